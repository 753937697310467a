"""Special points of a path of equilibria: limit points and bifurcations, located between two points of it.

There the Hessian is singular.  Between the two points the path is followed over their chord, by the same corrections as
its arcs.  Bisection separates the points where the number of negative eigenvalues or the direction of the load changes;
the secant method, safeguarded by bisection, then finds the root of the eigenvalue nearest zero, which is smooth along
the path, to round-off.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cosserat.solvers.arcs import corrected, path_tangent, step_size
from cosserat.solvers.banded import Vector, absolute_product
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver, NewtonSettings
from cosserat.solvers.indefinite import Factors
from cosserat.solvers.system import MechanicalSystem

_SPLIT = (
    0.4871  # where an interval is divided: not at its middle, where symmetry may put the special point
)
_WIDTH = 2.0**-16  # length of an arc [rad, or fraction of the load] below which the secant method begins
_FINEST = 2.0**-36  # the same, below which several crossings are one
_STRAY = 0.5  # largest distance of the path from the chord, as a fraction of it
_SECANTS = 24  # most steps of the secant method
_ROOT = 1e-3  # of the eigenvalues at its start, below which the last one is zero
_NEAR_ROOT = 0.25  # the same, between two eigenvalues of opposite signs
_ROUND_OFF = 16 * float(np.finfo(float).eps)  # of |x| . |K| |x|, below which an eigenvalue is zero
LOCATING = NewtonSettings(tolerance=1e-15)
"""Settings of the solver that locates: equilibria down to round-off."""


@dataclass(frozen=True)
class SpecialPoint:
    """A limit point or a bifurcation.

    point : the equilibrium there.
    limit : whether the load turns back along the path; if not, another path crosses.
    first : whether the path is stable before it and unstable after it.
    mode : (n,) the motion that costs no energy, its largest entry one.
    """

    point: Equilibrium
    limit: bool
    first: bool
    mode: Vector

    def unframed(self, system: MechanicalSystem) -> SpecialPoint:
        """The same, its DOFs along the axes of space."""
        return replace(self, point=self.point.unframed(system), mode=system.frame.out(self.mode))

    @property
    def label(self) -> str:
        """Its kind in words."""
        return "limit point" if self.limit else "bifurcation"


@dataclass(frozen=True)
class _Place:
    """An equilibrium at a distance along the chord; rises : whether the load grows there along it."""

    s: float
    point: Equilibrium
    rises: bool

    def differs(self, other: _Place) -> bool:
        return self.point.negative != other.point.negative or self.rises != other.rises


class _Chord:
    """The path between two of its points, by the distance along their chord."""

    def __init__(
        self, system: MechanicalSystem, name: str, one: Equilibrium, other: Equilibrium
    ) -> None:
        self.solver, self.one = EquilibriumSolver(system, LOCATING, name), one
        way, rise = other.q - one.q, other.factor - one.factor
        self.length = float(np.hypot(step_size(system.space, one.q, way), rise))
        self.way, self.rise = way / self.length, rise / self.length
        self.ends = self._place(0.0, one), self._place(self.length, other)

    def _place(self, s: float, point: Equilibrium) -> _Place:
        slope = path_tangent(self.solver, point, (self.way, self.rise))[1]
        return _Place(s, point, bool(slope > 0))

    def at(self, s: float) -> _Place | None:
        """The equilibrium at a distance; None if there is none near the chord."""
        found = corrected(self.solver, self.one, self.way, self.rise, s, _STRAY * self.length)
        return None if found is None else self._place(s, found)

    def separated(self, low: _Place, high: _Place) -> list[tuple[_Place, _Place]]:
        """Short intervals in which something changes, in order."""
        if not low.differs(high):
            return []
        middle = self.at(low.s + _SPLIT * (high.s - low.s))
        several = abs(high.point.negative - low.point.negative) > 1
        if high.s - low.s <= (_FINEST if several else _WIDTH) or middle is None:
            return [(low, high)]
        return self.separated(low, middle) + self.separated(middle, high)

    def softest(self, point: Equilibrium, start: Vector) -> tuple[float, Vector, float]:
        """The eigenvalue nearest zero, its vector of unit length, by inverse iteration, and its round-off [N/m]."""
        system, tangent = self.solver.system, self.solver.tangent
        system.assemble(point.q, point.history, point.factor, tangent)
        tangent.constrain(system.constrained)
        found = Factors(tangent.band, tangent.skew).softest(start)
        if found is None:
            return 0.0, start, 0.0  # singular to the last bit
        value, x = found
        return value, x, _ROUND_OFF * float(np.abs(x) @ absolute_product(tangent.band, x))

    def root(self, low: _Place, high: _Place) -> tuple[Equilibrium, Vector] | None:
        """Where the eigenvalue nearest zero is zero between two places, and its vector; None if it is nowhere zero.

        Newton's method may fail next to the root, where the Hessian is nearly singular.  There the path is a straight
        line between the nearest places found, whose distance is far below the precision of the load.
        """
        constrained = self.solver.system.constrained
        start = np.where(constrained, 0.0, np.cos(1.7 * np.arange(constrained.size)))
        (a, x, rounding), (b, y, _) = self.softest(low.point, start), self.softest(high.point, start)
        size, left, right, halve = max(abs(a), abs(b)), low, high, False
        best, point, mode = (abs(a), low.point, x) if abs(a) < abs(b) else (abs(b), high.point, y)
        beyond = False
        for _ in range(_SECANTS):
            if best <= rounding:
                return point, mode
            share = a / (a - b) if a != b and not halve else 0.5
            if not 0 < share < 1:
                share = 0.5
            found = self.at(left.s + share * (right.s - left.s))
            if found is None:  # beside the root; from one side, then from the other
                aside, beyond = (1 + share) / 2 if beyond else share / 2, not beyond
                found = self.at(left.s + aside * (right.s - left.s))
            if found is None or found.s in (left.s, right.s):
                break
            value, y, _ = self.softest(found.point, mode)
            halve = abs(value) >= best  # round-off may move a point near the root along the other path
            if not halve:
                best, point, mode = abs(value), found.point, y
            passed = found.differs(low) if a * b > 0 else np.sign(value) != np.sign(a)
            if not passed:
                left, a = found, value
            else:
                right, b = found, value
        if a * b < 0 and best <= _NEAR_ROOT * size:
            return _between(left.point, right.point, a / (a - b)), mode
        return (point, mode) if best <= max(_ROOT * size, rounding) else None


def _between(one: Equilibrium, other: Equilibrium, share: float) -> Equilibrium:
    """The point at a share of the way from one equilibrium to another one close by."""
    return replace(
        one,
        q=one.q + share * (other.q - one.q),
        factor=one.factor + share * (other.factor - one.factor),
    )


def special_points(
    system: MechanicalSystem, name: str, before: Equilibrium, after: Equilibrium
) -> list[SpecialPoint]:
    """The special points between two neighbouring points of a path, in its order.

    None where another path only comes near, as in an imperfect body.  Several whose distance is round-off are one.
    """
    chord, found = _Chord(system, name, before, after), []
    for low, high in chord.separated(*chord.ends):
        root = chord.root(low, high)
        if root is not None:
            point, motion = root
            first = low.point.stable and not high.point.stable
            mode = motion / motion[np.abs(motion).argmax()]
            found.append(SpecialPoint(point, bool(low.rises != high.rises), first, mode))
    return found
