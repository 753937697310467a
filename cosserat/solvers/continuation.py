"""The equilibrium path of a slender elastic body as its load grows, past limit points and bifurcations.

Continuation by pseudo-arclength (Keller 1977; Crisfield 1991, chapter 9).  An arc is halved if its end
is too far from the tangent or the path turns too much.  So the solver does not jump to another path nearby.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import exp, log

import numpy as np

from cosserat.errors import NotConvergedError
from cosserat.solvers.arcs import corrected, cosine, distance, path_tangent, step_size
from cosserat.solvers.banded import Vector
from cosserat.solvers.climb import next_arc
from cosserat.solvers.corrector import LEAST_COSINE, TANGENT_TOLERANCE, Corrector
from cosserat.solvers.equilibrium import SMALLEST, Equilibrium, EquilibriumSolver
from cosserat.solvers.hidden import Stop, Watch, Way

_BISECTION_TOLERANCE = 0.02  # fraction of the first arc to which a bifurcation is located
_FACTOR_TOLERANCE = 0.005  # fraction of the load factor to which a bifurcation is located
_FINEST_BISECTION = 0.001  # fraction of the first arc at which bisection ends
_LARGEST_BEND = 0.25  # of a chord, between points of a path
_LARGEST_LOG = 700.0  # whose power is finite
_RETURN_DISTANCE = 10.0  # multiple of the first arc after which a branch may return to its start


@dataclass(frozen=True)
class ArcLengthSettings:
    """Settings of a path: length of the first arc and of the longest, number of arcs, and where to stop.

    A length combines the largest change of the DOFs, as a fraction of the step limit of the body, with the change of
    the load factor.  until : factor at which the path ends.  limit : factor beyond which it fails.
    branches : how often to switch branches where symmetry would let the body stay on its path.
    """

    first: float
    longest: float
    count: int
    until: float
    limit: float
    branches: int


def trace_path(
    solver: EquilibriumSolver, point: Equilibrium, arc: ArcLengthSettings
) -> Iterator[Equilibrium]:
    """Points along the path from a first one, by pseudo-arclength, until the load factor passes `until`.

    If an eigenvalue changes sign and the load does not turn back, another path crosses or comes near.  Bisection
    locates the crossing, and the path continues along the softest motion there.  If symmetry would let the path stay,
    it stays after `branches` switches.

    Raises
    ------
    NotConvergedError : no further point, or the factor exceeds the limit, or a branch returns to its start;
        the last point is its `state`.
    """
    yield point
    space, origin, went_away, left = solver.system.space, None, False, 0
    direction = path_tangent(solver, point, None)
    turned: bool | None
    ds = arc.first
    for number in range(arc.count):
        before = solver.iterations
        onward = arc.count - number
        (found, ahead, ds), across = _next_or_bifurcation(solver, point, direction, ds, arc, onward)
        if (
            _passes_limit_point(point, direction, found, ahead, ds, arc.until)
            and ds > _BISECTION_TOLERANCE * arc.first
        ):
            ds /= 2
            continue
        effort, turned = solver.iterations - before, direction[1] * ahead[1] < 0
        if across is not None:
            motion, decided = solver.buckling_direction(*across)
            if decided or left < arc.branches:
                solver.note_crossing(*across)
                solver.branch_switches += 1
                if not decided:
                    left += 1
                    solver.undecided_factors.append(across[0].factor)
                if across[0] is not point:
                    yield across[0]
                origin = point = across[0]
                found, direction, ds = _switch_branch(solver, point, motion, arc)
                ahead, turned = path_tangent(solver, found, direction), None
        if (found.factor - arc.until) * (point.factor - arc.until) <= 0:
            last = _at_end(solver, point, found, arc.until)
            if last.negative != point.negative and ds > _BISECTION_TOLERANCE * arc.first:
                ds /= 2  # the point lies beyond a limit point
                continue
            solver.note_crossing(point, last, turned=turned)
            yield last
            return
        _check_limit(solver, point, found, arc)
        if origin is not None:
            away = distance(space, origin, found)
            went_away = went_away or away > _RETURN_DISTANCE * arc.first
            if went_away and away < ds:
                raise _returned(solver, origin, point)
        solver.note_crossing(point, found, turned=turned)
        yield found
        point, direction = found, ahead
        ds = next_arc(ds, effort, arc.longest)


def _returned(solver: EquilibriumSolver, origin: Equilibrium, last: Equilibrium) -> NotConvergedError:
    """The error of a branch that returns to its start."""
    return solver.stopped(
        f"the path returns to {origin.factor:.4g} of the load, where it branched off: no stable path continues "
        "from there, and under more load a body jumps; reduce the load, add a small one that breaks the symmetry, or "
        "follow the unstable path with kind = 'rod path' and arc.branch = 'stay'",
        last,
    )


def _check_limit(
    solver: EquilibriumSolver, point: Equilibrium, found: Equilibrium, arc: ArcLengthSettings
) -> None:
    """Raise NotConvergedError if the path exceeds its limit."""
    if abs(found.factor) > arc.limit:
        raise solver.stopped(
            f"the path goes to {found.factor:.4g} of the load, beyond the limit of {arc.limit:g}; "
            + solver.limit_remedy,
            point,
        )


def _next_or_bifurcation(
    solver: EquilibriumSolver,
    point: Equilibrium,
    direction: tuple[Vector, float],
    ds: float,
    arc: ArcLengthSettings,
    most: int,
) -> tuple[tuple[Equilibrium, tuple[Vector, float], float], tuple[Equilibrium, Equilibrium] | None]:
    """The next point, direction and arc, and the points on both sides of a crossing within the arc, if any.

    Raises
    ------
    NotConvergedError : there is no next point.
    """
    further = _next(solver, point, direction, ds, arc, most)
    if further is None:
        across = _sharp_turn(solver, point, direction, arc)
        if across is None:
            raise solver.failure(point.factor, point.factor + direction[1] * ds, point)
        return (across[1], direction, ds), across
    found, ahead, ds = further
    between = _watch(solver).between(
        Stop(point, direction), Stop(found, ahead), ds, lambda s: _stop(solver, point, direction, s, ds)
    )
    if between is not None:
        further = _next(solver, point, direction, between, arc, most) or further
        found, ahead, ds = further
    crosses = found.negative != point.negative and ahead[1] * direction[1] > 0
    if not crosses:
        return further, None
    across = _locate_bifurcation(solver, point, direction, found, ds, arc)
    if (across[0].factor - arc.until) * (
        point.factor - arc.until
    ) < 0:  # the path ends before the crossing
        return (across[0], ahead, ds), None
    return further, across


def _watch(solver: EquilibriumSolver) -> Watch:
    solver.watch = solver.watch or Watch(solver)
    return solver.watch


def _stop(
    solver: EquilibriumSolver, point: Equilibrium, direction: Way, s: float, ds: float
) -> Stop | None:
    """The path at a distance along an arc of length ds; None if there is none near it."""
    found = corrected(solver, point, *direction, s, TANGENT_TOLERANCE * ds)
    return None if found is None else Stop(found, path_tangent(solver, found, direction))


def _at_end(
    solver: EquilibriumSolver, point: Equilibrium, found: Equilibrium, until: float
) -> Equilibrium:
    """The equilibrium at the end of the path, between two points of it; the second point if there is none.

    It is sought from the cubic in the load factor through both, with their rates, where that is near the chord.
    """
    span, chord = found.factor - point.factor, found.q - point.q
    s = (until - point.factor) / span
    start = point.q + s * chord
    if point.rate is not None and found.rate is not None:
        leave, arrive = span * point.rate - chord, span * found.rate - chord
        bend = s * (1 - s) * ((1 - s) * leave - s * arrive)
        if np.abs(bend).max() < _LARGEST_BEND * np.abs(chord).max():
            start += bend
    last = solver.correct(start, until, point.history)
    return found if last is None else last


def _next(
    solver: EquilibriumSolver,
    point: Equilibrium,
    direction: tuple[Vector, float],
    ds: float,
    arc: ArcLengthSettings,
    most: int,
) -> tuple[Equilibrium, tuple[Vector, float], float] | None:
    """The next point along a direction, its direction and its arc; None if there is none.

    most : arcs that are left.
    """
    corrector = solver.corrector or Corrector(solver)
    if corrector.compiled:
        return corrector.onward(point, direction, ds, arc, most)
    while ds > SMALLEST * arc.first:
        found = corrected(solver, point, *direction, ds, TANGENT_TOLERANCE * ds)
        if found is not None:
            ahead = path_tangent(solver, found, direction)
            if cosine(direction, ahead) > LEAST_COSINE:
                return found, ahead, ds
        ds /= 2
    return None


def _sharp_turn(
    solver: EquilibriumSolver,
    point: Equilibrium,
    direction: tuple[Vector, float],
    arc: ArcLengthSettings,
) -> tuple[Equilibrium, Equilibrium] | None:
    """A stable point beside a turn too sharp for arcs, and an unstable one straight ahead."""
    beyond = point.factor + _BISECTION_TOLERANCE * arc.first * np.sign(direction[1])
    found = solver.correct(point.q, beyond, point.history)
    return (point, found) if point.stable and found is not None and not found.stable else None


def _passes_limit_point(
    point: Equilibrium,
    direction: tuple[Vector, float],
    found: Equilibrium,
    ahead: tuple[Vector, float],
    ds: float,
    until: float,
) -> bool:
    """Whether the load factor turns back just after it has passed `until` within an arc, by Hermite's cubic."""
    if direction[1] * ahead[1] >= 0 or (found.factor - until) * (point.factor - until) <= 0:
        return False
    s = np.linspace(0.0, 1.0, 33)
    rise = point.factor * (1 - s) ** 2 * (1 + 2 * s) + found.factor * s**2 * (3 - 2 * s)
    bend = ds * s * (1 - s) * (direction[1] * (1 - s) - ahead[1] * s)
    left = (until - rise - bend) * np.sign(until - point.factor)
    return bool((left <= _BISECTION_TOLERANCE * abs(until)).any())


