"""Results of a problem: fields with their dimensions, and statistics of the solver, without units or metadata.

Units and meaning of the names are in `cosserat.data.variables`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Field = tuple[tuple[str, ...], Array]
"""Names of the dimensions, and the values along them in SI units."""


@dataclass(frozen=True)
class Variable:
    """Description of a stored variable: unit, meaning, and symbol and equation of the thesis.

    floor : differences below this are round-off, in the variable's unit.  Positions of a few metres are known to
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
    """Part of the table of stored variables.

    labels : meaning of the dimensions whose values are names.  coordinates : variables that place the others.
    """

    variables: Mapping[str, Variable]
    labels: Mapping[str, str]
    coordinates: tuple[str, ...]


@dataclass(frozen=True)
class Solution:
    """Fields by variable name; `solution["u"]` gives the values of one.

    statistics : of the solver, by name.
    labels : the names along a dimension without numbers, such as the axes of a vector.
    warnings : sentences about the use of the numbers, each begins with a name.
    derive : gives further fields and labels that follow from these, when a Dataset is made; at least those of given
        names, or all of them.
    """

    fields: Mapping[str, Field]
    statistics: Mapping[str, int | float]
    labels: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    derive: Callable[..., Solution] | None = None

    def __getitem__(self, name: str) -> Array:
        """The values of one field."""
        return self.fields[name][1]

    def __contains__(self, name: str) -> bool:
        """Whether there is a field of that name."""
        return name in self.fields


@dataclass(frozen=True)
class FieldRates:
    """Fields of M results, and how they move with K keys, by the step of each: a fraction of its value, or itself.

    now : by name, with the dimension "member" before those of one result, (M, ...).  change : likewise, (M K, ...),
    the keys of one result together.  labels : as in `Solution`.
    rounding : (M, K) of the rates, as a fraction of the largest.  known : (M, K) which rates there are.
    """

    now: Mapping[str, Field]
    change: Mapping[str, Field]
    labels: Mapping[str, tuple[str, ...]]
    rounding: Array
    known: NDArray[np.bool_]

    def after(self, result: int, key: int, step: float) -> dict[str, Field]:
        """The fields of one result after a step of a key, to first order."""
        row = result * self.known.shape[1] + key
        return {
            name: (dims[1:], values[result] + step * self.change[name][1][row])
            for name, (dims, values) in self.now.items()
        }


@dataclass(frozen=True)
class Many:
    """Solutions of many problems that differ in some numbers.

    fields : by name, with the dimension "member" before those of one solution.  statistics : by name, (M,).
    labels : as in `Solution`.
    solved : (M,) which members are; each of the others is left to its own problem, which solves it or says why not.
    warnings : sentences by the number of a member.
    rates : of the fields with the keys that were asked for; None if none were.
    """

    fields: Mapping[str, Field]
    statistics: Mapping[str, NDArray[Any]]
    labels: Mapping[str, tuple[str, ...]]
    solved: NDArray[np.bool_]
    warnings: Mapping[int, Sequence[str]]
    rates: FieldRates | None = None
