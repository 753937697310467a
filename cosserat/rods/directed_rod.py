"""The directed rod of Green and Naghdi, Chapter 1: measures, energies, their gradients, inertia.

The directors d_1, d_2, d_3 = r', eq. (1.2.10), and d_1', d_2' describe a section.  Index 0 is index 1 of the thesis.
Stiffnesses come from three-dimensional elasticity.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Section:
    """A cross-section in its principal axes.

    area [m^2]; second_moment_1, second_moment_2 : about the X^1 and the X^2 axis, eq. (1.2.37) [m^4];
    torsion_constant : moment over twist for a unit shear modulus [m^4].
    """

    area: float
    second_moment_1: float
    second_moment_2: float
    torsion_constant: float

    @classmethod
    def circle(cls, radius: float) -> Section:
        """A full circle, whose torsion constant is its polar moment."""
        quarter = np.pi * radius**4 / 4
        return cls(np.pi * radius**2, quarter, quarter, 2 * quarter)


@dataclass(frozen=True)
class Offset:
    """Moments of a section about axes that are not its central principal ones, eqs. (1.2.36), (1.2.37).

    first : (2,) S^1, S^2 [m^3].  product : I^12 [m^4].
    """

    first: Array
    product: float


def lame(young: float, poisson: float) -> tuple[float, float]:
    """lambda and mu of eq. (1.2.96) [Pa]."""
    first = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    return first, young / (2 * (1 + poisson))


def measures(d: Array, d_prime: Array) -> tuple[Array, Array]:
    """gamma_ij, shape (3, 3), and kappa_alpha_i, shape (2, 3), of eq. (1.2.19).

    The reference is straight, eq. (1.3.1), and its directors are the unit vectors E_i, eq. (1.3.2).
    d : (3, 3) the directors d_1, d_2, d_3 as rows.  d_prime : (2, 3) d_1', d_2' [1/m].
    """
    return d @ d.T - np.eye(3), d_prime @ d.T


def integrated_stiffnesses(young: float, poisson: float, section: Section) -> dict[int, float]:
    """k_1 ... k_15 of eq. (1.2.95), by number: linear elasticity integrated over the section [N, N m^2]."""
    first, shear = lame(young, poisson)
    a, i1, i2 = section.area, section.second_moment_1, section.second_moment_2
    stretch = first + 2 * shear
    k = dict.fromkeys((1, 2, 3), stretch * a / 4)
    k |= dict.fromkeys((4, 5, 6), shear * a)
    k |= dict.fromkeys((7, 8, 9), first * a / 2)
    k |= dict.fromkeys((10, 12), shear * i2)
    k |= dict.fromkeys((11, 13), shear * i1)
    return k | {14: stretch * i2, 15: stretch * i1}


def adjusted_stiffnesses(
    young: float, poisson: float, section: Section, shear_correction: float
) -> dict[int, float]:
    """k_1 ... k_16 of eq. (1.2.98), which agree with exact bending and torsion [N, N m^2].

    Erratum E1.1: the torsional rigidity enters k_12 = k_13 with a plus, or a twisted rod would store nothing.
    Erratum E1.2: k_11 takes I_1, as in eq. (1.2.95).
    """
    _, shear = lame(young, poisson)
    i1, i2 = section.second_moment_1, section.second_moment_2
    polar, torsion = shear * (i1 + i2), shear * section.torsion_constant
    k = integrated_stiffnesses(young, poisson, section)
    k |= dict.fromkeys((5, 6), shear_correction * shear * section.area)
    k |= dict.fromkeys((12, 13), (polar + torsion) / 4)
    return k | {14: young * i2, 15: young * i1, 16: (polar - torsion) / 2}


def strain_energy(k: Mapping[int, float], gamma: Array, kappa: Array) -> float:
    """rho_0 psi of eq. (1.2.94) or, with a k_16, of eq. (1.2.97) [J/m]."""
    squares = {
        1: gamma[0, 0] ** 2,
        2: gamma[1, 1] ** 2,
        3: gamma[2, 2] ** 2,
        4: (gamma[1, 0] + gamma[0, 1]) ** 2 / 4,
        5: gamma[0, 2] ** 2,
        6: gamma[1, 2] ** 2,
        7: gamma[0, 0] * gamma[1, 1],
        8: gamma[0, 0] * gamma[2, 2],
        9: gamma[1, 1] * gamma[2, 2],
        10: kappa[0, 0] ** 2,
        11: kappa[1, 1] ** 2,
        12: kappa[0, 1] ** 2,
        13: kappa[1, 0] ** 2,
        14: kappa[0, 2] ** 2,
        15: kappa[1, 2] ** 2,
        16: kappa[0, 1] * kappa[1, 0],
    }
    return float(sum(value * squares[number] for number, value in k.items()) / 2)


def energy_gradient(k: Mapping[int, float], gamma: Array, kappa: Array) -> tuple[Array, Array]:
    """Derivatives of `strain_energy` by the measures: Gamma, shape (3, 3), and K, shape (2, 3) [N, N m].

    The change of the energy is the sum of Gamma_ij times that of gamma_ij over all nine, with Gamma symmetric.
    """
    by_gamma = np.zeros_like(gamma)
    by_gamma[0, 0] = k[1] * gamma[0, 0] + (k[7] * gamma[1, 1] + k[8] * gamma[2, 2]) / 2
    by_gamma[1, 1] = k[2] * gamma[1, 1] + (k[7] * gamma[0, 0] + k[9] * gamma[2, 2]) / 2
    by_gamma[2, 2] = k[3] * gamma[2, 2] + (k[8] * gamma[0, 0] + k[9] * gamma[1, 1]) / 2
    by_gamma[0, 1] = by_gamma[1, 0] = k[4] * (gamma[0, 1] + gamma[1, 0]) / 4
    by_gamma[0, 2] = by_gamma[2, 0] = k[5] * gamma[0, 2] / 2
    by_gamma[1, 2] = by_gamma[2, 1] = k[6] * gamma[1, 2] / 2
    by_kappa = np.array([[k[10], k[12], k[14]], [k[13], k[11], k[15]]]) * kappa
    by_kappa[0, 1] += k.get(16, 0.0) * kappa[1, 0] / 2
    by_kappa[1, 0] += k.get(16, 0.0) * kappa[0, 1] / 2
    return by_gamma, by_kappa


def offset_energy(
    young: float, poisson: float, section: Section, offset: Offset, gamma: Array, kappa: Array
) -> float:
    """rho_0 psi of eq. (1.2.93): of a section about any centreline and any axes [J/m].

    section : its area, and I_1 = I^22, I_2 = I^11 about those axes.
    """
    first, shear = lame(young, poisson)
    own = strain_energy(integrated_stiffnesses(young, poisson, section), gamma, kappa)
    one, two = kappa
    turning = shear * (one[0] * two[0] + one[1] * two[1]) + (first + 2 * shear) * one[2] * two[2]
    bent = offset.first @ kappa  # S^alpha kappa_alpha i, shape (3,)
    stretching = first / 2 * np.trace(gamma) * bent[2] + shear * float(gamma[:, 2] @ bent)
    return float(own + offset.product * turning + stretching)


def stretches(d: Array, d_prime: Array) -> tuple[Array, Array]:
    """mu_i, shape (3,), of eq. (1.3.6) and mu_alpha', shape (2,), of eq. (1.3.7)."""
    mu = np.linalg.norm(d, axis=1)
    return mu, np.einsum("ai,ai->a", d[:2], d_prime) / mu[:2]


