"""Equilibria of many like bodies as their loads grow, in one compiled loop; a single body is an array of one.

The body is one potential under dead loads, its constrained degrees of freedom (DOFs) stay where they are, and its path
is stable and predictable.  Wherever the loop is in doubt, because the Hessian is not positive, a prediction fails, or
Newton's method does not converge, it leaves the body to `solvers.incremental`.  It factorises by itself: the bits of an
answer must depend neither on the kernels of a library of linear algebra nor on the other bodies of the array.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numba.core.cgutils import create_struct_proxy, voidptr_t
from numba.extending import intrinsic
from numpy.typing import NDArray

from cosserat.solvers.members import (
    BALANCED,
    CHANGE,
    COUNT,
    CRITICAL,
    FACTOR,
    FRACTION,
    LEFT,
    LENGTH,
    LOG,
    NEGATIVE,
    PREDICTED,
    RATES,
    REACHED,
    REGULAR,
    RESIDUAL,
    ROUNDING,
    SINGULAR,
    SLOPE,
    SPACE_KERNEL,
    SPENT,
    STATE,
    STEPS,
    TOLERANCE,
    TRIED,
    UNDEFINED,
    UNSTABLE,
    Answers,
    Arcs,
    Around,
    Body,
    Found,
    Limits,
    Members,
    Numbers,
    Plane,
    Rates,
    Ways,
    types,
)
from cosserat.solvers.potential import GRADIENT, HESSIAN, KERNEL

Vector = NDArray[np.float64]
Fields = NDArray[np.float64]
Mask = NDArray[np.bool_]

PREDICTION_TOLERANCE = 0.3
"""Largest prediction error, as a fraction of the increment."""
NEGLIGIBLE_ROTATION = 1e-5
"""Rotation below which an increment needs no prediction [rad]."""
MAX_ROTATION = 0.7
"""Largest rotation of a part in an increment [rad]."""
MAX_ROUND_OFF_FRACTION = 1e-3
"""Largest round-off of forces, as a fraction of the loads; more makes an answer worthless."""
_STALL_FACTOR = 16.0  # a residual that stops falling below this multiple of round-off is round-off
MAX_CUTBACKS = 4  # rejected increments before a body is left
_STRAIGHT = 1e-4  # rotation or stretch below which a step is a straight line
_SETTLED = 7e-2  # last correction of an increment before the last one, as a fraction of the increment
_STIFFENING = 0.9  # ratio of the rates at two points below which a body stiffens
_UNROLLED = (0,) * 8
"""As many zeros as the width of the most common band: code for just this width is twice as fast."""
NEARLY_CRITICAL = 1e-8
"""Fraction of the load, within which of a critical one an equilibrium has no rates."""
BESIDE = 1e-6
"""Fraction of the load, to the Hessian that shows how fast the softest eigenvalue changes."""
_APART = (
    1e-3  # of a unit vector, by which an inverse iteration next to a critical load does not change it
)
_EPS = float(np.finfo(float).eps)
_INVERSE_ITERATIONS = 40  # most steps of inverse iteration towards an eigenvalue nearest zero
_SETTLED_EIGENVALUE = 1e-14  # relative change of an eigenvalue at which inverse iteration ends
_LOWEST_ITERATIONS = 50  # steps of inverse iteration towards a lowest eigenvalue
_SMALLEST_SHIFT = (
    -40
)  # of the largest diagonal entry, a power of two that is doubled until a band is positive
_TARGET_STEPS, MAX_TARGET_STEPS = 4, 8
"""Steps of corrections up to which the next arc is longer, and above which it is shorter."""


@njit(cache=True)
def _copy(values: Vector, into: Vector) -> None:
    """Overwrite the first numbers of a vector; with a slice Numba would compile texts of errors for seconds."""
    for i in range(values.size):
        into[i] = values[i]


@njit(cache=True)
def _begin(band: Fields, factor: Fields) -> None:
    """Overwrite a factor (n + w, w) by a band (n, w), and by zeros beyond it."""
    n = band.shape[0]
    for j in range(n):
        _copy(band[j], factor[j])
    factor[n:] = 0.0


@njit(cache=True)
def balance(gradient: Vector, constrained: Mask, forces: Vector) -> tuple[float, float]:
    """Overwrite what is unbalanced; the largest of it, not a number where one is not, and of the reactions."""
    residual = reaction = 0.0
    for i in range(gradient.size):
        forces[i] = 0.0 if constrained[i] else -gradient[i]
        size = abs(gradient[i])
        if constrained[i]:
            reaction = max(reaction, size)
        elif size > residual or np.isnan(size):
            residual = size
    return residual, reaction


@njit(cache=True)
def stalled(residual: float, last: float, rounding: float) -> bool:
    """Whether the residual no longer falls and is of the order of the estimated round-off."""
    return residual > last / 2 and residual <= _STALL_FACTOR * rounding


@njit(cache=True)
def largest_product(band: Fields, x: Vector, scale: Vector, work: Vector) -> float:
    """The largest entry of |H| max(|x|, scale); work : (n,) is overwritten."""
    n, width = band.shape
    work[:] = 0.0
    for j in range(n):
        size = max(abs(x[j]), scale[j])
        total = work[j] + abs(band[j, 0]) * size
        for k in range(1, min(width, n - j)):
            entry = abs(band[j, k])
            work[j + k] += entry * size
            total += entry * max(abs(x[j + k]), scale[j + k])
        work[j] = total
    largest = 0.0
    for j in range(n):
        largest = max(largest, work[j])
    return largest


@njit(cache=True, error_model="numpy")
def factorise(band: Fields, held: Mask) -> bool:
    """Overwrite a symmetric band with its lower factor, its diagonal inverted; False if not positive.

    Constrained DOFs are uncoupled and have the diagonal 1.

    band : (n + w, w), zero beyond the matrix.
    """
    _hold_apart(band, held)
    if band.shape[1] == len(_UNROLLED):
        return _eliminate(band, held.size, _UNROLLED)
    return _eliminate(band, held.size, range(band.shape[1]))


@njit(cache=True)
def _hold_apart(band: Fields, held: Mask) -> None:
    """Uncouple the constrained DOFs of a band (n + w, w), and make their diagonal one."""
    for j in range(held.size):
        if not held[j]:
            continue
        band[j, 0] = 1.0
        for k in range(1, band.shape[1]):
            band[j, k] = 0.0
            if k <= j:
                band[j - k, k] = 0.0


@njit(cache=True, error_model="numpy")
def _eliminate(band: Fields, n: int, width: Any) -> bool:
    """The factorisation itself; width : something of this length, which compiled code may know."""
    for j in range(n):
        row = band[j]
        if not row[0] > 0.0:
            return False
        row[0] = 1 / np.sqrt(row[0])
        for k in range(1, len(width)):
            row[k] *= row[0]
        for k in range(1, len(width)):
            below, factor = band[j + k], row[k]
            for m in range(k, len(width)):
                below[m - k] -= factor * row[m]
    return True


@njit(cache=True)
def substitute(factor: Fields, x: Vector, room: Vector) -> None:
    """Overwrite a right-hand side (n,) with the solution; room : (n + w,) is overwritten."""
    _copy(x, room)
    if factor.shape[1] == len(_UNROLLED):
        _solve(factor, x.size, _UNROLLED, room)
    else:
        _solve(factor, x.size, range(factor.shape[1]), room)
    _copy(room[: x.size], x)


@njit(cache=True)
def _solve(factor: Fields, n: int, width: Any, room: Vector) -> None:
    """Overwrite the first n numbers of a right-hand side (n + w,) with the solution."""
    room[n:] = 0.0
    for j in range(n):
        room[j] *= factor[j, 0]
        for k in range(1, len(width)):
            room[j + k] -= factor[j, k] * room[j]
    room[n:] = 0.0
    for j in range(n - 1, -1, -1):
        total = room[j]
        for k in range(1, len(width)):
            total -= factor[j, k] * room[j + k]
        room[j] = total * factor[j, 0]


@njit(cache=True)
def substitute_both(factor: Fields, x: Vector, y: Vector, rooms: Fields) -> None:
    """Overwrite two right-hand sides (n,) with the solutions; rooms : (2, n + w) is overwritten."""
    _copy(x, rooms[0])
    _copy(y, rooms[1])
    if factor.shape[1] == len(_UNROLLED):
        _solve_both(factor, x.size, _UNROLLED, rooms[0], rooms[1])
    else:
        _solve_both(factor, x.size, range(factor.shape[1]), rooms[0], rooms[1])
    _copy(rooms[0, : x.size], x)
    _copy(rooms[1, : x.size], y)


@njit(cache=True)
def _solve_both(factor: Fields, n: int, width: Any, x: Vector, y: Vector) -> None:
    """Overwrite the first n numbers of two right-hand sides (n + w,) with the solutions.

    The number known last is subtracted last: what depends on no other goes on meanwhile.
    """
    x[n:] = y[n:] = 0.0
    for j in range(n):
        x[j] *= factor[j, 0]
        y[j] *= factor[j, 0]
        for k in range(1, len(width)):
            x[j + k] -= factor[j, k] * x[j]
            y[j + k] -= factor[j, k] * y[j]
    x[n:] = y[n:] = 0.0
    for j in range(n - 1, -1, -1):
        one, other = x[j], y[j]
        for k in range(len(width) - 1, 0, -1):
            one -= factor[j, k] * x[j + k]
            other -= factor[j, k] * y[j + k]
        x[j], y[j] = one * factor[j, 0], other * factor[j, 0]


@njit(cache=True)
def assembled(body: Body, q: Vector, factor: float, task: int) -> float:
    """Overwrite the gradient, and the Hessian if that is the task; the energy of the body."""
    for i in range(q.size):
        body.at[i] = q[i] + body.origin[i]
        body.gradient[i] = 0.0
    if task == HESSIAN:
        body.band[:, :] = 0.0
    energy: float = body.kernel(
        body.at,
        body.none,
        body.data,
        body.none,
        body.skew,
        task,
        body.gradient,
        body.band[: q.size] if task == HESSIAN else body.skew,
        body.skew,
        body.terms,
    )
    for i in range(q.size):
        body.gradient[i] -= factor * body.dead[i]
    return energy


@njit(cache=True)
def negative_pivots(band: Fields, n: int) -> int:
    """How many eigenvalues are negative, from the signs of the pivots of L D L' (Sylvester's law of inertia).

    band : (n + w, w), zero beyond the matrix; overwritten.
    """
    count = 0
    for j in range(n):
        pivot = band[j, 0]
        count += pivot < 0.0
        if pivot == 0.0:
            continue
        for k in range(1, band.shape[1]):
            factor = band[j, k] / pivot
            for m in range(k, band.shape[1]):
                band[j + k, m - k] -= factor * band[j, m]
    return count


@njit(cache=True, error_model="numpy")
def decompose(band: Fields, skew: Fields, held: Mask, lu: Fields, pivots: NDArray[np.int64]) -> float:
    """Overwrite the factors of a band that need not be positive; the sign of its determinant, zero if singular.

    Gauss's elimination with partial pivoting.  skew : entries below the diagonal of a skew-symmetric part, without rows
    there is none.  lu : (n, 3 w - 2), entry (i, j) of the matrix at [j, 2 w - 2 + i - j].  pivots : (n,).
    """
    n, reach = held.size, band.shape[1] - 1
    at, last, sign = 2 * reach, 0, 1.0
    _spread(band, skew, held, lu)
    for j in range(n):
        below, chosen = min(reach, n - 1 - j), 0
        for k in range(1, below + 1):
            if abs(lu[j, at + k]) > abs(lu[j, at + chosen]):
                chosen = k
        pivots[j], last = chosen, max(last, min(j + reach + chosen, n - 1))
        pivot = lu[j, at + chosen]
        if not abs(pivot) > 0.0:
            return 0.0
        sign = -sign if (pivot < 0.0) != (chosen > 0) else sign
        for c in range(j, last + 1 if chosen else j):
            top = at + j - c
            lu[c, top], lu[c, top + chosen] = lu[c, top + chosen], lu[c, top]
        for k in range(1, below + 1):
            lu[j, at + k] /= pivot
        for c in range(j + 1, last + 1):
            top = at + j - c
            for k in range(1, below + 1):
                lu[c, top + k] -= lu[j, at + k] * lu[c, top]
    return sign


@njit(cache=True)
def _spread(band: Fields, skew: Fields, held: Mask, lu: Fields) -> None:
    """Overwrite lu by a matrix as `decompose` stores it, its constrained DOFs uncoupled."""
    n, reach = held.size, band.shape[1] - 1
    lu[:, :] = 0.0
    for j in range(n):
        for k in range(min(reach, n - 1 - j) + 1):
            entry = 0.0 if held[j] or held[j + k] else band[j, k]
            below = skew[j, k] if skew.shape[0] and k > 0 and not (held[j] or held[j + k]) else 0.0
            lu[j + k, 2 * reach - k] = entry - below
            lu[j, 2 * reach + k] = entry + below
        if held[j]:
            lu[j, 2 * reach] = 1.0


@njit(cache=True, error_model="numpy")
def resolve(lu: Fields, pivots: NDArray[np.int64], x: Vector) -> None:
    """Overwrite a right-hand side (n,) with the solution, by the factors of `decompose`."""
    n, reach = lu.shape[0], lu.shape[1] // 3
    at = 2 * reach
    for j in range(n):
        x[j], x[j + pivots[j]] = x[j + pivots[j]], x[j]
        for k in range(1, min(reach, n - 1 - j) + 1):
            x[j + k] -= lu[j, at + k] * x[j]
    for j in range(n - 1, -1, -1):
        x[j] /= lu[j, at]
        for k in range(1, min(at, j) + 1):
            x[j - k] -= lu[j, at - k] * x[j]


@njit(cache=True, error_model="numpy")
def iterate_inverse(lu: Fields, pivots: NDArray[np.int64], x: Vector) -> float:
    """The eigenvalue nearest zero, by inverse iteration from x, which its vector of unit length overwrites."""
    y, value = np.empty_like(x), np.inf
    for _ in range(_INVERSE_ITERATIONS):
        _copy(x, y)
        resolve(lu, pivots, y)
        along = across = square = 0.0
        for i in range(x.size):
            square += x[i] * x[i]
            along += x[i] * y[i]
            across += y[i] * y[i]
        before, value = value, square / along
        for i in range(x.size):
            x[i] = y[i] / np.sqrt(across)
        if abs(value - before) <= _SETTLED_EIGENVALUE * abs(value):
            break
    return value


@njit(cache=True)
def lowest_motion(band: Fields, x: Vector) -> None:
    """Overwrite x, from which it starts, by the eigenvector of the smallest eigenvalue, its largest component one.

    Inverse iteration with the band (n, w) plus the smallest tried multiple of the unit matrix that makes it positive.
    """
    n, width = band.shape
    factor, room = np.empty((n + width, width)), np.empty(n + width)
    nothing, largest = np.zeros(n, dtype=np.bool_), np.abs(band[:, 0]).max()
    for k in range(_SMALLEST_SHIFT, -_SMALLEST_SHIFT):
        _begin(band, factor)
        factor[:n, 0] += 2.0**k * (largest if largest > 0.0 else 1.0)
        if factorise(factor, nothing):
            break
    for _ in range(_LOWEST_ITERATIONS):
        substitute(factor, x, room)
        x /= np.abs(x).max()


@njit(cache=True, error_model="numpy")
def keep_on_plane(q: Vector, plane: Plane, step: Vector, rate: Vector, state: Vector) -> None:
    """Overwrite Newton's step, at a fixed load, by that within the plane, and the change of the load factor.

    rate : (n,) of the DOFs with the load factor.
    """
    part = plane.weight * plane.slope
    missing = state[FACTOR] - plane.factor - plane.ds * plane.slope
    across, along, beside = part * missing, 0.0, part
    for i in range(q.size):
        across += plane.direction[i] * (q[i] - plane.start[i] - plane.ds * plane.direction[i])
        along += plane.direction[i] * step[i]
        beside += plane.direction[i] * rate[i]
    state[CHANGE] = -(across + along) / beside
    for i in range(q.size):
        step[i] += state[CHANGE] * rate[i]


@njit(cache=True)
def respond(around: Around, q: Vector, plane: Plane, step: Vector, rate: Vector, state: Vector) -> int:
    """Overwrite the step within a plane from q, where the Hessian is known, and the rate with the load factor.

    Where the forces are BALANCED there is no step, `state[NEGATIVE]` is known, and where the Hessian is SINGULAR, the
    rate is zero.
    """
    n = q.size
    residual, reaction = balance(around.gradient, around.held, step)
    rounding = _EPS * largest_product(around.band, q, around.scale, around.rooms[0, :n])
    for i in range(n):
        rate[i] = 0.0 if around.held[i] else -around.rate[i]
    last, scale = state[RESIDUAL], max(abs(state[FACTOR]) * plane.load, reaction)
    tolerance = max(plane.tolerance * scale, rounding)
    state[RESIDUAL], state[TOLERANCE], state[ROUNDING] = residual, tolerance, rounding
    balanced = residual <= tolerance or stalled(residual, last, rounding)
    state[NEGATIVE] = state[SINGULAR] = 0.0
    _begin(around.band, around.factor)
    if not around.skew.shape[0] and factorise(around.factor, around.held):
        if balanced:
            state[LOG] = _log_of_factor(around.factor, n)
            substitute(around.factor, rate, around.rooms[0])
        else:
            substitute_both(around.factor, step, rate, around.rooms)
    else:
        _respond_indefinite(around, step, rate, state, balanced)
    if balanced:
        return BALANCED
    if state[SINGULAR]:
        return UNDEFINED
    keep_on_plane(q, plane, step, rate, state)
    return STEPS


@njit(cache=True, error_model="numpy")
def _log_of_factor(factor: Fields, n: int) -> float:
    """The logarithm of the determinant, from the factor of `factorise`."""
    total = 0.0
    for j in range(n):
        total -= 2 * np.log(factor[j, 0])
    return total


@njit(cache=True, error_model="numpy")
def log_of_pivots(lu: Fields) -> float:
    """The logarithm of the size of the determinant, from the factors of `decompose`; -inf if it is zero."""
    total, diagonal = 0.0, 2 * (lu.shape[1] // 3)
    for j in range(lu.shape[0]):
        total += np.log(abs(lu[j, diagonal]))
    return total


@njit(cache=True, inline="always")
def _respond_indefinite(
    around: Around, step: Vector, rate: Vector, state: Vector, balanced: bool
) -> None:
    """Overwrite the rate and the step, right-hand sides; where the forces are balanced, count in place of the step.

    With a skew part the negative eigenvalues are one if the determinant is negative, as in `solvers.system`.
    """
    n = step.size
    sign = decompose(around.band, around.skew, around.held, around.lu, around.pivots)
    state[SINGULAR] = 1.0 if sign == 0.0 else 0.0
    if sign == 0.0:
        rate[:] = 0.0
    else:
        resolve(around.lu, around.pivots, rate)
        if not balanced:
            resolve(around.lu, around.pivots, step)
    if not balanced:
        return
    state[LOG] = log_of_pivots(around.lu)
    if around.skew.shape[0]:
        state[NEGATIVE] = 1.0 if sign < 0.0 else 0.0
        return
    _begin(around.band, around.factor)
    _hold_apart(around.factor, around.held)
    state[NEGATIVE] = negative_pivots(around.factor, n)


def _at_address(signature: Any) -> Any:
    """What makes a function of this signature of its address: to take one as an argument costs as much as a step."""
    kind = types.FunctionType(signature)

    @intrinsic
    def function(_: Any, address: Any) -> Any:
        def code(context: Any, builder: Any, __: Any, arguments: Any) -> Any:
            made = create_struct_proxy(kind)(context, builder)  # type: ignore[no-untyped-call]
            made.c_addr = builder.inttoptr(arguments[0], voidptr_t)
            return made._getvalue()

        return kind(types.int64), code

    return function


_potential_at, _space_at = _at_address(KERNEL), _at_address(SPACE_KERNEL)


@njit(cache=True)
def next_arc(ds: float, steps: int, longest: float) -> float:
    """The length of the next arc, after one that took so many steps of corrections."""
    if steps <= _TARGET_STEPS:
        return min(longest, 2 * ds)
    return ds / 2 if steps > MAX_TARGET_STEPS else ds


@njit(cache=True)
def move_on(q: Vector, step: Vector, state: Vector, fraction: float) -> None:
    """Take a fraction of a step."""
    for i in range(q.size):
        q[i] += fraction * step[i]
    state[FACTOR] += fraction * state[CHANGE]
    state[COUNT] += 1.0


@njit(cache=True, inline="always")
def _correct(
    body: Body, around: Around, plane: Plane, answer: tuple[Vector, Vector, Vector, Vector]
) -> bool:
    """Newton's method within a plane; whether the forces are balanced.  answer : as of `_next_point`."""
    q, step, rate, state = answer
    for i in range(q.size):
        q[i] = plane.start[i] + plane.ds * plane.direction[i]
    state[FACTOR], state[RESIDUAL] = plane.factor + plane.ds * plane.slope, np.inf
    state[COUNT] = 0.0
    while state[COUNT] < plane.most:
        if not np.isfinite(assembled(body, q, state[FACTOR], HESSIAN)):
            return False
        outcome = respond(around, q, plane, step, rate, state)
        if outcome != STEPS:
            return outcome == BALANCED
        move_on(
            q, step, state, min(1.0, body.space(FRACTION, body.placed, q, step, body.held, body.skew))
        )
    return False


