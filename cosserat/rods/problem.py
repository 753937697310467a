"""A rod with its supports and loads: what its problems at rest and in motion have in common, section 3.5."""

from __future__ import annotations

import numbers
from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import GetCoreSchemaHandler, model_validator
from pydantic_core import PydanticCustomError, core_schema

from cosserat.parameters import Parameters, Quantity
from cosserat.problem import Problem
from cosserat.rods.constraints import DisplacedDof, PrescribedMotion, RotatedDirector
from cosserat.rods.energies.reissner import ConsistentRod
from cosserat.rods.kinematics import DOFS, Geometry
from cosserat.rods.loaded_rod import LoadedRod
from cosserat.rods.rod import Rod, RodBody
from cosserat.solvers.banded import band_product

Array = NDArray[np.float64]
_DIRECTIONS = {"E3": (1.0, 0.0), "-E3": (-1.0, 0.0), "E2": (0.0, 1.0), "-E2": (0.0, -1.0)}


class VertexName:
    """Annotation: 'first', 'last' or an index."""

    @staticmethod
    def check(value: object) -> str | int:
        """Read one name of a vertex."""
        if isinstance(value, str) and value in ("first", "last"):
            return value
        if isinstance(value, bool) or not isinstance(value, numbers.Integral) or value < 0:
            raise PydanticCustomError(
                "type", f"is {value!r}; it must be 'first', 'last' or the index of a vertex"
            )
        return int(value)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)


Vertex = Annotated[str | int, VertexName()]
Direction = Literal["E3", "-E3", "E2", "-E2"]
DofName = Literal["x3", "x2", "d3", "d2"]


def unit_vector(direction: Direction) -> Array:
    """The unit vector of a named direction, shape (2,)."""
    return np.array(_DIRECTIONS[direction])


class Support(Parameters):
    """Numbers of one vertex that keep their reference value."""

    at: Vertex
    """The vertex that is held."""
    fixed: tuple[DofName, ...]
    """Degrees of freedom that keep their reference value: components of the position (x) and of the director (d)."""


class Gravity(Parameters):
    """The weight of the rod: its mass matrix times a uniform acceleration, which lumped is rho0 g L of section 3.5."""

    g: Annotated[float, Quantity("m/s^2", "g", "section 3.5")]
    """Acceleration of free fall."""
    along: Direction
    """Direction in which things fall."""


class PointForce(Parameters):
    """A dead force on the centreline at one vertex."""

    at: Vertex
    """The vertex that is pulled."""
    along: Direction
    """Direction of the force."""
    force: Annotated[float, Quantity("N", "n", "section 3.5")]
    """Size of the force; a negative one pulls the other way."""


class LineLoad(Parameters):
    """A dead force per length on the centreline, over a stretch of it."""

    along: Direction
    """Direction of the load."""
    density: Annotated[float, Quantity("N/m")]
    """Force per length of the reference centreline."""
    start: Annotated[float, Quantity("m", at_least=0)] = 0.0
    """Where the load begins, counted along the reference centreline."""
    end: Annotated[float, Quantity("m", above=0)] | None = None
    """Where the load ends; at the end of the rod, if not given."""


class Couple(Parameters):
    """A moment on one section, positive from E3 towards E2, that turns with it: it does the work of a couple."""

    at: Vertex
    """The vertex whose section is turned."""
    moment: Annotated[float, Quantity("N*m", r"\mathbf{M}", "3.3.41")]
    """Moment, positive from E3 towards E2."""


class PrescribedDisplacement(Parameters):
    """A held number that is moved: at rest to a new place, in motion there at once or to and fro.

    With a frequency f it stands at by sin(2 pi f t) from its reference value.
    """

    at: Vertex
    """The vertex that is moved."""
    dof: DofName
    """Which of its fixed degrees of freedom is moved."""
    by: Annotated[float, Quantity("m")]
    """How far it is moved from its reference value; to and fro, the amplitude."""
    frequency: Annotated[float, Quantity("Hz", at_least=0)] = 0.0
    """Frequency of moving to and fro; with zero it is moved once."""


class PrescribedRotation(Parameters):
    """A held section that is turned as it is, from E3 towards E2: at rest by an angle, in motion at once or to and fro.

    With a frequency f it has turned by sin(2 pi f t) times the angle.
    """

    at: Vertex
    """The vertex whose fixed section is turned."""
    by: Annotated[float, Quantity("rad")]
    """Angle from E3 towards E2; to and fro, the amplitude."""
    frequency: Annotated[float, Quantity("Hz", at_least=0)] = 0.0
    """Frequency of turning to and fro; with zero it is turned once."""


