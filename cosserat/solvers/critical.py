"""Critical loads: by the linear criterion where the loads begin, and by the true one along the path of equilibria.

Linear: with K the Hessian where the loads begin and f the load factor, K + f G is singular at f.  G, the geometric
stiffness, is that of the stresses of the first-order answer to the load, and that of the loads.  As everywhere in
linear buckling, the shape is the one where the loads begin.  Its change would turn the stiff directions of a thin
curved rod: to first order alone, without the square of that turn, the stiffness falls without bound.
True: the Hessian on the path of equilibria is singular, at the first bifurcation or limit point of the path.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig, eigh

from cosserat.errors import UnstableError
from cosserat.solvers.arcs import rate_with_load
from cosserat.solvers.banded import Vector, to_sparse
from cosserat.solvers.continuation import ArcLengthSettings, trace_path
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver
from cosserat.solvers.incremental import unloaded
from cosserat.solvers.modes import FEW, MOST_DENSE
from cosserat.solvers.special import SpecialPoint, special_points
from cosserat.solvers.system import History, MechanicalSystem
from cosserat.solvers.tangent import Tangent

if TYPE_CHECKING:
    from scipy.sparse import dia_array

Fields = NDArray[np.float64]
_LARGEST_RATE = 2.0**-4  # rotation [rad] or stretch of a part in the longest difference
_LEVELS = 4  # of Richardson's extrapolation, each half the step of the one before
_NEGLIGIBLE = 1e-9  # of the largest inverse factor, below which one is round-off
_BESIDE = 1e-6  # of a factor, at which the determinant is compared on both sides


@dataclass(frozen=True)
class LinearCriterion:
    """factor : (k,) of the load, positive, lowest first.  mode : (k, n), its largest entry one."""

    factor: Vector
    mode: Fields


def linear_criterion(solver: EquilibriumSolver, count: int) -> LinearCriterion:
    """The lowest positive factors at which K + f G is singular, at most `count`.

    derived: the stresses on the path are those at q + f times its rate, up to second order in f.  Differences of the
    Hessian under them at f and -f have errors in even powers of f, which the extrapolation removes.
    Without a potential K is not symmetric; real factors are those of divergence, and flutter has none.

    Raises
    ------
    NotConvergedError : there is no equilibrium from which the loads could grow.
    UnstableError : the body is unstable there.
    """
    system = solver.system
    stiffness, geometric = criterion_matrices(solver)
    inverse, vectors = _inverse_factors(-geometric, stiffness, count, symmetric=system.symmetric)
    largest = float(np.abs(inverse).max(initial=0.0))
    order = np.argsort(-inverse, kind="stable")
    chosen = [i for i in order if inverse[i] > _NEGLIGIBLE * largest][:count]
    modes = np.zeros((len(chosen), system.constrained.size))
    modes[:, ~system.constrained] = vectors[:, chosen].T
    modes /= np.take_along_axis(modes, np.abs(modes).argmax(axis=1)[:, None], axis=1)
    return LinearCriterion(1 / inverse[chosen], modes)


def criterion_matrices(solver: EquilibriumSolver) -> tuple[dia_array, dia_array]:
    """K and G of the free DOFs, sparse.

    Raises
    ------
    NotConvergedError : there is no equilibrium from which the loads could grow.
    UnstableError : the body is unstable there.
    """
    system, start = solver.system, unloaded(solver)
    rate = rate_with_load(solver, start)
    if rate is None or not start.stable:
        raise UnstableError(
            f"{solver.name}: the body is unstable before its loads grow, so they do not make it so; fix more DOFs in "
            "'supports'"
        )
    return _hessian(system, start, start.q, 0.0), _slope(system, start, rate)


def _inverse_factors(
    geometric: dia_array, stiffness: dia_array, count: int, *, symmetric: bool
) -> tuple[Vector, Fields]:
    """Real g of geometric v = g stiffness v, the largest ones among them, and their v as columns."""
    if symmetric and geometric.shape[0] > max(MOST_DENSE, FEW * count):
        from scipy.sparse.linalg import eigsh

        start = np.ones(geometric.shape[0])
        inverse, vectors = eigsh(geometric, count, stiffness, which="LA", v0=start)
        return inverse, vectors
    if symmetric:
        inverse, vectors = eigh(geometric.toarray(), stiffness.toarray())
        return inverse, vectors
    values, vectors = eig(geometric.toarray(), stiffness.toarray())
    real = [
        i for i in np.flatnonzero(values.imag == 0) if _crosses(geometric, stiffness, values.real[i])
    ]
    return values.real[real], vectors.real[:, real]


def _crosses(geometric: dia_array, stiffness: dia_array, inverse: float) -> bool:
    """Whether the determinant of K + f G changes its sign at a factor, as it does where it is a single root.

    Under a load without a potential a multiple root of none, as of Beck's column, splits into many by round-off.
    """
    signs = [
        np.linalg.slogdet((inverse * (1 + away) * stiffness - geometric).toarray())[0]
        for away in (-_BESIDE, _BESIDE)
    ]
    return bool(signs[0] != signs[1])


def _hessian(system: MechanicalSystem, start: Equilibrium, q: Vector, factor: float) -> dia_array:
    """The Hessian of the free DOFs, sparse, in the shape of the start and under the stresses at q."""
    tangent = Tangent(system)
    system.assemble(q, start.history, factor, tangent, about=start.q)
    free = ~system.constrained
    return to_sparse(tangent.band, tangent.skew)[free][:, free].tocsc()


def _slope(system: MechanicalSystem, start: Equilibrium, rate: Vector) -> dia_array:
    """Derivative of that Hessian by the load factor, along the rate of the DOFs."""
    fastest = float(np.abs(system.space.rates(start.q, rate)).max())
    step = _LARGEST_RATE / fastest if fastest > 0 else 1.0

    def difference(f: float) -> dia_array:
        ahead, behind = (_hessian(system, start, start.q + g * rate, g) for g in (f, -f))
        return (ahead - behind) / (2 * f)

    table = [difference(step / 2**level) for level in range(_LEVELS)]
    for order in range(1, _LEVELS):
        table = [fine + (fine - coarse) / (4**order - 1) for coarse, fine in pairwise(table)]
    return table[0]


@dataclass(frozen=True)
class ScaledSystem(MechanicalSystem):
    """A body whose load factor counts in multiples of `scale` times its loads."""

    scale: float = 1.0

    @classmethod
    def of(cls, system: MechanicalSystem, scale: float) -> ScaledSystem:
        """A body with another unit of its load."""
        own = {field.name: getattr(system, field.name) for field in fields(MechanicalSystem)}
        return cls(**own, scale=scale)

    @cached_property
    def load_sizes(self) -> tuple[float, float]:
        """The largest force and the sum of all forces of the scaled loads at the reference [N]."""
        size = self.scale * self._reference_loads[1]
        return float(size.max()), float(size.sum())

    def assemble(
        self,
        q: Vector,
        history: History,
        factor: float,
        tangent: Tangent,
        *,
        about: Vector | None = None,
    ) -> bool:
        """As of any system, at the scaled factor."""
        return super().assemble(q, history, self.scale * factor, tangent, about=about)

    def prescribe(self, q: Vector, factor: float) -> Vector:
        """q with its constrained DOFs as prescribed at a load factor."""
        return super().prescribe(q, self.scale * factor)

    def prescribed_rate(self, factor: float) -> Vector:
        """Change of the constrained DOFs with the load factor."""
        return self.scale * super().prescribed_rate(self.scale * factor)

    def rate(self, factor: float, tangent: Tangent) -> Vector:
        """Derivative of the gradient by the load factor."""
        own = self.scale * tangent.load_gradient
        return own + tangent.product(self.prescribed_rate(factor)) if self.constraints.moving else own


def true_criterion(
    solver: EquilibriumSolver, arc: ArcLengthSettings
) -> Iterator[Equilibrium | SpecialPoint]:
    """The points of the path on which the body stays where symmetry lets it, with the special ones among them.

    Raises
    ------
    NotConvergedError : the path cannot be followed; the last point is its `state`.
    """
    known = 0
    for point in trace_path(solver, unloaded(solver), replace(arc, branches=0)):
        for before, after in solver.crossings[known:]:
            yield from special_points(solver.system, solver.name, before, after)
        known = len(solver.crossings)
        yield point


def first_special_point(
    solver: EquilibriumSolver, arc: ArcLengthSettings, unit: float
) -> tuple[SpecialPoint | None, float]:
    """The first special point, None if there is none up to the end of the search, and the load factor reached.

    unit : load factor in which the arcs and their end count.

    Raises
    ------
    NotConvergedError : the path cannot be followed, or loses its stability at a place that is not found; the last point
        is its `state`.
    """
    counted = f"{solver.name}, loads in multiples of {unit:.6g}"
    own = EquilibriumSolver(ScaledSystem.of(solver.system, unit), solver.settings, counted)
    own.remedy, own.limit_remedy = solver.remedy, solver.limit_remedy
    reached = 0.0
    for found in true_criterion(own, arc):
        solver.iterations = own.iterations
        if isinstance(found, SpecialPoint):
            point = replace(found.point, factor=unit * found.point.factor)
            return replace(found, point=point), point.factor
        if not found.stable:
            raise own.stopped(
                f"unstable between {reached:.6g} and {unit * found.factor:.6g} of the loads, at a place that is not "
                f"found; {solver.remedy}",
                found,
            )
        reached = unit * found.factor
    return None, reached
