"""Wrong and extreme values of every type of the schema."""

from __future__ import annotations

import datetime
import functools
import math
from collections.abc import Iterator
from typing import Any

from cosserat.describe.keys import Value
from cosserat.parameters import Count, Quantity, chooser

from .examples import example, right
from .toml import Raw

SURE, OPEN = (2,), (0, 1, 2)
"""Exit codes of values that no reading allows, and of values that may be right."""
CONTROL = "a\x1b]0;title\x07\x1b[31mred\u202eesrever\x00"
_DEEP: Any = functools.reduce(lambda inner, _: [inner], range(60), 1)
_OTHER = {"m": "1 kg", "kg": "1 m", "1": "1 m"}
NUMBERS = ("1e300", "1e-300", "-1e300", "0", "1e12", "1e-12", "1e100", "-1", "5e-324", "1.7e308")
"""Numbers that a range may allow and a computation may not bear."""


def wrong(value: Value) -> Iterator[tuple[str, Any, tuple[int, ...]]]:
    """Wrong and extreme values of a type: what is wrong, the value, and the exit codes that are as promised."""
    match value.form:
        case "quantity":
            yield from _wrong_quantity(value)
        case "count":
            yield from _wrong_count(value)
        case "word" | "text" | "name":
            yield from _wrong_word(value)
        case "truth":
            yield from [("type", bad, SURE) for bad in ("yes", [], {}, 7.5)]
        case "table":
            yield from _wrong_table(value)
        case "list" | "row":
            yield from _wrong_list(value)
        case "either":
            yield from _wrong_either(value)
        case "names" | "keys":
            yield from _wrong_names(value)


def _anything() -> Iterator[tuple[str, Any]]:
    """Values that fit hardly any key."""
    yield "type", datetime.date(2020, 1, 1)
    yield "control", CONTROL
    yield "long", "9" * 5000
    yield "deep", _DEEP
    yield "none", "none"
    yield "empty", ""


def _wrong_quantity(value: Value) -> Iterator[tuple[str, Any, tuple[int, ...]]]:
    assert isinstance(value.about, Quantity)
    unit = value.about.unit
    behind = "" if unit == "1" else f" {unit}"
    for bad in (True, [], {}, [1, 2], {"a": 1}):
        yield "type", bad, SURE
    for what, bad in _anything():
        yield what, bad, OPEN if what == "none" else SURE
    yield "unit", _OTHER.get(unit, "1 mol"), SURE
    yield "unit", f"1 {unit}^(9^9^9^9)", SURE
    yield "unit", "1 " + "m*" * 3000 + "m", SURE
    if unit != "1":
        yield "unit", 5, SURE
    for bad in ("nan", "inf", "-inf", "1e400", "1e-400x", "0x10", "1__0", "1,5"):
        yield "not a number", f"{bad}{behind}", SURE
    yield "not a number", Raw("nan"), SURE
    yield "digits", Raw("9" * 4000), SURE
    yield "digits", f"{'9' * 300}{behind}", OPEN
    for number in (*NUMBERS, *map(repr, _edges(value.about))):
        yield "extreme", f"{number}{behind}" if behind else float(number), OPEN


def _edges(about: Quantity) -> Iterator[float]:
    """The ends of a range, and numbers on the way to them."""
    large = math.sqrt(abs(about.most)) if about.below == math.inf else about.most * 0.999
    yield from (
        about.least,
        about.most,
        large,
        1 / large,
        -large if about.least < 0 else about.least * 1.5,
    )


def _wrong_count(value: Value) -> Iterator[tuple[str, Any, tuple[int, ...]]]:
    assert isinstance(value.about, Count)
    for bad in (True, 2.5, "7", [], {}, math.nan, math.inf):
        yield "type", bad, SURE
    for what, bad in _anything():
        yield what, bad, OPEN if what == "none" else SURE
    for bad in (-(10**30), 10**30, value.about.at_least - 1, value.about.at_most + 1):
        yield "range", bad, SURE
    yield "digits", Raw("9" * 5000), SURE
    yield "most", value.about.at_most, OPEN
    yield "least", value.about.at_least, OPEN


def _wrong_word(value: Value) -> Iterator[tuple[str, Any, tuple[int, ...]]]:
    for bad in (5, [], {}, True, math.nan):
        yield "type", bad, SURE
    for what, bad in _anything():
        yield what, bad, SURE if value.form == "word" and what != "none" else OPEN
    for bad in ("../../x", "<b>&amp;", r"$\frac$", "a" * 300):
        yield "text", bad, SURE if value.form == "word" else OPEN


def _wrong_table(value: Value) -> Iterator[tuple[str, Any, tuple[int, ...]]]:
    short = value.items or value.said
    for bad in (5, [], [{}], True, 0.1):
        yield "type", bad, OPEN if short else SURE
    for what, bad in _anything():
        yield what, bad, OPEN if what == "none" or short else SURE
    yield "unknown key", {"unknown": 1}, SURE
    yield "unknown key", {CONTROL: 1}, SURE
    yield "unknown key", {"a" * 5000: 1}, SURE
    yield "unknown key", {f"k{n}": 1 for n in range(500)}, SURE
    yield "like", {"like": "base"}, OPEN
    yield "like", {"like": [7]}, OPEN
    yield "empty table", {}, OPEN
    if choosing := chooser(value.tables):
        for bad in (5, "", "nonsense", [], {}, True, CONTROL, "a" * 5000):
            yield "choice", {choosing: bad}, SURE
    for inner in value.tables:
        yield "example", example(inner), OPEN


def _wrong_list(value: Value) -> Iterator[tuple[str, Any, tuple[int, ...]]]:
    item = value.items[0]
    right_one = right(item)
    for bad in (5, "a", {"a": 1}, True, [None or math.nan], [[[[[]]]]], [True], [{}], ["", {}]):
        yield "type", bad, OPEN
    for what, bad in _anything():
        yield what, bad, OPEN
    yield "empty list", [], OPEN
    yield "many", [right_one] * 1000, OPEN
    yield "twice", [right_one, right_one], OPEN
    for what, bad, codes in list(wrong(item)):
        yield f"{what} inside", [bad], codes
    if value.form == "row":
        yield "too many", [right(i) for i in (*value.items, item)], OPEN


def _wrong_either(value: Value) -> Iterator[tuple[str, Any, tuple[int, ...]]]:
    for bad in (True, {}, [], {"a": 1}, -7, 2.5, [[[]]]):
        yield "type", bad, OPEN
    for what, bad in _anything():
        yield what, bad, OPEN
    for part in value.items:
        for what, bad, _ in wrong(part):
            yield what, bad, OPEN


def _wrong_names(value: Value) -> Iterator[tuple[str, Any, tuple[int, ...]]]:
    """Tables whose keys the user names, or whose keys are those of a case."""
    for bad in (5, [5], "a", True):
        yield "type", bad, OPEN
    for what, bad in _anything():
        yield what, bad, OPEN if what == "none" else SURE
    for name in ("", "a b", CONTROL, "a" * 5000, "kind", "rod", "../x", "x", "1"):
        yield "unknown key", {name: "u.E2 at last"}, OPEN
    yield "empty table", {}, OPEN
    yield "many", {f"k{n}": "u.E2 at last" for n in range(3000)}, OPEN
    yield "deep inside", {"rod": {"rod": {"rod": {"rod": [[{}]]}}}}, SURE
    for item in value.items:
        for what, bad, _ in wrong(item):
            yield f"{what} inside", {"tip": bad}, OPEN
