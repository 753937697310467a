"""Derivatives of smooth functions of one number by central differences, extrapolated, with a check of their error.

The steps are halved and their differences extrapolated (Richardson), which removes all errors but those of the sixth
power of the step; where they are not enough, one more halving removes those too, and costs less round-off than to begin
with shorter steps.  Both sides together also show a kink, where no derivative exists.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import InputError

Array = NDArray[np.float64]
LARGEST = 2.0**-5
"""Largest first step."""
_LEVELS = 3
_SHORTER = 8.0  # factor to the next steps
_TRIALS = 4
_GOOD = 1e-8  # error, as a fraction of the largest derivative, at which no shorter steps are tried
_KINK = 1e-3  # of the largest derivative, by which one from the left and one from the right may differ


@dataclass(frozen=True)
class Slope:
    """A derivative.

    value : of any shape.  error : the larger change by the last extrapolation, or what round-off can do if that is
        more, of the same shape.
    kink : where the derivatives from both sides differ, of the same shape.
    relative : the largest error as a fraction of the largest derivative, beyond round-off; zero where all is round-off.
    noise : what round-off can do to it.
    """

    value: Array
    error: Array
    kink: NDArray[np.bool_]
    relative: float
    noise: float

    @property
    def rank(self) -> tuple[bool, float]:
        """Whether there is a kink, and the largest error; the least is best."""
        return bool(self.kink.any()), float(self.error.max(initial=0.0))

    @property
    def good(self) -> bool:
        """Whether shorter steps are not worth a trial."""
        return self.rank <= (False, max(self.noise, _GOOD * float(np.abs(self.value).max(initial=0.0))))


def halved(step: float) -> tuple[float, ...]:
    """Steps whose differences are extrapolated together."""
    return tuple(step / 2**level for level in range(_LEVELS))


def slope(values: Callable[[float], Array], floor: float, round_off: float = 0.0) -> Slope:
    """The derivative of a function at zero.

    values : the function, smooth to steps of at most `LARGEST`.
    floor : largest size of the round-off in its values, below which no kink is seen.
    round_off : its standard deviation; the error is never less than what three of these make of the shortest step.

    Raises
    ------
    InputError : the function is not defined on both sides of zero.
    """
    best: Slope | None = None
    first: InputError | None = None
    for trial in range(_TRIALS):
        try:
            found = _tried(values, LARGEST / _SHORTER**trial, floor, round_off)
        except InputError as error:
            first = first or error
            continue
        if best is None or found.rank < best.rank:
            best = found
        elif not best.kink.any():
            break  # round-off grows
        if best.good:
            break
    if best is None:
        assert first is not None  # every trial ended in one
        raise first
    return best


def _tried(values: Callable[[float], Array], step: float, floor: float, round_off: float) -> Slope:
    """The derivative by a step and its halves, with one more half where that is better."""
    middle = np.asarray(values(0.0), dtype=np.float64)
    steps = halved(step)
    ahead, behind = ([np.asarray(values(sign * h)) for h in steps] for sign in (1.0, -1.0))
    found = _slope(middle, ahead, behind, steps, floor, round_off)
    if found.good or found.kink.any():
        return found
    steps = (*steps, steps[-1] / 2)
    ahead.append(np.asarray(values(steps[-1])))
    behind.append(np.asarray(values(-steps[-1])))
    longer = _slope(middle, ahead, behind, steps, floor, round_off)
    return longer if longer.rank < found.rank else found


def _slope(
    middle: Array,
    ahead: Sequence[Array],
    behind: Sequence[Array],
    steps: Sequence[float],
    floor: float,
    round_off: float,
) -> Slope:
    """The derivative from values at zero and after steps to both sides."""
    value, error = extrapolated(ahead, behind, steps)
    jump = [(a + b - 2 * middle) / (2 * h) for a, b, h in zip(ahead, behind, steps, strict=True)]
    for power in (1, 3):
        jump = _eliminated(jump, 2**power)
    size, rounded = float(np.abs(value).max(initial=0.0)), 8 * floor / steps[-1]
    beyond = float(error.max(initial=0.0)) - rounded
    kink = np.abs(jump[-1]) > _KINK * size + rounded
    noise = 3 * round_off / steps[-1]  # of three standard deviations; the shortest step has nearly all
    return Slope(value, np.maximum(error, noise), kink, beyond / size if beyond > 0 else 0.0, noise)


def extrapolated(
    ahead: Sequence[Array], behind: Sequence[Array], steps: Sequence[float]
) -> tuple[Array, Array]:
    """A derivative from values after steps to both sides, and the change by the last extrapolation.

    steps : each half of the one before.  The change is that from the entry with the shortest steps, which round-off
    alone can make small by chance.
    """
    table = [(a - b) / (2 * h) for a, b, h in zip(ahead, behind, steps, strict=True)]
    before = table
    for order in range(1, len(steps)):
        before, table = table, _eliminated(table, 4**order)
    return table[-1], np.abs(table[-1] - before[-1])


def _eliminated(table: list[Array], ratio: float) -> list[Array]:
    """Neighbouring levels combined so that the error that halving divides by `ratio` is gone."""
    return [fine + (fine - coarse) / (ratio - 1) for coarse, fine in pairwise(table)]
