"""The rod that crawls, sections 2.1-2.6: sections stay vertical, eq. (2.1.1), and muscles load it by regions.

Stretches mu_1 (vertical), mu_2 (across) and mu_3 (along) of the material at z = xi / l_0 obey

    mu_alpha'' = f_alpha(mu_1, mu_2)

in every region of a uniform body, with mu_3 given by the balance of forces along the rod (compressible) or by constant
volume.  `body` has the equations of a body that varies.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Parameters, Quantity
from cosserat.peristalsis import equations
from cosserat.peristalsis.body import UNIFORM, BodySegment, Piece, check_segments, mean_square, pieces
from cosserat.rods.directed_rod import Section, integrated_stiffnesses

Array = NDArray[np.float64]


_INCOMPRESSIBLE = 0.5 - 1e-9  # above this nu the two Lame stiffnesses differ only by round-off
_AUXETIC = -1 + 1e-4  # below this nu the volume stiffness, 1 + 2 p of (2.3.19), is round-off
_MAX_SLENDERNESS = 1e6  # longest body in radii; in a longer one the layers are below round-off


class Compressible(Parameters):
    """An isotropic material by two of its three moduli, section 2.6; the energy is (2.3.1)."""

    kind: Literal["compressible"] = "compressible"
    young: Annotated[float, Quantity("Pa", "E", "2.6.3", above=0)] | None = None
    """Young's modulus."""
    poisson: Annotated[float, Quantity("1", r"\nu", "2.6.6", above=-1, below=0.5)] | None = None
    """Poisson's ratio; not within 1e-4 of -1, where the stiffness becomes singular."""
    bulk: Annotated[float, Quantity("Pa", r"\kappa", "2.6.15", above=0)] | None = None
    """Bulk modulus."""

    @model_validator(mode="after")
    def _two_of_three(self) -> Self:
        given = [name for name in ("young", "poisson", "bulk") if getattr(self, name) is not None]
        if len(given) != 2:
            raise PydanticCustomError(
                "moduli", f"has {', '.join(given) or 'no modulus'}; give two of young, poisson and bulk"
            )
        _, poisson = self.moduli
        if -1 < poisson <= _AUXETIC:
            raise PydanticCustomError(
                "moduli",
                f"has a Poisson's ratio nu = {poisson:.12g}; it must be above {_AUXETIC:g}: closer to -1 the stiffness "
                "becomes singular, eq. (2.3.19)",
            )
        if not -1 < poisson < _INCOMPRESSIBLE:
            raise PydanticCustomError(
                "moduli",
                f"has a Poisson's ratio nu = {poisson:.12g}; it must be above -1 and below 1/2: for a material that "
                "keeps its volume use kind = 'incompressible'",
            )
        return self

    @property
    def moduli(self) -> tuple[float, float]:
        """E [Pa] and nu.  kappa = E / (3 (1 - 2 nu)): the 3 that (2.6.15), (2.6.16) lack, erratum E2.6."""
        if self.bulk is None:
            assert self.young is not None
            assert self.poisson is not None
            return self.young, self.poisson
        if self.young is None:
            assert self.poisson is not None
            return 3 * self.bulk * (1 - 2 * self.poisson), self.poisson
        return self.young, (1 - self.young / (3 * self.bulk)) / 2


class Incompressible(Parameters):
    """A material of constant volume, section 2.4: mu_1 mu_2 mu_3 = 1."""

    kind: Literal["incompressible"] = "incompressible"
    young: Annotated[float, Quantity("Pa", "E", "2.6.17", above=0)]
    """Young's modulus."""


