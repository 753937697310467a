"""The rod itself, section 3.5: its sections, its reference configuration and its elastic body."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import field_validator, model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Count, Parameters, Quantity
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
    length: Annotated[float, Quantity("m", r"\ell_0", "3.3.1", above=0)]
    height: Annotated[float, Quantity("m", "H", "section 3.5", above=0)]
    width: Annotated[float, Quantity("m", "W", "section 3.5", above=0)]
    young: Annotated[float, Quantity("Pa", "E", "section 3.5", above=0)]
    poisson: Annotated[float, Quantity("1", r"\nu", "section 3.5", above=-1, below=0.5)]
    line_density: Annotated[float, Quantity("kg/m", r"\rho_0", "section 3.5", above=0)]
    shear_correction: Annotated[float, Quantity("1", "k", "3.4.13", above=0)]
    stations: tuple[Station, ...] = ()
    """How width, height, modulus, Poisson's ratio and density vary along the rod."""
    centreline: Annotated[float, Quantity("1", "", "3.3.28", above=0, below=1)] = 0.5
    """Height of the centreline above the lower surface, as a share of the section's; directors reach the upper one."""
    curvature: Annotated[float, Quantity("m^-1", "K", "3.3.23")] = 0.0
    """Of the reference configuration, an arc that turns from E3 towards E2."""
    calibration: Calibration | None = None
    """Of the published energy, which cannot do without; the consistent one takes none."""
    lateral_constraint: LateralConstraint = "free"
    """What the sections of the consistent rod may do in E1; the published one has no such choice."""
    barrier: bool = False
    """Whether the consistent rod resists collapse as Fig. 3.7 shows; equal to second order in the strains."""
    end_sections: EndSections = "full"
    poisson_coupling: PoissonCoupling = "halved"
    intrinsic_curvature: IntrinsicCurvature = "subtracted"

    @field_validator("calibration", mode="before")
    @classmethod
    def _none_at_all(cls, value: object) -> object:
        """A file has no word for nothing: 'none' takes away a calibration that `like` brought in."""
        return None if value == "none" else value

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

    def geometry(self) -> Geometry:
        """Its reference configuration; the directors reach the upper surface."""
        heights = self.height * self._height_shares()
        return Geometry.arc(self.vertices, self.length, (1 - self.centreline) * heights, self.curvature)

    def _height_shares(self) -> Array:
        """Heights at the vertices over the nominal one, after a step that lies on a vertex, shape (N,) [1]."""
        arc = np.linspace(0.0, self.length, self.vertices)
        return share_of(self.stations, "height", arc, before=False)

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
        Its Y02 and Y22 are those of the sections along an edge, in directors of the vertices.
        """
        if self.calibration is not None:
            part, none = self.part_masses(geometry), np.zeros(self.vertices - 1)
            return self._mass_band([part] * 3, [none] * 3, np.ones(self.vertices))[:, :3]
        edges = [
            edge_masses(self.stations, self.line_density, geometry.arc_length, power)
            for power in range(3)
        ]
        own = [np.append(edge.before, 0.0) + np.insert(edge.after, 0, 0.0) for edge in edges]
        return self._mass_band(own, [edge.shared for edge in edges], self._height_shares())

    def _mass_band(self, own: Sequence[Array], shared: Sequence[Array], height: Array) -> Array:
        """The band of masses times height^0, height^1 and height^2, of vertices (N,) and between them (N - 1,).

        height : of the vertices, as shares of the nominal one, (N,) [1].
        """
        band = np.zeros((height.size, len(DOFS), 7))
        before, after = height[:-1, None], height[1:, None]
        m0, m1, m2 = (mass[:, None] for mass in own)
        band[:, :2, 0], band[:, :2, 2] = m0, self.Y02 * m1 / height[:, None]
        band[:, 2:, 0] = self.Y22 * m2 / height[:, None] ** 2
        m0, m1, m2 = (mass[:, None] for mass in shared)
        band[:-1, :2, 4], band[:-1, :2, 6] = m0, self.Y02 * m1 / after
        band[:-1, 2:, 2], band[:-1, 2:, 4] = self.Y02 * m1 / before, self.Y22 * m2 / (before * after)
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
                offset=(0.5 - self.centreline) * self.height,
                curvature=self.curvature,
            )
            shares = self._height_shares()
            return ConsistentRod(
                coefficients(
                    geometry,
                    stiffness,
                    np.zeros(self.vertices) if couples is None else couples,
                    barrier=self.barrier,
                    product=self.lateral_constraint == "incompressible",
                    offsets=self.Y02 * (stiffness.axis / np.stack([shares[:-1], shares[1:]])),
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
