"""Pictures of a static rod: its body, and its displacement and strains."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures.style import (
    ALONG_E2,
    ALONG_E3,
    BODY,
    COMPUTED,
    EXACT,
    INK,
    VARIANT,
    canvas,
    title_of,
)
from cosserat.figures.supports import draw_masses, draw_supports
from cosserat.rods.loads.dead import LineLoad, PointForce
from cosserat.rods.loads.following import FollowerForce, FollowerLineLoad
from cosserat.rods.loads.load import Load
from cosserat.rods.loads.pressure import Pressure
from cosserat.rods.naming import unit_vector
from cosserat.rods.places import Located, located
from cosserat.rods.problem import RodProblem

Array = NDArray[np.float64]

_SHOWN = 0.1  # largest displacement in a picture, as a fraction of the rod's length
_ARROW = 0.14  # length of an arrow, as a fraction of the rod's length


def picture(data: xr.Dataset) -> Figure:
    """The body with its displacement magnified, and displacement, strains, forces and moment along it."""
    figure, axes = canvas(7.2, 9.4, 4, 2)
    grid = axes[0].get_gridspec()
    assert grid is not None
    axes[0].remove()
    axes[1].remove()
    top = figure.add_subplot(grid[0, :])
    magnified = magnification(data.u.to_numpy(), problem_of(data, RodProblem).rod.length)
    draw_body(top, data, magnified)
    top.set_aspect("equal", adjustable="datalim")
    top.set_title(f"{title_of(data)}, displacements × {magnified:g}")
    top.set(xlabel=ALONG_E3, ylabel=ALONG_E2)
    curves = [
        (data.u.sel(axis="E3"), "displacement along E3 [m]"),
        (data.u.sel(axis="E2"), "displacement along E2 [m]"),
        (data.lam - 1, r"section strain $\lambda - 1$ [1]"),
        (data.theta if "theta" in data else data.shear, "shear angle [rad]"),
        (data.bending_moment, "bending moment [N m]"),
    ]
    for ax, (values, label) in zip([*axes[2:6], axes[7]], curves, strict=True):
        ax.plot(data.xi if "vertex" in values.dims else data.xi_edge, values, color=COMPUTED, marker=".")
        ax.set(xlabel=r"arc length $\xi$ [m]", ylabel=label)
    for values, colour, label in (
        (data.normal_force, COMPUTED, "normal"),
        (data.shear_force, VARIANT, "shear"),
    ):
        axes[6].plot(data.xi_edge, values, color=colour, marker=".", label=label)
    axes[6].set(xlabel=r"arc length $\xi$ [m]", ylabel="force across the section [N]")
    axes[6].legend()
    return figure


def magnification(displacement: Array, length: float) -> float:
    """Magnification of displacements in a picture: one digit, at least 1."""
    largest = float(np.abs(displacement).max())
    return max(1.0, float(f"{_SHOWN * length / largest:.0e}")) if largest > 0 else 1.0


def draw_body(ax: Axes, data: xr.Dataset, magnified: float) -> None:
    """The body of the rod with its supports and loads; the directors reach the upper surface."""
    problem = problem_of(data, RodProblem)
    X, D = data.x_ref.to_numpy(), data.d_ref.to_numpy()
    x, d = X + magnified * data.u.to_numpy(), D + magnified * data.delta.to_numpy()
    draw_outline(ax, X, D, problem, facecolor="none", edgecolor=EXACT, linestyle=":")
    draw_outline(ax, x, d, problem, facecolor=BODY, edgecolor=COMPUTED)
    ax.quiver(
        *x.T, *d.T, angles="xy", scale_units="xy", scale=1, color=COMPUTED, width=0.003, headwidth=5
    )
    ax.plot(*x.T, color=INK, linestyle="--", linewidth=0.9)
    draw_supports(ax, problem, x, D)
    draw_masses(ax, problem, x, d)
    draw_loads(ax, problem, x, d)


def outline(x: Array, d: Array, problem: RodProblem) -> Array:
    """Both lateral surfaces and both ends as one closed curve, shape (..., 2 N, 2), of x and d of shape (..., N, 2)."""
    fraction = problem.rod.centreline
    return np.concatenate([x + d, (x - fraction / (1 - fraction) * d)[..., ::-1, :]], axis=-2)


def draw_outline(ax: Axes, x: Array, d: Array, problem: RodProblem, **colours: Any) -> None:
    """The body between its lateral surfaces."""
    ax.fill(*outline(x, d, problem).T, linewidth=0.9, **colours)


def draw_loads(ax: Axes, problem: RodProblem, x: Array, d: Array, time: float | None = None) -> None:
    """Gravity beside the rod, forces and couples at their places, loads over a stretch as rows of arrows.

    time : of a motion [s]; a load whose factor is zero then is left out.
    """
    size = _ARROW * problem.rod.length
    top = float(outline(x, d, problem)[:, 1].max())
    if problem.gravity is not None and (g := problem.gravity.g * _factor(problem.gravity, time)):
        along = np.sign(g) * unit_vector(problem.gravity.along)
        beside = np.array([(x[0, 0] + x[-1, 0]) / 2, top + 0.8 * size])
        _draw_arrow(ax, beside - along * size / 2, along * size, "$g$")
    forces: tuple[PointForce | FollowerForce, ...] = (*problem.forces, *problem.follower_forces)
    for force in forces:
        if force.force and (sign := np.sign(force.force * _factor(force, time))):
            place = located(force.at, problem.arc_length)
            along = sign * unit_vector(force.along)
            if isinstance(force, FollowerForce):
                along = _turned(problem, d, np.array([place.index + place.share]), along)[0]
            _draw_arrow(ax, _foot(x, place, along, size), along * size, "$n$")
    _draw_stretches(ax, problem, x, d, size / 2, time)
    for couple in problem.couples:
        if moment := couple.moment * _factor(couple, time):
            place = located(couple.at, problem.arc_length)
            _draw_turn(ax, point_at(x, place), size / 2, moment > 0)


def _draw_stretches(
    ax: Axes, problem: RodProblem, x: Array, d: Array, size: float, time: float | None
) -> None:
    """Line loads, and pressures on their surface, as rows of arrows."""
    loads: tuple[LineLoad | FollowerLineLoad | Pressure, ...]
    loads = (*problem.line_loads, *problem.follower_line_loads, *problem.pressures)
    for load in loads:
        amount = load.pressure if isinstance(load, Pressure) else load.density
        if not (sign := np.sign(amount * _factor(load, time))):
            continue
        parts = np.arange(x.shape[0])
        places = np.interp(np.linspace(*load.ends(problem.rod), 9), problem.arc_length, parts)
        if isinstance(load, Pressure):
            arrows = sign * (-1 if load.side == "upper" else 1) * _unit(_between(d, places))
            _draw_row(ax, x, d, places, arrows * size, inwards=bool(sign > 0))
            continue
        along = sign * unit_vector(load.along)
        follows = isinstance(load, FollowerLineLoad)
        arrows = _turned(problem, d, places, along) if follows else np.tile(along, (places.size, 1))
        _draw_row(ax, x, d, places, arrows * size)


def _factor(load: Load, time: float | None) -> float:
    """The factor of a load at a time; one without a time or a function of it."""
    if time is None or load.time_function is None:
        return 1.0
    return float(load.time_function.value(np.array([time]))[0])


def _turned(problem: RodProblem, d: Array, places: Array, along: Array) -> Array:
    """A direction (2,) of the reference, turned with the sections at places given in vertices, (n, 2)."""
    old, new = (_unit(_between(v, places)) for v in (problem.geometry.D, d))
    cosine = np.einsum("ij,ij->i", old, new)
    sine = old[:, 0] * new[:, 1] - old[:, 1] * new[:, 0]
    return np.column_stack([cosine * along[0] - sine * along[1], sine * along[0] + cosine * along[1]])


def _between(v: Array, places: Array) -> Array:
    """Vectors (N, 2) of the vertices at places given in vertices, (n, 2)."""
    at = np.arange(v.shape[0])
    return np.column_stack([np.interp(places, at, v[:, k]) for k in (0, 1)])


def _unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v, axis=1, keepdims=True))


def point_at(x: Array, place: Located) -> Array:
    """The point at a place of the centreline x (N, 2), shape (2,)."""
    return np.asarray(sum(weight * x[vertex] for vertex, weight in place.weights))


def _foot(x: Array, place: Located, along: Array, size: float) -> Array:
    """Start of the arrow of a force: at its place, or outside an end that it compresses."""
    outward = {0: x[0] - x[1], x.shape[0] - 1: x[-1] - x[-2]}.get(place.index, np.zeros(2))
    pressed = place.share == 0 and outward @ along < -0.5 * np.linalg.norm(outward)
    return point_at(x, place) - along * size * pressed


def _draw_row(
    ax: Axes, x: Array, d: Array, places: Array, arrows: Array, *, inwards: bool = True
) -> None:
    """Arrows (n, 2) that end on the body, or begin there, at places given in vertices, and the line along them."""
    centre, reach = _between(x, places), _between(d, places)
    across = np.abs(np.einsum("ij,ij->i", reach, arrows)) / np.einsum("ij,ij->i", arrows, arrows)
    feet = centre - (1 + across)[:, None] * arrows if inwards else centre + across[:, None] * arrows
    for foot, arrow in zip(feet, arrows, strict=True):
        _draw_arrow(ax, foot, arrow)
    ax.plot(*(feet if inwards else feet + arrows).T, color=VARIANT, linewidth=0.9)


def _draw_turn(ax: Axes, centre: Array, radius: float, counterclockwise: bool) -> None:
    """Most of a circle with an arrowhead: a couple, positive from E3 towards E2."""
    angles = np.linspace(-2.2, 2.2, 40) * (1 if counterclockwise else -1)
    circle = centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    ax.plot(*circle.T, color=VARIANT, linewidth=1.4)
    _draw_arrow(ax, circle[-2], circle[-1] - circle[-2])
    _label(ax, centre + np.array([radius, 0.0]), "$M$")


def _draw_arrow(ax: Axes, foot: Array, arrow: Array, label: str = "") -> None:
    style = {
        "arrowstyle": "-|>",
        "color": VARIANT,
        "linewidth": 1.4,
        "shrinkA": 0,
        "shrinkB": 0,
        "mutation_scale": 11,
    }
    ax.annotate("", tuple(foot + arrow), tuple(foot), arrowprops=style, zorder=5)
    ax.update_datalim([foot, foot + arrow])  # an annotation does not extend the limits
    ax.autoscale_view()
    if label:
        _label(ax, foot + 0.7 * arrow, label)


def _label(ax: Axes, place: Array, text: str) -> None:
    ax.annotate(text, tuple(place), xytext=(4, 4), textcoords="offset points", color=VARIANT)