def _locate_bifurcation(
    solver: EquilibriumSolver,
    point: Equilibrium,
    direction: tuple[Vector, float],
    found: Equilibrium,
    ds: float,
    arc: ArcLengthSettings,
) -> tuple[Equilibrium, Equilibrium]:
    """The points just before and just after the first change of sign of an eigenvalue within an arc.

    They are the ends of the part that bisection of the arc leads to; the determinant tells which parts are worth a try.
    found : the end of the arc.
    """
    parts, low, before, after = 1, 0, point, found
    while ds / parts > _BISECTION_TOLERANCE * arc.first:
        parts *= 2
    high, runs = parts, 0  # runs : how often the same end has moved in turn, negative for the first
    while high - low > 1 or (_wide(before, after) and ds > _FINEST_BISECTION * arc.first * parts):
        if high - low == 1:
            parts, low, high = 2 * parts, 2 * low, 2 * high
        middle = low + _share(before, after, high - low, runs)
        between = corrected(solver, point, *direction, middle * (ds / parts), TANGENT_TOLERANCE * ds)
        if between is not None and between.negative != point.negative:
            high, after, runs = middle, between, max(runs, 0) + 1
        elif between is not None and _goes_on(solver, before, between):
            low, before, runs = middle, between, min(runs, 0) - 1
        else:  # no equilibrium, or a stable one beside the crossing, perhaps on the other side
            high, after = middle, replace(after, log_determinant=None)
    return before, after


