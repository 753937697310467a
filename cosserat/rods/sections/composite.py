"""Sections of several materials, and sections whose stiffnesses are given; for the consistent energy.

derived: layers lie on each other along E2.  Each has a uniform strain e along the rod, and contracts as it will: the
stress along E2 is continuous, so the stretch w_i of layer i is its own, and that of the section their mean,
w = sum t_i w_i, with t_i the share of the height.  With c_i = E_i / (1 - nu_i^2), the energy per length

    sum A_i c_i (e^2 + 2 nu_i e w_i + w_i^2) / 2,      least over all w_i of the mean w,      is
    EA e^2 / 2 + S (w + n e)^2 / 2,      EA = sum E_i A_i,      n = sum t_i nu_i,      1/S = sum t_i^2 / (A_i c_i),

that is, `Elastic` with volume = S n, section = S (1 - n), axial = EA - S n (1 - n); of one material 2 mu A and
Lambda A.  Strain and bending do not couple about the elastic centre, where sum E_i A_i y_i = 0.  A bent section of
layers also changes its height by the mean of nu y times the curvature; this is left out: it changes no stiffness and
no displacement of the centreline, only the stretch that is shown.

derived: a layer of the coefficient a_i that is warmer by T_i would strain by f_i = a_i T_i in all directions.  The same
energy, with e - f_i and w_i - f_i in place of e and w_i, is

    sum E_i A_i (e - f_i)^2 / 2 + S (w + n e - sum t_i (1 + nu_i) f_i)^2 / 2,

so a section without resultant has EA e = sum E_i A_i f_i and w = sum t_i (1 + nu_i) f_i - n e.  A fibre at the height
y above the elastic centre has the strain e - kappa y, and with T_i = T + T' y the moment vanishes for
EI kappa = -sum E_i a_i (T A_i y_i + T' I_i), I_i about the elastic centre: Timoshenko's bimetal (1925) of two layers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Items, Parameters, Quantity
from cosserat.rods.elasticity import Along, Elastic, LateralConstraint
from cosserat.rods.material import Material
from cosserat.rods.sections.section import FreeStrains, Section, ShearFactor, require_expansion
from cosserat.rods.variation import Scales, Station

Array = NDArray[np.float64]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)  # exact to degree 5; the integrand has degree 4


class Composite(Section):
    """A section without a single isotropic material."""

    of_one_material: ClassVar[bool] = False

    def _check_constraint(self, lateral_constraint: LateralConstraint) -> None:
        if lateral_constraint != "free":
            raise PydanticCustomError(
                "section",
                f"has lateral_constraint = '{lateral_constraint}', but a section with shape = '{self.shape}' "
                "contracts freely; take 'free'",
            )

    def check_stations(self, stations: Sequence[Station]) -> None:
        """Require one set of Poisson's ratios."""
        super().check_stations(stations)
        for station in stations:
            if station.poisson != 1:
                raise PydanticCustomError(
                    "stations",
                    f"'stations' has poisson = {station.poisson:g} at {station.at:g} m, but shape = '{self.shape}' "
                    "has no single Poisson's ratio; leave it out",
                )


def _scaled(nominal: Elastic) -> Along:
    """Stiffnesses of places from the nominal ones: every modulus and every length scales alike."""

    def along(s: Scales) -> Elastic:
        area = s.young * s.width * s.height
        moment = area * s.height**2
        powers = Elastic(area, area, area, area, moment, moment)
        return Elastic(*(value * factor for value, factor in zip(nominal, powers, strict=True)))

    return along


def _elastic(
    pulled: float, lateral: float, poisson: float, shear: float, bending: float, gradient: float
) -> Elastic:
    """From EA, S, n, the shear stiffness, EI and the stiffness against changes of the section stretch."""
    volume, section = lateral * poisson, lateral * (1 - poisson)
    values = (pulled - volume * (1 - poisson), volume, section, shear, bending, gradient)
    return Elastic(*map(np.asarray, values))


class Layer(Parameters):
    """One layer of a section."""

    thickness: Annotated[float, Quantity("m", above=0)]
    """Thickness along E2."""
    width: Annotated[float, Quantity("m", above=0)]
    """Width along E1."""
    material: Material
    """Material of the layer."""

    @model_validator(mode="after")
    def _elastic(self) -> Self:
        self.material.check_moduli()
        return self

    @property
    def area(self) -> float:
        """Area [m^2]."""
        return self.width * self.thickness