@njit(cache=True, error_model="numpy")
def _length(body: Body, q: Vector, change: Vector, rise: float) -> float:
    """Length of a change of the DOFs, in step limits, and of the load factor."""
    size = 1 / body.space(FRACTION, body.placed, q, change, body.held, body.skew)
    return float(np.sqrt(size * size + rise * rise))


@njit(cache=True)
def _product(one: Vector, rise: float, other: Vector, slope: float, weight: float) -> float:
    """Product of two tangents."""
    total = 0.0
    for i in range(one.size):
        total += one[i] * other[i]
    return float(total + weight * rise * slope)


@njit(cache=True, error_model="numpy", inline="always")
def _next_point(
    body: Body, around: Around, plane: Plane, stray: float, answer: tuple[Vector, Vector, Vector, Vector]
) -> tuple[bool, float, float]:
    """Whether there is an equilibrium in a plane near its centre, the slope of the path there, and the cosine of the
    turn from the direction of the plane.

    answer : q, direction of the path, rate and state, which are overwritten.
    """
    q, ahead, rate, state = answer
    if not _correct(body, around, plane, answer):
        return False, 0.0, 0.0
    for i in range(q.size):
        ahead[i] = q[i] - plane.start[i] - plane.ds * plane.direction[i]
    missing = state[FACTOR] - plane.factor - plane.ds * plane.slope
    if _length(body, q, ahead, missing) > stray:
        return False, 0.0, 0.0  # an equilibrium of another path
    slope = 1 / _length(body, q, rate, 1.0)
    for i in range(q.size):
        ahead[i] = slope * rate[i]
    product = _product(ahead, slope, plane.direction, plane.slope, plane.weight)
    if product < 0:
        slope, product = -slope, -product
        for i in range(q.size):
            ahead[i] = -ahead[i]
    own = _product(ahead, slope, ahead, slope, plane.weight)
    before = _product(plane.direction, plane.slope, plane.direction, plane.slope, plane.weight)
    return True, slope, product / np.sqrt(own * before)


