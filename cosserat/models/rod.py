"""A straight rod with its supports and loads: what its problems at rest and in motion have in common, section 3.5."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import GetCoreSchemaHandler, model_validator
from pydantic_core import PydanticCustomError, core_schema

from cosserat.models.planar_rod import UNKNOWNS, Geometry, Lumped
from cosserat.models.published import (
    Calibration,
    EndSections,
    PoissonCoupling,
    PublishedRod,
    stiffnesses,
)
from cosserat.parameters import Count, Parameters, Quantity

Array = NDArray[np.float64]
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
    """A straight homogeneous rod of rectangular section, section 3.5."""

    energy: Literal["published"] = "published"
    vertices: Annotated[int, Count("N", "3.3.1", at_least=3)]
    length: Annotated[float, Quantity("m", r"\ell_0", "3.3.1", above=0)]
    height: Annotated[float, Quantity("m", "H", "section 3.5", above=0)]
    width: Annotated[float, Quantity("m", "W", "section 3.5", above=0)]
    young: Annotated[float, Quantity("Pa", "E", "section 3.5", above=0)]
    poisson: Annotated[float, Quantity("1", r"\nu", "section 3.5", above=-1, below=0.5)]
    line_density: Annotated[float, Quantity("kg/m", r"\rho_0", "section 3.5", above=0)]
    shear_correction: Annotated[float, Quantity("1", "k", "3.4.13", above=0)]
    calibration: Calibration
    end_sections: EndSections = "full"
    poisson_coupling: PoissonCoupling = "halved"

    @property
    def area(self) -> float:
        """Area of the section A [m^2]."""
        return self.width * self.height

    @property
    def second_moment(self) -> float:
        """Second moment of area about E1, I [m^4]."""
        return self.width * self.height**3 / 12

    @property
    def first_inertia(self) -> float:
        """Y02 of eq. (3.3.28): zero, for a centreline half-way up the section [1]."""
        return 0.0

    @property
    def second_inertia(self) -> float:
        """Y22 of eq. (3.3.28) for a centreline half-way up: mean of (y / (H/2))^2 over the section [1]."""
        return 1 / 3

    def geometry(self) -> Geometry:
        """Its reference configuration; the directors reach the lateral surface, at half the height."""
        return Geometry.straight(self.vertices, self.length, self.height / 2)

    def body(self, geometry: Geometry) -> PublishedRod:
        """The elastic body: eq. (3.4.13) with Table 3.1 for a homogeneous rod."""
        vertex, edge = (
            Lumped.uniform(
                count,
                area=self.area,
                second_moment=self.second_moment,
                young=self.young,
                poisson=self.poisson,
            )
            for count in (self.vertices, self.vertices - 1)
        )
        return PublishedRod(
            stiffnesses(
                geometry,
                vertex,
                edge,
                self.shear_correction,
                self.calibration,
                self.end_sections,
                self.poisson_coupling,
            )
        )


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


class RodProblem(Parameters):
    """A rod, what holds it and what pulls it."""

    rod: Rod
    supports: tuple[Support, ...]
    gravity: Gravity | None = None
    forces: tuple[PointForce, ...] = ()

    @model_validator(mode="after")
    def _vertices_exist(self) -> Self:
        for at in [item.at for item in self.supports] + [item.at for item in self.forces]:
            if isinstance(at, int) and at >= self.rod.vertices:
                raise PydanticCustomError(
                    "range",
                    f"'at' is {at}, but the rod's vertices are 0 to {self.rod.vertices - 1}; "
                    "choose one of those, 'first' or 'last'",
                )
        return self

    def loads(self, geometry: Geometry) -> Array:
        """Dead forces on the unknowns of each vertex, shape (N, 4) [N]."""
        load = np.zeros((self.rod.vertices, len(UNKNOWNS)))
        if self.gravity is not None:
            weight = self.rod.line_density * self.gravity.g * geometry.voronoi_length
            load[:, :2] += weight[:, None] * unit_vector(self.gravity.along)
        for item in self.forces:
            load[self._index(item.at), :2] += item.force * unit_vector(item.along)
        return load

    def held(self) -> NDArray[np.bool_]:
        """Which unknowns of each vertex keep their value, shape (N, 4)."""
        held = np.zeros((self.rod.vertices, len(UNKNOWNS)), dtype=np.bool_)
        for support in self.supports:
            for unknown in support.hold:
                held[self._index(support.at), UNKNOWNS.index(unknown)] = True
        return held

    def _index(self, at: Vertex) -> int:
        return {"first": 0, "last": self.rod.vertices - 1}[at] if isinstance(at, str) else at
