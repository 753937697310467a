"""A directed rod that converges: Reissner's measures between directors, coefficients from E, nu and the section alone.

An edge e of reference length h is measured in the frame of the director m half-way between those of its ends:

    axial stretch   a = (e x m) / h,      shear   g = e . m / h,      turning   T = angle from one director to the next,

and each vertex has the stretch lambda = |d| / |D| of its section.  The energy is

    Pi = sum over edges    h [ 2 mu A (a - 1)^2 + Lambda A (a - 1 + mean of lambda - 1)^2 + k mu A g^2 ] / 2
                           + [ EI T^2 + mu I (difference of lambda)^2 ] / (2 h)
       + sum over vertices L 2 mu A (lambda - 1)^2 / 2

less the measures of the reference.  Where the centreline misses the area centres, edges run between those, at
x plus a share of d: stretching and bending then couple as they do in (1.2.93).  The share, Y02 where the height is
constant, belongs to the edge: edges that meet at a step of the height end at different points of its director.  The
volumetric part sits on the edges, where it cannot lock; Lambda is Lame's first constant in plane strain, and
E nu / (1 - nu^2) where the section is free in E1.  In an incompressible section Lambda is a penalty, on a times the
mean of lambda less 1: the area in the plane itself, not its linear part.

Derivatives: with m = (cos b, sin b), b the mean of the two directors' angles, and t = (sin b, -cos b),
    h a = e . t,   h g = e . m,   d(h a)/db = h g,   d(h g)/db = -h a.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numba import cfunc, njit
from numpy.typing import NDArray

from cosserat.rods.energies.compiled_rod import CompiledRod
from cosserat.rods.kinematics import Geometry
from cosserat.solvers.banded import Band, Vector
from cosserat.solvers.energy_momentum import KERNEL

Array = NDArray[np.float64]

TERMS = (
    "axial stretching",
    "cross-section stretching",
    "bending",
    "shearing",
    "volume",
    "cross-section stretch gradients",
    "couples",
)
"""The parts of the energy, in the order of `energy_terms`."""

_STIFF = 5.0
"""Lambda over 2 mu from which on a volume is stiff: Poisson's ratio 0.45 in plane strain."""

(EDGE, AXIAL, SLIDE, TURN, K_AXIAL, K_VOLUME, K_SHEAR, K_BENDING, K_STRETCH_GRADIENT) = range(9)
(DIRECTOR, VORONOI, K_SECTION, COUPLE, BARRIER, ANGLE) = range(9, 15)
(EDGE_3, EDGE_2, DIRECTOR_3, DIRECTOR_2, PRODUCT, LOW, HIGH, START) = range(15, 23)
"""Columns of what the kernel reads; `consistent_reference.coefficients` says what they hold."""
STRAIN, SLIDING, TURNING, STRETCH = range(4)
"""Columns of the measures: of edge K the axial strain, the shear and the turning; of vertex K the section stretch."""


