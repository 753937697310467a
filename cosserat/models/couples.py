"""Couples on sections: a moment that turns with its section and does the work of a couple, eq. (3.3.41).

A couple M on a director that has turned by alpha has the potential -M alpha.  Minus its gradient is the director force
M n / |d|, n across the director: eq. (3.3.41) with |d| in place of lambda H, which for a director that reaches the
surface at half the height is twice the printed force (E3.10).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cosserat.models.published import PublishedRod
from cosserat.solvers.banded import Band, Vector

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Coupled:
    """A rod with couples, as a solver sees it.

    couples : (vertex, moment [N m], positive from E3 towards E2).  D : (N, 2) reference directors, from which the
    turning is counted; it must stay within half a turn.
    """

    rod: PublishedRod
    couples: tuple[tuple[int, float], ...]
    D: Array

    @property
    def half_bandwidth(self) -> int:
        """That of the rod."""
        return self.rod.half_bandwidth

    def assemble(self, q: Vector, gradient: Vector, band: Band) -> float:
        """Potential of rod and couples [J]; overwrites its gradient and Hessian."""
        energy = self.rod.assemble(q, gradient, band)
        for vertex, moment in self.couples:
            at = 4 * vertex + 2
            (t0, t1), length = self._director(q, vertex)
            gradient[at] += moment * t1 / length
            gradient[at + 1] -= moment * t0 / length
            twist = moment / length**2  # -M grad grad alpha = M (t n + n t) / |d|^2
            band[at, 0] -= 2 * twist * t0 * t1
            band[at, 1] += twist * (t0 * t0 - t1 * t1)
            band[at + 1, 0] += 2 * twist * t0 * t1
        return energy + self._potential(q)

    def differentiate(self, q: Vector, gradient: Vector) -> float:
        """Potential of rod and couples [J]; overwrites its gradient."""
        energy = self.rod.differentiate(q, gradient)
        for vertex, moment in self.couples:
            (t0, t1), length = self._director(q, vertex)
            gradient[4 * vertex + 2] += moment * t1 / length
            gradient[4 * vertex + 3] -= moment * t0 / length
        return energy + self._potential(q)

    def energy(self, q: Vector) -> float:
        """Potential of rod and couples [J]."""
        return self.rod.energy(q) + self._potential(q)

    def energy_terms(self, q: Vector) -> Array:
        """The seven terms of the rod's strain energy [J]."""
        return self.rod.energy_terms(q)

    def _director(self, q: Vector, vertex: int) -> tuple[tuple[float, float], float]:
        d0, d1 = float(q[4 * vertex + 2]), float(q[4 * vertex + 3])
        length = float(np.hypot(d0, d1))
        return (d0 / length, d1 / length), length

    def _potential(self, q: Vector) -> float:
        total = 0.0
        for vertex, moment in self.couples:
            (t0, t1), _ = self._director(q, vertex)
            D0, D1 = self.D[vertex]
            total -= moment * float(np.arctan2(D0 * t1 - D1 * t0, D0 * t0 + D1 * t1))
        return total
