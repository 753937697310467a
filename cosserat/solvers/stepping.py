"""The implicit method of `solvers.motion`, compiled: the midpoint rule with a discrete gradient.

The elastic force is the gradient at the midpoint plus sigma z, where sigma makes its work the change of energy, exactly
(Gonzalez, J. Nonlinear Sci. 6, 449, 1996).  Gonzalez takes z along the step; here z is the step less its rigid part
when nothing is held, so that the added force has neither a resultant nor a moment and linear and angular momentum stay
as they are.  Second order in the step.  Where a body hardly deforms in a step, there may be no such z: after some
iterations the step is taken without, and its energy is right to second order only.

Where some measure is very stiff (a volume that hardly changes), its stress is taken at the mean of its values at both
ends (Simo & Tarnow, ZAMP 43, 757, 1992): at the midpoint itself a mere rotation by t would strain it by t^2 / 8.

Each step is solved by Newton's method; its matrix is kept from one step to the next for as long as the corrections
shrink fast, which they do where little changes in a step.
"""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from cosserat.solvers.banded import Band, Mask, Vector

Fields = NDArray[np.float64]

KERNEL = types.float64(
    types.float64[::1],
    types.float64[:, ::1],
    types.int64,
    types.float64[::1],
    types.float64[:, ::1],
    types.float64[::1],
)
"""A compiled energy: (q, parameters, order, gradient, band, terms) -> energy; order 1 the gradient, 2 the Hessian.

The unknowns are plane vectors, two numbers each.  The second is a direction whose angle may count through whole turns:
the last of the first row of parameters is the angle within half a turn of which it is counted.

Order 3 writes measures of strain into gradient, those that are so stiff that their stress in a step is taken at the
mean of its ends instead of its middle; parameters have a column that is added to them, one row for each.
"""

TOLERANCE = 1e-11  # of the last correction, as a share of the step
MAX_ITERATIONS = 60
_FAST = 0.02  # ratio of two corrections above which the matrix is made anew
_NEAR = 1e-3  # a correction below this share of the step: from it on the change of energy is asked for
_PATIENCE = (
    25  # iterations after which sigma, of which Newton's matrix knows nothing, is left out of a step
)
_TINY = float(np.finfo(float).tiny)
STALL = 1e4  # corrections that no longer shrink are rounding if they are below this multiple of it
_EPS = float(np.finfo(float).eps)


@njit(cache=True)
def _cholesky(band: Band) -> bool:
    """Overwrite a symmetric band with its lower factor, its diagonal inverted; False if not positive."""
    n, width = band.shape
    for j in range(n):
        if not band[j, 0] > 0.0:
            return False
        inverse = 1 / np.sqrt(band[j, 0])
        band[j, 0] = inverse
        last = min(width, n - j)
        for k in range(1, last):
            band[j, k] *= inverse
        for k in range(1, last):
            factor = band[j, k]
            for m in range(k, last):
                band[j + k, m - k] -= factor * band[j, m]
    return True


@njit(cache=True)
def _substitute(factor: Band, x: Vector) -> None:
    """Overwrite a right-hand side with the solution."""
    n, width = factor.shape
    for j in range(n):
        x[j] *= factor[j, 0]
        for k in range(1, min(width, n - j)):
            x[j + k] -= factor[j, k] * x[j]
    for j in range(n - 1, -1, -1):
        total = x[j]
        for k in range(1, min(width, n - j)):
            total -= factor[j, k] * x[j + k]
        x[j] = total * factor[j, 0]


@njit(cache=True)
def _times(mass: Band, x: Vector, y: Vector) -> None:
    """y = M x."""
    n, width = mass.shape
    y[:] = 0.0
    for j in range(n):
        y[j] += mass[j, 0] * x[j]
        for k in range(1, min(width, n - j)):
            y[j + k] += mass[j, k] * x[j]
            y[j] += mass[j, k] * x[j + k]


