"""The equilibria that a slender elastic body goes through as its load grows, past limit points and branches.

`follow` takes every point of the path by pseudo-arclength (Keller 1977; Crisfield 1991, chapter 9).  An arc is taken
anew, half as long, where its end lies off the tangent, or where the path turns, more than a share of it: so no other
path that comes near is taken for this.  `lead` wants the end alone.  It takes increments of the load as long as the
tangent foretells them and the body stays stable, and follows the path from where it does not.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cosserat.solvers.banded import Vector, hold, negative_eigenvalues, solve_positive
from cosserat.solvers.equilibrium import SMALLEST, Climb, Fields, Loaded, Point, stalled
from cosserat.solvers.indefinite import solve_any

_CLOSE = 0.02  # share of the first arc to which a crossing of paths is closed in on
_NEAR = 0.005  # share of the factor to which a crossing is closed in on
_FINEST = 0.001  # share of the first arc at which that ends
_STRAY = 0.2  # share of an arc by which a point may lie off the tangent
_BEND = 0.9  # least cosine of the angle by which a path may turn within an arc
_AWAY = 10.0  # multiple of the first arc from which on a branch can come back to its beginning
_FORETOLD = 0.3  # share of an increment by which its end may lie off what is foretold
_STILL = 1e-5  # turning below which an increment needs no foretelling [rad]
_ON_THE_WAY = 1e-8  # share of the loads that may be left unbalanced before the end
_TURN = 0.7  # most that a part may turn in an increment [rad]
_MOST = 10_000  # arcs on the way to one equilibrium
_TRIES = 4  # increments refused short of the same factor before the path is followed
_EASY, _HARD = 4, 8  # corrector iterations below which the arc grows and above which it shrinks


@dataclass(frozen=True)
class Arc:
    """How a path is followed: length of the first arc and of the longest, number of arcs, and where to stop.

    A length is the change of the unknowns in the norm of the largest, as a share of the reach of the body, and that of
    the factor.  until : factor at which the path ends.  limit : factor beyond which it is given up.
    branches : how often to leave the path where it branches and the body is so symmetric that it could stay.
    """

    first: float
    longest: float
    count: int
    until: float
    limit: float
    branches: int


def lead(climb: Climb, start: Vector) -> Point:
    """The equilibrium at the factor one that the load leads to as it grows from nothing.

    Raises
    ------
    NotConvergedError : no path leads there, or to no stable equilibrium; the last point is its `state`.
    """
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused, not warned of
        point = unloaded(climb, start)
        climb.refuse_blur(point)
        point = _foretold(climb, point)
        if point.factor == 1.0:
            return point
        point = climb.at(point.q, point.factor) or point
        arc = Arc(first=0.05, longest=0.3, count=_MOST, until=1.0, limit=3.0, branches=_MOST)
        last = point
        for last in follow(climb, point, arc):
            climb.turned_back |= not last.stable
    if last.factor != 1.0 or not last.stable:
        raise climb.failure(point.factor, 1.0, last)
    return last


def unloaded(climb: Climb, start: Vector) -> Point:
    """The equilibrium without any load."""
    point = climb.at(start, 0.0)
    if point is None:
        raise climb.failure(0.0, 0.0, None)
    return point


def _foretold(climb: Climb, point: Point) -> Point:
    """The last equilibrium that increments reach which the path before them foretells."""
    body, refused, wall = climb.body, 0, 0.0
    longest = min(1.0 / climb.settings.load_steps, body.stride)
    increment = longest
    before: tuple[float, Fields] | None = None
    bend: Fields = np.zeros(())
    while point.factor < 1.0 and point.stable and refused < _TRIES:
        slope = _slope(climb, point)
        if slope is None:
            break
        rates = body.rates(point.q, slope)
        if before is not None:
            bend = (rates - before[1]) / (point.factor - before[0])
        fastest = float(np.abs(rates).max())
        increment = min(increment, longest, _TURN / fastest if fastest > 0 else longest)
        goal = point.factor + increment if point.factor + 1.001 * increment < 1.0 else 1.0
        step = goal - point.factor
        moved = step * (rates + step / 2 * bend)
        found = climb.at(
            body.foretold(point.q, moved, goal), goal, share=None if goal == 1.0 else _ON_THE_WAY
        )
        off = np.inf
        if found is not None and found.stable:
            turned = body.rates((point.q + found.q) / 2, found.q - point.q)
            off = float(np.abs(turned - moved).max()) / max(float(np.abs(turned).max()), _STILL)
        if found is None or off > _FORETOLD:
            refused, wall = refused + 1, goal
            climb.halvings += 1
            increment = step / 2
            continue
        before, point = (point.factor, rates), found
        if (
            point.factor >= wall
        ):  # short of it, ever shorter increments would come close to a crossing of paths
            refused = 0
        increment *= float(np.clip(np.sqrt(_FORETOLD / 2 / max(off, 1e-3)), 0.5, 2.0))
    return point


def follow(climb: Climb, point: Point, arc: Arc) -> Iterator[Point]:
    """Points along the path from a first one on, by pseudo-arclength, until the factor passes `until`.

    Where an eigenvalue changes its sign without the path turning back, another path crosses or comes near: the crossing
    is closed in on by halving, and the path goes on along the softest motion there.  Where the body is so symmetric
    that the path could also stay, it does so once it has left as often as it may.

    Raises
    ------
    NotConvergedError : no further point, or the factor goes beyond the limit, or a branch comes back to its beginning;
        the last point is its `state`.
    """
    yield point
    body, origin, went_away, left = climb.body, None, False, 0
    direction = _tangent(climb, point, None)
    ds = arc.first
    for _ in range(arc.count):
        before = climb.iterations
        (found, ahead, ds), across = _crossing_or_turn(climb, point, direction, ds, arc)
        if _peaks_beyond(point, direction, found, ahead, ds, arc.until) and ds > _CLOSE * arc.first:
            ds /= 2
            continue
        effort = climb.iterations - before
        if across is not None:
            motion, decided = climb.softest_motion(*across)
            if decided or left < arc.branches:
                climb.branchings += 1
                if not decided:
                    left += 1
                    climb.undecided.append(across[0].factor)
                if across[0] is not point:
                    yield across[0]
                origin = point = across[0]
                found, direction, ds = _branch(climb, point, motion, arc)
                ahead = _tangent(climb, found, direction)
        if (found.factor - arc.until) * (point.factor - arc.until) <= 0:
            last = _at_end(climb, point, found, arc.until)
            if last.negative != point.negative and ds > _CLOSE * arc.first:
                ds /= 2  # it came from beyond a limit point
                continue
            yield last
            return
        _refuse_beyond(climb, point, found, arc)
        if origin is not None:
            distance = _apart(body, origin, found)
            went_away = went_away or distance > _AWAY * arc.first
            if went_away and distance < ds:
                raise climb.stopped(
                    f"the path comes back to {origin.factor:.4g} of the load, where it branched off; set "
                    "arc.branch = 'stay', or add a small load that breaks the symmetry",
                    point,
                )
        yield found
        point, direction = found, ahead
        ds = min(arc.longest, 2 * ds) if effort <= _EASY else ds / 2 if effort > _HARD else ds


def _refuse_beyond(climb: Climb, point: Point, found: Point, arc: Arc) -> None:
    """Raise NotConvergedError where the path goes beyond its limit."""
    if abs(found.factor) > arc.limit:
        raise climb.stopped(
            f"the path goes to {found.factor:.4g} of the load, beyond 'arc.limit' = {arc.limit:g}; raise it",
            point,
        )


def _crossing_or_turn(
    climb: Climb, point: Point, direction: tuple[Vector, float], ds: float, arc: Arc
) -> tuple[tuple[Point, tuple[Vector, float], float], tuple[Point, Point] | None]:
    """The next point, direction and arc; and the points on both sides of a crossing on the way there, if any.

    Raises
    ------
    NotConvergedError : there is no next point.
    """
    further = _next(climb, point, direction, ds, arc)
    if further is None:
        across = _sharp_turn(climb, point, direction, arc)
        if across is None:
            raise climb.failure(point.factor, point.factor + direction[1] * ds, point)
        return (across[1], direction, ds), across
    found, ahead, ds = further
    crosses = found.negative != point.negative and ahead[1] * direction[1] > 0
    return further, _crossing(climb, point, direction, ds, arc) if crosses else None


def _at_end(climb: Climb, point: Point, found: Point, until: float) -> Point:
    """The equilibrium at the end of the path, between two points of it; the second of them where there is none."""
    share = (until - point.factor) / (found.factor - point.factor)
    last = climb.at(point.q + share * (found.q - point.q), until)
    return found if last is None else last


def _next(
    climb: Climb, point: Point, direction: tuple[Vector, float], ds: float, arc: Arc
) -> tuple[Point, tuple[Vector, float], float] | None:
    """The next point along a direction, the direction there, and the arc that led to it; None where there is none."""
    while ds > SMALLEST * arc.first:
        found = _corrected(climb, point, *direction, ds, _STRAY * ds)
        if found is not None:
            ahead = _tangent(climb, found, direction)
            if _cosine(direction, ahead) > _BEND:
                return found, ahead, ds
        ds /= 2
    return None


def _sharp_turn(
    climb: Climb, point: Point, direction: tuple[Vector, float], arc: Arc
) -> tuple[Point, Point] | None:
    """A stable point where the body turns aside too sharply for arcs to follow, and an unstable one straight on."""
    found = climb.at(point.q, point.factor + _CLOSE * arc.first * np.sign(direction[1]))
    return (point, found) if point.stable and found is not None and not found.stable else None


def _peaks_beyond(
    point: Point,
    direction: tuple[Vector, float],
    found: Point,
    ahead: tuple[Vector, float],
    ds: float,
    until: float,
) -> bool:
    """Whether the factor turns back within an arc, but hardly before it has passed `until`, by Hermite's cubic."""
    if direction[1] * ahead[1] >= 0 or (found.factor - until) * (point.factor - until) <= 0:
        return False
    s = np.linspace(0.0, 1.0, 33)
    rise = point.factor * (1 - s) ** 2 * (1 + 2 * s) + found.factor * s**2 * (3 - 2 * s)
    bend = ds * s * (1 - s) * (direction[1] * (1 - s) - ahead[1] * s)
    left = (until - rise - bend) * np.sign(until - point.factor)
    return bool((left <= _CLOSE * abs(until)).any())


