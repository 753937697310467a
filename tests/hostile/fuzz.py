"""Case files by chance: right ones, of every kind, changed in one to six places; each follows from a seed and a number.

What is changed, and into what, comes from the schema, so that a new kind or key is tried by itself.
"""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

from cosserat.publications import titles

from .examples import right
from .judge import Input, Outcome, faults
from .schema import BASE, CASE, FAMILIES, bases, spots, whole
from .toml import Raw, table
from .values import CONTROL, NUMBERS, wrong
from .worker import Worker, read_here

Document = dict[str, Any]
_MOST = 6
_PIECES = [
    "",
    " ",
    "\n",
    "[",
    "]",
    "{",
    "}",
    '"',
    "=",
    ".",
    ",",
    "\x00",
    "\\",
    "9" * 400,
    "é",
    "\udcff",
    "#",
    "'''",
    "e999",
]
_UNITS = [
    "m",
    "mm",
    "kg",
    "s",
    "Pa",
    "GPa",
    "N",
    "N*m",
    "rad",
    "deg",
    "K",
    "1/s",
    "Hz",
    "",
    "m^(9^9)",
    "%",
    "degC",
    "parrots",
]


@dataclass(frozen=True)
class Example:
    """A case file: the kind of its base, and its changes, each a function's name and a seed."""

    kind: str
    changes: tuple[tuple[str, int], ...]
    json: bool = False

    @property
    def content(self) -> bytes:
        """The bytes of the file."""
        document: Document = {BASE: bases().get(self.kind, {}), CASE: {"like": BASE}}
        if self.kind in FAMILIES:
            document = {BASE: bases()["rod statics"], CASE: FAMILIES[self.kind]}
        elif self.json:
            document = {CASE: copy.deepcopy(whole(self.kind))}
        document = copy.deepcopy(document)
        texts = []
        for name, seed in self.changes:
            if name in _ON_TEXT:
                texts.append((name, seed))
            else:
                _ON_TABLES[name](document, random.Random(seed), self.kind)
        text = (
            _json(document[CASE])
            if self.as_json
            else "\n".join(table(*item) for item in document.items())
        )
        for name, seed in texts:
            text = _ON_TEXT[name](text, random.Random(seed))
        return text.encode("utf-8", "surrogateescape")

    @property
    def input(self) -> Input:
        """The same as a command."""
        if self.as_json:
            return Input("", ("run", "-", "-o", "c.nc"), stdin=self.content)
        word = self.kind if self.kind in FAMILIES else "run"
        return Input("", (word, CASE, "--file", "c.toml", "-o", "c.nc"), {"c.toml": self.content})

    @property
    def as_json(self) -> bool:
        """Whether it is given on standard input, as a case may be."""
        return self.json and self.kind not in FAMILIES


def example(seed: int, number: int) -> Example:
    """The example of this number."""
    chance = random.Random(f"{seed} {number}")
    kind = chance.choice([*bases(), *FAMILIES])
    as_json = chance.random() < 0.15
    known = [*_ON_TABLES, *_ON_TABLES, *_ON_TEXT]
    count = min(_MOST, 1 + int(chance.expovariate(0.8)))
    changes = [(chance.choice(known), chance.getrandbits(32)) for _ in range(count)]
    return Example(kind, tuple(changes), as_json)


def read(worker: Worker, given: Example) -> Outcome:
    """How the reader ends with it."""
    content = given.content
    if given.as_json and not _is_text(content):
        given = replace(given, json=False)
    return worker.call(read_here, content, CASE, given.as_json)


def shrunk(given: Example, ends_so: Callable[[Example], bool]) -> Example:
    """The example with as few of its changes as end in the same way."""
    for change in given.changes:
        fewer = replace(given, changes=tuple(one for one in given.changes if one is not change))
        if ends_so(fewer):
            given = fewer
    return given


def faults_of(ended: Outcome) -> list[str]:
    """What is not as promised."""
    return faults(Input(""), ended)


def _is_text(content: bytes) -> bool:
    try:
        content.decode()
    except UnicodeDecodeError:
        return False
    return True


def _json(problem: Any) -> str:
    case = {"name": CASE, "title": "a title", "source": "", "problem": problem}
    return json.dumps(case, default=lambda value: value.text if isinstance(value, Raw) else str(value))


def _places(inside: Any) -> Iterator[tuple[Any, Any]]:
    """Every table or list below, with each key or index."""
    if isinstance(inside, dict | list):
        for key in list(inside) if isinstance(inside, dict) else range(len(inside)):
            yield inside, key
            yield from _places(inside[key])


def _somewhere(document: Document, chance: random.Random) -> tuple[Any, Any]:
    """A table or list of the case or its base, and a key."""
    places = list(_places(document[CASE]))
    if BASE in document and chance.random() < 0.3:
        places = list(_places(document[BASE]))
    return chance.choice(places) if places else (document, CASE)


def _set_key(document: Document, chance: random.Random, kind: str, *, good: bool = False) -> None:
    """Give a key of the schema a value that is wrong for it, or right."""
    spot = chance.choice(spots(kind, inner=True))
    values = [right(spot.value)] if good else [value for _, value, _ in wrong(spot.value)]
    for name, value in spot.given(chance.choice(values), whole(kind)).items():
        _put(document[CASE], name, copy.deepcopy(value))


def _put(inside: Any, name: str, value: Any) -> None:
    """Set a key, and the keys of a table inside those that are there."""
    if isinstance(inside, dict):
        old = inside.get(name)
        if isinstance(old, dict) and isinstance(value, dict):
            for key, inner in value.items():
                _put(old, key, inner)
        else:
            inside[name] = value


