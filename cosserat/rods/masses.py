"""Concentrated masses.

derived: a mass m at the distances a along the normal of a section and b along its director d is at the point
r = x + B d, with B d = (b d + a N d) / |D| and N d = (d2, -d3), the director turned from E2 to E3.  B is constant, so
the kinetic energy m |r'|^2 / 2 + J |d'|^2 / (2 |D|^2) has the constant mass matrix

    M_xx = m 1,   M_xd = m B,   M_dd = (m (a^2 + b^2) + J) / |D|^2 1.

The offsets a and b grow with the stretch of the section, and J resists this stretch as it resists rotation: the
frequencies of a rod are those of a rigid mass only while they are far below that of this stretch.  The rod
has a vertex at each mass: the inertia of one inside an edge would miss a part of the compliance there, to first order.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from cosserat.parameters import Parameters, Quantity
from cosserat.rods.kinematics import Kinematics
from cosserat.rods.places import Place, vertex_at
from cosserat.rods.reference import Geometry

Array = NDArray[np.float64]


class Mass(Parameters):
    """A concentrated mass that a section carries; it has weight and inertia."""

    at: Place
    """The place of the section; the rod has a vertex there."""
    mass: Annotated[float, Quantity("kg", above=0)]
    """The mass."""
    rotary_inertia: Annotated[float, Quantity("kg*m^2", at_least=0)] = 0.0
    """Moment of inertia about its own centre; it resists the stretch of the section too."""
    offset: tuple[Annotated[float, Quantity("m")], Annotated[float, Quantity("m")]] = (0.0, 0.0)
    """Distances of its centre from the centreline: along the normal of the section, which is E3 for a director along
    E2, and along the director."""

    def block(self, director: float) -> Array:
        """Its mass matrix for position and director, (4, 4) [kg]; director : reference length [m]."""
        a, b = np.array(self.offset) / director
        inertia = self.mass * (a * a + b * b) + self.rotary_inertia / director**2
        coupled = self.mass * np.array([[b, a], [-a, b]])
        return np.block([[self.mass * np.eye(2), coupled], [coupled.T, inertia * np.eye(2)]])


def mass_band(masses: Sequence[Mass], geometry: Geometry, kinematics: Kinematics) -> Array:
    """The mass matrix of concentrated masses as a symmetric band, (n, 4)."""
    band = np.zeros((geometry.X.shape[0] * kinematics.per_vertex, 4))
    for item in masses:
        vertex = vertex_at(item.at, geometry.arc_length)
        block, first = item.block(geometry.director_length[vertex]), kinematics.per_vertex * vertex
        for i in range(4):
            band[first + i, : 4 - i] += block[i:, i]
    return band


def added(one: Array, other: Array) -> Array:
    """The sum of two symmetric bands of the same size."""
    width = max(one.shape[1], other.shape[1])
    total = np.zeros((one.shape[0], width))
    for band in (one, other):
        total[:, : band.shape[1]] += band
    return total
