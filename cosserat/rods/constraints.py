"""Constrained degrees of freedom (DOFs): fixed, moved with the load, or moved by a function of time."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import Annotated, Protocol

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from cosserat.parameters import Parameters, Quantity
from cosserat.rods.naming import DofName
from cosserat.rods.places import Place, vertex_at
from cosserat.rods.reference import Geometry
from cosserat.rods.rod import Rod
from cosserat.rods.time_functions import AnyTimeFunction, TimeFunction
from cosserat.solvers.banded import Mask

Array = NDArray[np.float64]
_AXES = {"3": np.array([1.0, 0.0]), "2": np.array([0.0, 1.0])}
_MAX_ROTATION = 1.0  # of a section in one load increment [rad]; unwrapping needs less than pi


class PrescribedPart(Protocol):
    """Prescribed motion of neighbouring DOFs."""

    @property
    def index(self) -> int:
        """First of its DOFs."""

    @property
    def time_function(self) -> TimeFunction | None:
        """The fraction of the full motion over time; None for a single move."""

    @property
    def rotation(self) -> float:
        """Largest angle by which it rotates a section [rad]."""

    def times(self, factor: float) -> PrescribedPart:
        """A part of the motion, or more of it, that does not depend on time."""

    def place(self, fraction: float) -> tuple[Array, Array, Array]:
        """Displacement at a fraction of the full motion, and two derivatives by it, each (number of DOFs,)."""


@dataclass(frozen=True)
class DisplacedDof:
    """One DOF, moved by an amount [m]."""

    index: int
    by: float
    time_function: TimeFunction | None = None
    rotation: float = 0.0

    def times(self, factor: float) -> DisplacedDof:
        """Proportional displacement."""
        return replace(self, by=factor * self.by, time_function=None)

    def place(self, fraction: float) -> tuple[Array, Array, Array]:
        """Proportional displacement."""
        return np.array([fraction * self.by]), np.array([self.by]), np.zeros(1)


@dataclass(frozen=True)
class RotatedDirector:
    """A director D (2,), the two DOFs at `index`, rotated by an angle [rad] without stretch."""

    index: int
    D: Array
    by: float
    time_function: TimeFunction | None = None

    @property
    def rotation(self) -> float:
        """The angle [rad]."""
        return abs(self.by)

    def times(self, factor: float) -> RotatedDirector:
        """A rotation by the angle times the factor."""
        return replace(self, by=factor * self.by, time_function=None)

    def place(self, fraction: float) -> tuple[Array, Array, Array]:
        """Displacement along a circle."""
        c, s = np.cos(fraction * self.by), np.sin(fraction * self.by)
        d = np.array([c * self.D[0] - s * self.D[1], s * self.D[0] + c * self.D[1]])
        return d - self.D, self.by * np.array([-d[1], d[0]]), -(self.by**2) * d


@dataclass(frozen=True)
class RodConstraints:
    """Mask of the constrained DOFs of a rod, shape (n,), and the prescribed motions."""

    mask: Mask
    parts: tuple[PrescribedPart, ...]

    @property
    def moving(self) -> bool:
        """Whether some constrained DOFs move."""
        return bool(self.parts)

    @property
    def max_increment(self) -> float:
        """Largest change of the load factor in one increment: no section rotates by more than a radian."""
        rotation = max((part.rotation for part in self.parts), default=0.0)
        return _MAX_ROTATION / rotation if rotation else np.inf

    def at_time(self, time: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity and acceleration at a time [s], each (n,).

        The full motion times the function of time; without one, the full motion from the start.
        """
        motion = np.zeros((3, self.mask.size))
        for part in self.parts:
            fraction, rate, second = 1.0, 0.0, 0.0
            if part.time_function is not None:
                given = part.time_function.derivatives(np.array([time]))
                fraction, rate, second = (float(values[0]) for values in given)
            at, slope, bend = part.place(fraction)
            where = slice(part.index, part.index + at.size)
            motion[:, where] = at, slope * rate, bend * rate**2 + slope * second
        return motion[0], motion[1], motion[2]

    def at_load(self, factor: float) -> tuple[Array, Array]:
        """Displacement at a load factor, and its derivative by the factor, each (n,)."""
        place, slope = np.zeros(self.mask.size), np.zeros(self.mask.size)
        for part in self.parts:
            at, change, _ = part.place(factor)
            where = slice(part.index, part.index + at.size)
            place[where], slope[where] = at, change
        return place, slope


