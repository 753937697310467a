"""The published strain energy of the discrete planar directed rod, eqs. (3.4.11) and (3.4.13), and its derivatives.

The kernel works in three short passes.  The first measures strains: lengths |e|, |d| and the angles phi, theta, with
their gradients.  The second is the physics: the seven terms of eq. (3.4.11) and their derivatives by those strains.
The third carries them back to the DOFs by the chain rule; forces are minus the gradient, eq. (3.4.7).

Two facts make the third pass short.  Every angle is a difference of polar angles alpha(v) of edges e, chords
c_K = x_(K+1) - x_(K-1) or directors d.  And with t = v / |v| and n = t rotated by a right angle,
    grad |v| = t,       grad grad |v| = n n / |v|,
    grad alpha = n / |v|,   grad grad alpha = -(t n + n t) / |v|^2.

This file holds all compiled functions of this model: Numba's cache does not see edits of other files.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.solvers.banded import Band, Vector
from cosserat.solvers.potential import GRADIENT, HESSIAN, STRAINS

Array = NDArray[np.float64]

TERMS = (
    "centreline stretching",
    "cross-section stretching",
    "bending",
    "shearing",
    "shearing gradients",
    "cross-section stretch gradients",
    "Poisson effect",
)
"""The seven terms, in the order of eq. (3.4.11)."""


VERTEX = np.dtype(
    [
        (
            "edge",
            "f8",
        ),  # ||E^K|| of the edge after the vertex [m]; at the last one it is zero, and so are k1, k5 and k6
        ("k1", "f8"),
        ("k5", "f8"),
        ("k6", "f8"),
        ("voronoi", "f8"),  # L_K [m]
        ("director", "f8"),  # ||D_K|| [m]
        ("k2", "f8"),
        ("k3", "f8"),
        ("k4", "f8"),
        ("k7", "f8"),
        ("intrinsic", "f8"),  # tan(phi / 2) of the reference
    ]
)
"""Constants of each vertex and of the edge after it; stiffnesses as in eq. (3.4.11)."""


@njit(cache=True, error_model="numpy")
def stretching(s: float) -> tuple[float, float, float]:
    """s^2 - s + 1/s - 1 and two derivatives: the characteristic of Fig. 3.7(a), less its value at s = 1."""
    return (s - 1) ** 2 * (1 + 1 / s), (s - 1) * (2 * s * s + s + 1) / (s * s), 2 + 2 / s**3


@njit(cache=True)
def squared_tangent(angle: float, rest: float) -> tuple[float, float, float]:
    """(tan(angle) - rest)^2 and two derivatives by the angle: with rest = 0, the characteristic of Fig. 3.7(b)."""
    t = np.tan(angle)
    s = 1 + t * t
    return (t - rest) ** 2, 2 * (t - rest) * s, 2 * s * s + 4 * (t - rest) * t * s


@njit(cache=True)
def _add_square(band: Band, p: int, u0: float, u1: float, w: float) -> None:
    """Add w u u to the diagonal block at DOF p."""
    band[p, 0] += w * u0 * u0
    band[p, 1] += w * u0 * u1
    band[p + 1, 0] += w * u1 * u1


@njit(cache=True)
def _add_director_rotation(band: Band, p: int, t0: float, t1: float, w: float) -> None:
    """Add w (t n + n t), n = (-t1, t0), to the diagonal block at DOF p."""
    band[p, 0] -= 2 * w * t0 * t1
    band[p, 1] += w * (t0 * t0 - t1 * t1)
    band[p + 1, 0] += 2 * w * t0 * t1


@njit(cache=True)
def _add_product(
    band: Band, p: int, u0: float, u1: float, r: int, v0: float, v1: float, w: float
) -> None:
    """Add w (u v + v u) for a vector u at DOF p and v at DOF r."""
    if p == r:
        band[p, 0] += 2 * w * u0 * v0
        band[p, 1] += w * (u0 * v1 + u1 * v0)
        band[p + 1, 0] += 2 * w * u1 * v1
        return
    if p < r:
        p, u0, u1, r, v0, v1 = r, v0, v1, p, u0, u1
    k = p - r
    band[r, k] += w * u0 * v0
    band[r, k + 1] += w * u1 * v0
    band[r + 1, k - 1] += w * u0 * v1
    band[r + 1, k] += w * u1 * v1


@njit(cache=True)
def _add_edge_block(
    band: Band, p: int, r: int, t0: float, t1: float, along: float, across: float, twist: float
) -> None:
    """Add the Hessian A = along t t + across n n + twist (t n + n t) by e = x_r - x_p: +A at p, r, -A between."""
    a00 = along * t0 * t0 + across * t1 * t1 - 2 * twist * t0 * t1
    a01 = (along - across) * t0 * t1 + twist * (t0 * t0 - t1 * t1)
    a11 = along * t1 * t1 + across * t0 * t0 + 2 * twist * t0 * t1
    for at in (p, r):
        band[at, 0] += a00
        band[at, 1] += a01
        band[at + 1, 0] += a11
    k = r - p
    band[p, k] -= a00
    band[p, k + 1] -= a01
    band[p + 1, k - 1] -= a01
    band[p + 1, k] -= a11


@njit(cache=True, error_model="numpy")
def _measure_strains(q: Vector, strains: Array, units: Array) -> bool:
    """Strains, (N, 4), and unit vectors, (N, 7), at q; False if the rod has collapsed.

    Strains: |e| of edge K; |d| and theta of vertex K, and phi of an interior vertex.  Units: the tangent of edge K, the
    chord at vertex K as its length and direction, and the direction of its director.
    """
    n = strains.shape[0]
    sound = True
    for K in range(n - 1):
        e0, e1 = q[4 * K + 4] - q[4 * K], q[4 * K + 5] - q[4 * K + 1]
        m = np.hypot(e0, e1)
        strains[K, 0], units[K, 0], units[K, 1] = m, e0 / m, e1 / m
        sound = sound and bool(m > 0.0)
    for K in range(n):
        low, high = max(K - 1, 0), min(K + 1, n - 1)  # eqs. (3.3.7)-(3.3.9)
        b0, b1 = q[4 * high] - q[4 * low], q[4 * high + 1] - q[4 * low + 1]
        c = np.hypot(b0, b1)
        c0, c1 = b0 / c, b1 / c
        r = np.hypot(q[4 * K + 2], q[4 * K + 3])
        d0, d1 = q[4 * K + 2] / r, q[4 * K + 3] / r
        upright = c0 * d1 - c1 * d0  # b . d, b = t x E1, eq. (3.3.25)
        units[K, 2], units[K, 3], units[K, 4], units[K, 5], units[K, 6] = c, c0, c1, d0, d1
        strains[K, 1] = r
        strains[K, 2] = np.arctan2(-c0 * d0 - c1 * d1, upright)  # eqs. (3.3.24), (3.3.26)
        if 0 < K < n - 1:
            turn = units[K - 1, 0] * units[K, 1] - units[K - 1, 1] * units[K, 0]
            along = units[K - 1, 0] * units[K, 0] + units[K - 1, 1] * units[K, 1]
            strains[K, 3] = np.arctan2(turn, along)  # eqs. (3.3.15), (3.3.18)
        sound = sound and bool(upright > 0.0) and bool(r > 0.0)
    return sound


@njit(cache=True, error_model="numpy")
def _energies(rod: NDArray[np.void], strains: Array, terms: Array) -> None:
    """The seven terms of eq. (3.4.11) from the strains."""
    n = rod.shape[0]
    for K in range(n):
        E, L, m, r, theta = rod[K].edge, rod[K].voronoi, strains[K, 0], strains[K, 1], strains[K, 2]
        terms[1] += rod[K].k2 / 2 * stretching(r / rod[K].director)[0] * L
        terms[3] += rod[K].k4 / 2 * squared_tangent(theta, 0.0)[0] * L
        if n - 1 > K:
            terms[0] += rod[K].k1 / 2 * stretching(m / E)[0] * E  # eq. (3.3.19)
            jump = strains[K + 1, 2] - theta
            terms[4] += rod[K].k5 / 2 * jump * jump / E
            jump = strains[K + 1, 1] / rod[K + 1].director - r / rod[K].director
            terms[5] += rod[K].k6 / 2 * jump * jump / E
        if 0 < K < n - 1:  # bending and the Poisson effect: interior vertices only
            # mu kappa = 2/L tan(phi/2), eqs. (3.3.20), (3.3.23), less the intrinsic K of the reference
            terms[2] += 2 * rod[K].k3 / L * squared_tangent(strains[K, 3] / 2, rod[K].intrinsic)[0]
            # excess = (mu - 1) L, eqs. (3.3.13), (3.3.20)
            excess = ((strains[K - 1, 0] - rod[K - 1].edge) + (m - E)) / 2
            terms[6] += rod[K].k7 * (r - rod[K].director) / rod[K].director * excess


@njit(cache=True, error_model="numpy")
def assemble(
    q: Vector,
    after: Vector,
    data: NDArray[np.uint8],
    history: Vector,
    strains_before: Array,
    task: int,
    gradient: Vector,
    band: Band,
    skew: Band,
    terms: Array,
) -> float:
    """The energy and its terms; arguments as in `solvers.potential.KERNEL`."""
    rod = data.view(VERTEX)
    n = rod.shape[0]
    terms[:] = 0.0

    # First pass: strains.  Edge K: length m, tangent t.  Chord K and director K: length and unit vector.
    strains, units = np.zeros((n, 4)), np.empty((n, 7))
    if not _measure_strains(q, strains, units):
        return np.inf
    if task == STRAINS:
        strains_before[:, :] = strains
    ends = strains
    if after.size > 0:  # stresses are those of the mean of both ends
        ends = np.zeros((n, 4))
        if not _measure_strains(after, ends, np.empty((n, 7))):
            return np.inf
        for K in range(n):
            for k in range(4):
                strains[K, k] = (strains_before[K, k] + ends[K, k]) / 2
    _energies(rod, ends, terms)
    total: float = terms.sum()
    if task not in (GRADIENT, HESSIAN):
        return total
    t0, t1, c, c0, c1, d0, d1 = (
        units[:, 0],
        units[:, 1],
        units[:, 2],
        units[:, 3],
        units[:, 4],
        units[:, 5],
        units[:, 6],
    )
    m, r, theta = np.empty(n), np.empty(n), strains[:, 2]  # lengths where the gradients are taken
    for K in range(n):
        r[K] = np.hypot(q[4 * K + 2], q[4 * K + 3])
        if n - 1 > K:
            m[K] = np.hypot(q[4 * K + 4] - q[4 * K], q[4 * K + 5] - q[4 * K + 1])

    # Second pass: derivatives of eq. (3.4.11) by each strain s: W_s, W_ss, and W_s_next with the same strain of the
    # next vertex.
    W_m, W_mm = np.zeros(n - 1), np.zeros(n - 1)
    W_phi, W_phiphi = np.zeros(n), np.zeros(n)
    W_theta, W_thetatheta, W_theta_next = np.zeros(n), np.zeros(n), np.zeros(n - 1)
    W_lam, W_lamlam, W_lam_next = np.zeros(n), np.zeros(n), np.zeros(n - 1)
    lam = strains[:, 1] / rod["director"]  # eq. (3.3.21)
    for K in range(n - 1):
        E = rod[K].edge
        _, first, second = stretching(strains[K, 0] / E)
        if task == HESSIAN and after.size > 0:
            first = max(first, stretching(strains_before[K, 0] / E)[1])
        W_m[K] += rod[K].k1 / 2 * first
        W_mm[K] += rod[K].k1 / 2 * second / E

        jump = theta[K + 1] - theta[K]
        W_theta[K] -= rod[K].k5 * jump / E
        W_theta[K + 1] += rod[K].k5 * jump / E
        W_thetatheta[K] += rod[K].k5 / E
        W_thetatheta[K + 1] += rod[K].k5 / E
        W_theta_next[K] -= rod[K].k5 / E

        jump = lam[K + 1] - lam[K]
        W_lam[K] -= rod[K].k6 * jump / E
        W_lam[K + 1] += rod[K].k6 * jump / E
        W_lamlam[K] += rod[K].k6 / E
        W_lamlam[K + 1] += rod[K].k6 / E
        W_lam_next[K] -= rod[K].k6 / E
    for K in range(n):
        L = rod[K].voronoi
        _, first, second = stretching(lam[K])
        W_lam[K] += rod[K].k2 / 2 * first * L
        W_lamlam[K] += rod[K].k2 / 2 * second * L

        _, first, second = squared_tangent(theta[K], 0.0)
        W_theta[K] += rod[K].k4 / 2 * first * L
        W_thetatheta[K] += rod[K].k4 / 2 * second * L
    for K in range(1, n - 1):  # bending and the Poisson effect: interior vertices only
        L = rod[K].voronoi
        _, first, second = squared_tangent(strains[K, 3] / 2, rod[K].intrinsic)
        W_phi[K] = rod[K].k3 / L * first
        W_phiphi[K] = rod[K].k3 / (2 * L) * second

        stretch = (strains[K, 1] - rod[K].director) / rod[K].director
        excess = ((strains[K - 1, 0] - rod[K - 1].edge) + (strains[K, 0] - rod[K].edge)) / 2
        W_lam[K] += rod[K].k7 * excess
        W_m[K - 1] += rod[K].k7 / 2 * stretch
        W_m[K] += rod[K].k7 / 2 * stretch

    # Third pass: the chain rule.  First the terms of each edge, chord and director alone ...
    for K in range(n - 1):
        p, s = 4 * K, 4 * K + 4
        turning = W_phi[K] - W_phi[K + 1]  # e_K ends the angle at vertex K and begins the one at K + 1
        f0 = W_m[K] * t0[K] - turning * t1[K] / m[K]
        f1 = W_m[K] * t1[K] + turning * t0[K] / m[K]
        gradient[p] -= f0
        gradient[p + 1] -= f1
        gradient[s] += f0
        gradient[s + 1] += f1
        if task == GRADIENT:
            continue
        _add_edge_block(band, p, s, t0[K], t1[K], W_mm[K], W_m[K] / m[K], -turning / (m[K] * m[K]))
    for K in range(n):
        p, s, u = 4 * max(K - 1, 0), 4 * min(K + 1, n - 1), 4 * K + 2
        g0, g1 = c1[K] / c[K], -c0[K] / c[K]  # d theta / d chord
        h0, h1 = -d1[K] / r[K], d0[K] / r[K]  # d theta / d director
        gradient[p] -= W_theta[K] * g0
        gradient[p + 1] -= W_theta[K] * g1
        gradient[s] += W_theta[K] * g0
        gradient[s + 1] += W_theta[K] * g1
        gradient[u] += W_theta[K] * h0 + W_lam[K] * d0[K] / rod[K].director
        gradient[u + 1] += W_theta[K] * h1 + W_lam[K] * d1[K] / rod[K].director
        if task == GRADIENT:
            continue
        stiff = W_thetatheta[K]
        _add_edge_block(band, p, s, c0[K], c1[K], 0.0, stiff / (c[K] * c[K]), W_theta[K] / (c[K] * c[K]))
        _add_product(band, s, g0, g1, u, h0, h1, stiff)
        _add_product(band, p, -g0, -g1, u, h0, h1, stiff)
        _add_square(band, u, h0, h1, stiff + W_lam[K] * r[K] / rod[K].director)
        _add_director_rotation(band, u, d0[K], d1[K], -W_theta[K] / (r[K] * r[K]))
        _add_square(band, u, d0[K] / rod[K].director, d1[K] / rod[K].director, W_lamlam[K])

    if task == GRADIENT:
        return total

    # ... then the coupling of neighbours.
    for K in range(1, n - 1):
        p, s = 4 * K - 4, 4 * K
        a0, a1 = (
            -t1[K - 1] / m[K - 1],
            t0[K - 1] / m[K - 1],
        )  # grad alpha of the edges before and after vertex K
        b0, b1 = -t1[K] / m[K], t0[K] / m[K]
        z0, z1 = -a0 - b0, -a1 - b1
        stiff = W_phiphi[K]
        _add_square(band, p, a0, a1, stiff)
        _add_square(band, s, z0, z1, stiff)
        _add_square(band, s + 4, b0, b1, stiff)
        _add_product(band, s, z0, z1, p, a0, a1, stiff)
        _add_product(band, s + 4, b0, b1, p, a0, a1, stiff)
        _add_product(band, s + 4, b0, b1, s, z0, z1, stiff)

        w = rod[K].k7 / (2 * rod[K].director)
        _add_product(band, s + 2, d0[K], d1[K], p, -t0[K - 1], -t1[K - 1], w)
        _add_product(band, s + 2, d0[K], d1[K], s, t0[K - 1] - t0[K], t1[K - 1] - t1[K], w)
        _add_product(band, s + 2, d0[K], d1[K], s + 4, t0[K], t1[K], w)
    for K in range(n - 1):
        J = K + 1
        w = W_theta_next[K]
        low, high, low_next, high_next = 4 * max(K - 1, 0), 4 * K + 4, 4 * K, 4 * min(K + 2, n - 1)
        g0, g1, h0, h1 = c1[K] / c[K], -c0[K] / c[K], -d1[K] / r[K], d0[K] / r[K]
        j0, j1, i0, i1 = c1[J] / c[J], -c0[J] / c[J], -d1[J] / r[J], d0[J] / r[J]
        for at, v0, v1 in ((high, g0, g1), (low, -g0, -g1), (4 * K + 2, h0, h1)):
            _add_product(band, high_next, j0, j1, at, v0, v1, w)
            _add_product(band, low_next, -j0, -j1, at, v0, v1, w)
            _add_product(band, 4 * J + 2, i0, i1, at, v0, v1, w)
        w = W_lam_next[K] / (rod[K].director * rod[J].director)
        _add_product(band, 4 * J + 2, d0[J], d1[J], 4 * K + 2, d0[K], d1[K], w)
    return total
