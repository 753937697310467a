"""The energy of the thesis, eq. (3.4.11), with its calibration; its kernel is in `hemingway_kernel`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from cosserat.rods.energies import hemingway_kernel
from cosserat.rods.energies.energy import Energy
from cosserat.rods.energies.hemingway_kernel import TERMS, VERTEX
from cosserat.rods.energies.hemingway_stiffness import Stiffness, stiffnesses
from cosserat.rods.reference import Geometry, normals, signed_angle
from cosserat.rods.variation import lump, walls_vary
from cosserat.solution import Field
from cosserat.solvers.potential import Potential

if TYPE_CHECKING:
    from cosserat.rods.rod import Rod

Array = NDArray[np.float64]


class Hemingway(Energy):
    """The published energy, with the averages of Table 3.1 and I about the centreline."""

    options = ("calibration", "end_sections", "poisson_coupling", "intrinsic_curvature")
    between = ("k5", "k6")

    def check(self, rod: Rod) -> None:
        """Require a calibration and a section of one material."""
        if not rod.section.of_one_material:
            raise PydanticCustomError(
                "section",
                f"has shape = '{rod.section.shape}', whose stiffnesses energy = 'published' cannot take; take "
                "energy = 'consistent' (with calibration = 'none')",
            )
        if walls_vary(rod.stations):
            raise PydanticCustomError(
                "stations",
                "has 'stations' with 'wall', which energy = 'published' does not take; take energy = 'consistent' "
                "(with calibration = 'none'), or leave 'wall' out",
            )
        if rod.calibration is None:
            raise PydanticCustomError(
                "calibration",
                "has energy = 'published', which needs a calibration; give one, or take energy = 'consistent'",
            )

    def stiffness(self, rod: Rod, geometry: Geometry) -> Stiffness:
        """Stiffnesses of eq. (3.4.13)."""
        assert rod.calibration is not None  # checked
        section, young, poisson = rod.homogeneous
        vertex, edge = lump(
            rod.stations,
            geometry.arc_length,
            area=rod.area,
            second_moment=rod.second_moment,
            young=young,
            poisson=poisson,
        )
        return stiffnesses(
            geometry,
            vertex,
            edge,
            section.shear_factor_for(vertex.poisson),
            rod.calibration,
            rod.end_sections,
            rod.poisson_coupling,
            rod.intrinsic_curvature,
        )

    def potential(self, rod: Rod, geometry: Geometry, *, displacements: bool = False) -> Potential:
        """Eq. (3.4.11); it computes with positions, even if its DOFs are displacements."""
        return potential(self.stiffness(rod, geometry), geometry.q if displacements else None)

    def mass(self, rod: Rod, geometry: Geometry) -> Array:
        """Eq. (3.3.43) from (3.3.30), (3.3.31): rho0 L times 1, Y02 and Y22, shape (4 N, 3)."""
        m = rod.part_masses(geometry)
        return self.kinematics.mass_band(np.array([[m, rod.Y02 * m], [rod.Y02 * m, rod.Y22 * m]]))[:, :3]

    def fields(
        self, rod: Rod, geometry: Geometry, potential: Potential, u: Array, couples: Array
    ) -> tuple[dict[str, tuple[str, ...]], dict[str, Field]]:
        """Shear angles and the seven terms."""
        vectors, terms = rod.vectors(geometry, u), [potential.energy_terms(row) for row in u]
        theta = signed_angle(normals(vectors[..., 0, :]), vectors[..., 1, :])
        return {"term": TERMS}, {"theta": (("vertex",), theta), "energy": (("term",), np.array(terms))}


def potential(stiffness: Stiffness, origin: Array | None = None) -> Potential:
    """The energy for given stiffnesses; origin (4 N,) is added to its DOFs."""
    constants = np.zeros(stiffness.voronoi.size, VERTEX)
    for name in VERTEX.names or ():
        values = getattr(stiffness, name)
        constants[name][: values.size] = values
    return Potential(
        evaluate=hemingway_kernel.assemble,
        constants=constants,
        terms=TERMS,
        half_bandwidth=13,  # x_(K-1) meets x_(K+2) in the shearing gradients
        strains=(constants.size, 4),
        origin=origin,
    )
