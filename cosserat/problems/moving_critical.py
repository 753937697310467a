"""Critical load factors that move with a parameter to first order.

derived, linear criterion: (K + f G) v = 0 and its left vector w give f' = -w . (K' + f G') v / (w . G v).
derived, true criterion: there the gradient r is zero and the Hessian K singular, K v = 0, w . K = 0.  At a limit point
w . r' = 0 along the path, so f' = -(w . r_p) / (w . r_f).  At a bifurcation both products are zero.  Then K keeps its
zero along the path: with a and b the changes of the DOFs with p and f, f' = -w . K_a v / (w . K_b v), K_a the change of
the Hessian along a, and K_b along b.  Where the DOFs of a limit point go, y + c v, follows from its zero too:
w . K_y v + c w . K_v v = 0, K_y with the changes of parameter and load; at a symmetric bifurcation c is zero.  The
shapes follow from K v' = -K' v.  A parameter that breaks the symmetry has w . r_p other than zero: the bifurcation
ends, and the factor falls with a power below one of it.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import CosseratError, InputError
from cosserat.problems.critical import RodCriticalLoads, linear_fields
from cosserat.problems.moving_starts import begun_after
from cosserat.problems.special import special_fields
from cosserat.problems.tangents import (
    Body,
    Made,
    Motion,
    Moved,
    Nearby,
    body_after,
    total_mass,
)
from cosserat.solution import Field, Solution
from cosserat.solvers.banded import to_sparse
from cosserat.solvers.critical import LinearCriterion, criterion_matrices
from cosserat.solvers.equilibrium import EquilibriumSolver, NewtonSettings
from cosserat.solvers.slopes import Slope, slope
from cosserat.solvers.special import SpecialPoint

Array = NDArray[np.float64]
_EPS = float(np.finfo(float).eps)
_NOISE = 1e3  # of the round-off of a force, below which its derivative is zero
_ROUGH = 1e-5  # of the largest derivative, above which its error says that there is none
_BALANCED = 1e-6  # of a product of two vectors, below which it is zero
_ASYMMETRIC = 1e-4  # the same, of a third derivative
_APART = 1e-7  # of a factor, within which two are one
_LACKS = "only load factors of critical loads, and their shapes, have derivatives"
_LINEAR_SHAPES = {"linear_u", "linear_delta"}
_SPECIAL_SHAPES = {"special_x", "special_d", "special_u", "special_delta"}
_OF_LINEAR = {"linear_load_factor", *_LINEAR_SHAPES}
_OF_SPECIAL = {"special_load_factor", *_SPECIAL_SHAPES}


class MovedFactors:
    """Load factors of both criteria and, where they are asked for, shapes that move."""

    lacks = _LACKS

    def __init__(self, base: Solution, near: Nearby) -> None:
        self.base, self.near = base, near
        self.rates: dict[str, Array] = {}
        self.shapes: list[Callable[[float], Mapping[str, Field]]] = []

    def solution(self, step: float) -> Solution:
        """The factors after a step, to first order, and the mass of the rod."""
        problem = self.near(step)
        fields, labels = total_mass(problem, problem.geometry)
        for name, rate in self.rates.items():
            dims, values = self.base.fields[name]
            fields[name] = (dims, values + step * rate)
        for shape in self.shapes:
            fields |= shape(step)
        return Solution(fields, {}, {**self.base.labels, **labels})


def moving_critical(
    problem: RodCriticalLoads, nearby: Sequence[Nearby], name: str, wanted: Set[str] = frozenset()
) -> Motion:
    """The critical loads of a problem, moving with each of several parameters.

    wanted : names of the fields that move.

    Raises
    ------
    CosseratError : there are none.
    """
    result = problem.solve(name)
    geometry = problem.geometry
    system, _ = problem.grown(geometry, name)
    body = Body(problem, geometry, system)
    fields, labels = total_mass(problem, body.geometry)
    result = replace(result, fields={**result.fields, **fields}, labels={**result.labels, **labels})
    _, linear, true, _ = problem.criteria(body.system, name)
    ways, lost = [], []
    for near in nearby:
        way, why = MovedFactors(result, near), ""
        try:
            _set_rates(way, body, linear, true, problem, name, wanted)
        except CosseratError as error:
            why = str(error)
        ways.append(way)
        lost.append(why)
    return Motion(result, tuple(ways), tuple(lost))


def _set_rates(
    way: MovedFactors,
    body: Body,
    linear: LinearCriterion,
    true: SpecialPoint | None,
    problem: RodCriticalLoads,
    name: str,
    wanted: Set[str],
) -> None:
    """Set the wanted rates of both criteria with one parameter.

    Raises
    ------
    InputError : one has none.
    """
    made = begun_after(problem, way.near, name)
    if linear.factor.size and wanted & _OF_LINEAR:
        bodies = _bodies(body, way.near, made)
        criterion = _Linear(bodies, linear, problem.newton, name)
        way.rates["linear_load_factor"] = criterion.rates
        if wanted & _LINEAR_SHAPES:
            way.shapes.append(criterion.shapes())
    if true is not None and wanted & _OF_SPECIAL:
        at, moved = _Critical(body, true), Moved(way.near, body, true.point, made)
        rate = _true_rate(at, moved, true.limit)
        way.rates["special_load_factor"] = np.array([rate])
        if wanted & _SPECIAL_SHAPES:
            way.shapes.append(_special_shapes(at, moved, true, rate))


def _bodies(body: Body, near: Nearby, made: Made | None) -> Callable[[float], Body]:
    """The body after a step."""

    @functools.cache
    def after(step: float) -> Body:
        own = body if step == 0.0 else body_after(step, near, made)
        if not np.array_equal(own.system.constrained, body.system.constrained):
            raise InputError("the parameter changes which degrees of freedom are held")
        return own

    return after


class _Linear:
    """The linear criterion of bodies that move with a parameter; rates : of its factors, (k,)."""

    def __init__(
        self,
        bodies: Callable[[float], Body],
        linear: LinearCriterion,
        settings: NewtonSettings,
        name: str,
    ) -> None:
        self.bodies, self.linear = bodies, linear
        self.settings, self.name = settings, name
        self.known: dict[float, tuple[Any, Any]] = {}
        system, factors = bodies(0.0).system, linear.factor
        if (np.abs(np.diff(factors)) <= _APART * factors[1:]).any():
            raise InputError("two modes of the linear criterion share a load factor")
        self.free = ~system.constrained
        self.right = linear.mode[:, self.free]
        stiffness, self.geometric = self.matrices(0.0)
        self.singular = [stiffness + f * self.geometric for f in factors]
        self.left = (
            self.right if system.symmetric else np.array([_null(one)[1] for one in self.singular])
        )
        self.floor = _EPS * float(
            max(
                np.abs(w) @ (abs(stiffness) @ np.abs(v))
                for v, w in zip(self.right, self.left, strict=True)
            )
        )
        change = _smooth(slope(lambda step: (self.left * self.products(step)).sum(axis=1), self.floor))
        weight = np.array([w @ (self.geometric @ v) for v, w in zip(self.right, self.left, strict=True)])
        self.rates: Array = -change / weight

    def matrices(self, step: float) -> tuple[Any, Any]:
        """Stiffness and geometric stiffness after a step."""
        if step not in self.known:
            solver = EquilibriumSolver(self.bodies(step).system, self.settings, self.name)
            self.known[step] = criterion_matrices(solver)
        return self.known[step]

    def products(self, step: float) -> Array:
        """(K + f G) v after a step, (k, free)."""
        K, G = self.matrices(step)
        pairs = zip(self.linear.factor, self.right, strict=True)
        return np.array([K @ v + f * (G @ v) for f, v in pairs])

    def shapes(self) -> Callable[[float], Mapping[str, Field]]:
        """The modes after a step: (K + f G) v' = -(K' + f G') v - f' G v."""
        change = slope(self.products, float(self.floor / np.abs(self.right).max())).value
        rates = np.zeros_like(self.linear.mode)
        for k, (v, w) in enumerate(zip(self.right, self.left, strict=True)):
            force = change[k] + self.rates[k] * (self.geometric @ v)
            rates[k, self.free] = _bordered(self.singular[k], v, w, force)

        def after(step: float) -> Mapping[str, Field]:
            body = self.bodies(step)
            modes = body.system.frame.out(self.linear.mode + step * rates)
            factors = self.linear.factor + step * self.rates
            return linear_fields(body.problem.rod, LinearCriterion(factors, modes))

        return after


def _bordered(matrix: Any, v: Array, w: Array, force: Array) -> Array:
    """The answer of a singular matrix to minus a force, without a part along its right vector v; w : its left one."""
    from scipy.sparse import block_array
    from scipy.sparse.linalg import spsolve

    bordered = block_array([[matrix, w[:, None]], [v[None], None]]).tocsc()
    found: Array = spsolve(bordered, np.append(-force, 0.0))[:-1]
    return found


def _smooth(found: Slope) -> Array:
    """The value of a derivative that exists.

    Raises
    ------
    InputError : it does not.
    """
    if found.relative > _ROUGH or found.kink.any():
        raise InputError("the stiffness does not change smoothly with the parameter")
    return found.value


def _null(matrix: Any) -> tuple[Array, Array]:
    """The right and the left vector of unit length of a singular sparse matrix."""
    left, _, right = np.linalg.svd(matrix.toarray())
    return right[-1], left[:, -1]


class _Critical:
    """A singular equilibrium of a body, with the vectors of its Hessian; vectors are of the free DOFs."""

    def __init__(self, body: Body, true: SpecialPoint) -> None:
        self.body, self.point = body, true.point
        self.free = ~body.system.constrained
        self.tangent = body.tangent(true.point.q, true.point.history, true.point.factor)
        whole = to_sparse(self.tangent.band, self.tangent.skew)
        self.stiffness = whole[self.free][:, self.free]
        self.v, self.w = _null(self.stiffness)
        self.by_load = body.system.rate(true.point.factor, self.tangent)[self.free]
        self.floor = _EPS * float(np.abs(self.w) @ (abs(self.stiffness) @ np.abs(self.v)))

    def answer(self, force: Array, held: Array) -> Array:
        """Change of all DOFs (n,) under a change of the free forces, without a part along v.

        held : (n,) change of the held DOFs.
        """
        found = np.where(self.free, 0.0, held)
        found[self.free] = _bordered(self.stiffness, self.v, self.w, force)
        return found

    @property
    def shape(self) -> Array:
        """The motion v of all DOFs, (n,)."""
        found = np.zeros(self.free.size)
        found[self.free] = self.v
        return found

    @property
    def turning(self) -> Array:
        """The same, of which no part rotates or stretches by more than one."""
        fastest = float(np.abs(self.body.system.space.rates(self.point.q, self.shape)).max())
        return self.shape / fastest

    def product(self, state: tuple[Body, Array, float]) -> Array:
        """K v of a body at DOFs and a load factor, (free,)."""
        body, q, factor = state
        return body.tangent(q, self.point.history, factor).product(self.shape)[self.free]

    def softening(self, state: Callable[[float], tuple[Body, Array, float]]) -> float:
        """Derivative of w . K v along bodies, DOFs and load factors."""
        found = slope(lambda step: np.array([self.w @ self.product(state(step))]), self.floor)
        return float(_smooth(found)[0])


def _true_rate(at: _Critical, moved: Moved, limit: bool) -> float:
    """Rate of the factor of a limit point or of a bifurcation; sets that of the DOFs along their path."""
    body, point, factor = at.body, at.point, at.point.factor
    gap = moved.gap()
    force = (moved.unbalanced() + at.tangent.product(gap))[at.free]
    along = float(at.w @ force)
    if limit:
        rate = -along / float(at.w @ at.by_load)
        held = gap + rate * body.system.prescribed_rate(factor)
        moved.rate = at.answer(force + rate * at.by_load, held)
        return rate
    if abs(along) > max(_BALANCED * float(np.linalg.norm(force)), _NOISE * point.rounding):
        raise InputError(
            "the parameter breaks the symmetry of the bifurcation, which ends with it; the load falls more steeply "
            "than any straight line"
        )
    moved.rate = at.answer(force, gap)
    by_load = at.answer(at.by_load, body.system.prescribed_rate(factor))
    softer = at.softening(lambda s: (moved.body(s), moved.q(s), factor))
    softer_by_load = at.softening(lambda s: (body, point.q + s * factor * by_load, factor * (1 + s)))
    softer_by_mode = at.softening(lambda s: (body, point.q + s * at.turning, factor))
    if abs(softer_by_mode) > _ASYMMETRIC * abs(softer_by_load):
        raise InputError(
            "the bifurcation is not symmetric; give the body a small imperfection, which makes a limit point of it"
        )
    rate = -factor * softer / softer_by_load
    moved.rate = moved.rate + rate * by_load
    return rate


def _special_shapes(
    at: _Critical, moved: Moved, true: SpecialPoint, rate: float
) -> Callable[[float], Mapping[str, Field]]:
    """The special point and its mode after a step; rate : of its load factor."""
    factor = at.point.factor

    def state(step: float) -> tuple[Body, Array, float]:
        return moved.body(step), moved.q(step), factor + step * rate

    if true.limit:
        softer = at.softening(state)
        by_mode = at.softening(lambda s: (at.body, at.point.q + s * at.turning, factor))
        moved.rate = moved.rate - softer / by_mode * at.turning
    change = slope(lambda step: at.product(state(step)), at.floor / float(np.abs(at.w).max())).value
    shape_rate = np.zeros_like(at.shape)
    shape_rate[at.free] = _bordered(at.stiffness, at.v, at.w, change)

    def after(step: float) -> Mapping[str, Field]:
        body, q, load = state(step)
        point = replace(at.point, q=q, factor=load)
        special = replace(true, point=point, mode=at.shape + step * shape_rate).unframed(body.system)
        return special_fields(body.problem.rod, body.geometry, [special])[0]

    return after
