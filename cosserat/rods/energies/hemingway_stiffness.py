"""Stiffnesses of the published energy, eq. (3.4.13): linear elasticity times calibration coefficients.

The first of them, 1/2, follows from small strains, eq. (3.4.14); the others are fitted.
"""

from __future__ import annotations

from typing import Annotated, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cosserat.parameters import Parameters, Quantity
from cosserat.rods.reference import Geometry, Lumped, signed_angle

Array = NDArray[np.float64]


class Calibration(Parameters):
    """The calibration coefficients of eq. (3.4.13)."""

    c1: Annotated[float, Quantity("1", "c_1", "3.4.13", above=0)]
    """Factor of the stretching stiffness of the edges."""
    c2: Annotated[float, Quantity("1", "c_2", "3.4.13", above=0)]
    """Factor of the stretching stiffness of the sections."""
    c3: Annotated[float, Quantity("1", "c_3", "3.4.13", above=0)]
    """Factor of the bending stiffness."""
    c4: Annotated[float, Quantity("1", "c_4", "3.4.13", above=0)]
    """Factor of the shear stiffness."""
    c5: Annotated[float, Quantity("1", "c_5", "3.4.13", at_least=0)]
    """Factor of the stiffness against gradients of shearing."""
    c6: Annotated[float, Quantity("1", "c_6", "3.4.13", at_least=0)]
    """Factor of the stiffness against gradients of the section stretch."""
    c7: Annotated[float, Quantity("1", "c_7", "3.4.13")]
    """Factor of the Poisson coupling of edges and sections."""


class Stiffness(NamedTuple):
    """Constants of the kernel from the reference configuration and the material.

    edge, voronoi, director : ||E|| (N - 1,), L (N,) and ||D|| (N,) [m].
    k1 (N - 1,), k2 (N,), k4 (N,), k7 (N,) [N]; k3 (N,), k5 (N - 1,), k6 (N - 1,) [N m^2].
    intrinsic : (N,) half the Voronoi length times the curvature K of the unbent rod, eq. (3.3.23) [1].
    """

    edge: Array
    voronoi: Array
    director: Array
    k1: Array
    k2: Array
    k3: Array
    k4: Array
    k5: Array
    k6: Array
    k7: Array
    intrinsic: Array


EndSections = Literal["full", "halved"]
PoissonCoupling = Literal["halved", "printed"]
IntrinsicCurvature = Literal["subtracted", "printed"]


def stiffnesses(
    geometry: Geometry,
    vertex: Lumped,
    edge: Lumped,
    shear_correction: Array | float,
    c: Calibration,
    end_sections: EndSections,
    poisson_coupling: PoissonCoupling,
    intrinsic_curvature: IntrinsicCurvature = "subtracted",
) -> Stiffness:
    """Eq. (3.4.13), with the readings that the thesis leaves open.

    end_sections : "halved" halves the areas of the boundary vertices, eq. (3.4.10), on top of their half length.
    poisson_coupling : "printed" takes 2 sum k7 (lambda - 1)(mu - 1) L in eq. (3.4.11) as it stands; "halved" drops
        the 2, which is what the published c7 = 1.66 fits (erratum E3.2).
    intrinsic_curvature : "subtracted" measures bending from the reference, as (3.2.3) does; "printed" from the
        straight rod, as eq. (3.4.11) is printed: a curved reference is then not at rest (E3.24).
    """
    end_factor = np.ones(vertex.area.size)
    if end_sections == "halved":
        end_factor[[0, -1]] = 0.5
    area = vertex.area * end_factor
    coupling = 1.0 if poisson_coupling == "printed" else 0.5
    vertex_lame = vertex.young / ((1 + vertex.poisson) * (1 - 2 * vertex.poisson))
    edge_lame = edge.young / ((1 + edge.poisson) * (1 - 2 * edge.poisson))
    return Stiffness(
        edge=geometry.edge_length,
        voronoi=geometry.voronoi_length,
        director=geometry.director_length,
        k1=c.c1 * edge_lame * edge.area * (1 - edge.poisson),
        k2=c.c2 * vertex_lame * area * (1 - vertex.poisson),
        k3=c.c3 * vertex.young * vertex.second_moment,
        k4=c.c4 * shear_correction * vertex.shear * area,
        k5=c.c5 * edge.young * edge.second_moment,
        k6=c.c6 * edge.young * edge.second_moment / (1 + edge.poisson),
        k7=c.c7 * vertex_lame * area * vertex.poisson * coupling,
        intrinsic=_reference_turns(geometry) * (intrinsic_curvature == "subtracted"),
    )


def _reference_turns(geometry: Geometry) -> Array:
    """tan(Phi / 2) at the interior vertices of the reference, zero at the others, eqs. (3.3.15), (3.3.23)."""
    edges = np.diff(geometry.X, axis=0)
    turns = np.zeros(geometry.X.shape[0])
    turns[1:-1] = np.tan(signed_angle(edges[:-1], edges[1:]) / 2)
    return turns