def stretch_gradients(d: Array, d_prime: Array) -> tuple[Array, Array, Array]:
    """Gradients of eq. (1.3.19), the non-zero ones, each a row of three components.

    Returns d mu_i / d d_i, shape (3, 3); d mu_alpha' / d d_alpha, shape (2, 3); d mu_alpha' / d d_alpha', shape (2, 3).
    """
    mu, _ = stretches(d, d_prime)
    e = d / mu[:, None]
    along = np.einsum("ai,ai->a", e[:2], d_prime)
    turned = (d_prime - along[:, None] * e[:2]) / mu[:2, None]
    return e, turned, e[:2]


def internal_forces(
    d: Array, d_prime: Array, by_stretch: Array, by_slope: Array
) -> tuple[Array, Array, Array]:
    """n, shape (3,), k^alpha and m^alpha, shape (2, 3), of eqs. (1.3.18), (1.3.20), for an energy of the stretches.

    by_stretch : (3,) its derivatives by mu_1, mu_2, mu_3.  by_slope : (2,) those by mu_1', mu_2'.
    """
    along, turned, across = stretch_gradients(d, d_prime)
    intrinsic = by_stretch[:2, None] * along[:2] + by_slope[:, None] * turned
    return by_stretch[2] * along[2], intrinsic, by_slope[:, None] * across


