"""Natural modes that move with a parameter to first order.

derived: (K - k M) v = 0 with conj(v) . M v = 1 give, with K and M along the tangent of the equilibrium,
(K - k M) v' - M v k' = -(K' - k M') v and conj(v) . M v' = -conj(v) . M' v / 2: one bordered linear system for the
rates k' and v' of an eigenvalue of its own, symmetric or not.  Its first row times the left vector is the familiar
k' = v . (K' - k M') v.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from cosserat.problems.modes import RodModes
from cosserat.problems.moving_starts import begun_after
from cosserat.problems.posed import PosedProblem
from cosserat.problems.static import equilibrium_solution
from cosserat.problems.tangents import Body, Motion, Moved, Nearby, move
from cosserat.rods.holding import free_motions
from cosserat.rods.reference import Geometry
from cosserat.solution import Solution
from cosserat.solvers.banded import absolute_product, band_product, to_sparse
from cosserat.solvers.equilibrium import EquilibriumSolver
from cosserat.solvers.modes import rooted, small_motions
from cosserat.solvers.slopes import slope
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
_APART = 1e-7  # of an eigenvalue, within which two are one
_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Eigenvalues:
    """k : (K,) of K v = k M v.  vectors : (K, n) in frames, conj(v) . M v = 1.  single : (K,) those of their own."""

    k: Complex
    vectors: Complex
    single: NDArray[np.bool_]


class MovedModes:
    """The result of a problem of modes."""

    def __init__(self, moved: Moved, modes: Eigenvalues, name: str) -> None:
        self.moved, self.modes, self.name = moved, modes, name
        self.rates = np.zeros_like(modes.k), np.zeros_like(modes.vectors)
        self.lacks = "" if modes.single.all() else "modes of one frequency have no shapes of their own"

    def solve(self) -> None:
        """Set the rates of eigenvalues and vectors."""
        k, vectors = self.modes.k, self.modes.vectors
        stiff, heavy = self._products()
        for number in map(int, np.flatnonzero(self.modes.single)):
            change = stiff[number] - k[number] * heavy[number]
            inertial = np.vdot(vectors[number], heavy[number])
            self.rates[0][number], self.rates[1][number] = self._bordered(number, change, inertial)
        for group in _groups(k, ~self.modes.single & (k != 0)):
            change = stiff[group] - k[group, None] * heavy[group]
            own = np.linalg.eigvals(vectors[group].conj() @ change.T)
            self.rates[0][group] = own[np.argsort(own.real)]

    def _products(self) -> tuple[Complex, Complex]:
        """Derivatives of K v and M v along the tangent, each (K, n)."""
        parts = np.concatenate([self.modes.vectors.real, self.modes.vectors.imag])
        moved = self.moved
        band = moved.base.tangent(moved.point.q, moved.point.history, moved.point.factor).band
        floor = _EPS * max(float(absolute_product(band, part).max()) for part in parts)

        def stiff(step: float) -> Array:
            body = moved.body(step)
            tangent = body.tangent(moved.q(step), moved.point.history, moved.point.factor)
            return np.array([tangent.product(part) for part in parts])

        def heavy(step: float) -> Array:
            mass = moved.body(step).system.inertia
            return np.array([band_product(mass, part) for part in parts])

        found = [slope(stiff, floor).value, slope(heavy, 0.0).value]
        count = len(parts) // 2
        one, two = (values[:count] + 1j * values[count:] for values in found)
        return one, two

    def _bordered(self, number: int, change: Complex, inertial: complex) -> tuple[complex, Complex]:
        """The rates of one eigenvalue and of its vector (n,)."""
        from scipy.sparse import block_array
        from scipy.sparse.linalg import splu

        moved, free = self.moved, ~self.moved.base.system.constrained
        stiffness, mass = _free_matrices(moved)
        k, v = self.modes.k[number], self.modes.vectors[number][free]
        side = (mass @ v)[:, None]
        matrix = block_array([[stiffness - k * mass, -side], [-side.conj().T, None]]).tocsc()
        right = np.append(-change[free], inertial / 2)
        found = splu(matrix.astype(complex)).solve(right)
        rate = np.zeros(free.size, dtype=complex)
        rate[free] = found[:-1]
        return complex(found[-1]), rate

    def solution(self, step: float) -> Solution:
        """The equilibrium and its modes after a step, to first order."""
        body, state = self.moved.body(step), self.moved.state(step)
        problem = cast("RodModes", body.problem)
        k = self.modes.k + step * self.rates[0]
        found = rooted(k, self.modes.vectors + step * self.rates[1])
        solver = EquilibriumSolver(body.system, problem.newton, self.name)
        rest = equilibrium_solution(problem, body.geometry, state, solver)
        own = problem.mode_fields(body.geometry, body.system, state.q, found)
        if self.lacks:
            own = {
                name: field
                for name, field in own.items()
                if name in ("natural_frequency", "growth_rate", "total_mass", "total_inertia")
            }
        return replace(rest, fields={**rest.fields, **own})


def _unloaded(_: float, problem: PosedProblem, geometry: Geometry) -> MechanicalSystem:
    """The system about which a rod moves without its loads."""
    return problem.system(geometry).unloaded()


def _free_matrices(moved: Moved) -> tuple[Any, Any]:
    """K and M of the free DOFs at no step, sparse."""
    free = ~moved.base.system.constrained
    tangent = moved.base.tangent(moved.point.q, moved.point.history, moved.point.factor)
    matrices = to_sparse(tangent.band, tangent.skew), to_sparse(moved.base.system.inertia)
    stiffness, mass = (matrix[free][:, free].tocsc() for matrix in matrices)
    return stiffness, mass


def _groups(k: Complex, chosen: NDArray[np.bool_]) -> list[NDArray[np.int64]]:
    """Numbers of the chosen eigenvalues that are the same."""
    left, found = list(np.flatnonzero(chosen)), []
    while left:
        own = [i for i in left if abs(k[i] - k[left[0]]) <= _APART * max(abs(k[i]), abs(k[left[0]]))]
        found.append(np.array(own))
        left = [i for i in left if i not in own]
    return found


def _single(k: Complex, more: Complex) -> NDArray[np.bool_]:
    """Which eigenvalues are not zero and like no other of more of them."""
    near = np.abs(k[:, None] - more) <= _APART * np.abs(k)[:, None]
    return np.asarray((near.sum(axis=1) <= 1) & (k != 0))


def moving_modes(
    problem: RodModes, nearby: Sequence[Nearby], name: str, wanted: Set[str] = frozenset()
) -> Motion:
    """The modes of a problem, moving with each of several parameters.

    wanted : names of fields; all of them move.

    Raises
    ------
    CosseratError : it has no modes.
    """
    geometry = problem.geometry
    point, solver, _ = problem.settled_rod(geometry, name)
    system = solver.system
    bare = point.factor == 0.0
    base = Body(problem, geometry, system)
    moved = []
    for one in nearby:
        begun = begun_after(problem, one, name) if problem.start_from is not None else None
        moved.append(Moved(one, base, point, _unloaded if bare else begun))
    held = not free_motions(system).any()
    found, more = (
        small_motions(system, point.q, count, supported=held, history=point.history)
        for count in (problem.count, problem.count + 1)
    )
    k, others = (-((one.growth + 1j * one.angular_frequency) ** 2) for one in (found, more))
    modes = Eigenvalues(k, found.shape.astype(complex), _single(k, others))
    at_rest = MovedModes(Moved(lambda _: problem, base, point), modes, name)
    at_rest.lacks = ""
    ways, lost = [MovedModes(one, modes, name) for one in moved], move(moved) if moved else []
    for way, why in zip(ways, lost, strict=True):
        if not why:
            way.solve()
    return Motion(at_rest.solution(0.0), tuple(ways), tuple(lost))
