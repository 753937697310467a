"""The rod itself, section 3.5: its sections, its reference configuration and its elastic body."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Strict, ValidationError, ValidationInfo, model_validator
from pydantic_core import PydanticCustomError

from cosserat.errors import InputError
from cosserat.parameters import Count, OneOf, Parameters, Quantity
from cosserat.rods.elasticity import Elastic, LateralConstraint
from cosserat.rods.energies import ENERGIES, energy_named
from cosserat.rods.energies.energy import Energy
from cosserat.rods.energies.hemingway_stiffness import (
    Calibration,
    EndSections,
    IntrinsicCurvature,
    PoissonCoupling,
)
from cosserat.rods.kinematics import Kinematics
from cosserat.rods.material import Material
from cosserat.rods.naming import DofName
from cosserat.rods.places import equal_mesh, vertex_at
from cosserat.rods.reference import Geometry
from cosserat.rods.sections import AnySection
from cosserat.rods.sections.section import Homogeneous
from cosserat.rods.shapes import AnyShape, Points, Shape, Straight
from cosserat.rods.variation import NOMINAL, Scales, Station, mean, scale_at, vertex_cuts

Array = NDArray[np.float64]


class Rod(Parameters):
    """A rod of one section and material, section 3.5: straight and uniform by default."""

    energy: Annotated[str, OneOf(ENERGIES)] = "published"
    """The thesis's energy (3.4.11) with its calibration, or the convergent one of `rods.energies.reissner`."""
    vertices: Annotated[int, Count("N", "3.3.1", at_least=3, at_most=200_000)]
    """Number of vertices of the discrete rod, both ends included."""
    length: Annotated[float, Quantity("m", r"\ell_0", "3.3.1", above=0)]
    """Length of the centreline in the reference configuration."""
    section: AnySection
    """Cross-section of the rod."""
    material: Material | None = None
    """Material of the rod; layers have their own."""
    stations: tuple[Station, ...] = ()
    """Variation of width, height, modulus, Poisson's ratio and density along the rod."""
    centreline: Annotated[float, Quantity("1", "", "3.3.28", above=0, below=1)] = 0.5
    """Height of the centreline above the lower surface over that of the section; directors reach the upper surface."""
    rest: AnyShape = Straight()
    """Shape of the centreline at rest, without loads."""
    calibration: Calibration | None = None
    """Coefficients of the published energy, required there; the consistent one has none."""
    lateral_constraint: LateralConstraint = "free"
    """Lateral constraint of the sections in E1, of the consistent rod only."""
    barrier: Annotated[bool, Strict()] = False
    """Whether the consistent rod resists collapse as in Fig. 3.7; equal to second order in the strains."""
    end_sections: EndSections = "full"
    """Whether the end vertices of the published energy have full areas, or half of them, as eq. (3.4.10) is printed."""
    poisson_coupling: PoissonCoupling = "halved"
    """Whether the last term of eq. (3.4.11) is halved, which the published c7 fits, or as printed (erratum E3.2)."""
    intrinsic_curvature: IntrinsicCurvature = "subtracted"
    """Whether the published energy measures bending from the reference, or from a straight rod, as printed (E3.24)."""

    @model_validator(mode="before")
    @classmethod
    def _as_long_as_its_points(cls, values: Any, info: ValidationInfo) -> Any:
        """The length of a rod at rest along points, where none is given."""
        if not isinstance(values, Mapping):
            return values
        length = values.get("length", "none")
        if not isinstance(length, str) or length != "none":
            return values
        others, rest = {k: v for k, v in values.items() if k != "length"}, values.get("rest")
        if isinstance(rest, Mapping) and rest.get("kind") == "points":
            try:
                rest = Points.model_validate(rest, context=info.context)
            except ValidationError:
                return {**others, "length": "1 m"}  # so that only the faults of the points are told
        return {**others, "length": f"{rest.length!r} m"} if isinstance(rest, Points) else others

    @model_validator(mode="after")
    def _sound(self) -> Self:
        for other in ENERGIES:
            options = energy_named(other).options
            given = [
                option for option in options if getattr(self, option) != Rod.model_fields[option].default
            ]
            if other != self.energy and given:
                raise PydanticCustomError(
                    "energy",
                    f"has {' and '.join(map(repr, given))}, which only energy = '{other}' takes; "
                    "leave it out (calibration = 'none' removes an inherited one)",
                )
        self.section.check(self.material, self.lateral_constraint)
        self.section.check_stations(self.stations)
        ratios = self.poisson_ratios
        if ratios and not -1 < min(ratios) <= max(ratios) < 0.5:
            raise PydanticCustomError(
                "range",
                f"'stations' take Poisson's ratio from {min(ratios):g} to {max(ratios):g}; "
                "keep it above -1 and below 0.5",
            )
        self.strain_energy.check(self)
        places = [station.at for station in self.stations]
        if places != sorted(places):
            raise PydanticCustomError(
                "order", "'stations' are not in the order of 'at'; sort them along the rod"
            )
        if places and places[-1] > self.length * (1 + 1e-12):
            raise PydanticCustomError(
                "range",
                f"'stations' has one at {places[-1]:g} m, but the rod goes from 0 to {self.length:g} m; move it",
            )
        self.check_shape("rest", self.rest)
        return self

    def check_shape(self, key: str, shape: Shape) -> None:
        """Raise PydanticCustomError if it cannot have a shape; key : the name of the shape."""
        shape.check(key, self.length)
        if shape.straight:
            return
        turns = np.diff(shape.angles(np.linspace(0.0, self.length, self.vertices)))
        if np.abs(turns).max() >= 1:
            raise PydanticCustomError(
                "range",
                f"'{key}' rotates an edge by more than a radian; use more 'vertices' or a smaller curvature",
            )

    @property
    def strain_energy(self) -> Energy:
        """The energy named by `energy`."""
        return energy_named(self.energy)

    @property
    def kinematics(self) -> Kinematics:
        """The layout of its degrees of freedom."""
        return self.strain_energy.kinematics

    @property
    def poisson_ratios(self) -> list[float]:
        """Poisson's ratio at its stations, at least one; none for a section without a single material."""
        if not isinstance(self.section, Homogeneous):
            return []
        return [self.poisson * station.poisson for station in self.stations] or [self.poisson]

    @property
    def height(self) -> float:
        """Nominal height of the section, in the plane of motion [m]."""
        return self.section.height

    @property
    def width(self) -> float:
        """Nominal width of the section, across the plane of motion [m]."""
        width = getattr(self.section, "width", None)
        if width is None:
            raise InputError(
                f"a section with shape = '{self.section.shape}' has no 'width'; take another shape"
            )
        return float(width)

    @property
    def homogeneous(self) -> tuple[Homogeneous, float, float]:
        """The section, E [Pa] and nu.

        Raises
        ------
        InputError : the section has no single material.
        """
        if not isinstance(self.section, Homogeneous):
            raise InputError(
                f"a section with shape = '{self.section.shape}' has no single area and modulus; take another shape"
            )
        assert self.material is not None  # checked
        return (self.section, *self.material.moduli)

    @property
    def young(self) -> float:
        """Nominal Young's modulus [Pa], of a section of one material."""
        return self.homogeneous[1]

    @property
    def poisson(self) -> float:
        """Nominal Poisson's ratio [1], of a section of one material."""
        return self.homogeneous[2]

    @property
    def shear_correction(self) -> float:
        """Factor k of the shear stiffness k mu A [1], of a section of one material."""
        return float(self.homogeneous[0].shear_factor_for(self.poisson))

    @property
    def area(self) -> float:
        """Nominal area of the section A [m^2], of a section of one material."""
        return self.homogeneous[0].area

    @property
    def second_moment(self) -> float:
        """Nominal second moment of area about E1 through the centreline, I [m^4], of a section of one material."""
        spread = 1 / self.homogeneous[0].thinness
        return self.area * self.height**2 * (spread + (0.5 - self.centreline) ** 2)

    @property
    def line_density(self) -> float:
        """Nominal mass per length of the reference configuration [kg/m]."""
        return self.section.line_density(self.material)

    @property
    def elastic(self) -> Elastic:
        """Nominal stiffnesses about the elastic centre, of any section [N, N m^2]."""
        return self.section.along(self.material, self.lateral_constraint)(NOMINAL)

    @property
    def Y02(self) -> float:
        """Y02 of eq. (3.3.28): mean of y / |D| over the mass of the section, y counted from the centreline [1]."""
        return (self.section.mass_centre - self.centreline) / (1 - self.centreline)

    @property
    def elastic_offset(self) -> float:
        """Distance of the elastic centre from the centreline over that of the upper surface [1]."""
        return (self.section.centre - self.centreline) / (1 - self.centreline)

    @property
    def below(self) -> float:
        """Distance of the lower surface from the centreline, as a fraction of that of the upper one [1]."""
        return self.centreline / (1 - self.centreline)

    @property
    def Y22(self) -> float:
        """Y22 of eq. (3.3.28): mean of (y / |D|)^2 over the mass of the section [1]."""
        away = self.section.mass_centre - self.centreline
        return (self.section.mass_spread + away**2) / (1 - self.centreline) ** 2

    def geometry(self, arc: Array | None = None) -> Geometry:
        """Its reference configuration; the directors reach the upper surface.

        arc : (N,) arc length of the vertices [m]; equally spaced by default.
        """
        arc = equal_mesh(self.vertices, self.length) if arc is None else arc
        heights = self.height * self.height_fractions(arc)
        reach = (1 - self.centreline) * heights
        return self.placed(self.rest, arc, reach)

    def placed(self, shape: Shape, arc: Array, director_length: Array) -> Geometry:
        """The rod in a shape, its directors normal to it; arc, director_length : (N,) [m]."""
        if shape.straight:
            return Geometry.straight(arc, director_length)
        first = float(shape.angles(arc[:1])[0])
        true = self.strain_energy.true_normals
        return Geometry.arc(arc, director_length, shape.curvatures(arc), shape.origin, first, true)

    def height_fractions(self, arc: Array) -> Array:
        """Heights at arc lengths (N,) [m] over the nominal one, after any step there, shape (N,) [1]."""
        if not self.stations:
            return np.ones(arc.shape)
        return scale_at(self.stations, "height", arc, before=False)

    def part_masses(self, geometry: Geometry) -> Array:
        """Mass of the part round each vertex, shape (N,) [kg]."""
        cuts = vertex_cuts(geometry.arc_length)
        return (
            self.line_density
            * np.diff(cuts)
            * mean(self.stations, lambda scale, _: self.section.mass_along(scale), cuts)
        )

    def inertia_along(self, s: Scales) -> Array:
        """Mass per length, and its products with Y02 |D| and Y22 |D|^2, over the nominal ones, (3, points) [1]."""
        inertia = self.section.mass_along(s) * s.height ** np.arange(3)[:, None]
        if s.wall is not None:  # the section keeps its centre, but not its proportions
            away = (self.section.mass_centre - self.centreline) ** 2
            nominal = self.section.mass_spread + away
            inertia[2] *= (self.section.mass_spread_along(s) + away) / nominal
        return inertia

    def mass(self, geometry: Geometry) -> Array:
        """Mass matrix as a symmetric band, (n, w), eq. (3.3.43)."""
        return self.strain_energy.mass(self, geometry)

    def dof(self, at: str | int, name: DofName, arc: Array) -> int:
        """The index of a degree of freedom of the vertex at a place; arc : (N,) of the vertices [m]."""
        return vertex_at(at, arc) * self.kinematics.per_vertex + self.kinematics.dofs.index(name)

    def vectors(self, geometry: Geometry, u: Array) -> Array:
        """The vectors of every vertex, displaced by u (n,) from the reference: (N, m, 2) [m]."""
        return self.kinematics.split(self.strain_energy.reference(geometry) + u)
