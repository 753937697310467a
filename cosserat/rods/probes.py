"""Points of a rod whose displacement and rotation a case asks for by name."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cosserat.parameters import Parameters
from cosserat.rods.naming import Name
from cosserat.rods.places import Place, located

Array = NDArray[np.float64]


class Probe(Parameters):
    """A point whose displacement and rotation are stored by name."""

    at: Place
    """Its place; between two vertices their values are interpolated."""
    name: Name
    """Name of the point in the result."""


def at_probes(probes: Sequence[Probe], arc: Array, values: Array) -> Array:
    """Values (..., N, k) of the vertices at the points: (..., points, k); arc : (N,) of the vertices [m]."""
    found = np.zeros((*values.shape[:-2], len(probes), values.shape[-1]))
    for number, probe in enumerate(probes):
        for vertex, weight in located(probe.at, arc).weights:
            found[..., number, :] += weight * values[..., vertex, :]
    return found