@njit(cache=True, nogil=True)
def follow(
    kernel_address: int,
    space_address: int,
    numbers: Numbers,
    around: Around,
    arcs: Arcs,
    start: tuple[Vector, Vector],
    found: Found,
) -> int:
    """Follow a path by arcs from a point until something happens to it; how many arcs.

    The last arc is one in which an eigenvalue changes its sign, the load turns back or passes one of its bounds, or one
    after which there is no other.  start : DOFs and direction.  found : is overwritten.
    """
    body, most = _of_address(kernel_address, space_address, numbers, around, arcs), len(found.q)
    (q, way), factor, rise, ds = start, arcs.factor, arcs.slope, arcs.ds
    negative, lost, state = arcs.negative, 0.0, np.zeros(STATE)
    for k in range(most):
        first, good = ds, False
        weight = _product(way, 0.0, way, 0.0, 0.0)
        answer = found.q[k], found.direction[k], found.rate[k], state
        while ds > arcs.smallest and not good:
            plane = Plane(
                q, way, factor, rise, ds, weight or 1.0, arcs.load, arcs.tolerance, 2 * MAX_TARGET_STEPS
            )
            good, slope, cosine = _next_point(body, around, plane, arcs.stray * ds, answer)
            good = good and cosine > arcs.cosine
            lost += state[COUNT]
            if not good:
                ds /= 2
        found.lost[0] = lost
        if not good:
            return k
        state[TRIED], state[LENGTH], state[SLOPE], state[SPENT] = first, ds, slope, lost
        _react(body, found.reaction[k])
        _copy(state, found.state[k])
        turned = negative != state[NEGATIVE] or slope * rise < 0.0
        ended = abs(state[FACTOR]) > arcs.limit
        if turned or ended or (state[FACTOR] - arcs.until) * (factor - arcs.until) <= 0.0:
            return k + 1
        q, way, factor, rise = found.q[k], found.direction[k], state[FACTOR], slope
        ds, lost = next_arc(ds, int(lost), arcs.longest), 0.0
    return most


