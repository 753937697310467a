"""The published case files as plain tables: names and titles are known before any model is."""

from __future__ import annotations

import functools
import tomllib
from importlib import resources
from typing import Any

PUBLISHED = ("chapter2.toml", "chapter3.toml")
"""Case files of the package, beside this module."""


@functools.cache
def published_tables() -> dict[str, Any]:
    """All tables of the published files by name; those that begin with '_' are no cases but what cases are like."""
    folder = resources.files("cosserat.cases")
    tables: dict[str, Any] = {}
    for name in PUBLISHED:
        tables |= tomllib.loads((folder / name).read_text(encoding="utf-8"))
    return tables


def titles() -> dict[str, tuple[str, str]]:
    """Title and source of each published case by its name, in the order of the files."""
    return {
        name: (str(table.get("title", name)), str(table.get("source", "")))
        for name, table in published_tables().items()
        if not name.startswith("_")
    }
