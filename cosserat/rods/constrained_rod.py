"""A uniform rod that keeps its volume or its length: both forms of an internal constraint, section 1.3.

Uniform means that each section is rotated into the next: d_i' = omega x d_i with the same omega everywhere.  Without
loads between its ends the balances (1.2.71) and (1.2.82) then read omega x n = 0 and omega x m^alpha = k^alpha; so n is
along omega.  An omega along E_3 twists the rod, one across it bends it into a circle.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import InputError, NotConvergedError, OutOfReachError
from cosserat.rods.directed_rod import energy_gradient, forces, measures

Array = NDArray[np.float64]

_FORCE_TOLERANCE = 1e-12  # largest unbalanced force, as a fraction of the largest stiffness
_MAX_ITERATIONS = 60  # for directors and multiplier; moderate turns take a dozen
_MIN_VOLUME_RATIO = 0.1  # volume of a section over that at rest below which it has collapsed


@dataclass(frozen=True)
class Constraint:
    """phi^I(d_1, d_2, r') = 0 of eq. (1.3.21).

    value : phi^I at directors (3, 3).  gradient : its derivatives by d_1, d_2, r' = d_3, rows of a (3, 3) array.
    eliminate : gamma (3, 3) with gamma_33 from phi^I = 0, and the derivatives (3, 3) of that gamma_33 by
    gamma_ij, with -1 in place of the one by gamma_33 itself.
    """

    value: Callable[[Array], float]
    gradient: Callable[[Array], Array]
    eliminate: Callable[[Array], tuple[Array, Array]]


def _keep_volume(gamma: Array) -> tuple[Array, Array]:
    """C = gamma + I has the determinant 1: its last entry follows from the others."""
    c = gamma + np.eye(3)
    c[2, 2] = 0
    minor = c[0, 0] * c[1, 1] - c[0, 1] * c[1, 0]
    c[2, 2] = (1 - np.linalg.det(c)) / minor
    return c - np.eye(3), -np.linalg.inv(c).T / minor


def _keep_length(gamma: Array) -> tuple[Array, Array]:
    """gamma_33 = 0."""
    kept, slope = gamma.copy(), np.zeros_like(gamma)
    kept[2, 2], slope[2, 2] = 0, -1
    return kept, slope


INCOMPRESSIBLE = Constraint(
    lambda d: np.linalg.det(d) - 1,
    lambda d: np.cross(d[[1, 2, 0]], d[[2, 0, 1]]),
    _keep_volume,
)
"""Every section keeps its volume, eqs. (2.2.11)-(2.2.12)."""
INEXTENSIBLE = Constraint(
    lambda d: (d[2] @ d[2] - 1) / 2,
    lambda d: np.array([0 * d[0], 0 * d[1], d[2]]),
    _keep_length,
)
"""The centreline keeps its length."""

Form = Literal["before", "after"]
"""The constraint enters the energy before gradients are taken, eq. (1.3.28), or after, eq. (1.3.26)."""


def constrained_forces(
    k: Mapping[int, float],
    constraint: Constraint,
    form: Form,
    d: Array,
    d_prime: Array,
    multiplier: float,
) -> tuple[Array, Array, Array]:
    """n, shape (3,), k^alpha and m^alpha, shape (2, 3), of the energy (1.2.97) under a constraint.

    form "after" : the gradients of that energy, plus the reaction, eq. (1.3.26).  "before" : the gradients of w_c,
    eq. (1.3.27), the same energy with gamma_33 eliminated, plus the reaction, eq. (1.3.28).
    multiplier : lambda^I or lambda_c^I of these equations [N].
    """
    gamma, kappa = measures(d, d_prime)
    if form == "before":
        gamma, slope = constraint.eliminate(gamma)
        by_gamma, by_kappa = energy_gradient(k, gamma, kappa)
        by_gamma = by_gamma + by_gamma[2, 2] * slope
    else:
        by_gamma, by_kappa = energy_gradient(k, gamma, kappa)
    n, intrinsic, m = forces(d, d_prime, by_gamma, by_kappa)
    reaction = multiplier * constraint.gradient(d)
    return n + reaction[2], intrinsic + reaction[:2], m


def uniform_state(
    k: Mapping[int, float], constraint: Constraint, form: Form, turn: Array, pull: float
) -> tuple[Array, float]:
    """Directors d_1, d_2, d_3, rows of a (3, 3) array, and the multiplier [N] of a uniform rod.

    k : k_1 ... k_16 of eq. (1.2.98).  turn : omega, shape (3,) [1/m].  pull : n along omega [N].
    States that differ by a rotation about omega are equivalent; this is the one nearest to E_i.

    Raises
    ------
    InputError : omega is zero, or a number is not finite.  NotConvergedError : no equilibrium found.
    OutOfReachError : the sections collapse, where this energy has no meaning.
    """
    from scipy.optimize import least_squares

    amount = float(np.linalg.norm(turn))
    if not (amount > 0 and np.isfinite(amount) and np.isfinite(pull)):
        raise InputError(
            f"the turn omega is {turn} per metre and the pull {pull:g} N; give finite numbers and a turn that is not "
            "zero, however small"
        )
    axis, scale = turn / amount, max(k.values())

    def unbalanced(x: Array) -> Array:
        d, multiplier = x[:9].reshape(3, 3), x[9] * scale
        n, intrinsic, m = constrained_forces(k, constraint, form, d, np.cross(turn, d[:2]), multiplier)
        turned = (d * np.cross(axis, np.eye(3))).sum()  # about omega, against no resistance
        left = np.concatenate([n - pull * axis, (intrinsic - np.cross(turn, m)).ravel()])
        return np.append(left / scale, [constraint.value(d), turned])

    start = np.append(np.eye(3).ravel(), 0.0)
    found = least_squares(
        unbalanced, start, jac="cs", xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=_MAX_ITERATIONS
    )
    d, residual = found.x[:9].reshape(3, 3), float(np.abs(found.fun).max())
    asked = f"a uniform rod that rotates by {turn} per metre under {pull:g} N"
    if not residual < _FORCE_TOLERANCE:
        raise NotConvergedError(
            f"{asked}: no equilibrium found; reduce the rotation or the tension",
            iterations=int(found.nfev),
            residual=residual * scale,
            tolerance=_FORCE_TOLERANCE * scale,
        )
    if np.linalg.det(d) < _MIN_VOLUME_RATIO:
        raise OutOfReachError(f"{asked}: its sections collapse; reduce the rotation or the compression")
    return d, float(found.x[9]) * scale