@njit(cache=True, inline="always")
def _of_address(
    kernel_address: int, space_address: int, numbers: Numbers, around: Around, arcs: Arcs
) -> Body:
    """A body whose kernels are at given addresses."""
    n = around.gradient.size
    return Body(
        _potential_at(kernel_address),
        _space_at(space_address),
        numbers.data,
        numbers.origin,
        numbers.placed,
        around.scale,
        numbers.dead,
        around.held,
        arcs.load,
        arcs.load,
        np.empty(n),
        around.gradient,
        around.rooms[0],
        around.band,
        around.skew,
        np.empty(numbers.terms),
        np.empty(0),
    )


@njit(cache=True)
def _load_rates(body: Body, q: Vector, velocity: Vector, rates: Fields) -> None:
    """Overwrite the rates with the load factor at q, where the Hessian has been factorised."""
    for i in range(q.size):
        velocity[i] = 0.0 if body.held[i] else body.dead[i]
    substitute(body.band, velocity, body.room)
    body.space(RATES, body.placed, q, velocity, body.held, rates)


@njit(cache=True)
def reach(
    body: Body,
    limits: Limits,
    q: Vector,
    goal: float,
    size: float,
    step: Vector,
    rates: Fields,
    ahead: Fields,
    answer: tuple[Vector, Vector],
) -> tuple[bool, int]:
    """Newton's method from q, which is overwritten, at a load factor: whether it converges, and its steps.

    size : largest rotation or stretch of the increment.  Before the last one q need not satisfy the balance to the
    end, as long as little of the increment is left to correct.
    ahead : is overwritten by the rates with the load factor.  answer : at the last one reaction and forces.
    """
    reaction, forces = answer
    last, load = np.inf, abs(goal) * body.load
    for count in range(limits.max_iterations + 1):
        energy = assembled(body, q, goal, HESSIAN)
        residual, support = balance(body.gradient, body.held, step)
        rounding = _EPS * largest_product(body.band[: q.size], q, body.scale, body.at)
        scale = max(load, support)
        tolerance = max(limits.tolerance * scale, rounding)
        sound = np.isfinite(energy) and rounding <= MAX_ROUND_OFF_FRACTION * max(scale, body.total)
        if not sound or not factorise(body.band, body.held):
            return False, count
        substitute(body.band, step, body.room)
        if goal == 1.0 and (residual <= tolerance or stalled(residual, last, rounding)):
            forces[0], forces[1], forces[-1] = residual, tolerance, rounding
            _polish(body, q, step, reaction, forces)
            return True, count
        last = residual
        body.space(RATES, body.placed, q, step, body.held, rates)
        fastest = largest_of(rates)
        settled = goal < 1.0 and fastest <= _SETTLED * size
        if settled:
            _load_rates(body, q, body.at, ahead)
        if not np.isfinite(fastest) or count == limits.max_iterations:
            return False, count
        _move(body, q, step, rates, fastest)
        if settled:
            return True, count + 1
    return False, limits.max_iterations


