"""The compiled equations of a crawler at K points: f, its derivative and mu_3, and the states of long bodies.

`crawler` has the equations, `body` those of a body that varies.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

MOST_PLATEAU_STEPS = 60
"""Newton steps to a homogeneous state."""
PLATEAU_TOLERANCE = 1e-12
"""Largest correction of a converged one."""


@njit(cache=True, nogil=True)
def compressible(
    mu: Array, n: Array, c: Array, g: Array, p: float, m: Array, printed_contact: bool
) -> tuple[Array, Array, Array]:
    """Right-hand sides of eqs. (2.3.6) and (2.3.9) at K points; the push of the ground is that of (2.2.17).

    mu : (K, 2).  n : (K,) contact force over k_S, -d or 0.  c : (K,) advancing load, or 0.  g, m : (K,).
    Returns f (K, 2), its derivative (K, 2, 2) and mu_3 (K,).
    """
    f, df, mu_3 = np.empty((mu.shape[0], 2)), np.empty((mu.shape[0], 2, 2)), np.empty(mu.shape[0])
    for k in range(mu.shape[0]):
        mu_1, mu_2 = mu[k, 0], mu[k, 1]
        mu_3[k] = 1 + n[k] - p * (mu_1 + mu_2 - 2)  # (2.3.5), (2.3.10); erratum E2.1
        contact = m[k] / mu_3[k] if printed_contact else m[k]
        d_contact = m[k] * p / mu_3[k] ** 2 if printed_contact else 0.0
        # k^alpha of (2.3.2) over k_S, mu_3 inserted: keeps digits as nu tends to 1/2
        k_1 = (1 - p) * ((1 + p) * (mu_1 - 1) + p * (mu_2 - 1)) + p * n[k]
        k_2 = (1 - p) * ((1 + p) * (mu_2 - 1) + p * (mu_1 - 1)) + p * n[k]
        f[k, 0] = contact + g[k] * k_1 + c[k]
        f[k, 1] = g[k] * k_2 + c[k]
        df[k, 0, 0] = d_contact + g[k] * (1 - p) * (1 + p)
        df[k, 0, 1] = d_contact + p * g[k] * (1 - p)
        df[k, 1, 0] = p * g[k] * (1 - p)
        df[k, 1, 1] = g[k] * (1 - p) * (1 + p)
    return f, df, mu_3


@njit(cache=True, nogil=True)
def incompressible(
    mu: Array, multiplier: Array, exponent: Array, c: Array, i: Array, m: Array, printed_contact: bool
) -> tuple[Array, Array, Array]:
    """Right-hand sides of eqs. (2.4.10) and (2.4.13) at K points, from the forces (2.4.4).

    mu : (K, 2).  multiplier : (K,) lambda_c, which goes as (mu_1 mu_2)^-exponent.  c : (K,) advancing load, or 0.
    i, m : (K,).
    Returns f (K, 2), its derivative (K, 2, 2) and mu_3 (K,).
    """
    f, df, mu_3 = np.empty((mu.shape[0], 2)), np.empty((mu.shape[0], 2, 2)), np.empty(mu.shape[0])
    for k in range(mu.shape[0]):
        mu_1, mu_2 = mu[k, 0], mu[k, 1]
        lam, s = multiplier[k], exponent[k]
        mu_3[k] = 1 / (mu_1 * mu_2)  # (2.4.1)
        contact = m[k] * mu_1 * mu_2 if printed_contact else m[k]
        f[k, 0] = c[k] + contact + lam / mu_1 + i[k] * (2 * mu_1 + mu_2 - 3)
        f[k, 1] = c[k] + lam / mu_2 + i[k] * (2 * mu_2 + mu_1 - 3)
        df[k, 0, 0] = 2 * i[k] - (1 + s) * lam / (mu_1 * mu_1)
        df[k, 0, 1] = i[k] - s * lam / (mu_1 * mu_2)
        df[k, 1, 0] = i[k] - s * lam / (mu_1 * mu_2)
        df[k, 1, 1] = 2 * i[k] - (1 + s) * lam / (mu_2 * mu_2)
        if printed_contact:
            df[k, 0, 0] += m[k] * mu_2
            df[k, 0, 1] += m[k] * mu_1
    return f, df, mu_3


@njit(cache=True, nogil=True)
def multiplier_of(mu: Array, force: Array, exponent: Array) -> Array:
    """lambda_c (K,), eq. (2.4.7): it goes as (mu_1 mu_2)^-exponent and is `force` where mu_1 mu_2 = 1."""
    multiplier = np.empty(mu.shape[0])
    for k in range(mu.shape[0]):
        volume = mu[k, 0] * mu[k, 1]
        multiplier[k] = force[k] * (1 / volume if exponent[k] == 1.0 else volume ** -exponent[k])
    return multiplier


@njit(cache=True, nogil=True)
def local_terms(
    z: Array,
    span: Ints,
    loads: Array,
    piece: Ints,
    pieces: Array,
    groups: tuple[float, float],
    divided: bool,
) -> Array:
    """The rows of `instant.Local` at K places z, each in the span of that number.

    loads : (3, S) force, pressure and exponent of every span in a body that does not vary.  piece : (S,).
    pieces : of `body.tabulated`.  groups : stiffness, and weight where the radius is that of the body.
    divided : whether the force is over k_S of the place.
    """
    rows = np.empty((7, z.size))
    for k in range(z.size):
        s = span[k]
        left, right = pieces[piece[s], 0], pieces[piece[s], 1]
        rear, front = pieces[piece[s], 2:6], pieces[piece[s], 6:10]
        along = (z[k] - left) / (right - left)
        radius, young = rear[0] + (front[0] - rear[0]) * along, rear[1] + (front[1] - rear[1]) * along
        anchoring, advancing = (
            rear[2] + (front[2] - rear[2]) * along,
            rear[3] + (front[3] - rear[3]) * along,
        )
        stretching = young * radius**2
        force = loads[0, s] * anchoring
        rows[0, k] = force / stretching if divided else force
        rows[1, k] = loads[1, s] * (advancing * radius**2)
        rows[2, k] = loads[2, s]
        rows[3, k] = groups[0] * stretching
        rows[4, k] = groups[1] * radius**3
        rows[5, k] = young * radius**4
        rows[6, k] = radius
    return rows


@njit(cache=True, nogil=True, error_model="numpy")
def homogeneous(
    rows: Array, p: float, keeps_volume: bool, printed_contact: bool
) -> tuple[Array, Array, Array, float]:
    """Stretches of K long bodies, each with the loads and the section of one place; rows : of `local_terms`.

    Returns mu_1, mu_2 (K, 2), mu_3 (K,), the derivative of f (K, 2, 2), and the last correction, which is not below
    PLATEAU_TOLERANCE if MOST_PLATEAU_STEPS were too few.
    """
    force, pressure, stiffness, weight = rows[0], rows[1], rows[3], rows[4]
    mu, one, step = np.ones((force.size, 2)), np.ones(force.size), np.empty(2)
    largest = np.inf
    for _ in range(MOST_PLATEAU_STEPS):
        if keeps_volume:
            multiplier = multiplier_of(mu, force, one)
            f, df, mu_3 = incompressible(
                mu, multiplier, one, pressure, stiffness, weight, printed_contact
            )
        else:
            f, df, mu_3 = compressible(mu, force, pressure, stiffness, p, weight, printed_contact)
        before, largest = mu.copy(), 0.0
        for k in range(force.size):
            _solve_two(df[k], f[k], step)
            fraction = 1.0
            for c in range(2):
                step[c] = -step[c]
                if not abs(step[c]) <= largest and not math.isnan(largest):
                    largest = abs(step[c])
                if step[c] < 0:
                    fraction = min(fraction, -0.9 * mu[k, c] / step[c])
            for c in range(2):
                mu[k, c] += fraction * step[c]
        if largest < PLATEAU_TOLERANCE:
            return before, mu_3, df, largest
    return mu, mu_3, df, largest


@njit(cache=True, nogil=True, error_model="numpy")
def _solve_two(matrix: Array, right: Array, x: Array) -> None:
    """Solve two equations, with the larger pivot; not a number if the matrix is singular."""
    first, second = (0, 1) if abs(matrix[0, 0]) >= abs(matrix[1, 0]) else (1, 0)
    factor = matrix[second, 0] / matrix[first, 0]
    x[1] = (right[second] - factor * right[first]) / (matrix[second, 1] - factor * matrix[first, 1])
    x[0] = (right[first] - matrix[first, 1] * x[1]) / matrix[first, 0]


@njit(cache=True, nogil=True)
def fastest(df: Array, gradient: Array) -> float:
    """The largest size of the eigenvalues of the derivatives (K, 2, 2), each over `gradient` (K,)."""
    found = 0.0
    for k in range(gradient.size):
        half = (df[k, 0, 0] + df[k, 1, 1]) / 2
        root = ((df[k, 0, 0] - df[k, 1, 1]) / 2) ** 2 + df[k, 0, 1] * df[k, 1, 0]
        size = abs(half) + math.sqrt(root) if root >= 0 else math.hypot(half, math.sqrt(-root))
        found = max(found, size / gradient[k])
    return found


@njit(cache=True, nogil=True)
def layered(z: Array, span: Ints, ends: Array, plateaus: Array, layer: float) -> Array:
    """Plateaus joined by layers, (K, 2), at places z in the spans with these numbers.

    ends : (S, 2) of the spans.  plateaus : (S, 2, 2) mu_1, mu_2 at the left and at the right end of each.
    """
    mu = np.empty((z.size, 2))
    for k in range(z.size):
        s = span[k]
        left, right = ends[s]
        along = (z[k] - left) / (right - left)
        before = math.exp(-abs(z[k] - left) / (2 * layer)) if s > 0 else 0.0
        after = math.exp(-abs(z[k] - right) / (2 * layer)) if s < len(ends) - 1 else 0.0
        for c in range(2):
            mu[k, c] = plateaus[s, 0, c] + along * (plateaus[s, 1, c] - plateaus[s, 0, c])
            if s > 0:
                mu[k, c] -= before * ((plateaus[s, 0, c] - plateaus[s - 1, 1, c]) / 2)
            if s < len(ends) - 1:
                mu[k, c] += after * ((plateaus[s + 1, 0, c] - plateaus[s, 1, c]) / 2)
    return mu
