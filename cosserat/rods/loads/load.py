"""The interface of all kinds of loads."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Self

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from cosserat.parameters import Parameters, Quantity
from cosserat.rods.masses import Mass, added, mass_band
from cosserat.rods.places import located
from cosserat.rods.reference import Geometry
from cosserat.rods.rod import Rod
from cosserat.rods.time_functions import AnyTimeFunction, TimeFunction
from cosserat.rods.variation import overlap, vertex_cuts
from cosserat.solvers.potential import Potential

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LoadedRod:
    """The body that a load acts on.

    origin : (n,) added by the potential to the DOFs to get positions and directors: zero, or the reference.
    held : (n,) which DOFs are constrained and do not move; None: none of them.
    masses : concentrated masses that it carries.
    """

    rod: Rod
    geometry: Geometry
    origin: Array | None = None
    held: NDArray[np.bool_] | None = None
    masses: tuple[Mass, ...] = ()

    @cached_property
    def mass(self) -> Array:
        """Mass matrix as a symmetric band, with that of the concentrated masses."""
        own = self.rod.mass(self.geometry)
        if not self.masses:
            return own
        return added(own, mass_band(self.masses, self.geometry, self.rod.kinematics))

    @property
    def no_force(self) -> Array:
        """Zero for the DOFs of each vertex, shape (..., N, DOFs of a vertex)."""
        return np.zeros((*self.geometry.X.shape[:-1], self.rod.kinematics.per_vertex))

    @property
    def held_components(self) -> NDArray[np.bool_]:
        """Components in which neither the position nor the director of a vertex moves, shape (N, 2)."""
        if self.held is None:
            return np.zeros((self.rod.vertices, 2), dtype=np.bool_)
        return np.asarray(self.rod.kinematics.split(self.held)[:, :2].all(axis=1))

    def shared(self, at: str | int) -> tuple[tuple[int, float], ...]:
        """The vertices beside a place, with their weights in linear interpolation; the same in several rods."""
        arc = self.geometry.arc_length
        return located(at, arc.reshape(-1, arc.shape[-1])[0]).weights

    @property
    def unmoved(self) -> Array:
        """The DOFs (n,) of the reference."""
        at_rest = self.rod.strain_energy.reference(self.geometry)
        return at_rest if self.origin is None else np.zeros_like(at_rest)


class Load(Parameters):
    """A load of one kind: its parameters, and the potential of all loads of that kind."""

    time_function: AnyTimeFunction | None = None
    """Factor that depends on time, of a motion only; a load without one acts from the start."""

    @property
    def level(self) -> TimeFunction | None:
        """How it depends on time; None for a constant load."""
        return self.time_function

    @property
    def places(self) -> tuple[str | int, ...]:
        """The places that it names."""
        return ()

    def check(self, rod: Rod, key: str) -> None:
        """Raise PydanticCustomError if it does not fit the rod; `key` : its name in a case."""

    @classmethod
    @abstractmethod
    def potential(cls, loads: Sequence[Self], body: LoadedRod) -> Potential:
        """The potential of some loads of this kind together; zero in the reference configuration."""


class Stretch(Load):
    """A load over a stretch of the rod."""

    start: Annotated[float, Quantity("m", at_least=0)] = 0.0
    """Start of the load along the reference centreline."""
    end: Annotated[float, Quantity("m", above=0)] | None = None
    """End of the load; the end of the rod by default."""

    def check(self, rod: Rod, key: str) -> None:
        """Require a start before the end, both on the rod."""
        start, end = self.ends(rod)
        if not start < end <= rod.length * (1 + 1e-12):
            raise PydanticCustomError(
                "range",
                f"'{key}' has one from {start:g} m to {end:g} m, but the rod goes from 0 to "
                f"{rod.length:g} m; let it begin before it ends, on the rod",
            )

    def ends(self, rod: Rod) -> tuple[float, float]:
        """Its start and its end [m]."""
        return self.start, rod.length if self.end is None else self.end

    def covered(self, body: LoadedRod) -> Array:
        """Length that it covers of the part round each vertex, shape (..., N) [m]."""
        start, end = self.ends(body.rod)
        return overlap(vertex_cuts(body.geometry.arc_length), start, end)