@njit(cache=True)
def _polish(body: Body, q: Vector, step: Vector, reaction: Vector, forces: Vector) -> None:
    """Keep the balance at q, or after one more step, if the residual is smaller there or is round-off."""
    _react(body, reaction)
    for i in range(q.size):
        step[i] += q[i]
    assembled(body, step, 1.0, GRADIENT)
    nearer, _ = balance(body.gradient, body.held, body.at)
    if nearer <= max(forces[0], forces[-1]):
        forces[0] = nearer
        _copy(step, q)
        _react(body, reaction)


@njit(cache=True)
def _react(body: Body, reaction: Vector) -> None:
    """Overwrite the forces of the constrained DOFs, from the gradient assembled last."""
    for i in range(reaction.size):
        reaction[i] = body.gradient[i] if body.held[i] else 0.0


@njit(cache=True)
def _move(body: Body, q: Vector, step: Vector, rates: Fields, fastest: float) -> None:
    """Move q by a step: the parts rotate and stretch by its rates, so that a rotation does not stretch them."""
    if fastest <= _STRAIGHT:
        for i in range(q.size):
            q[i] += step[i]
        return
    share = min(1.0, body.space(FRACTION, body.placed, q, step, body.held, rates))
    for row in rates:
        for k in range(row.size):
            row[k] *= share
    _copy(q, step)
    body.space(PREDICTED, body.placed, q, step, body.held, rates)
    _copy(step, q)


