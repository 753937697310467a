"""The errata table: places where the thesis is wrong, silent or doubtful, with the replacement and its test."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Literal

from cosserat.errors import InputError
from cosserat.parameters import Parameters
from cosserat.reading import read_text


class Erratum(Parameters):
    """One entry.

    standing : "erratum" (the printed form fails something checkable that the corrected one meets), "assumption" (the
    page is silent or ambiguous), "question" (suspicious, not proven), "refuted" (looked wrong, is right).
    evidence : the test of it, as "file::function".
    """

    where: str
    printed: str
    corrected: str
    why: str
    standing: Literal["erratum", "assumption", "question", "refuted"]
    evidence: str


def read_errata(path: Path) -> dict[str, Erratum]:
    """The entries by id, in their order.

    Raises
    ------
    InputError : the file is missing or an entry is not valid.
    """
    try:
        tables = tomllib.loads(read_text(path))
    except (OSError, ValueError) as error:
        raise InputError(
            f"cannot read the errata {path}: {error}; restore it from the repository"
        ) from None
    return {name: Erratum.read(table, f"{path}, entry '{name}'") for name, table in tables.items()}
