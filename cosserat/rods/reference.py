"""The discrete planar directed rod: its reference geometry and lumped properties, sections 3.3 and 3.4.

Components in the plane of motion are in the order (E3, E2): along the straight rod, then up.  A positive angle
rotates E3 towards E2, the sign of eqs. (3.3.18) and (3.3.26).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.kinematics import lengths

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Lumped:
    """Section and material averaged over the parts round the vertices or over the edges, Table 3.1.

    area [m^2], second_moment [m^4], young [Pa], shear [Pa], poisson [1]: arrays of shape (N,) for vertices, (N - 1,)
    for edges.
    """

    area: Array
    second_moment: Array
    young: Array
    shear: Array
    poisson: Array

    @classmethod
    def uniform(
        cls, count: int, *, area: float, second_moment: float, young: float, poisson: float
    ) -> Lumped:
        """The same isotropic section at every one of `count` vertices or edges."""
        shear = young / (2 * (1 + poisson))
        return cls(*(np.full(count, value) for value in (area, second_moment, young, shear, poisson)))


@dataclass(frozen=True)
class Geometry:
    """A reference configuration.

    X : (N, 2) centreline vertices [m].  D : (N, 2) directors, from the centreline to the lateral surface [m].
    Axes before these are of several rods, here and in all that follows.
    """

    X: Array
    D: Array

    @classmethod
    def straight(cls, arc: Array, director_length: float | Array) -> Geometry:
        """A straight rod along E3 from the origin, eq. (3.3.1), its directors along E2.

        arc : (..., N) arc length of the vertices [m].
        """
        X, D = np.zeros((*arc.shape, 2)), np.zeros((*arc.shape, 2))
        X[..., 0] = arc
        D[..., 1] = director_length
        return cls(X, D)

    @classmethod
    def arc(
        cls,
        arc: Array,
        director_length: Array,
        curvature: float | Array,
        origin: Array | None = None,
        angle: float = 0.0,
        true_normals: bool = False,
    ) -> Geometry:
        """A rod bent into an arc from E3 towards E2, or into several, its directors along b, eq. (3.3.25).

        arc : (N,) arc length of the vertices along the polygon, which lie on a circle [m].
        true_normals : the directors are normal to the arcs; if not, to the vertex tangents, which at the ends are
        edges, half a turn off the arc (3.3.9).  Between equal edges both are the same.
        curvature : of every edge, or one for all [1/m].  origin : (2,) [m], zero by default, and angle [rad]: where
        and in which direction from E3 the arc begins.
        """
        edge = np.diff(arc)
        turn = 2 * np.arcsin(curvature * edge / 2)
        angles = angle + np.cumsum(turn) - turn / 2
        steps = edge[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
        X = np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])
        X = X if origin is None else X + origin
        if not true_normals:
            return cls(X, director_length[:, None] * normals(X))
        at_vertices = angle + np.concatenate([[0.0], np.cumsum(turn)])
        across = np.column_stack([-np.sin(at_vertices), np.cos(at_vertices)])
        return cls(X, director_length[:, None] * across)

    @cached_property
    def q(self) -> Array:
        """The DOFs of the reference configuration, shape (4 N,) [m]."""
        both = np.concatenate([self.X, self.D], axis=-1)
        dofs: Array = both.reshape(*both.shape[:-2], -1)
        return dofs

    @cached_property
    def edge_length(self) -> Array:
        """||E||, shape (N - 1,) [m], eq. (3.3.4)."""
        return lengths(np.diff(self.X, axis=-2))

    @cached_property
    def director_length(self) -> Array:
        """||D||, shape (N,) [m]."""
        return lengths(self.D)

    @cached_property
    def voronoi_length(self) -> Array:
        """Reference length of the part round each vertex, shape (N,) [m], eqs. (3.3.10)-(3.3.11)."""
        return to_vertices(self.edge_length)

    @cached_property
    def arc_length(self) -> Array:
        """Reference arc length of each vertex, shape (N,) [m]."""
        edges = self.edge_length
        along = np.zeros((*edges.shape[:-1], edges.shape[-1] + 1))
        np.cumsum(edges, axis=-1, out=along[..., 1:])
        return along


def to_vertices(edge_lengths: Array) -> Array:
    """Voronoi lengths of a polygon from its edge lengths: (N - 1,) -> (N,), eqs. (3.3.10)-(3.3.14).

    They add up to the length of the polygon, eq. (3.3.12).
    """
    vertex = np.zeros((*edge_lengths.shape[:-1], edge_lengths.shape[-1] + 1))
    vertex[..., :-1] += edge_lengths / 2
    vertex[..., 1:] += edge_lengths / 2
    return vertex


@dataclass(frozen=True)
class Strains:
    """The strain measures of section 3.3 in one configuration.

    mu_edge : (N - 1,) stretch of the edges, eq. (3.3.19).  mu : (N,) of the vertices, eq. (3.3.20).
    lam : (N,) stretch of the sections, eq. (3.3.21).
    phi : (N,) turning angle [rad], eqs. (3.3.15)-(3.3.18).
    kappa : (N,) curvature [1/m], eq. (3.3.23), one over the radius of eq. (3.3.22).
    theta : (N,) shear angle [rad], eqs. (3.3.24)-(3.3.26).
    """

    mu_edge: Array
    mu: Array
    lam: Array
    phi: Array
    kappa: Array
    theta: Array


def strains(geometry: Geometry, x: Array, d: Array) -> Strains:
    """Measure a configuration x, d, each of shape (N, 2) [m]."""
    e = np.diff(x, axis=-2)
    length = lengths(e)
    tangent = vertex_tangents(x)
    voronoi = to_vertices(length)
    # between edges, whose angle is that of their unit tangents (3.3.5); at the ends between the tangents of the
    # vertices, eqs. (3.3.16)-(3.3.17)
    before = np.concatenate([tangent[..., :1, :], e], axis=-2)
    after = np.concatenate([e, tangent[..., -1:, :]], axis=-2)
    after[..., 0, :], before[..., -1, :] = tangent[..., 1, :], tangent[..., -2, :]
    phi = signed_angle(before, after)
    return Strains(
        mu_edge=length / geometry.edge_length,
        mu=voronoi / geometry.voronoi_length,
        lam=lengths(d) / geometry.director_length,
        phi=phi,
        kappa=2 / voronoi * np.tan(phi / 2),
        theta=signed_angle(_across(tangent), d),
    )


class StrainRates:
    """Rates of the measures of configurations that move with parameters, each (..., N) or (..., N - 1).

    now : the measures.  vectors, rates : x and d, each (..., N, 2), and their rates [m].
    longer, taller : rates of all edges and of all directors of the reference, as fractions of them, each (...).
    """

    def __init__(
        self,
        geometry: Geometry,
        now: Strains,
        vectors: tuple[Array, Array],
        rates: tuple[Array, Array],
        scaled: tuple[Array, Array],
    ) -> None:
        self.geometry, self.now = geometry, now
        (self.x, self.d), (self.dx, self.dd) = vectors, rates
        self.longer, self.taller = (rate[..., None] for rate in scaled)

    @cached_property
    def _edges(self) -> tuple[Array, Array]:
        return np.diff(self.x, axis=-2), np.diff(self.dx, axis=-2)

    @cached_property
    def _length(self) -> Array:
        return _along(*self._edges) / lengths(self._edges[0])

    @property
    def mu_edge(self) -> Array:
        """Of the stretch of the edges."""
        return self._length / self.geometry.edge_length - self.longer * self.now.mu_edge

    @property
    def mu(self) -> Array:
        """Of the stretch of the vertices."""
        return to_vertices(self._length) / self.geometry.voronoi_length - self.longer * self.now.mu

    @property
    def lam(self) -> Array:
        """Of the stretch of the sections."""
        size = _along(self.d, self.dd) / lengths(self.d)
        return size / self.geometry.director_length - self.taller * self.now.lam

    @cached_property
    def phi(self) -> Array:
        """Of the turning angles [rad]."""
        turning, tangents = _turning(*self._edges), _turning(_chords(self.x), _chords(self.dx))
        before = np.concatenate([tangents[..., :1], turning], axis=-1)
        after = np.concatenate([turning, tangents[..., -1:]], axis=-1)
        after[..., 0], before[..., -1] = tangents[..., 1], tangents[..., -2]
        change: Array = after - before
        return change

    @property
    def kappa(self) -> Array:
        """Of the curvature [1/m]: kappa = 2 / L tan(phi / 2), L the length round the vertex."""
        voronoi = self.now.mu * self.geometry.voronoi_length
        across = 1 / (np.cos(self.now.phi / 2) ** 2 * voronoi)
        rate: Array = self.phi * across - to_vertices(self._length) * (self.now.kappa / voronoi)
        return rate


def _along(a: Array, b: Array) -> Array:
    """Products of vectors (..., 2)."""
    product: Array = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]
    return product


def _turning(vectors: Array, rates: Array) -> Array:
    """Rates of the angles of vectors (..., 2) [rad]."""
    across = vectors[..., 0] * rates[..., 1] - vectors[..., 1] * rates[..., 0]
    turning: Array = across / _along(vectors, vectors)
    return turning


def vertex_tangents(x: Array) -> Array:
    """Unit tangents at the vertices, shape (N, 2), eqs. (3.3.7), (3.3.8), (3.3.9)."""
    chord = _chords(x)
    return chord / lengths(chord)[..., None]


def _chords(x: Array) -> Array:
    """From the vertex before to the one after each vertex, (..., N, 2) [m]; at the ends, the edge."""
    chord = np.empty_like(x)
    chord[..., 1:-1, :] = x[..., 2:, :] - x[..., :-2, :]
    chord[..., 0, :] = x[..., 1, :] - x[..., 0, :]
    chord[..., -1, :] = x[..., -1, :] - x[..., -2, :]
    return chord


def normals(x: Array) -> Array:
    """Unit normals b = t x E1 at the vertices, shape (N, 2), eq. (3.3.25)."""
    return _across(vertex_tangents(x))


def _across(tangents: Array) -> Array:
    """t x E1 of tangents (N, 2)."""
    return np.stack([-tangents[..., 1], tangents[..., 0]], axis=-1)


def signed_angle(a: Array, b: Array) -> Array:
    """Angle from a to b, positive from E3 towards E2: rows of (n, 2) arrays -> (n,) [rad]."""
    across = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    angle: Array = np.arctan2(across, a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1])
    return angle


def unwrapped_angles(d: Array) -> Array:
    """Polar angles of directors (N, 2), each within half a turn of the vertex before: (N,) [rad]."""
    first = np.arctan2(d[..., :1, 1], d[..., :1, 0])
    turns = np.concatenate([first, signed_angle(d[..., :-1, :], d[..., 1:, :])], axis=-1)
    angles: Array = np.cumsum(turns, axis=-1)
    return angles


def edge_shear(e: Array, d: Array) -> Array:
    """Angle of each edge against the normal of the mean of its two unit directors (3.3.6), shape (N - 1,) [rad].

    e : (N - 1, 2) edges [m].  d : (N, 2) directors [m].
    """
    unit = d / lengths(d)[..., None]
    m = unit[..., 1:, :] + unit[..., :-1, :]
    along = e[..., 0] * m[..., 0] + e[..., 1] * m[..., 1]
    angle: Array = np.arctan2(along, e[..., 0] * m[..., 1] - e[..., 1] * m[..., 0])
    return angle
