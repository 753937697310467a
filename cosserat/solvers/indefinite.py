"""Symmetric bands that need not be positive: solving with them, and their softest motion."""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dgbtrf, dgbtrs

from cosserat.solvers.banded import Band, Mask, Vector, solve_positive

_SHIFTS = tuple(2.0**k for k in range(-40, 12))  # shares of the largest diagonal entry, tried in turn


def _factorised(band: Band) -> tuple[Vector, Vector, int]:
    """Factors with row interchanges of a symmetric band."""
    n, width = band.shape[0], band.shape[1] - 1
    general = np.zeros((3 * width + 1, n), order="F")
    for k in range(width + 1):
        general[2 * width + k, : n - k] = band[: n - k, k]
        general[2 * width - k, k:] = band[: n - k, k]
    factors, pivots, info = dgbtrf(general, width, width, overwrite_ab=1)
    return factors, pivots, int(info)


def solve_any(band: Band, right: Vector) -> Vector | None:
    """Solve with a symmetric band that need not be positive; None where it is singular."""
    factors, pivots, info = _factorised(band)
    if info != 0:
        return None
    width = band.shape[1] - 1
    x, _ = dgbtrs(factors, width, width, right, pivots)
    return np.asarray(x)


def shifted(band: Band, right: Vector) -> Vector | None:
    """Solve with the band and as much of the unit matrix as makes it positive."""
    largest = float(np.abs(band[:, 0]).max())
    trial = band.copy()
    for shift in _SHIFTS:
        trial[:, 0] = band[:, 0] + shift * largest
        step = solve_positive(trial, right)
        if step is not None:
            return step
    return None


def softest(band: Band, held: Mask) -> Vector:
    """The eigenvector of the smallest eigenvalue, of unit largest component, by inverse iteration with a shift."""
    largest = float(np.abs(band[:, 0]).max())
    x = np.where(held, 0.0, np.cos(1.7 * np.arange(held.size)))
    trial = band.copy()
    for shift in _SHIFTS:
        trial[:, 0] = band[:, 0] + shift * largest
        if solve_positive(trial, x) is not None:
            break
    for _ in range(50):
        found = solve_positive(trial, x)
        assert found is not None
        x = np.where(held, 0.0, found / np.abs(found).max())
    return x
