"""Fields of special points of a path, and of the modes that cost no energy there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.kinematics import Kinematics
from cosserat.rods.reference import Geometry
from cosserat.rods.rod import Rod
from cosserat.solution import Field
from cosserat.solvers.special import SpecialPoint

Array = NDArray[np.float64]
SPECIAL_FIELDS = {
    *("special_load_factor", "special_x", "special_d", "special_u", "special_delta", "special_after")
}
"""Fields of special points."""
_STILL = 1e-9  # of the directors of a mode, below which its displacements are round-off


def leading(kinematics: Kinematics, mode: NDArray[np.complex128] | Array) -> complex:
    """The largest component of the displacements of a mode (n,); of its directors if it moves no vertex."""
    vectors = kinematics.split(np.asarray(mode))
    u, delta = vectors[:, 0].ravel(), vectors[:, 1:].ravel()
    part = u if np.abs(u).max() > _STILL * np.abs(delta).max() else delta
    return complex(part[np.abs(part).argmax()])


def scaled(kinematics: Kinematics, mode: Array) -> tuple[Array, Array]:
    """Displacements and director displacements of a mode (n,), (N, 2) each: the largest displacement is one."""
    vectors = kinematics.split(mode / leading(kinematics, mode).real)
    return vectors[:, 0], vectors[:, 1]


def special_fields(
    rod: Rod, geometry: Geometry, found: Sequence[SpecialPoint]
) -> tuple[dict[str, Field], tuple[str, ...], dict[str, int | float]]:
    """Fields of special points, their labels, and statistics; no fields where there are none."""
    first = [point.point.factor for point in found if point.first][:1]
    statistics: dict[str, int | float] = {
        "limit_points": sum(int(point.limit) for point in found),
        "bifurcations": sum(not point.limit for point in found),
    }
    if first:
        statistics["first_instability_load_factor"] = float(first[0])
    if not found:
        return {}, (), statistics
    placed = np.array([rod.vectors(geometry, point.point.q) for point in found])
    shapes = np.array([scaled(rod.kinematics, point.mode) for point in found])
    vector = ("special", "vertex", "axis")
    fields: dict[str, Field] = {
        "special_load_factor": (("special",), np.array([point.point.factor for point in found])),
        "special_x": (vector, placed[:, :, 0]),
        "special_d": (vector, placed[:, :, 1]),
        "special_u": (vector, shapes[:, 0]),
        "special_delta": (vector, shapes[:, 1]),
    }
    unstable = next((k for k, point in enumerate(found) if point.first), None)
    labels = tuple(
        point.label + (", first instability" if k == unstable else "") for k, point in enumerate(found)
    )
    return fields, labels, statistics
