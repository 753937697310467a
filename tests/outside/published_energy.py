"""The energy of eq. (3.4.11) with (3.4.13) for a uniform straight rod, and its damped motion, in plain NumPy.

Points of the plane are complex numbers x3 + i x2, so that an angle is an argument and its gradient is i v / |v|^2.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh


@dataclass(frozen=True)
class Beam:
    """A straight uniform rod of rectangular section, centreline in the middle; c holds c1 ... c7."""

    vertices: int
    length: float
    height: float
    width: float
    young: float
    poisson: float
    line_density: float
    shear_correction: float
    c: tuple[float, ...]
    coupling: float = 0.5  # of the last term of (3.4.11) as printed

    @property
    def h(self):
        return self.length / (self.vertices - 1)

    @property
    def part(self):
        """Length that belongs to each vertex."""
        part = np.full(self.vertices, self.h)
        part[[0, -1]] /= 2
        return part

    @property
    def stiffness(self):
        """k1 ... k7."""
        E, nu = self.young, self.poisson
        A, EI = self.width * self.height, E * self.width * self.height**3 / 12
        lame = E / ((1 + nu) * (1 - 2 * nu))
        each = (
            lame * A * (1 - nu),
            lame * A * (1 - nu),
            EI,
            self.shear_correction * E / (2 * (1 + nu)) * A,
            EI,
            EI / (1 + nu),
            lame * A * nu * self.coupling,
        )
        return [c * k for c, k in zip(self.c, each, strict=True)]

    @property
    def reference(self):
        """Vertices and directors."""
        x = np.linspace(0, self.length, self.vertices).astype(complex)
        return x, np.full(self.vertices, 0.5j * self.height)

    @property
    def mass(self):
        """Of vertices and of directors: (1, Y22) times rho0 L, with Y22 = 1/3."""
        own = self.line_density * self.part
        return own, own / 3


def chords(x):
    return np.concatenate([[x[1] - x[0]], x[2:] - x[:-2], [x[-1] - x[-2]]])


def energy(beam, x, d):
    """Pi [J] at vertices x and directors d, (N,) each."""
    k1, k2, k3, k4, k5, k6, k7 = beam.stiffness
    h, L, D = beam.h, beam.part, beam.height / 2
    e, c = np.diff(x), chords(x)
    mu_edge, lam = np.abs(e) / h, np.abs(d) / D
    theta = np.angle(d * np.conj(1j * c))
    phi = np.angle(e[1:] * np.conj(e[:-1]))
    stretched = (mu_edge[1:] + mu_edge[:-1]) / 2  # of the inner vertices of equal edges

    def well(s):
        return s * s - s + 1 / s - 1

    twice = (
        k1 * h * well(mu_edge).sum()
        + k2 * (L * well(lam)).sum()
        + k3 * h * ((2 / h * np.tan(phi / 2)) ** 2).sum()
        + k4 * (L * np.tan(theta) ** 2).sum()
        + k5 / h * (np.diff(theta) ** 2).sum()
        + k6 / h * (np.diff(lam) ** 2).sum()
        + 2 * k7 * h * ((lam[1:-1] - 1) * (stretched - 1)).sum()
    )
    return twice / 2


def gradient(beam, x, d):
    """Derivatives of Pi by x and d, as complex numbers like them."""
    k1, k2, k3, k4, k5, k6, k7 = beam.stiffness
    return _gradient(x, d, beam.h, beam.part, beam.height / 2, k1, k2, k3, k4, k5, k6, k7)


def _gradient(x, d, h, L, D, k1, k2, k3, k4, k5, k6, k7):
    e, c = np.diff(x), chords(x)
    m, r = np.abs(e), np.abs(d)
    mu, lam = m / h, r / D
    theta = np.angle(d * np.conj(1j * c))
    turn = np.tan(np.angle(e[1:] * np.conj(e[:-1])) / 2)
    t = np.tan(theta)
    by_theta = k4 * L * t * (1 + t * t)
    jump = k5 / h * np.diff(theta)
    by_theta[1:] += jump
    by_theta[:-1] -= jump
    by_lam = k2 / 2 * L * (2 * lam - 1 - 1 / lam**2)
    jump = k6 / h * np.diff(lam)
    by_lam[1:] += jump
    by_lam[:-1] -= jump
    by_mu = k1 / 2 * h * (2 * mu - 1 - 1 / mu**2)
    if k7:
        by_lam[1:-1] += k7 * h * ((mu[1:] + mu[:-1]) / 2 - 1)
        part = k7 * h / 2 * (lam[1:-1] - 1)
        by_mu[1:] += part
        by_mu[:-1] += part
    by_phi = 2 * k3 / h * turn * (1 + turn * turn)
    by_angle = np.zeros(m.size)  # of an edge
    by_angle[1:] += by_phi
    by_angle[:-1] -= by_phi
    on_edge = e * (by_mu / (h * m) + 1j * by_angle / (m * m))
    on_chord = -1j * by_theta * c / np.abs(c) ** 2
    on_x = np.zeros(x.size, complex)
    on_x[1:] += on_edge
    on_x[:-1] -= on_edge
    on_x[1:] += on_chord[:-1]
    on_x[:-1] -= on_chord[1:]
    on_x[0] -= on_chord[0]
    on_x[-1] += on_chord[-1]
    return on_x, d * (1j * by_theta / (r * r) + by_lam / (D * r))


def frequencies(beam, count):
    """The lowest of the clamped beam about its reference [rad/s], by central differences of the gradient."""
    x, d = beam.reference
    n = x.size - 1
    start = np.concatenate([x[1:], d[1:]]).view(float)

    def force(y):
        z = y.view(complex)
        on_x, on_d = gradient(beam, np.append(x[0], z[:n]), np.append(d[0], z[n:]))
        return np.concatenate([on_x[1:], on_d[1:]]).view(float)

    step = 1e-6 * beam.h
    columns = [(force(start + s) - force(start - s)) / (2 * step) for s in step * np.eye(start.size)]
    hessian = np.array(columns)
    own, turning = beam.mass
    mass = np.repeat(np.concatenate([own[1:], turning[1:]]), 2)
    return np.sqrt(eigh((hessian + hessian.T) / 2, np.diag(mass), eigvals_only=True)[:count])


def lowest_frequency(beam):
    """The first of `frequencies`."""
    return frequencies(beam, 1)[0]


def first_beam_mode(length, xi):
    """Shape of a clamped-free Euler beam, 1 at its tip, and its slope."""
    b = 1.8751040687119612
    s = (np.sinh(b) - np.sin(b)) / (np.cosh(b) + np.cos(b))
    z = b * xi / length
    shape = np.cosh(z) - np.cos(z) - s * (np.sinh(z) - np.sin(z))
    slope = b / length * (np.sinh(z) + np.sin(z) - s * (np.cosh(z) - np.cos(z)))
    return shape / 2, slope / 2


def plucked(beam, amplitude, damping, times, tolerance, method="DOP853"):
    """Total energy at the times [J] of the clamped beam released from its first shape, M q'' = -dPi/dq - c M q'."""
    x, d = beam.reference
    shape, slope = first_beam_mode(beam.length, x.real)
    bent = x + 1j * amplitude * shape
    turned = d * np.exp(1j * np.arctan(amplitude * slope))
    n = x.size - 1
    own, turning = (mass[1:] for mass in beam.mass)
    damping_rate = 2 * damping * lowest_frequency(beam)
    clamp_x, clamp_d = x[:1], d[:1]
    fixed = (beam.h, beam.part, beam.height / 2, *beam.stiffness)

    def rates(_, y):
        z = y.view(complex)
        v = z[2 * n :]
        on_x, on_d = _gradient(
            np.concatenate([clamp_x, z[:n]]), np.concatenate([clamp_d, z[n : 2 * n]]), *fixed
        )
        out = np.empty_like(z)
        out[: 2 * n] = v
        out[2 * n : 3 * n] = -on_x[1:] / own - damping_rate * v[:n]
        out[3 * n :] = -on_d[1:] / turning - damping_rate * v[n:]
        return out.view(float)

    start = np.concatenate([bent[1:], turned[1:], np.zeros(2 * n)]).astype(complex).view(float)
    done = solve_ivp(
        rates,
        (0, times[-1]),
        start,
        method=method,
        t_eval=times,
        rtol=tolerance,
        atol=tolerance * np.repeat([amplitude, 1e3 * amplitude], 4 * n),
    )
    z = np.ascontiguousarray(done.y.T).view(complex)
    kinetic = (own * np.abs(z[:, 2 * n : 3 * n]) ** 2 + turning * np.abs(z[:, 3 * n :]) ** 2).sum(1) / 2
    strain = [energy(beam, np.append(x[0], s[:n]), np.append(d[0], s[n : 2 * n])) for s in z]
    return kinetic + np.array(strain), done.nfev


VIBRATION = Beam(20, 1.0, 0.1, 0.1, 1e9, 0.0, 10.0, 5 / 6, (0.5, 0.5, 0.99, 20.0, 1.0, 0.5, 1.66))
