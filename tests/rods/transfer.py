"""A straight Timoshenko beam by transfer matrices, with springs, foundations, masses and forces: exact answers.

The state is y = (u, w, a, N, Q, M, 1): displacements along E3 and E2, rotation from E3 towards E2, force components and
moment of the section, all times exp(i omega t).  In a part of the beam with a foundation (k, c) and a drag -d m v,

    u' = N / EA,  w' = a + Q / GA,  a' = M / EI,
    N' = -m o u,  Q' = (k - m o) w,  M' = -Q + (c - J o) a,  with o = omega^2 - i omega d.

At a point with a stiffness K (3, 3) and a load f (3,) the forces (N, Q, M) jump by K (u, w, a) - f.
"""

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq


class Beam:
    """Stiffnesses and masses of a uniform beam of a case; its rod is a rectangle with nu = 0."""

    def __init__(self, rod):
        b, h, E = rod.width, rod.height, rod.young
        assert rod.poisson == 0
        self.L, self.EA, self.EI, self.GA = (
            rod.length,
            E * b * h,
            E * b * h**3 / 12,
            5 / 6 * E / 2 * b * h,
        )
        self.m, self.J = rod.line_density, rod.line_density * h**2 / 12

    def part(self, length, k=0.0, c=0.0):
        """A part with a foundation across and against rotation."""

        def matrix(omega, drag=0.0):
            o = omega**2 - 1j * omega * drag if drag else omega**2
            rates = np.zeros((7, 7), dtype=complex if drag else float)
            rates[0, 3], rates[1, 4], rates[2, 5] = 1 / self.EA, 1 / self.GA, 1 / self.EI
            rates[1, 2], rates[5, 4] = 1, -1
            rates[3, 0], rates[4, 1], rates[5, 2] = -self.m * o, k - self.m * o, c - self.J * o
            unit = np.array([1, 1, 1 / self.L, *np.array([1, 1, self.L]) * self.EI / self.L**3, 1])
            return unit[:, None] * expm(rates * length * unit / unit[:, None]) / unit

        return matrix


def point(stiffness=None, mass=None, load=(0, 0, 0)):
    """A point with a stiffness and a mass matrix (3, 3) of (u, w, a), and a load."""

    def matrix(omega, drag=0.0):
        jump = np.eye(7, dtype=complex if drag else float)
        for given, factor in ((stiffness, 1.0), (mass, -(omega**2))):
            if given is not None:
                jump[3:6, :3] += factor * np.asarray(given)
        jump[3:6, 6] -= load
        return jump

    return matrix


def carried(mass, inertia=0.0, a=0.0, b=0.0):
    """Mass matrix of (u, w, a) of a mass at the distance a along the beam and b across it."""
    m = mass
    return np.array([[m, 0, -m * b], [0, m, m * a], [-m * b, m * a, m * (a * a + b * b) + inertia]])


CLAMPED, FREE = np.eye(6)[:3], np.eye(6)[3:]
"""Rows that are zero at an end."""


def oblique(angle):
    """Rows of an end on a roller that moves at an angle from E3: no displacement across it, no force along it."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[-s, c, 0, 0, 0, 0], [0, 0, 0, c, s, 0], [0, 0, 0, 0, 0, 1.0]])


def _ends(first, steps, last, omega, drag=0.0):
    total = np.eye(7)
    for step in steps:
        total = step(omega, drag) @ total
    free = np.linalg.svd(first)[2][3:].T  # what the first end leaves open, (6, 3)
    return last @ total[:6, :6] @ free, last @ total[:6, 6], free, total


def answer(first, steps, last, omega=0.0, drag=0.0, given=None):
    """State at both ends under the loads; given : (6,) added to the first one."""
    given = np.zeros(6) if given is None else given
    A, b, free, total = _ends(first, steps, last, omega, drag)
    rows = 1 / np.abs(A).max(axis=1)
    start = free @ np.linalg.solve(rows[:, None] * A, -rows * (b + last @ total[:6, :6] @ given)) + given
    return start, (total @ np.append(start, 1))[:6]


def frequencies(first, steps, last, count, low=0.5, factor=1.01):
    """The lowest angular frequencies."""
    scale = np.abs(_ends(first, steps, last, low)[0]).max(axis=1)

    def determinant(omega):
        return np.linalg.det(_ends(first, steps, last, omega)[0] / scale[:, None])

    found, value = [], determinant(low)
    while len(found) < count:
        high = factor * low
        after = determinant(high)
        if value * after < 0:
            found.append(brentq(determinant, low, high, rtol=1e-13))
        low, value = high, after
        assert low < 1e7
    return np.array(found)
