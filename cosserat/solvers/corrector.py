"""Corrections of equilibria within a plane normal to a path: in a compiled loop where that can take the body."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numba import njit

from cosserat.solvers.banded import Vector
from cosserat.solvers.climb import follow, keep_on_plane, move_on, respond
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver
from cosserat.solvers.many import Family, addresses, types
from cosserat.solvers.members import (
    BALANCED,
    COUNT,
    FACTOR,
    INDEFINITE,
    NEGATIVE,
    RESIDUAL,
    ROUNDING,
    STEPS,
    TOLERANCE,
    UNDEFINED,
    Around,
    Numbers,
    Plane,
)
from cosserat.solvers.system import History

_STATE = 7  # numbers of the state of a correction


@functools.cache
def _compiled() -> Callable[..., int]:
    """The loop, loaded only where it is needed, as that of `solvers.many`."""
    vector, matrix, number = types.float64[::1], types.float64[:, ::1], types.float64
    numbers = types.NamedTuple((types.uint8[::1], vector, vector, vector, types.int64), Numbers)
    around = types.NamedTuple(
        (vector, vector, matrix, vector, types.boolean[::1], matrix, vector), Around
    )
    numbers_of_plane = number, number, number, number, number, number
    plane = types.NamedTuple((vector, vector, *numbers_of_plane, types.int64), Plane)
    signature = types.int64(types.int64, types.int64, numbers, around, plane, types.UniTuple(vector, 4))
    (compiled,) = njit(signature, cache=True, nogil=True)(follow.py_func).overloads.values()
    loop: Callable[..., int] = compiled.entry_point
    return loop


@dataclass(frozen=True)
class Balance:
    """Balanced forces at q and a load factor.

    rounding : as in `Equilibrium`.  positive : whether the Hessian is.  rate : (n,) of the DOFs with the factor if so.
    """

    q: Vector
    factor: float
    rounding: float
    positive: bool
    rate: Vector


class Corrector:
    """Newton's method within planes for one solver."""

    def __init__(self, solver: EquilibriumSolver) -> None:
        solver.corrector = self
        self.solver, system = solver, solver.system
        n, width = solver.tangent.band.shape
        self.around = Around(
            solver.tangent.gradient,
            np.empty(n),
            solver.tangent.band,
            system.space.scale,
            system.constrained,
            np.zeros((n + width, width)),
            np.empty(n + width),
        )
        family, space, own = Family.of(system, solver.settings), system.space.compiled, system.internal
        self._loop = None
        if family is not None and space is not None:
            np.negative(system.dead_load, out=solver.tangent.load_gradient)
            rate = system.rate(0.0, solver.tangent)
            self.around.rate[:] = rate
            origin = np.zeros(n) if own.origin is None else own.origin
            numbers = Numbers(own.data, origin, space.placed, -rate, len(own.terms))
            self._kernels = addresses(family.kernel, family.space)
            where = (kernel.number for kernel in self._kernels)
            self._loop = functools.partial(_compiled(), *where, numbers, self.around)

    def balanced(self, q: Vector, plane: Plane, history: History) -> Balance | None:
        """The balance within a plane from q; None where there is none."""
        solver, space, state = self.solver, self.solver.system.space, np.zeros(_STATE)
        state[FACTOR], state[RESIDUAL] = plane.factor + plane.ds * plane.slope, np.inf
        step, rate, outcome = np.empty_like(q), np.empty_like(q), STEPS
        while outcome == STEPS and state[COUNT] < plane.most:
            q, outcome = self._advanced(q, plane, history, (step, rate, state))
            if outcome == INDEFINITE:
                both = solver.tangent.solve(np.column_stack([step, rate]))
                if both is None:
                    break
                outcome, (step, rate) = STEPS, both.T.copy()
                keep_on_plane(q, plane, step, rate, state)
            if outcome == STEPS and state[COUNT] < plane.most:
                move_on(q, step, state, min(1.0, space.max_step_fraction(q, step)))
        solver.iterations += int(state[COUNT])
        if outcome != BALANCED:
            return None
        solver.residual, solver.tolerance = float(state[RESIDUAL]), float(state[TOLERANCE])
        return Balance(q, float(state[FACTOR]), float(state[ROUNDING]), not state[NEGATIVE], rate)

    def _advanced(
        self, q: Vector, plane: Plane, history: History, answer: tuple[Vector, Vector, Vector]
    ) -> tuple[Vector, int]:
        """q and the outcome of one step, or of many of the compiled loop; the answer is overwritten."""
        system, tangent = self.solver.system, self.solver.tangent
        _, _, state = answer
        if self._loop is not None:
            outcome = self._loop(plane, (q, *answer))
        else:
            factor = float(state[FACTOR])
            if system.constraints.moving:
                q = system.prescribe(q, factor)
            if not system.assemble(q, history, factor, tangent):
                return q, UNDEFINED
            self.around.rate[:] = system.rate(factor, tangent)
            outcome = respond(self.around, q, plane, *answer, not tangent.skew.size)
        if state[NEGATIVE]:
            tangent.constrain(system.constrained)
        return q, outcome

    def accepted(self, found: Balance, history: History) -> Equilibrium:
        """The equilibrium of the balance found last, whose rate is then known if its Hessian is positive."""
        point = self.solver.accepted(
            found.q, found.factor, history, found.rounding, positive=found.positive
        )
        if found.positive and point.history is history:
            self.solver.know_rate(point, found.rate)
        return point
