"""Animations of crawls: the body on the ground, where advancing loads act, and the anchor."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.animation import FuncAnimation
from matplotlib.artist import Artist
from matplotlib.collections import PolyCollection
from numpy.typing import NDArray

from cosserat.figures.animated import FRAMES
from cosserat.figures.crawlers import ANCHOR, THINNED, legend_of_bodies, resting_radius, runs
from cosserat.figures.style import BODY, INK, canvas, title_of

Array = NDArray[np.float64]
_INTERVAL = 80  # from one frame to the next [ms]


def animate(data: xr.Dataset, frames: int = FRAMES) -> FuncAnimation:
    """A crawl seen from the side, with the time in the title; lengths are true to scale, in cm.

    frames : most instants shown, at equal distances.
    """
    radius, count = 1e2 * resting_radius(data), data.sizes["time"]
    chosen = np.unique(np.linspace(0, count - 1, min(count, frames)).round().astype(int))
    along, top = 1e2 * data.along.to_numpy(), 2 * radius * data.mu_1.to_numpy()
    thin, foot = data.advancing.to_numpy() > 0.5, 1e2 * data.anchor_along.to_numpy()
    margin = float(np.max(radius))
    limits = (along.min() - 2 * margin, along.max() + 2 * margin), (-margin, top.max() + margin)
    flat = (limits[1][1] - limits[1][0]) / (limits[0][1] - limits[0][0])
    figure, (ax,) = canvas(7.2, 1.3 + 6.3 * flat)
    body, advancing = (PolyCollection([], facecolor=colour, edgecolor=INK) for colour in (BODY, THINNED))
    for part in (body, advancing):
        part.set_linewidth(0.8)
        ax.add_collection(part)
    (anchor,) = ax.plot([], [], marker="^", color=ANCHOR, clip_on=False)
    ax.axhline(0, color=INK, linewidth=0.8)
    ax.set_aspect("equal")
    ax.set(xlim=limits[0], ylim=limits[1], xlabel="along the ground [cm]", ylabel="height [cm]")
    ax.grid(visible=False)
    figure.legend(handles=legend_of_bodies(), loc="outside lower center", ncols=3)

    def draw(frame: int) -> list[Artist]:
        body.set_verts([_outline(along[frame], top[frame])])
        advancing.set_verts([_outline(along[frame][run], top[frame][run]) for run in runs(thin[frame])])
        anchor.set_data([foot[frame]], [0.0])
        ax.set_title(f"{title_of(data)}, t = {data.time.to_numpy()[frame]:.2f} s")
        return [body, advancing, anchor]

    return FuncAnimation(figure, draw, frames=chosen.tolist(), interval=_INTERVAL)


def _outline(along: Array, top: Array) -> Array:
    """The outline of a part of the body from the side, shape (2 sections, 2)."""
    return np.column_stack([np.r_[along, along[::-1]], np.r_[top, np.zeros_like(top)]])