@njit(cache=True)
def _step_matrix(band: Band, mass: Band, inertia: float, held: Mask) -> float:
    """Overwrite a Hessian with half of it plus inertia times the mass, held unknowns uncoupled; its stiffest entry."""
    n, width = band.shape
    stiffest = 0.0
    for j in range(n):
        stiffest = max(stiffest, abs(band[j, 0]))
        for k in range(width):
            band[j, k] *= 0.5
        for k in range(mass.shape[1]):
            band[j, k] += inertia * mass[j, k]
    for j in range(n):
        for k in range(1, min(width, n - j)):
            if held[j] or held[j + k]:
                band[j, k] = 0.0
    return stiffest


@njit(cache=True)
def _remove(part: Vector, x: Vector) -> None:
    """Make x orthogonal to part."""
    share, size = 0.0, 0.0
    for i in range(x.size):
        share += part[i] * x[i]
        size += part[i] * part[i]
    for i in range(x.size):
        x[i] -= share / size * part[i]


@njit(cache=True)
def _deforming(change: Vector, middle: Vector, translations: Fields, spin: Vector, z: Vector) -> None:
    """z: a change less its rigid part at the midpoint; the change itself where no translations are free."""
    z[:] = change
    if translations.shape[0] == 0:
        return
    for i in range(0, change.size, 2):
        spin[i], spin[i + 1] = -middle[i + 1], middle[i]
    for _ in range(2):  # twice: far from the origin a rotation is nearly a translation
        for k in range(translations.shape[0]):
            _remove(translations[k], spin)
    for _ in range(2):
        for k in range(translations.shape[0]):
            _remove(translations[k], z)
        _remove(spin, z)


@njit(cache=True)
def counted_on(y: float, x: float, near: float) -> float:
    """Polar angle of (x, y), within half a turn of another angle."""
    angle = np.arctan2(y, x)
    return float(angle - 2 * np.pi * np.round((angle - near) / (2 * np.pi)))


@njit(cache=True)
def _sigma(
    change: Vector, gradient: Vector, z: Vector, before: float, after: float, blur: float
) -> float:
    """What makes the work of gradient + sigma z the change of energy, or zero where rounding hides the difference.

    blur : sqrt(2 k) eps q: rounding a position by eps q changes an energy Pi = k u^2 / 2 by sqrt(2 k Pi) eps q.
    """
    work, along = 0.0, 0.0
    for i in range(change.size):
        work += gradient[i] * change[i]
        along += z[i] * change[i]
    missing, size = after - before - work, abs(before) + abs(after)
    if along == 0.0 or not abs(missing) > blur * np.sqrt(size) + _EPS * size:
        return 0.0
    return float(missing / along)


