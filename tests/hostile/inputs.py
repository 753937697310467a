"""The corpus of bad input: every key of every kind from the schema, and files, commands and paths by hand."""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterable, Iterator
from typing import Any

from . import commands, families, files
from .judge import Input
from .schema import CASE, FAMILIES, MEASURED, Spot, bases, file_of, spots, whole
from .values import OPEN, SURE, wrong

RUN = ("run", CASE, "--file", "c.toml", "-o", "c.nc")


def corpus() -> Iterator[Input]:
    """Every bad input."""
    for spot in each_key():
        for what, value, codes in wrong(spot.value):
            yield of_a_file(spot, what, value, codes)
    yield from of_other_kinds()
    yield from from_standard_input()
    yield from missing_keys()
    yield from files.inputs()
    yield from commands.inputs()
    yield from families.inputs()


def refused_at_once() -> list[Input]:
    """The part of the corpus that is refused while it is read: of each key one wrong value after another, in turn."""
    found = []
    for number, spot in enumerate(each_key()):
        sure = [one for one in wrong(spot.value) if one[2] == SURE]
        found += [of_a_file(spot, *sure[number % len(sure)])] if sure else []
    by_hand = [*from_standard_input(), *files.inputs(), *commands.inputs(), *families.inputs()]
    found += [
        one for one in by_hand if one.codes == SURE and not one.alone and not one.before and one.common
    ]
    return found


def each_key() -> list[Spot]:
    """Every key once, of the first kind that has it."""
    found: dict[tuple[str, ...], Spot] = {}
    for kind in (*bases(), *FAMILIES):
        for spot in spots(kind):
            found.setdefault(spot.same, spot)
    return list(found.values())


def of_a_file(spot: Spot, what: str, value: Any, codes: tuple[int, ...]) -> Input:
    """A case file in which a key has a wrong value."""
    content = file_of(spot.kind, spot.given(value, whole(spot.kind)))
    given = {"c.toml": content, **MEASURED} if spot.kind in FAMILIES else {"c.toml": content}
    command = families.SOLVE.get(spot.kind, RUN)
    return Input(f"{what}: {spot.kind}, {spot.path}", command, given, codes=codes)


def of_other_kinds() -> Iterator[Input]:
    """Of keys that several kinds have, some extreme numbers in each of the others."""
    first = set(each_key())
    for kind in bases():
        for spot in spots(kind, inner=True):
            if spot in first or spot.value.form not in ("quantity", "count"):
                continue
            extreme = [found for found in wrong(spot.value) if found[2] == OPEN]
            for number in range(2 if spot in spots(kind) else 1):
                turn = zlib.crc32(f"{kind} {spot.path} {number}".encode()) % len(extreme)
                yield of_a_file(spot, *extreme[turn])


def missing_keys() -> Iterator[Input]:
    """Cases without one of the keys that their kind requires."""
    for kind in bases():
        yield Input(
            f"missing: {kind}, all", RUN, {"c.toml": f'[c]\nkind = "{kind}"\n'.encode()}, codes=SURE
        )
        for spot in spots(kind):
            if spot.required and not spot.way:
                content = _json({"name": CASE, "title": "", "problem": _without(whole(kind), spot.name)})
                yield Input(
                    f"missing: {kind}, {spot.path}",
                    ("run", "-", "-o", "c.nc"),
                    stdin=content,
                    codes=SURE,
                )


def _without(table: dict[str, Any], key: str) -> dict[str, Any]:
    return {name: value for name, value in table.items() if name != key}


def from_standard_input() -> Iterator[Input]:
    """Cases as JSON in which a key has one wrong value, in turn; JSON has null, and numbers without a limit."""
    for number, spot in enumerate(spot for spot in each_key() if spot.kind not in FAMILIES):
        for bad in (None, json_values()[number % len(json_values())]):
            problem = _deep_update(
                json.loads(json.dumps(whole(spot.kind))), spot.given(bad, whole(spot.kind))
            )
            content = _json({"name": CASE, "title": "a title", "problem": problem})
            plain = spot.value.form in ("quantity", "count", "word")
            codes = SURE if plain and isinstance(bad, list | dict) else OPEN
            yield Input(
                f"JSON: {spot.kind}, {spot.path}", ("run", "-", "-o", "c.nc"), stdin=content, codes=codes
            )


def json_values() -> list[Any]:
    """Values of JSON that fit few keys."""
    deep: Any = 1
    for _ in range(100):
        deep = [deep]
    return [
        float("nan"),
        1e308,
        float("-inf"),
        10**400,
        deep,
        True,
        "\x00",
        {"": {}},
        [],
        "9" * 5000,
        5e-324,
        -1,
    ]


def _json(value: Any) -> bytes:
    return json.dumps(value).encode()


def _deep_update(table: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    for key, value in changes.items():
        old = table.get(key)
        table[key] = (
            _deep_update(old, value) if isinstance(old, dict) and isinstance(value, dict) else value
        )
    return table


def named(given: Iterable[Input], words: list[str]) -> list[Input]:
    """Those whose name has one of the words."""
    return [one for one in given if not words or any(word in one.name for word in words)]
