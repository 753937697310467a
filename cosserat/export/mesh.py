"""Bodies as meshes: a rod as quadrilaterals between its lateral surfaces, a crawler as a closed surface.

Coordinates are x along E3, y along E2, as the pictures have them, and z across the plane of motion.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from cosserat.problems.crawler import CrawlerProblem
from cosserat.rods.problem import RodProblem

Array = NDArray[np.float64]
_VECTORS = {"velocity": ("x_rate", "d_rate"), "mode": ("mode_u", "mode_delta")}
AROUND = 32
"""Points of a mesh round a section of a crawler."""


@dataclass(frozen=True)
class Body:
    """A mesh of one instant.

    points : positions, shape (points, 3) [m].
    cells : kinds of cells as meshio names them, and the points of each, counterclockwise seen from outside.
    at_points : values by name, shape (points,) or (points, 3).
    in_cells : values by name, one array for each kind of cells.
    """

    points: Array
    cells: tuple[tuple[str, NDArray[np.intp]], ...]
    at_points: Mapping[str, Array]
    in_cells: Mapping[str, tuple[Array, ...]]


def rod(state: xr.Dataset, problem: RodProblem) -> Body:
    """One state of a rod: 2 N points, the upper ones first, and N - 1 quadrilaterals.

    Both points of a section have its values; a quadrilateral has those of its edge.  The vectors "displacement" [m],
    "velocity" [m/s] of a motion and "mode" of a natural mode are those of the points themselves.
    """
    below, count = problem.rod.below, state.sizes["vertex"]

    def surfaces(centre: str, director: str) -> Array:
        """Vectors of the upper and the lower points, from those of centreline and directors."""
        x, d = (
            state[name].transpose("vertex", "axis").sel(axis=["E3", "E2"]).to_numpy()
            for name in (centre, director)
        )
        return np.pad(np.concatenate([x + d, x - below * d]), ((0, 0), (0, 1)))

    points = surfaces("x", "d")
    vectors = {"displacement": points - surfaces("x_ref", "d_ref")}
    vectors |= {name: surfaces(*pair) for name, pair in _VECTORS.items() if pair[0] in state}
    lower = np.arange(count, 2 * count - 1)
    quads = np.column_stack([lower, lower + 1, lower + 1 - count, lower - count])
    at_vertices = {name: np.tile(values, 2) for name, values in _scalars(state, "vertex").items()}
    in_edges = {name: (values,) for name, values in _scalars(state, "edge").items()}
    return Body(points, (("quad", quads),), vectors | at_vertices, in_edges)


def crawler(state: xr.Dataset, problem: CrawlerProblem) -> Body:
    """One instant of a crawler on the ground y = 0: elliptical sections, and a flat end on either side.

    Every point has the values of its section.
    """
    sections, radius = state.sizes["section"], np.full(state.sizes["section"], problem.crawler.radius)
    if "resting_radius" in state:
        radius = state.resting_radius.to_numpy()
    angle = 2 * np.pi * np.arange(AROUND) / AROUND
    around = _section(state, radius, np.cos(angle), np.sin(angle))
    centres = _section(state, radius, np.zeros(1), np.zeros(1))[[0, -1]]
    start = AROUND * np.arange(sections - 1)[:, None] + np.arange(AROUND)
    after = AROUND * np.arange(sections - 1)[:, None] + (np.arange(AROUND) + 1) % AROUND
    sides = np.stack([start, start + AROUND, after + AROUND, after], axis=-1).reshape(-1, 4)
    rear, front, last = start[0], after[0], AROUND * (sections - 1)
    middle = np.full(AROUND, AROUND * sections)
    ends = np.concatenate(
        [
            np.column_stack([middle, rear, front]),
            np.column_stack([middle + 1, front + last, rear + last]),
        ]
    )
    values = {
        name: np.r_[np.repeat(of, AROUND), of[0], of[-1]]
        for name, of in _scalars(state, "section").items()
    }
    points = np.concatenate([around.reshape(-1, 3), centres.reshape(-1, 3)])
    return Body(points, (("quad", sides), ("triangle", ends)), values, {})


def _section(state: xr.Dataset, radius: Array, across: Array, up: Array) -> Array:
    """Points of every section at fractions of its semi-axes, shape (sections, points, 3)."""
    along = state.along.to_numpy()[:, None]
    tall, wide = ((radius * state[name].to_numpy())[:, None] for name in ("mu_1", "mu_2"))
    place = np.broadcast_to(along, (along.size, across.size))
    # the sections touch the ground, (2.2.16)
    return np.stack([place, tall * (1 + up), wide * across], axis=-1)


def _scalars(state: xr.Dataset, place: str) -> dict[str, Array]:
    """Variables with one number at each place."""
    return {
        str(name): values.to_numpy()
        for name, values in state.variables.items()
        if values.dims == (place,)
    }
