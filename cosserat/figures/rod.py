"""A static rod as the body it stands for, and a page that shows any stored result."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.figures.style import BODY, COMPUTED, EXACT, INK, VARIANT, canvas
from cosserat.table.readouts import problem_of

Array = NDArray[np.float64]

_SHOWN = 0.1  # largest displacement in a picture, as a share of the rod's length


def picture(data: xr.Dataset) -> Figure:
    """The body with its displacement magnified, and displacement and strains along it."""
    figure, axes = canvas(7.2, 7.2, 3, 2)
    grid = axes[0].get_gridspec()
    assert grid is not None
    axes[0].remove()
    axes[1].remove()
    top = figure.add_subplot(grid[0, :])
    largest = float(np.abs(data.u).max())
    length = problem_of(data).rod.length
    magnified = max(1.0, float(f"{_SHOWN * length / largest:.0e}")) if largest > 0 else 1.0
    draw_body(top, data, magnified)
    top.set_aspect("equal", adjustable="datalim")
    top.set_title(f"{data.attrs['title']}, displacements × {magnified:g}")
    top.set(xlabel=r"along $\mathbf{E}_3$ [m]", ylabel=r"along $\mathbf{E}_2$ [m]")
    curves = [
        (data.u.sel(axis="E3"), "displacement along E3 [m]"),
        (data.u.sel(axis="E2"), "displacement along E2 [m]"),
        (data.lam - 1, r"section strain $\lambda - 1$ [1]"),
        (data.theta if "theta" in data else data.shear, "shear angle [rad]"),
    ]
    for ax, (values, label) in zip(axes[2:], curves, strict=True):
        ax.plot(data.xi if "vertex" in values.dims else data.xi_edge, values, color=COMPUTED, marker=".")
        ax.set(xlabel=r"arc length $\xi$ [m]", ylabel=label)
    return figure


def draw_body(ax: Axes, data: xr.Dataset, magnified: float) -> None:
    """The rod as the body it stands for, with its supports and loads; the directors reach the upper surface."""
    problem = problem_of(data)
    X, D = data.x_ref.to_numpy(), data.d_ref.to_numpy()
    x, d = X + magnified * data.u.to_numpy(), D + magnified * data.delta.to_numpy()
    below = _below(data)
    _draw_outline(ax, X, D, below, facecolor="none", edgecolor=EXACT, linestyle=":")
    _draw_outline(ax, x, d, below, facecolor=BODY, edgecolor=COMPUTED)
    ax.quiver(
        *x.T, *d.T, angles="xy", scale_units="xy", scale=1, color=COMPUTED, width=0.003, headwidth=5
    )
    ax.plot(*x.T, color=INK, linestyle="--", linewidth=0.9)
    for support in problem.supports:
        index = {"first": 0, "last": -1}[support.at] if isinstance(support.at, str) else support.at
        section = np.column_stack([x[index] - 1.7 * D[index], x[index] + 1.7 * D[index]])
        whole = {"d3", "d2"} <= set(support.hold)  # else the section may still stretch
        ax.plot(*section, color=INK, linewidth=3.0 if whole else 1.2, solid_capstyle="butt", zorder=4)
    if problem.gravity is not None:
        along = np.array([1.0, 0.0]) if problem.gravity.along == "E3" else np.array([0.0, -1.0])
        _draw_arrow(ax, np.array([2.5, 1.15]), along, "$g$")
    for force, foot in zip(problem.forces, (x[0], x[-1]), strict=False):
        _draw_arrow(ax, foot, np.array([1.0 if force.along == "E3" else -1.0, 0.0]), "$n$")


def _below(data: xr.Dataset) -> float:
    """How far the lower surface is from the centreline, in directors."""
    share = problem_of(data).rod.centreline
    return share / (1 - share)


def _draw_outline(ax: Axes, x: Array, d: Array, below: float, **colours: Any) -> None:
    ax.fill(*np.vstack([x + d, (x - below * d)[::-1]]).T, linewidth=0.9, **colours)


def _draw_arrow(ax: Axes, foot: Array, along: Array, label: str) -> None:
    arrow = {"arrowstyle": "-|>", "color": VARIANT, "linewidth": 1.4}
    ax.annotate("", tuple(foot + 0.7 * along), tuple(foot), arrowprops=arrow)
    ax.annotate(
        label, tuple(foot + 0.5 * along), xytext=(4, 4), textcoords="offset points", color=VARIANT
    )
