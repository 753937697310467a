"""The implicit method of `solvers.integrate`, compiled: the midpoint rule with a discrete gradient.

Stresses are taken at the mean of the strains at both ends of a step (Simo & Tarnow, ZAMP 43, 757, 1992) and pull along
the directions of its midpoint.  At the midpoint itself a mere rotation by t would strain a body by t^2 / 8, which a
thin one takes for a compression beyond buckling.

What the energy still lacks is added as sigma z, where sigma makes the work of the forces the change of energy, exactly
(Gonzalez, J. Nonlinear Sci. 6, 449, 1996).  Gonzalez takes z along the step; here z is the step less its rigid part
when nothing is held, so that the added force has neither a resultant nor a moment and linear and angular momentum stay
as they are.  Second order in the step.  Where a body hardly deforms in a step, there may be no such z: after some
iterations the step is taken without, and its energy is right to third order in what it deforms.

A drag c takes exp(-c h / 2) off all momenta before and after a step that knows nothing of it (Strang, SIAM J. Numer.
Anal. 5, 506, 1968): a mode loses energy at the rate c, resolved or not, while c omega h^2 < 8.

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
    types.float64[::1],
    types.float64[:, ::1],
    types.int64,
    types.float64[:, ::1],
    types.float64[::1],
    types.float64[:, ::1],
    types.float64[::1],
)
"""A compiled energy: (q, after, parameters, order, measures, gradient, band, terms) -> energy.

Where `after` is empty: the energy at q; order 1 the gradient, 2 the Hessian too; order 3 writes the measures of strain
at q, (N, 4).

In a step that leads to `after`, q is its midpoint and `measures` are those of its start: the energy after the step.
Order 1 writes the gradient at the midpoint, its stresses those of the mean of the measures at both ends; order 2 the
Hessian at the midpoint with these stresses, but with no less tension than at the start, and the pressures of the start:
on the way to an answer a stress that is not there must not make it indefinite.

The DOFs are plane vectors, two numbers each.  The second is a direction whose angle may count through whole turns:
the last of the first row of parameters is the angle within half a turn of which it is counted.
"""

TOLERANCE = 1e-11  # of the last correction, as a share of the step
MAX_ITERATIONS = 60
_FAST = 0.02  # ratio of two corrections above which the matrix is made anew
_LEAST = 0.1  # share of the stresses up to which they are scaled to meet the change of energy
_RIGID = 0.1  # share of a step below which what deforms is too little to bear sigma
_ASTRAY = 0.5  # ratio of two corrections above which a matrix of an earlier step is given up
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
def _step_matrix(band: Band, mass: Band, inertia: float, constrained: Mask) -> float:
    """Overwrite a Hessian with half of it plus inertia times the mass, constrained DOFs uncoupled; stiffest entry."""
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
            if constrained[j] or constrained[j + k]:
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
def _deforming(change: Vector, middle: Vector, translations: Fields, spin: Vector, z: Vector) -> bool:
    """z: a change less its rigid part at the midpoint, the change itself where no translations are free.

    True where hardly anything is left.
    """
    z[:] = change
    if translations.shape[0] == 0:
        return False
    for i in range(0, change.size, 2):
        spin[i], spin[i + 1] = -middle[i + 1], middle[i]
    for _ in range(2):  # twice: far from the origin a rotation is nearly a translation
        for k in range(translations.shape[0]):
            _remove(translations[k], spin)
    for _ in range(2):
        for k in range(translations.shape[0]):
            _remove(translations[k], z)
        _remove(spin, z)
    return bool((z * z).sum() < _RIGID**2 * (change * change).sum())


@njit(cache=True)
def unwrap(y: float, x: float, near: float) -> float:
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


@njit(cache=True)
def _decay(
    v: Vector, mass: Band, factor: Band, constrained: Mask, share: float, work: Vector, exchanged: Vector
) -> None:
    """Take a drag's share off the momenta of the free DOFs; exchanged: what it takes, and what the supports give."""
    n = v.size
    _times(mass, v, work)
    before, loss = 0.0, work.copy()
    for i in range(n):
        before += v[i] * work[i] / 2
        loss[i] = 0.0 if constrained[i] else -share * work[i]
    _substitute(factor, loss)
    for i in range(n):
        v[i] += loss[i]
    _times(mass, loss, work)
    given = 0.0
    for i in range(n):
        if constrained[i]:
            given += v[i] * work[i]
    _times(mass, v, work)
    now = 0.0
    for i in range(n):
        now += v[i] * work[i] / 2
    exchanged[0] += before - now + given
    exchanged[1] += given


