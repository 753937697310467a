"""A straight rod of pieces whose area centres lie off the line that it is followed by, under forces at its end.

Linear theory, (u, w) the displacement of that line along the rod and across it, a the turning of the section and s the
stretch of its height less one.  With the area centres e above the line

    strain eps = u' - e a',      shear g = w' + e s' - a,      curvature a',

    energy per length [ A eps^2 + B (eps + s)^2 + A s^2 + GA g^2 + EI a'^2 + J s'^2 ] / 2.

So N = (A + B) eps + B s, M = EI a' - e N, t = J s' + e Q; N and Q are constant, M' = -Q and t' = B eps + (A + B) s.
A vibration takes omega^2 times the momenta from these, the kinetic energy per length being

    m [ (u' - e a')^2 + (w' + e s')^2 + k^2 (a'^2 + s'^2) ] / 2      with rates instead of slopes.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq, newton


@dataclass(frozen=True)
class Piece:
    """length, e [m]; A = 2 mu area, B = Lambda area, GA [N]; EI, J = mu I [N m^2]; m [kg/m], k^2 = I / area [m^2]."""

    length: float
    e: float
    A: float
    B: float
    GA: float
    EI: float
    J: float
    m: float
    square: float

    @classmethod
    def rectangle(cls, length, height, width, young, poisson, centreline, density=0.0, correction=5 / 6):
        """Its sections are free to contract; the line lies at that share of the height."""
        mu, area = young / (2 * (1 + poisson)), height * width
        square = height**2 / 12
        first = young * poisson / (1 - poisson**2)
        return cls(
            length=length,
            e=(0.5 - centreline) * height,
            A=2 * mu * area,
            B=first * area,
            GA=correction * mu * area,
            EI=young * area * square,
            J=mu * area * square,
            m=density * area,
            square=square,
        )

    @property
    def EA(self):
        """Where the height is free: B eps + (A + B) s = 0."""
        return self.A + self.B - self.B**2 / (self.A + self.B)

    def rates(self, omega):
        """Of (u, w, a, s, N, Q, M, t)."""
        both, R = self.A + self.B, np.zeros((8, 8))
        R[2, 6], R[2, 4] = 1 / self.EI, self.e / self.EI
        R[3, 7], R[3, 5] = 1 / self.J, -self.e / self.J
        R[0] = self.e * R[2]
        R[0, 4] += 1 / both
        R[0, 3] -= self.B / both
        R[1] = -self.e * R[3]
        R[1, 2], R[1, 5] = 1, R[1, 5] + 1 / self.GA
        R[6, 5] = -1
        R[7, 4], R[7, 3] = self.B / both, both - self.B**2 / both
        e, polar = self.e, self.e**2 + self.square
        inertia = [[1, 0, -e, 0], [0, 1, 0, e], [-e, 0, polar, 0], [0, e, 0, polar]]
        R[4:, :4] -= omega**2 * self.m * np.array(inertia)
        return R


def _equations(pieces, omega=0.0):
    """Transfer over all pieces, clamped and free ends, of the states at their ends in units of order one; forces in A.

    Pieces are cut to half their height, so that no transfer matrix grows beyond what elimination can bear.
    """
    steps = []
    for piece in pieces:
        count = int(np.ceil(piece.length / np.sqrt(3 * piece.square)))
        steps += [expm(piece.rates(omega) * piece.length / count)] * count
    n = len(steps)
    rows = np.zeros((8 * n + 8, 8 * n + 8))
    for k, step in enumerate(steps):
        rows[8 * k : 8 * k + 8, 8 * k : 8 * k + 8] = step
        rows[8 * k : 8 * k + 8, 8 * k + 8 : 8 * k + 16] = -np.eye(8)
    rows[8 * n : 8 * n + 4, :4] = rows[8 * n + 4 :, 8 * n + 4 :] = np.eye(4)
    unit = np.tile([1.0] * 4 + [pieces[0].A] * 4, n + 1)
    return rows * unit[None, :] / unit[:, None]


def linear_tip(pieces, along, across):
    """(u, w) of the free end of a clamped rod under forces on the line there [m], with its layers of stretch."""
    rows = _equations(pieces)
    right = np.zeros(len(rows))
    right[-4:] = np.array([along, across, 0, 0]) / pieces[0].A
    return np.linalg.solve(rows, right)[-8:-6]


def frequencies(pieces, count, start, factor=1.05):
    """The lowest ones of a clamped rod above `start` [Hz], where the determinant of its equations changes sign."""

    _, scale = np.linalg.slogdet(_equations(pieces, 2 * np.pi * start))

    def determinant(frequency):
        sign, size = np.linalg.slogdet(_equations(pieces, 2 * np.pi * frequency))
        return sign * np.exp(size - scale)

    found, low, before = [], start, determinant(start)
    while len(found) < count:
        high = factor * low
        after = determinant(high)
        if before * after < 0:
            found.append(brentq(determinant, low, high, rtol=1e-11))
        low, before = high, after
    return np.array(found)


def beam_tip(pieces, along, across):
    """The same in closed form without the layers: curvature (across (L - x) + along e) / EI, strain along / EA.

    derived: over a piece from b to c before the end the integrals of 1, z and z^2 are those of z = L - x.
    """
    u = w = 0.0
    c = sum(piece.length for piece in pieces)
    for piece in pieces:
        b = c - piece.length
        one, z, square = c - b, (c**2 - b**2) / 2, (c**3 - b**3) / 3
        e, c = piece.e, b
        u += along * one / piece.EA + e * (across * z + along * e * one) / piece.EI
        w += across * one / piece.GA + (across * square + along * e * z) / piece.EI
    return np.array([u, w])


def large_tip(pieces, along, across, curvature=0.0):
    """Where the free end of a clamped rod is under dead forces on the line there, (x, y) [m]; no section stretch.

    curvature : K of the line at rest [1/m], where the area centres are 1 - K e times as far apart.

    Reissner's rod through the area centres, which are e above the line: x' = (1 + N/EA + e a', Q/GA) in the frame of
    the section and EI a' = M + e N, M the moment about the line, which at the clamp is found by shooting.
    """

    def shot(first):
        y = np.array([0.0, 0.0, 0.0, first])
        for p in pieces:

            def rates(_, y, p=p):
                c, s = np.cos(y[2]), np.sin(y[2])
                N, Q = along * c + across * s, across * c - along * s
                apart = 1 - curvature * p.e
                turn = curvature + apart * (y[3] + p.e * N) / p.EI
                on, aside = apart * (1 + N / p.EA) + p.e * turn, apart * Q / p.GA
                dx, dy = on * c - aside * s, on * s + aside * c
                return [dx, dy, turn, along * dy - across * dx]

            y = solve_ivp(rates, (0, p.length), y, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
        return y

    L = sum(p.length for p in pieces)
    x, y = (
        (np.sin(curvature * L), 1 - np.cos(curvature * L)) / np.array(curvature) if curvature else (L, 0)
    )
    moment = across * x - along * y
    first = newton(
        lambda moment: shot(moment)[3], moment, x1=moment + 1e-3 * pieces[0].EI, tol=1e-13 * pieces[0].EI
    )
    return shot(first)[:2]
