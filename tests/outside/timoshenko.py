"""Timoshenko's beam: exact frequencies by transfer matrices, and finite elements for what is shaken and damped."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh, expm
from scipy.optimize import brentq


@dataclass(frozen=True)
class Piece:
    """A uniform piece of a beam: length [m], EI, kGA, mass and rotary inertia per length (m, J)."""

    length: float
    EI: float
    GA: float
    m: float
    J: float

    @classmethod
    def rectangle(cls, length, height, width, young, line_density, poisson=0.0, correction=5 / 6):
        area = height * width
        shear = correction * young / (2 * (1 + poisson)) * area
        return cls(
            length, young * area * height**2 / 12, shear, line_density, line_density * height**2 / 12
        )

    @classmethod
    def tube(cls, length, diameter, wall, young, density, poisson):
        """A round tube with the shear factor of Cowper (1966), m the inner over the outer radius."""
        outer, inner = diameter / 2, diameter / 2 - wall
        area, second = np.pi * (outer**2 - inner**2), np.pi / 4 * (outer**4 - inner**4)
        square, one = (inner / outer) ** 2, (1 + (inner / outer) ** 2) ** 2
        factor = 6 * (1 + poisson) * one / ((7 + 6 * poisson) * one + (20 + 12 * poisson) * square)
        shear = factor * young / (2 * (1 + poisson)) * area
        return cls(length, young * second, shear, density * area, density * second)

    def part(self, length):
        return Piece(length, self.EI, self.GA, self.m, self.J)

    def transfer(self, omega):
        """Of (w, a, M, Q) over the piece: w' = a + Q/GA, a' = M/EI, M' = -Q - J omega^2 a, Q' = -m omega^2 w."""
        rates = np.array(
            [
                [0, 1, 0, 1 / self.GA],
                [0, 0, 1 / self.EI, 0],
                [0, -self.J * omega**2, 0, -1],
                [-self.m * omega**2, 0, 0, 0],
            ]
        )
        # in units of the beam, so that the exponential is well scaled
        unit = np.array([self.length, 1, self.EI / self.length, self.EI / self.length**2])
        return unit[:, None] * expm(rates * self.length * unit[None, :] / unit[:, None]) / unit[None, :]


def frequencies(pieces, count, tip_mass=0.0, tip_inertia=0.0, start=1.0, factor=1.02, clamped=True):
    """The lowest frequencies [Hz] of a beam clamped (or free) at its first end, free at the last, with a mass there."""
    L, EI = sum(p.length for p in pieces), pieces[0].EI

    def free_end(omega):
        total = np.eye(4)
        for piece in pieces:
            total = piece.transfer(omega) @ total
        w, a, M, Q = total[:, 2:] if clamped else total[:, :2]
        # at the end: M = J omega^2 a and Q = M_tip omega^2 w
        return np.array([M - tip_inertia * omega**2 * a, Q - tip_mass * omega**2 * w])

    def determinant(omega):
        rows = free_end(omega) * np.array([1, L])[:, None] * np.array([1, 1 / L])[None, :]
        return np.linalg.det(rows)

    found, low = [], start
    value = determinant(low)
    while len(found) < count:
        high = low * factor
        after = determinant(high)
        if value * after < 0:
            found.append(brentq(determinant, low, high, xtol=1e-10 * low, rtol=1e-13))
        low, value = high, after
        assert low < 1e9 * np.sqrt(EI), "no frequency found"
    return np.array(found) / (2 * np.pi)


def elements(piece, count):
    """Stiffness and consistent mass of a free beam of `count` elements, (2 count + 2, 2 count + 2): w, a of each node.

    Each has the shape functions that solve the homogeneous static equations, so shear does not lock.
    """
    h = piece.length / count
    phi = 12 * piece.EI / (piece.GA * h * h)
    k = (
        piece.EI
        / (h**3 * (1 + phi))
        * np.array(
            [
                [12, 6 * h, -12, 6 * h],
                [6 * h, (4 + phi) * h * h, -6 * h, (2 - phi) * h * h],
                [-12, -6 * h, 12, -6 * h],
                [6 * h, (2 - phi) * h * h, -6 * h, (4 + phi) * h * h],
            ]
        )
    )
    nodes, weights = np.polynomial.legendre.leggauss(6)
    m = np.zeros((4, 4))
    for node, weight in zip((nodes + 1) / 2, weights / 2, strict=True):
        x = node
        w = np.array(
            [
                1 - 3 * x**2 + 2 * x**3 + phi * (1 - x),
                h * (x - 2 * x**2 + x**3 + phi / 2 * (x - x**2)),
                3 * x**2 - 2 * x**3 + phi * x,
                h * (-(x**2) + x**3 - phi / 2 * (x - x**2)),
            ]
        ) / (1 + phi)
        a = np.array(
            [
                6 / h * (x**2 - x),
                1 - 4 * x + 3 * x**2 + phi * (1 - x),
                6 / h * (x - x**2),
                -2 * x + 3 * x**2 + phi * x,
            ]
        ) / (1 + phi)
        m += weight * h * (piece.m * np.outer(w, w) + piece.J * np.outer(a, a))
    n = 2 * count + 2
    K, M = np.zeros((n, n)), np.zeros((n, n))
    for e in range(count):
        K[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += k
        M[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += m
    return K, M


def shaken(piece, frequency, damping, count=40):
    """Complex amplitudes of the tip [1] and of the force of the clamp [N/m] per amplitude of the clamped end that is
    shaken across; drag 2 zeta omega_1 M v on all but this end."""
    K, M = elements(piece, count)
    lowest = np.sqrt(eigh(K[2:, 2:], M[2:, 2:], eigvals_only=True, subset_by_index=[0, 0])[0])
    omega = 2 * np.pi * frequency
    Z = K + (2j * damping * lowest * omega - omega**2) * M
    u = np.zeros(len(K), dtype=complex)
    u[0] = 1
    u[2:] = np.linalg.solve(Z[2:, 2:], -Z[2:, 0])
    return u[-2], (K[0] - omega**2 * M[0]) @ u
