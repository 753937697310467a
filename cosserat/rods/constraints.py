"""Held numbers that are moved: to a new place with the load, or to and fro in time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class DisplacedDof:
    """One number, moved by an amount [m], to and fro if it has a frequency [Hz]."""

    index: int
    by: float
    frequency: float

    def place(self, share: float) -> tuple[Array, Array, Array]:
        """Displacement at a share of the whole, and two derivatives by the share, each of shape (1,)."""
        return np.array([share * self.by]), np.array([self.by]), np.zeros(1)


@dataclass(frozen=True)
class RotatedDirector:
    """A director D (2,), the numbers from `index` on, turned by an angle [rad] as it is."""

    index: int
    D: Array
    by: float
    frequency: float

    def place(self, share: float) -> tuple[Array, Array, Array]:
        """Displacement at a share of the whole, and two derivatives by the share, each of shape (2,)."""
        c, s = np.cos(share * self.by), np.sin(share * self.by)
        d = np.array([c * self.D[0] - s * self.D[1], s * self.D[0] + c * self.D[1]])
        return d - self.D, self.by * np.array([-d[1], d[0]]), -(self.by**2) * d


@dataclass(frozen=True)
class PrescribedMotion:
    """Everything that is moved, among n numbers."""

    n: int
    parts: tuple[DisplacedDof | RotatedDirector, ...]

    def __call__(self, time: float) -> tuple[Array, Array, Array]:
        """Displacement, velocity and acceleration at a time, each (n,): by sin(2 pi f t), or by all from the start."""
        motion = np.zeros((3, self.n))
        for part in self.parts:
            omega = 2 * np.pi * part.frequency
            share = np.sin(omega * time) if omega else 1.0
            rate = omega * np.cos(omega * time)
            at, slope, bend = part.place(share)
            where = slice(part.index, part.index + at.size)
            motion[:, where] = at, slope * rate, bend * rate**2 - slope * omega**2 * share
        return motion[0], motion[1], motion[2]

    def at_load(self, factor: float) -> tuple[Array, Array]:
        """Displacement at a factor of the load, and its derivative by the factor, each of shape (n,)."""
        place, slope = np.zeros(self.n), np.zeros(self.n)
        for part in self.parts:
            at, change, _ = part.place(factor)
            where = slice(part.index, part.index + at.size)
            place[where], slope[where] = at, change
        return place, slope

    @property
    def largest_turn(self) -> float:
        """Largest angle that a section is turned by [rad]."""
        return max(
            (abs(part.by) for part in self.parts if isinstance(part, RotatedDirector)), default=0.0
        )
