"""Corrections of equilibria within planes normal to a path: in a compiled loop where that can take the body."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numba import njit

from cosserat.solvers.banded import Vector
from cosserat.solvers.climb import follow, move_on, respond
from cosserat.solvers.equilibrium import SMALLEST, Equilibrium, EquilibriumSolver
from cosserat.solvers.many import Family, addresses, types
from cosserat.solvers.members import (
    BALANCED,
    COUNT,
    FACTOR,
    LENGTH,
    LOG,
    NEGATIVE,
    RESIDUAL,
    ROUNDING,
    SINGULAR,
    SLOPE,
    SPENT,
    STATE,
    STEPS,
    TOLERANCE,
    TRIED,
    UNDEFINED,
    Arcs,
    Around,
    Found,
    Numbers,
    Plane,
)
from cosserat.solvers.system import History

TANGENT_TOLERANCE = 0.2
"""Largest distance of a point from the tangent, as a fraction of the arc."""
LEAST_COSINE = 0.9
"""Least cosine of the turn of a path within an arc."""
_MOST_AHEAD = 32  # arcs at once
_MOST_NUMBERS = 2**14  # DOFs of the ends of arcs at once, after which a run is heard again
_ANY_TURN = -2.0  # below every cosine


class Bounds(Protocol):
    """Settings of arcs, see `solvers.continuation.ArcLengthSettings`."""

    @property
    def first(self) -> float:
        """Length of the first arc."""

    @property
    def longest(self) -> float:
        """Length of the longest arc."""

    @property
    def until(self) -> float:
        """Load factor at which the path ends."""

    @property
    def limit(self) -> float:
        """Load factor beyond which it fails."""


@functools.cache
def _compiled() -> Callable[..., int]:
    """The loop, loaded only where it is needed, as that of `solvers.many`."""
    vector, matrix, number, whole = (
        types.float64[::1],
        types.float64[:, ::1],
        types.float64,
        types.int64,
    )
    numbers = types.NamedTuple((types.uint8[::1], vector, vector, vector, whole), Numbers)
    held, pivots = types.boolean[::1], types.int64[::1]
    around = types.NamedTuple(
        (vector, vector, matrix, matrix, vector, held, matrix, matrix, matrix, pivots), Around
    )
    arcs = types.NamedTuple((number, number, whole, *(number,) * (len(Arcs._fields) - 3)), Arcs)
    found = types.NamedTuple((*(matrix,) * (len(Found._fields) - 1), vector), Found)
    signature = whole(whole, whole, numbers, around, arcs, types.UniTuple(vector, 2), found)
    (compiled,) = njit(signature, cache=True, nogil=True)(follow.py_func).overloads.values()
    loop: Callable[..., int] = compiled.entry_point
    return loop


@dataclass(frozen=True)
class Balance:
    """Balanced forces at q and a load factor.

    rounding, negative, log : as in `Equilibrium`, log of the determinant.  rate : (n,) of the DOFs with the factor;
    None if the Hessian is singular.
    """

    q: Vector
    factor: float
    rounding: float
    negative: int
    rate: Vector | None
    log: float


class _Ahead:
    """Arcs that are found, the number of the next one, and the point from which it goes."""

    def __init__(self, found: Found, count: int) -> None:
        self.found, self.next = found, 0
        self.states: list[list[float]] = found.state[:count].tolist()
        self.last: Equilibrium | None = None

    def goes_on(self, point: Equilibrium, ds: float) -> bool:
        """Whether the next arc goes from this point with this length."""
        known = self.last is point and self.next < len(self.states)
        return known and self.states[self.next][TRIED] == ds


_NOTHING_AHEAD = _Ahead(Found.empty(0, 0), 0)


class Corrector:
    """Newton's method within planes for one solver."""

    def __init__(self, solver: EquilibriumSolver) -> None:
        solver.corrector = self
        self.solver, system, tangent = solver, solver.system, solver.tangent
        n, width = tangent.band.shape
        self.around = Around(
            tangent.gradient,
            np.empty(n),
            tangent.band,
            tangent.skew,
            system.space.scale,
            system.constrained,
            np.zeros((n + width, width)),
            np.empty((2, n + width)),
            np.empty((n, 3 * width - 2)),
            np.empty(n, dtype=np.int64),
        )
        family, space, own = Family.of(system, solver.settings), system.space.compiled, system.internal
        self._loop: Callable[..., int] | None = None
        self._ahead = _NOTHING_AHEAD
        if family is not None and space is not None:
            np.negative(system.dead_load, out=tangent.load_gradient)
            rate = system.rate(0.0, tangent)
            self.around.rate[:] = rate
            origin = np.zeros(n) if own.origin is None else own.origin
            numbers = Numbers(own.data, origin, space.placed, -rate, len(own.terms))
            self._family = family  # which owns the kernels
            where = addresses(family.kernel, family.space)
            self._loop = functools.partial(_compiled(), *where, numbers, self.around)

    def _follow(self, arcs: Arcs, start: tuple[Vector, Vector], found: Found) -> int:
        assert self._loop is not None
        return self._loop(arcs, start, found)

    @property
    def compiled(self) -> bool:
        """Whether the compiled loop takes the body."""
        return self._loop is not None

    def alone(
        self, point: Equilibrium, direction: tuple[Vector, float], ds: float, stray: float
    ) -> Equilibrium | None:
        """By the compiled loop the equilibrium at a distance along a direction; None if it is farther than `stray`."""
        found = Found.empty(1, point.q.size)
        arcs = self._arcs(point, direction[1], ds)._replace(
            smallest=0.75 * ds, stray=stray / ds, cosine=_ANY_TURN
        )
        count = self._follow(arcs, (point.q, direction[0]), found)
        self.solver.iterations += int(found.lost[0])
        return self._end(found, 0, found.state[0].tolist(), point.history) if count else None

    def onward(
        self,
        point: Equilibrium,
        direction: tuple[Vector, float],
        ds: float,
        bounds: Bounds,
        most: int,
    ) -> tuple[Equilibrium, tuple[Vector, float], float] | None:
        """By the compiled loop the next point along a direction, its direction and its arc; None if there is none.

        Further arcs are kept for the next calls.  most : how many there may be.
        """
        ahead = self._ahead
        if not ahead.goes_on(point, ds):
            ahead = self._look_ahead(point, direction, ds, bounds, most)
            if not ahead.states:
                self.solver.iterations += int(ahead.found.lost[0])
                return None
        k, state = ahead.next, ahead.states[ahead.next]
        self.solver.iterations += int(state[SPENT])
        end = self._end(ahead.found, k, state, point.history)
        ahead.last, ahead.next = end, k + 1
        return end, (ahead.found.direction[k], state[SLOPE]), state[LENGTH]

    def _look_ahead(
        self,
        point: Equilibrium,
        direction: tuple[Vector, float],
        ds: float,
        bounds: Bounds,
        most: int,
    ) -> _Ahead:
        """The arcs from a point, until something happens to the path."""
        arcs = self._arcs(point, direction[1], ds)._replace(
            smallest=SMALLEST * bounds.first,
            longest=bounds.longest,
            until=bounds.until,
            limit=bounds.limit,
        )
        n = point.q.size
        found = Found.empty(max(1, min(most, _MOST_AHEAD, _MOST_NUMBERS // n)), n)
        self._ahead = _Ahead(found, self._follow(arcs, (point.q, direction[0]), found))
        return self._ahead

    def _arcs(self, point: Equilibrium, slope: float, ds: float) -> Arcs:
        """Arcs from a point without bounds."""
        return Arcs(
            point.factor,
            slope,
            point.negative,
            ds,
            smallest=0.0,
            longest=np.inf,
            stray=TANGENT_TOLERANCE,
            cosine=LEAST_COSINE,
            until=np.inf,
            limit=np.inf,
            load=self.solver.system.load_sizes[0],
            tolerance=self.solver.settings.tolerance,
        )

    def _end(self, found: Found, k: int, state: list[float], history: History) -> Equilibrium:
        """The end of an arc, and what the last attempt of the solver has left unbalanced."""
        solver = self.solver
        solver.residual, solver.tolerance = state[RESIDUAL], state[TOLERANCE]
        return Equilibrium(
            found.q[k],
            state[FACTOR],
            history,
            found.reaction[k],
            solver.iterations,
            solver.residual,
            solver.tolerance,
            state[ROUNDING],
            int(state[NEGATIVE]),
            None if state[SINGULAR] else found.rate[k],
            state[LOG],
        )

    def balanced(self, q: Vector, plane: Plane, history: History) -> Balance | None:
        """Of any body the balance within a plane from q; None where there is none."""
        solver, system, state = self.solver, self.solver.system, np.zeros(STATE)
        state[FACTOR], state[RESIDUAL] = plane.factor + plane.ds * plane.slope, np.inf
        step, rate, outcome = np.empty_like(q), np.empty_like(q), STEPS
        while outcome == STEPS and state[COUNT] < plane.most:
            factor = float(state[FACTOR])
            if system.constraints.moving:
                q = system.prescribe(q, factor)
            if not system.assemble(q, history, factor, solver.tangent):
                outcome = UNDEFINED
                break
            self.around.rate[:] = system.rate(factor, solver.tangent)
            outcome = respond(self.around, q, plane, step, rate, state)
            if outcome == STEPS:
                move_on(q, step, state, min(1.0, system.space.max_step_fraction(q, step)))
        solver.iterations += int(state[COUNT])
        if outcome != BALANCED:
            return None
        solver.residual, solver.tolerance = float(state[RESIDUAL]), float(state[TOLERANCE])
        known = None if state[SINGULAR] else rate
        about = float(state[FACTOR]), float(state[ROUNDING]), int(state[NEGATIVE])
        return Balance(q, *about, known, float(state[LOG]))
