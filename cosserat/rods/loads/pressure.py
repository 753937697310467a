"""Pressure on a lateral surface: across the deformed surface, on its deformed length.

derived: the surface is the polygon of s = x + r d, with r = 1 above and r = -below / above beneath.  On the part of an
edge from a to b, fractions of it, the force is p W (b - a) Q (s2 - s1), Q a quarter turn into the body, at the
middle m = (a + b) / 2: s1 carries 1 - m of it and s2 carries m.  Between whole edges of one width the skew parts of
the tangent cancel.  If also the ends of the surface can only move along one axis, the load has a potential: -p W times
the area between the surface and its reference, closed by straight lines between their ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal, Self

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.parameters import Quantity
from cosserat.rods.loads.load import LoadedRod, Stretch
from cosserat.rods.variation import scale_at
from cosserat.solvers.banded import Band, Vector
from cosserat.solvers.potential import COMMIT, GRADIENT, HESSIAN, Potential

Array = NDArray[np.float64]
_EDGE = np.dtype(
    [
        ("load", "f8"),  # p W (b - a), positive where it turns E3 towards -E2 [N/m]
        ("middle", "f8"),  # m
        ("reach", "f8"),  # r
        ("swept", "f8"),  # area of the reference, which is subtracted [m^2]
        ("from3", "f8"),  # S1 of the reference where the edge begins the loaded part, else zero [m]
        ("from2", "f8"),
        ("to3", "f8"),  # S2 of the reference where the edge ends it, else zero [m]
        ("to2", "f8"),
        ("dof", "i8"),  # the first of its first vertex
        ("next", "i8"),  # the first of its second vertex
        ("conserves", "i8"),  # whether there is a potential
    ]
)


class Pressure(Stretch):
    """A pressure on the upper or the lower surface of the rod, across it as it deforms, over a stretch of the rod."""

    side: Literal["upper", "lower"]
    """The surface: "upper" is where the directors end, E2 of a straight rod."""
    pressure: Annotated[float, Quantity("Pa", "p")]
    """Pressure into the body; a negative one pulls."""

    @classmethod
    def potential(cls, loads: Sequence[Self], body: LoadedRod) -> Potential:
        """The forces, or their potential where the ends of the surface are held."""
        edges = np.concatenate([np.zeros(0, _EDGE), *(load._edges(body) for load in loads)])
        conserves = all(load._conserves(body) for load in loads)
        edges["conserves"] = conserves
        return Potential(
            _push,
            edges,
            ("pressure",),
            half_bandwidth=body.rod.kinematics.per_vertex + 3,
            symmetric=conserves,
            origin=body.origin,
            sizes=("load",),
        )

    def _edges(self, body: LoadedRod) -> NDArray[np.void]:
        """The loaded edges."""
        geometry, rod = body.geometry, body.rod
        arc, (start, end) = geometry.arc_length, self.ends(rod)
        a, b = (np.clip((place - arc[:-1]) / np.diff(arc), 0.0, 1.0) for place in (start, end))
        loaded = np.flatnonzero(b > a)
        width = rod.width * scale_at(rod.stations, "width", (arc[:-1] + arc[1:]) / 2, before=False)
        reach = 1.0 if self.side == "upper" else -rod.below
        surface = geometry.X + reach * geometry.D
        first, second = surface[:-1], surface[1:]
        edges = np.zeros(loaded.size, _EDGE)
        into = self.pressure if self.side == "upper" else -self.pressure
        edges["load"] = (into * width * (b - a))[loaded]
        edges["middle"] = ((a + b) / 2)[loaded]
        edges["reach"] = reach
        edges["swept"] = (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])[loaded] / 2
        edges["from3"][0], edges["from2"][0] = first[loaded[0]]
        edges["to3"][-1], edges["to2"][-1] = second[loaded[-1]]
        edges["dof"] = rod.kinematics.per_vertex * loaded
        edges["next"] = rod.kinematics.per_vertex * (loaded + 1)
        return edges

    def _conserves(self, body: LoadedRod) -> bool:
        """Whether the ends of its surface have one free component, it covers whole edges, and these have one width."""
        arc, (start, end) = body.geometry.arc_length, self.ends(body.rod)
        near = [int(np.abs(arc - place).argmin()) for place in (start, end)]
        whole = bool(np.allclose(arc[near], [start, end], rtol=0, atol=1e-9 * arc[-1]))
        one_width = all(station.width == body.rod.stations[0].width for station in body.rod.stations)
        return whole and one_width and bool(body.held_components[near].any(axis=1).all())


@njit(cache=True)
def _push(
    q: Vector,
    after: Vector,
    data: NDArray[np.uint8],
    history: Vector,
    strains: Array,
    task: int,
    gradient: Vector,
    band: Band,
    skew: Band,
    terms: Array,
) -> float:
    """Minus the forces as a gradient; arguments as in `solvers.potential.KERNEL`."""
    edges = data.view(_EDGE)
    ends = after if after.size > 0 else q
    if task == COMMIT:
        return 0.0
    terms[0] = 0.0
    for k in range(edges.size):
        p, r, m = edges[k].load, edges[k].reach, edges[k].middle
        x, y = edges[k].dof, edges[k].next
        if edges[k].conserves:
            s0, s1 = ends[x] + r * ends[x + 2], ends[x + 1] + r * ends[x + 3]
            t0, t1 = ends[y] + r * ends[y + 2], ends[y + 1] + r * ends[y + 3]
            closing = edges[k].from3 * s1 - edges[k].from2 * s0 + t0 * edges[k].to2 - t1 * edges[k].to3
            terms[0] -= p * ((s0 * t1 - s1 * t0 + closing) / 2 - edges[k].swept)
        if task in (GRADIENT, HESSIAN):
            f0 = p * (q[y + 1] + r * q[y + 3] - q[x + 1] - r * q[x + 3])
            f1 = -p * (q[y] + r * q[y + 2] - q[x] - r * q[x + 2])
            for vertex, share in ((x, 1 - m), (y, m)):
                gradient[vertex] -= share * f0
                gradient[vertex + 1] -= share * f1
                gradient[vertex + 2] -= r * share * f0
                gradient[vertex + 3] -= r * share * f1
        if task == HESSIAN:
            _tangent(p, r, m, x, y, band, skew)
    energy: float = terms[0]
    return energy


@njit(cache=True)
def _tangent(p: float, r: float, m: float, x: int, y: int, band: Band, skew: Band) -> None:
    """Add the tangent of one edge; Q couples each component with the other one, with opposite signs."""
    for i in range(4):
        for j in range(4):
            if (i - j) % 2 == 0:
                continue
            factor = p * (r if i > 1 else 1.0) * (r if j > 1 else 1.0) * (1.0 if i % 2 == 0 else -1.0)
            band[x + i, y + j - x - i] -= factor / 2
            if skew.size > 0:
                skew[x + i, y + j - x - i] -= factor * (m - 0.5)
                if i < j:
                    skew[x + i, j - i] -= factor * (1 - m)
                    skew[y + i, j - i] += factor * m
