"""A directed rod that converges: Reissner's measures between directors, coefficients from E, nu and the section alone.

An edge e of reference length h is measured in the frame of the director m half-way between those of its ends:

    axial stretch   a = (e x m) / h,      shear   g = e . m / h,      turning   T = angle from one director to the next,

and each vertex has the stretch lambda = |d| / |D| of its section.  The energy is

    Pi = sum over edges    h [ 2 mu A (a - 1)^2 + Lambda A (a - 1 + mean of lambda - 1)^2 + k mu A g^2 ] / 2
                           + [ EI T^2 + mu I (difference of lambda)^2 ] / (2 h)
       + sum over vertices L 2 mu A (lambda - 1)^2 / 2

less the measures of the reference.  If the centreline misses the area centres, edges run between those, at x plus a
fraction of d; stretching and bending then couple as in (1.2.93).  The fraction, Y02 for a constant height, belongs to
the edge: edges that meet at a step of the height end at different points of its director.  The volumetric part is on
the edges, where it cannot lock.  Lambda is Lame's first constant in plane strain, and E nu / (1 - nu^2) if the section
is free in E1.  For an incompressible section Lambda is a penalty on a times the mean of lambda, less 1: on the area in
the plane itself, not on its linear part.

Derivatives: with m = (cos b, sin b), b the mean of the two directors' angles, and t = (sin b, -cos b),
    h a = e . t,   h g = e . m,   d(h a)/db = h g,   d(h g)/db = -h a.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.solvers.banded import Band, Vector
from cosserat.solvers.potential import COMMIT, GRADIENT, HESSIAN, STRAINS

Array = NDArray[np.float64]

TERMS = (
    "axial stretching",
    "cross-section stretching",
    "bending",
    "shearing",
    "volume",
    "cross-section stretch gradients",
)
"""The parts of the energy, in the order of `terms`."""

VERTEX = np.dtype(
    [
        # of the edge after the vertex, zero at the last one
        ("edge", "f8"),  # length along the area centres [m]
        ("axial", "f8"),  # h a of the reference [m]
        ("slide", "f8"),  # h g of the reference [m]
        ("turn", "f8"),  # T of the reference [rad]
        ("k_axial", "f8"),  # 2 mu A [N]
        ("k_volume", "f8"),  # Lambda A [N]
        ("k_shear", "f8"),  # k mu A [N]
        ("k_bending", "f8"),  # EI [N m^2]
        ("k_stretch_gradient", "f8"),  # mu I [N m^2]
        ("low", "f8"),  # its first end from the vertex, in units of its director [1]
        ("high", "f8"),  # its second end from the next vertex, in units of its director [1]
        # of the vertex
        ("director", "f8"),  # |D| [m]
        ("voronoi", "f8"),  # L [m]
        ("k_section", "f8"),  # 2 mu A [N]
        # added to the DOFs: zero, or the reference if these are displacements [m]
        ("edge_3", "f8"),
        ("edge_2", "f8"),
        ("director_3", "f8"),
        ("director_2", "f8"),
        # options, read from the first vertex
        ("barrier", "f8"),  # one with the barriers of Fig. 3.7
        ("product", "?"),  # whether the volume is the product of the stretches, not their sum
    ],
    align=True,
)
"""Constants of each vertex and of the edge after it."""
STRAIN, SLIDING, TURNING, STRETCH = range(4)
"""Columns of the measures: of edge K the axial strain, the shear and the turning; of vertex K the section stretch."""


@njit(cache=True, error_model="numpy")
def _stretch_energy(s: float, barrier: float) -> tuple[float, float, float]:
    """(s - 1)^2, or with a barrier (s^2 - s + 1/s - 1) / 2 of Fig. 3.7(a): equal to second order; two derivatives."""
    u = s - 1
    if barrier == 0.0:
        return u * u, 2 * u, 2.0
    return u * u * (1 + 1 / s) / 2, u * (2 * s * s + s + 1) / (2 * s * s), 1 + 1 / s**3


@njit(cache=True)
def _bending_energy(turn: float, barrier: float) -> tuple[float, float, float]:
    """T^2, or with a barrier 4 tan(T/2)^2 of Fig. 3.7(b), and two derivatives: equal to second order."""
    if barrier == 0.0:
        return turn * turn, 2 * turn, 2.0
    t = np.tan(turn / 2)
    s = 1 + t * t
    return 4 * t * t, 4 * t * s, 2 * s * (s + 2 * t * t)


@njit(cache=True)
def _add_edge_hessian(band: Band, p: int, v: Array, w: Array, c: Array) -> None:
    """Add sum over k of w_k v_k v_k + c b + b c, b the last row of v, to the block of eight DOFs at p.

    Rows 2, 4 and 5 of v are zero but for directors.
    """
    for j in (0, 1, 4, 5):
        for i in range(j, 8):
            band[p + j, i - j] += _plus_products(c[j] * v[5, i], v, w, i, j)
    for j in (2, 3):
        for i in (4, 5):
            band[p + j, i - j] += _plus_products(c[i] * v[5, j], v, w, i, j)
    for j in (2, 3, 6, 7):
        for i in (2, 3, 6, 7):
            if i < j:
                continue
            total = c[i] * v[5, j] + c[j] * v[5, i]
            for k in range(6):
                total += w[k] * v[k, i] * v[k, j]
            band[p + j, i - j] += total


@njit(cache=True)
def _plus_products(start: float, v: Array, w: Array, i: int, j: int) -> float:
    """A number plus w_k v_ki v_kj for the rows of v that are not zero for positions."""
    total = start + w[0] * v[0, i] * v[0, j]
    total += w[1] * v[1, i] * v[1, j]
    return float(total + w[3] * v[3, i] * v[3, j])


@njit(cache=True)
def _add_symmetric_product(band: Band, p: int, u: Array, v: Array, w: float) -> None:
    """Add w (u v + v u) to the block of eight DOFs at p."""
    for j in range(8):
        for i in range(j, 8):
            band[p + j, i - j] += w * (u[i] * v[j] + u[j] * v[i])


@njit(cache=True)
def _add_director_block(band: Band, p: int, n0: float, n1: float, across: float, twist: float) -> None:
    """Add across n' n' - twist (n n' + n' n), n' = (-n1, n0), to the block of a director at DOF p."""
    band[p, 0] += across * n1 * n1 + 2 * twist * n0 * n1
    band[p, 1] += -across * n0 * n1 - twist * (n0 * n0 - n1 * n1)
    band[p + 1, 0] += across * n0 * n0 - 2 * twist * n0 * n1


