"""Checks of resolution: sections that cross, coarse meshes, modes too fast for a step."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.linalg import solve_banded

from cosserat.errors import CrossingError
from cosserat.rods.reference import Geometry
from cosserat.solvers.banded import Band, Mask, Vector, band_product

Array = NDArray[np.float64]

COARSE = 1.0
"""Rotation from one section to the next above which a mesh is coarse [rad]."""
FAST = 1.0
"""Rotation of a section in one step above which a motion is fast [rad]."""
UNRESOLVED = 0.01
"""Fraction of the kinetic energy in unresolved modes above which a warning is given."""
UNBALANCED = 1e-3
"""Error of the energy balance, as a fraction of the energy, above which a warning is given."""
_FILTER_ORDER = 8  # of the filter between resolved and unresolved modes, in squares of the frequency


def surface_stretch(geometry: Geometry, x: Array, d: Array, lower: Array) -> Array:
    """Stretch of the upper and the lower surface between neighbouring sections, shape (..., 2, N - 1).

    x, d : (..., N, 2).  lower : (N,) distance of the lower surface, as a fraction of the director.

    Measured across the mean of the two directors.  derived: the surfaces run between the tips x + d, and between
    x - lower d; two sections meet where one of them has no length, as in the displays after eq. (3.4.11).
    """
    shape = *x.shape[:-2], 2, x.shape[-2] - 1
    stretch = np.empty((x.size // (2 * x.shape[-2]), *shape[-2:]))
    edges, flat = geometry.edge_length.reshape(-1, shape[-1]), (-1, *x.shape[-2:])
    x, d = np.ascontiguousarray(x), np.ascontiguousarray(d)
    _stretch(x.reshape(flat), d.reshape(flat), lower, edges, stretch)
    return stretch.reshape(shape)


@njit(cache=True, error_model="numpy")
def _stretch(x: Array, d: Array, lower: Array, edges: Array, stretch: Array) -> None:
    """Overwrite the stretch of both surfaces, (S, 2, N - 1), for x and d of shape (S, N, 2).

    edges : their lengths, (S, N - 1), or those of all states, (1, N - 1).
    """
    for s in range(x.shape[0]):
        for K in range(x.shape[1] - 1):
            for side in range(2):
                one, two = (1.0, 1.0) if side == 0 else (-lower[K], -lower[K + 1])
                along = _along(x[s], d[s], K, one, two)
                stretch[s, side, K] = along / edges[s % edges.shape[0], K]


@njit(cache=True, error_model="numpy")
def _along(x: Array, d: Array, K: int, one: float, two: float) -> float:
    """Distance of two neighbouring sections at heights of one and two directors, across the mean of these; (N, 2)."""
    u, v, e, f = d[K, 0], d[K, 1], d[K + 1, 0], d[K + 1, 1]
    low, high = np.sqrt(u * u + v * v), np.sqrt(e * e + f * f)
    p, r = e / high + u / low, f / high + v / low
    both = np.sqrt(p * p + r * r)
    p, r = p / both, r / both
    along = x[K + 1, 0] + two * e - (x[K, 0] + one * u)
    across = x[K + 1, 1] + two * f - (x[K, 1] + one * v)
    return float(along * r - across * p)


@njit(cache=True, error_model="numpy")
def _apart(x: Array, d: Array, lower: float) -> bool:
    """Whether no neighbouring sections of a configuration cross."""
    apart = True
    for K in range(x.shape[0] - 1):
        apart &= _along(x, d, K, 1.0, 1.0) > 0 and _along(x, d, K, -lower, -lower) > 0
    return apart


def check_crossing(geometry: Geometry, x: Array, d: Array, lower: float, name: str) -> None:
    """Raise CrossingError if neighbouring sections of a configuration, x and d of shape (N, 2), cross."""
    if _apart(x, d, lower):
        return
    stretch = surface_stretch(geometry, x, d, np.full(x.shape[0], lower))
    surface, edge = np.unravel_index(int(np.argmin(np.nan_to_num(stretch, nan=-np.inf))), stretch.shape)
    side = ("upper", "lower")[int(surface)]
    raise CrossingError(
        f"{name}: the sections of vertices {edge} and {edge + 1} cross at the {side} surface, where the material "
        "would pass through itself; reduce the loads, or take a rod that is thinner or bends less"
    )


def largest_turning(d: Array) -> Array:
    """Largest angle between neighbouring directors of each rod, (..., N, 2) -> (...) [rad]."""
    a, b = d[..., :-1, :], d[..., 1:, :]
    cross = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    dot = a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1]
    largest: Array = np.abs(np.arctan2(cross, dot)).max(axis=-1)
    return largest


def coarse(d: Array) -> list[str]:
    """A warning if the angle between neighbouring sections is large."""
    turning = largest_turning(d).max()
    if turning <= COARSE:
        return []
    return [
        f"coarse mesh: neighbouring sections stand up to {turning:.2g} rad apart; use more 'rod.vertices' where more "
        f"than {COARSE:g} rad lie between two"
    ]


def unresolved_energy(stiffness: Band, mass: Band, constrained: Mask, v: Vector, h: float) -> float:
    """Kinetic energy in modes with omega h > 1 [J], of small motions with a stiffness and a mass.

    derived: with z = (omega h)^2, 1 / (1 + z^n) is the mean of 1 / (1 - z / z_k) over the n roots z_k of -1.  Each
    takes one solution with M - h^2 K / z_k, without modes.  n = 8 separates modes with omega h = 0.7 and 1.4 to 0.4 %.
    """
    free = ~constrained
    moving = np.where(free, v, 0.0)
    momentum = np.where(free, band_product(mass, moving), 0.0)
    width = stiffness.shape[1] - 1
    both = np.zeros((2, 2 * width + 1, v.size))
    for target, band in zip(both, (mass, stiffness), strict=True):
        for k in range(band.shape[1]):
            column = np.where(free[: v.size - k] & free[k:], band[: v.size - k, k], 0.0)
            target[width + k, : v.size - k] = column
            target[width - k, k:] = column
        target[width, constrained] = 1.0
    resolved = 0.0
    for k in range(_FILTER_ORDER // 2):
        root = np.exp(1j * np.pi * (2 * k + 1) / _FILTER_ORDER)
        y = solve_banded((width, width), both[0] - h**2 / root * both[1], momentum.astype(complex))
        resolved += 2 / _FILTER_ORDER * float((momentum @ y).real)
    return max(0.0, float(moving @ momentum) - resolved) / 2
