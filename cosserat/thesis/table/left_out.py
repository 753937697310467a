"""The list of omissions from the thesis: numbered equations, figures, tables and topics, each with a reason."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

from pydantic import Field

from cosserat.errors import InputError
from cosserat.parameters import Parameters
from cosserat.reading import read_text

KINDS = ("equations", "figures", "tables")


class Numbered(Parameters):
    """Numbers of equations by section, of figures and tables by chapter, in the thesis."""

    equations: dict[str, int]
    figures: dict[str, int]
    tables: dict[str, int]

    def names(self, kind: str) -> list[str]:
        """Their numbers in order, such as "1.3.18" or "2.10"."""
        counts: dict[str, int] = getattr(self, kind)
        return [f"{place}.{k}" for place, count in counts.items() for k in range(1, count + 1)]


class LeftOut(Parameters):
    """One topic and the numbers that belong to it, single ones or ranges, "1.1.1-1.1.34"."""

    what: str
    why: str
    equations: tuple[str, ...] = ()
    figures: tuple[str, ...] = ()
    tables: tuple[str, ...] = ()
    sections: tuple[str, ...] = ()

    def names(self, kind: str) -> list[str]:
        """Every number of a kind, ranges written out.

        Raises
        ------
        InputError : a number or a range is malformed.
        """
        return [name for text in getattr(self, kind) for name in _expand(text)]

    @property
    def where(self) -> str:
        """The same as a line: "(1.1.1)-(1.1.34), Figs. 1.1-1.4, section 3.1"."""
        parts = ["-".join(f"({name})" for name in text.split("-")) for text in self.equations]
        parts += [f"Fig{'s' * ('-' in text)}. {text}" for text in self.figures]
        parts += [f"Table {text}" for text in self.tables]
        return ", ".join([*parts, *(f"section {text}" for text in self.sections)])


class LeftOutList(Parameters):
    """The whole list."""

    numbered: Numbered
    left_out: tuple[LeftOut, ...] = Field(min_length=1)

    def names(self, kind: str) -> list[str]:
        """All numbers of a kind that are left out, in the order of the list."""
        return [name for item in self.left_out for name in item.names(kind)]

    def kept(self, kind: str) -> tuple[int, int]:
        """The number of included items of a kind, and the number of all."""
        total = len(self.numbered.names(kind))
        return total - len(self.names(kind)), total


_RANGE = re.compile(r"(?P<place>\d(?:\.\d)?)\.(?P<first>\d+)(?:-(?P=place)\.(?P<last>\d+))?")


def _expand(text: str) -> list[str]:
    found = _RANGE.fullmatch(text)
    first, last = (int(found["first"]), int(found["last"] or found["first"])) if found else (1, 0)
    if found is None or last < first:
        raise InputError(f"'{text}' is no number or range; write one such as 1.2.3 or 1.2.3-1.2.9")
    return [f"{found['place']}.{k}" for k in range(first, last + 1)]


def read_left_out(path: Path) -> LeftOutList:
    """The list.

    Raises
    ------
    InputError : the file is missing or not valid.
    """
    try:
        table = tomllib.loads(read_text(path))
    except (OSError, ValueError) as error:
        raise InputError(
            f"cannot read the list of omissions {path}: {error}; restore it from the repository"
        ) from None
    return LeftOutList.read(table, str(path))
