"""The layout of a rod: N vertices, each a position and its directors, all vectors of one space.

It gives the names of degrees of freedom (DOFs), the rigid motions and the mass band, in the plane and in space.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
T = TypeVar("T", bound=np.generic)


@dataclass(frozen=True)
class Kinematics:
    """DOFs of shape (N, m, d), flat (N m d,): N vertices, m vectors each, d components of each.

    axes : names of the d components.  vectors : names of the m vectors: the position, then the directors.
    """

    axes: tuple[str, ...]
    vectors: tuple[str, ...]

    @property
    def dimension(self) -> int:
        """d."""
        return len(self.axes)

    @property
    def per_vertex(self) -> int:
        """m d, the number of DOFs of a vertex."""
        return len(self.vectors) * len(self.axes)

    @property
    def dofs(self) -> tuple[str, ...]:
        """Names of the DOFs of a vertex: a vector and the digit of an axis."""
        return tuple(f"{vector}{axis[-1]}" for vector in self.vectors for axis in self.axes)

    def split(self, q: NDArray[T]) -> NDArray[T]:
        """Flat DOFs (..., N m d), or a mask of them, as vectors, (..., N, m, d)."""
        return q.reshape(*q.shape[:-1], -1, len(self.vectors), len(self.axes))

    def parts(self, q: Array) -> Array:
        """Edges, then directors, at flat DOFs (..., n): (..., N - 1 + N (m - 1), d)."""
        vectors = self.split(q)
        edges, directors = np.diff(vectors[..., 0, :], axis=-2), vectors[..., 1:, :]
        shape = (*directors.shape[:-3], -1, self.dimension)
        return np.concatenate([edges, directors.reshape(shape)], axis=-2)

    def rigid_motions(self, q: Array) -> Array:
        """Velocities that deform nothing, at flat DOFs: shape (d + d (d - 1) / 2, N m d).

        Translations along the axes, then rotations about the origin, from the first axis of a pair towards the second.
        """
        vectors = self.split(q)
        pairs = list(itertools.combinations(range(self.dimension), 2))
        fields = np.zeros((self.dimension + len(pairs), *vectors.shape))
        for axis in range(self.dimension):
            fields[axis, :, 0, axis] = 1.0
        for field, (a, b) in zip(fields[self.dimension :], pairs, strict=True):
            field[..., a], field[..., b] = -vectors[..., b], vectors[..., a]
        return fields.reshape(fields.shape[0], -1)

    def mass_band(self, own: Array, shared: Array | None = None) -> Array:
        """The mass matrix as a symmetric band, (..., N m d, (2 m - 1) d + 1).

        own : (m, m, ..., N) masses between the vectors of a vertex [kg].
        shared : (m, m, ..., N - 1) masses between a vector of a vertex and one of the next vertex [kg]; None: none.
        """
        m, d = len(self.vectors), self.dimension
        band = np.zeros((*own.shape[2:], m, d, (2 * m - 1) * d + 1))
        for a, b in itertools.product(range(m), repeat=2):
            if b >= a:
                band[..., a, :, (b - a) * d] = own[a, b, ..., None]
            if shared is not None:
                band[..., :-1, a, :, (m + b - a) * d] = shared[a, b, ..., None]
        return band.reshape(*own.shape[2:-1], own.shape[-1] * m * d, -1)


PLANAR = Kinematics(("E3", "E2"), ("x", "d"))
"""A rod in the plane of E3 and E2, eq. (3.3.42)."""
SPATIAL = Kinematics(("E1", "E2", "E3"), ("x", "d1_", "d2_"))
"""A rod in space with two directors, as in Chapter 1; it has no energy yet."""


def lengths(vectors: Array) -> Array:
    """Norms of vectors (..., d): (...,)."""
    planar = vectors.shape[-1] == 2
    norms: Array = (
        np.hypot(vectors[..., 0], vectors[..., 1]) if planar else np.linalg.norm(vectors, axis=-1)
    )
    return norms


def rotation_rates(vectors: Array, rates: Array) -> Array:
    """Rates of rotation of vectors (k, d) that change at rates (k, d): (k, d (d - 1) / 2) [rad]."""
    square = (vectors**2).sum(axis=1)
    pairs = itertools.combinations(range(vectors.shape[1]), 2)
    turning = [(vectors[:, a] * rates[:, b] - vectors[:, b] * rates[:, a]) / square for a, b in pairs]
    return np.column_stack(turning)


def stretch_rates(vectors: Array, rates: Array) -> Array:
    """Rates of stretch of vectors (k, d) that change at rates (k, d), as fractions of their lengths: (k,)."""
    rate: Array = (vectors * rates).sum(axis=1) / (vectors**2).sum(axis=1)
    return rate


def rotated(vectors: Array, angles: Array) -> Array:
    """Vectors (k, d) rotated by angles as from `rotation_rates`, (k, d (d - 1) / 2) [rad]."""
    if vectors.shape[1] == 2:
        c, s = np.cos(angles[:, 0]), np.sin(angles[:, 0])
        return np.column_stack(
            [c * vectors[:, 0] - s * vectors[:, 1], s * vectors[:, 0] + c * vectors[:, 1]]
        )
    axes = angles[:, ::-1] * [1, -1, 1]  # rotations from 1 to 2, 1 to 3 and 2 to 3 are about 3, -2 and 1
    angle = np.linalg.norm(axes, axis=1)[:, None]
    unit = axes / np.maximum(angle, np.finfo(float).tiny)
    along = (unit * vectors).sum(axis=1)[:, None] * unit
    turned: Array = (
        np.cos(angle) * vectors + np.sin(angle) * np.cross(unit, vectors) + (1 - np.cos(angle)) * along
    )
    return turned