def forces(d: Array, d_prime: Array, by_gamma: Array, by_kappa: Array) -> tuple[Array, Array, Array]:
    """n, shape (3,), k^alpha and m^alpha, shape (2, 3), of eq. (1.3.18), for an energy of the measures (1.2.19).

    derived: a change of gamma_ij is d_i . d(d_j) + d_j . d(d_i), one of kappa_alpha i is
    d_i . d(d_alpha') + d_alpha' . d(d_i).

    by_gamma : (3, 3) its derivatives by gamma_ij, symmetric [N].  by_kappa : (2, 3) those by kappa_alpha i [N m].
    """
    by_d = 2 * by_gamma @ d + by_kappa.T @ d_prime
    return by_d[2], by_d[:2], by_kappa @ d


def unbalanced_couple(d: Array, d_prime: Array, n: Array, k: Array, m: Array) -> Array:
    """r' x n + d_alpha x k^alpha + d_alpha' x m^alpha, shape (3,), which eq. (1.2.91) says is zero [N]."""
    return np.asarray(np.cross(d[2], n) + couple(d, k) + np.cross(d_prime, m).sum(axis=0))


def couple(d: Array, director_forces: Array) -> Array:
    """d_alpha x f^alpha, shape (3,), of forces f^alpha, shape (2, 3): with m^alpha eq. (1.2.89) [N m]."""
    return np.asarray(np.cross(d[:2], director_forces).sum(axis=0))


@dataclass(frozen=True)
class Inertia:
    """Inertia of a section per reference length, eqs. (1.2.30)-(1.2.32).

    mass : rho_0 [kg/m].  first : (2,) rho_0 y_0^0alpha [kg].  second : (2, 2) rho_0 y_0^alpha beta [kg m].
    """

    mass: float
    first: Array
    second: Array

    @classmethod
    def homogeneous(cls, density: float, section: Section, offset: Offset) -> Inertia:
        """Of one density [kg/m^3], eqs. (1.2.35), (1.2.37): I^11 = I_2, I^22 = I_1."""
        i1, i2 = section.second_moment_1, section.second_moment_2
        area = np.array([[i2, offset.product], [offset.product, i1]])
        return cls(density * section.area, density * offset.first, density * area)

    @property
    def tensor(self) -> Array:
        """J_0 of eq. (1.2.34) about the centreline for D_alpha = E_alpha, shape (3, 3) [kg m]."""
        spread = np.zeros((3, 3))
        spread[:2, :2] = self.second
        return np.asarray(np.trace(spread) * np.eye(3) - spread)

    def momenta(self, v: Array, w: Array) -> tuple[Array, Array]:
        """G, shape (3,), and L^alpha, shape (2, 3), of eqs. (1.2.39), (1.2.41), the first two of (1.3.8).

        v : (3,) velocity of the centreline, w : (2, 3) of the directors, eq. (1.3.5) [m/s, 1/s].
        """
        return self.mass * v + self.first @ w, np.outer(self.first, v) + self.second @ w

    def kinetic_energy(self, v: Array, w: Array) -> float:
        """T of eq. (1.2.43) [J/m]."""
        linear, director = self.momenta(v, w)
        return float(linear @ v + (director * w).sum()) / 2

    def angular_momentum(self, r: Array, d: Array, v: Array, w: Array) -> Array:
        """H_O of eq. (1.2.45), shape (3,), of a section at r with directors d, shape (3, 3) [N s]."""
        linear, director = self.momenta(v, w)
        return np.asarray(np.cross(r, linear) + couple(d, director))
