"""A straight rod with its supports and loads: what its problems at rest and in motion have in common, section 3.5."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import GetCoreSchemaHandler, field_validator, model_validator
from pydantic_core import PydanticCustomError, core_schema

from cosserat.models.consistent import ConsistentRod, SectionState, coefficients
from cosserat.models.loaded_rod import LoadedRod
from cosserat.models.planar_rod import UNKNOWNS, Geometry
from cosserat.models.published import PublishedRod
from cosserat.models.section import Station, lump, mass_share, mean
from cosserat.models.section import share as share_of
from cosserat.models.stiffness import (
    Calibration,
    EndSections,
    IntrinsicCurvature,
    PoissonCoupling,
    stiffnesses,
)
from cosserat.parameters import Count, Parameters, Quantity

Array = NDArray[np.float64]
_INCOMPRESSIBLE = 0.49  # least Poisson's ratio that may be called so
RodBody = PublishedRod | ConsistentRod
_DIRECTIONS = {"E3": (1.0, 0.0), "-E3": (-1.0, 0.0), "E2": (0.0, 1.0), "-E2": (0.0, -1.0)}


class _VertexName:
    """Annotation: 'first', 'last' or an index."""

    @staticmethod
    def check(value: object) -> str | int:
        """Read one name of a vertex."""
        if isinstance(value, str) and value in ("first", "last"):
            return value
        if isinstance(value, bool) or not isinstance(value, int) or value < 0:
            raise PydanticCustomError(
                "type", f"is {value!r}; it must be 'first', 'last' or the index of a vertex"
            )
        return value

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)


Vertex = Annotated[str | int, _VertexName()]
Direction = Literal["E3", "-E3", "E2", "-E2"]
UnknownName = Literal["x3", "x2", "d3", "d2"]


def unit_vector(direction: Direction) -> Array:
    """The unit vector of a named direction, shape (2,)."""
    return np.array(_DIRECTIONS[direction])


class Rod(Parameters):
    """A rod of rectangular sections, section 3.5: straight and homogeneous unless it is said to be otherwise."""

    energy: Literal["published", "consistent"] = "published"
    """The thesis's energy (3.4.11) with its calibration, or the one that converges, of `models.consistent`."""
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
    section: SectionState = "free"
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
        if self.energy == "published" and (self.section != "free" or self.barrier):
            raise PydanticCustomError(
                "section",
                "has 'section' or 'barrier', which only energy = 'consistent' knows; leave them out",
            )
        ratios = [self.poisson * station.poisson for station in self.stations] or [self.poisson]
        if not -1 < min(ratios) <= max(ratios) < 0.5:
            raise PydanticCustomError(
                "range",
                f"'stations' take Poisson's ratio from {min(ratios):g} to {max(ratios):g}; "
                "keep it above -1 and below 0.5",
            )
        if self.section == "incompressible" and min(ratios) < _INCOMPRESSIBLE:
            raise PydanticCustomError(
                "section",
                f"has section = 'incompressible' and 'poisson' = {min(ratios):g}; it must be {_INCOMPRESSIBLE} "
                "or more",
            )
        places = [station.at for station in self.stations]
        if places != sorted(places):
            raise PydanticCustomError(
                "order", "'stations' are not in the order of 'at'; sort them along the rod"
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
    def first_inertia(self) -> float:
        """Y02 of eq. (3.3.28): mean of y / |D| over the section, y counted from the centreline [1]."""
        return (0.5 - self.centreline) / (1 - self.centreline)

    @property
    def second_inertia(self) -> float:
        """Y22 of eq. (3.3.28): mean of (y / |D|)^2 over the section [1]."""
        return (1 / 12 + (0.5 - self.centreline) ** 2) / (1 - self.centreline) ** 2

    def geometry(self) -> Geometry:
        """Its reference configuration; the directors reach the upper surface."""
        arc = np.linspace(0.0, self.length, self.vertices)
        heights = self.height * share_of(self.stations, "height", arc, before=False)
        return Geometry.arc(self.vertices, self.length, (1 - self.centreline) * heights, self.curvature)

    def part_masses(self, geometry: Geometry) -> Array:
        """Mass of the part round each vertex, shape (N,) [kg]."""
        arc, part = geometry.arc_length, geometry.voronoi_length
        cuts = np.concatenate([arc[:1], (arc[1:] + arc[:-1]) / 2, arc[-1:]])
        return self.line_density * part * mean(self.stations, mass_share, cuts[:-1], cuts[1:])

    def body(self, geometry: Geometry, couples: Array | None = None) -> RodBody:
        """The elastic body with the averages of Table 3.1 and its couples, shape (N,) [N m]."""
        vertex, edge = lump(
            self.stations,
            geometry.arc_length,
            area=self.area,
            second_moment=self.second_moment,
            young=self.young,
            poisson=self.poisson,
        )
        if self.calibration is None:
            moments = np.zeros(self.vertices) if couples is None else couples
            return ConsistentRod(
                coefficients(
                    geometry, vertex, edge, self.shear_correction, self.section, moments, self.barrier
                )
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


class Support(Parameters):
    """Numbers of one vertex that keep their reference value."""

    at: Vertex
    hold: tuple[UnknownName, ...]


class Gravity(Parameters):
    """The weight of the rod, lumped at the vertices: rho0 g L, section 3.5."""

    g: Annotated[float, Quantity("m/s^2", "g", "section 3.5")]
    along: Direction


class PointForce(Parameters):
    """A dead force on the centreline at one vertex."""

    at: Vertex
    along: Direction
    force: Annotated[float, Quantity("N", "n", "section 3.5")]


class LineLoad(Parameters):
    """A dead force per length on the centreline, over a stretch of it."""

    along: Direction
    density: Annotated[float, Quantity("N/m")]
    start: Annotated[float, Quantity("m", at_least=0)] = 0.0
    end: Annotated[float, Quantity("m", above=0)] | None = None
    """The end of the rod, if not given."""


class Couple(Parameters):
    """A moment on one section, positive from E3 towards E2, that turns with it: it does the work of a couple."""

    at: Vertex
    moment: Annotated[float, Quantity("N*m", r"\mathbf{M}", "3.3.41")]


class Move(Parameters):
    """A held number that is moved: at rest to a new place, in motion there at once or to and fro.

    With a frequency f it stands at by sin(2 pi f t) from its reference value.
    """

    at: Vertex
    unknown: UnknownName
    by: Annotated[float, Quantity("m")]
    frequency: Annotated[float, Quantity("Hz", at_least=0)] = 0.0


class RodProblem(Parameters):
    """A rod, what holds it and what pulls it."""

    rod: Rod
    supports: tuple[Support, ...]
    gravity: Gravity | None = None
    forces: tuple[PointForce, ...] = ()
    line_loads: tuple[LineLoad, ...] = ()
    couples: tuple[Couple, ...] = ()
    moves: tuple[Move, ...] = ()

    @model_validator(mode="after")
    def _vertices_exist(self) -> Self:
        for at in [
            item.at for items in (self.supports, self.forces, self.couples, self.moves) for item in items
        ]:
            if isinstance(at, int) and at >= self.rod.vertices:
                raise PydanticCustomError(
                    "range",
                    f"'at' is {at}, but the rod's vertices are 0 to {self.rod.vertices - 1}; "
                    "choose one of those, 'first' or 'last'",
                )
        for line in self.line_loads:
            end = self.rod.length if line.end is None else line.end
            if not line.start < end <= self.rod.length * (1 + 1e-12):
                raise PydanticCustomError(
                    "range",
                    f"'line_loads' has one from {line.start:g} m to {end:g} m, but the rod goes from 0 to "
                    f"{self.rod.length:g} m; let it begin before it ends, on the rod",
                )
        moved = [(self.index(move.at), move.unknown) for move in self.moves]
        if len(set(moved)) < len(moved):
            raise PydanticCustomError(
                "twice", "'moves' moves the same number of a vertex twice; put both together"
            )
        held = self.held()
        for move in self.moves:
            if not held[self.index(move.at), UNKNOWNS.index(move.unknown)]:
                raise PydanticCustomError(
                    "support",
                    f"'moves' moves {move.unknown} of vertex {move.at}, which no support holds; "
                    "add it to 'hold' of a support there",
                )
        return self

    def loads(self, geometry: Geometry) -> Array:
        """Dead forces on the unknowns of each vertex, shape (N, 4) [N]."""
        load = np.zeros((self.rod.vertices, len(UNKNOWNS)))
        if self.gravity is not None:
            weight = (
                self.gravity.g
                * self.rod.part_masses(geometry)[:, None]
                * unit_vector(self.gravity.along)
            )
            load[:, :2] += weight
            load[:, 2:] += self.rod.first_inertia * weight  # the weight acts at the centre of mass
        for line in self.line_loads:
            covered = _overlap(geometry, line.start, self.rod.length if line.end is None else line.end)
            load[:, :2] += line.density * covered[:, None] * unit_vector(line.along)
        for item in self.forces:
            load[self.index(item.at), :2] += item.force * unit_vector(item.along)
        return load

    def body(self, geometry: Geometry) -> RodBody:
        """The rod with its couples, which have a potential but are no dead load."""
        return self.rod.body(geometry, self._moments())

    def loaded(self, geometry: Geometry) -> LoadedRod:
        """The consistent rod with all its loads, couples and moves growing together."""
        rod = self.rod.body(geometry)
        assert isinstance(rod, ConsistentRod)
        dead = self.loads(geometry).ravel()
        held = self.held().ravel()
        return LoadedRod(rod.displaced(geometry), self._moments(), dead, held, self.drive(0.0)[0])

    def _moments(self) -> Array:
        """Couple at each vertex, shape (N,) [N m]."""
        moments = np.zeros(self.rod.vertices)
        for item in self.couples:
            moments[self.index(item.at)] += item.moment
        return moments

    def mass(self, geometry: Geometry) -> Array:
        """Mass matrix as a symmetric band: (3.3.43), shape (4 N, 3), rho0 L times 1, Y02 and Y22.

        The consistent rod takes the mean of that and of the mass that straight edges have, shape (4 N, 5): their errors
        in a frequency are opposite.  Where the centreline is off the area centres it takes (3.3.43) too.
        """
        if self.rod.calibration is None and self.rod.first_inertia == 0.0:
            return self._mean_mass(geometry)
        part = self.rod.part_masses(geometry)
        band = np.zeros((part.size, len(UNKNOWNS), 3))
        band[:, :2, 0] = part[:, None]
        band[:, 2:, 0] = part[:, None] * self.rod.second_inertia
        band[:, :2, 2] = part[:, None] * self.rod.first_inertia
        return band.reshape(-1, 3)

    def _mean_mass(self, geometry: Geometry) -> Array:
        arc = geometry.arc_length
        share = mean(self.rod.stations, mass_share, arc[:-1], arc[1:])
        edge = self.rod.line_density * geometry.edge_length * share
        own = np.zeros(arc.size)
        own[:-1] += 5 / 12 * edge
        own[1:] += 5 / 12 * edge
        band = np.zeros((arc.size, len(UNKNOWNS), 5))
        for columns, inertia in ((slice(0, 2), 1.0), (slice(2, 4), self.rod.second_inertia)):
            band[:, columns, 0] = inertia * own[:, None]
            band[:-1, columns, 4] = inertia * edge[:, None] / 12
        return band.reshape(-1, 5)

    def drive(self, time: float) -> tuple[Array, Array]:
        """Prescribed displacement and velocity of the held numbers at a time, each of shape (4 N,)."""
        place, rate = np.zeros((2, self.rod.vertices, len(UNKNOWNS)))
        for move in self.moves:
            at = self.index(move.at), UNKNOWNS.index(move.unknown)
            omega = 2 * np.pi * move.frequency
            place[at] = move.by * (np.sin(omega * time) if omega else 1.0)
            rate[at] = move.by * omega * np.cos(omega * time)
        return place.ravel(), rate.ravel()

    def held(self) -> NDArray[np.bool_]:
        """Which unknowns of each vertex keep their value, shape (N, 4)."""
        held = np.zeros((self.rod.vertices, len(UNKNOWNS)), dtype=np.bool_)
        for support in self.supports:
            for unknown in support.hold:
                held[self.index(support.at), UNKNOWNS.index(unknown)] = True
        return held

    def index(self, at: Vertex) -> int:
        """The index of a vertex that a load or a support names."""
        return {"first": 0, "last": self.rod.vertices - 1}[at] if isinstance(at, str) else at


def _overlap(geometry: Geometry, start: float, end: float) -> Array:
    """Length that each vertex's part shares with an interval, shape (N,) [m]."""
    arc = geometry.arc_length
    cuts = np.concatenate([arc[:1], (arc[1:] + arc[:-1]) / 2, arc[-1:]])
    shared: Array = np.maximum(0.0, np.minimum(cuts[1:], end) - np.maximum(cuts[:-1], start))
    return shared