class Crawler(Parameters):
    """A straight round body on the ground."""

    length: Annotated[float, Quantity("m", r"\ell_0", "2.3.4", above=0)]
    """Length of the resting body."""
    radius: Annotated[float, Quantity("m", "R", "2.2.8", above=0)]
    """Radius of the resting body."""
    material: Annotated[Compressible | Incompressible, Field(discriminator="kind")]
    """Material of the body."""
    mass: Annotated[float, Quantity("kg", "m", "2.8.4", at_least=0)] | None = None
    """Mass of the body, spread evenly over its volume; this or 'density' is given."""
    density: Annotated[float, Quantity("kg/m^3", r"\rho_0^*", "2.7.3", at_least=0)] | None = None
    """Mass per volume of the resting body; this or 'mass' is given."""
    segments: tuple[BodySegment, ...] = ()
    """Parts of the body from the rear to the front, if it varies along its length; together as long as the body."""

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        if (self.mass is None) == (self.density is None):
            fault = "has neither" if self.mass is None else "has both"
            raise PydanticCustomError(
                "mass",
                f"{fault} a mass and a density; give one of them (and 'none' for the inherited one)",
            )
        check_segments(self.segments, self.length)
        thinnest = self.radius * min(min(p.rear.radius, p.front.radius) for p in self.pieces)
        if self.length > _MAX_SLENDERNESS * thinnest:
            raise PydanticCustomError(
                "slender",
                f"has length / radius = {self.length / thinnest:.3g}; it must be below {_MAX_SLENDERNESS:g}",
            )
        return self

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The segments as fractions of the length, with their values over those of the body."""
        return pieces(self.segments, self.radius, self.material_young) if self.segments else UNIFORM

    @property
    def area(self) -> float:
        """A_0 [m^2] of a section with the radius of the body itself."""
        return float(np.pi * self.radius**2)

    @property
    def line_density(self) -> float:
        """rho_0 [kg/m], its mean along a body that varies.

        ASSUME mass over length where the mass is given: the thesis gives no rho_0 of the worm.
        """
        if self.mass is not None:
            return self.mass / self.length
        return (self.density or 0.0) * self.area * mean_square(self.pieces)

    @property
    def stiffnesses(self) -> tuple[float, float, float]:
        """k_S, k_P [N] and k_G [N m^2] of eq. (2.6.20): 4 k_1, 2 k_7 and k_10 of eq. (1.2.95); compressible only."""
        assert isinstance(self.material, Compressible)
        k = integrated_stiffnesses(*self.material.moduli, Section.circle(self.radius))
        return 4 * k[1], 2 * k[7], k[10]

    @property
    def incompressible_stiffnesses(self) -> tuple[float, float]:
        """k_I [N] of eq. (2.6.17) and k_G [N m^2] of eq. (2.6.22)."""
        return 2 / 3 * self.material_young * self.area, self.material_young * np.pi * self.radius**4 / 12

    @property
    def material_young(self) -> float:
        """E [Pa]."""
        return (
            self.material.moduli[0] if isinstance(self.material, Compressible) else self.material.young
        )


Contact = Literal["weight", "printed"]
"""Ground reaction: rho_0 g, or rho_0 g / mu_3 as printed in eq. (2.2.20) (erratum E2.7)."""
AdvancingForce = Literal["none", "continuous"]
"""n in advancing regions: zero (section 2.3) or that of the anchoring regions beside them (section 2.4)."""
Multiplier = Literal["balanced", "printed"]
"""Advancing regions of the incompressible rod: lambda_c mu_1 mu_2 constant, or eq. (2.4.18) as printed (E2.5)."""


class Loads(Parameters):
    """Loads on a crawler, and the form of the equations."""

    anchoring: Annotated[float, Quantity("N", r"\bar{D}", "2.2.7", at_least=0)]
    """Force of the longitudinal muscles."""
    advancing: Annotated[float, Quantity("Pa", "p", "2.2.8")]
    """Pressure of the circular muscles."""
    gravity: Annotated[float, Quantity("m/s^2", "g", "2.2.18", at_least=0)] = 9.81
    """Acceleration of free fall; the body lies on level ground."""
    contact: Contact = "weight"
    """Ground reaction: rho_0 g, or rho_0 g / mu_3 as printed in eq. (2.2.20) (erratum E2.7)."""
    advancing_force: AdvancingForce | None = None
    """Force n in advancing regions: zero (section 2.3) or that of the anchoring regions beside them (section 2.4).

    In relaxed regions likewise.  Where the anchoring regions beside one differ, that of the one behind it counts.
    Default as in the section on the material: "none" if compressible, "continuous" if incompressible.
    """
    multiplier: Multiplier = "balanced"
    """Advancing regions of the incompressible rod: lambda_c mu_1 mu_2 constant, or eq. (2.4.18) as printed (E2.5)."""


@dataclass(frozen=True)
class Groups:
    """The dimensionless groups of eqs. (2.3.4), (2.3.8) and (2.4.9), under the letters of the thesis.

    g : k_S l_0^2 / k_G.  p : k_P / k_S.  d : D / k_S.  All three are zero of an incompressible body.
    i : k_I l_0^2 / k_G.  delta : D l_0^2 / k_G.  Both are zero of a compressible body.
    c : p pi R^2 l_0^2 / k_G.  m : R rho_0 g l_0^2 / k_G.
    """

    incompressible: bool
    printed_contact: bool
    k: float  # k_S or k_I [N]
    area: float  # [m^2]
    square: float  # l_0^2 / k_G [1/N]
    g: float = 0.0
    p: float = 0.0
    d: float = 0.0
    i: float = 0.0
    delta: float = 0.0
    c: float = 0.0
    m: float = 0.0

    @classmethod
    def of(cls, body: Crawler, loads: Loads) -> Groups:
        """The groups of a body under loads."""
        incompressible = isinstance(body.material, Incompressible)
        if incompressible:
            k, k_g = body.incompressible_stiffnesses
        else:
            k, k_p, k_g = body.stiffnesses
        square = body.length**2 / k_g
        c = loads.advancing * body.area * square
        m = body.radius * body.line_density * loads.gravity * square
        own = cls(incompressible, loads.contact == "printed", k, body.area, square, c=c, m=m)
        if incompressible:
            return replace(own, i=k * square, delta=loads.anchoring * square)
        return replace(own, g=k * square, p=k_p / k, d=loads.anchoring / k)

    @property
    def stiffness(self) -> float:
        """g or i."""
        return self.i if self.incompressible else self.g

    @property
    def force(self) -> float:
        """d or delta."""
        return self.delta if self.incompressible else self.d

    def force_of(self, newton: float) -> float:
        """d or delta of a force of the longitudinal muscles [N]."""
        return newton * self.square if self.incompressible else newton / self.k

    def c_of(self, pascal: float) -> float:
        """c of a pressure of the circular muscles [Pa]."""
        return pascal * self.area * self.square

    def compressible_source(
        self, mu: Array, n: Array, c: Array, own: tuple[Array, Array] | None = None
    ) -> tuple[Array, Array, Array]:
        """f, its derivative and mu_3 by `equations.compressible`; own : g and m at each point."""
        g, m = own or self._everywhere(mu)
        return equations.compressible(mu, n, c, g, self.p, m, self.printed_contact)

    def incompressible_source(
        self,
        mu: Array,
        multiplier: Array,
        exponent: Array,
        c: Array,
        own: tuple[Array, Array] | None = None,
    ) -> tuple[Array, Array, Array]:
        """f, its derivative and mu_3 by `equations.incompressible`; own : i and m at each point."""
        i, m = own or self._everywhere(mu)
        return equations.incompressible(mu, multiplier, exponent, c, i, m, self.printed_contact)

    def _everywhere(self, mu: Array) -> tuple[Array, Array]:
        return np.full(mu.shape[0], self.stiffness), np.full(mu.shape[0], self.m)
