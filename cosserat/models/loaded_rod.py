"""The consistent rod under loads that grow together, as the solvers of `solvers.climb` and `solvers.path` see it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cosserat.models.consistent import COUPLE, DIRECTOR, DIRECTOR_2, DIRECTOR_3, EDGE, ConsistentRod
from cosserat.models.drive import Drive
from cosserat.solvers.banded import Band, Mask, Vector, band_product

Array = NDArray[np.float64]
_TURN = 1.0  # largest turning of a director in one step [rad]


@dataclass(frozen=True)
class LoadedRod:
    """Dead loads, couples and moved supports, all of them times one factor.

    body : without couples, its unknowns displacements.  moments : (N,) [N m].  dead : (4 N,) [N].
    drive : how held unknowns are moved.
    """

    body: ConsistentRod
    moments: Array
    dead: Vector
    held: Mask
    drive: Drive

    @property
    def half_bandwidth(self) -> int:
        """That of the rod."""
        return self.body.half_bandwidth

    @property
    def grain(self) -> Vector:
        """Edges and directors: stretches are rounded as shares of them."""
        edge, director = self.body.rod[:, EDGE], self.body.rod[:, DIRECTOR]
        edge = np.append(edge[:-1], edge[-2])
        return np.column_stack([edge, edge, director, director]).ravel()

    def coupled(self, factor: float) -> ConsistentRod:
        """The rod with its couples."""
        if not self.moments.any():
            return self.body
        rod = self.body.rod.copy()
        rod[:, COUPLE] = factor * self.moments
        return ConsistentRod(rod)

    def place(self, q: Vector, factor: float) -> Vector:
        """q with its held unknowns where the factor puts them."""
        return np.where(self.held, self.drive.grown(factor)[0], q)

    @property
    def stride(self) -> float:
        """No section is turned by more than is safe at once: angles are told by less than half a turn."""
        turn = self.drive.largest_turn
        return _TURN / turn if turn else np.inf

    def moving(self, factor: float) -> Vector:
        """Change of the held unknowns with the factor, zero elsewhere."""
        return self.drive.grown(factor)[1]

    def load(self, factor: float, *, signed: bool = False) -> Vector:
        """Dead load, shape (4 N,) [N]; unsigned, a couple counts as the force of its director."""
        if signed:
            return factor * self.dead
        force = np.abs(self.moments) / self.body.rod[:, DIRECTOR]
        size: Vector = np.abs(factor) * np.maximum(np.abs(self.dead), np.repeat(force, 4))
        return size

    def assemble(self, q: Vector, factor: float, gradient: Vector, band: Band) -> float:
        """Energy of rod and couples; overwrites the gradient of the potential, loads included, and the Hessian."""
        energy = self.coupled(factor).assemble(q, gradient, band)
        gradient -= factor * self.dead
        return energy

    def _directors(self, q: Vector) -> Array:
        d: Array = self.body.rod[:, DIRECTOR_3 : DIRECTOR_2 + 1] + q.reshape(-1, 4)[:, 2:]
        return d

    def rate(self, q: Vector, factor: float, band: Band) -> Vector:
        """Change of that gradient with the factor."""
        change = -self.dead
        if self.drive.parts:
            change = change + band_product(band, self.moving(factor))
        for vertex in np.flatnonzero(self.moments):
            d0, d1 = self._directors(q)[vertex]
            square = d0 * d0 + d1 * d1
            change[4 * vertex + 2] += self.moments[vertex] * d1 / square
            change[4 * vertex + 3] -= self.moments[vertex] * d0 / square
        return change

    def reach(self, q: Vector, step: Vector) -> float:
        """Largest share of a step that changes no director by more than its length, one radian."""
        d, change = self._directors(q), step.reshape(-1, 4)[:, 2:]
        fastest = float((np.hypot(*change.T) / np.hypot(*d.T)).max())
        return _TURN / fastest if fastest > 0 else np.inf
