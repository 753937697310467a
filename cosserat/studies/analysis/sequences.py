"""Values on finer and finer meshes: the observed order, the limit by Richardson, and an estimate of the error.

The values are taken to be F + C h^p, with one h for each mesh: from three of them p follows, and from p the limit F.
The estimate of the error is the distance to the limit times a factor of safety, as in the grid convergence index of
Roache, J. Fluids Eng. 116 (1994) 405-413: 1.25 where another mesh confirms order and limit, else 3.  The order for
meshes of any ratios is that of Celik et al., J. Fluids Eng. 130 (2008) 078001.  Where the values do not behave like
this, the state says so, and there is no number.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
CONFIRMED, UNCONFIRMED, ROUND_OFF, NOT_MONOTONE, NOT_ASYMPTOTIC, TOO_FEW = range(6)
STATES = ("confirmed", "unconfirmed", "round_off", "not_monotone", "not_asymptotic", "too_few_meshes")
"""What a sequence is, in the order of the numbers."""
SAID = (
    "order and limit are confirmed by another mesh",
    "three meshes: nothing confirms the order",
    "the meshes agree to round-off",
    "the values do not change in one direction",
    "the changes do not shrink with one order",
    "fewer than three meshes have an answer",
)
"""The same in words."""
MOST_ORDER = 20.0
"""Largest order that is looked for."""
_LEAST_ORDER = 0.05
_SAME_ORDER = 0.5  # largest difference of two orders that confirm each other
_ROUND_OFF = 1e-12  # of the largest value: changes below this are none
_MOST_FLOOR = 1e-7  # of the largest value: the most that the floor of a variable may be
SAFETY = {CONFIRMED: 1.25, UNCONFIRMED: 3.0}
"""The factor of safety by the state."""


@dataclass(frozen=True)
class Convergence:
    """What a sequence of values tells.

    state : a number of `STATES`.  order, limit : None where there is none.  orders : of each three neighbours, the
    finest last, None where there is none.  spread : the largest change between the three finest meshes.
    """

    state: int
    order: float | None
    limit: float | None
    orders: tuple[float | None, ...]
    spread: float

    def error(self, value: float) -> float | None:
        """The estimated error of a value of the sequence; None where nothing can be said."""
        if self.state == ROUND_OFF:
            return max(self.spread, _ROUND_OFF * abs(value))
        if self.limit is None:
            return None
        return SAFETY[self.state] * abs(value - self.limit)


def convergence(h: Array, values: Array, floor: float = 0.0) -> Convergence:
    """What values (n,) on meshes of the sizes h (n,) tell, in any order.

    floor : changes below this are round-off, in the unit of the values, where it is small beside them.
    """
    order = np.argsort(h)[::-1]
    h, values = h[order], values[order]
    if h.size < 3:
        return Convergence(TOO_FEW, None, None, (), 0.0)
    largest = float(np.abs(values).max())
    least = max(min(floor, _MOST_FLOOR * largest), _ROUND_OFF * largest)
    triples = [(h[k : k + 3], values[k : k + 3]) for k in range(h.size - 2)]
    orders = tuple(observed_order(*triple, least) for triple in triples)
    spread = float(np.ptp(triples[-1][1]))
    if spread <= least:
        return Convergence(ROUND_OFF, None, None, orders, spread)
    if orders[-1] is None:
        state = NOT_MONOTONE if _turns(triples[-1][1]) else NOT_ASYMPTOTIC
        return Convergence(state, None, None, orders, spread)
    limit = _limit(*triples[-1], orders[-1])
    if h.size == 3:
        return Convergence(UNCONFIRMED, orders[-1], limit, orders, spread)
    if not _confirms(triples[-2], orders[-2], limit, orders[-1]):
        return Convergence(NOT_ASYMPTOTIC, None, None, orders, spread)
    return Convergence(CONFIRMED, orders[-1], limit, orders, spread)


def _turns(values: Array) -> bool:
    """Whether three values go up and down."""
    before, after = np.diff(values)
    return bool(before * after <= 0)


def observed_order(h: Array, values: Array, least: float) -> float | None:
    """The order of three values on meshes h, the finest last; None where they have none.

    least : changes below this are none.
    """
    from scipy.optimize import brentq

    before, after = np.diff(values)
    if _turns(values) or min(abs(before), abs(after)) <= least:
        return None

    def excess(p: float) -> float:
        """Of the ratio of the changes that an order p has, over that of the values; it grows with p."""
        coarse, middle, fine = (h / h[1]) ** p
        return float((coarse - middle) / (middle - fine) - before / after)

    if excess(_LEAST_ORDER) >= 0 or excess(MOST_ORDER) <= 0:
        return None
    return float(brentq(excess, _LEAST_ORDER, MOST_ORDER, xtol=1e-12))


def _limit(h: Array, values: Array, order: float) -> float:
    """The value at h = 0."""
    _, middle, fine = (h / h[1]) ** order
    return float(values[2] + (values[2] - values[1]) * fine / (middle - fine))


def _confirms(
    coarser: tuple[Array, Array], coarse_order: float | None, limit: float, order: float
) -> bool:
    """Whether three coarser meshes have nearly the same order, and a limit with the finer one within its error."""
    if coarse_order is None or abs(coarse_order - order) > _SAME_ORDER:
        return False
    other = _limit(*coarser, coarse_order)
    return abs(limit - other) <= SAFETY[CONFIRMED] * abs(float(coarser[1][-1]) - other)
