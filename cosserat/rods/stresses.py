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
from cosserat.rods.variation import scales_at

Array = NDArray[np.float64]
SURFACES = ("upper", "lower")
"""The surfaces of a rod: the directors point to the upper one."""


class Sections(NamedTuple):
    """Sections at the middles of the edges, each (N - 1,).

    axial, bending : stiffnesses EA [N] and EI about the elastic centre [N m^2].
    upper, lower : heights of both surfaces above the elastic centre, the lower one negative [m].
    centre : height of the elastic centre above the centreline [m].
    young : stress over strain of a fibre [Pa], E if the section is free across the plane; area [m^2]; both None for a
        section without a single material.
    """

    axial: Array
    bending: Array
    upper: Array
    lower: Array
    centre: Array
    young: Array | None
    area: Array | None


def edge_sections(rod: Rod, xi: Array) -> Sections | None:
    """The sections at arc lengths xi; at a step those after it.  None if a section has no single material."""
    if not isinstance(rod.section, Homogeneous):
        return None
    scale = scales_at(rod.stations, xi)
    elastic = rod.section.along(rod.material, rod.lateral_constraint)(scale)
    height, centre = rod.height * scale.height, rod.section.centre
    young = area = None
    if isinstance(rod.section, Homogeneous):
        nu = rod.poisson * scale.poisson
        _, _, young = moduli(rod.young * scale.young, nu, rod.lateral_constraint)
        area = rod.section.area_along(scale)
    return Sections(
        elastic.pulled,
        elastic.bending,
        (1 - centre) * height,
        -centre * height,
        (centre - rod.centreline) * height,
        young,
        area,
    )


class Stresses(NamedTuple):
    """Stresses and strains of the sections of the edges.

    strain : (..., N - 1, 2) axial strain at the upper and the lower surface, positive in tension [1].
    fibre : (..., N - 1, 2) its axial stress [Pa].  shear : (..., N - 1) mean shear stress Q/A [Pa].  None for a section
        without a single material.
    """

    strain: Array
    fibre: Array | None
    shear: Array | None


def beam_stresses(sections: Sections, forces: Resultants) -> Stresses:
    """Stresses by N, Q and M.

    derived: the force n at the centreline is the same force at the elastic centre, e above it, with the couple M + e N.
    """
    curvature = (forces.moment + sections.centre * forces.normal) / sections.bending
    mean = forces.normal / sections.axial
    strain = np.stack([mean - curvature * sections.upper, mean - curvature * sections.lower], axis=-1)
    if sections.young is None or sections.area is None:
        return Stresses(strain, None, None)
    return Stresses(strain, strain * sections.young[:, None], forces.shear / sections.area)
