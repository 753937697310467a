"""Equilibria of a slender elastic body under a growing load, and the path they lie on.

Slender bodies turn far while they hardly stretch: their energy is a curved, narrow valley, along which a line search
creeps.  Full Newton steps cross it, if none of them turns the body by more than a given angle; the body says how
much of a step that is.  Where a load is too much for one go it is halved; where the equilibrium found is unstable the
body is pushed along its softest motion and comes to rest elsewhere.  Paths that turn back are followed by
pseudo-arclength (Keller 1977; Crisfield 1991, chapter 9).  Nothing here knows what the unknowns mean.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from cosserat.errors import NotConvergedError
from cosserat.solvers.banded import (
    Band,
    Mask,
    Vector,
    absolute_product,
    hold,
    negative_eigenvalues,
    solve_positive,
)
from cosserat.solvers.indefinite import shifted, softest, solve_any
from cosserat.solvers.newton import NewtonSettings

_EPS = float(np.finfo(float).eps)
_SMALLEST = 2.0**-12  # share of the load below which halving gives up
_BLUR = 1e-3  # share of the loads beyond which forces of rounding make an answer worthless
_ROUGH = 16.0  # multiple of the estimate below which a residual that no longer falls is rounding
_CLOSE = 0.02  # share of the first arc to which a crossing of paths is closed in on
_PUSH = 0.05  # share of its reach by which an unstable body is pushed
_EASY, _HARD = 4, 8  # corrector iterations below which the arc grows and above which it shrinks


class Loaded(Protocol):
    """A body under a load that grows with a factor."""

    @property
    def half_bandwidth(self) -> int:
        """Largest distance of two coupled unknowns."""

    @property
    def held(self) -> Mask:
        """Which unknowns keep their value, or the one that the factor gives them, shape (n,)."""

    @property
    def grain(self) -> Vector:
        """Sizes (n,) that are rounded where the energy is computed, however small the unknowns are."""

    def place(self, q: Vector, factor: float) -> Vector:
        """q with its held unknowns where the factor puts them."""

    def assemble(self, q: Vector, factor: float, gradient: Vector, band: Band) -> float:
        """Elastic energy at q; overwrites the gradient of the potential, loads included, and the Hessian."""

    def load(self, factor: float, *, signed: bool = False) -> Vector:
        """Dead load, shape (n,), and unsigned also what couples amount to: the scale of what counts as balanced."""

    def rate(self, q: Vector, factor: float, band: Band) -> Vector:
        """Change of that gradient with the factor, shape (n,); `band` is the Hessian at q."""

    def reach(self, q: Vector, step: Vector) -> float:
        """Largest share of a step that turns no part by more than is safe."""


@dataclass(frozen=True)
class Point:
    """One equilibrium.

    factor : of the load.  reaction : (n,) force that holds each held unknown [N].  residual, tolerance, rounding : as
    in `newton.Equilibrium` [N].  negative : how many eigenvalues of the Hessian are negative.
    """

    q: Vector
    factor: float
    energy: float
    reaction: Vector
    iterations: int
    residual: float
    tolerance: float
    rounding: float
    negative: int

    @property
    def stable(self) -> bool:
        """Whether the potential has a minimum there."""
        return self.negative == 0


class Climb:
    """Equilibria at given factors, from the reference on."""

    def __init__(self, body: Loaded, settings: NewtonSettings, name: str) -> None:
        n = body.held.size
        self.body, self.settings, self.name = body, settings, name
        self.gradient, self.band = np.empty(n), np.empty((n, body.half_bandwidth + 1))
        self.iterations = self.halvings = self.pushes = 0
        self.remedy = (
            "the path may turn back there: follow it with kind = 'rod path', or check supports and loads"
        )

    def to(self, start: Vector, factor: float) -> Point:
        """A stable equilibrium at the factor, by as few increments as it takes.

        Raises
        ------
        NotConvergedError : with the factor that was reached, and the last equilibrium as `state`.
        """
        last: Point | None = None
        q, done, increment = start, 0.0, factor / self.settings.load_steps
        with np.errstate(over="ignore", invalid="ignore"):
            while done != factor:
                goal = factor if abs(factor - done) <= 1.001 * abs(increment) else done + increment
                point = self.at(q, goal)
                if point is not None and not point.stable:
                    point = self._pushed(point)
                if point is None:
                    self.halvings += 1
                    increment /= 2
                    if abs(increment) < _SMALLEST * abs(factor):
                        raise self._failure(done, goal, last)
                    continue
                last, q, done = point, point.q, goal
        if last is None:  # no load at all
            last = self.at(start, factor)
            if last is None:
                raise self._failure(0.0, factor, None)
        return last

    def at(self, q: Vector, factor: float, *, downhill: bool = False) -> Point | None:
        """An equilibrium at the factor by full Newton steps from q; None where they do not lead to one.

        downhill : where the Hessian is not positive, take the step of a shifted one, which lowers the potential.
        """
        body, held = self.body, self.body.held
        q = body.place(q, factor)
        load = float(np.abs(body.load(factor)).max())
        largest, last = 0.0, np.inf
        for _ in range(self.settings.max_iterations + 1):
            energy = body.assemble(q, factor, self.gradient, self.band)
            if not np.isfinite(energy):
                return None
            unbalanced = np.where(held, 0.0, -self.gradient)
            residual = float(np.abs(unbalanced).max())
            largest = max(largest, residual)
            rounding = self.rounding(q)
            scale = max(load, float(np.abs(self.gradient[held]).max(initial=0.0)), largest * (load == 0))
            tolerance = max(self.settings.tolerance * scale, rounding)
            if load > 0 and rounding > _BLUR * max(scale, float(np.abs(body.load(factor)).sum())):
                raise NotConvergedError(
                    f"{self.name}: rounding the unknowns makes forces up to {rounding:.2g} N, too much beside the "
                    "loads; use fewer vertices, or loads that strain the body less",
                    iterations=self.iterations,
                    residual=residual,
                    tolerance=tolerance,
                )
            hold(self.band, held)
            step = solve_positive(self.band, unbalanced)
            if residual <= tolerance or _stalled(residual, last, rounding):
                reaction = np.where(held, self.gradient, 0.0)
                return Point(
                    q,
                    factor,
                    energy,
                    reaction,
                    self.iterations,
                    residual,
                    tolerance,
                    rounding,
                    0 if step is not None else negative_eigenvalues(self.band),
                )
            last = residual
            if step is None:
                step = shifted(self.band, unbalanced) if downhill else solve_any(self.band, unbalanced)
            if step is None or not np.isfinite(step).all():
                return None
            q = q + min(1.0, body.reach(q, step)) * step
            self.iterations += 1
        return None

    def rounding(self, q: Vector) -> float:
        """Largest force that rounding can cause, by the Hessian assembled last [N]."""
        size = np.maximum(np.abs(q), self.body.grain)
        return _EPS * float(absolute_product(self.band, size).max())

    def softest_motion(self, point: Point) -> Vector:
        """The softest motion at a point, one reach long, to the side that the loads push to."""
        self.body.assemble(point.q, point.factor, self.gradient, self.band)
        hold(self.band, self.body.held)
        motion = softest(self.band, self.body.held)
        if float(self.body.load(point.factor, signed=True) @ motion) < 0:
            motion = -motion
        return self.body.reach(point.q, motion) * motion

    def _pushed(self, point: Point) -> Point | None:
        """From an unstable equilibrium, along its softest motion, to another one."""
        self.pushes += 1
        motion = self.softest_motion(point)
        found = self.at(point.q + _PUSH * motion, point.factor, downhill=True)
        return found if found is not None and found.stable else None

    def _failure(self, done: float, goal: float, last: Point | None) -> NotConvergedError:
        error = NotConvergedError(
            f"{self.name}: no equilibrium found beyond {done:.4g} of the load (tried {goal:.6g}); {self.remedy}",
            iterations=self.iterations,
        )
        error.state = None if last is None else last.q  # as the body counts its unknowns
        error.factor = done
        return error


@dataclass(frozen=True)
class Arc:
    """How a path is followed: length of the first arc and of the longest, number of arcs, and where to stop.

    A length is the change of the unknowns in the norm of the largest, as a share of the reach of the body, and that of
    the factor.  until : factor at which the path ends.  limit : factor beyond which it is given up.
    switch : whether to leave the path where it branches.
    """

    first: float
    longest: float
    count: int
    until: float
    limit: float
    switch: bool


def follow(climb: Climb, start: Vector, arc: Arc) -> Iterator[Point]:
    """Points along the path from the factor zero on, by pseudo-arclength, until the factor passes `until`.

    Where an eigenvalue changes its sign without the path turning back, another path crosses: the crossing is closed in
    on by halving, and the path left along the softest motion there.

    Raises
    ------
    NotConvergedError : no further point, or the factor goes beyond the limit; the last point is its `state`.
    """
    climb.remedy = "take a smaller 'arc.first' and 'arc.longest', or check supports and loads"
    point = climb.at(start, 0.0)
    if point is None:
        raise climb._failure(0.0, 0.0, None)
    yield point
    body, switch = climb.body, arc.switch
    direction = _tangent(climb, point, None)
    ds = arc.first
    for _ in range(arc.count):
        before = climb.iterations
        found, ds = _next(climb, point, direction, ds, arc)
        effort = climb.iterations - before
        ahead = _tangent(climb, found, direction)
        if switch and found.negative != point.negative and ahead[1] * direction[1] > 0:
            near, found = _crossing(climb, point, direction, ds, arc)
            if near is not point:
                yield near
            branch = _branch(climb, found, arc)
            if branch is None:
                raise climb._failure(found.factor, found.factor, point)
            away = branch.q - found.q
            size = np.hypot(_norm(body, branch.q, away), branch.factor - found.factor)
            ahead = _tangent(climb, branch, (away / size, (branch.factor - found.factor) / size))
            found, switch, ds = branch, False, arc.first
        if point.factor != 0.0 and (found.factor - arc.until) * (point.factor - arc.until) <= 0:
            last = climb.at(found.q, arc.until)
            yield found if last is None else last
            return
        if abs(found.factor) > arc.limit:
            raise climb._failure(point.factor, found.factor, point)
        yield found
        point, direction = found, ahead
        ds = min(arc.longest, 2 * ds) if effort <= _EASY else ds / 2 if effort > _HARD else ds


def _next(
    climb: Climb, point: Point, direction: tuple[Vector, float], ds: float, arc: Arc
) -> tuple[Point, float]:
    """The next point along a direction, and the arc that led to it."""
    while ds > _SMALLEST * arc.first:
        found = _corrected(climb, point, *direction, ds)
        if found is not None:
            return found, ds
        ds /= 2
    raise climb._failure(point.factor, point.factor + direction[1] * ds, point)


def _crossing(
    climb: Climb, point: Point, direction: tuple[Vector, float], ds: float, arc: Arc
) -> tuple[Point, Point]:
    """The points just before and just after the first change of sign of an eigenvalue within an arc."""
    low, high = 0.0, ds
    before, after = point, None
    while after is None or high - low > _CLOSE * arc.first:
        middle = high if after is None else (low + high) / 2
        found = _corrected(climb, point, *direction, middle)
        if found is None:
            break
        if found.negative == point.negative:
            low, before = middle, found
        else:
            high, after = middle, found
    if after is None:
        raise climb._failure(point.factor, point.factor, point)
    return before, after


def _norm(body: Loaded, q: Vector, step: Vector) -> float:
    """Length of a step in reaches of the body."""
    reach = body.reach(q, step)
    return 1 / reach if np.isfinite(reach) else 0.0


def _tangent(climb: Climb, point: Point, before: tuple[Vector, float] | None) -> tuple[Vector, float]:
    """Direction of the path at a point: change of unknowns and factor, of unit length, going on from before."""
    body = climb.body
    body.assemble(point.q, point.factor, climb.gradient, climb.band)
    rate = body.rate(point.q, point.factor, climb.band)
    hold(climb.band, body.held)
    moved = body.place(point.q, point.factor + 1.0) - point.q
    change = solve_any(climb.band, np.where(body.held, 0.0, -rate))
    change = np.where(body.held, moved, np.zeros_like(point.q) if change is None else change)
    size = np.hypot(_norm(body, point.q, change), 1.0)
    change, slope = change / size, 1.0 / size
    if before is not None and float(change @ before[0]) + slope * before[1] * _weight(before[0]) < 0:
        change, slope = -change, -slope
    return change, slope


def _weight(tangent: Vector) -> float:
    """Weight of the factor against the unknowns in products of tangents."""
    return float(tangent @ tangent) or 1.0


def _corrected(climb: Climb, point: Point, tangent: Vector, slope: float, ds: float) -> Point | None:
    """The equilibrium on the plane across the tangent at an arc of ds, with its factor."""
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
        if residual <= tolerance or _stalled(residual, last, rounding):
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


def _branch(climb: Climb, point: Point, arc: Arc) -> Point | None:
    """A point on the path that leaves this one along its softest motion, to the side that the loads push to."""
    body, motion, ds = climb.body, climb.softest_motion(point), arc.first
    while ds > _SMALLEST * arc.first:
        found = _corrected(climb, point, motion, 0.0, ds)
        if found is not None and _norm(body, point.q, found.q - point.q) > ds / 2:
            return found
        ds /= 2
    return None


def _stalled(residual: float, last: float, rounding: float) -> bool:
    """Whether what is left no longer falls and is of the size of rounding, whose bound is an estimate."""
    return residual > last / 2 and residual <= _ROUGH * rounding
