"""What the kernel of the consistent rod is told of a reference configuration."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.energies.compliance import EdgeStiffnesses, LateralConstraint
from cosserat.rods.energies.reissner import (
    ANGLE,
    AXIAL,
    BARRIER,
    COUPLE,
    DIRECTOR,
    EDGE,
    HIGH,
    K_AXIAL,
    K_BENDING,
    K_SECTION,
    K_SHEAR,
    K_STRETCH_GRADIENT,
    K_VOLUME,
    LOW,
    PRODUCT,
    SLIDE,
    START,
    TURN,
    VORONOI,
    ConsistentRod,
)
from cosserat.rods.kinematics import Geometry, unwrapped_angles

Array = NDArray[np.float64]


def coefficients(
    geometry: Geometry,
    stiffness: EdgeStiffnesses,
    couples: Array,
    *,
    barrier: bool,
    product: bool,
    offsets: Array | float = 0.0,
) -> Array:
    """What the kernel needs, shape (N, 23): row K has edge K (the last row none), vertex K and its couple.

    Of the edge: length along the area centres; axial measure, shear measure and turning in the reference; 2 mu A,
    Lambda A, k mu A, EI, mu I.  Of the vertex: |D|, L, 2 mu A, the couple [N m], one for the barriers of Fig. 3.7, and
    the angle of the director in the reference, counted on from vertex to vertex.  Then four numbers that are zero, or
    what `ConsistentRod.displaced` puts there; one where the product of the stretches is the volume, not their sum; the
    offsets of the edge; and, in row 0, the angle within half a turn of which that of the first director is counted.

    offsets : (2, N - 1) of each edge's area centres from the centreline at its two vertices, in directors of those, or
        one for all; edges run from one area centre to the next, and the second moment is about them.
    """
    n = geometry.X.shape[0]
    rod = np.zeros((n, START + 1))
    rod[:-1, LOW], rod[:-1, HIGH] = np.broadcast_to(offsets, (2, n - 1))
    e, alpha = ConsistentRod(rod).centre_edges(geometry.X, geometry.D), unwrapped_angles(geometry.D)
    turn = np.diff(alpha)
    b = alpha[:-1] + turn / 2
    rod[:-1, EDGE] = np.linalg.norm(np.diff(geometry.X, axis=0), axis=1) * stiffness.length
    rod[:-1, AXIAL] = e[:, 0] * np.sin(b) - e[:, 1] * np.cos(b)
    rod[:-1, SLIDE] = e[:, 0] * np.cos(b) + e[:, 1] * np.sin(b)
    rod[:-1, TURN] = turn
    rod[:-1, K_AXIAL] = stiffness.axial
    rod[:-1, K_VOLUME] = stiffness.volume
    rod[:-1, K_SHEAR] = stiffness.shear
    rod[:-1, K_BENDING] = stiffness.bending
    rod[:-1, K_STRETCH_GRADIENT] = stiffness.stretch_gradient
    rod[:, DIRECTOR] = geometry.director_length
    rod[:, VORONOI] = geometry.voronoi_length
    rod[:, K_SECTION] = stiffness.section
    rod[:, COUPLE] = couples
    rod[:, BARRIER] = float(barrier)
    rod[:, ANGLE] = alpha
    rod[:, PRODUCT] = float(product)
    rod[0, START] = alpha[0]
    return rod


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