def _integrate_steps(  # type: ignore[no-untyped-def]
    kernel,
    rod,
    q,
    v,
    mass,
    load,
    constrained,
    moved,
    places,
    rates,
    translations,
    damping_rate,
    h,
    width,
    exchanged,
):
    """Take steps of h, overwriting q, v and the angle in rod; returns how many, fewer where one found no solution.

    translations : (2, n), or (0, n) where something is held.
    moved : (m,) constrained DOFs that are moved; places, rates : (steps + 1, m) where and how fast they are.
    exchanged : energy that the drag has taken, and that moved supports have given; added to [J].
    """
    n, steps = q.size, places.shape[0] - 1
    gradient, none, terms, nothing = np.empty(n), np.empty((0, width + 1)), np.empty(16), np.empty(0)
    factor, change, middle, force = np.empty((n, width + 1)), np.empty(n), np.empty(n), np.empty(n)
    product, pull, z, spin, gained = np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    earlier, earliest, end = np.zeros(n), np.zeros(n), np.empty(n)  # changes of the last two steps
    measures = np.zeros((rod.shape[0], 4))
    inertia = 2 / h**2
    stiffest, fresh, judged, turning, first = 0.0, False, False, False, np.empty(n)
    share, mass_factor = 1 - np.exp(-damping_rate * h / 2), mass.copy()
    if damping_rate > 0.0:
        for j in range(n):
            for k in range(1, min(mass.shape[1], n - j)):
                if constrained[j] or constrained[j + k]:
                    mass_factor[j, k] = 0.0
        _cholesky(mass_factor)
    before = kernel(q, nothing, rod, 3, measures, nothing, none, terms)
    for done in range(steps):
        if damping_rate > 0.0:
            _decay(v, mass, mass_factor, constrained, share, product, exchanged)
        _times(mass, v, pull)
        for i in range(n):
            pull[i] = load[i] + 2 / h * pull[i]
            guess = h * v[i] if done < 2 or turning else 2 * earlier[i] - earliest[i]
            change[i] = 0.0 if constrained[i] else guess
            first[i] = change[i]
        for i in range(moved.size):
            change[moved[i]] = first[moved[i]] = places[done + 1, i] - places[done, i]
        arrived, near, after = False, False, before
        stale = fresh = fresh and not turning  # whether the matrix is of an earlier step
        relative = size = sized = (
            np.inf
        )  # last correction as a share of the step; the last two themselves
        for iteration in range(MAX_ITERATIONS):
            if (
                stale and iteration > 0 and not size <= _ASTRAY * sized
            ):  # begin anew with a matrix of this step
                fresh, stale, turning, near = False, False, True, False
                relative = size = np.inf
                change[:] = first
            for i in range(n):
                middle[i] = q[i] + change[i] / 2
                end[i] = q[i] + change[i]
            if not fresh:
                if not np.isfinite(kernel(middle, end, rod, 2, measures, gradient, factor, terms)):
                    return done
                stiffest = _step_matrix(factor, mass, inertia, constrained)
                if not _cholesky(factor):
                    return done
                fresh, judged, stale = True, False, False
            after = kernel(middle, end, rod, 1, measures, gradient, none, terms)
            if stale and not np.isfinite(after):
                size = np.inf
                continue
            if not np.isfinite(after):
                return done
            max_step_fraction = np.abs(q).max()
            sigma = 0.0
            if near and iteration <= _PATIENCE:
                blur = _EPS * max_step_fraction * np.sqrt(2 * stiffest)
                rigid = _deforming(change, middle, translations, spin, z)
                if rigid:
                    z[:] = gradient
                sigma = _sigma(change, gradient, z, before, after, blur)
                if rigid and abs(sigma) > _LEAST:
                    sigma = 0.0
            for i in range(n):
                gained[i] = change[i]
                if sigma != 0.0:
                    gradient[i] += sigma * z[i]
            for i in range(moved.size):  # accelerated from one given velocity to the next
                gained[moved[i]] = h / 2 * (rates[done, i] + rates[done + 1, i])
            _times(mass, gained, product)
            for i in range(n):
                force[i] = 0.0 if constrained[i] else pull[i] - inertia * product[i] - gradient[i]
            _substitute(factor, force)
            sized, size, farthest = size, 0.0, 0.0
            for i in range(n):
                change[i] += force[i]
                size, farthest = max(size, abs(force[i])), max(farthest, abs(change[i]))
            rounding = _EPS * max_step_fraction
            settled = size <= max(TOLERANCE * farthest, rounding)
            stalled = size > relative * farthest / 2 and size < STALL * rounding
            if near and (settled or stalled):
                arrived = True
                break
            if not (stale or np.isfinite(size)):
                return done
            if judged and size > _FAST * relative * farthest:
                fresh = False
            judged = True
            relative = size / max(farthest, _TINY)
            near = near or settled or stalled or relative < _NEAR
        if not arrived:
            return done
        for i in range(moved.size):
            k = moved[i]
            pushed = inertia * product[k] - (pull[k] - load[k])
            exchanged[1] += pushed * gained[k] + (gradient[k] - load[k]) * change[k]
        for i in range(n):
            q[i] += change[i]
            v[i] = 2 / h * change[i] - v[i]
            earliest[i], earlier[i] = earlier[i], change[i]
        rod[0, -1] = unwrap(q[3], q[2], rod[0, -1])
        for i in range(moved.size):
            v[moved[i]] = rates[done + 1, i]
        if damping_rate > 0.0:
            _decay(v, mass, mass_factor, constrained, share, product, exchanged)
        before = kernel(q, nothing, rod, 3, measures, nothing, none, terms)
        if not np.isfinite(before):
            return done
    return steps


@functools.cache
def integrate_steps() -> Callable[..., int]:
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
        vector,
    )
    compiled: Callable[..., int] = njit(signature, cache=True)(_integrate_steps)
    return compiled
