"""Compiled functions of the configuration space of a planar rod: how its edges and directors rotate and stretch."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.solvers.members import FRACTION, PREDICTED, RATES

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_MAX_ROTATION = 1.0  # of a director in one step [rad]


@njit(cache=True)
def _part(placed: Array, q: Array, number: int, vertices: int) -> tuple[float, float]:
    """Components of an edge, or after those of a director, at DOFs q of a rod."""
    if number < vertices - 1:
        a, b = 4 * number, 4 * number + 4
        first = placed[b] + q[b] - (placed[a] + q[a])
        return first, placed[b + 1] + q[b + 1] - (placed[a + 1] + q[a + 1])
    i = 4 * (number - vertices + 1) + 2
    return placed[i] + q[i], placed[i + 1] + q[i + 1]


@njit(cache=True)
def _change(change: Array, number: int, vertices: int) -> tuple[float, float]:
    """Components of the change of an edge or of a director."""
    if number < vertices - 1:
        a, b = 4 * number, 4 * number + 4
        return change[b] - change[a], change[b + 1] - change[a + 1]
    i = 4 * (number - vertices + 1) + 2
    return change[i], change[i + 1]


@njit(cache=True, error_model="numpy")
def _rates(placed: Array, q: Array, change: Array, rates: Array) -> None:
    """Overwrite rates of rotation [rad] and stretch of edges, then of directors, (2 N - 1, 2)."""
    vertices = q.size // 4
    for number in range(2 * vertices - 1):
        a, b = _part(placed, q, number, vertices)
        by_a, by_b = _change(change, number, vertices)
        square = a * a + b * b
        rates[number, 0] = (a * by_b - b * by_a) / square
        rates[number, 1] = (a * by_a + b * by_b) / square


@njit(cache=True, error_model="numpy")
def _fraction(placed: Array, q: Array, step: Array) -> float:
    """Largest fraction of a step that changes no director by more than its length, one radian."""
    fastest = 0.0
    for first in range(2, q.size, 4):
        a, b = placed[first] + q[first], placed[first + 1] + q[first + 1]
        square = (step[first] ** 2 + step[first + 1] ** 2) / (a * a + b * b)
        if not square <= fastest:
            fastest = square
    return _MAX_ROTATION / np.sqrt(fastest) if fastest != 0.0 else np.inf


@njit(cache=True)
def _predict(placed: Array, q: Array, moved: Array, constrained: Mask, new: Array) -> None:
    """Overwrite the DOFs after rotations and stretches of edges and directors, except constrained ones.

    Rotated edges miss the supports; the gap is distributed along the rod between them.
    """
    vertices, goal = q.size // 4, new.copy()
    x, y = placed[0] + q[0], placed[1] + q[1]
    for number in range(2 * vertices - 1):
        a, b = _part(placed, q, number, vertices)
        c, s = np.cos(moved[number, 0]), np.sin(moved[number, 0])
        wide = 1 + moved[number, 1]
        a, b = wide * (c * a - s * b), wide * (s * a + c * b)
        if number < vertices - 1:
            i = 4 * number
            new[i], new[i + 1] = x - placed[i], y - placed[i + 1]
            x, y = x + a, y + b
        else:
            i = 4 * (number - vertices + 1) + 2
            new[i], new[i + 1] = a - placed[i], b - placed[i + 1]
    last = 4 * vertices - 4
    new[last], new[last + 1] = x - placed[last], y - placed[last + 1]
    for axis in range(2):
        _close(goal, constrained, new, axis)
    for i in range(q.size):
        if constrained[i]:
            new[i] = goal[i]


@njit(cache=True)
def _close(goal: Array, constrained: Mask, new: Array, axis: int) -> None:
    """Move the vertices along one axis so that the supported ones are at their goal."""
    vertices, before, gap = goal.size // 4, -1, 0.0
    for vertex in range(vertices):
        i = 4 * vertex + axis
        if not constrained[i]:
            continue
        missing = goal[i] - new[i]
        for K in range(before + 1, vertex + 1):
            share = 1.0 if before < 0 else (K - before) / (vertex - before)
            new[4 * K + axis] += gap + share * (missing - gap)
        before, gap = vertex, missing
    for K in range(before + 1, vertices):
        new[4 * K + axis] += gap


@njit(cache=True)
def planar(task: int, placed: Array, q: Array, change: Array, constrained: Mask, rates: Array) -> float:
    """The space of a planar rod with one director; arguments as in `solvers.members.SPACE_KERNEL`."""
    if task == FRACTION:
        return _fraction(placed, q, change)
    if task == RATES:
        _rates(placed, q, change, rates)
    elif task == PREDICTED:
        _predict(placed, q, rates, constrained, change)
    return 0.0
