"""Equilibria of a body whose supports are moved as if by hand, in compiled code that needs no interpreter.

Increments of the motion are predicted and corrected as those of a load in `solvers.climb`.  The energy of every
accepted equilibrium has a minimum there, for supports that stay.  Where the path ahead has none, the body falls: its
energy decreases, with the supports in place, until it is at rest in another minimum.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from cosserat.solvers.banded import Vector, band_product
from cosserat.solvers.climb import (
    MAX_CUTBACKS,
    MAX_ROTATION,
    NEGLIGIBLE_ROTATION,
    PREDICTION_TOLERANCE,
    Fields,
    assembled,
    balance,
    factorise,
    largest_of,
    largest_product,
    reach,
    stray,
    substitute,
)
from cosserat.solvers.members import FRACTION, PREDICTED, RATES, Body, Limits
from cosserat.solvers.potential import ENERGY, HESSIAN

FOLLOWED, FELL, STOPPED = range(3)
"""What comes of a motion: a path, another minimum of the energy on the way, an end before that of the motion."""
DONE, ITERATIONS, REFUSED, FALLS = range(4)
"""What is told of it: its fraction, Newton steps, refused increments, falls."""

_MOST_INCREMENTS = 400
_MOST_STEPS = 300  # of one fall
_MOST_HALVINGS = 30
_AT_REST = 1e-6  # unbalanced fraction of the reactions at which a fall ends
_NUDGE = 0.05  # rotation that leaves a saddle of the energy [rad]
_DECREASE = 1e-4  # least decrease of the energy, as a fraction of that along the tangent
_EPS = float(np.finfo(float).eps)


@njit(error_model="numpy")
def pull(
    body: Body,
    limits: Limits,
    q: Vector,
    travel: Vector,
    answer: tuple[Vector, Vector],
    told: Vector,
) -> int:
    """Move the supports of a body from an equilibrium q, which is overwritten by the last one found; what came of it.

    travel : (n,) of the constrained DOFs, zero elsewhere.  answer : reactions (n,) [N], and residual, tolerance and
    rounding [N].  told : (4,) is overwritten by the fraction of the travel and by counts.
    """
    n, shape = q.size, (limits.parts, 2)
    step, new, velocity, middle = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    rates, moved, turned, ahead = np.empty(shape), np.empty(shape), np.empty(shape), np.empty(shape)
    told[:] = 0.0
    increment, refused, wall, outcome = limits.longest, 0, 0.0, FOLLOWED
    for _ in range(_MOST_INCREMENTS):
        if told[DONE] == 1.0:
            return outcome
        if not _move_supports(body, q, travel, velocity):
            return STOPPED
        body.space(RATES, body.placed, q, velocity, body.held, rates)
        fastest = largest_of(rates)
        increment = min(increment, limits.longest, MAX_ROTATION / fastest if fastest > 0.0 else np.inf)
        goal = told[DONE] + increment if told[DONE] + 1.001 * increment < 1.0 else 1.0
        part = goal - told[DONE]
        for i in range(limits.parts):
            for k in range(2):
                moved[i, k] = part * rates[i, k]
        for i in range(n):
            new[i] = q[i] + part * travel[i]
        body.space(PREDICTED, body.placed, q, new, body.held, moved)
        middle[:] = new
        size = max(largest_of(moved), NEGLIGIBLE_ROTATION)
        good, steps = reach(body, limits, new, 1.0, size, step, turned, ahead, answer)
        told[ITERATIONS] += steps
        off = stray(body, q, new, moved, (velocity, step, turned)) if good else np.inf
        if not off <= PREDICTION_TOLERANCE:
            refused, wall = refused + 1, max(wall, goal)
            told[REFUSED] += 1.0
            increment = part / 2
            if refused <= MAX_CUTBACKS:
                continue
            new[:] = middle
            if not _fall(body, limits, new, step, answer, told):
                return STOPPED
            told[FALLS] += 1.0
            outcome, off = FELL, PREDICTION_TOLERANCE / 2
        q[:] = new
        told[DONE] = goal
        if goal >= wall:  # otherwise ever shorter increments would approach a bifurcation
            refused = 0
        increment *= min(2.0, max(0.5, np.sqrt(PREDICTION_TOLERANCE / 2 / max(off, 1e-3))))
    return STOPPED


@njit(error_model="numpy")
def _move_supports(body: Body, q: Vector, travel: Vector, velocity: Vector) -> bool:
    """Overwrite the change of the DOFs at q as the supports travel; False if the energy has no minimum there."""
    energy = assembled(body, q, 1.0, HESSIAN)
    pulled = band_product(body.band[: q.size], travel)
    for i in range(q.size):
        velocity[i] = 0.0 if body.held[i] else -pulled[i]
    if not np.isfinite(energy) or not factorise(body.band, body.held):
        return False
    substitute(body.band, velocity, body.room)
    for i in range(q.size):
        if body.held[i]:
            velocity[i] = travel[i]
    return True


@njit(error_model="numpy")
def _fall(
    body: Body, limits: Limits, q: Vector, step: Vector, answer: tuple[Vector, Vector], told: Vector
) -> bool:
    """Let a body fall from q, which is overwritten, with its supports in place; whether it comes to rest."""
    shape, n = (limits.parts, 2), q.size
    turned, ahead, new, hessian = np.empty(shape), np.empty(shape), np.empty(n), np.empty_like(body.band)
    for _ in range(_MOST_STEPS):
        energy = _potential_energy(body, q, HESSIAN)
        if not np.isfinite(energy):
            return False
        residual, reaction = balance(body.gradient, body.held, step)
        rounding = _EPS * largest_product(body.band[:n], q, body.scale, body.at)
        hessian[:, :] = body.band
        shift = _factorise_shifted(body, hessian)
        at_rest = residual <= max(_AT_REST * reaction, 16 * rounding)
        if at_rest and shift == 0.0:
            good, steps = reach(body, limits, q, 1.0, 1.0, step, turned, ahead, answer)
            told[ITERATIONS] += steps
            return good
        told[ITERATIONS] += 1.0
        if at_rest:
            _soften(body, q, new, step)
            continue
        slope = 0.0
        new[:] = step
        substitute(body.band, step, body.room)
        for i in range(n):
            slope += new[i] * step[i]
        fraction = min(1.0, body.space(FRACTION, body.placed, q, step, body.held, turned))
        if not _descend(body, q, step, fraction, slope, energy, new):
            return False
    return False


@njit(error_model="numpy")
def _descend(
    body: Body, q: Vector, step: Vector, fraction: float, slope: float, energy: float, new: Vector
) -> bool:
    """Move q along a step to where the energy is less; False if it is not."""
    for _ in range(_MOST_HALVINGS):
        for i in range(q.size):
            new[i] = q[i] + fraction * step[i]
        lower = _potential_energy(body, new, ENERGY)
        if lower <= energy - _DECREASE * fraction * slope + 4 * _EPS * abs(energy):
            q[:] = new
            return True
        fraction /= 2
    return False


@njit(error_model="numpy")
def _potential_energy(body: Body, q: Vector, task: int) -> float:
    """The energy of the body and of its dead loads; the gradient and the Hessian are overwritten as by the task."""
    energy = assembled(body, q, 1.0, task)
    for i in range(q.size):
        energy -= body.dead[i] * q[i]
    return energy


@njit(error_model="numpy")
def _factorise_shifted(body: Body, hessian: Fields) -> float:
    """Factorise the Hessian plus the least tried multiple of the unit matrix that makes it positive; the multiple."""
    largest, shift = 0.0, 0.0
    for j in range(body.held.size):
        largest = max(largest, abs(hessian[j, 0]))
    while shift < np.inf:
        body.band[:, :] = hessian
        for j in range(body.held.size):
            body.band[j, 0] += shift
        if factorise(body.band, body.held):
            return shift
        shift = 2 * shift if shift > 0.0 else 2.0**-40 * largest
    return shift


@njit(error_model="numpy")
def _soften(body: Body, q: Vector, x: Vector, rates: Vector) -> None:
    """Move q a little along the softest motion of the body, where the shifted Hessian has been factorised."""
    for i in range(q.size):
        x[i] = 0.0 if body.held[i] else np.sin(1.7 * i + 0.5)
    for _ in range(50):
        substitute(body.band, x, body.room)
        size, sign = 0.0, 1.0
        for i in range(q.size):
            if abs(x[i]) > size:
                size, sign = abs(x[i]), np.sign(x[i])
        for i in range(q.size):
            x[i] *= sign / size
    share = _NUDGE * body.space(FRACTION, body.placed, q, x, body.held, body.skew)
    for i in range(q.size):
        q[i] += share * x[i]
