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
"""What a command does with its options."""
AddCommand = Callable[[str, Command, str], argparse.ArgumentParser]
"""Adds a command by its name, what it does and its help; returns its parser, for options."""

PUBLICATIONS = ("cosserat.thesis:PUBLICATION",)
"""Where each `Publication` is, as "module:object"."""


@dataclass(frozen=True)
class Publication:
    """What one publication adds.

    reference : how to cite it.
    kinds : kinds of problems that are its own.
    cases : its case files, in the order in which they are listed; `folder` is the package that holds them.
    variables, commands : where its `cosserat.solution.Variables` are, and the function that adds its commands to the
        command line, as "module:object".
    """

    reference: str
    kinds: Mapping[str, Kind]
    folder: str
    cases: tuple[str, ...]
    variables: str
    commands: str

    def own_variables(self) -> Variables:
        """What it adds to the table of stored variables."""
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
    """Every kind of problem by the word that a case names in `kind`."""
    found = dict(KINDS)
    for publication in publications():
        found |= publication.kinds
    return found


def reference() -> str:
    """The publications, as a result cites them."""
    return "; ".join(publication.reference for publication in publications())


@functools.cache
def published_tables() -> dict[str, Any]:
    """All tables of the published case files by name; those that begin with '_' are no cases but bases of cases."""
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
        if not name.startswith("_")
    }
