"""How the compiled equations of a crawler change with J parameters, the stretches at the points being fixed.

derived: derivatives of the formulas in `equations`, term by term.  A rate is a derivative by a parameter.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@njit(cache=True, nogil=True)
def local_rates(
    z: Array,
    z_rate: Array,
    span: Ints,
    loads: Array,
    loads_rate: Array,
    piece: Ints,
    pieces: Array,
    pieces_rate: Array,
    groups: tuple[float, float],
    groups_rate: Array,
    divided: bool,
) -> Array:
    """How the rows of `equations.local_terms` change, (J, 7, K); the other arguments are those of that function.

    z_rate : (J, K).  loads_rate : (J, 3, S).  pieces_rate : (J, P, 10).  groups_rate : (J, 2).
    """
    rows = np.empty((z_rate.shape[0], 7, z.size))
    value, rate = np.empty(4), np.empty(4)
    for j in range(z_rate.shape[0]):
        for k in range(z.size):
            s = span[k]
            own, own_rate = pieces[piece[s]], pieces_rate[j, piece[s]]
            along = (z[k] - own[0]) / (own[1] - own[0])
            along_rate = (z_rate[j, k] - own_rate[0] - along * (own_rate[1] - own_rate[0])) / (
                own[1] - own[0]
            )
            for c in range(4):  # radius, modulus, anchoring, advancing
                rise, rise_rate = own[6 + c] - own[2 + c], own_rate[6 + c] - own_rate[2 + c]
                value[c] = own[2 + c] + rise * along
                rate[c] = own_rate[2 + c] + rise_rate * along + rise * along_rate
            radius, young = value[0], value[1]
            relative = rate[1] / young + 2 * rate[0] / radius  # of the stretching stiffness
            stretching = young * radius**2
            force = loads[0, s] * value[2]
            force_rate = loads_rate[j, 0, s] * value[2] + loads[0, s] * rate[2]
            rows[j, 0, k] = (force_rate - force * relative) / stretching if divided else force_rate
            rows[j, 1, k] = radius * (
                radius * (loads_rate[j, 1, s] * value[3] + loads[1, s] * rate[3])
                + 2 * rate[0] * loads[1, s] * value[3]
            )
            rows[j, 2, k] = loads_rate[j, 2, s]
            rows[j, 3, k] = stretching * (groups_rate[j, 0] + groups[0] * relative)
            rows[j, 4, k] = radius**2 * (groups_rate[j, 1] * radius + 3 * groups[1] * rate[0])
            rows[j, 5, k] = stretching * radius**2 * (relative + 2 * rate[0] / radius)
            rows[j, 6, k] = rate[0]
    return rows


@njit(cache=True, nogil=True)
def compressible_rates(
    mu: Array, rows: Array, rows_rate: Array, p: float, p_rate: Array, printed_contact: bool
) -> tuple[Array, Array]:
    """How f (J, K, 2) and mu_3 (J, K) of `equations.compressible` change; rows : (7, K) of `instant.Local`."""
    count, points = p_rate.size, mu.shape[0]
    f, mu_3 = np.empty((count, points, 2)), np.empty((count, points))
    for j in range(count):
        for k in range(points):
            n, g, m = rows[0, k], rows[3, k], rows[4, k]
            n_rate, c_rate = rows_rate[j, 0, k], rows_rate[j, 1, k]
            g_rate, m_rate = rows_rate[j, 3, k], rows_rate[j, 4, k]
            one, two = mu[k, 0] - 1, mu[k, 1] - 1
            mu_3[j, k] = n_rate - p_rate[j] * (one + two)
            contact = m_rate
            if printed_contact:
                stretch = 1 + n - p * (one + two)
                contact = (m_rate - m * mu_3[j, k] / stretch) / stretch
            for c in range(2):
                same, other = (one, two) if c == 0 else (two, one)
                force = (1 - p) * ((1 + p) * same + p * other) + p * n
                by_p = -2 * p * same + (1 - 2 * p) * other + n
                f[j, k, c] = c_rate + g_rate * force + g * (by_p * p_rate[j] + p * n_rate)
            f[j, k, 0] += contact
    return f, mu_3


@njit(cache=True, nogil=True)
def incompressible_rates(
    mu: Array, multiplier_rate: Array, rows_rate: Array, printed_contact: bool
) -> Array:
    """How f (J, K, 2) of `equations.incompressible` changes; multiplier_rate : (J, K) of lambda_c."""
    f = np.empty((multiplier_rate.shape[0], mu.shape[0], 2))
    for j in range(f.shape[0]):
        for k in range(mu.shape[0]):
            mu_1, mu_2, rate = mu[k, 0], mu[k, 1], multiplier_rate[j, k]
            c_rate, i_rate, m_rate = rows_rate[j, 1, k], rows_rate[j, 3, k], rows_rate[j, 4, k]
            contact = m_rate * mu_1 * mu_2 if printed_contact else m_rate
            f[j, k, 0] = c_rate + contact + rate / mu_1 + i_rate * (2 * mu_1 + mu_2 - 3)
            f[j, k, 1] = c_rate + rate / mu_2 + i_rate * (2 * mu_2 + mu_1 - 3)
    return f


@njit(cache=True, nogil=True)
def multiplier_rates(mu: Array, rows: Array, rows_rate: Array, far: Array) -> Array:
    """How lambda_c of `equations.multiplier_of` changes, (J, K).

    far : (K,) mu_1 mu_2 at the junction where lambda_c is taken from; one where it is taken from nowhere.
    """
    rates = np.empty((rows_rate.shape[0], mu.shape[0]))
    for k in range(mu.shape[0]):
        volume, exponent = mu[k, 0] * mu[k, 1], rows[2, k]
        share = 1 / volume
        if exponent != 1.0:
            share = (far[k] / volume) ** exponent / far[k]
        for j in range(rates.shape[0]):
            rates[j, k] = rows_rate[j, 0, k] * share
            if exponent != 1.0:
                rates[j, k] += rows[0, k] * share * rows_rate[j, 2, k] * math.log(far[k] / volume)
    return rates
