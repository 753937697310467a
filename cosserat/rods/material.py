"""The material of a rod: two of four moduli, and its mass per volume or per length."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Parameters, Quantity

MODULI = ("young", "shear_modulus", "poisson", "bulk_modulus")
"""Keys of the moduli of an isotropic material; two of them determine the others."""


class Material(Parameters):
    """An isotropic elastic material, by two of its four moduli, and its mass per volume or per length."""

    young: Annotated[float, Quantity("Pa", "E", "section 3.5", above=0)] | None = None
    """Young's modulus."""
    poisson: Annotated[float, Quantity("1", r"\nu", "section 3.5", above=-1, below=0.5)] | None = None
    """Poisson's ratio."""
    shear_modulus: Annotated[float, Quantity("Pa", r"\mu", "1.2.96", above=0)] | None = None
    """Shear modulus G."""
    bulk_modulus: Annotated[float, Quantity("Pa", "K", above=0)] | None = None
    """Bulk modulus."""
    line_density: Annotated[float, Quantity("kg/m", r"\rho_0", "section 3.5", above=0)] | None = None
    """Mass per length of the reference configuration; this or 'density' is given."""
    density: Annotated[float, Quantity("kg/m^3", r"\rho_0^*", "section 3.5", above=0)] | None = None
    """Mass per volume of the reference configuration; this or 'line_density' is given."""
    expansion: Annotated[float, Quantity("K^-1", r"\alpha")] | None = None
    """Coefficient of linear thermal expansion, for 'temperatures' that give none."""

    @model_validator(mode="after")
    def _determined(self) -> Self:
        if len(given := self.given) not in (0, 2):
            raise PydanticCustomError(
                "moduli",
                f"has {' and '.join(map(repr, given))}; give two of {', '.join(MODULI)} "
                "('none' removes an inherited one)",
            )
        if given and not -1 < self.moduli[1] < 0.5:
            raise PydanticCustomError(
                "moduli",
                f"has {' and '.join(map(repr, given))} of a Poisson's ratio {self.moduli[1]:g}; "
                "it must be above -1 and below 0.5",
            )
        if (self.density is None) == (self.line_density is None):
            fault = "has neither {} nor {}" if self.density is None else "has both {} and {}"
            raise PydanticCustomError(
                "mass",
                fault.format("a 'density'", "a 'line_density'")
                + "; give one of them ('none' removes an inherited one)",
            )
        return self

    @property
    def given(self) -> list[str]:
        """Keys of the given moduli: two, or none for a section whose stiffnesses are given."""
        return [name for name in MODULI if getattr(self, name) is not None]

    def check_moduli(self) -> None:
        """Raise PydanticCustomError if there are none."""
        if not self.given:
            raise PydanticCustomError(
                "moduli", f"has a 'material' with no modulus; give two of {', '.join(MODULI)}"
            )

    @property
    def moduli(self) -> tuple[float, float]:
        """E [Pa] and nu, from the two moduli that are given."""
        young, poisson, shear, bulk = self.young, self.poisson, self.shear_modulus, self.bulk_modulus
        if young is not None and poisson is not None:
            return young, poisson
        if young is not None and shear is not None:
            return young, young / (2 * shear) - 1
        if young is not None and bulk is not None:
            return young, (1 - young / (3 * bulk)) / 2
        if poisson is not None and shear is not None:
            return 2 * shear * (1 + poisson), poisson
        if poisson is not None and bulk is not None:
            return 3 * bulk * (1 - 2 * poisson), poisson
        assert shear is not None
        assert bulk is not None
        return 9 * bulk * shear / (3 * bulk + shear), (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear))

    def mass_per_length(self, area: float) -> float:
        """Mass per length [kg/m] of a rod with this area [m^2]."""
        if self.line_density is not None:
            return self.line_density
        assert self.density is not None
        return self.density * area
