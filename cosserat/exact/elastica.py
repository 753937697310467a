"""Exact answers for rods with large deflections or vibrations with shear, independent of the models of this package.

Lengths in lengths of the rod, forces in EI / L^2, unless a unit is given.
"""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from cosserat.exact.beams import Beam

Array = NDArray[np.float64]
_SLENDER = 1e-9  # E I over k G A L^2


def transverse_tip(force: float) -> tuple[float, float]:
    """Lateral displacement and shortening of the tip of a clamped inextensible rod under a dead force across it.

    Elliptic integrals of the parameter k^2 = (1 + sin(tip angle)) / 2 (Bisshopp and Drucker 1945; Mattiasson 1981).
    """
    from scipy.optimize import brentq
    from scipy.special import ellipeinc, ellipkinc

    def missing(angle: float) -> float:
        m = (1 + np.sin(angle)) / 2
        start = np.arcsin(1 / np.sqrt(2 * m))
        return float(ellipkinc(np.pi / 2, m) - ellipkinc(start, m) - np.sqrt(force))

    angle = float(brentq(missing, 1e-12, np.pi / 2 - 1e-13, xtol=1e-15))
    m = (1 + np.sin(angle)) / 2
    start = np.arcsin(1 / np.sqrt(2 * m))
    sideways = 1 - 2 * float(ellipeinc(np.pi / 2, m) - ellipeinc(start, m)) / np.sqrt(force)
    return float(sideways), float(1 - np.sqrt(2 * np.sin(angle) / force))


def shearable_tip(force: float, axial: float, shear: float) -> tuple[float, float]:
    """Lateral displacement and shortening of the tip of Reissner's rod with stiffnesses EA and kGA."""
    x, y, _ = shearable_shape(force, axial, shear, np.array([1.0]))[-1]
    return float(y), float(1 - x)


def shearable_shape(force: float, axial: float, shear: float, s: Array) -> Array:
    """Reissner's rod by shooting: x, y and the angle of its sections at the arc lengths s, shape (len(s), 3)."""
    return _shot(force, axial, shear, _first_bend(force, axial, shear), s)[:, :3]


@functools.cache
def _first_bend(force: float, axial: float, shear: float) -> float:
    """The curvature at the clamp with which the free end has none."""
    from scipy.optimize import brentq

    end = np.array([1.0])
    found = brentq(
        lambda bend: _shot(force, axial, shear, bend, end)[-1, 3], 0.0, 1.2 * force, xtol=1e-13
    )
    return float(found)


def _shot(force: float, axial: float, shear: float, bend: float, s: Array) -> Array:
    """x, y, angle and curvature at the arc lengths s of the rod that leaves its clamp with a curvature."""
    from scipy.integrate import solve_ivp

    def rates(_: float, y: Array) -> Array:
        turned, bend = y[2], y[3]
        normal, across = force * np.sin(turned), force * np.cos(turned)
        along, slide = 1 + normal / axial, across / shear
        return np.array(
            [
                along * np.cos(turned) - slide * np.sin(turned),
                along * np.sin(turned) + slide * np.cos(turned),
                bend,
                across * -along + normal * slide,
            ]
        )

    start = [0, 0, 0, bend]
    done = solve_ivp(rates, (0, 1), start, method="DOP853", t_eval=s, rtol=1e-12, atol=1e-13)
    return np.asarray(done.y.T)


def column_load(sideways_angle: float) -> float:
    """Load of a clamped-free inextensible column at an angle [rad] of its tip: K(k)^2, k = sin(angle / 2)."""
    from scipy.special import ellipk

    return float(ellipk(np.sin(sideways_angle / 2) ** 2) ** 2)


def column_tip(load: float) -> tuple[float, float]:
    """Lateral displacement and height of the tip of a clamped-free inextensible column beyond its buckling load.

    Raises
    ------
    ValueError : the load is below pi^2 / 4, where the column is straight.
    """
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipk

    angle = float(brentq(lambda a: column_load(a) - load, 1e-9, np.pi - 1e-9, xtol=1e-14))
    m = np.sin(angle / 2) ** 2
    return float(2 * np.sqrt(m) / ellipk(m)), float(2 * ellipe(m) / ellipk(m) - 1)


def timoshenko_frequencies(beam: Beam, count: int) -> Array:
    """The lowest angular frequencies of a clamped-free Timoshenko beam, shape (count,) [rad/s].

    w = exp(s xi) solves the two equations of motion where (kGA s^2 + rho0 w2)(EI s^2 + rho I w2 - kGA) + (kGA s)^2 = 0
    with w2 = omega^2; the clamp and the free end make a determinant vanish.  Where E I is less than 1e-9 k G A L^2,
    rounding makes more of the determinant than shear of the frequencies, and they are those of Bernoulli and Euler.
    """
    return np.array(_timoshenko_frequencies(beam, count))


@functools.cache
def _timoshenko_frequencies(beam: Beam, count: int) -> tuple[float, ...]:
    from scipy.optimize import brentq

    shear = beam.shear_stiffness
    bending = beam.bending_stiffness
    if bending < _SLENDER * shear * beam.length**2:
        near = np.pi * (
            np.arange(count) + 0.5
        )  # cos b = -1 / cosh b: between neighbouring zeros of the sine
        roots = [
            brentq(lambda b: np.cos(b) + 1 / np.cosh(b), b - 0.5, b + 0.5, xtol=1e-14) for b in near
        ]
        return tuple(np.square(roots) * np.sqrt(bending / beam.line_density) / beam.length**2)
    rotary = beam.line_density * beam.second_moment / beam.area

    def determinant(omega: float) -> float:
        w2 = omega**2
        a = shear * bending
        b = shear * (rotary * w2 - shear) + beam.line_density * w2 * bending + shear**2
        c = beam.line_density * w2 * (rotary * w2 - shear)
        squares = np.roots([a, b, c]).astype(complex)
        roots = np.concatenate([np.sqrt(squares), -np.sqrt(squares)])
        turn = (shear * roots**2 + beam.line_density * w2) / (shear * roots)  # psi over w of each
        end = np.exp(roots * beam.length)
        rows = np.array([np.ones(4), turn, roots * turn * end, (roots - turn) * end])
        rows = rows / np.abs(rows).max(axis=1, keepdims=True)
        value = np.linalg.det(rows) / np.linalg.det(np.vander(roots / np.abs(roots).max()))
        return float(value.real if abs(value.real) > abs(value.imag) else value.imag)

    found: list[float] = []
    first = 3.516 * np.sqrt(bending / beam.line_density) / beam.length**2
    step, omega = first / 20, first / 2
    before = determinant(omega)
    while len(found) < count:
        after = determinant(omega + step)
        if before * after < 0:
            found.append(float(brentq(determinant, omega, omega + step, xtol=1e-12 * omega)))
        omega, before = omega + step, after
    return tuple(found)
