"""Sections that vary along the rod, and their averages over the parts of the discrete rod, eqs. (3.4.8)-(3.4.10)."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from cosserat.models.planar_rod import Lumped
from cosserat.parameters import Parameters, Quantity

Array = NDArray[np.float64]
Density = Callable[[Array, Array, Array], Array]


class Station(Parameters):
    """Width, height and modulus at a place, as shares of the rod's; linear between stations, constant beyond them.

    Two stations at one place make a step.
    """

    at: Annotated[float, Quantity("m", r"\xi", "3.4.8", at_least=0)]
    width: Annotated[float, Quantity("1", above=0)] = 1.0
    height: Annotated[float, Quantity("1", above=0)] = 1.0
    young: Annotated[float, Quantity("1", above=0)] = 1.0


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


def mean(
    stations: Sequence[Station], density: Callable[[Array, Array, Array], Array], low: Array, high: Array
) -> Array:
    """Mean of density(width, height, young) over each interval [low, high], to rounding.

    Gauss's rule with four points on each smooth piece: exact for the polynomials that linear shares make.
    """
    if not stations:
        one = np.ones_like(low)
        return density(one, one, one)
    nodes, weights = np.polynomial.legendre.leggauss(4)
    breaks = np.array(sorted({s.at for s in stations}))
    total = np.zeros_like(low)
    for number, (a, b) in enumerate(zip(low, high, strict=True)):
        cuts = np.concatenate([[a], breaks[(breaks > a) & (breaks < b)], [b]])
        for left, right in itertools.pairwise(cuts):
            xi = (left + right) / 2 + (right - left) / 2 * nodes
            shares = (share(stations, name, xi, before=False) for name in ("width", "height", "young"))
            total[number] += (right - left) / 2 * float(weights @ density(*shares))
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
    """Vertex and edge properties, Table 3.1, of a rod whose nominal section varies as the stations say.

    arc : (N,) arc length of the vertices.  The boundary vertices have the properties of their edges, eq. (3.4.10)
    without its half.
    """
    middles = (arc[1:] + arc[:-1]) / 2

    def averaged(low: Array, high: Array) -> tuple[Array, Array, Array]:
        return (
            area * mean(stations, lambda w, h, _: w * h, low, high),
            second_moment * mean(stations, lambda w, h, _: w * h**3, low, high),
            young * mean(stations, lambda w, h, e: e, low, high),
        )

    edge = averaged(arc[:-1], arc[1:])
    inner = averaged(middles[:-1], middles[1:])
    a, i, e = (
        np.concatenate([ends[:1], part, ends[-1:]]) for ends, part in zip(edge, inner, strict=True)
    )
    return _lumped(a, i, e, poisson), _lumped(*edge, poisson)


def _lumped(area: Array, second_moment: Array, young: Array, poisson: float) -> Lumped:
    return Lumped(area, second_moment, young, young / (2 * (1 + poisson)), np.full_like(area, poisson))
