"""The energy that converges: Reissner's measures between directors; its kernel is in `reissner_kernel`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from cosserat.rods.elasticity import INCOMPRESSIBLE, LateralConstraint
from cosserat.rods.energies import compliance, reissner_kernel
from cosserat.rods.energies.compliance import EdgeStiffnesses
from cosserat.rods.energies.energy import Energy
from cosserat.rods.energies.reissner_kernel import TERMS, VERTEX
from cosserat.rods.reference import Geometry, edge_shear, unwrapped_angles
from cosserat.rods.variation import edge_masses
from cosserat.solution import Field
from cosserat.solvers.potential import Potential

if TYPE_CHECKING:
    from cosserat.rods.rod import Rod

Array = NDArray[np.float64]

STRESSES = ("stress-free strains",)
"""The term of a load that is stresses of the rod itself."""
_STIFF_VOLUME_RATIO = 5.0  # least Lambda over 2 mu of a stiff volume: nu = 0.45 in plane strain


class Reissner(Energy):
    """The convergent energy, with the compliances of its edges and I about the area centres."""

    options = ("lateral_constraint", "barrier")
    between = ("k_axial", "k_volume", "k_shear", "k_bending", "k_stretch_gradient")
    large_rotations = True
    true_normals = True

    def check(self, rod: Rod) -> None:
        """Require a Poisson's ratio near one half of an incompressible section."""
        least = min(rod.poisson_ratios, default=0.0)
        if rod.lateral_constraint == "incompressible" and least < INCOMPRESSIBLE:
            raise PydanticCustomError(
                "section",
                f"has lateral_constraint = 'incompressible' and 'poisson' = {least:g}; it must be "
                f"{INCOMPRESSIBLE} or more",
            )

    def potential(self, rod: Rod, geometry: Geometry, *, displacements: bool = False) -> Potential:
        """Reissner's measures between directors, and section stretches."""
        stiffness = compliance.stiffnesses(
            rod.stations,
            geometry.arc_length,
            rod.section.along(rod.material, rod.lateral_constraint),
            offset=(rod.section.centre - rod.centreline) * rod.height,
            curvature=rod.rest.curvatures(geometry.arc_length),
        )
        heights = rod.height_fractions(geometry.arc_length)
        return potential(
            geometry,
            stiffness,
            barrier=rod.barrier,
            product=rod.lateral_constraint == "incompressible",
            offsets=rod.elastic_offset
            * (stiffness.axis / np.array([heights[..., :-1], heights[..., 1:]])),
            displacements=displacements,
        )

    def mass(self, rod: Rod, geometry: Geometry) -> Array:
        """The mean of the lumped masses and those of straight edges, shape (4 N, 7).

        Y02 and Y22 are those of the sections along an edge, in units of the directors of the vertices.
        """
        heights = rod.height_fractions(geometry.arc_length)
        edges = edge_masses(rod.stations, rod.line_density, geometry.arc_length, rod.inertia_along)
        own = np.zeros((3, *heights.shape))
        own[..., :-1] += edges.before
        own[..., 1:] += edges.after
        Y02, Y22 = rod.Y02, rod.Y22
        m0, m1, m2 = own[0], Y02 * own[1] / heights, Y22 * own[2] / heights**2
        low, high = heights[..., :-1], heights[..., 1:]
        n0, n1, n2 = edges.shared
        between = [[n0, Y02 * n1 / high], [Y02 * n1 / low, Y22 * n2 / (low * high)]]
        return self.kinematics.mass_band(np.array([[m0, m1], [m1, m2]]), np.array(between))

    def fields(
        self, rod: Rod, geometry: Geometry, potential: Potential, u: Array, couples: Array
    ) -> tuple[dict[str, tuple[str, ...]], dict[str, Field]]:
        """Shear angles of the edges and the parts of the energy, that of the couples included."""
        vectors, terms = rod.vectors(geometry, u), [potential.energy_terms(row) for row in u]
        x, d = vectors[..., 0, :], vectors[..., 1, :]
        return {"part": (*TERMS, "couples")}, {
            "shear": (("edge",), edge_shear(centre_edges(potential.constants, x, d), d)),
            "energy_parts": (("part",), np.column_stack([terms, couples])),
        }

    def start_directors(self, rod: Rod, geometry: Geometry, x: Array, d: Array) -> Array:
        """Directors that keep the volume of the edges if it hardly changes: it would excite vibrations."""
        constants = self.potential(rod, geometry).constants
        stiff = constants["k_volume"] > _STIFF_VOLUME_RATIO * constants["k_axial"]
        return keeping_volume(geometry, x, d, rod.lateral_constraint) if stiff.any() else d


