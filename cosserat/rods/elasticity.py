"""Linear elasticity of a section: the stiffnesses of a rod per length that the energies take from it.

A uniform strain e along the rod and a uniform stretch 1 + w of the section along E2 cost per volume, if the stress
along E1 is zero,

    mu (e^2 + w^2) + Lambda (e + w)^2 / 2,      Lambda = E nu / (1 - nu^2),

so that over the section only its area counts, whatever its shape.  A stretch that changes along the rod shears the
material by y w' and costs mu I w'^2 / 2; bending costs EI K^2 / 2.  Both take the second moment about E1.  The
contraction along E1 follows freely: it has no inertia, and its changes along the rod cost nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.variation import Scales

Array = NDArray[np.float64]

LateralConstraint = Literal["free", "plane strain", "incompressible"]
"""Lateral constraint of the section in E1: free contraction, none, or (in plane strain) constant area."""

PENALTY = 1e5
"""Lambda over 2 mu of an incompressible section."""
INCOMPRESSIBLE = 0.49
"""Least Poisson's ratio of an incompressible section."""


class Elastic(NamedTuple):
    """Stiffnesses at places along a rod, arrays of one shape [N, the last two N m^2].

    The energy per length is half of

        axial e^2 + volume (e + w)^2 + section w^2 + shear g^2 + bending K^2 + stretch_gradient w'^2

    for strain e, section stretch 1 + w, shear g and curvature K.  Of one material axial = section = 2 mu A,
    volume = Lambda A, shear = k mu A, bending = EI, stretch_gradient = mu I.
    """

    axial: Array
    volume: Array
    section: Array
    shear: Array
    bending: Array
    stretch_gradient: Array

    @property
    def pulled(self) -> Array:
        """Stiffness EA against a strain under which the section contracts freely [N]."""
        return self.axial + self.volume * self.section / (self.volume + self.section)


Along = Callable[[Scales], Elastic]
"""Stiffnesses from the scale factors of places."""


def of_one_material(
    area: Callable[[Scales], Array],
    second_moment: Callable[[Scales], Array],
    young: float,
    poisson: float,
    shear_factor: Callable[[Scales, Array], Array | float],
    lateral_constraint: LateralConstraint,
) -> Along:
    """Of a section of one material.

    area [m^2], second_moment : about E1 through the area centre [m^4], at places.
    shear_factor : k at places, from Poisson's ratio there.
    """

    def along(s: Scales) -> Elastic:
        here, bending = area(s), second_moment(s)
        nu = poisson * s.poisson
        mu, first, plane = moduli(young * s.young, nu, lateral_constraint)
        shear = shear_factor(s, nu) * mu * here
        return Elastic(2 * mu * here, first * here, 2 * mu * here, shear, plane * bending, mu * bending)

    return along


def moduli(
    young: Array, poisson: Array, lateral_constraint: LateralConstraint
) -> tuple[Array, Array, Array]:
    """mu, Lambda and the modulus of bending [Pa]."""
    if lateral_constraint == "incompressible":
        shear = young / 3
        return shear, PENALTY * 2 * shear, young / 0.75
    shear = young / (2 * (1 + poisson))
    if lateral_constraint == "free":
        return shear, young * poisson / (1 - poisson**2), young
    return (
        shear,
        young * poisson / ((1 + poisson) * (1 - 2 * poisson)),
        young / (1 - poisson**2),
    )
