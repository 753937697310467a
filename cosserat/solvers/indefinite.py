"""Symmetric bands that may be indefinite: their solution and their softest motion."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.linalg.lapack import dgbtrf, dgbtrs, dpbtrf, dpbtrs

from cosserat.solvers.banded import NO_BAND, Band, Mask, Vector, solve_positive

_DIAGONAL_SHIFTS = tuple(2.0**k for k in range(-40, 12))  # of the largest diagonal entry, in turn


@njit(cache=True)
def _general(band: Band, skew: Band) -> Band:
    """The matrix with room for its factors: its transpose is LAPACK's storage of a general band."""
    n, width = band.shape[0], band.shape[1] - 1
    general = np.zeros((n, 3 * width + 1))
    for j in range(n):
        for k in range(min(width, n - 1 - j) + 1):
            below = skew[j, k] if skew.size and k > 0 else 0.0
            general[j + k, 2 * width - k] = band[j, k] - below
            general[j, 2 * width + k] = band[j, k] + below
    return general


class Factors:
    """The factors of a symmetric band that need not be positive.

    skew : the part below the diagonal of a skew-symmetric matrix to be added; without rows there is none.
    sign : of the determinant; zero where the matrix is singular.
    """

    def __init__(self, band: Band, skew: Band = NO_BAND) -> None:
        self.width = band.shape[1] - 1
        general = _general(band, skew).T
        self.factors, self.pivots, info = dgbtrf(general, self.width, self.width, overwrite_ab=1)
        exchanges = np.count_nonzero(self.pivots != np.arange(band.shape[0]))
        negative = np.count_nonzero(self.factors[2 * self.width] < 0)
        self.sign = 0.0 if info else (-1.0) ** (exchanges + negative)

    @property
    def log(self) -> float:
        """The logarithm of the size of the determinant."""
        with np.errstate(divide="ignore"):
            return float(np.log(np.abs(self.factors[2 * self.width])).sum())

    def solve(self, right: Vector) -> Vector | None:
        """The solution for one or, as columns, several right-hand sides; None where the matrix is singular."""
        if self.sign == 0.0:
            return None
        return np.asarray(dgbtrs(self.factors, self.width, self.width, right, self.pivots)[0])


def _made_positive(band: Band, right: Vector) -> tuple[Band, Vector | None]:
    """The band plus the smallest tried multiple of the unit matrix that makes it positive, and its solution."""
    largest = float(np.abs(band[:, 0]).max()) or 1.0
    trial, step = band.copy(), None
    for shift in _DIAGONAL_SHIFTS:
        trial[:, 0] = band[:, 0] + shift * largest
        step = solve_positive(trial, right)
        if step is not None:
            break
    return trial, step


def shifted(band: Band, right: Vector) -> Vector | None:
    """Solve with the band plus a multiple of the unit matrix that makes it positive."""
    return _made_positive(band, right)[1]


def lowest_eigenvector(band: Band, constrained: Mask) -> Vector:
    """The eigenvector of the smallest eigenvalue, of unit largest component, by inverse iteration with a shift."""
    x = np.where(constrained, 0.0, np.cos(1.7 * np.arange(constrained.size)))
    trial, _ = _made_positive(band, x)
    factor, info = dpbtrf(trial.T, lower=1)
    assert info == 0
    for _ in range(50):
        found, _ = dpbtrs(factor, x, lower=1)
        x = found / np.abs(found).max()
    return x
