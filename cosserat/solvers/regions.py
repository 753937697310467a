"""Boundary value problems on regions: (w u')' = f(u), another f in each, u and w u' continuous, u' = 0 at the ends.

Spectral elements give a banded system, and Newton's method solves it.  If f in a region also depends on the value at
one other node, Woodbury's formula adds one column to the banded matrix.  Meaning and number of the components of u are
free.  The weight w is one unless it is given.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Protocol

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.linalg.lapack import dgbtrf, dgbtrs

from cosserat.errors import NotConvergedError
from cosserat.parameters import Count, Parameters, Quantity
from cosserat.solvers.elements import Mesh, rule
from cosserat.solvers.heartbeat import beat

Array = NDArray[np.float64]

_MIN_DAMPING = 2.0**-20  # least fraction of Newton's step


@dataclass(frozen=True)
class Remote:
    """How f in one region depends on u at one node.

    node : index of that node.  column : (M, p + 1, m) change of f with the quantity read there, zero elsewhere.
    row : (m,) change of that quantity with u at the node.
    """

    node: int
    column: Array
    row: Array


@dataclass(frozen=True)
class Source:
    """f and its derivative at the points of every element: (M, p + 1, m) and (M, p + 1, m, m)."""

    value: Array
    derivative: Array
    remote: tuple[Remote, ...] = ()


class Equation(Protocol):
    """The equation to solve."""

    def source(self, u: Array) -> Source | None:
        """f at u, shape (M, p + 1, m); None if u is inadmissible."""


class RegionSettings(Parameters):
    """Mesh and effort of the banded solver."""

    elements: Annotated[int, Count(at_least=3, at_most=1000)] = 6
    """Elements on each side of a junction."""
    degree: Annotated[int, Count(at_least=2, at_most=20)] = 8
    """Degree of the polynomials in each element."""
    tolerance: Annotated[float, Quantity("1", at_least=1e-13, below=1e-3)] = 1e-11
    """Largest correction of a converged answer."""
    max_iterations: Annotated[int, Count(at_least=1, at_most=100_000)] = 50
    """Most Newton iterations of an instant."""


@dataclass(frozen=True)
class Solved:
    """u : (nodes, m).  correction : the last one, an estimate of the error of the nonlinear solve."""

    u: Array
    iterations: int
    correction: float


def solve(
    mesh: Mesh,
    equation: Equation,
    start: Array,
    settings: RegionSettings,
    name: str,
    weight: Array | None = None,
) -> Solved:
    """Solve from a first guess at the distinct points, shape (nodes, m); `name` is what an error calls the case.

    weight : (M, p + 1) w at the points of every element, above zero; it may jump between elements.

    Natural monotonicity test: accept a step if the simplified Newton correction decreases (Deuflhard 2011, section
    3.3).

    Raises
    ------
    NotConvergedError : no correction below the tolerance; nothing half-converged is returned.
    """
    u = start
    stiffness = _stiffness(mesh, weight)
    source = equation.source(mesh.split(u))
    if source is None:
        raise _failure(name, "the initial guess is not admissible", 0, np.inf, settings)
    size = np.inf
    for iteration in range(settings.max_iterations):
        system = _Linear(mesh, stiffness, source, u.shape[1])
        step = system.correct(mesh, u, source)
        size = float(np.abs(step).max())
        fraction = 1.0
        while True:
            trial = u + fraction * step
            found = equation.source(mesh.split(trial))
            if found is not None:
                left = float(np.abs(system.correct(mesh, trial, found)).max())
                if left <= max((1 - fraction / 4) * size, settings.tolerance):
                    break
            fraction /= 2
            if fraction < _MIN_DAMPING:
                raise _failure(name, "no shorter step reduces the residual", iteration, size, settings)
        u, source = trial, found
        beat(0.0, iteration + 1)
        if fraction == 1.0 and min(left, size) <= settings.tolerance:
            return Solved(u, iteration + 1, min(left, size))
    raise _failure(name, "the iterations did not converge", settings.max_iterations, size, settings)


@dataclass(frozen=True)
class Change:
    """How the equation on fixed u changes with J parameters.

    source : (J, M, p + 1, m) of f.  sizes : (J, M) of the lengths of the elements.
    weight : (J, M, p + 1) of w; None where w is one.
    """

    source: Array
    sizes: Array
    weight: Array | None


def moved(
    mesh: Mesh, equation: Equation, u: Array, weight: Array | None, change: Change
) -> Array | None:
    """How a solution u (nodes, m) moves with J parameters, (J, nodes, m); None where the matrix is singular.

    derived: the residual R(u, s) is zero for every s, so du/ds = -R_u^-1 R_s with the matrix R_u of Newton's method.
    The nodes move with the ends of the elements.  With the length h of an element and the stiffness S for the length
    two, d(2/h S) = 2/h (dS - dh/h S) and d(h/2 f) = h/2 (df + dh/h f).
    """
    stiffness, known = _stiffness(mesh, weight), rule(mesh.degree)
    source = equation.source(mesh.split(u))
    assert source is not None  # u is a solution
    system = _Linear(mesh, stiffness, source, u.shape[1])
    if system.singular:
        return None
    residuals = np.zeros((len(change.source), *u.shape))
    for j, residual in enumerate(residuals):
        relative = (change.sizes[j] / mesh.sizes)[:, None, None]
        stiffer = -relative * stiffness
        if change.weight is not None:
            stiffer += _stiffness(mesh, change.weight[j])
        stronger = change.source[j] + relative * source.value
        _residual(residual, u, stronger, stiffer, known.weights, mesh.sizes)
    right = residuals.reshape(len(residuals), -1).T
    return -system.solve(right).T.reshape(residuals.shape)


def _failure(
    name: str, reason: str, iterations: int, size: float, settings: RegionSettings
) -> NotConvergedError:
    return NotConvergedError(
        f"{name}: no solution on the regions found: {reason} (iteration {iterations}, last correction {size:.3g}, "
        f"allowed {settings.tolerance:.3g}); try weaker loads, longer regions or another 'mesh.elements'",
        iterations=iterations,
        residual=size,
        tolerance=settings.tolerance,
    )


def _stiffness(mesh: Mesh, weight: Array | None) -> Array:
    """Integrals of w u' v' over every element, for the length two, shape (M, p + 1, p + 1)."""
    known = rule(mesh.degree)
    if weight is None:
        one = known.derivative.T @ (known.weights[:, None] * known.derivative)
        return np.repeat(one[None], mesh.region.size, axis=0)
    weighted = (weight * known.weights)[:, :, None] * known.derivative
    result: Array = known.derivative.T @ weighted
    return result


class _Linear:
    """The factorised matrix of one Newton step."""

    def __init__(self, mesh: Mesh, stiffness: Array, source: Source, m: int) -> None:
        known = rule(mesh.degree)
        self.stiffness = stiffness
        self.width = (mesh.degree + 1) * m - 1
        band = np.zeros((mesh.nodes * m, 3 * self.width + 1))
        _fill(band, self.stiffness, known.weights, mesh.sizes, source.derivative)
        self.factors, self.pivots, info = dgbtrf(band.T, self.width, self.width, overwrite_ab=1)
        self.singular = info != 0
        self.remote = source.remote
        if self.remote:
            self.columns = np.column_stack(
                [self._substitute(self._load(mesh, r.column).ravel()) for r in self.remote]
            )
            self.rows = np.zeros((len(self.remote), mesh.nodes * m))
            for row, r in zip(self.rows, self.remote, strict=True):
                row[r.node * m : (r.node + 1) * m] = r.row
            self.small = np.eye(len(self.remote)) + self.rows @ self.columns

    def correct(self, mesh: Mesh, u: Array, source: Source) -> Array:
        """Newton's correction, shape (nodes, m); infinite where the matrix is singular."""
        if self.singular:
            return np.full_like(u, np.inf)
        residual = np.zeros_like(u)
        _residual(residual, u, source.value, self.stiffness, rule(mesh.degree).weights, mesh.sizes)
        correction: Array = -self.solve(residual.ravel()).reshape(u.shape)
        return correction

    def solve(self, right: Array) -> Array:
        """The solution for one right-hand side (n,), or for some of them (n, J)."""
        x = self._substitute(right)
        if self.remote:
            x -= self.columns @ np.linalg.solve(self.small, self.rows @ x)
        return x

    def _load(self, mesh: Mesh, f: Array) -> Array:
        load = np.zeros((mesh.nodes, f.shape[2]))
        _residual(load, load.copy(), f, self.stiffness, rule(mesh.degree).weights, mesh.sizes)
        return load

    def _substitute(self, right: Array) -> Array:
        x, _ = dgbtrs(self.factors, self.width, self.width, right, self.pivots)
        return np.asarray(x)


