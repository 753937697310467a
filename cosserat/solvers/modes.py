"""Natural frequencies and mode shapes of small motions about a configuration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from cosserat.errors import InputError, UnstableError
from cosserat.solvers.banded import Band, Vector, band_product, negative_eigenvalues
from cosserat.solvers.integrate import free_matrices
from cosserat.solvers.system import History, MechanicalSystem, Tangent

Dense = NDArray[np.float64]
_ROUND_OFF_FRACTION = 16 * float(np.finfo(float).eps)  # of the largest squared frequency


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
            "kind = 'rod motion' how they grow or fade"
        )
    stiffness, mass = (matrix.toarray() for matrix in free_matrices(system, q, history))
    if supported:
        rounding, growing = 0.0, _count_unstable(system, q, history)
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


def _count_unstable(system: MechanicalSystem, q: Vector, history: History | None) -> int:
    """Number of negative eigenvalues of the Hessian at q, of the free DOFs."""
    tangent = Tangent(system)
    system.assemble(q, system.history if history is None else history, 1.0, tangent)
    tangent.constrain(system.constrained)
    tangent.band[system.constrained, 0] = 1.0
    return negative_eigenvalues(tangent.band)


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
