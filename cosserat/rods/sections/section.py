"""The interface of the cross-sections of a rod, and sections of one material."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError, core_schema

from cosserat.parameters import Parameters, Quantity, Reader
from cosserat.rods.elasticity import Along, LateralConstraint, of_one_material
from cosserat.rods.material import Material
from cosserat.rods.variation import Scales, Station, walls_vary
from cosserat.text import shown

Array = NDArray[np.float64]


class FreeStrains(NamedTuple):
    """Strains at which a section is without stress, arrays of one shape.

    axial : along the rod at the elastic centre [1].  curvature : from E3 towards E2 [1/m].  section : along E2 [1].
    """

    axial: Array
    curvature: Array
    section: Array


def expanded(expansion: float, change: float, gradient: float, scale: Array) -> FreeStrains:
    """The strains of one coefficient of expansion [1/K]: every fibre expands alike in all directions."""
    same = np.ones_like(scale)
    return FreeStrains(
        expansion * change * same, -expansion * gradient * same, expansion * change * same
    )


class Section(Parameters):
    """A cross-section, symmetric about the plane of motion; y runs along E2, in the direction of its height.

    Each class has its own `shape` and lengths.  `height` along E2 and `width` along E1 are those of the rectangle
    round it.
    """

    of_one_material: ClassVar[bool] = True
    """Whether it has one isotropic material, an area and a second moment; the published energy needs them."""
    shape: str

    if TYPE_CHECKING:  # a key or a property of each class

        @property
        def height(self) -> float:
            """Height along E2 [m]."""

    @abstractmethod
    def check(self, material: Material | None, lateral_constraint: LateralConstraint) -> None:
        """Raise PydanticCustomError if it cannot be made of a material, or with a lateral constraint."""

    def check_stations(self, stations: Sequence[Station]) -> None:
        """Raise PydanticCustomError if it cannot vary like this along a rod."""
        for station in stations:
            if station.wall is not None:
                raise PydanticCustomError(
                    "stations",
                    f"'stations' has wall = {station.wall:g} at {station.at:g} m, but a section with shape = "
                    f"'{self.shape}' has no wall; leave it out",
                )

    @abstractmethod
    def along(self, material: Material | None, lateral_constraint: LateralConstraint) -> Along:
        """Its stiffnesses at places of a rod, about its elastic centre."""

    @abstractmethod
    def check_expansion(self, material: Material | None, key: str) -> None:
        """Raise PydanticCustomError unless its materials have coefficients of thermal expansion; key : of the load."""

    @abstractmethod
    def expand(
        self, material: Material | None, change: float, gradient: float, scale: Array
    ) -> FreeStrains:
        """Strains without stress under a change of temperature, its sections free to expand.

        change : at the elastic centre [K].  gradient : of the change, towards the upper surface [K/m].
        scale : heights over the nominal one, any shape [1].
        """

    @abstractmethod
    def line_density(self, material: Material | None) -> float:
        """Mass per length [kg/m]."""

    @property
    def centre(self) -> float:
        """Height of the elastic centre above the lower surface, over that of the section [1]."""
        return 0.5

    @property
    def mass_centre(self) -> float:
        """Height of the centre of mass above the lower surface, over that of the section [1]."""
        return 0.5

    @property
    @abstractmethod
    def mass_spread(self) -> float:
        """Mean over the mass of the squared distance from its centre along E2, over the squared height [1]."""

    def mass_along(self, s: Scales) -> Array:
        """Mass per length at places over the nominal one [1]."""
        return s.density * s.width * s.height

    def mass_spread_along(self, s: Scales) -> Array:
        """`mass_spread` at places [1]."""
        return np.full(s.height.shape, self.mass_spread)


@dataclass(frozen=True)
class ShearFactor(Reader):
    """Annotation: a factor of the shear stiffness, or a word for one that follows from the section."""

    word: str

    @property
    def alternatives(self) -> Any:
        """A number or the word."""
        return Annotated[float, self._number] | Literal[self.word]

    @property
    def _number(self) -> Quantity:
        return Quantity("1", "k", "3.4.13", above=0)

    @property
    def said(self) -> str:
        """In words."""
        return f'a number above 0, such as 0.9 or "5/6", or "{self.word}"'

    def check(self, value: object, info: core_schema.ValidationInfo) -> float | str:
        """Read one factor."""
        if isinstance(value, str) and value == self.word:
            return self.word
        try:
            return self._number.check(value, info)
        except PydanticCustomError as error:
            if error.type == "range":
                raise
            raise PydanticCustomError("type", f"is {shown(value)}; it must be {self.said}") from None


class Homogeneous(Section):
    """A section of one material."""

    stays_in_proportion: ClassVar[bool] = False
    """Whether its height and its width can only grow together."""
    proportions_in_cowper: ClassVar[bool] = True
    """Whether Cowper's factor depends on the ratio of its lengths."""
    shear_factor: Annotated[float | str, ShearFactor("cowper")]
    """Factor k of the shear stiffness k mu A: a number, 5/6 for a rectangle, or "cowper".

    Cowper's factors depend on Poisson's ratio and the shape: J. Appl. Mech. 33 (1966) 335-340.
    """

    if TYPE_CHECKING:  # a key or a property of each class

        @property
        def area(self) -> float:
            """Area A [m^2]."""

        @property
        def second_moment(self) -> float:
            """Second moment of area about E1 through the area centre, I [m^4]."""

    @property
    def thinness(self) -> float:
        """A H^2 / I, with H the height: 12 for a rectangle [1]."""
        return self.area * self.height * self.height / self.second_moment

    @property
    def mass_spread(self) -> float:
        """I / (A H^2) [1]."""
        return 1 / self.thinness

    @abstractmethod
    def cowper(self, poisson: Any) -> Any:
        """Cowper's shear factor for Poisson's ratio, a number or an array [1].

        Raises
        ------
        PydanticCustomError : there is none for this shape.
        """

    def shear_factor_for(self, poisson: Any) -> Any:
        """The shear factor k for Poisson's ratio, a number or an array [1]."""
        return self.cowper(poisson) if isinstance(self.shear_factor, str) else self.shear_factor

    def area_along(self, s: Scales) -> Array:
        """Area at places [m^2]."""
        return self.area * s.width * s.height

    def second_moment_along(self, s: Scales) -> Array:
        """Second moment of area about E1 through the area centre, at places [m^4]."""
        nominal = self.area * self.height * self.height / self.thinness
        return nominal * s.width * s.height**3

    def shear_factor_along(self, s: Scales, poisson: Array) -> Any:
        """The shear factor at places with a Poisson's ratio [1]."""
        return self.shear_factor_for(poisson)

    def check(self, material: Material | None, lateral_constraint: LateralConstraint) -> None:
        """Require a material with moduli and a mass."""
        if material is None:
            raise PydanticCustomError(
                "material",
                f"has no 'material'; write a table with two of its moduli and a density for a {self.shape}",
            )
        material.check_moduli()
        self.shear_factor_for(material.moduli[1])

    def check_stations(self, stations: Sequence[Station]) -> None:
        """Require that shapes keep their proportions where they must."""
        super().check_stations(stations)
        self._check_proportions(stations)

    def _check_proportions(self, stations: Sequence[Station]) -> None:
        own = walls_vary(stations)
        by_cowper = self.shear_factor == "cowper" and self.proportions_in_cowper and not own
        for station in stations:
            if station.height != station.width and (self.stays_in_proportion or by_cowper):
                why = f"a {self.shape}" if self.stays_in_proportion else "a shear_factor of 'cowper'"
                raise PydanticCustomError(
                    "stations",
                    f"'stations' has height = {station.height:g} and width = {station.width:g} at {station.at:g} m, "
                    f"but {why} keeps its proportions; give both the same factor",
                )

    def along(self, material: Material | None, lateral_constraint: LateralConstraint) -> Along:
        """2 mu A, Lambda A, k mu A, EI and mu I."""
        assert material is not None
        return of_one_material(
            self.area_along,
            self.second_moment_along,
            *material.moduli,
            self.shear_factor_along,
            lateral_constraint,
        )

    def line_density(self, material: Material | None) -> float:
        """Mass per length, given or from that per volume [kg/m]."""
        assert material is not None
        return material.mass_per_length(self.area)

    def check_expansion(self, material: Material | None, key: str) -> None:
        """Require a coefficient of thermal expansion of the material."""
        require_expansion(material, "rod.material", key)

    def expand(
        self, material: Material | None, change: float, gradient: float, scale: Array
    ) -> FreeStrains:
        """Those of the coefficient of its material."""
        assert material is not None
        assert material.expansion is not None
        return expanded(material.expansion, change, gradient, scale)


def require_expansion(material: Material | None, place: str, key: str) -> None:
    """Raise PydanticCustomError if a material has no coefficient of thermal expansion.

    place : of the material.  key : of the load that needs it.
    """
    if material is None or material.expansion is None:
        raise PydanticCustomError(
            "expansion",
            f"'{key}' has one without 'expansion', and '{place}' has none either; give it in one of them, such as "
            '"12e-6 K^-1"',
        )
