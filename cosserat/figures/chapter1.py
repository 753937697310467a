"""The directed rod of Chapter 1 as the body it stands for, drawn from a stored state of a crawler."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.figures.crawlers import crawler_of
from cosserat.figures.style import COMPUTED, EXACT, INK, VARIANT, settings

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]


def surface(state: xr.Dataset, radius: float, around: Array) -> Array:
    """Points r + X^alpha d_alpha of the lateral surface, eq. (1.3.4), shape (sections, len(around), 3) [m].

    around : angles at which the section's boundary X^1 = R cos, X^2 = R sin is taken.
    """
    r = np.column_stack([state.height, np.zeros(state.sizes["section"]), state.along])
    d_1 = state.mu_1.to_numpy()[:, None] * np.array([1.0, 0, 0])
    d_2 = state.mu_2.to_numpy()[:, None] * np.array([0, 1.0, 0])
    x_1, x_2 = radius * np.cos(around), radius * np.sin(around)
    points: Array = r[:, None] + x_1[:, None] * d_1[:, None] + x_2[:, None] * d_2[:, None]
    return points


def fig_directed_rod(data: Data) -> Figure:
    """The soft robot while its front half is thin: its surface, its centreline and some directors."""
    run = data["soft_robot"]
    state = run.isel(time=int(np.abs(run.time.to_numpy() - 10.0).argmin()))
    state = state.isel(section=slice(None, None, 5))
    radius = crawler_of(run).crawler.radius
    with settings():
        figure = Figure(figsize=(7.2, 3.4))
        ax: Any = figure.add_axes(
            (0.0, 0.0, 1.0, 1.0), projection="3d"
        )  # its methods are those of Axes3D
    skin = surface(state, radius, np.linspace(0, 2 * np.pi, 49)) * 1e2
    for k in range(0, skin.shape[0], 2):
        ax.plot(skin[k, :, 2], skin[k, :, 1], skin[k, :, 0], color=COMPUTED, linewidth=0.6, alpha=0.7)
    for j in range(0, 48, 6):
        ax.plot(skin[:, j, 2], skin[:, j, 1], skin[:, j, 0], color=EXACT, linewidth=0.5)
    axis = np.column_stack([state.along, 0 * state.along, state.height]) * 1e2
    ax.plot(*axis.T, color=INK, linewidth=1.5)
    for k in range(2, axis.shape[0], 8):
        for number, (mu, along) in enumerate(
            ((state.mu_1[k], (0, 0, 1)), (state.mu_2[k], (0, 1, 0))), start=1
        ):
            tip = float(mu) * radius * 1e2 * np.array(along)
            ax.quiver(*axis[k], *tip, color=VARIANT, linewidth=1.2, arrow_length_ratio=0.2)
            if k == 10:
                ax.text(*(axis[k] + 1.25 * tip), rf"$R\,\mathbf{{d}}_{number}$", color=VARIANT)
    ax.text(*(axis[-1] + np.array([0.6, 0, -0.3])), r"$\mathbf{r}$", color=INK)
    ax.set_box_aspect((np.ptp(skin[..., 2]), np.ptp(skin[..., 1]), np.ptp(skin[..., 0])), zoom=2.3)
    ax.set_axis_off()
    ax.view_init(elev=20, azim=-62)
    return figure
