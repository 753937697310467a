"""Symmetric bands that may be indefinite: their solution and their softest motion."""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dgbtrf, dgbtrs

from cosserat.solvers.banded import NO_BAND, Band, Mask, Vector, solve_positive

_DIAGONAL_SHIFTS = tuple(2.0**k for k in range(-40, 12))  # of the largest diagonal entry, in turn


def solve_any(band: Band, right: Vector, skew: Band = NO_BAND) -> tuple[Vector | None, float]:
    """Solve with a symmetric band that need not be positive, for one or, as columns, several right-hand sides.

    skew : the part below the diagonal of a skew-symmetric matrix to be added; without rows there is none.
    Returns the solution and the sign of the determinant; None and zero where the matrix is singular.
    """
    n, width = band.shape[0], band.shape[1] - 1
    general = np.zeros((3 * width + 1, n), order="F")
    for k in range(min(width, n - 1) + 1):
        general[2 * width + k, : n - k] = band[: n - k, k]
        general[2 * width - k, k:] = band[: n - k, k]
        if skew.size and k > 0:
            general[2 * width + k, : n - k] += skew[: n - k, k]
            general[2 * width - k, k:] -= skew[: n - k, k]
    factors, pivots, info = dgbtrf(general, width, width, overwrite_ab=1)
    if info != 0:
        return None, 0.0
    x, _ = dgbtrs(factors, width, width, right, pivots)
    exchanges = np.count_nonzero(pivots != np.arange(n))
    sign = (-1.0) ** exchanges * float(np.prod(np.sign(factors[2 * width])))
    return np.asarray(x), sign


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
    for _ in range(50):
        found = solve_positive(trial, x)
        assert found is not None
        x = np.where(constrained, 0.0, found / np.abs(found).max())
    return x
