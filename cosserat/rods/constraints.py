"""Constrained degrees of freedom (DOFs): fixed, or prescribed to move with the load or to and fro in time."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Annotated, Protocol

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from cosserat.parameters import Parameters, Quantity
from cosserat.rods.naming import DofName, Vertex
from cosserat.rods.reference import Geometry
from cosserat.rods.rod import Rod
from cosserat.solvers.banded import Mask

Array = NDArray[np.float64]
_MAX_ROTATION = (
    1.0  # of a section in one load increment [rad]: angles are unwrapped, so less than half a turn
)


class PrescribedPart(Protocol):
    """Neighbouring DOFs, prescribed together."""

    @property
    def index(self) -> int:
        """The first of its DOFs."""

    @property
    def frequency(self) -> float:
        """Of moving to and fro [Hz]; zero where it moves once."""

    @property
    def rotation(self) -> float:
        """Largest angle by which it rotates a section [rad]."""

    def place(self, fraction: float) -> tuple[Array, Array, Array]:
        """Displacement at a fraction of the whole, and two derivatives by the fraction, each (number of DOFs,)."""


@dataclass(frozen=True)
class DisplacedDof:
    """One DOF, moved by an amount [m], to and fro if it has a frequency [Hz]."""

    index: int
    by: float
    frequency: float
    rotation: float = 0.0

    def place(self, fraction: float) -> tuple[Array, Array, Array]:
        """In proportion."""
        return np.array([fraction * self.by]), np.array([self.by]), np.zeros(1)


@dataclass(frozen=True)
class RotatedDirector:
    """A director D (2,), the DOFs from `index` on, rotated by an angle [rad] as it is."""

    index: int
    D: Array
    by: float
    frequency: float

    @property
    def rotation(self) -> float:
        """The angle [rad]."""
        return abs(self.by)

    def place(self, fraction: float) -> tuple[Array, Array, Array]:
        """Along a circle."""
        c, s = np.cos(fraction * self.by), np.sin(fraction * self.by)
        d = np.array([c * self.D[0] - s * self.D[1], s * self.D[0] + c * self.D[1]])
        return d - self.D, self.by * np.array([-d[1], d[0]]), -(self.by**2) * d


@dataclass(frozen=True)
class RodConstraints:
    """Which DOFs of a rod are constrained, shape (n,), and those that are prescribed."""

    mask: Mask
    parts: tuple[PrescribedPart, ...]

    @property
    def moving(self) -> bool:
        """Whether some constrained DOFs do not keep their reference value."""
        return bool(self.parts)

    @property
    def max_increment(self) -> float:
        """Largest change of the load factor in one increment: no section rotates by more than a radian."""
        rotation = max((part.rotation for part in self.parts), default=0.0)
        return _MAX_ROTATION / rotation if rotation else np.inf

    def at_time(self, time: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity and acceleration at a time [s], each (n,).

        By sin(2 pi f t) of the whole; without a frequency by the whole from the start.
        """
        motion = np.zeros((3, self.mask.size))
        for part in self.parts:
            omega = 2 * np.pi * part.frequency
            fraction = np.sin(omega * time) if omega else 1.0
            rate = omega * np.cos(omega * time)
            at, slope, bend = part.place(fraction)
            where = slice(part.index, part.index + at.size)
            motion[:, where] = at, slope * rate, bend * rate**2 - slope * omega**2 * fraction
        return motion[0], motion[1], motion[2]

    def at_load(self, factor: float) -> tuple[Array, Array]:
        """Displacement at a load factor, and its derivative by the factor, each (n,)."""
        place, slope = np.zeros(self.mask.size), np.zeros(self.mask.size)
        for part in self.parts:
            at, change, _ = part.place(factor)
            where = slice(part.index, part.index + at.size)
            place[where], slope[where] = at, change
        return place, slope


class Constraint(Parameters):
    """A constraint at one vertex, as a case says it."""

    at: Vertex
    """The vertex that is constrained."""

    @property
    def fixes(self) -> tuple[DofName, ...]:
        """The DOFs of the vertex that it constrains."""
        return ()

    @property
    def moves(self) -> tuple[DofName, ...]:
        """The DOFs of the vertex that it moves; another constraint has to fix them."""
        return ()

    @property
    def action(self) -> str:
        """What it does, in words that follow its key."""
        return ""

    def check(self, *, far: bool) -> None:
        """Raise PydanticCustomError where it asks for more than a rod can follow; far : sections may rotate far."""

    @abstractmethod
    def part(self, rod: Rod, geometry: Geometry) -> PrescribedPart | None:
        """What is prescribed; None if it moves nothing."""


class Support(Constraint):
    """Numbers of one vertex that keep their reference value."""

    fixed: tuple[DofName, ...]
    """Degrees of freedom that keep their reference value: components of the position (x) and of the director (d)."""

    @property
    def fixes(self) -> tuple[DofName, ...]:
        """The fixed DOFs."""
        return self.fixed

    def part(self, rod: Rod, geometry: Geometry) -> None:
        """Nothing moves."""


class PrescribedDisplacement(Constraint):
    """A fixed number that is moved: at rest to a new place, in motion there at once or to and fro.

    With a frequency f it stands at by sin(2 pi f t) from its reference value.
    """

    dof: DofName
    """Which of its fixed degrees of freedom is moved."""
    by: Annotated[float, Quantity("m")]
    """How far it is moved from its reference value; to and fro, the amplitude."""
    frequency: Annotated[float, Quantity("Hz", at_least=0)] = 0.0
    """Frequency of moving to and fro; with zero it is moved once."""

    @property
    def moves(self) -> tuple[DofName, ...]:
        """Its DOF."""
        return (self.dof,)

    @property
    def action(self) -> str:
        """What it does."""
        return f"moves {self.dof}"

    def part(self, rod: Rod, geometry: Geometry) -> PrescribedPart:
        """Its DOF, in proportion."""
        return DisplacedDof(rod.dof(self.at, self.dof), self.by, self.frequency)


class PrescribedRotation(Constraint):
    """A fixed section that is rotated, from E3 towards E2: at rest by an angle, in motion at once or to and fro.

    With a frequency f it has rotated by sin(2 pi f t) times the angle.
    """

    by: Annotated[float, Quantity("rad")]
    """Angle from E3 towards E2; to and fro, the amplitude."""
    frequency: Annotated[float, Quantity("Hz", at_least=0)] = 0.0
    """Frequency of turning to and fro; with zero it is turned once."""

    @property
    def moves(self) -> tuple[DofName, ...]:
        """Both components of the director."""
        return ("d3", "d2")

    @property
    def action(self) -> str:
        """What it does."""
        return "turns the section"

    def check(self, *, far: bool) -> None:
        """Sections rotate by more than a quarter turn only in increments."""
        if not far and not self.frequency and abs(self.by) > np.pi / 2:
            raise PydanticCustomError(
                "range",
                f"'prescribed_rotations' turns the section of vertex {self.at} by {self.by:.4g} rad at once; "
                "only the consistent rod at rest turns by more than a quarter, in steps: take "
                "that, or a smaller angle",
            )

    def part(self, rod: Rod, geometry: Geometry) -> PrescribedPart:
        """Its director, along a circle."""
        D = geometry.D[rod.index(self.at)]
        return RotatedDirector(rod.dof(self.at, "d3"), D, self.by, self.frequency)
