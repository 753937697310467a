"""The implicit method of `solvers.motion` compiled whole, for bodies whose energy is compiled, at rest supports.

The equations are those of `motion._Implicit`; only the matrix is kept from one step to the next for as long as the
corrections shrink fast, which they do where little changes in a step.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Protocol, runtime_checkable

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from cosserat.solvers.banded import Band, Vector

KERNEL = types.float64(
    types.float64[::1],
    types.float64[:, ::1],
    types.int64,
    types.float64[::1],
    types.float64[:, ::1],
    types.float64[::1],
)
"""A compiled energy: (q, parameters, order, gradient, band, terms) -> energy; order 1 the gradient, 2 the Hessian."""

TOLERANCE = 1e-11  # of the last correction, as a share of the step
MAX_ITERATIONS = 60
_FAST = 0.05  # ratio of two corrections above which the matrix is made anew
_NEAR = 1e-3  # last correction, as a share of the step, from which on the change of energy is asked for
_TINY = float(np.finfo(float).tiny)
STALL = 1e4  # corrections that no longer shrink are rounding if they are below this multiple of it
_EPS = float(np.finfo(float).eps)


@runtime_checkable
class Compiled(Protocol):
    """A body whose energy is a compiled function of its parameters."""

    @property
    def half_bandwidth(self) -> int:
        """Largest distance of two coupled unknowns."""

    @property
    def kernel(self) -> object:
        """The compiled energy, of the signature `KERNEL`."""

    @property
    def parameters(self) -> NDArray[np.float64]:
        """What the kernel takes as its second argument."""


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


def _march(kernel, rod, q, v, mass, load, held, drag, h, steps, width):  # type: ignore[no-untyped-def]
    """Take steps of h, overwriting q and v; returns the number of steps taken, fewer where one found no solution."""
    n = q.size
    gradient, none, terms = np.empty(n), np.empty((0, width + 1)), np.empty(16)
    nothing = np.empty(0)
    factor, change, middle, force = np.empty((n, width + 1)), np.empty(n), np.empty(n), np.empty(n)
    product, pull = np.empty(n), np.empty(n)
    earlier, earliest = np.zeros(n), np.zeros(n)  # changes of the last two steps
    inertia = 2 / h**2 + drag / h
    stiffest, fresh = 0.0, False
    before = kernel(q, rod, 0, nothing, none, terms)
    for done in range(steps):
        _times(mass, v, pull)
        for i in range(n):
            pull[i] = load[i] + 2 / h * pull[i]
            guess = h * v[i] if done < 2 else 2 * earlier[i] - earliest[i]
            change[i] = 0.0 if held[i] else guess
        arrived, after = False, before
        relative = np.inf  # last correction as a share of the step
        for _ in range(MAX_ITERATIONS):
            for i in range(n):
                middle[i] = q[i] + change[i] / 2
            if not fresh:
                if not np.isfinite(kernel(middle, rod, 2, gradient, factor, terms)):
                    return done
                stiffest = 0.0
                for j in range(n):
                    stiffest = max(stiffest, abs(factor[j, 0]))
                    for k in range(width + 1):
                        factor[j, k] *= 0.5
                    for k in range(mass.shape[1]):
                        factor[j, k] += inertia * mass[j, k]
                for j in range(n):
                    for k in range(1, min(width + 1, n - j)):
                        if held[j] or held[j + k]:
                            factor[j, k] = 0.0
                if not _cholesky(factor):
                    return done
                fresh, judged = True, False
            elif not np.isfinite(kernel(middle, rod, 1, gradient, none, terms)):
                return done
            near = relative < _NEAR
            if near:
                for i in range(n):
                    middle[i] = q[i] + change[i]
                after = kernel(middle, rod, 0, nothing, none, terms)
            work, size2, reach = 0.0, 0.0, 0.0
            for i in range(n):
                work += gradient[i] * change[i]
                size2 += change[i] * change[i]
                reach = max(reach, abs(q[i]))
            missing = after - before - work
            slip = _EPS * reach * np.sqrt(2 * stiffest * (abs(before) + abs(after)))
            sigma = 0.0
            if near and size2 > 0.0 and abs(missing) > slip + _EPS * (abs(before) + abs(after)):
                sigma = missing / size2
            _times(mass, change, product)
            for i in range(n):
                force[i] = (
                    0.0 if held[i] else pull[i] - inertia * product[i] - gradient[i] - sigma * change[i]
                )
            _substitute(factor, force)
            size, moved = 0.0, 0.0
            for i in range(n):
                change[i] += force[i]
                size, moved = max(size, abs(force[i])), max(moved, abs(change[i]))
            rounding = _EPS * reach
            settled = size <= max(TOLERANCE * moved, rounding)
            stalled = size > relative * moved / 2 and size < STALL * rounding
            if near and (settled or stalled):
                arrived = True
                break
            if not np.isfinite(size):
                return done
            if judged and size > _FAST * relative * moved:
                fresh = False
            judged = True
            relative = size / max(moved, _TINY)
        if not arrived:
            return done
        for i in range(n):
            q[i] += change[i]
            v[i] = 2 / h * change[i] - v[i]
            earliest[i], earlier[i] = earlier[i], change[i]
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
        types.float64,
        types.float64,
        types.int64,
        types.int64,
    )
    compiled: Callable[..., int] = njit(signature, cache=True)(_march)
    return compiled
