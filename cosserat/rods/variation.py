"""Sections that vary along the rod, and their averages over the parts of the discrete rod, eqs. (3.4.8), (3.4.9)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cosserat.parameters import Parameters, Quantity
from cosserat.rods.quadrature import gauss
from cosserat.rods.reference import Lumped

Array = NDArray[np.float64]


class Station(Parameters):
    """Scale factors of section and material at a place; linear between stations, constant beyond them.

    Two stations at one place make a step, for a rod of several materials.
    """

    at: Annotated[float, Quantity("m", r"\xi", "3.4.8", at_least=0)]
    """Distance from the first vertex along the reference centreline."""
    width: Annotated[float, Quantity("1", above=0)] = 1.0
    """Width of the section over that of the rod; a circle, tube or square takes the same factor for its height."""
    height: Annotated[float, Quantity("1", above=0)] = 1.0
    """Height of the section over that of the rod."""
    young: Annotated[float, Quantity("1", above=0)] = 1.0
    """Young's modulus over that of the rod."""
    poisson: Annotated[float, Quantity("1")] = 1.0
    """Poisson's ratio over that of the rod."""
    density: Annotated[float, Quantity("1", above=0)] = 1.0
    """Mass per volume over that of the rod; the line density scales with this times the area."""
    wall: Annotated[float, Quantity("1", above=0)] | None = None
    """Thickness of the walls over that of the rod: of a tube, a hollow rectangle, or flanges and web of an I.

    Height and width are then those of the outline.  By default walls scale with them.
    """

    @property
    def thickness(self) -> float:
        """Factor of the walls; that of the height if none is given."""
        return self.height if self.wall is None else self.wall


class Scales(NamedTuple):
    """Scale factors at some places, arrays of one shape; wall : None if walls scale with width and height."""

    width: Array
    height: Array
    young: Array
    poisson: Array
    density: Array
    wall: Array | None = None


_FACTORS = ("width", "height", "young", "poisson", "density")


def _gauss(cuts: Array) -> tuple[Array, Array]:
    """Nodes and weights on every interval between neighbouring cuts, in order."""
    nodes, weights = gauss(cuts)
    return nodes.ravel(), weights.ravel()


_ONE = _gauss(np.array([0.0, 1.0]))
_NOMINAL = Scales(*(np.ones_like(_ONE[0]) for _ in _FACTORS))
"""Of a uniform rod: nodes and weights of one interval, and the scale factors there."""

NOMINAL = Scales(*(np.ones(()) for _ in _FACTORS))
"""Scale factors of the nominal section, at one place."""

Property = Callable[[Scales, Array], Array]


def walls_vary(stations: Sequence[Station]) -> bool:
    """Whether walls have a factor of their own."""
    return any(station.wall is not None for station in stations)


def scale_at(stations: Sequence[Station], name: str, xi: Array, *, before: bool) -> Array:
    """One scale factor at xi, of the shape of xi; at a step, its value before or after the step."""
    if not stations:
        return np.ones_like(xi)
    at = np.array([s.at for s in stations])
    values = np.array([getattr(s, name) for s in stations])
    upper = np.searchsorted(at, xi, side="left" if before else "right")
    low, high = np.clip(upper - 1, 0, at.size - 1), np.clip(upper, 0, at.size - 1)
    span = np.where(at[high] > at[low], at[high] - at[low], 1.0)
    weight = np.clip((xi - at[low]) / span, 0.0, 1.0)
    result: Array = (1 - weight) * values[low] + weight * values[high]
    return result


def scales_at(stations: Sequence[Station], xi: Array) -> Scales:
    """All scale factors at xi, each of the shape of xi; at a step those after it."""
    scales = Scales(*(scale_at(stations, name, xi, before=False) for name in _FACTORS))
    if walls_vary(stations):
        return scales._replace(wall=scale_at(stations, "thickness", xi, before=False))
    return scales