def _set_right(document: Document, chance: random.Random, kind: str) -> None:
    """Give a key of the schema an ordinary value."""
    _set_key(document, chance, kind, good=True)


def _number(document: Document, chance: random.Random, kind: str) -> None:
    """Give a quantity of the schema a strange number in its own unit, or in another."""
    known = [*spots(kind, inner=True), *(spots("rod statics") if kind in FAMILIES else ())]
    spot = chance.choice([spot for spot in known if spot.value.form in ("quantity", "count")])
    number = chance.choice(
        [*NUMBERS, "nan", "inf", "1e9", "-0", "0.1", f"1e{chance.randint(-330, 330)}"]
    )
    unit = getattr(spot.value.about, "unit", "")
    unit = chance.choice(_UNITS) if chance.random() < 0.2 else unit
    value: Any = f"{number} {unit}" if unit not in ("", "1") else Raw(number)
    for name, found in spot.given(value, whole(kind)).items():
        _put(document[CASE], name, found)


def _other_kind(document: Document, chance: random.Random, kind: str) -> None:
    """Give a key of another kind."""
    _set_right(document, chance, chance.choice(list(bases())))


def _drop(document: Document, chance: random.Random, kind: str) -> None:
    """Leave something out."""
    inside, key = _somewhere(document, chance)
    if inside is not document:
        del inside[key]


def _misspell(document: Document, chance: random.Random, kind: str) -> None:
    """Rename a key."""
    inside, key = _somewhere(document, chance)
    if isinstance(inside, dict) and inside is not document:
        new = _scrambled(str(key), chance)
        inside[new] = inside.pop(key)


def _scramble(document: Document, chance: random.Random, kind: str) -> None:
    """Change the characters of a text."""
    texts = [(inside, key) for inside, key in _places(document) if isinstance(inside[key], str)]
    if texts:
        inside, key = chance.choice(texts)
        inside[key] = _scrambled(inside[key], chance)


def _scrambled(text: str, chance: random.Random) -> str:
    at = chance.randint(0, len(text))
    piece = chance.choice(
        [*_PIECES, *_UNITS, CONTROL, text, "^", "*", "/", "-", "e5", "(", "none", "°", "²"]
    )
    return chance.choice([text[:at] + piece + text[at:], text[:at] + text[at + 1 :], text[:at] + piece])


def _another_type(document: Document, chance: random.Random, kind: str) -> None:
    """Put a value of another type somewhere."""
    inside, key = _somewhere(document, chance)
    old = inside[key]
    inside[key] = chance.choice(
        [
            [old],
            {"a": old},
            [old, old],
            str(old),
            True,
            0,
            -1,
            1.5,
            [],
            {},
            "",
            "none",
            CONTROL,
            [[[[old]]]],
            "x" * 3000,
        ]
    )


def _repeat(document: Document, chance: random.Random, kind: str) -> None:
    """Repeat, mix or empty a list."""
    lists = [(inside, key) for inside, key in _places(document) if isinstance(inside[key], list)]
    if lists:
        inside, key = chance.choice(lists)
        old = inside[key]
        mixed = chance.sample(old, len(old))
        inside[key] = chance.choice(
            [old * chance.choice([2, 3, 50]), mixed, [], old[:1], old[::-1], [old]]
        )


def _move(document: Document, chance: random.Random, kind: str) -> None:
    """Copy something to another place."""
    inside, key = _somewhere(document, chance)
    target, place = _somewhere(document, chance)
    if target is not document:
        target[place] = copy.deepcopy(inside[key])


def _like(document: Document, chance: random.Random, kind: str) -> None:
    """Inherit from other cases."""
    names = [
        chance.choice([*titles(), BASE, CASE, "_slender", "", "none", 5])
        for _ in range(chance.randint(1, 4))
    ]
    tables = [inside for inside, _ in _places(document[CASE]) if isinstance(inside, dict)]
    where = chance.choice(tables or [document.get(BASE, document)])
    where["like"] = names[0] if len(names) == 1 else names


def _table(document: Document, chance: random.Random, kind: str) -> None:
    """Add a table beside the case, or put the case into another."""
    document[_scrambled(CASE, chance)] = copy.deepcopy(document[CASE])


_ON_TABLES: dict[str, Callable[[Document, random.Random, str], None]] = {
    "key": _set_key,
    "right key": _set_right,
    "number": _number,
    "other kind": _other_kind,
    "drop": _drop,
    "misspell": _misspell,
    "scramble": _scramble,
    "type": _another_type,
    "repeat": _repeat,
    "move": _move,
    "like": _like,
    "table": _table,
}


def _cut(text: str, chance: random.Random) -> str:
    return text[: chance.randint(0, len(text))]


def _insert(text: str, chance: random.Random) -> str:
    at = chance.randint(0, len(text))
    return text[:at] + chance.choice(_PIECES) + text[at:]


def _replace(text: str, chance: random.Random) -> str:
    at = chance.randint(0, len(text))
    return text[:at] + chance.choice(_PIECES) + text[at + chance.randint(1, 5) :]


def _lines(text: str, chance: random.Random) -> str:
    lines = text.split("\n")
    at = chance.randrange(len(lines))
    return "\n".join(lines[:at] + [lines[at]] * chance.choice([0, 2, 2, 30]) + lines[at + 1 :])


_ON_TEXT: dict[str, Callable[[str, random.Random], str]] = {
    "cut": _cut,
    "insert": _insert,
    "replace": _replace,
    "lines": _lines,
}


CHANGES = (*_ON_TABLES, *_ON_TEXT)
"""Names of the changes."""


def named(given: Example) -> str:
    """Its class for a table: what was changed first."""
    return (
        f"{given.changes[0][0] if given.changes else 'nothing'}: {given.kind}"
        + " as JSON" * given.as_json
    )