@njit(cache=True, error_model="numpy")
def _edge_strains(
    e0: float, e1: float, n0: float, n1: float, p0: float, p1: float
) -> tuple[float, float, float, float, float]:
    """h a, h g and T of an edge e between two directions, and the direction m between them."""
    s0, s1 = n0 + p0, n1 + p1
    both = np.sqrt(s0 * s0 + s1 * s1)
    m0, m1 = s0 / both, s1 / both
    return e0 * m1 - e1 * m0, e0 * m0 + e1 * m1, np.arctan2(n0 * p1 - n1 * p0, n0 * p0 + n1 * p1), m0, m1


@njit(cache=True)
def _volume(strain: float, wide: float, product: bool) -> float:
    """Change of volume of an edge from its axial strain and the mean stretch of its sections."""
    return (1 + strain) * wide - 1 if product else strain + wide - 1


@njit(cache=True, error_model="numpy")
def assemble(
    q: Vector,
    after: Vector,
    data: NDArray[np.uint8],
    history: Vector,
    strains: Array,
    task: int,
    gradient: Vector,
    band: Band,
    skew: Band,
    terms: Array,
) -> float:
    """The energy and its parts; arguments as in `solvers.potential.KERNEL`."""
    rod = data.view(VERTEX)
    terms[:] = 0.0
    moving, measuring, curving = after.size > 0, task == STRAINS, task == HESSIAN
    deriving = curving or task == GRADIENT
    barrier, product = rod[0].barrier, rod[0].product
    # of the vertex before: direction, length and stretch; at the end of a step; and the stretch for stresses
    n0 = n1 = r_a = a0 = a1 = end_a = used_a = 0.0
    v, w, c, widening = np.zeros((6, 8)), np.zeros(6), np.zeros(8), np.zeros(8)
    for K in range(rod.shape[0]):
        p, J, D = 4 * K, K - 1, rod[K].director
        p0, p1 = q[p + 2] + rod[K].director_3, q[p + 3] + rod[K].director_2
        r_b = np.sqrt(p0 * p0 + p1 * p1)
        if not r_b > 0.0:
            return np.inf
        p0, p1 = p0 / r_b, p1 / r_b
        b0, b1, used_b = p0, p1, r_b / D
        end_b = used_b
        if moving:
            b0, b1 = after[p + 2] + rod[K].director_3, after[p + 3] + rod[K].director_2
            size = np.sqrt(b0 * b0 + b1 * b1)
            if not size > 0.0:
                return np.inf
            b0, b1, end_b = b0 / size, b1 / size, size / D
            used_b = (strains[K, STRETCH] + end_b) / 2
        if measuring:
            strains[K, STRETCH] = end_b
        terms[1] += rod[K].k_section / 2 * rod[K].voronoi * _stretch_energy(end_b, barrier)[0]
        W_rb = W_rr = 0.0
        W_turn = 0.0
        if deriving:
            _, first, second = _stretch_energy(used_b, barrier)
            W_rb = rod[K].k_section / 2 * rod[K].voronoi * first / D
            W_rr = rod[K].k_section / 2 * rod[K].voronoi * second / D**2
        if K > 0:
            E, D_a, low, high = rod[J].edge, rod[J].director, rod[J].low, rod[J].high
            e0, e1 = q[p] - q[p - 4] + rod[J].edge_3, q[p + 1] - q[p - 3] + rod[J].edge_2
            e0 += high * (q[p + 2] - q[p - 2]) + (high - low) * q[p - 2]
            e1 += high * (q[p + 3] - q[p - 1]) + (high - low) * q[p - 1]
            A, G, T, m0, m1 = _edge_strains(e0, e1, n0, n1, p0, p1)
            if not A > 0.0:
                return np.inf
            strain, slide, turn = (A - rod[J].axial) / E, (G - rod[J].slide) / E, T
            if moving:
                e0, e1 = (
                    after[p] - after[p - 4] + rod[J].edge_3,
                    after[p + 1] - after[p - 3] + rod[J].edge_2,
                )
                e0 += high * (after[p + 2] - after[p - 2]) + (high - low) * after[p - 2]
                e1 += high * (after[p + 3] - after[p - 1]) + (high - low) * after[p - 1]
                A_end, G_end, turn, _, _ = _edge_strains(e0, e1, a0, a1, b0, b1)
                if not A_end > 0.0:
                    return np.inf
                strain, slide = (A_end - rod[J].axial) / E, (G_end - rod[J].slide) / E
            wide = (end_a + end_b) / 2
            volume, jump = _volume(strain, wide, product), end_b - end_a
            terms[0] += rod[J].k_axial / 2 * E * _stretch_energy(1 + strain, barrier)[0]
            terms[4] += rod[J].k_volume / 2 * E * volume * volume
            terms[3] += rod[J].k_shear / 2 * E * slide * slide
            terms[2] += rod[J].k_bending / (2 * E) * _bending_energy(turn - rod[J].turn, barrier)[0]
            terms[5] += rod[J].k_stretch_gradient / (2 * E) * jump * jump
            if measuring:
                strains[J, STRAIN], strains[J, SLIDING], strains[J, TURNING] = strain, slide, turn
            if deriving:
                least = -np.inf
                if moving:  # stresses are those of the mean of both ends
                    old, old_wide = (
                        strains[J, STRAIN],
                        (strains[J, STRETCH] + strains[K, STRETCH]) / 2,
                    )
                    old_volume = _volume(old, old_wide, product)
                    if curving:  # except pressure and least tension, from the start
                        least, volume = _stretch_energy(1 + old, barrier)[1], old_volume
                    volume, strain = (old_volume + volume) / 2, (old + strain) / 2
                    slide, turn = (strains[J, SLIDING] + slide) / 2, (strains[J, TURNING] + turn) / 2
                    wide, jump = (used_a + used_b) / 2, used_b - used_a
                by_axial, by_wide = (wide, 1 + strain) if product else (1.0, 1.0)
                _, first, w_axial = _stretch_energy(1 + strain, barrier)
                _, bent_first, bent_second = _bending_energy(turn - rod[J].turn, barrier)
                pressure = rod[J].k_volume * volume
                W_A = rod[J].k_axial / 2 * max(first, least) + pressure * by_axial
                W_G = rod[J].k_shear * slide
                W_T = rod[J].k_bending / (2 * E) * bent_first
                W_wide = pressure * E / 2 * by_wide
                W_ra = (W_wide - rod[J].k_stretch_gradient / E * jump) / D_a
                W_rb += (W_wide + rod[J].k_stretch_gradient / E * jump) / D
                W_b = W_A * G - W_G * A
                f0, f1 = W_A * m1 + W_G * m0, -W_A * m0 + W_G * m1
                turn_a = (W_b / 2 - W_T) / r_a
                W_turn += W_b / 2 + W_T
                gradient[p - 4] -= f0
                gradient[p - 3] -= f1
                gradient[p - 2] += W_ra * n0 - turn_a * n1
                gradient[p - 1] += W_ra * n1 + turn_a * n0
                gradient[p] += f0
                gradient[p + 1] += f1
                gradient[p - 2] -= low * f0
                gradient[p - 1] -= low * f1
                gradient[p + 2] += high * f0
                gradient[p + 3] += high * f1
            if curving:
                # gradients by (x, d) of both vertices: A, G, T, volume E, jump, b
                v[0, 0], v[0, 1], v[0, 4], v[0, 5] = -m1, m0, m1, -m0
                v[1, 0], v[1, 1], v[1, 4], v[1, 5] = -m0, -m1, m0, m1
                v[2, 2], v[2, 3], v[2, 6], v[2, 7] = n1 / r_a, -n0 / r_a, -p1 / r_b, p0 / r_b
                v[4, 2], v[4, 3], v[4, 6], v[4, 7] = -n0 / D_a, -n1 / D_a, p0 / D, p1 / D
                for i in range(8):
                    if i % 4 > 1:
                        v[5, i] = v[2, i] / 2 if i > 3 else -v[2, i] / 2
                        weight = high if i > 3 else low
                        v[0, i] = G * v[5, i] + weight * v[0, i - 2]
                        v[1, i] = -A * v[5, i] + weight * v[1, i - 2]
                        widening[i] = v[4, i] / 2 if i > 3 else -v[4, i] / 2
                    v[3, i] = by_axial * v[0, i] + by_wide * E * widening[i]
                w[0], w[1], w[2] = (
                    rod[J].k_axial / 2 * w_axial / E,
                    rod[J].k_shear / E,
                    rod[J].k_bending / (2 * E) * bent_second,
                )
                w[3], w[4], w[5] = (
                    rod[J].k_volume / E,
                    rod[J].k_stretch_gradient / E,
                    -W_A * A - W_G * G,
                )
                c0, c1 = W_A * m0 - W_G * m1, W_A * m1 + W_G * m0
                c[0], c[1], c[4], c[5] = -c0, -c1, c0, c1
                c[2], c[3], c[6], c[7] = -low * c0, -low * c1, high * c0, high * c1
                _add_edge_hessian(band, p - 4, v, w, c)
                if product:
                    _add_symmetric_product(band, p - 4, v[0], widening, pressure)
                _add_director_block(band, p - 2, n0, n1, W_ra / r_a, turn_a / r_a)
        if deriving:
            gradient[p + 2] += W_rb * p0 - W_turn / r_b * p1
            gradient[p + 3] += W_rb * p1 + W_turn / r_b * p0
        if curving:
            band[p + 2, 0] += W_rr * p0 * p0
            band[p + 2, 1] += W_rr * p0 * p1
            band[p + 3, 0] += W_rr * p1 * p1
            _add_director_block(band, p + 2, p0, p1, W_rb / r_b, W_turn / r_b**2)
        n0, n1, r_a, a0, a1, end_a, used_a = p0, p1, r_b, b0, b1, end_b, used_b
    total: float = terms.sum()
    return total


