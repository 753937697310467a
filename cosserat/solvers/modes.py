"""Natural frequencies and mode shapes of small motions about a configuration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from cosserat.errors import UnstableError
from cosserat.solvers.banded import Band, Vector, band_product
from cosserat.solvers.motion import System, free_matrices

_ROUNDING = 16 * float(np.finfo(float).eps)  # of a squared frequency, as a share of the largest one


@dataclass(frozen=True)
class Modes:
    """angular_frequency : (k,), lowest first [rad/s]; zero, to rounding, for motions that cost no energy.

    shape : (k, n), one a row, of unit kinetic energy at unit rate (v . M v = 1), its largest entry positive.
    """

    angular_frequency: Vector
    shape: NDArray[np.float64]

    def coordinates(self, mass: Band, fields: NDArray[np.float64]) -> NDArray[np.float64]:
        """Shares of the modes in displacements or velocities: shape . M field, (t, n) -> (t, k)."""
        weighted = np.array([band_product(mass, field) for field in fields])
        shares: NDArray[np.float64] = weighted @ self.shape.T
        return shares


def modes(system: System, q: Vector, count: int, name: str) -> Modes:
    """The lowest `count` modes about q, with the held unknowns at rest.

    Raises
    ------
    UnstableError : some small motions about q grow.
    """
    stiffness, mass = (matrix.toarray() for matrix in free_matrices(system, q))
    all_squared = eigh(stiffness, mass, eigvals_only=True)
    rounding = _ROUNDING * all_squared[-1]
    growing = int((all_squared < -rounding).sum())
    if growing:
        raise UnstableError(
            f"{name}: what it vibrates about is unstable in {growing} direction{'s' * (growing > 1)}, along which "
            "small motions grow instead of swinging; lessen the loads, or nudge the rod by a small force so that it "
            "comes to rest in a stable equilibrium"
        )
    squared, vectors = eigh(stiffness, mass, subset_by_index=(0, min(count, mass.shape[0]) - 1))
    shapes = np.zeros((squared.size, q.size))
    shapes[:, ~system.held] = vectors.T
    largest = np.take_along_axis(shapes, np.abs(shapes).argmax(axis=1)[:, None], axis=1)
    frequencies = np.sqrt(np.where(squared > rounding, squared, 0.0))
    return Modes(frequencies, shapes * np.sign(largest))


def first_elastic_frequency(system: System, q: Vector) -> float:
    """The lowest angular frequency about q that is not zero to rounding: of the first motion that deforms [rad/s]."""
    squared = eigh(*(matrix.toarray() for matrix in free_matrices(system, q)), eigvals_only=True)
    return float(np.sqrt(squared[squared > _ROUNDING * squared[-1]][0]))