class RodProblem(Problem):
    """A rod, what holds it and what pulls it."""

    rod: Rod
    supports: tuple[Support, ...]
    """What holds the rod; empty for a free one, which only a motion may be."""
    gravity: Gravity | None = None
    forces: tuple[PointForce, ...] = ()
    """Dead forces, each at one vertex."""
    line_loads: tuple[LineLoad, ...] = ()
    """Dead forces per length, each over a stretch of the rod."""
    couples: tuple[Couple, ...] = ()
    """Moments, each on one section."""
    prescribed_displacements: tuple[PrescribedDisplacement, ...] = ()
    """Fixed degrees of freedom that are moved."""
    prescribed_rotations: tuple[PrescribedRotation, ...] = ()
    """Fixed sections that are turned."""

    @model_validator(mode="after")
    def _vertices_exist(self) -> Self:
        named = (
            self.supports,
            self.forces,
            self.couples,
            self.prescribed_displacements,
            self.prescribed_rotations,
        )
        for at in [item.at for items in named for item in items]:
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
        return self

    @model_validator(mode="after")
    def _what_is_moved_is_held(self) -> Self:
        moved: list[tuple[str, Vertex, tuple[DofName, ...]]] = [
            *(
                (f"'prescribed_displacements' moves {move.dof}", move.at, (move.dof,))
                for move in self.prescribed_displacements
            ),
            *(
                ("'prescribed_rotations' turns the section", turn.at, ("d3", "d2"))
                for turn in self.prescribed_rotations
            ),
        ]
        constrained, met = self.constrained(), set()
        for words, at, dofs in moved:
            for dof in dofs:
                number = self.index(at), DOFS.index(dof)
                if number in met:
                    raise PydanticCustomError(
                        "twice",
                        f"'prescribed_displacements' and 'prescribed_rotations' move {dof} of vertex {at} twice; "
                        "put both together",
                    )
                met.add(number)
                if not constrained[number]:
                    raise PydanticCustomError(
                        "support",
                        f"{words} of vertex {at}, which no support holds; "
                        f"add {dof} to 'fixed' of a support there",
                    )
        at_once = self.rod.calibration is not None or getattr(self, "kind", "") == "rod motion"
        for turn in self.prescribed_rotations:
            if at_once and not turn.frequency and abs(turn.by) > np.pi / 2:
                raise PydanticCustomError(
                    "range",
                    f"'prescribed_rotations' turns the section of vertex {turn.at} by {turn.by:.4g} rad at once; "
                    "only the consistent rod at rest turns by more than a quarter, in steps: take "
                    "that, or a smaller angle",
                )
        return self

    @property
    def swings(self) -> bool:
        """Whether a support is moved to and fro, which takes time."""
        prescribed: tuple[PrescribedDisplacement | PrescribedRotation, ...] = (
            *self.prescribed_displacements,
            *self.prescribed_rotations,
        )
        return any(item.frequency for item in prescribed)

    def loads(self, geometry: Geometry) -> Array:
        """Dead forces on the DOFs of each vertex, shape (N, 4) [N]."""
        load = np.zeros((self.rod.vertices, len(DOFS)))
        if self.gravity is not None:
            fall = np.zeros_like(load)
            fall[:, :2] = self.gravity.g * unit_vector(self.gravity.along)
            load += band_product(self.mass(geometry), fall.ravel()).reshape(load.shape)
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
        """The rod with all its loads, couples and moves growing together.

        The consistent rod counts displacements itself, whose rounding is far less than that of positions.
        """
        rod = self.rod.body(geometry)
        reference = np.hstack([geometry.X, geometry.D])
        base = reference.ravel()
        if isinstance(rod, ConsistentRod):
            rod, base = rod.displaced(geometry), np.zeros_like(base)
        dead, constrained = self.loads(geometry).ravel(), self.constrained().ravel()
        return LoadedRod(rod, base, self._moments(), dead, constrained, self.drive(geometry), reference)

    def _moments(self) -> Array:
        """Couple at each vertex, shape (N,) [N m]."""
        moments = np.zeros(self.rod.vertices)
        for item in self.couples:
            moments[self.index(item.at)] += item.moment
        return moments

    def mass(self, geometry: Geometry) -> Array:
        """Mass matrix as a symmetric band, eq. (3.3.43)."""
        return self.rod.mass(geometry)

    def drive(self, geometry: Geometry) -> PrescribedMotion:
        """How prescribed DOFs are moved."""
        shifts = [
            DisplacedDof(self.index(m.at) * len(DOFS) + DOFS.index(m.dof), m.by, m.frequency)
            for m in self.prescribed_displacements
        ]
        turned = [
            RotatedDirector(
                self.index(t.at) * len(DOFS) + 2, geometry.D[self.index(t.at)], t.by, t.frequency
            )
            for t in self.prescribed_rotations
        ]
        return PrescribedMotion(self.rod.vertices * len(DOFS), (*shifts, *turned))

    def constrained(self) -> NDArray[np.bool_]:
        """Which DOFs of each vertex keep their value, shape (N, 4)."""
        constrained = np.zeros((self.rod.vertices, len(DOFS)), dtype=np.bool_)
        for support in self.supports:
            for dof in support.fixed:
                constrained[self.index(support.at), DOFS.index(dof)] = True
        return constrained

    def index(self, at: Vertex) -> int:
        """The index of a vertex that a load or a support names."""
        return {"first": 0, "last": self.rod.vertices - 1}[at] if isinstance(at, str) else at


def _overlap(geometry: Geometry, start: float, end: float) -> Array:
    """Length that each vertex's part shares with an interval, shape (N,) [m]."""
    arc = geometry.arc_length
    cuts = np.concatenate([arc[:1], (arc[1:] + arc[:-1]) / 2, arc[-1:]])
    shared: Array = np.maximum(0.0, np.minimum(cuts[1:], end) - np.maximum(cuts[:-1], start))
    return shared