def _march(  # type: ignore[no-untyped-def]
    kernel, rod, q, v, mass, load, held, moved, places, rates, translations, drag, h, width, averaged
):
    """Take steps of h, overwriting q, v and the angle in rod; returns how many, fewer where one found no solution.

    translations : (2, n), or (0, n) where something is held.
    moved : (m,) held unknowns that are moved; places, rates : (steps + 1, m) where and how fast they are.
    """
    n, steps = q.size, places.shape[0] - 1
    gradient, none, terms, nothing = np.empty(n), np.empty((0, width + 1)), np.empty(16), np.empty(0)
    factor, change, middle, force = np.empty((n, width + 1)), np.empty(n), np.empty(n), np.empty(n)
    product, pull, z, spin, gained = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    earlier, earliest = np.zeros(n), np.zeros(n)  # changes of the last two steps
    shifted, old, new, now = rod.copy(), np.zeros(n), np.zeros(n), np.zeros(n)
    inertia = 2 / h**2 + drag / h
    stiffest, fresh, judged = 0.0, False, False
    before = kernel(q, rod, 0, nothing, none, terms)
    for done in range(steps):
        _times(mass, v, pull)
        for i in range(n):
            pull[i] = load[i] + 2 / h * pull[i]
            guess = h * v[i] if done < 2 else 2 * earlier[i] - earliest[i]
            change[i] = 0.0 if held[i] else guess
        for i in range(moved.size):
            change[moved[i]] = places[done + 1, i] - places[done, i]
        if averaged >= 0:
            kernel(q, rod, 3, old, none, terms)
        arrived, near, after = False, False, before
        relative = np.inf  # last correction as a share of the step
        for iteration in range(MAX_ITERATIONS):
            if averaged >= 0:
                kernel(q + change, rod, 3, new, none, terms)
                kernel(q + change / 2, rod, 3, now, none, terms)
                for k in range(rod.shape[0]):
                    shifted[k, averaged] = (old[k] + new[k]) / 2 - now[k]
            for i in range(n):
                middle[i] = q[i] + change[i] / 2
            if not fresh:
                if not np.isfinite(kernel(middle, shifted, 2, gradient, factor, terms)):
                    return done
                stiffest = _step_matrix(factor, mass, inertia, held)
                if not _cholesky(factor):
                    return done
                fresh, judged = True, False
            elif not np.isfinite(kernel(middle, shifted, 1, gradient, none, terms)):
                return done
            reach = np.abs(q).max()
            sigma = 0.0
            if near:
                _deforming(change, middle, translations, spin, z)
                for i in range(n):
                    middle[i] = q[i] + change[i]
                after = kernel(middle, rod, 0, nothing, none, terms)
                sigma = _sigma(change, gradient, z, before, after, _EPS * reach * np.sqrt(2 * stiffest))
                if iteration > _PATIENCE:
                    sigma = 0.0
            for i in range(n):
                gained[i] = change[i]
            for i in range(moved.size):  # accelerated from one given velocity to the next
                gained[moved[i]] = h / 2 * (rates[done, i] + rates[done + 1, i])
            _times(mass, gained, product)
            for i in range(n):
                added = sigma * z[i] if near else 0.0
                force[i] = 0.0 if held[i] else pull[i] - inertia * product[i] - gradient[i] - added
            _substitute(factor, force)
            size, farthest = 0.0, 0.0
            for i in range(n):
                change[i] += force[i]
                size, farthest = max(size, abs(force[i])), max(farthest, abs(change[i]))
            rounding = _EPS * reach
            settled = size <= max(TOLERANCE * farthest, rounding)
            stalled = size > relative * farthest / 2 and size < STALL * rounding
            if near and (settled or stalled):
                arrived = True
                break
            if not np.isfinite(size):
                return done
            if judged and size > _FAST * relative * farthest:
                fresh = False
            judged = True
            relative = size / max(farthest, _TINY)
            near = near or settled or stalled or relative < _NEAR
        if not arrived:
            return done
        for i in range(n):
            q[i] += change[i]
            v[i] = 2 / h * change[i] - v[i]
            earliest[i], earlier[i] = earlier[i], change[i]
        rod[0, -1] = shifted[0, -1] = counted_on(q[3], q[2], rod[0, -1])
        for i in range(moved.size):
            v[moved[i]] = rates[done + 1, i]
        before = kernel(q, rod, 0, nothing, none, terms)
        if not np.isfinite(before):
            return done
    return steps


@functools.cache
def march() -> Callable[..., int]:
    """`_march`, compiled; loaded only where a motion needs it."""
    vector, matrix = types.float64[::1], types.float64[:, ::1]
    signature = types.int64(
        types.FunctionType(KERNEL),
        matrix,
        vector,
        vector,
        matrix,
        vector,
        types.boolean[::1],
        types.int64[::1],
        matrix,
        matrix,
        matrix,
        types.float64,
        types.float64,
        types.int64,
        types.int64,
    )
    compiled: Callable[..., int] = njit(signature, cache=True)(_march)
    return compiled
