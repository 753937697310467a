"""Critical load factors that move with a parameter to first order.

derived, linear criterion: (K + f G) v = 0 and its left vector w give f' = -w . (K' + f G') v / (w . G v).
derived, true criterion: there the gradient r is zero and the Hessian K singular, K v = 0, w . K = 0.  At a limit point
w . r' = 0 along the path, so f' = -(w . r_p) / (w . r_f).  At a bifurcation both products are zero.  Then K keeps its
zero along the path: with a and b the changes of the DOFs with p and f, f' = -w . K_a v / (w . K_b v), K_a the change of
the Hessian along a, and K_b along b.  A parameter that breaks the symmetry has w . r_p other than zero: the bifurcation
ends, and the factor falls with a power below one of it.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence, Set
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import CosseratError, InputError
from cosserat.problems.critical import RodCriticalLoads
from cosserat.problems.moving_starts import moving_start
from cosserat.problems.tangents import (
    Body,
    Made,
    Motion,
    Moved,
    Nearby,
    body_after,
    total_mass,
)
from cosserat.solution import Solution
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
_LACKS = "only load factors of critical loads have derivatives"


class MovedFactors:
    """Load factors of both criteria and their rates."""

    lacks = _LACKS

    def __init__(self, base: Solution, near: Nearby, rates: dict[str, Array]) -> None:
        self.base, self.near, self.rates = base, near, rates

    def solution(self, step: float) -> Solution:
        """The factors after a step, to first order, and the mass of the rod."""
        problem = self.near(step)
        fields, labels = total_mass(problem, problem.geometry)
        for name, rate in self.rates.items():
            dims, values = self.base.fields[name]
            fields[name] = (dims, values + step * rate)
        return Solution(fields, {}, {**self.base.labels, **labels})


def moving_critical(
    problem: RodCriticalLoads, nearby: Sequence[Nearby], name: str, wanted: Set[str] = frozenset()
) -> Motion:
    """The critical loads of a problem, moving with each of several parameters.

    wanted : names of fields; all of them move.

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
        rates: dict[str, Array] = {}
        why = ""
        try:
            made = moving_start(problem, near, name)
            if linear.factor.size:
                bodies = _bodies(body, near, made)
                rates["linear_load_factor"] = _linear_rates(bodies, linear, problem.newton, name)
            if true is not None:
                rates["special_load_factor"] = np.array([_true_rate(body, near, made, true)])
        except CosseratError as error:
            why = str(error)
        ways.append(MovedFactors(result, near, rates))
        lost.append(why)
    return Motion(result, tuple(ways), tuple(lost))


def _bodies(body: Body, near: Nearby, made: Made | None) -> Callable[[float], Body]:
    """The body after a step."""

    @functools.cache
    def after(step: float) -> Body:
        own = body if step == 0.0 else body_after(step, near, made)
        if not np.array_equal(own.system.constrained, body.system.constrained):
            raise InputError("the parameter changes which degrees of freedom are held")
        return own

    return after


def _linear_rates(
    bodies: Callable[[float], Body], linear: LinearCriterion, settings: NewtonSettings, name: str
) -> Array:
    """Rates of the factors of the linear criterion, (k,)."""
    body, factors = bodies(0.0), linear.factor
    if (np.abs(np.diff(factors)) <= _APART * factors[1:]).any():
        raise InputError("two modes of the linear criterion share a load factor")
    free = ~body.system.constrained
    right = [mode[free] for mode in linear.mode]

    def matrices(step: float) -> tuple[Any, Any]:
        return criterion_matrices(EquilibriumSolver(bodies(step).system, settings, name))

    stiffness, geometric = matrices(0.0)
    left = right
    if not body.system.symmetric:
        left = [_null(stiffness + f * geometric)[1] for f in factors]

    def products(step: float) -> Array:
        K, G = matrices(step)
        return np.array(
            [w @ (K @ v + f * (G @ v)) for f, v, w in zip(factors, right, left, strict=True)]
        )

    floor = max(
        float(np.abs(w) @ (abs(stiffness) @ np.abs(v))) for v, w in zip(right, left, strict=True)
    )
    change = _smooth(slope(products, _EPS * floor))
    weight = [float(w @ (geometric @ v)) for v, w in zip(right, left, strict=True)]
    found: Array = -change / np.array(weight)
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
        from scipy.sparse import block_array
        from scipy.sparse.linalg import spsolve

        matrix = block_array([[self.stiffness, self.w[:, None]], [self.v[None], None]]).tocsc()
        found = np.where(self.free, 0.0, held)
        found[self.free] = spsolve(matrix, np.append(-force, 0.0))[:-1]
        return found

    def softening(self, state: Callable[[float], tuple[Body, Array, float]]) -> float:
        """Derivative of w . K v along bodies, DOFs and load factors."""

        def product(step: float) -> Array:
            body, q, factor = state(step)
            tangent = body.tangent(q, self.point.history, factor)
            whole = np.zeros(self.free.size)
            whole[self.free] = self.v
            return np.array([self.w @ tangent.product(whole)[self.free]])

        return float(_smooth(slope(product, self.floor))[0])


def _true_rate(body: Body, near: Nearby, made: Made | None, true: SpecialPoint) -> float:
    """Rate of the factor of a limit point or of a bifurcation."""
    at = _Critical(body, true)
    point, factor = true.point, true.point.factor
    moved = Moved(near, body, point, made)
    gap = moved.gap()
    force = (moved.unbalanced() + at.tangent.product(gap))[at.free]
    along = float(at.w @ force)
    if true.limit:
        return -along / float(at.w @ at.by_load)
    if abs(along) > max(_BALANCED * float(np.linalg.norm(force)), _NOISE * point.rounding):
        raise InputError(
            "the parameter breaks the symmetry of the bifurcation, which ends with it; the load falls more steeply "
            "than any straight line"
        )
    moved.rate = at.answer(force, gap)
    rate = at.answer(at.by_load, body.system.prescribed_rate(factor))
    mode = np.zeros(at.free.size)
    mode[at.free] = at.v
    mode /= np.abs(body.system.space.rates(point.q, mode)).max()
    by_parameter = at.softening(lambda s: (moved.body(s), moved.q(s), factor))
    by_load = at.softening(lambda s: (body, point.q + s * factor * rate, factor * (1 + s)))
    by_mode = at.softening(lambda s: (body, point.q + s * mode, factor))
    if abs(by_mode) > _ASYMMETRIC * abs(by_load):
        raise InputError(
            "the bifurcation is not symmetric; give the body a small imperfection, which makes a limit point of it"
        )
    return -factor * by_parameter / by_load
