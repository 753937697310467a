"""Symmetric bands that may be indefinite: their solution, and their softest motions."""

from __future__ import annotations

import numpy as np

from cosserat.solvers.banded import NO_BAND, Band, Mask, Vector
from cosserat.solvers.climb import (
    decompose,
    iterate_inverse,
    log_of_pivots,
    lowest_motion,
    negative_pivots,
    resolve,
)


class Factors:
    """The factors of a symmetric band that need not be positive.

    skew : the part below the diagonal of a skew-symmetric matrix to be added; without rows there is none.
    sign : of the determinant; zero where the matrix is singular.
    """

    def __init__(self, band: Band, skew: Band = NO_BAND) -> None:
        n, width = band.shape
        self.factors, self.pivots = np.empty((n, 3 * width - 2)), np.empty(n, dtype=np.int64)
        self.sign = decompose(band, skew, np.zeros(n, dtype=np.bool_), self.factors, self.pivots)

    @property
    def log(self) -> float:
        """The logarithm of the size of the determinant."""
        return float(log_of_pivots(self.factors))

    def solve(self, right: Vector) -> Vector | None:
        """The solution for one or, as columns, several right-hand sides; None where the matrix is singular."""
        if self.sign == 0.0:
            return None
        columns = np.array(right.T, dtype=float, ndmin=2, order="C")
        for column in columns:
            resolve(self.factors, self.pivots, column)
        return columns.T.reshape(right.shape)

    def softest(self, start: Vector) -> tuple[float, Vector] | None:
        """The eigenvalue nearest zero and its vector of unit length; None where the matrix is singular."""
        if self.sign == 0.0:
            return None
        x = start.copy()
        return iterate_inverse(self.factors, self.pivots, x), x


def negative_eigenvalues(band: Band) -> int:
    """How many eigenvalues are negative."""
    n, width = band.shape
    work = np.zeros((n + width, width))
    work[:n] = band
    return int(negative_pivots(work, n))


def lowest_eigenvector(band: Band, constrained: Mask) -> Vector:
    """The eigenvector of the smallest eigenvalue, of unit largest component, by inverse iteration with a shift."""
    x = np.where(constrained, 0.0, np.cos(1.7 * np.arange(constrained.size)))
    lowest_motion(band, x)
    return x
