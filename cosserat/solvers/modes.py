"""Natural frequencies and mode shapes of small motions about a configuration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cholesky, eig, eigh, solve, solve_triangular

from cosserat.errors import InputError, UnstableError
from cosserat.solvers.banded import Band, Vector, band_product, to_sparse
from cosserat.solvers.integrate import free_matrices
from cosserat.solvers.system import History, MechanicalSystem
from cosserat.solvers.tangent import Tangent

if TYPE_CHECKING:
    from scipy.sparse import dia_array

Dense = NDArray[np.float64]
Complex = NDArray[np.complex128]
MOST_DENSE = 300
"""Free DOFs up to which all eigenvalues are found by dense methods; beyond, a few by sparse ones."""
FEW = 5
"""Free DOFs for each mode that is asked for, below which all are found."""
_SHIFT = 100.0  # of the round-off, from which squared frequencies of a free body are first sought
_ROUND_OFF_FRACTION = 16 * float(np.finfo(float).eps)  # of the largest squared frequency
_ROUGHLY = 1e-2  # tolerance of the highest eigenvalue, which only sizes round-off


@dataclass(frozen=True)
class Modes:
    """angular_frequency : (k,), lowest first [rad/s]; zero, to rounding, for motions that cost no energy.

    shape : (k, n), one mode per row, normalised to v . M v = 1, its largest entry positive.
    """

    angular_frequency: Vector
    shape: NDArray[np.float64]

    def coordinates(self, mass: Band, fields: NDArray[np.float64]) -> NDArray[np.float64]:
        """Modal coordinates of displacements or velocities: shape . M field, (t, n) -> (t, k)."""
        weighted = np.array([band_product(mass, field) for field in fields])
        coordinates: NDArray[np.float64] = weighted @ self.shape.T
        return coordinates


def modes(
    system: MechanicalSystem,
    q: Vector,
    count: int,
    name: str,
    *,
    supported: bool,
    history: History | None = None,
) -> Modes:
    """The lowest `count` modes about q, with the constrained DOFs at rest.

    supported : no rigid motion is free, so a stable body has no zero frequency.
    history : the internal variables there; None: those of the start.

    Raises
    ------
    UnstableError : some small motions about q grow.
    InputError : a load has no potential, so that the Hessian is not symmetric.
    """
    if not system.symmetric:
        raise InputError(
            f"{name}: a load has no potential, so small motions need not be vibrations; leave it out, or compute with "
            "kind = 'modes' how they grow or fade"
        )
    stiffness, mass = (matrix.toarray() for matrix in free_matrices(system, q, history))
    if supported:
        rounding, growing = 0.0, _tangent(system, q, history).negative()
    else:
        every = eigh(stiffness, mass, eigvals_only=True)
        rounding = _ROUND_OFF_FRACTION * every[-1]
        growing = int((every < -rounding).sum())
    if growing:
        raise UnstableError(
            f"{name}: its equilibrium is unstable in {growing} direction{'s' * (growing > 1)}, along which "
            "small motions grow instead of oscillating; reduce the loads, or add a small force so that the rod "
            "comes to rest in a stable equilibrium"
        )
    squared, vectors = _lowest(stiffness, mass, min(count, mass.shape[0]), supported)
    shapes = np.zeros((squared.size, q.size))
    shapes[:, ~system.constrained] = vectors.T
    largest = np.take_along_axis(shapes, np.abs(shapes).argmax(axis=1)[:, None], axis=1)
    frequencies = np.sqrt(np.where(squared > rounding, squared, 0.0))
    return Modes(frequencies, shapes * np.sign(largest))


def _tangent(system: MechanicalSystem, q: Vector, history: History | None) -> Tangent:
    """The Hessian at q, its constrained DOFs uncoupled."""
    tangent = Tangent(system)
    system.assemble(q, system.history if history is None else history, 1.0, tangent)
    tangent.constrain(system.constrained)
    tangent.band[system.constrained, 0] = 1.0
    return tangent


def _lowest(stiffness: Dense, mass: Dense, count: int, supported: bool) -> tuple[Vector, Dense]:
    """The lowest squared frequencies and their modes, v . M v = 1, as columns.

    For a supported body they are the largest of the inverse problem, without the round-off of the stiffest modes.
    """
    if not supported:
        squared, vectors = eigh(stiffness, mass, subset_by_index=(0, count - 1))
        return squared, vectors
    last = mass.shape[0] - 1
    inverse, vectors = eigh(mass, stiffness, subset_by_index=(last - count + 1, last))
    return 1 / inverse[::-1], vectors[:, ::-1] / np.sqrt(inverse[::-1])


def first_elastic_frequency(system: MechanicalSystem, q: Vector, *, supported: bool) -> float:
    """The lowest angular frequency about q that is not zero to round-off: that of a motion that deforms [rad/s]."""
    stiffness, mass = (matrix.toarray() for matrix in free_matrices(system, q))
    if supported:
        return float(np.sqrt(_lowest(stiffness, mass, 1, supported)[0][0]))
    squared = eigh(stiffness, mass, eigvals_only=True)
    return float(np.sqrt(squared[squared > _ROUND_OFF_FRACTION * squared[-1]][0]))


@dataclass(frozen=True)
class SmallMotions:
    """Small motions about an equilibrium, exp((growth + i frequency) t) times a shape each, without damping.

    growth : (k,) real parts [1/s]: positive where a motion grows, zero where it vibrates.
    angular_frequency : (k,) imaginary parts, lowest first, none negative [rad/s].
    shape : (k, n) complex, normalised to conj(v) . M v = 1; real for a symmetric Hessian.

    Each stands for two motions: if it neither grows nor vibrates at once, the other has the opposite sign.  A growing
    pair of a flutter is followed by the pair of the same frequency that fades.
    """

    growth: Vector
    angular_frequency: Vector
    shape: Complex


def small_motions(
    system: MechanicalSystem,
    q: Vector,
    count: int,
    *,
    supported: bool,
    history: History | None = None,
) -> SmallMotions:
    """The `count` small motions of the smallest modulus about q, which may be unstable, with any loads.

    derived: s^2 M v + K v = 0; for each k of K v = k M v, s is the root of -k whose imaginary part is not negative.
    For real k < 0 a body diverges; complex k, which only loads without a potential make, are flutter.  If K is not
    singular, l' K^-1 l with M = l l' gives 1 / k: the softest motions are free of the round-off of the stiffest.

    supported : no rigid motion is free.
    """
    free = ~system.constrained
    tangent = _tangent(system, q, history)
    stiffness = to_sparse(tangent.band, tangent.skew)[free][:, free].tocsc()
    mass = to_sparse(system.inertia)[free][:, free].tocsc()
    count = min(count, mass.shape[0])
    squared: Vector | Complex
    vectors: Dense | Complex
    if system.symmetric:
        squared, vectors = _symmetric(stiffness, mass, count, tangent.negative(), supported=supported)
    else:
        squared, vectors = _general(stiffness, mass, count, supported=supported)
    shapes = np.zeros((squared.size, q.size), complex)
    shapes[:, free] = vectors.T
    return rooted(squared.astype(complex), shapes)


def rooted(squared: Complex, shapes: Complex) -> SmallMotions:
    """Small motions of eigenvalues k (k,) and their shapes (k, n), in order."""
    root = np.emath.sqrt(-squared)
    root *= np.where((root.imag < 0) | ((root.imag == 0) & (root.real < 0)), -1, 1)
    order = np.lexsort((-root.real, root.imag))
    found = root[order]
    return SmallMotions(np.asarray(found.real, float), np.asarray(found.imag, float), shapes[order])


def _symmetric(
    stiffness: dia_array, mass: dia_array, count: int, negative: int, *, supported: bool
) -> tuple[Vector, Dense]:
    """The lowest eigenvalues k and their v, v . M v = 1, as columns; zero where they are round-off."""
    if mass.shape[0] > max(MOST_DENSE, FEW * count):
        more = count + negative * supported  # those nearest zero, on both sides
        squared, vectors = _sparse(stiffness, mass, more, supported=supported)
        return squared[:count], vectors[:, :count]
    if not supported:
        K, M = stiffness.toarray(), mass.toarray()
        squared, vectors = eigh(K, M)
        rounding = _ROUND_OFF_FRACTION * squared[-1]
        return np.where(np.abs(squared) > rounding, squared, 0.0)[:count], vectors[:, :count]
    if not negative:
        return _lowest(stiffness.toarray(), mass.toarray(), count, supported)
    inverse, shapes = _inverted(stiffness, mass, symmetric=True)
    squared = 1 / inverse.real
    order = np.argsort(squared)[:count]
    return squared[order], shapes.real[:, order]


def _general(
    stiffness: dia_array, mass: dia_array, count: int, *, supported: bool
) -> tuple[Complex, Complex]:
    """The eigenvalues k of the smallest modulus and their v, conj(v) . M v = 1, as columns."""
    if mass.shape[0] > max(MOST_DENSE, FEW * count):
        from scipy.sparse.linalg import eigs

        squared, vectors = eigs(stiffness, count, mass, sigma=0.0, v0=np.ones(mass.shape[0]))
    elif supported:
        inverse, vectors = _inverted(stiffness, mass, symmetric=False)
        squared = 1 / inverse
    else:
        lower = cholesky(mass.toarray(), lower=True)
        half = solve_triangular(lower, stiffness.toarray(), lower=True)
        squared, vectors = eig(solve_triangular(lower, half.T, lower=True).T)
        vectors = solve_triangular(lower.T, vectors)
        squared = np.where(np.abs(squared) > _ROUND_OFF_FRACTION * np.abs(squared).max(), squared, 0.0)
    order = np.argsort(np.abs(squared), kind="stable")[:count]
    squared, vectors = squared[order], vectors[:, order].astype(complex)
    sizes = np.einsum("ij,ij->j", vectors.conj(), mass @ vectors).real
    return squared, vectors / np.sqrt(sizes)


def _inverted(stiffness: dia_array, mass: dia_array, *, symmetric: bool) -> tuple[Complex, Complex]:
    """Every 1 / k of K v = k M v, and v as columns, conj(v) . M v = 1 where K is symmetric."""
    lower = cholesky(mass.toarray(), lower=True)
    compliance = lower.T @ solve(stiffness.toarray(), lower, assume_a="sym" if symmetric else "gen")
    values, vectors = eigh((compliance + compliance.T) / 2) if symmetric else eig(compliance)
    return values, solve_triangular(lower.T, vectors)


def _sparse(
    stiffness: dia_array, mass: dia_array, count: int, *, supported: bool
) -> tuple[Vector, Dense]:
    """Eigenvalues nearest zero of a large symmetric problem, lowest first, by shifted inverse Lanczos iterations."""
    from scipy.sparse.linalg import eigsh

    start = np.ones(mass.shape[0])
    rounding = 0.0
    if not supported:
        (most,) = eigsh(
            stiffness, 1, mass, which="LM", v0=start, tol=_ROUGHLY, return_eigenvectors=False
        )
        rounding = _ROUND_OFF_FRACTION * abs(most)
    shift = -_SHIFT * rounding
    squared, vectors = eigsh(stiffness, count, mass, sigma=shift, v0=start)
    elastic = squared[squared > -shift]
    if (
        not supported and elastic.size
    ):  # so near to zero the matrix that is solved with is hardly regular
        squared, vectors = eigsh(stiffness, count, mass, sigma=-elastic.min(), v0=start)
    order = np.argsort(squared)
    return np.where(np.abs(squared) > rounding, squared, 0.0)[order], vectors[:, order]
