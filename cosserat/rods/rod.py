"""The rod itself, section 3.5: its sections, its reference configuration and its elastic body."""

from __future__ import annotations

import itertools
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import NONE_BY_WORD, Count, Parameters, Quantity
from cosserat.rods.energies import compliance
from cosserat.rods.energies.compliance import LateralConstraint
from cosserat.rods.energies.hemingway import PublishedRod
from cosserat.rods.energies.hemingway_stiffness import (
    Calibration,
    EndSections,
    IntrinsicCurvature,
    PoissonCoupling,
    stiffnesses,
)
from cosserat.rods.energies.reissner import ConsistentRod
from cosserat.rods.energies.reissner_reference import coefficients
from cosserat.rods.kinematics import DOFS, Geometry
from cosserat.rods.variation import Station, edge_masses, lump, mass_share, mean, vertex_cuts
from cosserat.rods.variation import share as share_of

Array = NDArray[np.float64]
_INCOMPRESSIBLE = 0.49  # least Poisson's ratio that may be called so
RodBody = PublishedRod | ConsistentRod


class Rod(Parameters):
    """A rod of rectangular sections, section 3.5: straight and homogeneous unless it is said to be otherwise."""

    energy: Literal["published", "consistent"] = "published"
    """The thesis's energy (3.4.11) with its calibration, or the one that converges, of `rods.energies.reissner`."""
    vertices: Annotated[int, Count("N", "3.3.1", at_least=3)]
    """Number of vertices of the discrete rod, both ends counted."""
    length: Annotated[float, Quantity("m", r"\ell_0", "3.3.1", above=0)]
    """Length of the centreline in the reference configuration."""
    height: Annotated[float, Quantity("m", "H", "section 3.5", above=0)]
    """Height of the section, in the plane of motion."""
    width: Annotated[float, Quantity("m", "W", "section 3.5", above=0)]
    """Width of the section, across the plane of motion."""
    young: Annotated[float, Quantity("Pa", "E", "section 3.5", above=0)]
    """Young's modulus."""
    poisson: Annotated[float, Quantity("1", r"\nu", "section 3.5", above=-1, below=0.5)]
    """Poisson's ratio."""
    line_density: Annotated[float, Quantity("kg/m", r"\rho_0", "section 3.5", above=0)]
    """Mass per length of the reference configuration."""
    shear_correction: Annotated[float, Quantity("1", "k", "3.4.13", above=0)]
    """Factor of the shear stiffness k mu A; 5/6 for a rectangle."""
    stations: tuple[Station, ...] = ()
    """How width, height, modulus, Poisson's ratio and density vary along the rod."""
    centreline: Annotated[float, Quantity("1", "", "3.3.28", above=0, below=1)] = 0.5
    """Height of the centreline above the lower surface, as a share of the section's; directors reach the upper one."""
    curvature: Annotated[float, Quantity("m^-1", "K", "3.3.23")] = 0.0
    """Curvature of the reference configuration, an arc that turns from E3 towards E2."""
    calibration: Annotated[Calibration | None, NONE_BY_WORD] = None
    """Coefficients of the published energy, which cannot do without them; the consistent one takes none."""
    lateral_constraint: LateralConstraint = "free"
    """What the sections of the consistent rod may do in E1; the published one has no such choice."""
    barrier: bool = False
    """Whether the consistent rod resists collapse as Fig. 3.7 shows; equal to second order in the strains."""
    end_sections: EndSections = "full"
    """Whether the end vertices of the published energy have full areas, or half of them, as eq. (3.4.10) is printed."""
    poisson_coupling: PoissonCoupling = "halved"
    """Whether the last term of eq. (3.4.11) is halved, which the published c7 fits, or as printed (erratum E3.2)."""
    intrinsic_curvature: IntrinsicCurvature = "subtracted"
    """Whether the published energy measures bending from the reference, or from a straight rod, as printed (E3.24)."""

    @model_validator(mode="after")
    def _sound(self) -> Self:
        if (self.calibration is None) == (self.energy == "published"):
            fault = "needs a calibration" if self.calibration is None else "takes no calibration"
            raise PydanticCustomError(
                "calibration",
                f"has energy = '{self.energy}', which {fault}; give the one, or calibration = 'none'",
            )
        if self.energy == "published" and (self.lateral_constraint != "free" or self.barrier):
            raise PydanticCustomError(
                "section",
                "has 'lateral_constraint' or 'barrier', which only energy = 'consistent' knows; leave them out",
            )
        ratios = [self.poisson * station.poisson for station in self.stations] or [self.poisson]
        if not -1 < min(ratios) <= max(ratios) < 0.5:
            raise PydanticCustomError(
                "range",
                f"'stations' take Poisson's ratio from {min(ratios):g} to {max(ratios):g}; "
                "keep it above -1 and below 0.5",
            )
        if self.lateral_constraint == "incompressible" and min(ratios) < _INCOMPRESSIBLE:
            raise PydanticCustomError(
                "section",
                f"has lateral_constraint = 'incompressible' and 'poisson' = {min(ratios):g}; it must be "
                f"{_INCOMPRESSIBLE} or more",
            )
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
        if abs(self.curvature) * self.length / (self.vertices - 1) >= 1:
            raise PydanticCustomError(
                "range",
                "'curvature' turns each edge by more than a radian; use more 'vertices' or a smaller curvature",
            )
        return self

    @property
    def area(self) -> float:
        """Nominal area of the section A [m^2]."""
        return self.width * self.height

    @property
    def second_moment(self) -> float:
        """Nominal second moment of area about E1 through the centreline, I [m^4]."""
        return self.area * self.height**2 * (1 / 12 + (0.5 - self.centreline) ** 2)

    @property
    def Y02(self) -> float:
        """Y02 of eq. (3.3.28): mean of y / |D| over the section, y counted from the centreline [1]."""
        return (0.5 - self.centreline) / (1 - self.centreline)

    @property
    def below(self) -> float:
        """What lies below the centreline, as a share of the directors, which reach the upper surface [1]."""
        return self.centreline / (1 - self.centreline)

    @property
    def Y22(self) -> float:
        """Y22 of eq. (3.3.28): mean of (y / |D|)^2 over the section [1]."""
        return (1 / 12 + (0.5 - self.centreline) ** 2) / (1 - self.centreline) ** 2

    def warnings(self) -> list[str]:
        """What of the rod its edges follow less well than the rest."""
        steps = [
            after.at
            for before, after in itertools.pairwise(self.stations)
            if before.at == after.at and before.height != after.height and 0 < after.at < self.length
        ]
        if self.energy == "published" or self.centreline == 0.5 or not steps:
            return []
        return [
            f"stepped axis: the height jumps at {steps[0]:.4g} m and the centreline is not in the middle, so the area "
            "centres jump too, which an edge cannot; what stretching and bending do to each other there is right to "
            "first order in 'rod.vertices' only: use more, or 'rod.centreline' = 0.5"
        ]

    def geometry(self) -> Geometry:
        """Its reference configuration; the directors reach the upper surface."""
        arc = np.linspace(0.0, self.length, self.vertices)
        heights = self.height * share_of(self.stations, "height", arc, before=False)
        return Geometry.arc(self.vertices, self.length, (1 - self.centreline) * heights, self.curvature)

    def part_masses(self, geometry: Geometry) -> Array:
        """Mass of the part round each vertex, shape (N,) [kg]."""
        cuts = vertex_cuts(geometry.arc_length)
        return (
            self.line_density
            * np.diff(cuts)
            * mean(self.stations, lambda scale, _: mass_share(scale), cuts)
        )

    def mass(self, geometry: Geometry) -> Array:
        """Mass matrix as a symmetric band: (3.3.43), shape (4 N, 3), rho0 L times 1, Y02 and Y22.

        That of the consistent rod is the mean of such a one and of the mass that straight edges have, shape (4 N, 7).
        """
        if self.calibration is not None:
            return self._mass_band(self.part_masses(geometry), np.zeros(self.vertices - 1))[:, :3]
        edges = edge_masses(self.stations, self.line_density, geometry.arc_length)
        own = np.append(edges.before, 0.0) + np.insert(edges.after, 0, 0.0)
        return self._mass_band(own, edges.shared)

    def _mass_band(self, own: Array, shared: Array) -> Array:
        """Masses of vertices (N,) and between neighbours (N - 1,), times 1, Y02 and Y22, shape (4 N, 7)."""
        first, second = self.Y02, self.Y22
        band = np.zeros((own.size, len(DOFS), 7))
        band[:, :2, 0], band[:, :2, 2], band[:, 2:, 0] = (
            factor * own[:, None] for factor in (1.0, first, second)
        )
        band[:-1, :2, 4], band[:-1, :2, 6] = shared[:, None], first * shared[:, None]
        band[:-1, 2:, 2], band[:-1, 2:, 4] = first * shared[:, None], second * shared[:, None]
        return band.reshape(-1, 7)

    def body(self, geometry: Geometry, couples: Array | None = None) -> RodBody:
        """The elastic body and its couples, shape (N,) [N m].

        The published energy takes the averages of Table 3.1 and I about the centreline, the consistent one the
        compliances of its edges and I about the area centres.
        """
        arc = geometry.arc_length
        if self.calibration is None:
            stiffness = compliance.stiffnesses(
                self.stations,
                arc,
                area=self.area,
                second_moment=self.area * self.height**2 / 12,
                young=self.young,
                poisson=self.poisson,
                shear_correction=self.shear_correction,
                lateral_constraint=self.lateral_constraint,
            )
            return ConsistentRod(
                coefficients(
                    geometry,
                    stiffness,
                    np.zeros(self.vertices) if couples is None else couples,
                    barrier=self.barrier,
                    product=self.lateral_constraint == "incompressible",
                    offset=self.Y02,
                )
            )
        vertex, edge = lump(
            self.stations,
            arc,
            area=self.area,
            second_moment=self.second_moment,
            young=self.young,
            poisson=self.poisson,
        )
        stiff = stiffnesses(
            geometry,
            vertex,
            edge,
            self.shear_correction,
            self.calibration,
            self.end_sections,
            self.poisson_coupling,
            self.intrinsic_curvature,
        )
        return PublishedRod.of(stiff, geometry, couples)
