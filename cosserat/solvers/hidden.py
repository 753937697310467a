"""Crossings of eigenvalues that cancel within one arc of a path, so that as many are negative at both of its ends.

derived: D, the determinant of the Hessian of the free DOFs, is smooth along the path and zero where an eigenvalue is.
Two zeros at the distances a and b within an arc of length h make it fall by more than the factor (1 + g / h)^2 over an
arc of length g before, since a, b < h; so an arc is looked at only if D has fallen by more than the root of that,
or if nothing is known of the arc before; and only if D grows again at its end.  Its values and slopes at both ends
then give a cubic, which has a dip there.  Where it does, the path is followed to the bottom of the dip, which becomes
the end of a shorter interval, until D is negative there or no dip is left.
"""

from __future__ import annotations

from collections.abc import Callable
from math import exp, inf, log1p, sqrt
from typing import TYPE_CHECKING, NamedTuple

from cosserat.solvers.banded import Vector
from cosserat.solvers.indefinite import Factors

if TYPE_CHECKING:
    from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver

_DIP = 0.3  # of the smaller end, below which the bottom of the cubic is a dip
_STEPS = 12  # most points at the bottoms of dips
_NUDGE = 1e-4  # of the arc, over which slopes are differences
_LARGEST_CHANGE = 30.0  # of the logarithm of D within an arc, beyond which no cubic follows it

Way = tuple[Vector, float]
"""A direction of unit length along a path: of the DOFs and of the load factor."""


class Stop(NamedTuple):
    """A point of a path and the direction of the path there."""

    point: Equilibrium
    way: Way


class _Seen(NamedTuple):
    """The last point, the logarithm of D there, its fall over the arc before, and the length of that arc."""

    point: Equilibrium
    log: float
    fall: float
    arc: float


class _Place(NamedTuple):
    """A place at a share s of an arc: the logarithm of D, and its derivative by s."""

    s: float
    log: float
    slope: float


class Watch:
    """Looks for crossings that cancel, arc by arc."""

    def __init__(self, solver: EquilibriumSolver) -> None:
        self.solver = solver
        self._seen: _Seen | None = None

    def passed(self, start: Equilibrium, end: Equilibrium, ds: float) -> None:
        """Keep what is known of an arc that is not looked at."""
        before, after = start.log_determinant, end.log_determinant
        if before is not None and after is not None:
            self._seen = _Seen(end, after, before - after, ds)

    def between(
        self, start: Stop, end: Stop, ds: float, follow: Callable[[float], Stop | None]
    ) -> float | None:
        """A distance along an arc where the path is on the other side of a crossing than at both ends, if it is found.

        ds : length of the arc along its first direction.
        follow : the path at a distance along that direction.
        """
        after, same = self._log(end.point), end.point.negative == start.point.negative
        seen = self._seen if self._seen is not None and self._seen.point is start.point else None
        fall = inf if seen is None or not same else seen.log - after
        self._seen = _Seen(end.point, after, fall, ds)
        if not same or (seen is not None and seen.fall <= log1p(seen.arc / ds)):
            return None
        high = _Place(1.0, after, self._slope(start, end, after, ds, ahead=False))
        if high.slope <= 0.0:
            return None
        before = self._log(start.point) if seen is None else seen.log
        low = _Place(0.0, before, self._slope(start, start, before, ds, ahead=True))
        for _ in range(_STEPS):
            s, depth = _bottom(low, high)
            reached = follow(s * ds) if depth < _DIP else None
            if reached is None:
                return None
            if reached.point.negative != start.point.negative:
                return s * ds
            log = self._log(reached.point)
            middle = _Place(s, log, self._slope(start, reached, log, ds, ahead=True))
            low, high = min(((low, middle), (middle, high)), key=lambda pair: _bottom(*pair)[1])
        return None

    def _log(self, point: Equilibrium) -> float:
        """The logarithm of the size of D at a point."""
        known = point.log_determinant
        return self._at(point, point.q, point.factor) if known is None else known

    def _at(self, point: Equilibrium, q: Vector, factor: float) -> float:
        """The same beside a point."""
        system, tangent = self.solver.system, self.solver.tangent
        if not system.assemble(q, point.history, factor, tangent):
            return inf
        tangent.constrain(system.constrained)
        tangent.band[system.constrained, 0] = 1.0
        return Factors(tangent.band, tangent.skew).log

    def _slope(self, start: Stop, at: Stop, log: float, ds: float, *, ahead: bool) -> float:
        """Derivative of log |D| by the share of the arc, at a point of it; ahead : by a difference forwards."""
        (along, slope), (first, rise) = at.way, start.way
        weight = float(first @ first) or 1.0
        advance = (float(along @ first) + weight * slope * rise) / (weight + weight * rise * rise)
        step = (1 if ahead else -1) * _NUDGE * ds
        point = at.point
        beside = self._at(point, point.q + step * along, point.factor + step * slope)
        return (beside - log) / step * ds / advance


def _bottom(low: _Place, high: _Place) -> tuple[float, float]:
    """Of the cubic through D and its slopes at two places: the share of the arc at its bottom between them, and its
    value there over the smaller of both ends; infinite if it has no bottom.
    """
    span, rise = high.s - low.s, high.log - low.log
    if not abs(rise) < _LARGEST_CHANGE:
        return low.s, inf
    one, other = 1.0, exp(rise)
    first, last = span * low.slope, other * span * high.slope
    cubed, squared = 2 * (one - other) + first + last, 3 * (other - one) - 2 * first - last
    root = squared * squared - 3 * cubed * first
    if not root > 0.0:
        return low.s, inf
    beside = squared + sqrt(root)  # of the stationary points the one where the cubic bends upwards
    t = -first / beside if beside else inf
    if not 0.0 < t < 1.0:
        return low.s, inf
    value = one + t * (first + t * (squared + t * cubed))
    return low.s + t * span, value / min(one, other)