class Layers(Composite):
    """Rectangular layers of several materials on each other, bonded."""

    shape: Literal["layers"] = "layers"
    layers: Annotated[tuple[Layer, ...], Items(at_most=100)]
    """Layers from the lower surface to the upper one."""
    shear_factor: Annotated[float | str, ShearFactor("jourawski")] = "jourawski"
    """Factor of the sum of G A of the layers, or "jourawski": of the shear stresses that balance those of bending.

    With Q(y) the sum of E y over the area above y, and b the width, 1 / GA is the integral of Q^2 / (EI^2 G b).  A
    soft core between stiff faces has a factor far from 5/6.
    """

    @model_validator(mode="after")
    def _some(self) -> Self:
        if not self.layers:
            raise PydanticCustomError("layers", "'layers' is empty; give at least one")
        return self

    def check(self, material: Material | None, lateral_constraint: LateralConstraint) -> None:
        """Require that nothing but the layers has a material."""
        if material is not None:
            raise PydanticCustomError(
                "material",
                "has a 'material' beside the layers, which have their own; leave it out "
                "(material = 'none' removes an inherited one)",
            )
        self._check_constraint(lateral_constraint)

    @property
    def height(self) -> float:
        """Height along E2 [m]."""
        return float(self._thickness.sum())

    @property
    def width(self) -> float:
        """Width along E1 of the widest layer [m]."""
        return max(layer.width for layer in self.layers)

    @property
    def _thickness(self) -> Array:
        return np.array([layer.thickness for layer in self.layers])

    @property
    def _middles(self) -> Array:
        """Heights of the middles of the layers above the lower surface [m]."""
        return np.cumsum(self._thickness) - self._thickness / 2

    @property
    def _areas(self) -> Array:
        return np.array([layer.area for layer in self.layers])

    @property
    def _moduli(self) -> tuple[Array, Array]:
        young, poisson = np.array([layer.material.moduli for layer in self.layers]).T
        return young, poisson

    @property
    def _masses(self) -> Array:
        return np.array([layer.material.mass_per_length(layer.area) for layer in self.layers])

    @property
    def centre(self) -> float:
        """Height of the elastic centre above the lower surface, over that of the section [1]."""
        return float(_centre(self._moduli[0] * self._areas, self._middles) / self.height)

    @property
    def mass_centre(self) -> float:
        """Height of the centre of mass above the lower surface, over that of the section [1]."""
        return float(_centre(self._masses, self._middles) / self.height)

    @property
    def mass_spread(self) -> float:
        """Mean over the mass of the squared distance from its centre along E2, over the squared height [1]."""
        masses, middles = self._masses, self._middles
        squares = (middles - _centre(masses, middles)) ** 2 + self._thickness**2 / 12
        return float(masses @ squares / masses.sum() / self.height**2)

    def line_density(self, material: Material | None) -> float:
        """Mass per length [kg/m]."""
        return float(self._masses.sum())

    def along(self, material: Material | None, lateral_constraint: LateralConstraint) -> Along:
        """EA, S, n, the shear stiffness, EI and the sum of mu I, about the elastic centre."""
        (young, poisson), areas, share = self._moduli, self._areas, self._thickness / self.height
        centre = self.centre * self.height
        second = areas * ((self._middles - centre) ** 2 + self._thickness**2 / 12)
        mu = young / (2 * (1 + poisson))
        lateral = 1 / (share**2 * (1 - poisson**2) / (areas * young)).sum()
        bending = float(young @ second)
        shear = (
            self._jourawski(bending)
            if isinstance(self.shear_factor, str)
            else self.shear_factor * float(mu @ areas)
        )
        return _scaled(
            _elastic(
                float(young @ areas), lateral, float(share @ poisson), shear, bending, float(mu @ second)
            )
        )

    def check_expansion(self, material: Material | None, key: str) -> None:
        """Require a coefficient of thermal expansion of every layer."""
        for number, layer in enumerate(self.layers):
            require_expansion(layer.material, f"rod.section.layers.{number}.material", key)

    def expand(
        self, material: Material | None, change: float, gradient: float, scale: Array
    ) -> FreeStrains:
        """Those at which the section has no resultant, though its layers have stresses."""
        (young, poisson), areas, share = self._moduli, self._areas, self._thickness / self.height
        expansion = np.array([layer.material.expansion for layer in self.layers])
        y = self._middles - self.centre * self.height
        second = areas * (y**2 + self._thickness**2 / 12)
        stiff, bent, s = young * areas * expansion, young * second, np.asarray(scale)[..., None]
        axial = ((change + gradient * y * s) * stiff).sum(axis=-1) / (young @ areas)
        curvature = -(change * y / s * stiff + gradient * expansion * bent).sum(axis=-1) / bent.sum()
        free = (share * (1 + poisson) * expansion * (change + gradient * y * s)).sum(axis=-1)
        return FreeStrains(axial, curvature, free - float(share @ poisson) * axial)

    def _jourawski(self, bending: float) -> float:
        """Shear stiffness of stresses that balance those of bending [N]."""
        top, above, compliance = self.height * (1 - self.centre), 0.0, 0.0
        for layer in reversed(self.layers):
            young, poisson = layer.material.moduli
            y = top - layer.thickness * (1 - _NODES) / 2
            Q = above + young * layer.width * (top**2 - y**2) / 2
            density = Q**2 / (bending**2 * young / (2 * (1 + poisson)) * layer.width)
            compliance += float(layer.thickness / 2 * _WEIGHTS @ density)
            bottom = top - layer.thickness
            above += young * layer.width * (top**2 - bottom**2) / 2
            top = bottom
        return 1 / compliance


