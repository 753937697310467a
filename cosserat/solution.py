"""What a problem gives back: fields with their dimensions, and what the solver did; without units or metadata.

The names are those of `cosserat.data.variables`, which knows units and meaning.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Field = tuple[tuple[str, ...], Array]
"""Names of the dimensions, and the values along them in SI units."""


@dataclass(frozen=True)
class Variable:
    """What a stored variable is: unit, meaning, and symbol and equation of the thesis.

    floor : differences below this are rounding, in the variable's unit.  Positions of a few metres are known to
        1e-15 m; strains of an edge to that over its length; forces to that strain times the axial stiffness.
    """

    dims: tuple[str, ...]  # of one state; a motion puts `time` before them, a path `point`
    units: str
    long_name: str
    symbol: str
    equation: str
    floor: float


@dataclass(frozen=True)
class Variables:
    """What one part of the package adds to the table of stored variables.

    labels : meaning of the dimensions whose values are names.  coordinates : variables that place the others.
    """

    variables: Mapping[str, Variable]
    labels: Mapping[str, str]
    coordinates: tuple[str, ...]


@dataclass(frozen=True)
class Solution:
    """Fields by variable name; `solution["u"]` gives the values of one.

    statistics : what the solver did, by name.
    labels : the names along a dimension that is not counted, such as the axes of a vector.
    warnings : what a user should know before using the numbers, a sentence each that begins with a name.
    """

    fields: Mapping[str, Field]
    statistics: Mapping[str, int | float]
    labels: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def __getitem__(self, name: str) -> Array:
        """The values of one field."""
        return self.fields[name][1]

    def __contains__(self, name: str) -> bool:
        """Whether there is a field of that name."""
        return name in self.fields
