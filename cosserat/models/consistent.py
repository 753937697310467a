"""A directed rod that converges: Reissner's measures between directors, coefficients from E, nu and the section alone.

An edge e of reference length h is measured in the frame of the director m half-way between those of its ends:

    axial stretch   a = (e x m) / h,      shear   g = e . m / h,      turning   T = angle from one director to the next,

and each vertex has the stretch lambda = |d| / |D| of its section.  The energy is

    Pi = sum over edges    h [ 2 mu A (a - 1)^2 + Lambda A (a - 1 + mean of lambda - 1)^2 + k mu A g^2 ] / 2
                           + [ EI T^2 + mu I (difference of lambda)^2 ] / (2 h)
       + sum over vertices L 2 mu A (lambda - 1)^2 / 2

less the measures of the reference.  The volumetric part sits on the edges, where it cannot lock; Lambda is Lame's
first constant in plane strain, and E nu / (1 - nu^2) where the section is free to contract in E1.

Derivatives: with m = (cos b, sin b), b the mean of the two directors' angles, and t = (sin b, -cos b),
    h a = e . t,   h g = e . m,   d(h a)/db = h g,   d(h g)/db = -h a.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numba import cfunc, njit
from numpy.typing import NDArray

from cosserat.models.planar_rod import Geometry, Lumped, counted_angles
from cosserat.solvers.banded import Band, Vector
from cosserat.solvers.stepping import KERNEL

Array = NDArray[np.float64]

SectionState = Literal["free", "plane strain", "incompressible"]
"""What the section may do in E1: contract freely, not at all, or (in plane strain) nothing that changes the area."""

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

PENALTY = 1e5
"""Lambda over 2 mu of an incompressible section."""

_COLUMNS = 20


def coefficients(
    geometry: Geometry,
    vertex: Lumped,
    edge: Lumped,
    shear_correction: float,
    section: SectionState,
    couples: Array,
    barrier: bool,
) -> Array:
    """What the kernel needs, shape (N, 20): row K has edge K (the last row none), vertex K and its couple.

    Columns: length, axial measure, shear measure and turning of the edge in the reference; 2 mu A, Lambda A, k mu A,
    EI, mu I of the edge; |D|, L and 2 mu A of the vertex; couple [N m]; one for the barriers of Fig. 3.7, else zero;
    angle of the director in the reference, counted on from vertex to vertex; four numbers that are zero, or what
    `ConsistentRod.displaced` puts there; and, in row 0, the angle within half a turn of which that of the first
    director is counted.
    """
    n = geometry.X.shape[0]
    rod = np.zeros((n, _COLUMNS))
    e, alpha = np.diff(geometry.X, axis=0), counted_angles(geometry.D)
    turn = np.diff(alpha)
    b = alpha[:-1] + turn / 2
    rod[:-1, 0] = geometry.edge_length
    rod[:-1, 1] = e[:, 0] * np.sin(b) - e[:, 1] * np.cos(b)
    rod[:-1, 2] = e[:, 0] * np.cos(b) + e[:, 1] * np.sin(b)
    rod[:-1, 3] = turn
    shear, first, plane = _moduli(edge, section)
    rod[:-1, 4] = 2 * shear * edge.area
    rod[:-1, 5] = first * edge.area
    rod[:-1, 6] = shear_correction * shear * edge.area
    rod[:-1, 7] = plane * edge.second_moment
    rod[:-1, 8] = shear * edge.second_moment
    shear, _, _ = _moduli(vertex, section)
    rod[:, 9] = geometry.director_length
    rod[:, 10] = geometry.voronoi_length
    rod[:, 11] = 2 * shear * vertex.area
    rod[:, 12] = couples
    rod[:, 13] = float(barrier)
    rod[:, 14] = alpha
    rod[0, 19] = alpha[0]
    return rod


def edge_shear(x: Array, d: Array) -> Array:
    """Angle of each edge against the normal of the mean of its two directors, shape (N - 1,) [rad]."""
    unit = d / np.linalg.norm(d, axis=1)[:, None]
    m, e = unit[1:] + unit[:-1], np.diff(x, axis=0)
    angle: Array = np.arctan2((e * m).sum(axis=1), e[:, 0] * m[:, 1] - e[:, 1] * m[:, 0])
    return angle


def _moduli(part: Lumped, section: SectionState) -> tuple[Array, Array, Array]:
    """mu, Lambda and the modulus of bending."""
    if section == "incompressible":
        shear = part.young / 3
        return shear, PENALTY * 2 * shear, part.young / 0.75
    nu = part.poisson
    if section == "free":
        return part.shear, part.young * nu / (1 - nu**2), part.young
    return part.shear, part.young * nu / ((1 + nu) * (1 - 2 * nu)), part.young / (1 - nu**2)


_NO_VECTOR, _NO_BAND = np.empty(0), np.empty((0, 8))


@dataclass(frozen=True)
class ConsistentRod:
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
        """What that kernel takes besides the unknowns."""
        return self.rod

    def counted_near(self, angle: float) -> ConsistentRod:
        """The same rod, the angle of its first director counted within half a turn of this one [rad]."""
        rod = self.rod.copy()
        rod[0, 19] = angle
        return ConsistentRod(rod)

    def displaced(self, geometry: Geometry) -> ConsistentRod:
        """The same rod, its unknowns counted from the reference.

        Forces then feel the rounding of displacements instead of positions, which on fine meshes is far less.
        """
        rod = self.rod.copy()
        rod[:-1, 15:17] = np.diff(geometry.X, axis=0)
        rod[:, 17:19] = geometry.D
        return ConsistentRod(rod)

    def assemble(self, q: Vector, gradient: Vector, band: Band) -> float:
        """Strain energy less the work of the couples [J] at q, shape (4 N,); overwrites gradient and band.

        The energy is infinite where a section or an edge has shrunk to nothing or neighbouring directors oppose.
        """
        return float(_assemble(q, self.rod, 2, gradient, band, np.empty(7)))

    def energy(self, q: Vector) -> float:
        """The same energy [J]."""
        return float(_assemble(q, self.rod, 0, _NO_VECTOR, _NO_BAND, np.empty(7)))

    def differentiate(self, q: Vector, gradient: Vector) -> float:
        """The same energy [J]; overwrites its gradient, shape (4 N,) [N]."""
        return float(_assemble(q, self.rod, 1, gradient, _NO_BAND, np.empty(7)))

    def energy_terms(self, q: Vector) -> Array:
        """The parts of the energy at q, in the order of `TERMS`, shape (7,) [J]."""
        terms = np.empty(7)
        _assemble(q, self.rod, 0, _NO_VECTOR, _NO_BAND, terms)
        return terms


@njit(cache=True)
def _well(s: float, barrier: float) -> tuple[float, float, float]:
    """(s - 1)^2, or with a barrier (s^2 - s + 1/s - 1) / 2 of Fig. 3.7(a): equal to second order; two derivatives."""
    u = s - 1
    if barrier == 0.0:
        return u * u, 2 * u, 2.0
    return u * u * (1 + 1 / s) / 2, u * (2 * s * s + s + 1) / (2 * s * s), 1 + 1 / s**3


@njit(cache=True)
def _bow(turn: float, barrier: float) -> tuple[float, float, float]:
    """T^2, or with a barrier 4 tan(T/2)^2 of Fig. 3.7(b), and two derivatives: equal to second order."""
    if barrier == 0.0:
        return turn * turn, 2 * turn, 2.0
    t = np.tan(turn / 2)
    s = 1 + t * t
    return 4 * t * t, 4 * t * s, 2 * s * (s + 2 * t * t)


@njit(cache=True)
def _curve(band: Band, p: int, v: Array, w: Array, c: Array) -> None:
    """Add sum over k of w_k v_k v_k + c b + b c, b the last row of v, to the block of eight unknowns from p on."""
    for j in range(8):
        for i in range(j, 8):
            total = c[i] * v[5, j] + c[j] * v[5, i]
            for k in range(6):
                total += w[k] * v[k, i] * v[k, j]
            band[p + j, i - j] += total


@njit(cache=True)
def _turn(band: Band, p: int, n0: float, n1: float, across: float, twist: float) -> None:
    """Add across n' n' - twist (n n' + n' n), n' = (-n1, n0), to the block of a director from unknown p on."""
    band[p, 0] += across * n1 * n1 + 2 * twist * n0 * n1
    band[p, 1] += -across * n0 * n1 - twist * (n0 * n0 - n1 * n1)
    band[p + 1, 0] += across * n0 * n0 - 2 * twist * n0 * n1