def _share(before: Equilibrium, after: Equilibrium, parts: int, runs: int) -> int:
    """How many of some parts between two points lie before the zero of the determinant, at least one and not all.

    By the Illinois rule: the value at an end counts half after the other end has moved twice.  A half, where the values
    are not known or have no zero between them.
    """
    one, other = before.log_determinant, after.log_determinant
    if one is None or other is None or abs(after.negative - before.negative) != 1:
        return parts // 2
    stays = max(abs(runs) - 1, 0) * log(2.0)
    rise = other - one + (stays if runs > 0 else -stays)
    return min(max(round(parts / (1.0 + exp(min(rise, _LARGEST_LOG)))), 1), parts - 1)


def _wide(before: Equilibrium, after: Equilibrium) -> bool:
    """Whether the change of load between two points can reverse the pull to one side."""
    return abs(after.factor - before.factor) > _FACTOR_TOLERANCE * abs(before.factor)


def _goes_on(solver: EquilibriumSolver, before: Equilibrium, found: Equilibrium) -> bool:
    """Whether a point lies ahead of the one before it."""
    chord = found.q - before.q, found.factor - before.factor
    return cosine(path_tangent(solver, before, chord), chord) > LEAST_COSINE


def _switch_branch(
    solver: EquilibriumSolver, point: Equilibrium, motion: Vector, arc: ArcLengthSettings
) -> tuple[Equilibrium, tuple[Vector, float], float]:
    """A point on the branch that leaves this one along a motion, with its direction and arc.

    Raises
    ------
    NotConvergedError : there is none.
    """
    space, ds = solver.system.space, arc.first
    while ds > SMALLEST * arc.first:
        found = corrected(solver, point, motion, 0.0, ds, arc.first)
        if found is not None and step_size(space, point.q, found.q - point.q) > ds / 4:
            _watch(solver).passed(point, found, ds)
            size = distance(space, found, point)
            away = (found.q - point.q) / size, (found.factor - point.factor) / size
            return found, away, ds
        ds /= 2
    raise solver.failure(point.factor, point.factor, point)
