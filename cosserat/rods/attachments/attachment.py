"""The interface of all kinds of attachments: springs between a rod and the ground, at rest in the reference."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Parameters
from cosserat.rods.attachments.kernel import ELEMENT, evaluate
from cosserat.rods.loads.load import LoadedRod
from cosserat.rods.naming import Direction, unit_vector
from cosserat.rods.places import Located
from cosserat.rods.reference import unwrapped_angles
from cosserat.rods.rod import Rod
from cosserat.solvers.potential import NOTHING, Potential

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Element:
    """A spring at one place: along a unit vector (2,) [N/m], or against rotation if there is none [N m/rad]."""

    place: Located
    stiffness: float
    along: Array | None


class Attachment(Parameters):
    """An attachment of one kind: its parameters, and the springs that it is made of."""

    along: Direction | None = None
    """Direction in which it resists displacements; the direction stays, however the rod turns."""

    @property
    @abstractmethod
    def stiffnesses(self) -> tuple[float, float]:
        """Stiffness against displacement, and against rotation."""

    @property
    def places(self) -> tuple[str | int, ...]:
        """The places that it names."""
        return ()

    def check(self, rod: Rod) -> None:
        """Raise PydanticCustomError if it does not fit the rod."""

    @abstractmethod
    def shares(self, body: LoadedRod) -> Iterator[tuple[Located, float]]:
        """The places of its springs, and by how much each multiplies the stiffnesses."""

    @model_validator(mode="after")
    def _resists(self) -> Self:
        straight, turning = self.stiffnesses
        if not straight and not turning:
            raise PydanticCustomError(
                "stiffness",
                "has no stiffness; give 'stiffness' and 'along', or 'rotational_stiffness'",
            )
        if bool(straight) != (self.along is not None):
            raise PydanticCustomError(
                "along",
                f"has {'stiffness' if straight else 'along'!r} without "
                f"{'along' if straight else 'stiffness'!r}; give both or none",
            )
        return self

    def elements(self, body: LoadedRod) -> Iterator[Element]:
        """Its springs."""
        straight, turning = self.stiffnesses
        for place, share in self.shares(body):
            if self.along is not None:
                yield Element(place, share * straight, unit_vector(self.along))
            if turning:
                yield Element(place, share * turning, None)


def attached_energy(items: Iterable[Attachment], body: LoadedRod) -> Potential:
    """The energy of all attachments together, zero in the reference.

    Its internal variable, if one resists rotation, is the winding angle of the first director [rad].
    """
    every = [element for item in items for element in item.elements(body)]
    elements = sorted(every, key=lambda element: element.place.index)
    per_vertex, angles = body.rod.kinematics.per_vertex, unwrapped_angles(body.geometry.D)
    constants = np.zeros(len(elements), ELEMENT)
    for row, element in zip(constants, elements, strict=True):
        weights = dict(element.place.weights)
        vertex = min(weights)
        low, high = weights[vertex], weights.get(vertex + 1, 0.0)
        values = angles if element.along is None else body.geometry.X @ element.along
        row["stiffness"], row["vertex"], row["per_vertex"] = element.stiffness, vertex, per_vertex
        row["low"], row["high"] = low, high
        row["rest"] = low * values[vertex] + (high * values[vertex + 1] if high else 0.0)
        if element.along is None:
            row["turns"] = 1
        else:
            row["along_3"], row["along_2"] = element.along
    between = bool(constants["high"].any())
    return Potential(
        evaluate,
        constants,
        ("attachments",),
        half_bandwidth=per_vertex + 1 if between else 1,
        history=angles[:1].copy() if constants["turns"].any() else NOTHING,
        strains=(constants.size, 1),
        origin=body.origin,
    )
