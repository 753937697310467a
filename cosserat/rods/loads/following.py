"""Follower loads: forces that keep their angle to the section on which they act.

derived: with n = d / |d|, R a quarter turn from E2 to E3 and (a, b) the components of the force along R N and N in the
reference, the force is f = a R n + b n.  It has no potential.  Its derivative by the director is
(a R + b 1) (1 - n n) / |d|; half of this block is the symmetric part of the tangent, and half the skew part.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from typing import Annotated, Self

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.parameters import Quantity
from cosserat.rods.loads.load import Load, LoadedRod, Stretch
from cosserat.rods.naming import Direction, unit_vector
from cosserat.rods.places import Place
from cosserat.solvers.banded import Band, Vector
from cosserat.solvers.potential import COMMIT, GRADIENT, HESSIAN, Potential

Array = NDArray[np.float64]
_FORCE = np.dtype(
    [
        ("across", "f8"),  # a, along the normal of the section [N]
        ("along", "f8"),  # b, along its director [N]
        ("dof", "i8"),  # the first of its vertex
    ]
)


class Following(Load):
    """A load that keeps its angle to the section."""

    along: Direction
    """Direction of the load in the reference configuration; it turns with the section."""

    @abstractmethod
    def on_vertices(self, body: LoadedRod) -> Iterator[tuple[int, float]]:
        """The loaded vertices and the sizes of their forces [N]."""

    @classmethod
    def potential(cls, loads: Sequence[Self], body: LoadedRod) -> Potential:
        """The forces; there is no energy."""
        forces = np.zeros((body.rod.vertices, 2))
        D = body.geometry.D / body.geometry.director_length[:, None]
        normal = np.column_stack([D[:, 1], -D[:, 0]])
        for load in loads:
            direction = unit_vector(load.along)
            for vertex, size in load.on_vertices(body):
                forces[vertex] += size * np.array([normal[vertex] @ direction, D[vertex] @ direction])
        loaded = np.flatnonzero(forces.any(axis=1))
        constants = np.zeros(loaded.size, _FORCE)
        constants["across"], constants["along"] = forces[loaded].T
        constants["dof"] = body.rod.kinematics.per_vertex * loaded
        return Potential(
            _force,
            constants,
            ("follower loads",),
            half_bandwidth=3,
            symmetric=False,
            origin=body.origin,
            sizes=("across", "along"),
        )


class FollowerForce(Following):
    """A force on the centreline that turns with the section; between two vertices, both carry it."""

    at: Place
    """The place where it acts."""
    force: Annotated[float, Quantity("N")]
    """Size of the force; a negative one acts the other way."""

    @property
    def places(self) -> tuple[str | int, ...]:
        """The place where it acts."""
        return (self.at,)

    def on_vertices(self, body: LoadedRod) -> Iterator[tuple[int, float]]:
        """The vertices beside its place."""
        for vertex, weight in body.shared(self.at):
            yield vertex, weight * self.force


class FollowerLineLoad(Stretch, Following):
    """A force per length of the reference centreline that turns with the sections, over a stretch of the rod."""

    density: Annotated[float, Quantity("N/m")]
    """Force per length of the reference centreline."""

    def on_vertices(self, body: LoadedRod) -> Iterator[tuple[int, float]]:
        """The vertices whose parts it covers."""
        for vertex, length in enumerate(self.covered(body)):
            yield vertex, self.density * length


@njit(cache=True, error_model="numpy")
def _force(
    q: Vector,
    after: Vector,
    data: NDArray[np.uint8],
    history: Vector,
    strains: Array,
    task: int,
    gradient: Vector,
    band: Band,
    skew: Band,
    terms: Array,
) -> float:
    """Minus the forces as a gradient; arguments as in `solvers.potential.KERNEL`."""
    forces = data.view(_FORCE)
    if task != COMMIT:
        terms[0] = 0.0
    if task not in (GRADIENT, HESSIAN):
        return 0.0
    for k in range(forces.size):
        a, b, x = forces[k].across, forces[k].along, forces[k].dof
        d0, d1 = q[x + 2], q[x + 3]
        length = np.sqrt(d0 * d0 + d1 * d1)
        n0, n1 = d0 / length, d1 / length
        gradient[x] -= a * n1 + b * n0
        gradient[x + 1] -= -a * n0 + b * n1
        if task == HESSIAN:
            p00, p01, p11 = (1 - n0 * n0) / length, -n0 * n1 / length, (1 - n1 * n1) / length
            block = (
                (-(a * p01 + b * p00), -(a * p11 + b * p01)),
                (-(-a * p00 + b * p01), -(-a * p01 + b * p11)),
            )
            for i in range(2):
                for j in range(2):
                    band[x + i, 2 + j - i] += block[i][j] / 2
                    if skew.size > 0:
                        skew[x + i, 2 + j - i] -= block[i][j] / 2
    return 0.0
