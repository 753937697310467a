"""Every key of every kind from the parameter classes, and case files that give one of them another value."""

from __future__ import annotations

import functools
import tempfile
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import BaseModel

import cosserat
from cosserat.describe.keys import Value, described
from cosserat.publications import FIT, STUDY, kinds

from .examples import chosen, example, type_of
from .toml import table

BASE, CASE = "base", "c"
"""Names of the tables of a file: a right case, and the wrong one that is like it."""
_CONTEXT: dict[str, dict[str, Any]] = {
    "Layers": {"rod": {"material": "none"}},
    "Stiffnesses": {"rod": {"material": {"young": "none", "poisson": "none", "line_density": "1 kg/m"}}},
    "Measured": {"gait": {"gamma": []}},
    "Points": {"rod": {"length": "none"}},
    "Calibration": {"rod": {"energy": "published"}},
    "Chamber": {"gait": {"gamma": [], "eta": []}},
}
FAMILIES: dict[str, dict[str, Any]] = {
    STUDY: {
        "kind": STUDY,
        "of": BASE,
        "keep": {"tip": "u.E2 at last"},
        "vary": [{"rod": {"length": ["1 m", "1.1 m"]}}],
    },
    FIT: {
        "kind": FIT,
        "of": BASE,
        "data": "data.csv",
        "free": {"rod": {"material": {"young": ["0.1 GPa", "10 GPa"]}}},
        "keep": {"tip": "u.E2 at last"},
    },
}
"""Small studies and fits of the small static case, by the word of their kind."""
MEASURED = {"data.csv": b"forces.0.force [N],tip [m]\n0.5,0.32\n1,0.51\n2,0.68\n"}
"""What the fit reads."""
"""Keys elsewhere in the case that a table of a class needs."""


@dataclass(frozen=True)
class Step:
    """A table on the way to a key: the class that holds the key `name`, and whether a list of tables follows."""

    owner: type[BaseModel]
    name: str
    listed: bool


@dataclass(frozen=True)
class Spot:
    """One key of one kind: the tables that lead to it, its class, its name and the type of its value."""

    kind: str
    way: tuple[Step, ...]
    owner: type[BaseModel]
    name: str
    value: Value
    required: bool

    @property
    def path(self) -> str:
        """Such as "rod.length" and "forces[].at"."""
        before = "".join(f"{step.name}{'[]' if step.listed else ''}." for step in self.way)
        return before + self.name

    @property
    def same(self) -> tuple[str, ...]:
        """What this key has in common with the same one of another kind."""
        declared = next(
            c for c in reversed(self.owner.__mro__) if self.name in getattr(c, "__annotations__", ())
        )
        return (declared.__qualname__, self.name)

    def given(self, value: Any, base: Mapping[str, Any]) -> dict[str, Any]:
        """The top-level key of a case in which this one has the value; all else stays, or is an example."""
        content: dict[str, Any] = {self.name: value}
        owner = self.owner
        context: dict[str, Any] = {}
        key = self.name
        for number in range(len(self.way), 0, -1):
            step = self.way[number - 1]
            there = not step.listed and _is_there(owner, self.way[:number], base)
            content = {**(chosen(owner) if there else example(owner, key)), **content}
            content = {step.name: [content] if step.listed else content}
            context = _joined(context, _CONTEXT.get(owner.__name__, {}))
            owner, key = step.owner, step.name
        return _joined(context, content)


def _joined(first: Mapping[str, Any], second: Mapping[str, Any]) -> dict[str, Any]:
    """Both tables, key by key; the second one counts."""
    both = dict(first)
    for key, value in second.items():
        old = both.get(key)
        both[key] = _joined(old, value) if isinstance(old, dict) and isinstance(value, dict) else value
    return both


def _is_there(owner: type[BaseModel], way: tuple[Step, ...], base: Mapping[str, Any]) -> bool:
    """Whether the base has a table of this class at the end of the way."""
    inside: Any = base
    for step in way:
        inside = inside.get(step.name) if isinstance(inside, Mapping) else None
    word = chosen(owner)
    return isinstance(inside, Mapping) and all(inside.get(key) == value for key, value in word.items())


@functools.cache
def spots(kind: str, *, inner: bool = False) -> tuple[Spot, ...]:
    """Every key of a kind; `inner` : also those of the problems inside it, which are those of their own kinds."""
    return tuple(_spots(kind, described()[kind], (), inner))


def _spots(kind: str, owner: type[BaseModel], way: tuple[Step, ...], inner: bool) -> Iterator[Spot]:
    for name in owner.model_fields:
        if name == "time_function" and kind != "rod motion":
            continue  # other kinds have no time
        value = type_of(owner, name)
        yield Spot(kind, way, owner, name, value, owner.model_fields[name].is_required())
        if inner or not value.problem:
            for table_class in value.innermost.tables:
                yield from _spots(
                    kind, table_class, (*way, Step(owner, name, value.form == "list")), inner
                )


@functools.cache
def bases() -> dict[str, dict[str, Any]]:
    """A small case of each kind as it is written in a file, by kind; of a new kind, its first published case."""
    found: dict[str, dict[str, Any]] = {}
    for file in (Path(__file__).parent / "bases.toml", Path(__file__).parents[1] / "examples.toml"):
        written = tomllib.loads(file.read_text())
        for name, case in cosserat.load_cases(file).items():
            found.setdefault(case.problem.kind, written[name])
    for name, case in cosserat.published().items():
        found.setdefault(case.problem.kind, {"like": name})
    return {kind: found[kind] for kind in kinds()}


@functools.cache
def whole(kind: str) -> dict[str, Any]:
    """The small case of a kind with all that it inherits, in SI units; a study or a fit as it is written."""
    if kind in FAMILIES:
        return FAMILIES[kind]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "base.toml"
        file.write_bytes(file_of(kind, {}))
        return cosserat.case(CASE, file).problem.model_dump()


def file_of(kind: str, changes: Mapping[str, Any]) -> bytes:
    """A case file whose case, study or fit `c` is the small one of a kind with these top-level keys."""
    if kind in FAMILIES:
        written = {**FAMILIES[kind], **changes}
        text = f"{table(BASE, bases()['rod statics'])}\n{table(CASE, written)}"
        return text.encode("utf-8", "surrogateescape")
    text = f"{table(BASE, bases()[kind])}\n{table(CASE, {'like': BASE, **changes})}"
    return text.encode("utf-8", "surrogateescape")
