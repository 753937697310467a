"""The publications that the package reproduces: each brings kinds of problems, cases and variables of its own.

A publication is one folder of the package.  The rest of the package finds it here and imports nothing of it.
"""

from __future__ import annotations

import argparse
import functools
import pkgutil
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import resources
from typing import Any, cast

from cosserat.kinds import KINDS, Kind
from cosserat.solution import Variables

Command = Callable[[argparse.Namespace], None]
"""The action of a command, with its options."""
AddCommand = Callable[[str, Command, str], argparse.ArgumentParser]
"""Adds a command by its name, its action and its help; returns its parser, for options."""

STUDY = "study"
"""The kind of a table of a case file that is a study, not a case."""
FIT = "fit"
"""The kind of a table of a case file that is a fit of a case to data."""
PUBLICATIONS = ("cosserat.thesis:PUBLICATION",)
"""Place of each `Publication`, as "module:object"."""


@dataclass(frozen=True)
class Publication:
    """Additions of one publication.

    title : of its commands in `--help`.
    reference : its citation.
    kinds : its own kinds of problems.
    cases : its case files, in order; `folder` is their package.
    variables, commands : its `cosserat.solution.Variables`, and the function that adds its commands to the command
        line, each as "module:object".
    """

    title: str
    reference: str
    kinds: Mapping[str, Kind]
    folder: str
    cases: tuple[str, ...]
    variables: str
    commands: str

    def own_variables(self) -> Variables:
        """Its part of the table of stored variables."""
        return cast("Variables", pkgutil.resolve_name(self.variables))

    def add_commands(self) -> Callable[[AddCommand], None]:
        """The function that adds its commands."""
        return cast("Callable[[AddCommand], None]", pkgutil.resolve_name(self.commands))


@functools.cache
def publications() -> tuple[Publication, ...]:
    """Every publication."""
    return tuple(cast("Publication", pkgutil.resolve_name(place)) for place in PUBLICATIONS)


@functools.cache
def kinds() -> Mapping[str, Kind]:
    """Every kind of problem by the value of `kind` in a case."""
    found = dict(KINDS)
    for publication in publications():
        found |= publication.kinds
    return found


def reference() -> str:
    """Citations of the publications for a result."""
    return "; ".join(publication.reference for publication in publications())


@functools.cache
def published_tables() -> dict[str, Any]:
    """All tables of the published case files by name; a name that begins with '_' is a base of cases, not a case."""
    tables: dict[str, Any] = {}
    for publication in publications():
        folder = resources.files(publication.folder)
        for name in publication.cases:
            tables |= tomllib.loads((folder / name).read_text(encoding="utf-8"))
    return tables


def titles() -> dict[str, tuple[str, str]]:
    """Title and source of each published case by its name, in the order of the files."""
    return {
        name: (str(table.get("title", name)), str(table.get("source", "")))
        for name, table in published_tables().items()
        if not name.startswith("_") and table.get("kind") != STUDY
    }
