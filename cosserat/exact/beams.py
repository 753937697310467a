"""Closed forms of section 3.5, in small displacements, independent of the models of this package.

Lengths in m, forces in N, moduli in Pa; xi is an array of arc lengths from the left end.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NeckingTheory = Literal["printed", "two directors", "plane strain", "free section"]
"""The one-dimensional theory of the decay of a necked end; see `necking_decay`."""


@dataclass(frozen=True, kw_only=True)
class Beam:
    """A uniform beam: length [m], area [m^2], second_moment [m^4], young [Pa], poisson [1], line_density [kg/m]."""

    length: float
    area: float
    second_moment: float
    young: float
    poisson: float
    line_density: float
    shear_correction: float

    @property
    def axial_stiffness(self) -> float:
        """EA [N]."""
        return self.young * self.area

    @property
    def bending_stiffness(self) -> float:
        """EI [N m^2]."""
        return self.young * self.second_moment

    @property
    def shear_stiffness(self) -> float:
        """kGA [N]."""
        return self.shear_correction * self.young / (2 * (1 + self.poisson)) * self.area


BeamCurve = Callable[[Beam, float, Array], Array]
"""A closed form of a beam under its weight: (beam, g, xi) -> values at xi."""


def hanging_bar_displacement(beam: Beam, g: float, xi: Array) -> Array:
    """u . E3 of a bar that hangs from its left end, eq. (3.5.2) [m]."""
    s = xi / beam.length
    return beam.line_density * g * beam.length**2 / beam.axial_stiffness * (s - s**2 / 2)


def sigma(beam: Beam, g: float) -> tuple[float, float]:
    """sigma_1, sigma_2 of eq. (3.5.5) [1]: the effects of the weight by bending and by shear."""
    weight = beam.line_density * g
    sigma_1 = weight * beam.length**3 / (beam.young * beam.second_moment)
    sigma_2 = (
        2 * (1 + beam.poisson) * weight * beam.length / (beam.shear_correction * beam.axial_stiffness)
    )
    return sigma_1, sigma_2


def clamped_free_displacement(beam: Beam, g: float, xi: Array) -> Array:
    """u . E2 of a Timoshenko beam clamped at its left end, eq. (3.5.3) [m]."""
    s = xi / beam.length
    s1, s2 = sigma(beam, g)
    return (-s1 / 24 * s**3 + s1 / 6 * s**2 + (2 * s2 - s1) / 4 * s - s2) * xi


def clamped_free_director(beam: Beam, g: float, xi: Array) -> Array:
    """delta . E3 of a director of unit length in the same beam, eq. (3.5.4) [1]."""
    s = xi / beam.length
    s1, _ = sigma(beam, g)
    return s1 / 6 * s**3 - s1 / 2 * s**2 + s1 / 2 * s


def clamped_clamped_displacement(beam: Beam, g: float, xi: Array) -> Array:
    """u . E2 of a Timoshenko beam clamped at both ends, eq. (3.5.6) [m]."""
    s = xi / beam.length
    s1, s2 = sigma(beam, g)
    return (-s1 / 24 * s**3 + s1 / 12 * s**2 + (12 * s2 - s1) / 24 * s - s2 / 2) * xi


def clamped_clamped_director(beam: Beam, g: float, xi: Array) -> Array:
    """delta . E3 of a director of unit length in the same beam, eq. (3.5.7) [1]."""
    s = xi / beam.length
    s1, _ = sigma(beam, g)
    return s1 / 6 * s**3 - s1 / 4 * s**2 + s1 / 12 * s


def first_root() -> float:
    """beta_1 L, the first root of cosh cos + 1 = 0, eq. (3.5.13); over pi, (3.5.14)."""
    from scipy.optimize import brentq

    return float(brentq(lambda x: np.cosh(x) * np.cos(x) + 1, 1.8, 1.9, xtol=1e-15))


def first_beam_mode(length: float, xi: Array) -> tuple[Array, Array]:
    """First mode of a clamped-free beam and its slope [1/m]; the displacement of the tip is one.

    A product (3.5.11) that solves (3.5.10): eqs. (3.5.12), (3.5.16).
    """
    b = first_root()
    ratio = (np.cos(b) + np.cosh(b)) / (
        np.sin(b) + np.sinh(b)
    )  # at the tip, not at x as printed (E3.20)
    s = b * xi / length
    shape: Array = np.cosh(s) - np.cos(s) + ratio * (np.sin(s) - np.sinh(s))
    slope: Array = np.sinh(s) + np.sin(s) + ratio * (np.cos(s) - np.cosh(s))
    return shape / 2, b / length * slope / 2


def first_frequency(beam: Beam) -> float:
    """omega_1 of a clamped-free Bernoulli-Euler beam, eq. (3.5.15) [rad/s]."""
    factor = first_root() ** 2 / beam.length**2
    return float(factor * np.sqrt(beam.bending_stiffness / beam.line_density))


def clamped_free_tip_of_published_rod(beam: Beam, g: float, c3: float, c4: float, c5: float) -> float:
    """Tip displacement to which the published rod tends under refinement [m]; not in the thesis.

    derived: in the limit the energy is that of k3 alpha'^2 + k4 theta^2 + k5 theta'^2 over 2, alpha the angle of the
    tangent and theta of shear.  The director carries no load, so k5 theta'' = k4 theta: shear is confined to a layer
    beside the clamp, theta = -alpha(0) exp(-xi sqrt(k4 / k5)), whose energy sqrt(k4 k5) alpha(0)^2 / 2 is a spring
    between clamp and tangent.  The moment M there rotates the beam by M / sqrt(k4 k5); the rest bends with k3.
    """
    weight, length = beam.line_density * g, beam.length
    shear = beam.shear_stiffness
    bending = beam.bending_stiffness
    hinge = weight * length**2 / 2 / np.sqrt(c4 * shear * c5 * bending)
    return float(-weight * length**4 / (8 * c3 * bending) - hinge * length)


def necking_decay(beam: Beam, theory: NeckingTheory) -> float:
    """beta [1/m]: decay rate of the section stretch beside an end that cannot contract.

    "printed" is eq. (3.5.9).  The others follow from k6 lambda'' = k2 (lambda - 1) + k7 (mu - 1) with the axial force
    constant, k6 = mu I as in eqs. (1.2.98) and (2.6.20), and three choices where the thesis is silent:

    "two directors": both lateral stretches equal, the theory of Chapter 1.
    "plane strain": no stretch along E1.
    "free section": no stress along E1.
    """
    slenderness = beam.area / beam.second_moment
    nu = beam.poisson
    squared = {
        "printed": slenderness * (1 + nu) / (1 - nu),
        "two directors": 2 * slenderness * (1 + nu) / (1 - nu),
        "plane strain": 2 * slenderness / (1 - nu),
        "free section": 2 * slenderness * (1 + nu),
    }
    # derived: with n constant, beta^2 = (k2 - k7^2 / k1) / k6, where k1, k2, k7 are the small-strain
    # stiffnesses.  Two directors: E / ((1 - nu) mu) A/I; plane strain: E / ((1 - nu^2) mu) A/I;
    # free in E1: E A / (mu I); and E = 2 (1 + nu) mu.
    return float(np.sqrt(squared[theory]))


def necking_strain(beam: Beam, n: float, beta: float, xi: Array) -> Array:
    """lambda - 1 in a bar pulled by n whose end sections cannot contract, eq. (3.5.8) [1].

    Eq. (3.5.8) rearranged: as printed it subtracts numbers of size cosh(beta l), which leaves no digits at the far end
    of a long bar.
    """
    profile: Array = (np.exp(beta * (xi - beam.length)) + np.exp(-beta * xi)) / (
        1 + np.exp(-beta * beam.length)
    )
    return beam.poisson * n / beam.axial_stiffness * (profile - 1)


def necking_strain_as_printed(beam: Beam, n: float, beta: float, xi: Array) -> Array:
    """Eq. (3.5.8) in the order of operations of the thesis, as evidence that it loses its digits."""
    decay = (1 - np.cosh(beta * beam.length)) / np.sinh(beta * beam.length)
    shape: Array = decay * np.sinh(beta * xi) + np.cosh(beta * xi) - 1
    return beam.poisson * n / beam.axial_stiffness * shape


def rest_pressure(line_density: float, g: float, radius: float) -> float:
    """Pressure in a resting incompressible round body on the ground, over mu_1 mu_2 [Pa]; not in the thesis.

    derived: without muscles lambda_c = 0 and (2.4.13) gives 2 mu_1 + mu_2 - 3 = -R rho_0 g / k_I, mu_1 + 2 mu_2 = 3, so
    mu_1 + mu_2 - 2 = -R rho_0 g / (3 k_I), and (2.8.8), (2.8.9) give mu_1 mu_2 rho_0 g / (3 pi R).
    """
    return float(line_density * g / (3 * np.pi * radius))


@dataclass(frozen=True, kw_only=True)
class PushPullRod:
    """A compressible crawler under its weight, section 2.3: the constants of the closed form.

    k_s, k_p [N], k_g [N m^2] : stiffnesses.  length, radius [m].  weight : rho_0 g [N/m].
    anchoring : D [N].  advancing : p pi R^2 [N].
    """

    k_s: float
    k_p: float
    k_g: float
    length: float
    radius: float
    weight: float
    anchoring: float
    advancing: float

    def stretched_length(self, junction: float) -> float:
        """Length along the ground, eq. (2.5.8) [m], with anchoring loads on [0, junction] and advancing ones beyond.

        derived: with the weight per reference length and mu_3 of (2.3.2) put in, y = mu_1 + mu_2 obeys
        y'' = a^2 (y - b) with a different b on each side of the junction, while mu_1 - mu_2 is constant; y and y'
        continuous and y' = 0 at the ends give y = b + C cosh(a xi) on the left, and likewise on the right.
        """
        from scipy.integrate import quad

        p, k_s, k_g = self.k_p / self.k_s, self.k_s, self.k_g
        weight = self.radius * self.weight
        forces = (-self.anchoring, 0.0)
        loads = (0.0, self.advancing)
        a_sum = np.sqrt(k_s * (1 - p) * (1 + 2 * p) / k_g)
        b_sum = [
            2 - (2 * p * n + 2 * c + weight) / (k_g * a_sum**2)
            for n, c in zip(forces, loads, strict=True)
        ]

        def integrand(xi: float) -> float:
            total, slope = _two_plateaus(a_sum, b_sum, junction, self.length, xi)
            n = forces[0] if xi < junction else forces[1]
            mu_3 = 1 + n / k_s - p * (total - 2)
            return float(np.sqrt(mu_3**2 - (self.radius * slope / 2) ** 2))

        cuts = sorted({0.0, junction, self.length})
        pieces = [
            quad(integrand, a, b, epsabs=1e-13, epsrel=1e-13, limit=200)[0]
            for a, b in itertools.pairwise(cuts)
        ]
        return float(sum(pieces))


def _two_plateaus(
    a: float, b: list[float], junction: float, length: float, xi: float
) -> tuple[float, float]:
    """y and y' of y'' = a^2 (y - b), b[0] before the junction and b[1] after it, y' = 0 at 0 and at `length`."""
    jump = b[1] - b[0]
    left, right = np.tanh(a * junction), np.tanh(a * (length - junction))
    if left + right == 0 or junction in (0.0, length):
        return b[0] if junction == length else b[1], 0.0
    if xi < junction:
        fraction = jump * right / (left + right) / np.cosh(a * junction)
        return b[0] + fraction * np.cosh(a * xi), fraction * a * np.sinh(a * xi)
    fraction = -jump * left / (left + right) / np.cosh(a * (length - junction))
    back = a * (length - xi)
    return b[1] + fraction * np.cosh(back), -fraction * a * np.sinh(back)
