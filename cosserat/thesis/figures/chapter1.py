"""The directed rod of Chapter 1 as a body, drawn from a stored state of a crawler."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures.style import BODY, COMPUTED, INK, PAPER, VARIANT, WIDTH, beside, canvas
from cosserat.problems.crawler import CrawlerProblem

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_THICKNESS = 3.5  # magnification across the axis
_DRAWN = (0.12, 0.5, 0.88)  # places of the sections with directors, as fractions of the length
_GROUND = {"facecolor": PAPER, "edgecolor": "none", "alpha": 0.7, "pad": 0.5}  # behind a label


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
    """The soft robot while its front half is thin: its body, its centreline and three sections with their directors.

    Seen obliquely and magnified across the axis; the half of the surface that faces the reader is left out.
    """
    run = data["soft_robot"]
    state = run.isel(time=int(np.abs(run.time.to_numpy() - 10.0).argmin()))
    radius = problem_of(run, CrawlerProblem).crawler.radius
    figure, (ax,) = canvas(WIDTH, 4.0)
    around = np.linspace(0, 2 * np.pi, 73)
    skin = _oblique(surface(state, radius, around))
    _fill_body(ax, skin)
    r = np.column_stack([state.height, np.zeros(state.sizes["section"]), state.along])
    ax.plot(*_oblique(r).T, color=INK, linewidth=1.8, zorder=4)
    for place in _DRAWN:
        k = round(place * (r.shape[0] - 1))
        ax.fill(*skin[k].T, facecolor=PAPER, edgecolor=COMPUTED, linewidth=1.2, alpha=0.85, zorder=3)
        for number, mu, aside in ((1, state.mu_1, (0, 8)), (2, state.mu_2, (-2, -12))):
            tip = r[k] + float(mu[k]) * radius * np.eye(3)[number - 1]
            foot, head = _oblique(np.array([r[k], tip]))
            arrow = {"arrowstyle": "-|>", "color": VARIANT, "shrinkA": 0, "shrinkB": 0, "linewidth": 1.6}
            ax.annotate("", tuple(head), tuple(foot), arrowprops=arrow, zorder=5)
            name = rf"$R\,\mathbf{{d}}_{number}$"
            beside(
                ax, (head[0], head[1]), name, aside, color=VARIANT, ha="center", zorder=6, bbox=_GROUND
            )
    middle = _oblique(r[r.shape[0] // 4])
    beside(ax, (middle[0], middle[1]), r"$\mathbf{r}$", (6, -9), color=INK)
    ax.set_aspect("equal")
    ax.grid(visible=False)
    across = rf"along $\mathbf{{E}}_1$ [cm], × {_THICKNESS:g}"
    ax.set(xlabel=r"along $\mathbf{E}_3$ [cm]", ylabel=across)
    return figure


def _fill_body(ax: Axes, skin: Array) -> None:
    """What is seen of the body: between its outermost lines, with its rear section in front."""
    top, low = (skin[:, :, 1].argmax(axis=1), skin[:, :, 1].argmin(axis=1))
    lines = [skin[np.arange(skin.shape[0]), places] for places in (top, low)]
    ax.fill(*np.vstack([lines[0], lines[1][::-1]]).T, facecolor=BODY, edgecolor="none", zorder=1)
    for end in (0, -1):
        ax.fill(*skin[end].T, facecolor=BODY, edgecolor=COMPUTED, linewidth=1.2, zorder=1 if end else 2)
    for line in lines:
        ax.plot(*line.T, color=COMPUTED, linewidth=1.2, zorder=2)


def _oblique(points: Array) -> Array:
    """Points (..., 3) on paper, in cm: E_3 to the right, E_1 up, E_2 obliquely towards the reader, both magnified."""
    x, y, z = np.moveaxis(points * 1e2, -1, 0)
    return np.stack([z - _THICKNESS * 0.35 * y, _THICKNESS * (x - 0.25 * y)], axis=-1)
