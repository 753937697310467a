"""The doors of a chapter: stored data, drawn figures, rows of the report, and lines of the library.

A chapter computes no published case again and types no result; it reads results of the workflow and asserts its rows.
Names are imported when first used: half of the time of a short page is that of its imports.
"""

from __future__ import annotations

import importlib
from typing import Any

_HOMES = {
    "command_line": ("commands",),
    "drawn": ("figure", "text"),
    "equation_list": ("counts", "equations", "left_out", "left_out_table"),
    "judgements": ("errata_list", "results_table", "total_of"),
    "key_lists": ("anchor", "common_keys", "keys"),
    "listings": ("excerpt", "source", "written"),
    "notation": ("notation", "other_symbols", "several_meanings"),
    "players": ("explore", "player"),
    "pulling": ("pull",),
    "references": ("how_to_cite", "references"),
    "stored_variables": ("variables",),
    "tables": ("folded", "table", "tens"),
    "tutorial": ("Folder",),
    "verdicts": (
        "amount",
        "errata",
        "misprint",
        "overview",
        "report",
        "row",
        "rows",
        "today",
        "unseen_changes",
    ),
    "workflow": ("data", "results", "study"),
}
"""The doors, by the module of this folder that has them."""


def __getattr__(name: str) -> Any:
    for module, names in _HOMES.items():
        if name in names:
            home = importlib.import_module(f"cosserat.thesis.book.{module}")
            value = globals()[name] = getattr(home, name)
            return value
    raise AttributeError(f"a chapter has no door '{name}'; the doors are {', '.join(__dir__())}")


def __dir__() -> list[str]:
    return sorted(name for names in _HOMES.values() for name in names)