@njit(cache=True)
def largest_of(values: Fields) -> float:
    """The largest size of some numbers."""
    largest = 0.0
    for row in values:
        for value in row:
            if not abs(value) <= largest:
                largest = abs(value)
    return largest


@njit(cache=True, error_model="numpy")
def _extrapolate(
    rates: Fields, earlier: Fields, before: float, point: float, goal: float, moved: Fields
) -> None:
    """Overwrite the motion from one load factor to another by the rates there and, if it is not negative, before.

    derived: a body that stiffens as it turns towards its load has rates like 1 / (c + factor).  With the logarithm of
    c + factor as the parameter they change least; c makes them the same at both points in the mean.  Otherwise the
    parameter is the factor.
    """
    first = goal - point
    second, share = 0.0, 1.0
    if before >= 0.0:
        both = square = 0.0
        for i in range(rates.shape[0]):
            for k in range(rates.shape[1]):
                both += rates[i, k] * earlier[i, k]
                square += earlier[i, k] * earlier[i, k]
        second = first * first / 2 / (point - before)
        share = both / square
        if 0.0 < share < _STIFFENING:
            c = (point * share - before) / (1 - share)
            first = (c + point) * np.log((c + goal) / (c + point))
            second = first * first / (c + point) / 2 / -np.log(share)
        else:
            share = 1.0
    for i in range(rates.shape[0]):
        for k in range(rates.shape[1]):
            moved[i, k] = first * rates[i, k] + second * (rates[i, k] - share * earlier[i, k])


@njit(cache=True)
def _start(body: Body, q: Vector, step: Vector) -> bool:
    """Whether the body is at rest without loads, stable, and its loads above round-off; the Hessian is factorised."""
    energy = assembled(body, q, 0.0, HESSIAN)
    residual, _ = balance(body.gradient, body.held, step)
    rounding = _EPS * largest_product(body.band[: q.size], q, body.scale, body.at)
    sound = np.isfinite(energy) and residual <= _STALL_FACTOR * rounding and body.load > 0.0
    if not sound or rounding > MAX_ROUND_OFF_FRACTION * body.total:
        return False
    return factorise(body.band, body.held)


