"""Kinds of damping of a motion.  Every ratio is a fraction of the critical damping of a mode of the unloaded rod about
its reference configuration, in which it deforms.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from cosserat.errors import InputError
from cosserat.parameters import Count, Parameters, Quantity
from cosserat.solvers.damping import DampedModes, rayleigh
from cosserat.solvers.modes import Modes, first_elastic_frequency, modes
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]
Ratio = Annotated[float, Quantity("1", r"\zeta", at_least=0)]
STATED = 4
"""Number of lowest modes whose damping a Dataset states, or more if more are damped by name."""
_RIGID = 3  # free motions of a planar rod, at most


@dataclass(frozen=True)
class Vibrations:
    """Small motions of a body about its reference configuration; supported : no rigid motion is free."""

    body: MechanicalSystem
    supported: bool

    def first(self) -> float:
        """The lowest angular frequency at which it deforms [rad/s]."""
        return first_elastic_frequency(self.body, self.body.space.reference, supported=self.supported)

    def lowest(self, count: int) -> Modes:
        """The lowest modes in which it deforms, as many as there are up to a count.

        Raises
        ------
        UnstableError : small motions grow.
        """
        asked = count + (0 if self.supported else _RIGID)
        found = modes(self.body, self.body.space.reference, asked, "the rod", supported=self.supported)
        deforming = np.flatnonzero(found.angular_frequency)[:count]
        return Modes(found.angular_frequency[deforming], found.shape[deforming])


class Damping(Parameters):
    """A damping of one kind."""

    @abstractmethod
    def damped(self, system: MechanicalSystem, vibrations: Vibrations) -> MechanicalSystem:
        """The system with this damping."""

    def followed(self, vibrations: Vibrations) -> tuple[float, ...]:
        """Angular frequencies of the modes whose damping it states [rad/s]."""
        return ()


def _either(what: str, **named: object) -> None:
    """Raise PydanticCustomError unless just one of two keys is given."""
    given = [key for key, value in named.items() if value is not None]
    if len(given) != 1:
        keys = " or ".join(f"'{key}'" for key in named)
        raise PydanticCustomError(
            "either",
            f"has {' and '.join(map(repr, given)) or 'no ' + what}; give {keys}, just one of them",
        )


class MassDamping(Damping):
    """Damping in proportion to mass: all modes lose energy at the same rate, and rigid motions too."""

    kind: Literal["mass"] = "mass"
    ratio: Annotated[float, Quantity("1", r"\zeta", "section 3.5", at_least=0)] | None = None
    """Fraction of the critical damping of the lowest mode."""
    rate: Annotated[float, Quantity("1/s", "c", at_least=0)] | None = None
    """Rate c of the force -c M v, at which energy falls."""

    @model_validator(mode="after")
    def _one(self) -> Self:
        _either("size", ratio=self.ratio, rate=self.rate)
        return self

    def damped(self, system: MechanicalSystem, vibrations: Vibrations) -> MechanicalSystem:
        """ASSUME a force -2 zeta omega_1 M v, where the page of the thesis names none."""
        if self.rate is not None:
            return replace(system, damping_rate=self.rate)
        if not self.ratio:
            return system
        return replace(system, damping_rate=2 * self.ratio * vibrations.first())


class RayleighDamping(Damping):
    """Damping in proportion to mass and to stiffness, from the ratios of two modes."""

    kind: Literal["rayleigh"] = "rayleigh"
    ratios: tuple[Ratio, ...]
    """Two fractions of critical damping."""
    frequencies: tuple[Annotated[float, Quantity("Hz", above=0)], ...] | None = None
    """The two frequencies at which they hold."""
    modes: tuple[Annotated[int, Count(at_least=1, at_most=100_000)], ...] | None = None
    """The numbers of the two modes in which they hold, in place of frequencies; the lowest is 1."""

    @model_validator(mode="after")
    def _pairs(self) -> Self:
        _either("place of its ratios", frequencies=self.frequencies, modes=self.modes)
        for key in ("ratios", "frequencies", "modes"):
            values = getattr(self, key)
            if values is not None and len(values) != 2:
                raise PydanticCustomError("pair", f"has {len(values)} '{key}'; give two")
        low, high = self.frequencies or self.modes or (1, 2)
        if not low < high:
            raise PydanticCustomError(
                "order", f"is for {low:g} before {high:g}; give the lower one first"
            )
        if self.frequencies is not None and min(self._sizes(*self.frequencies)) < 0:
            raise PydanticCustomError("sign", self._negative(*self.frequencies))
        return self

    def _sizes(self, low: float, high: float) -> tuple[float, float]:
        return rayleigh((self.ratios[0], self.ratios[1]), (2 * np.pi * low, 2 * np.pi * high))

    def _negative(self, low: float, high: float) -> str:
        one, other = self.ratios
        return (
            f"with the ratios {one:g} at {low:.4g} Hz and {other:g} at {high:.4g} Hz would feed energy into other "
            f"modes; give a second ratio from {one * low / high:.3g} to {one * high / low:.3g}"
        )

    def damped(self, system: MechanicalSystem, vibrations: Vibrations) -> MechanicalSystem:
        """With the rate c and the time T of its two modes.

        Raises
        ------
        InputError : one of them would be negative, or the rod has no such mode.
        """
        low, high = (omega / (2 * np.pi) for omega in self.followed(vibrations))
        rate, time = self._sizes(low, high)
        if min(rate, time) < 0:
            raise InputError(f"'damping' {self._negative(low, high)}")
        return replace(system, damping_rate=rate, damping_time=time)

    def followed(self, vibrations: Vibrations) -> tuple[float, ...]:
        """Those of its two modes."""
        if self.frequencies is not None:
            return tuple(2 * np.pi * frequency for frequency in self.frequencies)
        low, high = self.modes or (1, 2)
        found = _lowest(vibrations, high).angular_frequency
        return float(found[low - 1]), float(found[high - 1])


class StiffnessDamping(Damping):
    """Damping in proportion to the stiffness of the material: stresses grow with the rate of strain (Kelvin and Voigt).

    The force is -T K v.  Rotations and other rigid motions lose nothing.
    """

    kind: Literal["stiffness"] = "stiffness"
    time: Annotated[float, Quantity("s", "T", at_least=0)] | None = None
    """Time T; a mode of angular frequency omega has the ratio T omega / 2."""
    ratio: Ratio | None = None
    """Fraction of critical damping at the frequency, in place of the time."""
    frequency: Annotated[float, Quantity("Hz", above=0)] | None = None
    """Frequency of that ratio; that of the lowest mode by default."""

    @model_validator(mode="after")
    def _one(self) -> Self:
        _either("size", time=self.time, ratio=self.ratio)
        if self.time is not None and self.frequency is not None:
            raise PydanticCustomError("either", "has a 'time' and a 'frequency'; leave one of them out")
        return self

    def damped(self, system: MechanicalSystem, vibrations: Vibrations) -> MechanicalSystem:
        """With the time T."""
        if self.time is not None:
            return replace(system, damping_time=self.time)
        return replace(system, damping_time=2 * (self.ratio or 0.0) / self.followed(vibrations)[0])

    def followed(self, vibrations: Vibrations) -> tuple[float, ...]:
        """That of its ratio, or of the lowest mode."""
        given = self.frequency
        return (vibrations.first() if given is None else 2 * np.pi * given,)


class ModalDamping(Damping):
    """Damping of the lowest modes alone, each with its own ratio; for small motions about the reference."""

    kind: Literal["modal"] = "modal"
    ratios: tuple[Ratio, ...] | None = None
    """Fractions of critical damping of the lowest modes, in their order."""
    ratio: Ratio | None = None
    """One fraction for all of them."""
    modes: Annotated[int, Count(at_least=1, at_most=100_000)] | None = None
    """Number of damped modes, for one ratio."""

    @model_validator(mode="after")
    def _numbers(self) -> Self:
        _either("size", ratios=self.ratios, ratio=self.ratio)
        if (self.ratio is None) == (self.modes is not None):
            raise PydanticCustomError(
                "either",
                "needs 'modes', the number of damped modes, with 'ratio', and none with 'ratios'",
            )
        if self.ratios == ():
            raise PydanticCustomError("rows", "has no 'ratios'; give one for each damped mode")
        return self

    @property
    def each(self) -> Array:
        """The ratios of the damped modes."""
        return np.array(self.ratios if self.ratio is None else [self.ratio] * (self.modes or 0))

    def damped(self, system: MechanicalSystem, vibrations: Vibrations) -> MechanicalSystem:
        """With the damped modes.

        Raises
        ------
        InputError : the rod has fewer modes.
        """
        found, ratios = _lowest(vibrations, self.each.size), self.each
        rates = 2 * ratios * found.angular_frequency
        return replace(system, damped_modes=DampedModes(np.ascontiguousarray(found.shape), rates))


def _lowest(vibrations: Vibrations, count: int) -> Modes:
    found = vibrations.lowest(count)
    if found.angular_frequency.size < count:
        raise InputError(
            f"'damping' is for mode {count}, but the rod has {found.angular_frequency.size} modes; take a lower one, "
            "or more 'rod.vertices'"
        )
    return found


AnyDamping = Annotated[
    MassDamping | RayleighDamping | StiffnessDamping | ModalDamping, Field(discriminator="kind")
]
"""Every kind of damping."""


def stated(system: MechanicalSystem, vibrations: Vibrations) -> dict[str, float]:
    """Sizes of the damping, and frequencies and ratios of the lowest modes in which the rod deforms."""
    found = vibrations.lowest(max(STATED, system.damped_modes.rate.size))
    rates = system.damping_rate + system.damping_time * found.angular_frequency**2
    rates[: system.damped_modes.rate.size] += system.damped_modes.rate
    sizes = {"damping_rate_per_s": system.damping_rate, "damping_time_s": system.damping_time}
    for number, (omega, rate) in enumerate(zip(found.angular_frequency, rates, strict=True), start=1):
        sizes[f"mode_{number}_frequency_Hz"] = omega / (2 * np.pi)
        sizes[f"mode_{number}_damping_ratio"] = rate / (2 * omega)
    return {key: float(f"{value:.9g}") for key, value in sizes.items()}