@njit(cache=True, error_model="numpy")
def _measures(rod: NDArray[np.void], K: int, q: Vector) -> tuple[float, ...]:
    """Of edge K: h a, h g, T and the direction m between the directors; unit directors and lengths at both ends."""
    p = 4 * K
    n0, n1 = q[p + 2] + rod[K].director_3, q[p + 3] + rod[K].director_2
    p0, p1 = q[p + 6] + rod[K + 1].director_3, q[p + 7] + rod[K + 1].director_2
    r_a, r_b = np.sqrt(n0 * n0 + n1 * n1), np.sqrt(p0 * p0 + p1 * p1)
    low, high = rod[K].low, rod[K].high
    e0, e1 = q[p + 4] - q[p] + rod[K].edge_3, q[p + 5] - q[p + 1] + rod[K].edge_2
    e0 += high * (q[p + 6] - q[p + 2]) + (high - low) * q[p + 2]
    e1 += high * (q[p + 7] - q[p + 3]) + (high - low) * q[p + 3]
    A, G, T, m0, m1 = _edge_strains(e0, e1, n0 / r_a, n1 / r_a, p0 / r_b, p1 / r_b)
    return A, G, T, m0, m1, n0 / r_a, n1 / r_a, p0 / r_b, p1 / r_b, r_a, r_b


