"""The compiled energy of springs between a rod and the ground.

derived: the energy of a spring is k s^2 / 2.  s is c . (x - X) at its place, or the angle of the director there less
that of the reference.  Between two vertices s is the linear interpolation of theirs.  With t = d / |d| and n across it,
grad alpha = n / |d| and grad grad alpha = -(t n + n t) / |d|^2.  Angles are unwrapped from vertex to vertex, and the
winding angle of the first director is an internal variable, as for couples.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.solvers.banded import Band, Vector
from cosserat.solvers.potential import COMMIT, GRADIENT, HESSIAN, STRAINS

Array = NDArray[np.float64]
ELEMENT = np.dtype(
    [
        ("stiffness", "f8"),  # [N/m], or [N m/rad] of one that turns
        ("rest", "f8"),  # the value of s in the reference, to be subtracted [m] or [rad]
        ("low", "f8"),  # weights of its vertex and of the next one
        ("high", "f8"),
        ("along_3", "f8"),  # direction of one that does not turn
        ("along_2", "f8"),
        ("vertex", "i8"),
        (
            "per_vertex",
            "i8",
        ),  # DOFs of a vertex; the position is the first pair, the director the second
        ("turns", "i8"),  # 1 of a rotational spring, else 0
    ]
)
"""One spring; springs are in the order of their vertices."""


@njit(cache=True)
def _near(y: float, x: float, near: float) -> float:
    """Polar angle of (x, y), within half a turn of another angle."""
    angle = np.arctan2(y, x)
    return float(angle - 2 * np.pi * np.round((angle - near) / (2 * np.pi)))


@njit(cache=True)
def _turn(q: Vector, p: int, r: int) -> float:
    """Angle from the director at the DOF p to the one at r."""
    return float(np.arctan2(q[p] * q[r + 1] - q[p + 1] * q[r], q[p] * q[r] + q[p + 1] * q[r + 1]))


@njit(cache=True)
def _measure(q: Vector, springs: NDArray[np.void], k: int, angle: float) -> float:
    """s of a spring; angle : that of the director of its vertex, unwrapped."""
    e = springs[k]
    p = e.vertex * e.per_vertex + 2 * e.turns
    r = p + e.per_vertex
    if e.turns == 1:
        more = e.high * _turn(q, p, r) if e.high != 0.0 else 0.0
        return float((e.low + e.high) * angle + more - e.rest)
    s = e.low * (e.along_3 * q[p] + e.along_2 * q[p + 1]) - e.rest
    if e.high != 0.0:
        s += e.high * (e.along_3 * q[r] + e.along_2 * q[r + 1])
    return float(s)


@njit(cache=True, error_model="numpy")
def _add(
    q: Vector,
    springs: NDArray[np.void],
    k: int,
    force: float,
    hessian: bool,
    gradient: Vector,
    band: Band,
) -> None:
    """Add the gradient of the energy of a spring with this force, and its Hessian."""
    e, slope = springs[k], np.zeros(4)
    p, sides = e.vertex * e.per_vertex + 2 * e.turns, 1 if e.high == 0.0 else 2
    for side in range(sides):
        r, weight = p + side * e.per_vertex, e.low if side == 0 else e.high
        slope[2 * side], slope[2 * side + 1] = weight * e.along_3, weight * e.along_2
        if e.turns == 1:
            d0, d1 = q[r], q[r + 1]
            square = d0 * d0 + d1 * d1
            slope[2 * side], slope[2 * side + 1] = -weight * d1 / square, weight * d0 / square
            if hessian:
                bend = force * weight / (square * square)
                band[r, 0] += 2 * bend * d0 * d1
                band[r, 1] += bend * (d1 * d1 - d0 * d0)
                band[r + 1, 0] -= 2 * bend * d0 * d1
    for i in range(2 * sides):
        at = p + (i // 2) * e.per_vertex + i % 2
        gradient[at] += force * slope[i]
        for j in range(i + 1 if hessian else 0):
            before = p + (j // 2) * e.per_vertex + j % 2
            band[before, at - before] += e.stiffness * slope[i] * slope[j]


@njit(cache=True, error_model="numpy")
def evaluate(
    q: Vector,
    after: Vector,
    data: NDArray[np.uint8],
    history: Vector,
    strains: Array,
    task: int,
    gradient: Vector,
    band: Band,
    skew: Band,
    terms: Array,
) -> float:
    """The energy of all springs; arguments as in `solvers.potential.KERNEL`, `strains` (springs, 1) are their s."""
    springs, energy, angle, vertex = data.view(ELEMENT), 0.0, 0.0, 0
    ends, per_vertex = after if after.size > 0 else q, springs[0].per_vertex
    if history.size > 0:
        angle = _near(ends[3], ends[2], history[0])
    if task == COMMIT:
        if history.size > 0:
            history[0] = angle
        return 0.0
    for k in range(springs.size):
        while springs[k].turns == 1 and vertex < springs[k].vertex:
            angle += _turn(ends, vertex * per_vertex + 2, (vertex + 1) * per_vertex + 2)
            vertex += 1
        s, stiffness = _measure(ends, springs, k, angle), springs[k].stiffness
        energy += stiffness * s * s / 2
        if task == STRAINS:
            strains[k, 0] = s
        if task in (GRADIENT, HESSIAN):
            mean = s if after.size == 0 else (s + strains[k, 0]) / 2
            _add(q, springs, k, stiffness * mean, task == HESSIAN, gradient, band)
    terms[0] = energy
    return energy
