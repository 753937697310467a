"""The equilibrium under a growing load, by load increments.

A body that `solvers.climb` can take is left to its compiled loop.  Otherwise, and where the loop is in doubt,
increments continue while the path before them predicts their end and the body stays stable.  After that,
`solvers.continuation` traces the path.
"""

from __future__ import annotations

import numpy as np

from cosserat.solvers.arcs import rate_with_load
from cosserat.solvers.climb import MAX_ROTATION, NEGLIGIBLE_ROTATION, PREDICTION_TOLERANCE
from cosserat.solvers.continuation import ArcLengthSettings, trace_path
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver
from cosserat.solvers.many import climbed
from cosserat.solvers.system import Fields, MechanicalSystem

_INTERMEDIATE_TOLERANCE = 1e-8  # unbalanced fraction of the loads before the last increment
_MAX_ARCS = 10_000  # arcs on the way to one equilibrium
_MAX_CUTBACKS = 4  # rejected increments at one factor before the path is traced


def solve_full_load(solver: EquilibriumSolver, *, stay: bool = False) -> Equilibrium:
    """The equilibrium at the load factor one, reached as the load grows from zero.

    stay : on its path where symmetry would let it, also beyond its loss of stability.

    Raises
    ------
    NotConvergedError : no path leads there, or, unless it stays, to no stable equilibrium; the last point is its
        `state`.
    """
    found = climbed(solver)
    if found is not None:
        return found
    with np.errstate(
        over="ignore", invalid="ignore"
    ):  # non-finite values are rejected below without a warning
        point = unloaded(solver)
        solver.check_round_off(point)
        point = _by_increments(solver, point)
        if point.factor == 1.0:
            return point
        point = solver.correct(point.q, point.factor, point.history) or point
        arc = ArcLengthSettings(
            first=0.05,
            longest=0.3,
            count=_MAX_ARCS,
            until=1.0,
            limit=3.0,
            branches=0 if stay else _MAX_ARCS,
        )
        last = point
        for last in trace_path(solver, point, arc):
            solver.passed_limit_load |= not (last.stable or stay)
    if last.factor != 1.0:
        raise solver.failure(point.factor, 1.0, last)
    if not (last.stable or stay):
        raise solver.stopped(f"the load leads to an unstable equilibrium; {solver.limit_remedy}", last)
    return last


def unloaded(solver: EquilibriumSolver) -> Equilibrium:
    """The equilibrium from which the loads grow."""
    point = solver.correct(solver.system.start, 0.0, solver.system.history)
    if point is None:
        raise solver.failure(0.0, 0.0, None)
    return point


def without_load(system: MechanicalSystem) -> Equilibrium:
    """The reference of a body without loads as an equilibrium, which it is also where rigid motions are free."""
    at_rest, still = system.space.reference, np.zeros_like(system.space.reference)
    return Equilibrium(at_rest, 0.0, system.history, still, 0, 0.0, 0.0, 0.0, 0)


def _by_increments(solver: EquilibriumSolver, point: Equilibrium) -> Equilibrium:
    """The last equilibrium that predictable increments reach."""
    system, space, refused, wall = solver.system, solver.system.space, 0, 0.0
    longest = min(1.0 / solver.settings.load_increments, system.constraints.max_increment)
    increment = longest
    before: tuple[float, Fields] | None = None
    bend: Fields = np.zeros(())
    while point.factor < 1.0 and point.stable and refused < _MAX_CUTBACKS:
        velocity = rate_with_load(solver, point)
        if velocity is None:
            break
        rates = space.rates(point.q, velocity)
        if before is not None:
            bend = (rates - before[1]) / (point.factor - before[0])
        fastest = float(np.abs(rates).max())
        increment = min(increment, longest, MAX_ROTATION / fastest if fastest > 0 else longest)
        goal = point.factor + increment if point.factor + 1.001 * increment < 1.0 else 1.0
        step = goal - point.factor
        moved = step * (rates + step / 2 * bend)
        found = solver.correct(
            system.predicted(point.q, moved, goal),
            goal,
            point.history,
            fraction=None if goal == 1.0 else _INTERMEDIATE_TOLERANCE,
        )
        off = np.inf
        if found is not None and found.stable:
            turned = space.rates((point.q + found.q) / 2, found.q - point.q)
            off = float(np.abs(turned - moved).max()) / max(
                float(np.abs(turned).max()), NEGLIGIBLE_ROTATION
            )
        if found is None or off > PREDICTION_TOLERANCE:
            refused, wall = refused + 1, goal
            solver.cutbacks += 1
            increment = step / 2
            continue
        before, point = (point.factor, rates), found
        if point.factor >= wall:  # otherwise ever shorter increments would approach a bifurcation
            refused = 0
        increment *= float(np.clip(np.sqrt(PREDICTION_TOLERANCE / 2 / max(off, 1e-3)), 0.5, 2.0))
    return point