@njit(cache=True)
def stray(
    body: Body, q: Vector, new: Vector, moved: Fields, work: tuple[Vector, Vector, Fields]
) -> float:
    """Error of a predicted motion `moved` from q to new, as a fraction of the motion; moved is overwritten."""
    middle, step, turned = work
    for i in range(q.size):
        middle[i], step[i] = (q[i] + new[i]) / 2, new[i] - q[i]
    body.space(RATES, body.placed, middle, step, body.held, turned)
    for i in range(moved.shape[0]):
        for k in range(moved.shape[1]):
            moved[i, k] -= turned[i, k]
    return largest_of(moved) / max(largest_of(turned), NEGLIGIBLE_ROTATION)


@njit(cache=True)
def _climb(
    body: Body,
    limits: Limits,
    q: Vector,
    answer: tuple[Vector, Vector],
    counts: NDArray[np.int64],
    vectors: tuple[Vector, Vector, Vector],
    parts: tuple[Fields, Fields, Fields, Fields, Fields],
) -> int:
    """One body from its start q as its loads grow; everything but the body and the limits is overwritten."""
    point, increment, before = 0.0, limits.longest, -1.0
    middle, new, step = vectors
    rates, earlier, ahead, moved, turned = parts
    if not _start(body, q, step):
        return LEFT
    _load_rates(body, q, middle, rates)
    while point < 1.0:
        fastest = largest_of(rates)
        increment = min(increment, limits.longest, MAX_ROTATION / fastest if fastest > 0.0 else np.inf)
        if (
            increment < 1.0 - point < 3 / 2 * increment
        ):  # a short last one would show the errors of this one
            increment = (1.0 - point) / 2
        goal = point + increment if point + 1.001 * increment < 1.0 else 1.0
        _extrapolate(rates, earlier, before, point, goal, moved)
        _copy(q, new)
        body.space(PREDICTED, body.placed, q, new, body.held, moved)
        size = max(largest_of(moved), NEGLIGIBLE_ROTATION)
        good, steps = reach(body, limits, new, goal, size, step, turned, ahead, answer)
        counts[0] += steps
        off = stray(body, q, new, moved, (middle, step, turned)) if good else np.inf
        if not off <= PREDICTION_TOLERANCE:
            counts[1] += 1
            if counts[1] >= MAX_CUTBACKS:
                return LEFT
            increment = (goal - point) / 2
            continue
        before, point = point, goal
        for i in range(limits.parts):
            _copy(rates[i], earlier[i])
            _copy(ahead[i], rates[i])
        _copy(new, q)
        increment *= min(2.0, max(0.5, np.sqrt(PREDICTION_TOLERANCE / 2 / max(off, 1e-3))))
    return REACHED


@njit(cache=True)
def _member(
    kernel: Any,
    space: Any,
    members: Members,
    held: Mask,
    m: int,
    vectors: tuple[Vector, Vector, Vector, Vector, Vector],
    bands: tuple[Fields, Fields],
) -> Body:
    """One body of several, with work space."""
    at, gradient, room, terms, none = vectors
    band, skew = bands
    return Body(
        kernel,
        space,
        members.constants[m],
        members.origin[m],
        members.placed[m],
        members.scale[m],
        members.dead[m],
        held,
        members.sizes[m, 0],
        members.sizes[m, 1],
        at,
        gradient,
        room,
        band,
        skew,
        terms,
        none,
    )


@njit(cache=True, nogil=True)
def climb_all(
    kernel_at: int, space_at: int, members: Members, held: Mask, limits: Limits, answers: Answers
) -> int:
    """Find the equilibria of all bodies under their full loads; how many were reached.

    kernel_at, space_at : addresses of a `solvers.potential.KERNEL` and of a `solvers.members.SPACE_KERNEL`.
    held : (n,) the constrained DOFs.
    """
    kernel, space = _potential_at(kernel_at), _space_at(space_at)
    count, n = members.dead.shape
    vectors = np.zeros(n), np.zeros(n), np.zeros(n)
    shape = limits.parts, 2
    pairs = np.zeros(shape), np.zeros(shape), np.zeros(shape)
    parts = (*pairs, np.zeros(shape), np.zeros(shape))
    at, gradient, room = np.empty(n), np.empty(n), np.empty(n + limits.width)
    band = np.zeros((n + limits.width, limits.width))
    skew, terms, none = np.empty((0, 1)), np.empty(limits.terms), np.empty(0)
    reached = 0
    for m in range(count):
        body = _member(kernel, space, members, held, m, (at, gradient, room, terms, none), (band, skew))
        _copy(members.start[m], answers.q[m])
        answers.counts[m] = 0
        answers.status[m] = _climb(
            body,
            limits,
            answers.q[m],
            (answers.reaction[m], answers.forces[m]),
            answers.counts[m],
            vectors,
            parts,
        )
        reached += answers.status[m] == REACHED
    return reached


