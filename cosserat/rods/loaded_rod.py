"""A rod under loads that grow together, as the solvers of `solvers.equilibrium` and `solvers.continuation` see it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.constraints import PrescribedMotion
from cosserat.rods.energies.hemingway import PublishedRod
from cosserat.rods.energies.reissner import ConsistentRod
from cosserat.rods.kinematics import lengths
from cosserat.solvers.banded import Band, Mask, Vector, band_product

Array = NDArray[np.float64]
_TURN = 1.0  # largest turning of a director in one step [rad]


@dataclass(frozen=True)
class LoadedRod:
    """Dead loads, couples and moved supports, all of them times one factor; DOFs are displacements.

    body : without couples.  base : (4 N,) what the body wants added to displacements: nothing, or the reference.
    moments : (N,) [N m].  dead : (4 N,) [N].  drive : how constrained DOFs are moved.
    reference : (N, 4) vertices and directors at rest [m].
    """

    body: PublishedRod | ConsistentRod
    base: Vector
    moments: Array
    dead: Vector
    constrained: Mask
    drive: PrescribedMotion
    reference: Array

    @property
    def half_bandwidth(self) -> int:
        """That of the rod."""
        return self.body.half_bandwidth

    @cached_property
    def dof_scale(self) -> Vector:
        """Edges, directors and what is added to the DOFs: stretches are rounded as shares of them."""
        edge = lengths(np.diff(self.reference[:, :2], axis=0))
        edge = np.append(edge, edge[-1])
        sizes = np.column_stack([edge, edge, self._director, self._director]).ravel()
        dof_scale: Vector = np.maximum(sizes, np.abs(self.base))
        return dof_scale

    @cached_property
    def _director(self) -> Array:
        """Lengths of the directors at rest, (N,) [m]."""
        return lengths(self.reference[:, 2:])

    def coupled(self, factor: float) -> PublishedRod | ConsistentRod:
        """The rod with its couples."""
        return self.body.with_couples(factor * self.moments) if self.moments.any() else self.body

    def prescribe(self, q: Vector, factor: float) -> Vector:
        """q with its constrained DOFs where the factor puts them."""
        return np.where(self.constrained, self.drive.at_load(factor)[0], q)

    @property
    def max_increment(self) -> float:
        """No section is turned by more than is safe at once: angles are told by less than half a turn."""
        turn = self.drive.largest_turn
        return _TURN / turn if turn else np.inf

    def prescribed_rate(self, factor: float) -> Vector:
        """Change of the constrained DOFs with the factor, zero elsewhere."""
        return self.drive.at_load(factor)[1]

    def load(self, factor: float, *, signed: bool = False) -> Vector:
        """Dead load, shape (4 N,) [N]; unsigned, a couple counts as the force of its director."""
        if signed:
            return factor * self.dead
        force = np.abs(self.moments) / self._director
        size: Vector = np.abs(factor) * np.maximum(np.abs(self.dead), np.repeat(force, 4))
        return size

    def assemble(self, q: Vector, factor: float, gradient: Vector, band: Band) -> float:
        """Energy of rod and couples; overwrites the gradient of the potential, loads included, and the Hessian."""
        energy = self.coupled(factor).assemble(q + self.base, gradient, band)
        gradient -= factor * self.dead
        return energy

    def _directors(self, q: Vector) -> Array:
        d: Array = self.reference[:, 2:] + q.reshape(-1, 4)[:, 2:]
        return d

    def rate(self, q: Vector, factor: float, band: Band) -> Vector:
        """Change of that gradient with the factor."""
        change = -self.dead
        if self.drive.parts:
            change = change + band_product(band, self.prescribed_rate(factor))
        for vertex in np.flatnonzero(self.moments):
            d0, d1 = self._directors(q)[vertex]
            square = d0 * d0 + d1 * d1
            change[4 * vertex + 2] += self.moments[vertex] * d1 / square
            change[4 * vertex + 3] -= self.moments[vertex] * d0 / square
        return change

    def rates(self, q: Vector, change: Vector) -> Array:
        """How fast edges and directors turn [rad] and stretch as the DOFs change: (2 N - 1, 2)."""
        vectors, rates = self._vectors(q + self.reference.ravel()), self._vectors(change)
        square = (vectors**2).sum(axis=1)
        turning = (vectors[:, 0] * rates[:, 1] - vectors[:, 1] * rates[:, 0]) / square
        return np.column_stack([turning, (vectors * rates).sum(axis=1) / square])

    def predicted(self, q: Vector, moved: Array, factor: float) -> Vector:
        """The DOFs at a factor after edges and directors have turned and stretched, (2 N - 1, 2).

        Edges that turn do not meet the supports any more; what is missing is spread along the rod between them.
        """
        X = self.reference
        count = X.shape[0] - 1
        vectors = self._vectors(q + X.ravel())
        c, s = (1 + moved[:, 1]) * np.cos(moved[:, 0]), (1 + moved[:, 1]) * np.sin(moved[:, 0])
        turned = np.column_stack(
            [c * vectors[:, 0] - s * vectors[:, 1], s * vectors[:, 0] + c * vectors[:, 1]]
        )
        x = (q[:2] + X[0, :2]) + np.vstack([np.zeros(2), np.cumsum(turned[:count], axis=0)])
        guess = np.hstack([x, turned[count:]]) - X
        goal = self.prescribe(guess.ravel(), factor).reshape(X.shape)
        for axis, constrained in enumerate(self.constrained.reshape(X.shape)[:, :2].T):
            at = np.flatnonzero(constrained)
            if at.size:
                guess[:, axis] += np.interp(np.arange(X.shape[0]), at, (goal - guess)[at, axis])
        return self.prescribe(guess.ravel(), factor)

    def carried(self, change: Vector) -> Vector:
        """The mean translation of the supported vertices, in the change of every vertex.

        derived: where two ends have moved against each other, what is left is as symmetric as the rod.
        """
        vertices = change.reshape(-1, 4)
        supported = self.constrained.reshape(-1, 4)[:, :2].any(axis=1)
        translation = np.zeros_like(vertices)
        if supported.any():
            translation[:, :2] = vertices[supported, :2].mean(axis=0)
        return translation.ravel()

    def _vectors(self, q: Vector) -> Array:
        """Edges, then directors, (2 N - 1, 2)."""
        at = q.reshape(self.reference.shape)
        return np.vstack([np.diff(at[:, :2], axis=0), at[:, 2:]])

    def max_step_fraction(self, q: Vector, step: Vector) -> float:
        """Largest share of a step that changes no director by more than its length, one radian."""
        d, change = self._directors(q), step.reshape(-1, 4)[:, 2:]
        fastest = float((np.hypot(*change.T) / np.hypot(*d.T)).max())
        return _TURN / fastest if fastest > 0 else np.inf
