"""Names in a case: of directions in the plane, of degrees of freedom (DOFs), of points and supports."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator
from pydantic_core import PydanticCustomError, core_schema

from cosserat.parameters import Quantity, Reader, from_file
from cosserat.text import checked_name, shown

Array = NDArray[np.float64]
_DIRECTIONS = {"E3": (1.0, 0.0), "-E3": (-1.0, 0.0), "E2": (0.0, 1.0), "-E2": (0.0, -1.0)}


class DirectionName(Reader):
    """Annotation: an axis, an angle from E3 towards E2, or components along E3 and E2 of any length."""

    @property
    def alternatives(self) -> Any:
        """A word, an angle or two numbers."""
        number = Annotated[float, Quantity("1")]
        return (
            Literal["E3", "-E3", "E2", "-E2"] | Annotated[float, Quantity("rad")] | tuple[number, number]
        )

    @property
    def said(self) -> str:
        """In words."""
        return '"E3", "-E3", "E2", "-E2", an angle from E3 towards E2 such as "30 deg", or components such as [3, 4]'

    def check(self, value: object, info: core_schema.ValidationInfo) -> Any:
        """Read one direction."""
        if isinstance(value, str) and value in _DIRECTIONS:
            return value
        required = from_file(info)
        try:
            if not isinstance(value, list | tuple):
                return Quantity("rad").read(value, unit_required=required)
            components = tuple(Quantity("1").read(part, unit_required=required) for part in value[:3])
        except PydanticCustomError:
            components = ()
        if len(components) != 2 or not any(components):
            raise PydanticCustomError("direction", f"is {shown(value)}; it must be {self.said}")
        return components


Direction = Annotated[str | float | tuple[float, float], DirectionName()]
DofName = Literal["x3", "x2", "d3", "d2"]


def _check_name(name: str) -> str:
    return checked_name(name, r"[^\W\d_][\w -]*", "; begin it with a letter, such as 'tip'")


Name = Annotated[str, AfterValidator(_check_name)]
"""The name of a point or a support in the result."""


def check_names(key: str, names: Sequence[str]) -> None:
    """Raise PydanticCustomError if two things of one key have the same name."""
    for name in names:
        if names.count(name) > 1:
            raise PydanticCustomError(
                "twice", f"'{key}' has two named {shown(name)}; give each a name of its own"
            )


def unit_vector(direction: str | float | tuple[float, float]) -> Array:
    """The unit vector of a direction, shape (2,)."""
    if isinstance(direction, str):
        return np.array(_DIRECTIONS[direction])
    if isinstance(direction, tuple):
        components: Array = np.array(direction) / np.hypot(*direction)
        return components
    return np.array([np.cos(direction), np.sin(direction)])
