"""Crawlers as bodies on the ground: the side view of Figs. 2.1, 2.7 and 2.9."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures.style import BODY, COMPUTED, FOURTH, INK, VARIANT, canvas, title_of
from cosserat.problems.crawl import Crawl
from cosserat.problems.crawler import CrawlerProblem

Array = NDArray[np.float64]

THINNED = "#f3d3a8"  # where advancing loads act
RELAXED = "#eeeeee"  # where no load acts, if that is told apart
GAMMA, ETA, ANCHOR = FOURTH, COMPUTED, "#c1121f"  # purple, blue and red
FRONTS = {"gamma": GAMMA, "eta": ETA}
STRETCHES = {"mu_1": COMPUTED, "mu_2": GAMMA, "mu_3": VARIANT}
WIDTHS = {"mu_1": 2.4, "mu_2": 1.0, "mu_3": 1.4}  # mu_2 lies on mu_1 apart from the weight


def draw_crawler(
    ax: Axes,
    state: xr.Dataset,
    radius: float | Array,
    *,
    base: float = 0.0,
    mark: float | None = None,
    tall: float = 1.0,
    lines: int = 50,
) -> None:
    """The lateral surface of one instant from the side, the ground at `base`, in cm.

    radius : of the resting sections [m].  mark : fraction of the length at which a section is marked in black.
    tall : magnification of heights.  lines : drawn sections.
    """
    along = state.along.to_numpy() * 1e2
    # the sections touch the ground, (2.2.16)
    top = 2 * tall * radius * state.mu_1.to_numpy() * 1e2 + base
    thin = state.advancing.to_numpy() > 0.5
    ax.fill_between(along, base, top, color=BODY, linewidth=0)
    for run in runs(thin):
        ax.fill_between(along[run], base, top[run], color=THINNED, linewidth=0)
    if "muscle_pressure" in state:
        for run in runs((state.muscle_pressure == 0).to_numpy() & (state.muscle_force == 0).to_numpy()):
            ax.fill_between(along[run], base, top[run], color=RELAXED, linewidth=0)
    outline = (np.r_[along, along[::-1]], np.r_[top, np.full_like(top, base)])
    ax.fill(*outline, facecolor="none", edgecolor=INK, linewidth=0.8)
    for k in range(0, along.size, max(1, along.size // lines)):
        ax.plot([along[k]] * 2, [base, top[k]], color=INK, linewidth=0.25)
    if mark is not None:
        k = round(mark * (along.size - 1))
        ax.fill_between(along[k - 1 : k + 2], base, top[k - 1 : k + 2], color="black", linewidth=0)
    if "anchor_along" in state:
        foot = float(state.anchor_along) * 1e2
        ax.plot([foot], [base], marker="^", color=ANCHOR, markersize=6, clip_on=False, zorder=5)


def draw_snapshots(
    ax: Axes,
    data: xr.Dataset,
    indices: list[int],
    labels: list[str],
    *,
    mark: float | None = None,
    tall: float = 1.0,
    above: bool = False,
    lines: int = 50,
) -> None:
    """Instants of a crawl below each other, each in its lane with its label at the left or above, in cm."""
    radius, lane = resting_radius(data), lane_height(data, tall, above=above)
    for number, (index, label) in enumerate(zip(indices, labels, strict=True)):
        base = -lane * number
        draw_crawler(ax, data.isel(time=index), radius, base=base, mark=mark, tall=tall, lines=lines)
        ax.axhline(base, color=INK, linewidth=0.6)
        ax.annotate(
            label,
            (0, base + (0.755 * lane if above else 0)),
            xycoords=("axes fraction", "data"),
            xytext=(0, 0) if above else (-4, 4),
            textcoords="offset points",
            ha="left" if above else "right",
        )
    left, right = (1e2 * float(end) for end in (data.along[indices].min(), data.along[indices].max()))
    ax.set(xlabel="along the ground [cm]", yticks=[], xlim=(left - 0.5, right + 0.5))
    ax.set_ylim(-lane * (len(indices) - 1) - 0.25 * lane, 0.9 * lane)
    ax.set_aspect("equal")
    ax.grid(visible=False, axis="y")
    ax.spines["left"].set_visible(False)


def draw_fronts(ax: Axes, data: xr.Dataset, indices: list[int]) -> None:
    """The fronts on the body at instants drawn by `draw_snapshots`: a line across it, its letter above."""
    lane, height = lane_height(data), 2e2 * float(np.max(resting_radius(data)))
    for number, index in enumerate(indices):
        state = data.isel(time=index)
        for place, kind in fronts_on_the_body(problem_of(data, Crawl), float(state.time)):
            at = 1e2 * float(np.interp(place, np.linspace(0, 1, state.sizes["section"]), state.along))
            base, colour = -lane * number, FRONTS[kind]
            ax.plot([at, at], [base, base + 1.08 * height], color=colour, linewidth=2.2)
            ax.annotate(
                rf"$\{kind}$",
                (at, base + 1.08 * height),
                xytext=(0, 3),
                textcoords="offset points",
                color=colour,
                ha="center",
                va="bottom",
            )


def fronts_on_the_body(problem: Crawl, time: float) -> list[tuple[float, str]]:
    """Places, as fractions of the length, and kinds of the fronts at a time [s]; a front at an end has left."""
    gait = problem.gait
    fraction = time / gait.duration - min(int(time / gait.duration + 1e-9), problem.strides - 1)
    starts = np.concatenate([[0.0], np.cumsum(gait.phases)])
    phase = float(np.interp(fraction * gait.duration, starts, np.arange(starts.size)))
    near = gait.clearance
    return [front for front in gait.fronts(phase) if near < front[0] < 1 - near]


def lane_height(data: xr.Dataset, tall: float = 1.0, *, above: bool = False) -> float:
    """Height of a crawler in a row of snapshots, in cm, with room for labels above if they are there."""
    return 2e2 * tall * float(np.max(resting_radius(data))) * (1.7 if above else 1.4)


def resting_radius(data: xr.Dataset) -> float | Array:
    """Radius of the resting sections [m]: one, or an array if the body varies."""
    if "resting_radius" in data:
        return np.asarray(data.resting_radius)
    return problem_of(data, CrawlerProblem).crawler.radius


def legend_of_bodies() -> list[Artist]:
    """Legend of the colours and the triangle of a drawn crawler."""
    return [
        Patch(facecolor=BODY, label="anchoring load"),
        Patch(facecolor=THINNED, label="advancing load"),
        Line2D([], [], color=ANCHOR, marker="^", linestyle="none", label="anchor"),
    ]


def nearest(data: xr.Dataset, time: float) -> int:
    """Index of the stored instant nearest to a time [s]."""
    return int(np.abs(data.time.to_numpy() - time).argmin())


def picture(data: xr.Dataset) -> Figure:
    """The picture of `cosserat plot` for a crawler: body, stretches and, for a crawl, its path."""
    loads = [name for name in MUSCLES if "time" in data.sizes and name in data and data[name].any()]
    figure, (body, curves, path, *below) = canvas(7.2, 6.4 + 2.1 * len(loads), 3 + len(loads), 1)
    for name, ax in zip(loads, below, strict=True):
        draw_loads(ax, data, name)
    last = data.isel(time=-1) if "time" in data.sizes else data
    draw_crawler(body, last, resting_radius(data))
    body.set_aspect("equal", adjustable="datalim")
    body.set(xlabel="along the ground [cm]", ylabel="height [cm]", title=title_of(data))
    for name, colour in STRETCHES.items():
        curves.plot(data.xi_section * 1e2, last[name], color=colour, label=rf"$\{name}$")
    curves.set(xlabel=r"arc length $\xi$ [cm]", ylabel="stretch [1]")
    curves.legend(ncols=3)
    if "time" not in data.sizes:
        path.plot(data.xi_section * 1e2, data.height * 1e3, color=COMPUTED)
        path.set(xlabel=r"arc length $\xi$ [cm]", ylabel="height of the centreline [mm]")
        return figure
    for section, label in ((0, "rear end"), (-1, "front end")):
        path.plot(data.time, data.along.isel(section=section) * 1e2, label=label)
    path.plot(data.time, data.anchor_along * 1e2, ".", color=ANCHOR, markersize=2, label="anchor")
    path.set(xlabel="time [s]", ylabel="along the ground [cm]")
    path.legend(ncols=3)
    return figure


MUSCLES = {
    "muscle_force": ("force of the muscles [N]", 1.0),
    "muscle_pressure": ("pressure [kPa]", 1e-3),
}
"""Loads that a crawl stores if they differ from chamber to chamber or in time, with labels and factors of units."""


def draw_loads(ax: Axes, data: xr.Dataset, name: str) -> None:
    """A load of `MUSCLES` along the body in time."""
    label, factor = MUSCLES[name]
    values = factor * data[name].to_numpy().T
    image = ax.pcolormesh(data.time, 1e2 * data.xi_section, values, cmap="viridis", rasterized=True)
    ax.figure.colorbar(image, ax=ax, label=label)
    ax.set(xlabel="time [s]", ylabel=r"$\xi$ [cm]")


def runs(flags: NDArray[np.bool_]) -> list[slice]:
    """Slices of set flags, each extended by one section so that neighbours meet."""
    edges = np.flatnonzero(np.diff(np.r_[False, flags, False].astype(int)))
    return [
        slice(int(a), int(min(b + 1, flags.size))) for a, b in zip(edges[::2], edges[1::2], strict=True)
    ]
