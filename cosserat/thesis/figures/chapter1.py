"""The directed rod of Chapter 1 as a body, drawn from a stored state of a crawler."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures.style import COMPUTED, EXACT, INK, PAPER, VARIANT, canvas
from cosserat.problems.crawl import CrawlerProblem

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_WHITE_BOX = {
    "facecolor": PAPER,
    "edgecolor": "none",
    "pad": 1.0,
}  # behind a label on the surface


def surface(state: xr.Dataset, radius: float, around: Array) -> Array:
    """Points r + X^alpha d_alpha of the lateral surface, eq. (1.3.4), shape (sections, len(around), 3) [m].

    around : angles of the points X^1 = R cos, X^2 = R sin on the section's boundary.
    """
    r = np.column_stack([state.height, np.zeros(state.sizes["section"]), state.along])
    d_1 = state.mu_1.to_numpy()[:, None] * np.array([1.0, 0, 0])
    d_2 = state.mu_2.to_numpy()[:, None] * np.array([0, 1.0, 0])
    x_1, x_2 = radius * np.cos(around), radius * np.sin(around)
    points: Array = r[:, None] + x_1[:, None] * d_1[:, None] + x_2[:, None] * d_2[:, None]
    return points


def fig_directed_rod(data: Data) -> Figure:
    """The soft robot while its front half is thin: its surface, its centreline and some directors, seen obliquely."""
    run = data["soft_robot"]
    state = run.isel(time=int(np.abs(run.time.to_numpy() - 10.0).argmin()))
    state = state.isel(section=slice(None, None, 5))
    radius = problem_of(run, CrawlerProblem).crawler.radius
    figure, (ax,) = canvas(7.2, 2.6)
    skin = _oblique(surface(state, radius, np.linspace(0, 2 * np.pi, 49)))
    for section in skin[::2]:
        ax.plot(*section.T, color=COMPUTED, linewidth=0.6, alpha=0.7)
    for j in range(0, 48, 6):
        ax.plot(*skin[:, j].T, color=EXACT, linewidth=0.5)
    along, height = state.along.to_numpy(), state.height.to_numpy()
    r = np.column_stack([height, 0 * height, along])
    ax.plot(*_oblique(r).T, color=INK, linewidth=1.5)
    for k in range(2, along.size, 8):
        for number, mu in ((1, state.mu_1), (2, state.mu_2)):
            tip = r[k] + float(mu[k]) * radius * np.eye(3)[number - 1]
            foot, head = _oblique(np.array([r[k], tip]))
            arrow = {"arrowstyle": "-|>", "color": VARIANT, "shrinkA": 0, "shrinkB": 0}
            ax.annotate("", tuple(head), tuple(foot), arrowprops=arrow)
            if k == 2:
                ax.annotate(
                    rf"$R\,\mathbf{{d}}_{number}$", tuple(head + 0.2), color=VARIANT, bbox=_WHITE_BOX
                )
    ax.annotate(r"$\mathbf{r}$", tuple(_oblique(r[-1:])[0] + [1.0, 0.0]), color=INK)
    ax.set_aspect("equal")
    ax.set(xlabel=r"along $\mathbf{E}_3$ [cm]", ylabel=r"along $\mathbf{E}_1$ [cm]")
    return figure


def _oblique(points: Array) -> Array:
    """Points (..., 3) on paper, in cm: E_3 to the right, E_1 up, E_2 obliquely away from the reader."""
    x, y, z = np.moveaxis(points * 1e2, -1, 0)
    return np.stack([z + 0.45 * y, x + 0.3 * y], axis=-1)
