"""Dead loads, constant in direction and size: weight, forces at vertices and along stretches of the rod."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Annotated, Self

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.parameters import Quantity
from cosserat.rods.loads.load import Load, LoadedRod, Stretch
from cosserat.rods.naming import Direction, unit_vector
from cosserat.rods.places import Place
from cosserat.solvers.banded import Band, Vector, band_product
from cosserat.solvers.potential import COMMIT, GRADIENT, HESSIAN, Potential

Array = NDArray[np.float64]
_DOF = np.dtype([("force", "f8"), ("reference", "f8")])


class DeadLoad(Load):
    """A load that is a constant force on the DOFs."""

    @abstractmethod
    def on_dofs(self, body: LoadedRod) -> Array:
        """Force on the DOFs of each vertex, shape (..., N, DOFs of a vertex) [N]."""

    @classmethod
    def total(cls, loads: Sequence[Self], body: LoadedRod) -> Array:
        """The force of all of them on the DOFs of each vertex, shape (..., N, DOFs of a vertex) [N]."""
        total = body.no_force
        for load in loads:
            total += load.on_dofs(body)
        return total

    @classmethod
    def potential(cls, loads: Sequence[Self], body: LoadedRod) -> Potential:
        """Minus the work of the forces from the reference, eq. (3.3.40)."""
        return dead(cls.total(loads, body).ravel(), body.unmoved)


class Gravity(DeadLoad):
    """The weight of the rod: its mass matrix times a uniform acceleration; lumped, rho0 g L of section 3.5."""

    g: Annotated[float, Quantity("m/s^2", "g", "section 3.5")]
    """Acceleration of free fall."""
    along: Direction
    """Direction of free fall."""

    def on_dofs(self, body: LoadedRod) -> Array:
        """Weights from the mass matrix of motions."""
        fall = body.no_force
        fall[..., :2] = np.asarray(self.g)[..., None] * unit_vector(self.along)
        bands = body.mass.reshape(-1, *body.mass.shape[-2:])
        falls = fall.reshape(bands.shape[:2])
        each = [band_product(band, own) for band, own in zip(bands, falls, strict=True)]
        return np.array(each).reshape(fall.shape)


class PointForce(DeadLoad):
    """A dead force on the centreline at one place; between two vertices, both carry it."""

    at: Place
    """The place where it acts."""
    along: Direction
    """Direction of the force."""
    force: Annotated[float, Quantity("N", "n", "section 3.5")]
    """Size of the force; a negative one acts the other way."""

    @property
    def places(self) -> tuple[str | int, ...]:
        """The place where it acts."""
        return (self.at,)

    def on_dofs(self, body: LoadedRod) -> Array:
        """Force on the positions of the vertices beside it."""
        forces = body.no_force
        for vertex, weight in body.shared(self.at):
            forces[..., vertex, :2] = weight * self.force * unit_vector(self.along)
        return forces


class LineLoad(Stretch, DeadLoad):
    """A dead force per length on the centreline, over a stretch of it."""

    along: Direction
    """Direction of the load."""
    density: Annotated[float, Quantity("N/m")]
    """Force per length of the reference centreline."""

    def on_dofs(self, body: LoadedRod) -> Array:
        """Forces on the covered lengths of the parts round the vertices."""
        forces = body.no_force
        sizes = self.density * self.covered(body)
        forces[..., :2] = sizes[..., None] * unit_vector(self.along)
        return forces


def dead(force: Vector, reference: Vector) -> Potential:
    """The potential of constant forces (n,) [N] on the DOFs, zero at the reference (n,)."""
    constants = np.empty(force.size, _DOF)
    constants["force"], constants["reference"] = force, reference
    return Potential(_work, constants, ("dead loads",), half_bandwidth=-1, sizes=("force",))


@njit(cache=True)
def _work(
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
    """Minus the work of the forces; arguments as in `solvers.potential.KERNEL`."""
    dofs = data.view(_DOF)
    ends = after if after.size > 0 else q
    energy = 0.0
    for i in range(dofs.size):
        energy -= dofs[i].force * (ends[i] - dofs[i].reference)
        if task in (GRADIENT, HESSIAN):
            gradient[i] -= dofs[i].force
    if task != COMMIT:
        terms[0] = energy
    return energy