def _cosine(one: tuple[Vector, float], other: tuple[Vector, float]) -> float:
    """Of the angle between two tangents."""
    weight = _weight(one[0])
    product = float(one[0] @ other[0]) + weight * one[1] * other[1]
    sizes = (float(t @ t) + weight * slope**2 for t, slope in (one, other))
    return product / float(np.sqrt(np.prod(list(sizes))))


def _crossing(
    climb: Climb, point: Point, direction: tuple[Vector, float], ds: float, arc: Arc
) -> tuple[Point, Point]:
    """The points just before and just after the first change of sign of an eigenvalue within an arc."""
    low, high = 0.0, ds
    before, after = point, None
    while high - low > _CLOSE * arc.first or (_wide(before, after) and high - low > _FINEST * arc.first):
        middle = high if after is None else (low + high) / 2
        found = _corrected(climb, point, *direction, middle, _STRAY * ds)
        if found is not None and found.negative != point.negative:
            high, after = middle, found
        elif after is None:
            break
        elif found is not None and _goes_on(climb, before, found):
            low, before = middle, found
        else:  # nothing is there, or a stable point beside the crossing, perhaps of the other side
            high = middle
    if after is None:
        raise climb.failure(point.factor, point.factor, point)
    return before, after


def _wide(before: Point, after: Point | None) -> bool:
    """Whether the load between two points can still turn what pulls to one side into what pulls to the other."""
    return after is None or abs(after.factor - before.factor) > _NEAR * abs(before.factor)


