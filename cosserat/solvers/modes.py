"""Natural frequencies and mode shapes of small motions about a configuration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from cosserat.solvers.banded import Vector
from cosserat.solvers.motion import System, free_matrices


@dataclass(frozen=True)
class Modes:
    """angular_frequency : (k,), lowest first [rad/s]; zero for motions that cost no energy.

    shape : (k, n), one a row, of unit kinetic energy at unit rate (v . M v = 1), its largest entry positive.
    """

    angular_frequency: Vector
    shape: NDArray[np.float64]


def modes(system: System, q: Vector, count: int) -> Modes:
    """The lowest `count` modes about q, with the held unknowns at rest."""
    stiffness, mass = free_matrices(system, q)
    dense = (stiffness.toarray(), mass.toarray())
    squared, vectors = eigh(*dense, subset_by_index=(0, min(count, mass.shape[0]) - 1))
    shapes = np.zeros((squared.size, q.size))
    shapes[:, ~system.held] = vectors.T
    largest = np.take_along_axis(shapes, np.abs(shapes).argmax(axis=1)[:, None], axis=1)
    return Modes(np.sqrt(np.maximum(squared, 0.0)), shapes * np.sign(largest))
