"""The configuration space of a rod for the solvers: how its edges and directors rotate and stretch."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.kinematics import (
    PLANAR,
    Kinematics,
    lengths,
    rotated,
    rotation_rates,
    stretch_rates,
)
from cosserat.rods.space_kernel import planar
from cosserat.solvers.banded import Mask, Vector
from cosserat.solvers.members import FRACTION, PREDICTED, RATES
from cosserat.solvers.system import CompiledSpace

Array = NDArray[np.float64]
_MAX_ROTATION = 1.0  # of a director in one step [rad]
_NO_MASK, _NO_RATES = np.empty(0, dtype=np.bool_), np.empty((0, 2))


@dataclass(frozen=True)
class RodSpace:
    """Configurations of a rod, in the plane or in space.

    at_rest : positions and directors of the reference, flat (n,) [m].
    displacements : whether the DOFs are displacements from it; if not, they are positions and directors.
    rounded : (n,) added to the DOFs in the energy, zero for nothing.
    """

    kinematics: Kinematics
    at_rest: Vector
    displacements: bool
    rounded: Vector

    @cached_property
    def dimension(self) -> int:
        """Dimension of the space of positions and directors."""
        return self.kinematics.dimension

    @cached_property
    def compiled(self) -> CompiledSpace | None:
        """That of a planar rod."""
        if self.kinematics != PLANAR:
            return None
        none = np.zeros_like(self.at_rest)
        parts = 2 * (none.size // self.kinematics.per_vertex) - 1
        return CompiledSpace(planar, self.at_rest if self.displacements else none, parts)

    @cached_property
    def reference(self) -> Vector:
        """The DOFs (n,) of the reference configuration."""
        return np.zeros_like(self.at_rest) if self.displacements else self.at_rest

    @cached_property
    def scale(self) -> Vector:
        """Lengths of edges and directors, and additions to the DOFs: stretches are rounded as fractions of them."""
        sizes = np.empty_like(self.kinematics.split(self.at_rest))
        length = lengths(self.kinematics.parts(self.at_rest))
        count, directors = sizes.shape[-3] - 1, sizes[..., 1:, 0].shape
        sizes[..., :-1, 0, :] = length[..., :count, None]
        sizes[..., -1, 0, :] = length[..., count - 1, None]
        sizes[..., 1:, :] = length[..., count:].reshape(directors)[..., None]
        scale: Vector = np.maximum(sizes.reshape(self.at_rest.shape), np.abs(self.rounded))
        return scale

    def placed(self, q: Vector) -> Vector:
        """Positions and directors (n,) at the DOFs."""
        return self.at_rest + q if self.displacements else q

    def rigid_motions(self, q: Vector) -> Array:
        """Velocities that deform nothing, the translations first."""
        return self.kinematics.rigid_motions(self.placed(q))

    def max_step_fraction(self, q: Vector, step: Vector) -> float:
        """Largest fraction of a step that changes no director by more than its length, one radian."""
        if self.compiled is not None:
            kernel, placed, _ = self.compiled
            return kernel(FRACTION, placed, q, step, _NO_MASK, _NO_RATES)
        d = self.kinematics.split(self.placed(q))[:, 1:]
        change = self.kinematics.split(step)[:, 1:]
        fastest = float((lengths(change) / lengths(d)).max())
        return _MAX_ROTATION / fastest if fastest > 0 else np.inf

    def rotation_weights(self, q: Vector) -> Vector:
        """One over the lengths of the directors, zero for positions, (n,)."""
        vectors = self.kinematics.split(self.placed(q))
        weights = np.zeros_like(vectors)
        weights[:, 1:] = 1 / lengths(vectors[:, 1:])[..., None]
        return weights.ravel()

    def rates(self, q: Vector, change: Vector) -> Array:
        """How fast edges and directors rotate [rad] and stretch as the DOFs change, (parts, 2) in the plane."""
        if self.compiled is not None:
            kernel, placed, parts = self.compiled
            found = np.empty((parts, 2))
            kernel(RATES, placed, q, change, _NO_MASK, found)
            return found
        vectors, rates = self.kinematics.parts(self.placed(q)), self.kinematics.parts(change)
        return np.column_stack([rotation_rates(vectors, rates), stretch_rates(vectors, rates)])

    def predicted(
        self, q: Vector, moved: Array, prescribe: Callable[[Vector], Vector], constrained: Mask
    ) -> Vector:
        """The DOFs after given rotations and stretches of edges and directors.

        Rotated edges miss the supports; the gap is distributed along the rod between them.
        """
        if self.compiled is not None:
            kernel, given, _ = self.compiled
            new = prescribe(q)
            kernel(PREDICTED, given, q, new, constrained, moved)
            return new
        placed = self.placed(q)
        at, vectors = self.kinematics.split(placed), self.kinematics.parts(placed)
        vectors = rotated((1 + moved[:, -1:]) * vectors, moved[:, :-1])
        count = at.shape[0] - 1
        x = at[0, 0] + np.vstack([np.zeros(self.dimension), np.cumsum(vectors[:count], axis=0)])
        guess = np.concatenate(
            [x[:, None], vectors[count:].reshape(count + 1, -1, self.dimension)], axis=1
        )
        guess = guess - self.kinematics.split(self.at_rest if self.displacements else np.zeros_like(q))
        goal = self.kinematics.split(prescribe(guess.ravel()))
        for axis, mask in enumerate(self.kinematics.split(constrained)[:, 0].T):
            vertices = np.flatnonzero(mask)
            if vertices.size:
                missing = (goal - guess)[vertices, 0, axis]
                guess[:, 0, axis] += np.interp(np.arange(count + 1), vertices, missing)
        return prescribe(guess.ravel())

    def carried(self, change: Vector, constrained: Mask) -> Vector:
        """The mean translation of the supported vertices, in the change of every vertex.

        derived: if two ends have moved against each other, the remainder is as symmetric as the rod.
        """
        vectors = self.kinematics.split(change)
        supported = self.kinematics.split(constrained)[:, 0].any(axis=1)
        translation = np.zeros_like(vectors)
        if supported.any():
            translation[:, 0] = vectors[supported, 0].mean(axis=0)
        return translation.ravel()