def _goes_on(climb: Climb, before: Point, found: Point) -> bool:
    """Whether a point lies where the path goes from the one before it."""
    chord = found.q - before.q, found.factor - before.factor
    return _cosine(_tangent(climb, before, chord), chord) > _BEND


def _norm(body: Loaded, q: Vector, step: Vector) -> float:
    """Length of a step in reaches of the body."""
    reach = body.reach(q, step)
    return 1 / reach if np.isfinite(reach) else 0.0


def _apart(body: Loaded, one: Point, other: Point) -> float:
    """Distance of two points in reaches of the body and factors of the load."""
    return float(np.hypot(_norm(body, one.q, other.q - one.q), other.factor - one.factor))


def _slope(climb: Climb, point: Point) -> Vector | None:
    """Change of the unknowns with the factor at a point; None where the Hessian is singular."""
    body = climb.body
    body.assemble(point.q, point.factor, climb.gradient, climb.band)
    rate = body.rate(point.q, point.factor, climb.band)
    hold(climb.band, body.held)
    right = np.where(body.held, 0.0, -rate)
    change = solve_positive(climb.band, right) if point.stable else solve_any(climb.band, right)
    return None if change is None else np.where(body.held, body.moving(point.factor), change)


def _tangent(climb: Climb, point: Point, before: tuple[Vector, float] | None) -> tuple[Vector, float]:
    """Direction of the path at a point: change of unknowns and factor, of unit length, going on from before."""
    body, change = climb.body, _slope(climb, point)
    if change is None:
        change = np.where(body.held, body.moving(point.factor), np.zeros_like(point.q))
    size = np.hypot(_norm(body, point.q, change), 1.0)
    change, slope = change / size, 1.0 / size
    if before is not None and float(change @ before[0]) + slope * before[1] * _weight(before[0]) < 0:
        change, slope = -change, -slope
    return change, slope