@dataclass(frozen=True)
class MovedOn(RodConstraints):
    """Constraints that move the DOFs from where they are, (n,), as a load grows."""

    begin: Array

    def at_load(self, factor: float) -> tuple[Array, Array]:
        """Displacement at a load factor, and its derivative by the factor, each (n,)."""
        place, slope = super().at_load(factor)
        return place + np.where(self.mask, self.begin, 0.0), slope


class Constraint(Parameters):
    """A constraint at one vertex of a case."""

    at: Place
    """The place that is constrained; the rod has a vertex there."""

    @property
    def label(self) -> str:
        """What it is called in the result."""
        return str(self.at)

    @property
    def fixes(self) -> tuple[DofName, ...]:
        """The DOFs of the vertex that it fixes."""
        return ()

    def holds(self, D: Array) -> list[tuple[str, Array]]:
        """The components that it holds, a vector ("x" or "d") and a direction (2,) each; D : director (2,) [m]."""
        return [(dof[0], _AXES[dof[1]]) for dof in self.fixes]

    @property
    def moves(self) -> tuple[DofName, ...]:
        """The DOFs of the vertex that it moves; another constraint must fix them."""
        return ()

    @property
    def action(self) -> str:
        """What it does, as words after its key."""
        return ""

    def check(self, *, large_rotations: bool) -> None:
        """Raise PydanticCustomError if the rod cannot follow; large_rotations : beyond a quarter turn it can."""

    @abstractmethod
    def part(self, rod: Rod, geometry: Geometry) -> PrescribedPart | None:
        """The prescribed motion; None if it moves nothing."""


class PrescribedDisplacement(Constraint):
    """Prescribed displacement of a fixed DOF.  Static: applied with the load.  Dynamic: at once, or over time."""

    dof: DofName
    """The fixed degree of freedom that is moved."""
    by: Annotated[float, Quantity("m")]
    """Displacement from its reference value."""
    time_function: AnyTimeFunction | None = None
    """Fraction of the displacement over time, of a motion only; without one, the DOF moves at the start."""

    @property
    def moves(self) -> tuple[DofName, ...]:
        """Its DOF."""
        return (self.dof,)

    @property
    def action(self) -> str:
        """What it does."""
        return f"moves {self.dof}"

    def part(self, rod: Rod, geometry: Geometry) -> PrescribedPart:
        """The proportional motion of its DOF."""
        return DisplacedDof(rod.dof(self.at, self.dof, geometry.arc_length), self.by, self.time_function)


class PrescribedRotation(Constraint):
    """Prescribed rotation of a fixed section, positive from E3 towards E2.

    Static: applied with the load.  Dynamic: at once, or over time.
    """

    by: Annotated[float, Quantity("rad", at_least=-1e3, at_most=1e3)]
    """Angle from E3 towards E2."""
    time_function: AnyTimeFunction | None = None
    """Fraction of the angle over time, of a motion only; without one, the section rotates at the start."""

    @property
    def moves(self) -> tuple[DofName, ...]:
        """Both components of the director."""
        return ("d3", "d2")

    @property
    def action(self) -> str:
        """What it does."""
        return "rotates the section"

    def check(self, *, large_rotations: bool) -> None:
        """Sections rotate by more than a quarter turn only in increments."""
        if not large_rotations and not self.time_function and abs(self.by) > np.pi / 2:
            raise PydanticCustomError(
                "range",
                f"'prescribed_rotations' rotates the section of vertex {self.at} by {self.by:.4g} rad at once; only "
                "the consistent rod at rest rotates it by more than a quarter turn, in increments: take that, or a "
                "smaller angle",
            )

    def part(self, rod: Rod, geometry: Geometry) -> PrescribedPart:
        """The motion of its director along a circle."""
        D = geometry.D[vertex_at(self.at, geometry.arc_length)]
        return RotatedDirector(
            rod.dof(self.at, "d3", geometry.arc_length), D, self.by, self.time_function
        )
