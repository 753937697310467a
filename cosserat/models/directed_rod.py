"""The directed rod of Green and Naghdi, Chapter 1: measures, stiffnesses from three-dimensional elasticity, gradients.

A section is known by its directors d_1, d_2, by d_3 = r' and by d_1', d_2'.  Index 0 stands for 1 of the thesis.
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
    """What a section has about axes that are not its central principal ones, eqs. (1.2.36), (1.2.37).

    first : (2,) S^1, S^2 [m^3].  product : I^12 [m^4].
    """

    first: Array
    product: float


def lame(young: float, poisson: float) -> tuple[float, float]:
    """lambda and mu of eq. (1.2.96) [Pa]."""
    first = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    return first, young / (2 * (1 + poisson))


def measures(d: Array, d_prime: Array) -> tuple[Array, Array]:
    """gamma_ij, shape (3, 3), and kappa_alpha_i, shape (2, 3), of eq. (1.2.19) for a straight reference.

    d : (3, 3) the directors d_1, d_2, d_3 as rows.  d_prime : (2, 3) d_1', d_2' [1/m].
    """
    return d @ d.T - np.eye(3), d_prime @ d.T


def integrated_stiffnesses(young: float, poisson: float, section: Section) -> dict[int, float]:
    """k_1 ... k_15 of eq. (1.2.95), by number: what integrating linear elasticity over the section gives [N, N m^2]."""
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