def _centre(weights: Array, places: Array) -> Array:
    centre: Array = weights @ places / weights.sum()
    return centre


class Stiffnesses(Composite):
    """A section whose stiffnesses are given, as of a cable, a hose or a beam that was measured."""

    shape: Literal["stiffnesses"] = "stiffnesses"
    axial_stiffness: Annotated[float, Quantity("N", "EA", above=0)]
    """Stiffness against stretching along the rod, its sections free to contract."""
    bending_stiffness: Annotated[float, Quantity("N*m^2", "EI", above=0)]
    """Stiffness against bending about E1 through the elastic centre."""
    shear_stiffness: Annotated[float, Quantity("N", "kGA", above=0)]
    """Stiffness against shearing, with its factor."""
    height: Annotated[float, Quantity("m", "H", above=0)]
    """Height in the plane of motion, whose middle is the elastic centre; directors reach the upper surface."""
    poisson: Annotated[float, Quantity("1", r"\nu", above=-1, below=0.5)] = 0.0
    """Contraction of the section along E2 over the strain along the rod.  ASSUME none by default."""
    section_stiffness: Annotated[float, Quantity("N", above=0)] | None = None
    """Stiffness against a stretch of the section along E2 without strain along the rod.

    ASSUME by default that of one material, EA / (1 - nu^2).
    """
    section_gradient_stiffness: Annotated[float, Quantity("N*m^2", above=0)] | None = None
    """Stiffness against a stretch of the section that changes along the rod.

    ASSUME by default that of one material, EI / (2 (1 + nu)).
    """
    gyration: Annotated[float, Quantity("m", above=0)] | None = None
    """Radius of gyration of the mass about E1, for the rotary inertia.

    ASSUME by default that of the stiffness, the square root of EI / EA.
    """

    @model_validator(mode="after")
    def _stable(self) -> Self:
        n, lateral = self.poisson, self._lateral
        if lateral * n * (1 - n) >= self.axial_stiffness:
            raise PydanticCustomError(
                "range",
                f"'section_stiffness' is {lateral:g} N; with this 'poisson' and 'axial_stiffness' it must be below "
                f"{self.axial_stiffness / (n * (1 - n)):g} N",
            )
        if self._squared_gyration > self.height**2 / 4:
            raise PydanticCustomError(
                "range",
                f"has a radius of gyration {self._squared_gyration**0.5:g} m above half its height {self.height:g} m; "
                "give 'gyration', or a larger 'height'",
            )
        return self

    def check(self, material: Material | None, lateral_constraint: LateralConstraint) -> None:
        """Require a material of a mass per length alone."""
        if material is None or material.line_density is None or material.given:
            raise PydanticCustomError(
                "material",
                "has shape = 'stiffnesses', whose 'material' has a 'line_density' and nothing else; "
                "write material = { line_density = \"2.5 kg/m\" } ('none' removes an inherited key)",
            )
        self._check_constraint(lateral_constraint)

    def check_expansion(self, material: Material | None, key: str) -> None:
        """Require that the load has the coefficient: given stiffnesses have no material to take it from."""
        raise PydanticCustomError(
            "expansion",
            f"'{key}' has one without 'expansion', and a section with shape = '{self.shape}' has none either; give it "
            'with the load, such as "12e-6 K^-1"',
        )

    def expand(
        self, material: Material | None, change: float, gradient: float, scale: Array
    ) -> FreeStrains:
        """None; see `check_expansion`."""
        raise AssertionError("checked")

    @property
    def _lateral(self) -> float:
        return self.section_stiffness or self.axial_stiffness / (1 - self.poisson**2)

    @property
    def _squared_gyration(self) -> float:
        return self.gyration**2 if self.gyration else self.bending_stiffness / self.axial_stiffness

    @property
    def mass_spread(self) -> float:
        """Mean over the mass of the squared distance from its centre along E2, over the squared height [1]."""
        return self._squared_gyration / self.height**2

    def line_density(self, material: Material | None) -> float:
        """Mass per length [kg/m]."""
        assert material is not None
        assert material.line_density is not None
        return material.line_density

    def along(self, material: Material | None, lateral_constraint: LateralConstraint) -> Along:
        """EA, S, n, the shear stiffness, EI and the stiffness against changes of the section stretch."""
        gradient = self.section_gradient_stiffness or self.bending_stiffness / (2 * (1 + self.poisson))
        return _scaled(
            _elastic(
                self.axial_stiffness,
                self._lateral,
                self.poisson,
                self.shear_stiffness,
                self.bending_stiffness,
                gradient,
            )
        )
