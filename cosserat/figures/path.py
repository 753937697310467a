"""Paths of equilibria."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.figures.style import (
    ALONG_E2,
    ALONG_E3,
    COMPUTED,
    EARLIER,
    EXACT,
    INK,
    VARIANT,
    canvas,
    plain,
    title_of,
)

Array = NDArray[np.float64]


def picture(data: xr.Dataset) -> Figure:
    """The picture of `cosserat plot` for a path: shapes, and the load over the largest displacement."""
    figure, (left, right) = canvas(7.2, 3.4, 1, 2)
    draw_shapes(left, data)
    left.set_aspect("equal", adjustable="datalim")
    left.set(xlabel=ALONG_E3, ylabel=ALONG_E2, title=title_of(data))
    moved = np.linalg.norm(data.x.to_numpy() - data.x_ref.to_numpy(), axis=2).max(axis=1)
    draw_path(right, moved, data.load_factor.to_numpy(), data)
    draw_special(right, data)
    right.set(xlabel="largest displacement [m]", ylabel="load / full load [1]")
    right.locator_params(axis="x", nbins=5)
    right.legend()
    return figure


def draw_shapes(ax: Axes, run: xr.Dataset) -> None:
    """Draw the last shape, and every third one of a path before it."""
    x = run.x.to_numpy()
    ax.plot(*run.x_ref.to_numpy().T, color=EXACT, linestyle=":")
    if x.ndim == 2:
        ax.plot(*x.T, color=COMPUTED, marker=".")
        return
    for shape in x[1:-1:3]:
        ax.plot(*shape.T, color=EARLIER)
    ax.plot(*x[-1].T, color=COMPUTED, marker=".", markersize=3)


def draw_path(ax: Axes, across: Array, load: Array, run: xr.Dataset) -> None:
    """Draw a load over a displacement, stable points filled."""
    stable = run.stable.to_numpy() > 0.5
    ax.plot(across, load, color=INK, linewidth=0.8)
    ax.plot(across[stable], load[stable], "o", color=COMPUTED, label="stable")
    if not stable.all():
        ax.plot(
            across[~stable], load[~stable], "o", markerfacecolor="none", color=VARIANT, label="unstable"
        )
    ax.legend()


def draw_special(ax: Axes, run: xr.Dataset) -> None:
    """Mark limit points and bifurcations on the load over the largest displacement, each with its load."""
    if "special" not in run.sizes:
        return
    moved = np.linalg.norm(run.special_x.to_numpy() - run.x_ref.to_numpy(), axis=2).max(axis=1)
    for across, load, kind in zip(
        moved, run.special_load_factor.to_numpy(), run.special.to_numpy(), strict=True
    ):
        ax.plot(
            [across],
            [load],
            linestyle="none",
            marker="^" if "limit" in kind else "D",
            markersize=6,
            color=INK,
            zorder=5,
            label=f"{plain(kind)} at {load:.4g}",
        )
