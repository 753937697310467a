"""The energy that converges, of `rods.energies.reissner`, in a reference configuration."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from cosserat.rods.energies import compliance, reissner
from cosserat.rods.energies.compliance import EdgeStiffnesses, LateralConstraint
from cosserat.rods.energies.energy import Energy
from cosserat.rods.energies.reissner import TERMS, VERTEX
from cosserat.rods.reference import Geometry, edge_shear, unwrapped_angles
from cosserat.rods.variation import edge_masses
from cosserat.solution import Field
from cosserat.solvers.potential import Potential

if TYPE_CHECKING:
    from cosserat.rods.rod import Rod

Array = NDArray[np.float64]

_STIFF = 5.0  # Lambda over 2 mu from which on a volume is stiff: Poisson's ratio 0.45 in plane strain


class Reissner(Energy):
    """The convergent energy: it takes the compliances of its edges and I about the area centres."""

    options = ("lateral_constraint", "barrier")
    far = True

    def check(self, rod: Rod) -> None:
        """An incompressible section has a Poisson's ratio near one half."""
        least = min(rod.poisson_ratios)
        if rod.lateral_constraint == "incompressible" and least < compliance.INCOMPRESSIBLE:
            raise PydanticCustomError(
                "section",
                f"has lateral_constraint = 'incompressible' and 'poisson' = {least:g}; it must be "
                f"{compliance.INCOMPRESSIBLE} or more",
            )

    def potential(self, rod: Rod, geometry: Geometry, *, displacements: bool = False) -> Potential:
        """Reissner's measures between directors, and section stretches."""
        stiffness = compliance.stiffnesses(
            rod.stations,
            geometry.arc_length,
            area=rod.area,
            second_moment=rod.area * rod.height**2 / 12,
            young=rod.young,
            poisson=rod.poisson,
            shear_correction=rod.shear_correction,
            lateral_constraint=rod.lateral_constraint,
        )
        return potential(
            geometry,
            stiffness,
            barrier=rod.barrier,
            product=rod.lateral_constraint == "incompressible",
            offset=rod.Y02,
            displacements=displacements,
        )

    def mass(self, rod: Rod, geometry: Geometry) -> Array:
        """The mean of lumped masses and of those that straight edges have, shape (4 N, 7)."""
        edges = edge_masses(rod.stations, rod.line_density, geometry.arc_length)
        own = np.append(edges.before, 0.0) + np.insert(edges.after, 0, 0.0)
        return self.kinematics.mass_band(own, edges.shared, rod.inertia)

    def fields(
        self, rod: Rod, geometry: Geometry, vectors: Array, terms: Array, couples: float
    ) -> tuple[dict[str, tuple[str, ...]], dict[str, Field]]:
        """Shear angles of the edges and the parts of the energy, that of the couples included."""
        x, d = vectors[:, 0], vectors[:, 1]
        return {"part": (*TERMS, "couples")}, {
            "shear": (("edge",), edge_shear(x + rod.Y02 * d, d)),
            "energy_parts": (("part",), np.append(terms, couples)),
        }

    def shaped(self, rod: Rod, geometry: Geometry, x: Array, d: Array) -> Array:
        """A volume that hardly changes would set off vibrations of its own: the edges keep theirs."""
        constants = self.potential(rod, geometry).constants
        stiff = constants["k_volume"] > _STIFF * constants["k_axial"]
        return keeping_volume(geometry, x, d, rod.lateral_constraint) if stiff.any() else d


def potential(
    geometry: Geometry,
    stiffness: EdgeStiffnesses,
    *,
    barrier: bool,
    product: bool,
    offset: float = 0.0,
    displacements: bool = False,
) -> Potential:
    """The energy of given stiffnesses.

    barrier : with those of Fig. 3.7.  product : the volume is the product of the stretches, not their sum.
    offset : of the area centres from the centreline, in directors; edges run from one area centre to the next, and the
        second moment is about them.
    displacements : DOFs are displacements, whose rounding on fine meshes is far less than that of positions.
    """
    centres = geometry.X + offset * geometry.D
    rod = np.zeros(geometry.X.shape[0], VERTEX)
    e, turn = np.diff(centres, axis=0), np.diff(unwrapped_angles(geometry.D))
    b = unwrapped_angles(geometry.D)[:-1] + turn / 2
    edges = {
        "edge": np.linalg.norm(e, axis=1),
        "axial": e[:, 0] * np.sin(b) - e[:, 1] * np.cos(b),
        "slide": e[:, 0] * np.cos(b) + e[:, 1] * np.sin(b),
        "turn": turn,
        "k_axial": stiffness.axial,
        "k_volume": stiffness.volume,
        "k_shear": stiffness.shear,
        "k_bending": stiffness.bending,
        "k_stretch_gradient": stiffness.stretch_gradient,
    }
    for name, values in edges.items():
        rod[name][:-1] = values
    rod["director"], rod["voronoi"] = geometry.director_length, geometry.voronoi_length
    rod["k_section"], rod["offset"] = stiffness.section, offset
    rod["barrier"], rod["product"] = float(barrier), product
    if displacements:
        rod["edge_3"][:-1], rod["edge_2"][:-1] = e.T
        rod["director_3"], rod["director_2"] = geometry.D.T
    return Potential(
        evaluate=reissner.assemble,
        compiled=reissner.compiled_energy,
        constants=rod,
        terms=TERMS,
        half_bandwidth=7,  # two neighbouring vertices
        strains=(rod.size, 4),
    )


def keeping_volume(
    geometry: Geometry, x: Array, d: Array, lateral_constraint: LateralConstraint
) -> Array:
    """Directors of the same directions, (N, 2) [m], so long that each edge keeps its volume; the first is not scaled.

    A volume that hardly changes would otherwise set off vibrations of its own at the start of a motion.
    """
    unit = d / np.linalg.norm(d, axis=1)[:, None]
    m, e = unit[1:] + unit[:-1], np.diff(x, axis=0)
    axial = (e[:, 0] * m[:, 1] - e[:, 1] * m[:, 0]) / np.linalg.norm(m, axis=1) / geometry.edge_length
    wide = np.ones(axial.size + 1)
    for K, a in enumerate(axial):
        wide[K + 1] = 2 * (1 / a if lateral_constraint == "incompressible" else 2 - a) - wide[K]
    directors: Array = (geometry.director_length * wide)[:, None] * unit
    return directors
