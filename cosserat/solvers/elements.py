"""Spectral elements on a line: polynomials through Gauss-Lobatto points, which are also the quadrature points.

Fields live at the points of every element, arrays of shape (elements, degree + 1, ...); neighbours share an end.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
_FINEST_SPAN = 6.0  # shortest decay lengths that `per_side` elements of the finest size span
_AT_POINT = 1e-14  # local coordinates closer to a point than this are there
_SWEEPS = 60  # fixed-point sweeps for the growth of element sizes; the sizes need not be exact


@dataclass(frozen=True)
class Rule:
    """Points and matrices of one element on [-1, 1].

    points, weights : (p + 1,).  derivative : (p + 1, p + 1), values to slopes.  integral : (p + 1, p + 1), values to
    integrals from -1 to each point.  barycentric : (p + 1,) weights of the interpolation formula.
    """

    points: Array
    weights: Array
    derivative: Array
    integral: Array
    barycentric: Array


@functools.cache
def rule(degree: int) -> Rule:
    """The rule of Gauss, Legendre and Lobatto with degree + 1 points (Canuto et al. 2006, section 2.3)."""
    legendre = np.polynomial.legendre.Legendre.basis(degree)
    inner = np.sort(legendre.deriv().roots().real)
    points = np.concatenate([[-1.0], inner, [1.0]])
    weights = 2 / (degree * (degree + 1) * legendre(points) ** 2)
    gaps = points[:, None] - points[None, :] + np.eye(degree + 1)
    barycentric = 1 / gaps.prod(axis=1)
    derivative = barycentric[None, :] / barycentric[:, None] / gaps
    np.fill_diagonal(derivative, 0.0)
    np.fill_diagonal(derivative, -derivative.sum(axis=1))
    coefficients = np.linalg.inv(np.polynomial.legendre.legvander(points, degree))
    antiderivatives = np.polynomial.legendre.legint(coefficients, lbnd=-1, axis=0)
    integral = np.polynomial.legendre.legval(points, antiderivatives).T
    return Rule(points, weights, derivative, integral, barycentric)


@dataclass(frozen=True)
class Mesh:
    """Elements over consecutive regions.

    ends : (M + 1,) ends of the elements, increasing.  region : (M,) the region that each element lies in.
    """

    ends: Array
    region: NDArray[np.int64]
    degree: int

    @functools.cached_property
    def sizes(self) -> Array:
        """Lengths of the elements, shape (M,)."""
        sizes: Array = self.ends[1:] - self.ends[:-1]
        return sizes

    @functools.cached_property
    def places(self) -> Array:
        """Coordinates of the points, shape (M, p + 1)."""
        within: Array = self.sizes[:, None] * (rule(self.degree).points + 1) / 2
        return self.ends[:-1, None] + within

    @property
    def nodes(self) -> int:
        """Number of distinct points."""
        return self.region.size * self.degree + 1

    def split(self, nodal: Array) -> Array:
        """Values at distinct points, shape (nodes, ...), as values at the points of every element."""
        shape = self.region.size, self.degree + 1, *nodal.shape[1:]
        split: Array = _split(nodal.reshape(nodal.shape[0], -1), self.degree).reshape(shape)
        return split

    def slope(self, values: Array) -> Array:
        """Derivative of a field (M, p + 1, ...), element by element."""
        columns = values.reshape(*values.shape[:2], -1)
        slopes: Array = _slopes(columns, rule(self.degree).derivative, self.sizes).reshape(values.shape)
        return slopes

    def cumulative(self, values: Array) -> Array:
        """Integral of a field (M, p + 1) from the left end of the line to each point."""
        inside = values @ rule(self.degree).integral.T * (self.sizes / 2)[:, None]
        before = np.concatenate([[0.0], np.cumsum(inside[:-1, -1])])
        total: Array = inside + before[:, None]
        return total

    def interpolate(self, values: Array, at: Array) -> Array:
        """A field (M, p + 1, ...) at given coordinates, shape (len(at), ...)."""
        known, columns = rule(self.degree), values.reshape(*values.shape[:2], -1)
        found = _interpolated(columns, at, self.ends, known.points, known.barycentric)
        interpolated: Array = found.reshape(at.size, *values.shape[2:])
        return interpolated


@njit(cache=True, nogil=True)
def _split(nodal: Array, degree: int) -> Array:
    elements, components = (nodal.shape[0] - 1) // degree, nodal.shape[1]
    values = np.empty((elements, degree + 1, components))
    for e in range(elements):
        for a in range(degree + 1):
            for c in range(components):
                values[e, a, c] = nodal[e * degree + a, c]
    return values


@njit(cache=True, nogil=True)
def _slopes(values: Array, derivative: Array, sizes: Array) -> Array:
    """Derivative at the points of every element, shape (M, p + 1, m) like the values."""
    elements, points, components = values.shape
    slopes = np.zeros((elements, points, components))
    for e in range(elements):
        for a in range(points):
            for c in range(components):
                total = 0.0
                for b in range(points):
                    total += derivative[a, b] * values[e, b, c]
                slopes[e, a, c] = total * (2 / sizes[e])
    return slopes


@njit(cache=True, nogil=True)
def _interpolated(values: Array, at: Array, ends: Array, points: Array, barycentric: Array) -> Array:
    """Values (M, p + 1, m) at coordinates, shape (K, m), by the barycentric formula."""
    last, components = values.shape[0] - 1, values.shape[2]
    found = np.zeros((at.size, components))
    weights = np.empty(points.size)
    for k in range(at.size):
        e = min(max(np.searchsorted(ends, at[k], side="right") - 1, 0), last)
        local = 2 * (at[k] - ends[e]) / (ends[e + 1] - ends[e]) - 1
        total = 0.0
        for a in range(points.size):
            gap = local - points[a]
            if abs(gap) < _AT_POINT:
                weights[:] = 0.0
                weights[a] = total = 1.0
                break
            weights[a] = barycentric[a] / gap
            total += weights[a]
        for a in range(points.size):
            for c in range(components):
                found[k, c] += weights[a] / total * values[e, a, c]
    return found


def graded(
    edges: Sequence[float], layer: float, per_side: int, degree: int, *, fine_ends: bool = False
) -> Mesh:
    """A mesh over the regions between `edges`, fine where two of them meet, and at both ends if `fine_ends`.

    Element sizes grow geometrically from a fine edge to the middle of the region (or its free end), with `per_side`
    elements on each side, the first of length _FINEST_SPAN / per_side times `layer`.  A region too short for that is
    divided evenly.  The number of elements depends only on the number of regions, so a solution on one mesh is a first
    guess on the next.
    """
    ends, region = _graded(np.array(edges), _FINEST_SPAN * layer / per_side, per_side, fine_ends)
    return Mesh(ends, region, degree)


@njit(cache=True, nogil=True)
def _graded(
    edges: Array, first: float, per_side: int, fine_ends: bool
) -> tuple[Array, NDArray[np.int64]]:
    """Ends of the elements, and the region of each."""
    regions, count = edges.size - 1, 0
    cuts = np.empty(2 * per_side * regions + 1)
    region = np.empty(2 * per_side * regions, dtype=np.int64)
    cuts[0] = edges[0]
    for number in range(regions):
        left, right, before = edges[number], edges[number + 1], count
        fine_left = number > 0 or fine_ends
        fine_right = number < regions - 1 or fine_ends or regions == 1
        both = fine_left and fine_right
        places = _geometric((right - left) / 2 if both else right - left, first, per_side)
        if fine_left:
            for k in range(1, per_side + 1):
                cuts[count + k] = left + places[k]
            count += per_side
        if fine_right:
            for k in range(1, per_side + 1):
                cuts[count + k] = right - places[per_side - k]
            count += per_side
        cuts[count] = right
        region[before:count] = number
    return cuts[: count + 1].copy(), region[:count].copy()


@njit(cache=True, nogil=True)
def _geometric(length: float, first: float, count: int) -> Array:
    """Ends of `count` elements on [0, length] that grow from `first` by a constant factor."""
    if count * first >= length:
        return np.arange(count + 1.0) * (length / count)
    growth = 2.0
    for _ in range(_SWEEPS):
        growth = (1 + length / first * (growth - 1)) ** (1 / count)
    ends = np.empty(count + 1)
    for k in range(count + 1):
        ends[k] = (growth ** float(k) - 1) / (growth ** float(count) - 1) * length
    return ends