@njit(cache=True, error_model="numpy")
def _work_on(rod: NDArray[np.void], K: int, q: Vector) -> float:
    """Work of the stresses on edge K."""
    E, D_a, D_b = rod[K].edge, rod[K].director, rod[K + 1].director
    A, G, T, _, _, _, _, _, _, r_a, r_b = _measures(rod, K, q)
    strain, wide = (A - rod[K].axial) / E, (r_a / D_a + r_b / D_b) / 2
    work = E * (rod[K].k_axial * strain + rod[K].k_volume * _volume(strain, wide, rod[0].product))
    work += rod[K].k_bending * (T - rod[K].turn) + rod[K].k_shear * (G - rod[K].slide)
    return float(work + rod[K].k_stretch_gradient / E * (r_b / D_b - r_a / D_a))


@njit(cache=True, error_model="numpy")
def _add_edge_stress(
    rod: NDArray[np.void], K: int, q: Vector, curving: bool, gradient: Vector, band: Band
) -> None:
    """Subtract the gradient, and the Hessian if `curving`, of the work of the stresses on edge K."""
    p, E, D_a, D_b = 4 * K, rod[K].edge, rod[K].director, rod[K + 1].director
    low, high, product = rod[K].low, rod[K].high, rod[0].product
    A, G, _, m0, m1, n0, n1, p0, p1, r_a, r_b = _measures(rod, K, q)
    by_axial, by_wide = 1.0, 1.0
    if product:
        by_axial, by_wide = (r_a / D_a + r_b / D_b) / 2, 1 + (A - rod[K].axial) / E
    W_A, W_G = -rod[K].k_axial - rod[K].k_volume * by_axial, -rod[K].k_shear
    W_m, W_T = W_A * G - W_G * A, -rod[K].k_bending
    W_wide, W_jump = -rod[K].k_volume * E * by_wide / 2, -rod[K].k_stretch_gradient / E
    W_a, W_b = (W_wide - W_jump) / D_a, (W_wide + W_jump) / D_b
    turn_a, turn_b = (W_m / 2 - W_T) / r_a, (W_m / 2 + W_T) / r_b
    f0, f1 = W_A * m1 + W_G * m0, -W_A * m0 + W_G * m1
    gradient[p] -= f0
    gradient[p + 1] -= f1
    gradient[p + 2] += W_a * n0 - turn_a * n1 - low * f0
    gradient[p + 3] += W_a * n1 + turn_a * n0 - low * f1
    gradient[p + 4] += f0
    gradient[p + 5] += f1
    gradient[p + 6] += W_b * p0 - turn_b * p1 + high * f0
    gradient[p + 7] += W_b * p1 + turn_b * p0 + high * f1
    if not curving:
        return
    v, w, c, widening = np.zeros((6, 8)), np.zeros(6), np.zeros(8), np.zeros(8)
    v[5, 2], v[5, 3] = -n1 / (2 * r_a), n0 / (2 * r_a)
    v[5, 6], v[5, 7] = -p1 / (2 * r_b), p0 / (2 * r_b)
    w[5] = -W_A * A - W_G * G
    c0, c1 = W_A * m0 - W_G * m1, W_A * m1 + W_G * m0
    c[0], c[1], c[4], c[5] = -c0, -c1, c0, c1
    c[2], c[3], c[6], c[7] = -low * c0, -low * c1, high * c0, high * c1
    _add_edge_hessian(band, p, v, w, c)
    _add_director_block(band, p + 2, n0, n1, W_a / r_a, turn_a / r_a)
    _add_director_block(band, p + 6, p0, p1, W_b / r_b, turn_b / r_b)
    if product:
        along = np.array([-m1, m0, 0.0, 0.0, m1, -m0, 0.0, 0.0]) + G * v[5]
        along[2:4] += low * along[:2]
        along[6:] += high * along[4:6]
        widening[2], widening[3] = n0 / (2 * D_a), n1 / (2 * D_a)
        widening[6], widening[7] = p0 / (2 * D_b), p1 / (2 * D_b)
        _add_symmetric_product(band, p, along, widening, -rod[K].k_volume)


