"""Reissner's planar rod as a boundary value problem: extensible, shearable, curved at rest, under dead loads.

Lengths are counted in L, forces in EI / L^2, so that the unknowns are of order one:

    x' = (1 + N/EA) cos a - (Q/GA) sin a        Nx' = -px      M' = -(x' Ny - y' Nx)
    y' = (1 + N/EA) sin a + (Q/GA) cos a        Ny' = -py      a' = K + M/EI

a is the angle of the section, N and Q the components of the force (Nx, Ny) along and across its normal.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.integrate import solve_bvp, solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipk

FREE = {"Nx": 0.0, "Ny": 0.0, "M": 0.0}
CLAMP = {"x": 0.0, "y": 0.0, "a": 0.0}
ORDER = ("x", "y", "a", "Nx", "Ny", "M")


@dataclass(frozen=True)
class Rod:
    """length [m], EI [N m^2], EA and GA [N], curvature at rest K [1/m]; x along the rod, y across.

    K : a number, or a function of the arc length [m].  first : angle of the rod at rest at its first end [rad].
    """

    length: float
    EI: float
    EA: float = np.inf
    GA: float = np.inf
    K: float | Callable = 0.0
    first: float = 0.0

    @classmethod
    def rectangle(cls, length, height, width, young, poisson=0.0, correction=5 / 6, curvature=0.0):
        area = height * width
        shear = correction * young / (2 * (1 + poisson)) * area
        return cls(length, young * area * height**2 / 12, young * area, shear, curvature)

    @classmethod
    def circle(cls, length, diameter, young, poisson=0.0):
        """With the shear factor of Cowper (1966)."""
        area = np.pi * diameter**2 / 4
        shear = 6 * (1 + poisson) / (7 + 6 * poisson) * young / (2 * (1 + poisson)) * area
        return cls(length, young * area * diameter**2 / 16, young * area, shear)

    def turning(self, s):
        """The curvature at rest at the fractions s of the length, counted in 1 / L."""
        return self.length * (self.K(self.length * s) if callable(self.K) else self.K)

    @property
    def unit(self):
        """Of a force [N]."""
        return self.EI / self.length**2


@dataclass(frozen=True)
class Load:
    """What is asked of both ends, three of x, y, a, Nx, Ny, M each [m, rad, N, N m], and a load per length [N/m]."""

    first: dict
    last: dict
    px: float = 0.0
    py: float = 0.0

    def times(self, factor, rest):
        """That share of it, counted from the shape at rest of the ends."""

        def part(asked, at_rest):
            return {
                k: at_rest.get(k, 0.0) + factor * (v - at_rest.get(k, 0.0)) for k, v in asked.items()
            }

        return replace(
            self,
            first=part(self.first, rest[0]),
            last=part(self.last, rest[1]),
            px=factor * self.px,
            py=factor * self.py,
        )


def at_rest(rod, s):
    """The shape without loads, (6, len(s)), in lengths of the rod."""
    y = np.zeros((6, s.size))
    if callable(rod.K) or rod.first:

        def rates(s, y):
            return [np.cos(y[2]), np.sin(y[2]), rod.turning(s)]

        y[:3] = solve_ivp(rates, (0, 1), [0, 0, rod.first], t_eval=s, rtol=1e-11, atol=1e-12).y
        return y
    k = rod.K * rod.length
    y[2] = k * s
    y[0], y[1] = (s, 0 * s) if k == 0 else (np.sin(k * s) / k, (1 - np.cos(k * s)) / k)
    return y


def equilibrium(rod, load, *, steps=20, through=(), tolerance=1e-8):
    """Shape and forces where the load has grown in steps, (6, 401) in units of the problem: metres, newtons.

    through : loads that are met on the way, the first of which grows, each reached from the one before.
    """
    mesh = np.linspace(0, 1, 41)
    y = at_rest(rod, mesh)
    ends = [dict(zip(ORDER[:3], y[:3, k] * [rod.length, rod.length, 1], strict=True)) for k in (0, -1)]
    first, *rest = [*through, load]
    stages = [first.times((k + 1) / steps, ends) for k in range(steps)] + rest
    for stage in stages:
        done = _solve(rod, stage, mesh, y, 1e-4)
        mesh, y = done.x, done.y
    done = _solve(rod, load, mesh, y, tolerance)
    scale = np.array([rod.length] * 2 + [1.0] + [rod.unit] * 2 + [rod.unit * rod.length])
    return done.sol(np.linspace(0, 1, 401)) * scale[:, None]


def _solve(rod, load, mesh, guess, tolerance):
    axial, shear = rod.unit / rod.EA, rod.unit / rod.GA
    px, py = load.px * rod.length / rod.unit, load.py * rod.length / rod.unit
    scale = dict(
        zip(ORDER, [rod.length, rod.length, 1, rod.unit, rod.unit, rod.unit * rod.length], strict=True)
    )
    asked = [
        (side, ORDER.index(name), value / scale[name])
        for side, wanted in ((0, load.first), (1, load.last))
        for name, value in wanted.items()
    ]
    of_ends = np.zeros((2, 6, 6))
    for row, (side, k, _) in enumerate(asked):
        of_ends[side, row, k] = 1

    def parts(y):
        c, s = np.cos(y[2]), np.sin(y[2])
        along, across = 1 + axial * (y[3] * c + y[4] * s), shear * (y[4] * c - y[3] * s)
        return c, s, along * c - across * s, along * s + across * c

    def rates(s, y):
        _, _, dx, dy = parts(y)
        still = np.zeros_like(dx)
        return np.array([dx, dy, rod.turning(s) + y[5], still - px, still - py, dy * y[3] - dx * y[4]])

    def by_unknowns(_, y):
        c, s, dx, dy = parts(y)
        J = np.zeros((6, 6, y.shape[1]))
        # along changes by axial Q, across by -shear N with the angle, on top of the turning of the frame
        J[0, 2] = -dy + axial * (y[4] * c - y[3] * s) * c + shear * (y[3] * c + y[4] * s) * s
        J[1, 2] = dx + axial * (y[4] * c - y[3] * s) * s - shear * (y[3] * c + y[4] * s) * c
        J[0, 3], J[0, 4] = axial * c * c + shear * s * s, (axial - shear) * s * c
        J[1, 3], J[1, 4] = (axial - shear) * s * c, axial * s * s + shear * c * c
        J[2, 5] = 1
        J[5] = J[1] * y[3] - J[0] * y[4]
        J[5, 3] += dy
        J[5, 4] -= dx
        return J

    def ends(a, b):
        return np.array([(a, b)[side][k] - value for side, k, value in asked])

    done = solve_bvp(
        rates,
        ends,
        mesh,
        guess,
        fun_jac=by_unknowns,
        bc_jac=lambda a, b: (of_ends[0], of_ends[1]),
        tol=tolerance,
        max_nodes=20000,
    )
    assert done.success, done.message
    return done


def tip(rod, load, **how):
    """Where the last end is (x, y) [m]."""
    return equilibrium(rod, load, **how)[:2, -1]


def column_beyond(rod, pushed, aside, strong=0.02):
    """The state of a clamped-free column under an end force -pushed along it and `aside` across, grown together.

    The pitchfork opens: the side force decides, however small.  So the load is grown with a strong side force of the
    same sign, which is then taken away; the state moves steadily on the same branch.
    """
    loads = [
        Load(CLAMP, {"Nx": -pushed, "Ny": force, "M": 0.0})
        for force in (np.sign(aside) * strong * pushed * np.array([1, 0.5, 0.2, 0.1, 0.03, 0.01]))
    ]
    return equilibrium(rod, Load(CLAMP, {"Nx": -pushed, "Ny": aside, "M": 0.0}), through=loads, steps=40)


# ---------------------------------------------------------------- buckling loads, shear and shortening included


def buckling_load(rod, ends):
    """Critical end force [N]: k^2 = P b / EI, b = 1 - P/EA + P/GA, where k L is that of the ends.

    Clamped and hinged: tan k L = k L (1 - P / (GA b)), since the force across shears the rod as well.
    """

    def wave(P):
        return np.sqrt(P * (1 - P / rod.EA + P / rod.GA) / rod.EI) * rod.length

    euler = np.pi**2 * rod.EI / rod.length**2
    if ends == "clamped-hinged":

        def missing(P):
            k, b = wave(P), 1 - P / rod.EA + P / rod.GA
            return np.sin(k) - k * (1 - P / (rod.GA * b)) * np.cos(k)

        return brentq(missing, 1.5 * euler, 2.5 * euler, xtol=1e-12 * euler)
    asked = {"hinged-hinged": np.pi, "clamped-free": np.pi / 2, "clamped-clamped": 2 * np.pi}[ends]
    return brentq(lambda P: wave(P) - asked, 0.1 * euler, 8 * euler, xtol=1e-12 * euler)


def greenhill(rod):
    """Critical weight per length of a clamped-free column [N/m]: EI a'' + w (L - s) b(s) a = 0."""
    L, unit = rod.length, rod.EI / rod.length**3

    def missing(w):
        def rates(s, y):
            P = w * (L - s)
            return [y[1] / rod.EI, -P * (1 - P / rod.EA + P / rod.GA) * y[0]]

        return solve_ivp(rates, (0, L), [0, rod.EI], method="DOP853", rtol=1e-12, atol=1e-14 * rod.EI).y[
            1, -1
        ]

    return brentq(missing, 6 * unit, 9 * unit, xtol=1e-11 * unit)


# ---------------------------------------------------------------- the inextensible elastica, for the check of the code


def elastica_tip(force):
    """Tip (x, y) / L of a clamped rod under force = P L^2 / EI across it: EI a'^2 / 2 = P (sin A - sin a).

    With a = A - z^2 the integrands are smooth, for sin A - sin a = 2 cos((A + a) / 2) sin(z^2 / 2).
    """
    nodes, weights = np.polynomial.legendre.leggauss(60)

    def over(A, weight):
        z = np.sqrt(A) / 2 * (1 + nodes)
        a = A - z * z
        ds = 2 / np.sqrt(2 * force * np.cos((A + a) / 2) * np.sinc(z * z / (2 * np.pi)))
        return np.sqrt(A) / 2 * weights @ (weight(a) * ds)

    A = brentq(lambda A: over(A, np.ones_like) - 1, 1e-6, np.pi / 2 - 1e-9, xtol=1e-14)
    return over(A, np.cos), over(A, np.sin)


def column_load(tip_angle):
    """P L^2 / EI at which the tip of a clamped-free column has turned by the angle."""
    return ellipk(np.sin(tip_angle / 2) ** 2) ** 2


# ---------------------------------------------------------------- chains


def catenary(length, weight, EA, span, rise):
    """Tension at both ends [N] and shape of an elastic catenary from (0, 0) to (span, rise), weight per length at rest.

    T_A = (-H, -V): x(s) = H s/EA + H/w [asinh((V + w s)/H) - asinh(V/H)] and y alike.
    Returns H, T_A, T_B and the function s -> (x, y).
    """

    def shape(H, V, s):
        U = V + weight * s
        x = H * s / EA + H / weight * (np.arcsinh(U / H) - np.arcsinh(V / H))
        y = (U**2 - V**2) / (2 * EA * weight) + (np.hypot(H, U) - np.hypot(H, V)) / weight
        return x, y

    def lift(H):
        low, high = -10 * weight * length, 10 * weight * length
        return brentq(lambda V: shape(H, V, length)[1] - rise, low, high, xtol=1e-9)

    H = brentq(
        lambda H: shape(H, lift(H), length)[0] - span, 1e-3 * weight * length, EA * 0.01, xtol=1e-8
    )
    V = lift(H)
    return H, np.hypot(H, V), np.hypot(H, V + weight * length), lambda s: shape(H, V, s)