def _weight(tangent: Vector) -> float:
    """Weight of the factor against the unknowns in products of tangents."""
    return float(tangent @ tangent) or 1.0


def _corrected(
    climb: Climb, point: Point, tangent: Vector, slope: float, ds: float, stray: float
) -> Point | None:
    """The equilibrium with its factor on the plane across the tangent at an arc of ds; None beyond `stray` of there."""
    body, held = climb.body, climb.body.held
    q, factor = point.q + ds * tangent, point.factor + ds * slope
    weight, last = _weight(tangent), np.inf
    for _ in range(2 * _HARD):
        q = body.place(q, factor)
        energy = body.assemble(q, factor, climb.gradient, climb.band)
        if not np.isfinite(energy):
            return None
        unbalanced = np.where(held, 0.0, -climb.gradient)
        residual = float(np.abs(unbalanced).max())
        rounding = climb.rounding(q)
        load = float(np.abs(body.load(factor)).max())
        scale = max(load, float(np.abs(climb.gradient[held]).max(initial=0.0)))
        tolerance = max(climb.settings.tolerance * scale, rounding)
        rate = body.rate(q, factor, climb.band)
        hold(climb.band, held)
        if residual <= tolerance or stalled(residual, last, rounding):
            strayed = np.hypot(
                _norm(body, q, q - point.q - ds * tangent), factor - point.factor - ds * slope
            )
            if strayed > stray:
                return None  # an equilibrium, but one of another path
            negative = negative_eigenvalues(climb.band)
            reaction = np.where(held, climb.gradient, 0.0)
            return Point(
                q, factor, energy, reaction, climb.iterations, residual, tolerance, rounding, negative
            )
        last = residual
        both = solve_any(climb.band, np.column_stack([unbalanced, np.where(held, 0.0, -rate)]))
        if both is None:
            return None
        a, b = both.T
        across = float(tangent @ (q - point.q - ds * tangent)) + weight * slope * (
            factor - point.factor - ds * slope
        )
        change = -(across + float(tangent @ a)) / (float(tangent @ b) + weight * slope)
        step = a + change * b
        share = min(1.0, body.reach(q, step))
        q, factor = q + share * step, factor + share * change
        climb.iterations += 1
    return None


def _branch(
    climb: Climb, point: Point, motion: Vector, arc: Arc
) -> tuple[Point, tuple[Vector, float], float]:
    """A point on the path that leaves this one along a motion, the direction to it and the arc that led there.

    Raises
    ------
    NotConvergedError : there is none.
    """
    body, ds = climb.body, arc.first
    while ds > SMALLEST * arc.first:
        found = _corrected(climb, point, motion, 0.0, ds, arc.first)
        if found is not None and _norm(body, point.q, found.q - point.q) > ds / 4:
            size = _apart(body, found, point)
            away = (found.q - point.q) / size, (found.factor - point.factor) / size
            return found, away, ds
        ds /= 2
    raise climb.failure(point.factor, point.factor, point)
