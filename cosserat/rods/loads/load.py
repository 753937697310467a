"""The interface of all kinds of loads."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from cosserat.parameters import Parameters
from cosserat.rods.places import located
from cosserat.rods.reference import Geometry
from cosserat.rods.rod import Rod
from cosserat.rods.time_functions import AnyTimeFunction
from cosserat.solvers.potential import Potential

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LoadedRod:
    """The body that a load acts on.

    origin : (n,) added by the potential to the DOFs to get positions and directors: zero, or the reference.
    """

    rod: Rod
    geometry: Geometry
    origin: Array | None = None

    @cached_property
    def mass(self) -> Array:
        """Mass matrix as a symmetric band."""
        return self.rod.mass(self.geometry)

    @property
    def no_force(self) -> Array:
        """Zero for the DOFs of each vertex, shape (N, DOFs of a vertex)."""
        return np.zeros((self.rod.vertices, self.rod.kinematics.per_vertex))

    def shared(self, at: str | int) -> tuple[tuple[int, float], ...]:
        """The vertices beside a place, with their weights in linear interpolation."""
        return located(at, self.geometry.arc_length).weights

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
    def places(self) -> tuple[str | int, ...]:
        """The places that it names."""
        return ()

    def check(self, rod: Rod) -> None:
        """Raise PydanticCustomError if it does not fit the rod."""

    @classmethod
    @abstractmethod
    def potential(cls, loads: Sequence[Self], body: LoadedRod) -> Potential:
        """The potential of some loads of this kind together; zero in the reference configuration."""