@njit(cache=True, nogil=True)
def rates_all(
    kernel_at: int,
    space_at: int,
    members: Members,
    held: Mask,
    width: int,
    parts: int,
    q: Fields,
    ways: Ways,
    found: Rates,
) -> int:
    """Find how stable equilibria q (M, n) move with parameters, each with one factorisation; how many do.

    derived: where a parameter changes the lengths of the reference by factors s of the DOFs, and an equilibrium keeps
    its strains, its DOFs are s q, and their forces 1 / s times those that are counted in the old lengths.  So the rate
    of the gradient is that of the softened constants, less s' times the inner forces and less the rate of the loads.
    The Hessian answers it.
    """
    kernel, space = _potential_at(kernel_at), _space_at(space_at)
    count, n = q.shape
    each = ways.softens.size
    at, gradient, room, terms = np.empty(n), np.empty(n), np.empty(n + width), np.empty(parts)
    band, skew, none = np.zeros((n + width, width)), np.empty((0, 1)), np.empty(0)
    whole, inner = np.empty((n, width)), np.empty(n)
    softened = np.empty(members.constants.shape[1], dtype=np.uint8)
    moved = 0
    for m in range(count):
        body = _member(kernel, space, members, held, m, (at, gradient, room, terms, none), (band, skew))
        found.status[m] = UNSTABLE
        if not np.isfinite(assembled(body, q[m], 1.0, HESSIAN)):
            continue
        whole[:, :] = band[:n]
        for i in range(n):
            inner[i] = gradient[i] + body.dead[i]
        rounding = _EPS * largest_product(whole, q[m], body.scale, at)
        if not factorise(band, held):
            continue
        softened[:] = members.constants[m]
        for k in range(each):
            row = m * each + k
            gradient[:] = 0.0
            if ways.softens[k]:
                _soften(body, q[m], softened, ways.places, ways.softened[row])
            for i in range(n):
                change = gradient[i] - ways.scaled[row, i] * inner[i] - ways.dead[row, i]
                found.reaction[row, i] = change
            found.rounding[row] = _answer(body, q[m], ways.scaled[row], whole, rounding, found, row)
        found.status[m] = CRITICAL if _is_critical(body, q[m], whole, inner) else REGULAR
        moved += found.status[m] == REGULAR
    return moved


@njit(cache=True)
def _soften(
    body: Body, q: Vector, constants: NDArray[np.uint8], places: NDArray[np.int64], values: Vector
) -> None:
    """Add the gradient of the potential with some values at places (P, F) among its constants."""
    numbers = constants.view(np.float64)
    for row in places:
        for f in range(values.size):
            numbers[row[f]] = values[f]
    for i in range(q.size):
        body.at[i] = q[i] + body.origin[i]
    body.kernel(
        body.at,
        body.none,
        constants,
        body.none,
        body.skew,
        GRADIENT,
        body.gradient,
        body.skew,
        body.skew,
        body.terms,
    )


@njit(cache=True)
def _answer(
    body: Body, q: Vector, scaled: Vector, whole: Fields, rounding: float, found: Rates, row: int
) -> float:
    """Overwrite the rates of the DOFs and of the forces that hold them, from that of the gradient in the latter.

    whole : (n, w) the Hessian, whose factor the band of the body is.  Returns the fraction that round-off has in the
    rate of the gradient.
    """
    step, rate, largest = found.q[row], found.reaction[row], 0.0
    for i in range(q.size):
        step[i] = 0.0 if body.held[i] else -rate[i]
        largest = max(largest, abs(step[i]))
    substitute(body.band, step, body.room)
    multiply(whole, step, body.gradient)
    for i in range(q.size):
        step[i] += scaled[i] * q[i]
        rate[i] = rate[i] + body.gradient[i] if body.held[i] else 0.0
    return rounding / largest if largest > 0.0 else 0.0


@njit(cache=True)
def multiply(band: Fields, x: Vector, product: Vector) -> None:
    """Overwrite the product of a symmetric band (n, w) and a vector (n,)."""
    n, width = band.shape
    product[:] = 0.0
    for j in range(n):
        total = product[j] + band[j, 0] * x[j]
        for k in range(1, min(width, n - j)):
            product[j + k] += band[j, k] * x[j]
            total += band[j, k] * x[j + k]
        product[j] = total


@njit(cache=True)
def _is_critical(body: Body, q: Vector, whole: Fields, x: Vector) -> bool:
    """Whether the softest eigenvalue would be zero at a load so near that no computation tells them apart.

    whole : (n, w) the Hessian, whose factor the band of the body is.  x : (n,) is overwritten.  Next to a critical load
    the softest eigenvalue is so far below all others that one inverse iteration gives its vector: if another one
    still changes it, the load is not critical.
    """
    change, product = np.empty(q.size), np.empty(q.size)
    for i in range(q.size):
        x[i] = 0.0 if body.held[i] else np.cos(1.7 * i)
        change[i] = 0.0 if body.held[i] else body.dead[i]
    _soften_most(body, x)
    product[:] = x
    _soften_most(body, x)
    away = 0.0
    for i in range(q.size):
        away = max(away, abs(x[i] - product[i]))
    if away > _APART:
        return False
    substitute(body.band, change, body.room)
    multiply(whole, x, product)
    value = (x * product).sum()
    for i in range(q.size):
        change[i] = q[i] + BESIDE * change[i]
    assembled(body, change, 1.0 + BESIDE, HESSIAN)
    multiply(body.band[: q.size], x, product)
    return not abs(value) * BESIDE > NEARLY_CRITICAL * abs((x * product).sum() - value)


@njit(cache=True)
def _soften_most(body: Body, x: Vector) -> None:
    """One inverse iteration with a factorised Hessian: x comes nearer to the softest vector, of unit length."""
    substitute(body.band, x, body.room)
    x /= np.sqrt((x * x).sum())