@njit(cache=True)
def _residual(
    residual: Array, u: Array, f: Array, stiffness: Array, weights: Array, sizes: Array
) -> None:
    """Add the integrals of w u' v' + f v for the polynomial v of each node, by Gauss-Lobatto quadrature."""
    elements, points, m = f.shape
    for e in range(elements):
        first = e * (points - 1)
        for a in range(points):
            for c in range(m):
                total = 0.0
                for b in range(points):
                    total += stiffness[e, a, b] * (
                        u[first + b, c] - u[first + a, c]
                    )  # its rows sum to zero
                load = sizes[e] / 2 * weights[a] * f[e, a, c]
                residual[first + a, c] += 2 / sizes[e] * total + load


@njit(cache=True)
def _fill(band: Array, stiffness: Array, weights: Array, sizes: Array, derivative: Array) -> None:
    """Add stiffness and source derivative; band[j, 2 w + i - j] = matrix[i, j] with the half bandwidth w."""
    elements, points, m, _ = derivative.shape
    w = points * m - 1
    for e in range(elements):
        first = e * (points - 1) * m
        for a in range(points):
            for b in range(points):
                k = 2 / sizes[e] * stiffness[e, a, b]
                for c in range(m):
                    i, j = first + a * m + c, first + b * m + c
                    band[j, 2 * w + i - j] += k
            for c in range(m):
                for d in range(m):
                    i, j = first + a * m + c, first + a * m + d
                    band[j, 2 * w + i - j] += sizes[e] / 2 * weights[a] * derivative[e, a, c, d]
