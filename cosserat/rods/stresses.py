"""Stresses of a section as in beam theory: not results of the directed rod, which has no stress of a point.

A beam whose sections stay plane has the axial stress N/A - M y/I at the height y above its area centre, and strains
that follow from it by Hooke's law.  Stress concentrations at supports, loads, steps and notches, the warping of thick
or strongly curved sections and pressures between fibres are not in it.  All is per area of the reference.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.elasticity import moduli
from cosserat.rods.resultants import Resultants
from cosserat.rods.rod import Rod
from cosserat.rods.sections.section import Homogeneous
from cosserat.rods.variation import Scales, scale_at

Array = NDArray[np.float64]
SURFACES = ("upper", "lower")
"""The surfaces of a rod: the directors point to the upper one."""


class Sections(NamedTuple):
    """Sections at the middles of the edges, each (N - 1,).

    area [m^2].  second_moment : about the area centre [m^4].  height [m].
    centre : height of the area centre above the centreline [m].
    young : stress over strain of a fibre [Pa], E if the section is free across the plane.
    """

    area: Array
    second_moment: Array
    height: Array
    centre: Array
    young: Array


def edge_sections(rod: Rod, xi: Array) -> Sections | None:
    """The sections at arc lengths xi; at a step those after it.  None if a section has no single material."""
    if not isinstance(rod.section, Homogeneous):
        return None
    scale = Scales(*(scale_at(rod.stations, name, xi, before=False) for name in Scales._fields))
    nominal = rod.area * rod.height**2 / rod.section.thinness
    _, _, young = moduli(rod.young * scale.young, rod.poisson * scale.poisson, rod.lateral_constraint)
    return Sections(
        rod.area * scale.width * scale.height,
        nominal * scale.width * scale.height**3,
        rod.height * scale.height,
        (rod.section.centre - rod.centreline) * rod.height * scale.height,
        young,
    )


class Stresses(NamedTuple):
    """Stresses and strains of the sections of the edges.

    fibre : (..., N - 1, 2) axial stress at the upper and the lower surface, positive in tension [Pa].
    strain : (..., N - 1, 2) its axial strain [1].  shear : (..., N - 1) mean shear stress Q/A [Pa].
    """

    fibre: Array
    strain: Array
    shear: Array


def beam_stresses(sections: Sections, forces: Resultants) -> Stresses:
    """Stresses by N, Q and M.

    derived: the force n at the centreline is the same force at the area centre, e above it, with the couple M + e N.
    """
    about_centre = forces.moment + sections.centre * forces.normal
    bending = about_centre * sections.height / 2 / sections.second_moment
    mean = forces.normal / sections.area
    fibre = np.stack([mean - bending, mean + bending], axis=-1)
    return Stresses(fibre, fibre / sections.young[:, None], forces.shear / sections.area)
