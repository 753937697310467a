"""Symmetric banded matrices in LAPACK's storage.

A band is an array of shape (n, w + 1): row j holds column j of the lower triangle from the diagonal down,
`band[j, i - j] = H[i, j]`.  Its transpose, taken without a copy, is LAPACK's lower form.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.linalg.lapack import dpbsv

if TYPE_CHECKING:
    from scipy.sparse import dia_array

Vector = NDArray[np.float64]
Band = NDArray[np.float64]
Mask = NDArray[np.bool_]

NO_BAND = np.empty((0, 1))
"""A band without rows, for callers that need none."""


@njit(cache=True)
def uncouple(band: Band, constrained: Mask) -> None:
    """Zero in place the rows and columns of the constrained DOFs of a symmetric or skew-symmetric matrix."""
    n, width = band.shape
    for j in range(n):
        for k in range(1, min(width, n - j)):
            if constrained[j] or constrained[j + k]:
                band[j, k] = 0.0


@njit(cache=True)
def constrain(band: Band, constrained: Mask) -> None:
    """Uncouple the constrained DOFs in place, and make their diagonal positive."""
    for j in range(band.shape[0]):
        if constrained[j]:
            band[j, 0] = abs(band[j, 0]) or 1.0
    uncouple(band, constrained)


@njit(cache=True)
def absolute_product(band: Band, x: Vector) -> Vector:
    """|H| |x|, shape (n,): times the unit round-off it bounds the round-off error of H x."""
    n, width = band.shape
    y = np.zeros(n)
    for j in range(n):
        y[j] += abs(band[j, 0]) * abs(x[j])
        for k in range(1, min(width, n - j)):
            entry = abs(band[j, k])
            y[j + k] += entry * abs(x[j])
            y[j] += entry * abs(x[j + k])
    return y


@njit(cache=True)
def band_product(band: Band, x: Vector) -> Vector:
    """H x, shape (n,)."""
    n, width = band.shape
    y = np.zeros(n)
    for j in range(n):
        y[j] += band[j, 0] * x[j]
        for k in range(1, min(width, n - j)):
            y[j + k] += band[j, k] * x[j]
            y[j] += band[j, k] * x[j + k]
    return y


@njit(cache=True)
def skew_product(skew: Band, x: Vector) -> Vector:
    """A x, shape (n,), of a skew-symmetric matrix whose entries below the diagonal are stored as those of a band."""
    n, width = skew.shape
    y = np.zeros(n)
    for j in range(n):
        for k in range(1, min(width, n - j)):
            y[j + k] += skew[j, k] * x[j]
            y[j] -= skew[j, k] * x[j + k]
    return y


def solve_positive(band: Band, right: Vector) -> Vector | None:
    """Solve H x = right by Cholesky's factorisation; None where H is not positive definite."""
    _, x, info = dpbsv(band.T, right, lower=1)
    return x if info == 0 else None


def to_dense(band: Band) -> NDArray[np.float64]:
    """The full symmetric matrix, shape (n, n): for tests and small eigenproblems."""
    n, width = band.shape
    dense = np.zeros((n, n))
    for k in range(min(width, n)):
        j = np.arange(n - k)
        dense[j + k, j] = dense[j, j + k] = band[: n - k, k]
    return dense


def to_sparse(band: Band, skew: Band = NO_BAND) -> dia_array:
    """The full matrix, sparse, (n, n); skew : as in `skew_product`, without rows there is none."""
    from scipy.sparse import dia_array, tril

    n, width = band.shape
    below = range(min(width, n))
    lower = dia_array((band.T[: len(below)], [-k for k in below]), shape=(n, n)).tocsr()
    full = lower + tril(lower, -1).T
    if not skew.size:
        return full
    lower = dia_array((skew.T[: len(below)], [-k for k in below]), shape=(n, n)).tocsr()
    return full + tril(lower, -1) - tril(lower, -1).T
