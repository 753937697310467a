"""How an equilibrium moves as a parameter of its problem changes, to first order.

derived: r(q, p) = 0 for every p gives K dq/dp = -dr/dp, with K the Hessian that Newton's method ends with.  What dr/dp
keeps fixed may be chosen, as long as dq/dp counts from it.  Fixed displacements would stretch a rod whose length
changes, and fixed positions one that grows thicker.  Here every edge keeps its rotation and its stretch against its
reference, and so does every director: the strains stay, and the gradient changes as smoothly as the stiffnesses.
Supports that hold DOFs elsewhere add the Hessian times the gap to the right-hand side.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import CosseratError, InputError
from cosserat.problems.posed import PosedProblem
from cosserat.rods.problem import RodProblem
from cosserat.rods.reference import Geometry
from cosserat.rods.rod import Rod
from cosserat.solution import Field, FieldRates, Solution
from cosserat.solvers.climb import BESIDE, NEARLY_CRITICAL
from cosserat.solvers.equilibrium import Equilibrium
from cosserat.solvers.slopes import slope
from cosserat.solvers.system import History, MechanicalSystem
from cosserat.solvers.tangent import Tangent

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Nearby = Callable[[float], Any]
"""The problem after a step of its parameter; a step of zero is the problem itself."""


@dataclass(frozen=True)
class NearKey:
    """The problem after a step of one of its keys, a `Nearby`.

    made : the problem after a step.  key : its dotted path.  after : its value after a step.
    """

    made: Nearby
    key: str
    after: Callable[[float], float]

    def __call__(self, step: float) -> Any:
        """The problem after a step."""
        return self.made(step)


_ROUGH = 1e-5  # of the largest derivative, above which its error says that there is none
_ROUNDED = 1e-12  # of the largest reaction, below which a force is round-off
_INVERSE_ITERATIONS = 12


class Moving(Protocol):
    """A result whose first derivative by the step of a parameter is right at a step of zero.

    lacks : why some variables of the result are not among those that move.
    """

    lacks: str

    def solution(self, step: float) -> Solution:
        """The result after a step.

        Raises
        ------
        InputError : the parameter is out of its range there.
        """


@dataclass(frozen=True)
class Motion:
    """A result that moves with several parameters.

    base : the result itself.  ways : how it moves with each.  lost : why it does not, for each; empty where it does.
    rates : of its fields, with some of the parameters at once; None where these are not known apart from the ways.
    rated : the number among those of the rates, by that of a parameter.
    """

    base: Solution
    ways: tuple[Moving, ...]
    lost: tuple[str, ...]
    rates: FieldRates | None = None
    rated: Mapping[int, int] = field(default_factory=dict)


@dataclass(frozen=True)
class Body:
    """A problem with its reference and its system, in displacements."""

    problem: PosedProblem
    geometry: Geometry
    system: MechanicalSystem

    @classmethod
    def of(
        cls,
        problem: PosedProblem,
        made: Callable[[PosedProblem, Geometry], MechanicalSystem] | None = None,
    ) -> Body:
        """The body of a problem; made : its system, if that is not the one under all loads."""
        geometry = problem.geometry
        return cls(
            problem, geometry, problem.system(geometry) if made is None else made(problem, geometry)
        )

    @cached_property
    def reference(self) -> Array:
        """Positions and directors of the reference, (N, m, 2) [m]."""
        rod = self.problem.rod
        return rod.kinematics.split(rod.strain_energy.reference(self.geometry))

    def tangent(self, q: Array, history: History, factor: float) -> Tangent:
        """Gradient and Hessian at a load factor."""
        tangent = Tangent(self.system)
        self.system.assemble(q, history, factor, tangent)
        return tangent


Made = Callable[[float, PosedProblem, Geometry], MechanicalSystem]
"""The system of a problem after a step, if that is not the one under all loads."""


def body_after(step: float, nearby: Nearby, made: Made | None) -> Body:
    """The body after a step of a parameter."""
    return Body.of(nearby(step), None if made is None else functools.partial(made, step))


def _turned(vectors: Array) -> Complex:
    """Vectors (..., 2) as complex numbers, whose quotients are rotations and stretches."""
    return vectors[..., 0] + 1j * vectors[..., 1]


def _shifted(before: Complex, after: Complex, away: Complex, moved: Complex) -> Complex:
    """Displacements of vectors `after` a step that turn and stretch as displacements `away` from those `before` it.

    moved : further changes of these.  Nothing large is subtracted, so that small displacements keep their digits.
    """
    strain = away / before
    return np.asarray((strain + (1 + strain) * np.expm1(moved / (before + away))) * after)


def placed(base: Body, q: Array, rate: Array, steps: Array, references: Array) -> Array:
    """The DOFs along the axes of space after some steps, (..., n): edges and directors rotate and stretch at the rates.

    q, rate : (n,) of the base.  steps : (...).  references : (..., N, m, 2) [m].
    """
    split, out = base.problem.rod.kinematics.split, base.system.frame.out
    before, after = _turned(base.reference), _turned(references)
    away = _turned(split(out(q)))
    moved = np.asarray(steps)[..., None, None] * _turned(split(out(rate)))
    found = np.empty_like(after)
    edges = _shifted(
        np.diff(before[:, 0]), np.diff(after[..., 0]), np.diff(away[:, 0]), np.diff(moved[..., 0])
    )
    found[..., 0] = away[0, 0] + moved[..., :1, 0]
    found[..., 1:, 0] += np.cumsum(edges, axis=-1)
    found[..., 1:] = _shifted(before[:, 1:], after[..., 1:], away[:, 1:], moved[..., 1:])
    flat = np.stack([found.real, found.imag], axis=-1)
    return flat.reshape(*flat.shape[:-3], -1)


class Moved:
    """An equilibrium that moves with a parameter.

    nearby, made : the problem and its system after a step.  base, point : those of no step.
    rate : (n,) change of the DOFs with the step beyond those that keep the strains.
    reaction_rate : (n,) change of the force that holds each constrained DOF [N].
    """

    def __init__(
        self,
        nearby: Nearby,
        base: Body,
        point: Equilibrium,
        made: Made | None = None,
    ) -> None:
        self.nearby, self.base, self.point, self.made = nearby, base, point, made
        self.known: dict[float, Body] = {0.0: base}
        self.with_strains: dict[float, Array] = {}
        self.rate = self.reaction_rate = np.zeros_like(point.q)

    def body(self, step: float) -> Body:
        """The body after a step.

        Raises
        ------
        InputError : the parameter is out of its range there.
        """
        if step not in self.known:
            found = body_after(step, self.nearby, self.made)
            if found.reference.shape != self.base.reference.shape:
                raise InputError("the number of vertices changes with the parameter")
            if not np.array_equal(found.system.constrained, self.base.system.constrained):
                raise InputError("the parameter changes which degrees of freedom are held")
            self.known[step] = found
        return self.known[step]

    def carried(self, step: float) -> Array:
        """The DOFs after a step with the rotations and stretches of no step, (n,)."""
        if step not in self.with_strains:
            self.with_strains[step] = self._placed(step, np.zeros_like(self.point.q))
        return self.with_strains[step]

    def q(self, step: float) -> Array:
        """The DOFs after a step, to first order, (n,): edges and directors rotate and stretch at the rates."""
        return self._placed(step, self.rate)

    def _placed(self, step: float, rate: Array) -> Array:
        if step == 0.0 or not (self.point.q.any() or rate.any()):
            return self.point.q
        found = placed(self.base, self.point.q, rate, np.array(step), self.reference(step))
        return self.system(step).frame.into(found)

    def system(self, step: float) -> MechanicalSystem:
        """The system after a step, or one with the same frames, constraints and internal variables."""
        return self.body(step).system

    def reference(self, step: float) -> Array:
        """Positions and directors of the reference after a step, (N, m, 2) [m]."""
        return self.body(step).reference

    def shape(self, step: float) -> tuple[Rod, Geometry]:
        """The rod and its reference after a step."""
        body = self.body(step)
        return body.problem.rod, body.geometry

    def gradient(self, step: float) -> Array:
        """The gradient of the carried equilibrium after a step, (n,) [N]."""
        return (
            self.body(step).tangent(self.carried(step), self.point.history, self.point.factor).gradient
        )

    def state(self, step: float) -> Equilibrium:
        """The equilibrium after a step, to first order."""
        if step == 0.0:
            return self.point
        q = self.q(step)
        return replace(
            self.point,
            q=q,
            reaction=self.point.reaction + step * self.reaction_rate,
            history=self.system(step).committed(q, self.point.history),
        )

    def unbalanced(self) -> Array:
        """Derivative of the gradient of the carried equilibrium, (n,) [N].

        Raises
        ------
        InputError : it has none, or the parameter is at an end of its range.
        """
        held = float(np.abs(self.point.reaction).max(initial=0.0))
        found = slope(self.gradient, max(self.point.rounding, _ROUNDED * held))
        free = ~self.base.system.constrained
        if found.relative > _ROUGH or found.kink[free].any():
            raise InputError("its forces do not change smoothly with the parameter")
        return found.value

    def gap(self) -> Array:
        """Derivative of where the supports hold the DOFs, less where they are carried to, (n,); zero for free DOFs."""
        system, factor = self.base.system, self.point.factor
        if not system.constrained.any():
            return np.zeros_like(self.point.q)

        def held(step: float) -> Array:
            carried = self.carried(step)
            return self.system(step).prescribe(carried, factor) - carried

        size = float(np.abs(self.base.reference).max() + np.abs(self.point.q).max())
        return slope(held, np.finfo(float).eps * size).value


AT_CRITICAL = "the equilibrium is at a limit point or a bifurcation, where it has no derivative; change the load a bit"


def move(moving: Sequence[Moved]) -> list[str]:
    """Set the rates of one equilibrium for several parameters, with one factorisation of its Hessian.

    Returns why one has none, for each; empty where it has.
    """
    base, point = moving[0].base, moving[0].point
    system = base.system
    if point.factor == 0 and not point.q.any():  # at rest whatever the parameters are
        return [""] * len(moving)
    tangent = base.tangent(point.q, point.history, point.factor)
    rates, forces = np.zeros((2, point.q.size, len(moving)))
    lost = [""] * len(moving)
    for number, one in enumerate(moving):
        try:
            rates[:, number] = one.gap()
            forces[:, number] = one.unbalanced() + tangent.product(rates[:, number])
        except CosseratError as error:
            lost[number] = str(error)
    right = np.where(system.constrained[:, None], 0.0, -forces)
    if right.any():
        whole = base.tangent(point.q, point.history, point.factor)
        tangent.constrain(system.constrained)
        found = tangent.solve(right, positive=point.stable)
        if found is None or not np.isfinite(found).all() or _is_critical(base, point, tangent):
            return [AT_CRITICAL] * len(moving)
        rates += found
        forces += np.column_stack([whole.product(column) for column in found.T])
    for number, one in enumerate(moving):
        one.rate = rates[:, number]
        one.reaction_rate = np.where(system.constrained, forces[:, number], 0.0)
    return lost


def _is_critical(base: Body, point: Equilibrium, tangent: Tangent) -> bool:
    """Whether the softest eigenvalue would be zero at a load so near that no computation tells them apart.

    tangent : the Hessian, constrained.
    """
    system = base.system
    if not system.external and not system.constraints.moving:
        return False
    x = np.where(system.constrained, 0.0, np.cos(1.7 * np.arange(point.q.size)))
    for _ in range(_INVERSE_ITERATIONS):
        y = tangent.solve(x)
        if y is None:
            return True
        x = np.where(system.constrained, 0.0, y)
        x /= np.linalg.norm(x)
    value = float(x @ tangent.product(x))
    here = base.tangent(point.q, point.history, point.factor)
    rate = system.rate(point.factor, here)
    change = tangent.solve(np.where(system.constrained, 0.0, -rate))
    if change is None:
        return True
    change = np.where(system.constrained, system.prescribed_rate(point.factor), change)
    ahead, behind = (
        base.tangent(point.q + f * change, point.history, point.factor + f) for f in (BESIDE, -BESIDE)
    )
    along = float(x @ ahead.product(x) - x @ behind.product(x)) / (2 * BESIDE)
    return abs(value) <= NEARLY_CRITICAL * abs(along)


def total_mass(
    problem: RodProblem, geometry: Geometry
) -> tuple[dict[str, Field], dict[str, tuple[str, ...]]]:
    """The mass of the whole rod as a field with its labels: also of a result that does not store it."""
    total = float(problem.rod.part_masses(geometry).sum())
    total += sum(item.mass for item in problem.masses)
    axes = problem.rod.kinematics.axes
    return {"total_mass": (("axis",), np.full(len(axes), total))}, {"axis": axes}
