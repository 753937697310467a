"""Places and instants of read-outs: read from texts, and values between those of a result."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from cosserat.text import shown
from cosserat.units import to_si

Array = NDArray[np.float64]
_READ = 4 * float(
    np.finfo(float).eps
)  # of a level, its round-off when it is read from a text with a unit


def place(text: str) -> tuple[float, str]:
    """A place or an instant: a number and its unit, "" for the number of a vertex, edge, section or mode.

    A percentage of the length has the unit "%" and its number from 0 to 1.

    Raises
    ------
    PydanticCustomError : it is neither.
    """
    if text in ("first", "last"):
        return (0.0, "") if text == "first" else (-1.0, "")
    if re.fullmatch(r"\d{1,6}", text):
        return float(text), ""
    part = text.endswith("%")
    for unit in ("1",) if part else ("m", "s"):
        try:
            number = to_si(text, unit, unit_required=True)
        except PydanticCustomError:
            continue
        if part and not 0 <= number <= 1:
            raise PydanticCustomError("place", f"has 'at' {shown(text)}; write 0 % to 100 %")
        return number, "%" if part else unit
    raise PydanticCustomError(
        "place",
        f"has 'at' {shown(text)}; write first, last, a number from 0, or a place or time with its unit: 1.2 m, 50 %",
    )


def taken(values: Array, index: int, axis: int) -> Array:
    """The values at one index of an axis."""
    return np.asarray(values.take(index, axis=axis))


def reaches(where: Array, at: float) -> bool:
    """Whether places (n,) reach as far as one."""
    return bool(where[0] <= at <= where[-1] * (1 + 1e-12))


def interpolated(where: Array, values: Array, at: float) -> Array:
    """Values (..., n) between places (n,); not a number outside them."""
    if not reaches(where, at):
        return np.full(values.shape[:-1], np.nan)
    k = int(np.clip(np.searchsorted(where, at, side="right"), 1, where.size - 1))
    share = (at - where[k - 1]) / (where[k] - where[k - 1])
    found: Array = (1 - share) * values[..., k - 1] + share * values[..., k]
    return found


def first_met(values: Array, level: float) -> tuple[int, float] | None:
    """The instant at which values (n,) first meet a level, and the share of the way to the next one; None for none."""
    over = values - level
    over[np.abs(over) <= _READ * abs(level)] = 0.0
    sign = np.sign(over)
    passes = np.append(sign[:-1] * sign[1:] < 0, [False])
    met = np.flatnonzero((sign == 0) | passes)
    if not met.size:
        return None
    k = int(met[0])
    return k, 0.0 if over[k] == 0 else float(over[k] / (over[k] - over[k + 1]))


def at_level(values: Array, k: int, share: float) -> float:
    """The value (n,) at an instant as `first_met` gives it."""
    return float((1 - share) * values[k] + share * values[k + 1]) if share else float(values[k])
