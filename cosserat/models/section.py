"""Sections that vary along the rod, and their averages over the parts of the discrete rod, eqs. (3.4.8)-(3.4.10)."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cosserat.models.planar_rod import Lumped
from cosserat.parameters import Parameters, Quantity

Array = NDArray[np.float64]


class Station(Parameters):
    """Section and material at a place, as shares of the rod's; linear between stations, constant beyond them.

    Two stations at one place make a step: a rod may be of several materials.
    """

    at: Annotated[float, Quantity("m", r"\xi", "3.4.8", at_least=0)]
    width: Annotated[float, Quantity("1", above=0)] = 1.0
    height: Annotated[float, Quantity("1", above=0)] = 1.0
    young: Annotated[float, Quantity("1", above=0)] = 1.0
    poisson: Annotated[float, Quantity("1")] = 1.0
    density: Annotated[float, Quantity("1", above=0)] = 1.0
    """Of mass per volume: the line density goes with this times the area."""


class Shares(NamedTuple):
    """The shares of the stations at some places."""

    width: Array
    height: Array
    young: Array
    poisson: Array
    density: Array


Property = Callable[[Shares], Array]


def mass_share(s: Shares) -> Array:
    """Mass per length over the nominal one."""
    return s.density * s.width * s.height


def share(stations: Sequence[Station], name: str, xi: Array, *, before: bool) -> Array:
    """One share of the stations at xi; at a step, its value before or after the step."""
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


def mean(stations: Sequence[Station], value: Property, low: Array, high: Array) -> Array:
    """Mean of a property over each interval [low, high].

    Gauss's rule with four points on each smooth piece: exact to rounding for the polynomials that linear shares make.
    """
    if not stations:
        return value(Shares(*(np.ones_like(low) for _ in Shares._fields)))
    nodes, weights = np.polynomial.legendre.leggauss(4)
    breaks = np.array(sorted({s.at for s in stations}))
    total = np.zeros_like(low)
    for number, (a, b) in enumerate(zip(low, high, strict=True)):
        cuts = np.concatenate([[a], breaks[(breaks > a) & (breaks < b)], [b]])
        for left, right in itertools.pairwise(cuts):
            xi = (left + right) / 2 + (right - left) / 2 * nodes
            shares = Shares(*(share(stations, name, xi, before=False) for name in Shares._fields))
            total[number] += (right - left) / 2 * float(weights @ value(shares))
    result: Array = total / (high - low)
    return result


def lump(
    stations: Sequence[Station],
    arc: Array,
    *,
    area: float,
    second_moment: float,
    young: float,
    poisson: float,
) -> tuple[Lumped, Lumped]:
    """Vertex and edge properties, Table 3.1, of a rod whose nominal section and material vary as the stations say.

    arc : (N,) arc length of the vertices.  The boundary vertices have the properties of their edges, eq. (3.4.10)
    without its half.  Each of A, I, E, G and nu is averaged by itself, as the table has it.
    """
    middles = (arc[1:] + arc[:-1]) / 2
    properties: dict[str, Property] = {
        "area": lambda s: area * s.width * s.height,
        "second_moment": lambda s: second_moment * s.width * s.height**3,
        "young": lambda s: young * s.young,
        "shear": lambda s: young * s.young / (2 * (1 + poisson * s.poisson)),
        "poisson": lambda s: poisson * s.poisson,
    }

    def averaged(low: Array, high: Array) -> dict[str, Array]:
        return {name: mean(stations, value, low, high) for name, value in properties.items()}

    edge, inner = averaged(arc[:-1], arc[1:]), averaged(middles[:-1], middles[1:])
    vertex = {name: np.concatenate([edge[name][:1], inner[name], edge[name][-1:]]) for name in edge}
    return Lumped(**vertex), Lumped(**edge)
