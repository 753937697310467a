"""What holds a rod and what it carries: supports, springs, foundations and masses, each with the sign of its kind."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from cosserat.figures.style import EXACT, INK, PAPER
from cosserat.rods.attachments.foundations import Foundation
from cosserat.rods.attachments.springs import Spring
from cosserat.rods.naming import unit_vector
from cosserat.rods.places import vertex_at
from cosserat.rods.problem import RodProblem
from cosserat.rods.supports import Support

Array = NDArray[np.float64]
_SIGN = 0.022  # half the size of a sign, as a fraction of the rod's length
_SPRINGS = 9  # drawn under the whole of a foundation
_ZIGZAG = np.array([[0, 0], [1, 0], [1.5, 0.6], [2.5, -0.6], [3.5, 0.6], [4.5, -0.6], [5, 0], [6, 0]])


def draw_supports(ax: Axes, problem: RodProblem, x: Array, D: Array) -> None:
    """Supports, springs and foundations.

    A bar across a section whose angle is held, thick if it cannot stretch either; a triangle where the place alone is
    held; a wheel on a line along which it may move; zigzags and spirals for springs.
    """
    size, arc = _SIGN * problem.rod.length, problem.arc_length
    for support in problem.supports:
        index = vertex_at(support.at, arc)
        _draw_support(ax, support, x[index], D[index], size)
    for spring in problem.springs:
        _draw_spring(ax, spring, x[vertex_at(spring.at, arc)], size)
    for ground in problem.foundations:
        _draw_foundation(ax, ground, problem, x, size)


def draw_masses(ax: Axes, problem: RodProblem, x: Array, d: Array) -> None:
    """Each mass as a disc at its place, with the arm that carries it."""
    size, geometry = _SIGN * problem.rod.length, problem.geometry
    for mass in problem.masses:
        index = vertex_at(mass.at, geometry.arc_length)
        b3, b2 = d[index] / geometry.director_length[index]
        along, up = mass.offset
        centre = x[index] + along * np.array([b2, -b3]) + up * np.array([b3, b2])
        ax.plot(*np.stack([x[index], centre]).T, color=INK, linewidth=1.2, zorder=4)
        _fill(ax, centre + size * _circle(24), INK)


def _draw_support(ax: Axes, support: Support, x: Array, D: Array, size: float) -> None:
    held = support.holds(D)
    place = [direction for vector, direction in held if vector == "x"]
    section = sum(vector == "d" for vector, _ in held)
    if section:
        bar = np.stack([x - 1.7 * D, x + 1.7 * D])
        ax.plot(*bar.T, color=INK, linewidth=1.2 * section**1.33, solid_capstyle="butt", zorder=4)
    if len(place) == 2 and not section:
        _fill(ax, x + size * np.array([[0, 0], [-1, -1.8], [1, -1.8]]), PAPER)
        _ground(ax, x - [0, 1.8 * size], np.array([0.0, 1.0]), size)
    if len(place) == 1:
        normal = place[0] * (1 if place[0] @ [1e-6, 1] > 0 else -1)
        _fill(ax, x - size * normal + size * _circle(24), PAPER)
        _ground(ax, x - 2 * size * normal, normal, size)


def _draw_spring(ax: Axes, spring: Spring, x: Array, size: float) -> None:
    if spring.along is not None:
        _draw_zigzag(ax, x, -unit_vector(spring.along), size)
    if spring.rotational_stiffness:
        turn = np.linspace(0, 5 * np.pi, 80)
        spiral = x + (1.55 * size * turn / turn[-1])[:, None] * np.column_stack(
            [np.cos(turn), np.sin(turn)]
        )
        ax.plot(*spiral.T, color=EXACT, linewidth=1.2, zorder=4)


def _draw_foundation(ax: Axes, ground: Foundation, problem: RodProblem, x: Array, size: float) -> None:
    """A row of springs, or of dots where the foundation only resists rotation."""
    start, end = ground.start, ground.end_on(problem.rod)
    places = np.linspace(start, end, max(2, round(_SPRINGS * (end - start) / problem.rod.length)))
    feet = np.column_stack([np.interp(places, problem.arc_length, x[:, k]) for k in (0, 1)])
    if ground.along is None:
        ax.plot(*feet.T, color=EXACT, linestyle="none", marker="o", markersize=3, zorder=4)
        return
    for foot in feet:
        _draw_zigzag(ax, foot, -unit_vector(ground.along), 0.6 * size)


def _draw_zigzag(ax: Axes, x: Array, along: Array, size: float) -> None:
    """A spring from a point to the ground."""
    points = x + 0.8 * size * _ZIGZAG @ np.stack([along, [-along[1], along[0]]])
    ax.plot(*points.T, color=EXACT, linewidth=1.1, zorder=4)
    _ground(ax, points[-1], -along, size)


def _ground(ax: Axes, x: Array, normal: Array, size: float) -> None:
    """A line with hatches below it."""
    along = np.array([normal[1], -normal[0]])
    ends = x + 1.3 * size * np.outer([-1, 1], along)
    ax.plot(*ends.T, color=INK, linewidth=1.2, zorder=4)
    for foot in x + 1.3 * size * np.outer(np.linspace(-1, 1, 5), along):
        hatch = np.stack([foot, foot - 0.5 * size * (normal + along)])
        ax.plot(*hatch.T, color=INK, linewidth=0.7, zorder=4)


def _fill(ax: Axes, points: Array, colour: str) -> None:
    ax.fill(*points.T, facecolor=colour, edgecolor=INK, linewidth=1.0, zorder=5)


def _circle(count: int) -> Array:
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return np.column_stack([np.cos(angle), np.sin(angle)])
