"""The published rod with its couples, as solvers see it; its kernel stands in `rods.energies.hemingway_kernel`."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.energies import hemingway_kernel
from cosserat.rods.energies.compiled_rod import CompiledRod
from cosserat.rods.energies.hemingway_kernel import K6, START, VORONOI
from cosserat.rods.energies.hemingway_stiffness import Stiffness
from cosserat.rods.kinematics import Geometry, unwrapped_angles
from cosserat.solvers.banded import Band, Vector

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PublishedRod(CompiledRod):
    """The published rod with its couples as a solver sees it: an energy with its gradient and banded Hessian.

    A couple M on a director that has turned by alpha has the potential -M alpha.  Minus its gradient is the director
    force M n / |d|, n across the director: eq. (3.3.41) with |d| in place of lambda H, which for a director that
    reaches the surface at half the height is twice the printed force (E3.10).

    couples : (N,) moments that turn with their sections, positive from E3 towards E2 [N m].
    angles : (N,) angles of the directors in the reference, counted on from vertex to vertex [rad].
    start : angle within half a turn of which that of the first director is counted; None: that of the reference.
    """

    stiffness: Stiffness
    couples: Array
    angles: Array
    start: float | None = None

    @classmethod
    def of(cls, stiffness: Stiffness, geometry: Geometry, couples: Array | None = None) -> PublishedRod:
        """The rod of a reference configuration, without couples if none are given."""
        moments = np.zeros(geometry.X.shape[0]) if couples is None else couples
        return cls(stiffness, moments, unwrapped_angles(geometry.D))

    @property
    def half_bandwidth(self) -> int:
        """x_(K-1) meets x_(K+2) in the shearing gradients: three vertices of four numbers, and one component."""
        return 13

    @property
    def kernel(self) -> object:
        """The compiled energy, for compiled solvers."""
        return hemingway_kernel.compiled_energy()

    @functools.cached_property
    def parameters(self) -> Array:
        """What the kernel takes besides the DOFs, shape (N, 14)."""
        k = self.stiffness
        rod = np.zeros((k.voronoi.size, START + 1))
        rod[:-1, : K6 + 1] = np.column_stack([k.edge, k.k1, k.k5, k.k6])
        rod[:, VORONOI:START] = np.column_stack(
            [k.voronoi, k.director, k.k2, k.k3, k.k4, k.k7, k.intrinsic, self.couples, self.angles]
        )
        rod[0, START] = self.angles[0] if self.start is None else self.start
        return rod

    @property
    def stiff_volume(self) -> bool:
        """It has no volume."""
        return False

    def unwrapped_near(self, angle: float) -> PublishedRod:
        """The same rod, the angle of its first director counted within half a turn of this one [rad]."""
        return replace(self, start=angle)

    def with_couples(self, couples: Array) -> PublishedRod:
        """The same rod with other couples, (N,) [N m]."""
        return replace(self, couples=couples)

    def evaluate(
        self, q: Vector, order: int, measures: Array, gradient: Vector, band: Band, terms: Array
    ) -> float:
        """The kernel at q; infinite where a section or an edge has vanished or a shear angle has reached pi/2."""
        return float(
            hemingway_kernel.assemble(
                q, np.empty(0), self.parameters, order, measures, gradient, band, terms
            )
        )
