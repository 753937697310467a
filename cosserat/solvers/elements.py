"""Spectral elements on a line: polynomials through Gauss-Lobatto points, which are also the quadrature points.

Fields live at the points of every element, arrays of shape (elements, degree + 1, ...); neighbours share an end.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_FINEST_SPAN = 6.0  # shortest decay lengths that `per_side` elements of the finest size span
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
        return np.diff(self.ends)

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
        local = np.arange(self.region.size)[:, None] * self.degree + np.arange(self.degree + 1)
        values: Array = nodal[local]
        return values

    def slope(self, values: Array) -> Array:
        """Derivative of a field (M, p + 1, ...), element by element."""
        by_point = np.einsum("ij,ej...->ei...", rule(self.degree).derivative, values)
        scale = (2 / self.sizes).reshape(-1, *[1] * (values.ndim - 1))
        slopes: Array = by_point * scale
        return slopes

    def cumulative(self, values: Array) -> Array:
        """Integral of a field (M, p + 1) from the left end of the line to each point."""
        inside = values @ rule(self.degree).integral.T * (self.sizes / 2)[:, None]
        before = np.concatenate([[0.0], np.cumsum(inside[:-1, -1])])
        total: Array = inside + before[:, None]
        return total

    def interpolate(self, values: Array, at: Array) -> Array:
        """A field (M, p + 1, ...) at given coordinates, shape (len(at), ...)."""
        element, weights = self._weights(at)
        shape = values.shape[2:]
        inside = values[element].reshape(at.size, self.degree + 1, -1)
        result: Array = (weights[:, None, :] @ inside)[:, 0].reshape(at.size, *shape)
        return result

    def _weights(self, at: Array) -> tuple[NDArray[np.int64], Array]:
        """The element of each coordinate and its nodal polynomials there, shape (len(at), p + 1)."""
        element = np.clip(np.searchsorted(self.ends, at, side="right") - 1, 0, self.region.size - 1)
        local = 2 * (at - self.ends[element]) / self.sizes[element] - 1
        known = rule(self.degree)
        gaps = local[:, None] - known.points
        hit = np.abs(gaps) < 1e-14
        weights = known.barycentric / np.where(hit, 1.0, gaps)
        weights = np.where(hit.any(axis=1, keepdims=True), hit, weights)
        return element, weights / weights.sum(axis=1, keepdims=True)


def graded(
    edges: Sequence[float], layer: float, per_side: int, degree: int, *, fine_ends: bool = False
) -> Mesh:
    """A mesh over the regions between `edges`, fine where two of them meet, and at both ends if `fine_ends`.

    Element sizes grow geometrically from a fine edge to the middle of the region (or its free end), with `per_side`
    elements on each side, the first of length _FINEST_SPAN / per_side times `layer`.  A region too short for that is
    divided evenly.  The number of elements depends only on the number of regions, so a solution on one mesh is a first
    guess on the next.
    """
    first = _FINEST_SPAN * layer / per_side
    ends: list[float] = [edges[0]]
    region: list[int] = []
    last = len(edges) - 2
    for number, (left, right) in enumerate(itertools.pairwise(edges)):
        length = right - left
        if number in (0, last) and not fine_ends:
            places = _geometric(length, first, per_side)
            inner = left + places if number == last and last > 0 else right - places[::-1]
        else:
            half = _geometric(length / 2, first, per_side)
            inner = np.concatenate([left + half, right - half[-2::-1]])
        inner[0], inner[-1] = left, right
        ends.extend(inner[1:].tolist())
        region.extend([number] * (inner.size - 1))
    return Mesh(np.array(ends), np.array(region), degree)


def _geometric(length: float, first: float, count: int) -> Array:
    """Ends of `count` elements on [0, length] that grow from `first` by a constant factor."""
    if count * first >= length:
        return np.linspace(0.0, length, count + 1)
    growth = 2.0
    for _ in range(_SWEEPS):
        growth = (1 + length / first * (growth - 1)) ** (1 / count)
    ends: Array = (growth ** np.arange(count + 1.0) - 1) / (growth**count - 1) * length
    return ends