@njit(cache=True, error_model="numpy")
def _assemble(q: Vector, rod: Array, order: int, gradient: Vector, band: Band, terms: Array) -> float:
    """The energy and its parts; with order 1 also the gradient, with order 2 the Hessian too."""
    gradient[:] = 0.0
    band[:, :] = 0.0
    terms[:] = 0.0
    barrier = rod[0, 13]
    angle = n0 = n1 = r_a = (
        0.0  # of the vertex before: angle, counted on from vertex to vertex, direction and length
    )
    v, w, c = np.zeros((6, 8)), np.zeros(6), np.zeros(8)
    for K in range(rod.shape[0]):
        p = 4 * K
        p0, p1 = q[p + 2] + rod[K, 17], q[p + 3] + rod[K, 18]
        r_b = np.sqrt(p0 * p0 + p1 * p1)
        if not r_b > 0.0:
            return np.inf
        p0, p1 = p0 / r_b, p1 / r_b
        D = rod[K, 9]
        W_rb, W_rr, W_turn = 0.0, 0.0, -rod[K, 12]
        value, first, second = _well(r_b / D, barrier)
        terms[1] += rod[K, 11] / 2 * rod[K, 10] * value
        W_rb += rod[K, 11] / 2 * rod[K, 10] * first / D
        W_rr = rod[K, 11] / 2 * rod[K, 10] * second / D**2
        if K == 0:
            angle = np.arctan2(p1, p0)
            angle -= 2 * np.pi * np.round((angle - rod[0, 19]) / (2 * np.pi))
        else:
            J = K - 1
            E, D_a = rod[J, 0], rod[J, 9]
            e0, e1 = q[p] - q[p - 4] + rod[J, 15], q[p + 1] - q[p - 3] + rod[J, 16]
            T = np.arctan2(n0 * p1 - n1 * p0, n0 * p0 + n1 * p1)
            angle += T
            s0, s1 = n0 + p0, n1 + p1  # along m
            both = np.sqrt(s0 * s0 + s1 * s1)
            if not both > 0.0:
                return np.inf
            m0, m1 = s0 / both, s1 / both
            A, G = e0 * m1 - e1 * m0, e0 * m0 + e1 * m1
            if not A > 0.0:
                return np.inf
            strain, slide = (A - rod[J, 1]) / E, (G - rod[J, 2]) / E
            value, first, w_axial = _well(1 + strain, barrier)
            volume = strain + (r_a / D_a + r_b / D) / 2 - 1
            bent, bent_first, bent_second = _bow(T - rod[J, 3], barrier)
            jump = r_b / D - r_a / D_a
            terms[0] += rod[J, 4] / 2 * E * value
            terms[4] += rod[J, 5] / 2 * E * volume * volume
            terms[3] += rod[J, 6] / 2 * E * slide * slide
            terms[2] += rod[J, 7] / (2 * E) * bent
            terms[5] += rod[J, 8] / (2 * E) * jump * jump
            if order > 0:
                W_A, W_G = rod[J, 4] / 2 * first + rod[J, 5] * volume, rod[J, 6] * slide
                W_T = rod[J, 7] / (2 * E) * bent_first
                W_ra = (rod[J, 5] * E / 2 * volume - rod[J, 8] / E * jump) / D_a
                W_rb += (rod[J, 5] * E / 2 * volume + rod[J, 8] / E * jump) / D
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
            if order > 1:
                # gradients by (x, d) of both vertices: A, G, T, volume E, jump, b
                a0, a1, b0, b1 = -n1 / r_a, n0 / r_a, -p1 / r_b, p0 / r_b
                v[0, 0], v[0, 1], v[0, 4], v[0, 5] = -m1, m0, m1, -m0
                v[1, 0], v[1, 1], v[1, 4], v[1, 5] = -m0, -m1, m0, m1
                v[5, 2], v[5, 3], v[5, 6], v[5, 7] = a0 / 2, a1 / 2, b0 / 2, b1 / 2
                v[2, 2], v[2, 3], v[2, 6], v[2, 7] = -a0, -a1, b0, b1
                v[4, 2], v[4, 3], v[4, 6], v[4, 7] = -n0 / D_a, -n1 / D_a, p0 / D, p1 / D
                for i in range(8):
                    if i % 4 > 1:
                        v[0, i], v[1, i] = G * v[5, i], -A * v[5, i]
                        v[3, i] = v[0, i] + E / 2 * (v[4, i] if i > 3 else -v[4, i])
                    else:
                        v[3, i] = v[0, i]
                w[0], w[1], w[2] = (
                    rod[J, 4] / 2 * w_axial / E,
                    rod[J, 6] / E,
                    rod[J, 7] / (2 * E) * bent_second,
                )
                w[3], w[4], w[5] = rod[J, 5] / E, rod[J, 8] / E, -W_A * A - W_G * G
                c0, c1 = W_A * m0 - W_G * m1, W_A * m1 + W_G * m0
                c[0], c[1], c[4], c[5] = -c0, -c1, c0, c1
                _curve(band, p - 4, v, w, c)
                _turn(band, p - 2, n0, n1, W_ra / r_a, turn_a / r_a)
        if rod[K, 12] != 0.0:
            terms[6] -= rod[K, 12] * (angle - rod[K, 14])
        if order > 0:
            gradient[p + 2] += W_rb * p0 - W_turn / r_b * p1
            gradient[p + 3] += W_rb * p1 + W_turn / r_b * p0
        if order > 1:
            band[p + 2, 0] += W_rr * p0 * p0
            band[p + 2, 1] += W_rr * p0 * p1
            band[p + 3, 0] += W_rr * p1 * p1
            _turn(band, p + 2, p0, p1, W_rb / r_b, W_turn / r_b**2)
        n0, n1, r_a = p0, p1, r_b
    total: float = terms.sum()
    return total


def _energy(q: Vector, rod: Array, order: int, gradient: Vector, band: Band, terms: Array) -> float:
    """The same, as a function that compiled solvers can be handed."""
    return _assemble(q, rod, order, gradient, band, terms)


@functools.cache
def _compiled_energy() -> object:
    """Loaded only where a motion needs it: 0.2 s."""
    return cfunc(KERNEL, cache=True)(_energy)