@dataclass(frozen=True)
class ConsistentRod(CompiledRod):
    """The convergent rod as a solver sees it: an energy with its gradient and banded Hessian."""

    rod: Array

    @property
    def half_bandwidth(self) -> int:
        """Two neighbouring vertices of four numbers."""
        return 7

    @property
    def kernel(self) -> object:
        """The compiled energy, for compiled solvers."""
        return _compiled_energy()

    @property
    def parameters(self) -> Array:
        """What that kernel takes besides the DOFs."""
        return self.rod

    @property
    def stiff_volume(self) -> bool:
        """Whether a change of volume costs so much more than one of shape that motions have to begin without."""
        return bool((self.rod[:, K_VOLUME] > _STIFF * self.rod[:, K_AXIAL]).any())

    def centre_edges(self, x: Array, d: Array) -> Array:
        """Edges between area centres, (N - 1, 2) [m], of vertices and directors of shape (N, 2) [m]."""
        low, high = self.rod[:-1, LOW : HIGH + 1].T[..., None]
        edges: Array = (x[1:] + high * d[1:]) - (x[:-1] + low * d[:-1])
        return edges

    def unwrapped_near(self, angle: float) -> ConsistentRod:
        """The same rod, the angle of its first director counted within half a turn of this one [rad]."""
        rod = self.rod.copy()
        rod[0, START] = angle
        return ConsistentRod(rod)

    def displaced(self, geometry: Geometry) -> ConsistentRod:
        """The same rod, its DOFs counted from the reference.

        Forces then feel the rounding of displacements instead of positions, which on fine meshes is far less.
        """
        rod = self.rod.copy()
        rod[:-1, EDGE_3 : EDGE_2 + 1] = self.centre_edges(geometry.X, geometry.D)
        rod[:, DIRECTOR_3 : DIRECTOR_2 + 1] = geometry.D
        return ConsistentRod(rod)

    def with_couples(self, couples: Array) -> ConsistentRod:
        """The same rod with other couples, (N,) [N m]."""
        rod = self.rod.copy()
        rod[:, COUPLE] = couples
        return ConsistentRod(rod)

    def evaluate(
        self, q: Vector, order: int, measures: Array, gradient: Vector, band: Band, terms: Array
    ) -> float:
        """The kernel at q; infinite where a section or an edge has shrunk to nothing or two directors oppose."""
        return float(_assemble(q, _NOTHING, self.rod, order, measures, gradient, band, terms))


_NOTHING = np.empty(0)


@njit(cache=True)
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
def _curve(band: Band, p: int, v: Array, w: Array, c: Array) -> None:
    """Add sum over k of w_k v_k v_k + c b + b c, b the last row of v, to the block of eight DOFs from p on."""
    for j in range(8):
        for i in range(j, 8):
            total = c[i] * v[5, j] + c[j] * v[5, i]
            for k in range(6):
                total += w[k] * v[k, i] * v[k, j]
            band[p + j, i - j] += total


@njit(cache=True)
def _pair(band: Band, p: int, u: Array, v: Array, w: float) -> None:
    """Add w (u v + v u) to the block of eight DOFs from p on."""
    for j in range(8):
        for i in range(j, 8):
            band[p + j, i - j] += w * (u[i] * v[j] + u[j] * v[i])


@njit(cache=True)
def _turn(band: Band, p: int, n0: float, n1: float, across: float, twist: float) -> None:
    """Add across n' n' - twist (n n' + n' n), n' = (-n1, n0), to the block of a director from unknown p on."""
    band[p, 0] += across * n1 * n1 + 2 * twist * n0 * n1
    band[p, 1] += -across * n0 * n1 - twist * (n0 * n0 - n1 * n1)
    band[p + 1, 0] += across * n0 * n0 - 2 * twist * n0 * n1


@njit(cache=True, error_model="numpy")
def _measured(
    e0: float, e1: float, n0: float, n1: float, p0: float, p1: float
) -> tuple[float, float, float, float, float]:
    """h a, h g and the turning of an edge e between two directions, and the direction m between them."""
    s0, s1 = n0 + p0, n1 + p1
    both = np.sqrt(s0 * s0 + s1 * s1)
    m0, m1 = s0 / both, s1 / both
    return e0 * m1 - e1 * m0, e0 * m0 + e1 * m1, np.arctan2(n0 * p1 - n1 * p0, n0 * p0 + n1 * p1), m0, m1


@njit(cache=True)
def _volume(strain: float, wide: float, product: bool) -> float:
    """Change of volume of an edge by its axial strain and the mean stretch of its sections."""
    return (1 + strain) * wide - 1 if product else strain + wide - 1


