"""Held numbers that are moved: to a new place with the load, or to and fro in time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Shift:
    """One number, moved by an amount [m], to and fro if it has a frequency [Hz]."""

    index: int
    by: float
    frequency: float

    def place(self, share: float) -> tuple[Array, Array]:
        """Displacement at a share of the whole, and its derivative by the share, each of shape (1,)."""
        return np.array([share * self.by]), np.array([self.by])


@dataclass(frozen=True)
class Turned:
    """A director D (2,), the numbers from `index` on, turned by an angle [rad] as it is."""

    index: int
    D: Array
    by: float
    frequency: float

    def place(self, share: float) -> tuple[Array, Array]:
        """Displacement at a share of the whole, and its derivative by the share, each of shape (2,)."""
        c, s = np.cos(share * self.by), np.sin(share * self.by)
        d = np.array([c * self.D[0] - s * self.D[1], s * self.D[0] + c * self.D[1]])
        return d - self.D, self.by * np.array([-d[1], d[0]])


@dataclass(frozen=True)
class Drive:
    """Everything that is moved, among n numbers."""

    n: int
    parts: tuple[Shift | Turned, ...]

    def __call__(self, time: float) -> tuple[Array, Array]:
        """Displacement and velocity at a time, each of shape (n,): by sin(2 pi f t), or by all of it from the start."""
        place, rate = np.zeros(self.n), np.zeros(self.n)
        for part in self.parts:
            omega = 2 * np.pi * part.frequency
            at, slope = part.place(np.sin(omega * time) if omega else 1.0)
            where = slice(part.index, part.index + at.size)
            place[where], rate[where] = at, slope * omega * np.cos(omega * time)
        return place, rate

    def grown(self, factor: float) -> tuple[Array, Array]:
        """Displacement at a factor of the load, and its derivative by the factor, each of shape (n,)."""
        place, slope = np.zeros(self.n), np.zeros(self.n)
        for part in self.parts:
            at, change = part.place(factor)
            where = slice(part.index, part.index + at.size)
            place[where], slope[where] = at, change
        return place, slope
