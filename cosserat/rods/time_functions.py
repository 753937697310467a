"""Functions of time for loads and supports: ramp, sine, pulse, half-sine, chirp, and a table such as a record."""

from __future__ import annotations

from abc import abstractmethod
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, Strict

from cosserat.parameters import Parameters, Quantity
from cosserat.rods.quadrature import gauss
from cosserat.tables import Columns, Rows

Array = NDArray[np.float64]
_FASTEST_CHANGE = np.pi / 2
"""A rise over a time T is as fast as a sine of the angular frequency pi / 2 T."""


class TimeFunction(Parameters):
    """A factor that depends on time; it multiplies a load or a prescribed motion."""

    @abstractmethod
    def derivatives(self, t: Array) -> tuple[Array, Array, Array]:
        """The factor and its first two derivatives at times (n,) [s]; one-sided at a jump."""

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times at which it is not smooth [s]."""
        return ()

    @property
    def fastest(self) -> float:
        """Angular frequency of its fastest change [rad/s]; a jump counts as none."""
        return 0.0

    def value(self, t: Array) -> Array:
        """The factor at times (n,) [s]."""
        return self.derivatives(t)[0]

    @property
    def before_zero(self) -> float:
        """The factor just before time zero: that of a function which begins there is zero, a table has its own."""
        return float(self.value(np.array([-np.finfo(float).tiny]))[0])

    def means(self, times: Array) -> Array:
        """Means of the factor between neighbouring times, (n,) [s] -> (n - 1,).

        Gauss's rule with eight points on each smooth piece.  So a jump inside a step has its exact impulse.
        """
        inside = [b for b in self.breaks if times[0] < b < times[-1]]
        cuts = np.unique(np.concatenate([times, inside]))
        nodes, weights = gauss(cuts)
        integrals = (self.value(nodes.ravel()).reshape(nodes.shape) * weights).sum(axis=1)
        owner = np.clip(np.searchsorted(times, cuts[:-1], side="right") - 1, 0, times.size - 2)
        first = np.searchsorted(owner, np.arange(times.size - 1))
        result: Array = np.add.reduceat(integrals, first) / np.diff(times)
        return result


class Window(TimeFunction):
    """A function with a start and a duration."""

    start: Annotated[float, Quantity("s", at_least=0)] = 0.0
    """Time at which it begins; it is zero before."""
    duration: Annotated[float, Quantity("s", above=0)]
    """Time from its beginning to its end."""

    @property
    def breaks(self) -> tuple[float, ...]:
        """Its ends."""
        return self.start, self.start + self.duration

    def _inside(self, t: Array) -> Array:
        return np.asarray((t >= self.start) & (t < self.start + self.duration), dtype=float)


class Ramp(Window):
    """A rise from 0 to 1 that then stays."""

    kind: Literal["ramp"] = "ramp"
    smooth: Annotated[bool, Strict()] = False
    """Whether velocity and acceleration begin and end at zero: 10 s^3 - 15 s^4 + 6 s^5; if not, the rise is linear."""

    def derivatives(self, t: Array) -> tuple[Array, Array, Array]:
        """A straight line or a polynomial of degree five."""
        s, inside = np.clip((t - self.start) / self.duration, 0, 1), self._inside(t)
        if not self.smooth:
            return s, inside / self.duration, np.zeros_like(s)
        value = s**3 * (10 - 15 * s + 6 * s**2)
        rate, second = 30 * s**2 * (1 - s) ** 2, 60 * s * (1 - s) * (1 - 2 * s)
        return value, rate / self.duration, second / self.duration**2

    @property
    def fastest(self) -> float:
        """That of its rise."""
        return _FASTEST_CHANGE / self.duration


class Sine(TimeFunction):
    """A sine, sin(2 pi f (t - start) + phase)."""

    kind: Literal["sine"] = "sine"
    frequency: Annotated[float, Quantity("Hz", "f", above=0)]
    """Frequency f."""
    phase: Annotated[float, Quantity("rad")] = 0.0
    """Phase at the start; "90 deg" makes a cosine."""
    start: Annotated[float, Quantity("s", at_least=0)] = 0.0
    """Time at which it begins; it is zero before."""

    @property
    def breaks(self) -> tuple[float, ...]:
        """Its beginning."""
        return (self.start,)

    @property
    def fastest(self) -> float:
        """2 pi f."""
        return 2 * np.pi * self.frequency

    def derivatives(self, t: Array) -> tuple[Array, Array, Array]:
        """Sine and cosine."""
        omega, begun = self.fastest, np.asarray(t >= self.start, dtype=float)
        angle = omega * (t - self.start) + self.phase
        value = begun * np.sin(angle)
        return value, begun * omega * np.cos(angle), -(omega**2) * value


class Pulse(Window):
    """The factor 1 for a duration, zero before and after."""

    kind: Literal["pulse"] = "pulse"

    def derivatives(self, t: Array) -> tuple[Array, Array, Array]:
        """A constant."""
        return self._inside(t), np.zeros_like(t), np.zeros_like(t)


class HalfSine(Window):
    """Half a period of a sine, a shock; zero before and after."""

    kind: Literal["half-sine"] = "half-sine"

    @property
    def fastest(self) -> float:
        """Pi over the duration."""
        return np.pi / self.duration

    def derivatives(self, t: Array) -> tuple[Array, Array, Array]:
        """Sine and cosine."""
        omega, inside = self.fastest, self._inside(t)
        value = inside * np.sin(omega * (t - self.start))
        return value, inside * omega * np.cos(omega * (t - self.start)), -(omega**2) * value


class Chirp(Window):
    """A sine whose frequency changes linearly with time; zero before and after."""

    kind: Literal["chirp"] = "chirp"
    first_frequency: Annotated[float, Quantity("Hz", at_least=0)]
    """Frequency at its beginning."""
    last_frequency: Annotated[float, Quantity("Hz", at_least=0)]
    """Frequency at its end."""

    @property
    def fastest(self) -> float:
        """2 pi times the higher frequency."""
        return 2 * np.pi * max(self.first_frequency, self.last_frequency)

    def derivatives(self, t: Array) -> tuple[Array, Array, Array]:
        """Sine and cosine of a phase that is quadratic in time."""
        s, inside = t - self.start, self._inside(t)
        sweep = 2 * np.pi * (self.last_frequency - self.first_frequency) / self.duration
        omega = 2 * np.pi * self.first_frequency + sweep * s
        angle = 2 * np.pi * self.first_frequency * s + sweep * s**2 / 2
        sine, cosine = inside * np.sin(angle), inside * np.cos(angle)
        return sine, omega * cosine, sweep * cosine - omega**2 * sine


class Table(TimeFunction):
    """A table of factors over time, such as a record; beyond its ends it keeps its first and last value."""

    kind: Literal["table"] = "table"
    rows: Annotated[Rows, Columns((("time", "s"), ("value", "1")))]
    """Times and factors."""
    interpolation: Literal["linear", "spline"] = "linear"
    """Between the rows: straight lines, or a cubic spline, which a support needs to have an acceleration."""

    @property
    def breaks(self) -> tuple[float, ...]:
        """Its times."""
        return tuple(time for time, _ in self.rows)

    @property
    def fastest(self) -> float:
        """That of a rise between its closest rows."""
        return _FASTEST_CHANGE / float(np.diff(self.breaks).min())

    def derivatives(self, t: Array) -> tuple[Array, Array, Array]:
        """Piecewise polynomials."""
        from scipy.interpolate import CubicSpline  # 0.1 s: only where it is used

        times, values = np.array(self.rows).T
        if self.interpolation == "spline":
            spline = CubicSpline(times, values)
            s = np.clip(t, times[0], times[-1])
            inside = np.asarray(t == s, dtype=float)
            return spline(s), inside * spline(s, 1), inside * spline(s, 2)
        piece = np.clip(np.searchsorted(times, t, side="right") - 1, 0, times.size - 2)
        inside = np.asarray((t >= times[0]) & (t < times[-1]), dtype=float)
        slope = inside * (np.diff(values) / np.diff(times))[piece]
        return np.interp(t, times, values), slope, np.zeros_like(slope)


AnyTimeFunction = Annotated[Ramp | Sine | Pulse | HalfSine | Chirp | Table, Field(discriminator="kind")]
"""Every kind of a function of time."""