@njit(cache=True, error_model="numpy")
def _assemble(
    q: Vector,
    after: Vector,
    rod: Array,
    order: int,
    measures: Array,
    gradient: Vector,
    band: Band,
    terms: Array,
) -> float:
    """The energy and its parts, as `stepping.KERNEL` says."""
    gradient[:] = 0.0
    band[:, :] = 0.0
    terms[:] = 0.0
    moving, measuring, deriving, curving = after.size > 0, order == 3, 0 < order < 3, order == 2
    barrier, product = rod[0, BARRIER], rod[0, PRODUCT] != 0.0
    # of the vertex before: direction, length and stretch; at the end of a step; and the stretch that stresses go by
    n0 = n1 = r_a = a0 = a1 = end_a = used_a = angle = 0.0
    v, w, c, widening = np.zeros((6, 8)), np.zeros(6), np.zeros(8), np.zeros(8)
    for K in range(rod.shape[0]):
        p, J, D = 4 * K, K - 1, rod[K, DIRECTOR]
        p0, p1 = q[p + 2] + rod[K, DIRECTOR_3], q[p + 3] + rod[K, DIRECTOR_2]
        r_b = np.sqrt(p0 * p0 + p1 * p1)
        if not r_b > 0.0:
            return np.inf
        p0, p1 = p0 / r_b, p1 / r_b
        b0, b1, used_b = p0, p1, r_b / D
        end_b = used_b
        if moving:
            b0, b1 = after[p + 2] + rod[K, DIRECTOR_3], after[p + 3] + rod[K, DIRECTOR_2]
            size = np.sqrt(b0 * b0 + b1 * b1)
            if not size > 0.0:
                return np.inf
            b0, b1, end_b = b0 / size, b1 / size, size / D
            used_b = (measures[K, STRETCH] + end_b) / 2
        if measuring:
            measures[K, STRETCH] = end_b
        terms[1] += rod[K, K_SECTION] / 2 * rod[K, VORONOI] * _stretch_energy(end_b, barrier)[0]
        W_rb = W_rr = 0.0
        W_turn = -rod[K, COUPLE]
        if deriving:
            _, first, second = _stretch_energy(used_b, barrier)
            W_rb = rod[K, K_SECTION] / 2 * rod[K, VORONOI] * first / D
            W_rr = rod[K, K_SECTION] / 2 * rod[K, VORONOI] * second / D**2
        if K == 0:
            angle = np.arctan2(b1, b0)
            angle -= 2 * np.pi * np.round((angle - rod[0, START]) / (2 * np.pi))
        else:
            E, D_a, low, high = rod[J, EDGE], rod[J, DIRECTOR], rod[J, LOW], rod[J, HIGH]
            e0, e1 = q[p] - q[p - 4] + rod[J, EDGE_3], q[p + 1] - q[p - 3] + rod[J, EDGE_2]
            e0 += high * (q[p + 2] - q[p - 2]) + (high - low) * q[p - 2]
            e1 += high * (q[p + 3] - q[p - 1]) + (high - low) * q[p - 1]
            A, G, T, m0, m1 = _measured(e0, e1, n0, n1, p0, p1)
            if not A > 0.0:
                return np.inf
            strain, slide, turn = (A - rod[J, AXIAL]) / E, (G - rod[J, SLIDE]) / E, T
            if moving:
                e0, e1 = (
                    after[p] - after[p - 4] + rod[J, EDGE_3],
                    after[p + 1] - after[p - 3] + rod[J, EDGE_2],
                )
                e0 += high * (after[p + 2] - after[p - 2]) + (high - low) * after[p - 2]
                e1 += high * (after[p + 3] - after[p - 1]) + (high - low) * after[p - 1]
                A_end, G_end, turn, _, _ = _measured(e0, e1, a0, a1, b0, b1)
                if not A_end > 0.0:
                    return np.inf
                strain, slide = (A_end - rod[J, AXIAL]) / E, (G_end - rod[J, SLIDE]) / E
            angle += turn
            wide = (end_a + end_b) / 2
            volume, jump = _volume(strain, wide, product), end_b - end_a
            terms[0] += rod[J, K_AXIAL] / 2 * E * _stretch_energy(1 + strain, barrier)[0]
            terms[4] += rod[J, K_VOLUME] / 2 * E * volume * volume
            terms[3] += rod[J, K_SHEAR] / 2 * E * slide * slide
            terms[2] += rod[J, K_BENDING] / (2 * E) * _bending_energy(turn - rod[J, TURN], barrier)[0]
            terms[5] += rod[J, K_STRETCH_GRADIENT] / (2 * E) * jump * jump
            if measuring:
                measures[J, STRAIN], measures[J, SLIDING], measures[J, TURNING] = strain, slide, turn
            if deriving:
                least = -np.inf
                if moving:  # stresses are those of the mean of both ends
                    old, old_wide = (
                        measures[J, STRAIN],
                        (measures[J, STRETCH] + measures[K, STRETCH]) / 2,
                    )
                    old_volume = _volume(old, old_wide, product)
                    if curving:  # but pressure and least tension are those of the start
                        least, volume = _stretch_energy(1 + old, barrier)[1], old_volume
                    volume, strain = (old_volume + volume) / 2, (old + strain) / 2
                    slide, turn = (measures[J, SLIDING] + slide) / 2, (measures[J, TURNING] + turn) / 2
                    wide, jump = (used_a + used_b) / 2, used_b - used_a
                by_axial, by_wide = (wide, 1 + strain) if product else (1.0, 1.0)
                _, first, w_axial = _stretch_energy(1 + strain, barrier)
                _, bent_first, bent_second = _bending_energy(turn - rod[J, TURN], barrier)
                pressure = rod[J, K_VOLUME] * volume
                W_A = rod[J, K_AXIAL] / 2 * max(first, least) + pressure * by_axial
                W_G = rod[J, K_SHEAR] * slide
                W_T = rod[J, K_BENDING] / (2 * E) * bent_first
                W_wide = pressure * E / 2 * by_wide
                W_ra = (W_wide - rod[J, K_STRETCH_GRADIENT] / E * jump) / D_a
                W_rb += (W_wide + rod[J, K_STRETCH_GRADIENT] / E * jump) / D
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
                        share = high if i > 3 else low
                        v[0, i] = G * v[5, i] + share * v[0, i - 2]
                        v[1, i] = -A * v[5, i] + share * v[1, i - 2]
                        widening[i] = v[4, i] / 2 if i > 3 else -v[4, i] / 2
                    v[3, i] = by_axial * v[0, i] + by_wide * E * widening[i]
                w[0], w[1], w[2] = (
                    rod[J, K_AXIAL] / 2 * w_axial / E,
                    rod[J, K_SHEAR] / E,
                    rod[J, K_BENDING] / (2 * E) * bent_second,
                )
                w[3], w[4], w[5] = (
                    rod[J, K_VOLUME] / E,
                    rod[J, K_STRETCH_GRADIENT] / E,
                    -W_A * A - W_G * G,
                )
                c0, c1 = W_A * m0 - W_G * m1, W_A * m1 + W_G * m0
                c[0], c[1], c[4], c[5] = -c0, -c1, c0, c1
                c[2], c[3], c[6], c[7] = -low * c0, -low * c1, high * c0, high * c1
                _curve(band, p - 4, v, w, c)
                if product:
                    _pair(band, p - 4, v[0], widening, pressure)
                _turn(band, p - 2, n0, n1, W_ra / r_a, turn_a / r_a)
        if rod[K, COUPLE] != 0.0:
            terms[6] -= rod[K, COUPLE] * (angle - rod[K, ANGLE])
        if deriving:
            gradient[p + 2] += W_rb * p0 - W_turn / r_b * p1
            gradient[p + 3] += W_rb * p1 + W_turn / r_b * p0
        if curving:
            band[p + 2, 0] += W_rr * p0 * p0
            band[p + 2, 1] += W_rr * p0 * p1
            band[p + 3, 0] += W_rr * p1 * p1
            _turn(band, p + 2, p0, p1, W_rb / r_b, W_turn / r_b**2)
        n0, n1, r_a, a0, a1, end_a, used_a = p0, p1, r_b, b0, b1, end_b, used_b
    total: float = terms.sum()
    return total


def _energy(
    q: Vector,
    after: Vector,
    rod: Array,
    order: int,
    measures: Array,
    gradient: Vector,
    band: Band,
    terms: Array,
) -> float:
    """The same, as a function that compiled solvers can be handed."""
    return _assemble(q, after, rod, order, measures, gradient, band, terms)


@functools.cache
def _compiled_energy() -> object:
    """Loaded only where a motion needs it: 0.2 s."""
    return cfunc(KERNEL, cache=True)(_energy)