def mean(stations: Sequence[Station], value: Property, cuts: Array) -> Array:
    """Means of properties between neighbouring cuts, shape (..., cuts - 1).

    value : of shape (..., points), from the scale factors at the points and their places s between the cuts, 0 to 1.
    Gauss's rule with eight points on each smooth piece: exact to rounding for the polynomials that linear scale
    factors make, and nearly so for their inverses.
    """
    count = cuts.shape[-1] - 1
    if not stations:  # uniform: one interval represents all
        nodes, weights = _ONE
        one = (value(_NOMINAL, nodes) * weights).sum(axis=-1)
        return np.repeat(np.asarray(one)[..., None], count, axis=-1)
    steps = np.array([station.at for station in stations])
    nodes, weights = _gauss(
        np.unique(np.concatenate([cuts, steps[(steps > cuts[0]) & (steps < cuts[-1])]]))
    )
    owner = np.clip(np.searchsorted(cuts, nodes, side="right") - 1, 0, count - 1)
    span = (cuts[1:] - cuts[:-1])[owner]
    parts = value(scales_at(stations, nodes), (nodes - cuts[owner]) / span) * (weights / span)
    first = np.searchsorted(owner, np.arange(count))
    means: Array = np.add.reduceat(parts, first, axis=-1)
    return means


def vertex_cuts(arc: Array) -> Array:
    """Arc lengths where the parts round the vertices meet, and both ends, shape (..., N + 1) [m]."""
    middle = (arc[..., 1:] + arc[..., :-1]) / 2
    return np.concatenate([arc[..., :1], middle, arc[..., -1:]], axis=-1)


def overlap(cuts: Array, start: float, end: float) -> Array:
    """Length that each interval between neighbouring cuts shares with another interval, (..., cuts - 1) [m]."""
    shared: Array = np.maximum(0.0, np.minimum(cuts[..., 1:], end) - np.maximum(cuts[..., :-1], start))
    return shared


class EdgeMasses(NamedTuple):
    """Masses of the edges between their two vertices a and b, each (3, ..., N - 1) [kg]: of a, shared by both, of b.

    The rows have the mass and its first and second moment across the rod, the moments over their nominal arms.
    """

    before: Array
    shared: Array
    after: Array


def edge_masses(
    stations: Sequence[Station],
    line_density: float | Array,
    arc: Array,
    inertia: Callable[[Scales], Array],
) -> EdgeMasses:
    """The mean of the lumped and the consistent mass of every edge.

    inertia : mass per length and its two moments over the nominal ones, (3, points), from the scale factors there.

    derived: with s from 0 to 1 along an edge and M_k the integral of s^k over its mass, linear interpolation gives
    M_0 - 2 M_1 + M_2, M_1 - M_2 and M_2; the two masses at the ends that keep M_0 and M_1 are M_0 - M_1 and M_1.  Both
    keep mass and centre of mass, and their errors in a frequency are opposite.
    """
    powers = np.arange(3)[:, None]

    def moments(scale: Scales, s: Array) -> Array:
        return inertia(scale)[:, None] * s**powers

    edge = np.diff(arc) * line_density
    means = mean(stations, moments, arc)
    several = means.reshape(*means.shape[:-1], *[1] * (edge.ndim - 1), -1)
    M0, M1, M2 = (edge * several).swapaxes(0, 1)
    return EdgeMasses(M0 - 3 / 2 * M1 + M2 / 2, (M1 - M2) / 2, (M1 + M2) / 2)


def lump(
    stations: Sequence[Station],
    arc: Array,
    *,
    area: float,
    second_moment: float,
    young: float,
    poisson: float,
) -> tuple[Lumped, Lumped]:
    """Vertex and edge properties, Table 3.1, of a rod whose nominal section and material vary along its stations.

    arc : (N,) arc length of the vertices.  The boundary vertices have the properties of their edges, eq. (3.4.10)
    without its half.  Each of A, I, E, G and nu is averaged by itself, as in the table.
    """
    if not stations:
        nominal = {"area": area, "second_moment": second_moment, "young": young, "poisson": poisson}
        return Lumped.uniform(arc.size, **nominal), Lumped.uniform(arc.size - 1, **nominal)

    def averaged(cuts: Array) -> Array:
        return mean(
            stations,
            lambda s, _: np.stack(
                [
                    area * s.width * s.height,
                    second_moment * s.width * s.height**3,
                    young * s.young,
                    young * s.young / (2 * (1 + poisson * s.poisson)),
                    poisson * s.poisson,
                ]
            ),
            cuts,
        )

    edge, inner = averaged(arc), averaged(vertex_cuts(arc))
    vertex = np.concatenate([edge[:, :1], inner[:, 1:-1], edge[:, -1:]], axis=1)
    return Lumped(*vertex), Lumped(*edge)