@njit(cache=True, error_model="numpy")
def stressed(
    q: Vector,
    after: Vector,
    data: NDArray[np.uint8],
    history: Vector,
    strains: Array,
    task: int,
    gradient: Vector,
    band: Band,
    skew: Band,
    terms: Array,
) -> float:
    """Minus the work of constant stresses on the measures; arguments as in `solvers.potential.KERNEL`.

    The constants are those of the energy with stresses, stiffnesses times strains, in place of the stiffnesses.
    """
    rod = data.view(VERTEX)
    if task == COMMIT:
        return 0.0
    ends, work = after if after.size > 0 else q, 0.0
    for K in range(rod.shape[0]):
        p, stress = 4 * K, rod[K].k_section * rod[K].voronoi
        d0, d1 = ends[p + 2] + rod[K].director_3, ends[p + 3] + rod[K].director_2
        work += stress * (np.sqrt(d0 * d0 + d1 * d1) / rod[K].director - 1)
        if rod.shape[0] > K + 1:
            work += _work_on(rod, K, ends)
        if task not in (GRADIENT, HESSIAN):
            continue
        if rod.shape[0] > K + 1:
            _add_edge_stress(rod, K, q, task == HESSIAN, gradient, band)
        d0, d1 = q[p + 2] + rod[K].director_3, q[p + 3] + rod[K].director_2
        r, W_r = np.sqrt(d0 * d0 + d1 * d1), -stress / rod[K].director
        gradient[p + 2] += W_r * d0 / r
        gradient[p + 3] += W_r * d1 / r
        if task == HESSIAN:
            _add_director_block(band, p + 2, d0 / r, d1 / r, W_r / r, 0.0)
    terms[0] = -work
    return -work
