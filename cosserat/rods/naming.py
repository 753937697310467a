"""Names in a case: of vertices, of directions in the plane, of degrees of freedom (DOFs)."""

from __future__ import annotations

import numbers
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import GetCoreSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

Array = NDArray[np.float64]
_DIRECTIONS = {"E3": (1.0, 0.0), "-E3": (-1.0, 0.0), "E2": (0.0, 1.0), "-E2": (0.0, -1.0)}


class VertexName:
    """Annotation: 'first', 'last' or an index."""

    @staticmethod
    def check(value: object) -> str | int:
        """Read one name of a vertex."""
        if isinstance(value, str) and value in ("first", "last"):
            return value
        if isinstance(value, bool) or not isinstance(value, numbers.Integral) or value < 0:
            raise PydanticCustomError(
                "type", f"is {value!r}; it must be 'first', 'last' or the index of a vertex"
            )
        return int(value)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)


Vertex = Annotated[str | int, VertexName()]
Direction = Literal["E3", "-E3", "E2", "-E2"]
DofName = Literal["x3", "x2", "d3", "d2"]


def unit_vector(direction: Direction) -> Array:
    """The unit vector of a named direction, shape (2,)."""
    return np.array(_DIRECTIONS[direction])
