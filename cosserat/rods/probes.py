"""Points of a rod whose displacement and rotation a case asks for by name."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Parameters
from cosserat.rods.places import Place, located

Array = NDArray[np.float64]


def _check_name(name: str) -> str:
    if not re.fullmatch(r"[^\W\d][\w -]*", name):
        raise PydanticCustomError("name", f"is {name!r}; begin it with a letter, such as 'tip'")
    return name


class Probe(Parameters):
    """A point whose displacement and rotation are stored by name."""

    at: Place
    """Its place; between two vertices their values are interpolated."""
    name: Annotated[str, AfterValidator(_check_name)]
    """Name of the point in the result."""


def check_names(probes: Sequence[Probe]) -> None:
    """Raise PydanticCustomError if two points have one name."""
    names = [probe.name for probe in probes]
    for name in names:
        if names.count(name) > 1:
            raise PydanticCustomError(
                "twice", f"'probes' has two named {name!r}; give each a name of its own"
            )


def at_probes(probes: Sequence[Probe], arc: Array, values: Array) -> Array:
    """Values (..., N, k) of the vertices at the points: (..., points, k); arc : (N,) of the vertices [m]."""
    found = np.zeros((*values.shape[:-2], len(probes), values.shape[-1]))
    for number, probe in enumerate(probes):
        for vertex, weight in located(probe.at, arc).weights:
            found[..., number, :] += weight * values[..., vertex, :]
    return found
