"""The compiled loop of `solvers.climb` for bodies of the solvers: which it can take, and how it is called."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numba import types as numba_types
from numba.core.dispatcher import Dispatcher
from numba.experimental import function_type
from numpy.typing import NDArray

from cosserat.solvers.banded import Mask
from cosserat.solvers.climb import climb_all, rates_all
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver, NewtonSettings
from cosserat.solvers.heartbeat import beat
from cosserat.solvers.members import (
    REACHED,
    SPACE_KERNEL,
    Answers,
    Limits,
    Members,
    Rates,
    Ways,
)
from cosserat.solvers.potential import KERNEL
from cosserat.solvers.system import MechanicalSystem

Fields = NDArray[np.float64]
address: Any = function_type._get_wrapper_address  # what a compiled function would look up at every call
_MOST_WORK = 2e5
"""Most DOFs times load increments: the loop takes seconds then, in which it cannot be stopped."""
types: Any = numba_types  # which says nothing of its own types


_MATRIX, _BYTES, _WHOLE = types.float64[:, ::1], types.uint8[:, ::1], types.int64
_NUMBERS = types.int64[::1]
_MEMBERS = types.NamedTuple((_BYTES, *(_MATRIX,) * (len(Members._fields) - 1)), Members)


def _loaded(function: Dispatcher, *arguments: Any) -> Callable[..., int]:
    """A loop over members; called directly, as `solvers.implicit` does."""
    signature = _WHOLE(_WHOLE, _WHOLE, _MEMBERS, types.boolean[::1], *arguments)
    (compiled,) = njit(signature, cache=True, nogil=True)(function.py_func).overloads.values()
    loop: Callable[..., int] = compiled.entry_point
    return loop


@functools.cache
def _climbing() -> Callable[..., int]:
    """The loop to equilibria, loaded only where it is needed."""
    limits = types.NamedTuple((types.float64, _WHOLE, types.float64, _WHOLE, _WHOLE, _WHOLE), Limits)
    answers = types.NamedTuple((_MATRIX, _MATRIX, _MATRIX, types.int64[:, ::1], _NUMBERS), Answers)
    return _loaded(climb_all, limits, answers)


@functools.cache
def _moving() -> Callable[..., int]:
    """The loop to their rates, likewise."""
    ways = types.NamedTuple((_MATRIX, _WHOLE[:, ::1], types.boolean[::1], _MATRIX, _MATRIX), Ways)
    rates = types.NamedTuple((_MATRIX, _MATRIX, types.float64[::1], _NUMBERS), Rates)
    return _loaded(rates_all, _WHOLE, _WHOLE, _MATRIX, ways, rates)


@functools.lru_cache(maxsize=64)
def addresses(kernel: Callable[..., float], space: Callable[..., float]) -> tuple[int, int]:
    """Where the code of the two kernels of a family is; to look it up at every call would take longer than a solve.

    It is there as long as the functions are.
    """
    return address(kernel, KERNEL), address(space, SPACE_KERNEL)


@dataclass(frozen=True)
class Family:
    """What bodies that differ in numbers alone have in common.

    kernel : of their potential, see `solvers.potential.KERNEL`.  terms : how many parts its energy has.
    half_bandwidth : of its Hessian.  space : `solvers.members.SPACE_KERNEL`.  parts : how many it turns.
    constrained : (n,) the DOFs that stay where they are.  settings : of Newton's method.
    """

    kernel: Callable[..., float]
    terms: int
    half_bandwidth: int
    space: Callable[..., float]
    parts: int
    constrained: Mask
    settings: NewtonSettings

    @classmethod
    def of(cls, system: MechanicalSystem, settings: NewtonSettings) -> Family | None:
        """That of one body; None where the loop cannot take it."""
        own, space, size = system.internal, system.space.compiled, system.constrained.size
        if space is None or not system.simple or size * settings.load_increments > _MOST_WORK:
            return None
        kernel, _, parts = space
        return cls(
            own.evaluate,
            len(own.terms),
            own.half_bandwidth,
            kernel,
            parts,
            system.constrained,
            settings,
        )

    def solve(self, members: Members) -> Answers:
        """The equilibria of all members, without the interpreter: other threads go on meanwhile."""
        answers = Answers.empty(*members.dead.shape)
        longest = 1.0 / self.settings.load_increments
        limits = Limits(
            self.settings.tolerance,
            self.settings.max_iterations,
            longest,
            self.terms,
            self.parts,
            self.half_bandwidth + 1,
        )
        _climbing()(*addresses(self.kernel, self.space), members, self.constrained, limits, answers)
        return answers

    def rates(self, members: Members, q: Fields, ways: Ways) -> Rates:
        """How equilibria q (M, n) of members move with parameters, likewise."""
        found = Rates.empty(q.shape[0], ways.softens.size, q.shape[1])
        kernels = addresses(self.kernel, self.space)
        width = self.half_bandwidth + 1
        _moving()(*kernels, members, self.constrained, width, self.terms, q, ways, found)
        return found


def climbed(solver: EquilibriumSolver) -> Equilibrium | None:
    """The equilibrium under the full load by the compiled loop; None where it cannot take the body, or leaves it."""
    system = solver.system
    family = Family.of(system, solver.settings)
    if family is None:
        return None
    found = family.solve(system.member)
    if found.status[0] != REACHED:
        return None
    (forces,), (counts,) = found.forces.tolist(), found.counts.tolist()
    (q,), (reaction,) = found.q, found.reaction
    solver.residual, solver.tolerance, rounding = forces
    iterations, cutbacks = counts
    solver.iterations += iterations
    solver.cutbacks += cutbacks
    beat(1.0, solver.iterations)
    about = (solver.iterations, solver.residual, solver.tolerance, rounding)
    return Equilibrium(q, 1.0, system.history, reaction, *about, negative=0)