def potential(
    geometry: Geometry,
    stiffness: EdgeStiffnesses,
    *,
    barrier: bool,
    product: bool,
    offsets: Array | float = 0.0,
    displacements: bool = False,
) -> Potential:
    """The energy for given stiffnesses.

    barrier : with those of Fig. 3.7.  product : the volume is the product of the stretches, not their sum.
    offsets : (2, N - 1) of each edge's area centres from the centreline at its two vertices, in units of their
        directors, or one for all; edges run between area centres, and the second moment is about them.
    displacements : DOFs are displacements; on fine meshes their round-off is far less than that of positions.
    """
    angles = unwrapped_angles(geometry.D)
    turn = np.diff(angles)
    rod = np.zeros(angles.shape, VERTEX)
    rod["low"][..., :-1], rod["high"][..., :-1] = np.full((2, *turn.shape), offsets)
    e = centre_edges(rod, geometry.X, geometry.D)
    b = angles[..., :-1] + turn / 2
    s, c = np.sin(b), np.cos(b)
    edges = {
        "edge": geometry.edge_length * stiffness.length,
        "axial": e[..., 0] * s - e[..., 1] * c,
        "slide": e[..., 0] * c + e[..., 1] * s,
        "turn": turn,
        "k_axial": stiffness.axial,
        "k_volume": stiffness.volume,
        "k_shear": stiffness.shear,
        "k_bending": stiffness.bending,
        "k_stretch_gradient": stiffness.stretch_gradient,
    }
    for name, values in edges.items():
        rod[name][..., :-1] = values
    rod["director"], rod["voronoi"] = geometry.director_length, geometry.voronoi_length
    rod["k_section"] = stiffness.section
    rod["barrier"], rod["product"] = float(barrier), product
    if displacements:
        rod["edge_3"][..., :-1], rod["edge_2"][..., :-1] = e[..., 0], e[..., 1]
        rod["director_3"], rod["director_2"] = geometry.D[..., 0], geometry.D[..., 1]
    return Potential(
        evaluate=reissner_kernel.assemble,
        constants=rod,
        terms=TERMS,
        half_bandwidth=7,  # two neighbouring vertices
        strains=(angles.shape[-1], 4),
    )


SOFTENED = ("k_axial", "k_volume", "k_section", "k_shear", "k_bending", "k_stretch_gradient")
"""Constants that `softening` gives, in the order of `cosserat.rods.elasticity.Elastic`."""


def softening(own: Array, change: Array, longer: Array) -> Array:
    """Constants whose gradient is the rate of the gradient of uniform straight rods that keep their strains, (..., 6).

    derived: with its strains, and with forces counted in the lengths of the old reference, the energy depends on a
    rod by E 2 mu A, E Lambda A, L 2 mu A, E k mu A, EI / E and mu I / E alone, E and L lengths along it.  If these
    grow by l as a fraction, the products have the rates E (k' + l k) and L (k' + l k), the quotients (k' - l k) / E.

    own, change : (6, ...) stiffnesses and their rates.  longer : (...) l.
    """
    sign = np.array([1.0, 1.0, 1.0, 1.0, -1.0, -1.0])
    found: Array = np.moveaxis(change, 0, -1) + longer[..., None] * sign * np.moveaxis(own, 0, -1)
    return found


def measured_from(rest: Potential, energy: Potential) -> Potential:
    """The energy with its strains measured from the reference of another one; its DOFs stay what they are."""
    constants = energy.constants.copy()
    for name in ("axial", "slide", "turn"):
        constants[name] = rest.constants[name]
    return replace(energy, constants=constants)


def stressed(
    energy: Potential,
    extension: Array,
    curvature: Array,
    section: Array,
    slide: Array | float = 0.0,
) -> Potential:
    """Minus the work of the stresses that some strains need, on the measures of the rod.

    energy : without barrier.  extension, slide [1], curvature [1/m] : (N - 1,) of the edges.  section : (N,) strain of
    the sections [1].
    """
    stress = energy.constants.copy()
    wide = (section[:-1] + section[1:]) / 2
    volume = (1 + extension) * (1 + wide) - 1 if stress["product"][0] else extension + wide
    measures = {
        "k_axial": extension,
        "k_volume": volume,
        "k_shear": slide,
        "k_bending": curvature,
        "k_stretch_gradient": np.diff(section),
    }
    for name, values in measures.items():
        stress[name][:-1] *= values
    stress["k_section"] *= section
    return Potential(
        evaluate=reissner_kernel.stressed,
        constants=stress,
        terms=STRESSES,
        half_bandwidth=energy.half_bandwidth,
        sizes=(*measures, "k_section"),
    )


def centre_edges(constants: NDArray[np.void], x: Array, d: Array) -> Array:
    """Edges between area centres, (N - 1, 2) [m], of vertices and directors (N, 2) [m]."""
    low, high = constants["low"][..., :-1, None], constants["high"][..., :-1, None]
    first = x[..., :-1, :] + low * d[..., :-1, :]
    edges: Array = (x[..., 1:, :] + high * d[..., 1:, :]) - first
    return edges


def keeping_volume(
    geometry: Geometry, x: Array, d: Array, lateral_constraint: LateralConstraint
) -> Array:
    """Directors (N, 2) [m] scaled so that each edge keeps its volume; the first is not scaled.

    A volume that hardly changes would otherwise excite vibrations at the start of a motion.
    """
    unit = d / np.linalg.norm(d, axis=1)[:, None]
    m, e = unit[1:] + unit[:-1], np.diff(x, axis=0)
    axial = (e[:, 0] * m[:, 1] - e[:, 1] * m[:, 0]) / np.linalg.norm(m, axis=1) / geometry.edge_length
    wide = np.ones(axial.size + 1)
    for K, a in enumerate(axial):
        wide[K + 1] = 2 * (1 / a if lateral_constraint == "incompressible" else 2 - a) - wide[K]
    directors: Array = (geometry.director_length * wide)[:, None] * unit
    return directors
