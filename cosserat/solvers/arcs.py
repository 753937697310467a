"""Points, directions and lengths of an equilibrium path."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite, sqrt

import numpy as np

from cosserat.solvers.banded import Vector
from cosserat.solvers.climb import MAX_TARGET_STEPS
from cosserat.solvers.corrector import Corrector
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver
from cosserat.solvers.members import Plane
from cosserat.solvers.system import ConfigurationSpace


def cosine(one: tuple[Vector, float], other: tuple[Vector, float]) -> float:
    """Cosine of the angle between two tangents."""
    (a, rise), (b, climb) = one, other
    square = float(a @ a)
    weight = square or 1.0
    product = float(a @ b) + weight * rise * climb
    first, second = square + weight * rise**2, float(b @ b) + weight * climb**2
    return product / sqrt(first * second)


def step_size(space: ConfigurationSpace, q: Vector, step: Vector) -> float:
    """Length of a step, in step limits."""
    fraction = space.max_step_fraction(q, step)
    return 1 / fraction if isfinite(fraction) else 0.0


def distance(space: ConfigurationSpace, one: Equilibrium, other: Equilibrium) -> float:
    """Distance of two points, in step limits and load factors."""
    return float(np.hypot(step_size(space, one.q, other.q - one.q), other.factor - one.factor))


def rate_with_load(solver: EquilibriumSolver, point: Equilibrium) -> Vector | None:
    """Derivative of the DOFs by the load factor at a point; None if the Hessian is singular."""
    system, tangent = solver.system, solver.tangent
    change = point.rate
    if change is None:
        system.assemble(point.q, point.history, point.factor, tangent)
        rate = system.rate(point.factor, tangent)
        tangent.constrain(system.constrained)
        right = np.where(system.constrained, 0.0, -rate)
        change = tangent.solve(right, positive=point.stable)
    if change is None or not system.constraints.moving:
        return change
    return np.where(system.constrained, system.prescribed_rate(point.factor), change)


def path_tangent(
    solver: EquilibriumSolver, point: Equilibrium, before: tuple[Vector, float] | None
) -> tuple[Vector, float]:
    """Direction of the path at a point: changes of DOFs and factor, of unit length, forward from the point before."""
    system, change = solver.system, rate_with_load(solver, point)
    if change is None:
        change = np.where(
            system.constrained, system.prescribed_rate(point.factor), np.zeros_like(point.q)
        )
    size = np.hypot(step_size(system.space, point.q, change), 1.0)
    change, slope = change / size, 1.0 / size
    if before is not None and float(change @ before[0]) + slope * before[1] * _weight(before[0]) < 0:
        change, slope = -change, -slope
    return change, slope


def _weight(tangent: Vector) -> float:
    """Weight of the load factor relative to the DOFs in products of tangents."""
    return float(tangent @ tangent) or 1.0


def corrected(
    solver: EquilibriumSolver,
    point: Equilibrium,
    direction: Vector,
    slope: float,
    ds: float,
    stray: float,
) -> Equilibrium | None:
    """The equilibrium on the plane normal to a direction at an arc of ds; None if it is farther than `stray`."""
    system = solver.system
    corrector = solver.corrector or Corrector(solver)
    if corrector.compiled:
        return corrector.alone(point, (direction, slope), ds, stray)
    start = point.q + ds * direction
    plane = Plane(
        point.q,
        direction,
        point.factor,
        slope,
        ds,
        _weight(direction),
        system.load_sizes[0],
        solver.settings.tolerance,
        2 * MAX_TARGET_STEPS,
    )
    found = corrector.balanced(start.copy(), plane, point.history)
    if found is None:
        return None
    missing = found.factor - point.factor - ds * slope
    strayed = np.hypot(step_size(system.space, found.q, found.q - start), missing)
    if strayed > stray:
        return None  # an equilibrium of another path
    end = solver.accepted(found.q, found.factor, point.history, found.rounding, negative=found.negative)
    known = end.history is point.history  # else the Hessian is another
    return replace(end, rate=found.rate, log_determinant=found.log) if known else end
