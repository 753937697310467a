"""Damping of a body, and how well the implicit method follows it.

A mode of frequency omega under the force -(c M + T K) v loses energy at the rate c + T omega^2 = 2 zeta omega, while
its ratio zeta is below one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import InputError
from cosserat.solvers.banded import NO_BAND, band_product
from cosserat.solvers.potential import HESSIAN, NOTHING, STRAINS

if TYPE_CHECKING:
    from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]
_STRESS_FREE = 1e-9
"""Largest force in a stress-free reference, as a fraction of the largest stiffness times the size of a DOF."""

DAMPED = 8.0
"""Largest c omega h^2 at which the implicit method damps a mode of frequency omega by its momenta at the rate c."""


@dataclass(frozen=True)
class DampedModes:
    """Modes that are damped on their own.

    shape : (k, n), of unit modal mass.  rate : (k,) at which each loses energy, 2 zeta omega [1/s].
    """

    shape: Array
    rate: Array


NO_MODES = DampedModes(np.empty((0, 0)), np.empty(0))


def rayleigh(ratios: tuple[float, float], omega: tuple[float, float]) -> tuple[float, float]:
    """c [1/s] and T [s] that give two ratios at two different angular frequencies [rad/s].

    derived: c / omega + T omega = 2 zeta at both.
    """
    (one, other), (low, high) = ratios, omega
    spread = high**2 - low**2
    return 2 * low * high * (one * high - other * low) / spread, 2 * (other * high - one * low) / spread


def followed_fraction(omega: float, damping_time: float, h: float) -> float:
    """The rate at which a mode fades under stiffness-proportional damping in steps h, as a fraction of the exact one.

    derived: the midpoint rule for q'' + T omega^2 q' + omega^2 q = 0 multiplies (q, v) in each step by a matrix with
    the trace 2 (1 - a) / (1 + a + b) and the determinant (1 + a - b) / (1 + a + b), a = (omega h / 2)^2,
    b = T omega^2 h / 2.  At a ratio below one its eigenvalues are complex, and energy falls by the determinant.  Above,
    the greater of its real eigenvalues is that of the slower of two motions.
    """
    a, b = (omega * h / 2) ** 2, damping_time * omega**2 * h / 2
    if b == 0:
        return 1 / (1 + a)  # its limit
    if b**2 / 4 <= a:
        return float(np.log1p(2 * b / (1 + a - b)) / (2 * b))
    root = 2 * np.sqrt(b**2 / 4 - a)
    slower = (1 - a + root) / (1 + a + b)
    return float(-np.log(slower) / (b - root)) if slower > 0 else 0.0


def damped_like(framed: MechanicalSystem, plain: MechanicalSystem) -> MechanicalSystem:
    """A system with its DOFs along the axes of space, with the damping of the same one in its frames."""
    modes = framed.damped_modes
    if modes.rate.size:
        modes = replace(modes, shape=framed.frame.out(modes.shape))
    return replace(
        plain,
        damping_rate=framed.damping_rate,
        damping_time=framed.damping_time,
        damped_modes=modes,
    )


def rest_strains(system: MechanicalSystem, name: str) -> Array:
    """The strains of the body in its reference, which has no stresses.

    Raises
    ------
    InputError : it is damped in proportion to stiffness, and there are stresses in the reference.
    """
    body, reference = system.unframed.internal, rest_dofs(system)
    strains, terms = np.zeros(body.strains), np.empty(len(body.terms))
    body.evaluate(
        *(reference, NOTHING, body.data, body.history, strains),
        *(STRAINS, NOTHING, NO_BAND, NO_BAND, terms),
    )
    if system.damping_time:
        gradient, band = np.zeros(reference.size), np.zeros((reference.size, body.half_bandwidth + 1))
        body.assemble(reference, gradient, band)
        if np.abs(gradient).max() > _STRESS_FREE * float((band[:, 0] * system.space.scale).max()):
            raise InputError(
                f"{name}: 'damping' in proportion to stiffness is for a body without stresses in its reference, and "
                "this one has some; take a damping of kind 'mass' or 'modal'"
            )
    return strains


def rest_dofs(system: MechanicalSystem) -> Array:
    """The DOFs (n,) of the reference, along the axes of space."""
    return np.ascontiguousarray(system.unframed.space.reference)


def strain_damping(system: MechanicalSystem, q: Array, v: Array) -> Array:
    """T K v with the stiffness K of the material at q, (n,) [N]: minus the stiffness-proportional damping."""
    if not system.damping_time:
        return np.zeros_like(v)
    body, frame = system.unframed.internal, system.frame
    gradient, band = np.zeros(q.size), np.zeros((q.size, body.half_bandwidth + 1))
    body.evaluate(
        *(frame.out(q), rest_dofs(system), body.data, body.history, rest_strains(system, "the body")),
        *(HESSIAN, gradient, band, NO_BAND, np.empty(len(body.terms))),
    )
    return system.damping_time * frame.into(band_product(band, frame.out(v)))


def momentum_damping(system: MechanicalSystem, v: Array) -> Array:
    """The velocities (n,) that damping takes per second from the free DOFs, by mass and by damped modes [m/s^2]."""
    modes = system.damped_modes
    taken: Array = system.damping_rate * v
    if modes.rate.size:
        taken = taken + (modes.rate * (modes.shape @ band_product(system.inertia, v))) @ modes.shape
    return taken
