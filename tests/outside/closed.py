"""Closed forms: beams that statics alone determines, bars, bodies under pressure, a rigid pendulum."""

import itertools

import numpy as np
from scipy.integrate import quad

GAUSS = np.polynomial.legendre.leggauss(8)


def overhanging_tip(length, hinge, q, EI, GA):
    """Sag of the free end of a beam on hinges at 0 and `hinge` under q across it [m], and both reactions [N].

    By a unit force at the end: integral of M m / EI and of Q v / GA.
    """
    right = q * length**2 / 2 / hinge
    left = q * length - right
    nodes, weights = GAUSS
    sag = 0.0
    for a, b in ((0, hinge), (hinge, length)):
        s = (a + b) / 2 + (b - a) / 2 * nodes
        if a == 0:
            M, Q = left * s - q * s**2 / 2, left - q * s
            unit = 1 - length / hinge  # reaction at 0 of a unit force down at the end
            m, v = unit * s, unit
        else:
            M, Q = -q * (length - s) ** 2 / 2, q * (length - s)
            m, v = -(length - s), 1.0
        sag += (b - a) / 2 * weights @ (M * m / EI + Q * v / GA)
    return sag, left, right


def couple_at_middle(length, moment, EI, GA):
    """Reactions of a simple beam under a couple at its middle (first, last) [N] and the turn there [rad]."""
    return (
        moment / length,
        -moment / length,
        moment * length / (12 * EI) + moment / (GA * length),
    )


def toggle(length, angle, down, EA):
    """Force that holds the apex of an inclined linear bar moved down by `down` [N], positive down."""
    base, height = length * np.cos(angle), length * np.sin(angle) - down
    now = np.hypot(base, height)
    return EA * (1 - now / length) * height / now


def toggle_limit(length, angle, EA):
    """The largest force that it takes: where cos^3 of its slope is the cosine at rest [N]."""
    now = np.arccos(np.cos(angle) ** (1 / 3))
    return toggle(length, angle, length * (np.sin(angle) - np.cos(angle) * np.tan(now)), EA)


def struck_bar(length, force, EA, speed, t):
    """Displacement of the end of a bar held at the other, under a force that begins at t = 0 (D'Alembert)."""
    phase = np.mod(t * speed / length, 4.0)
    return force * length / EA * (2 - np.abs(phase - 2))


def squeezed(pressure, young, poisson):
    """Strains of a body under pressure on its sides alone: along it and across it (Lame)."""
    return 2 * poisson * pressure / young, -(1 - poisson) * pressure / young


def swung(length, line_density, height, torque, t):
    """Angle of a rigid rod that turns about its first end under a torque [rad]."""
    J = line_density * (length**3 / 3 + length * height**2 / 12)
    return torque * t**2 / (2 * J)


def cantilever_tip(force, length, EI, GA=lambda s: np.inf, breaks=()):
    """Tip of a clamped beam whose stiffnesses vary under a force across its end."""
    points = sorted({0.0, length, *breaks})
    return sum(
        quad(lambda s: force * ((length - s) ** 2 / EI(s) + 1 / GA(s)), a, b, epsabs=0, epsrel=1e-12)[0]
        for a, b in itertools.pairwise(points)
    )


def pulled(force, length, EA, breaks=()):
    """Stretch of a bar whose stiffness varies."""
    points = sorted({0.0, length, *breaks})
    return sum(
        quad(lambda s: force / EA(s), a, b, epsabs=0, epsrel=1e-12)[0]
        for a, b in itertools.pairwise(points)
    )


def inner_forces(length, s, force, line_load):
    """N, Q and M at s of a simple beam that its first end holds along it, N positive in tension.

    force : place [m], angle [rad] and size [N].  line_load : from, to [m], and q across it, downwards [N/m].
    What is beyond a cut holds what is before it: Q is the sum of the forces across there, M that of their moments.
    """
    at, angle, size = force
    start, end, q = line_load
    along, across = size * np.cos(angle), size * np.sin(angle)
    total, centre = q * (end - start), (start + end) / 2
    last = (total * centre - across * at) / length  # moments about the first end
    beyond = s < at
    low = np.clip(s, start, end)
    rest, arm = q * (end - low), (end + low) / 2 - s
    N = np.where(beyond, along, 0.0)
    Q = last - rest + np.where(beyond, across, 0.0)
    M = last * (length - s) - rest * arm + np.where(beyond, across * (at - s), 0.0)
    return N, Q, M


def shocked_bar(length, speed, EA, force, duration, t):
    """Displacement of the end of a bar under half a sine of force, and the force on the wall at its other end.

    D'Alembert: u(L, t) = c / EA (I(t) - 2 I(t - 2 L/c) + 2 I(t - 4 L/c) - ...), I the impulse of the force so far; the
    wall carries 2 (F(t - L/c) - F(t - 3 L/c) + ...).
    """

    def impulse(t):
        part = np.clip(t, 0.0, duration)
        return force * duration / np.pi * (1 - np.cos(np.pi * part / duration))

    def push(t):
        return np.where((t > 0) & (t < duration), force * np.sin(np.pi * t / duration), 0.0)

    once = length / speed
    tip, wall = impulse(t), np.zeros_like(t)
    for k in range(1, int(t[-1] / once) // 2 + 2):
        tip = tip + 2 * (-1) ** k * impulse(t - 2 * k * once)
        wall = wall - 2 * (-1) ** k * push(t - (2 * k - 1) * once)
    return speed / EA * tip, wall


def rail(force, foundation, EI, GA):
    """Deflection under a force on an infinite beam on a foundation [m], and its moment at a distance [N m].

    w = Re C exp(-r x), of EI d4w/dx4 - k EI / GA d2w/dx2 + k w = 0 beside the force, with shear in the beam: the
    section under the force does not turn, and Q jumps by the force.  Without shear P b / 2 k and P / 4 b (Hetenyi).
    """
    square = complex(foundation / (2 * GA), np.sqrt(foundation / EI - (foundation / (2 * GA)) ** 2))
    r = np.sqrt(square)
    turn, across = foundation / (r * GA) - r, foundation / r
    C = complex(*np.linalg.solve([[z.real, -z.imag] for z in (turn, across)], [0, force / 2]))
    return C.real, lambda x: -(EI * (square - foundation / GA) * C * np.exp(-r * x)).real


def bar_let_go(length, force, EA, speed, t):
    """Displacement of the end of a bar that a force had stretched, from the instant at which it ends (D'Alembert)."""
    return force * length / EA - struck_bar(length, force, EA, speed, t)
