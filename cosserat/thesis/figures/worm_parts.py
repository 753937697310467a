"""The parts of a crawling worm and of its gait, with their names, drawn from two instants of the stored worm."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cosserat.data.dataset import problem_of
from cosserat.figures import crawlers
from cosserat.figures.style import INK, PAPER, canvas
from cosserat.problems.crawl import Crawl
from cosserat.thesis.earthworm import SEGMENT_50

_TALL = 7.0  # magnification of heights
_LANE = 2.85  # from one worm to the next, in the height of a worm at rest
_LEFT, _RIGHT = 4.5, 42.5  # of the drawn ground [cm]
_SHORTEST_NAMED = 4.0  # part of the body with a name inside it [cm]
_SCENES = (
    (0.7, "(a) protrusion: the rear end holds,\nand the thin front part reaches forward"),
    (1.5, "(b) stance: the front end holds,\nand the rear part is pulled after it"),
)


def fig_worm_parts(data: Mapping[str, xr.Dataset]) -> Figure:
    """One worm in its protrusion and in its stance, with the names of regions, fronts, segments and the anchor."""
    run = data["worm"]
    problem = problem_of(run, Crawl)
    height = 2e2 * _TALL * problem.crawler.radius
    figure, (ax,) = canvas(5.0, 4.3)
    for number, (phase, title) in enumerate(_SCENES):
        state = run.isel(time=crawlers.nearest(run, problem.gait.time(phase)))
        base = -_LANE * height * number
        crawlers.draw_crawler(ax, state, problem.crawler.radius, base=base, mark=SEGMENT_50, tall=_TALL)
        ax.axhline(base, color=INK, linewidth=0.6, zorder=0)
        ax.annotate(title, (_LEFT, base + 1.75 * height), va="bottom")
        _name_fronts(ax, state, problem, base, height)
        _name_regions(ax, state, base + 0.45 * height)
        _name_anchor(ax, state, base)
    first = run.isel(time=crawlers.nearest(run, problem.gait.time(_SCENES[0][0])))
    _name_segments(ax, first, height)
    ax.set(
        xlabel=f"along the ground [cm], heights × {_TALL:g}",
        yticks=[],
        xlim=(_LEFT, _RIGHT),
        ylim=(-_LANE * height - 0.5 * height, 2.4 * height),
    )
    ax.set_aspect("equal")
    ax.grid(visible=False)
    ax.spines["left"].set_visible(False)
    return figure


def _name_fronts(ax: Axes, state: xr.Dataset, problem: Crawl, base: float, height: float) -> None:
    """A line across the body at each front, with its letter, and an arrow that shows where it travels."""
    places = np.linspace(0, 1, state.sizes["section"])
    top = base + 1.3 * height
    for place, kind in crawlers.fronts_on_the_body(problem, float(state.time)):
        colour = crawlers.FRONTS[kind]
        at = 1e2 * float(np.interp(place, places, state.along))
        ax.plot([at, at], [base, top], color=colour, linewidth=2.2)
        arrow = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0}
        ax.annotate("", (at - 1.8, top), (at, top), arrowprops=arrow)
        _name(ax, rf"front $\{kind}$", (at, top), (5, 0), colour, va="center")


def _name_regions(ax: Axes, state: xr.Dataset, middle: float) -> None:
    """The load of every part of the body, inside it."""
    along = 1e2 * state.along.to_numpy()
    advances = state.advancing.to_numpy() > 0.5
    box = {"facecolor": PAPER, "edgecolor": "none", "alpha": 0.85, "pad": 1.0}
    for name, flags in (("anchoring", ~advances), ("advancing", advances)):
        for part in crawlers.runs(flags):
            ends = along[part][[0, -1]]
            if np.ptp(ends) > _SHORTEST_NAMED:
                ax.annotate(name, (ends.mean(), middle), ha="center", va="center", bbox=box)


def _name_anchor(ax: Axes, state: xr.Dataset, base: float) -> None:
    _name(ax, "anchor", (1e2 * float(state.anchor_along), base), (0, -7), crawlers.ANCHOR, va="top")


def _name_segments(ax: Axes, state: xr.Dataset, height: float) -> None:
    """Both ends and segment 50 of the upper worm, and its direction; segments are counted from the front end."""
    along = 1e2 * state.along.to_numpy()
    marked = along[round(SEGMENT_50 * (along.size - 1))]
    _name(ax, "segment 50", (marked, 0), (0, -7), INK, ha="center", va="top")
    _name(ax, r"rear end, $\xi = 0$", (along[0], height), (-2, 10), INK, va="bottom")
    _name(ax, "front end, $\\xi = \\ell_0$,\nsegment 1", (along[-1], height / 2), (8, 0), INK)
    arrow = {"arrowstyle": "-|>", "color": INK, "shrinkA": 0, "shrinkB": 0}
    foot = (along[-1] + 1.2, 1.1 * height)
    ax.annotate("", (foot[0] + 6, foot[1]), foot, arrowprops=arrow)
    _name(ax, "crawls this way", foot, (0, 5), INK, va="bottom")


def _name(
    ax: Axes,
    text: str,
    place: tuple[float, float],
    aside: tuple[float, float],
    colour: str,
    ha: str = "left",
    va: str = "center",
) -> None:
    """A text beside a place of the data, offset in points."""
    ax.annotate(text, place, aside, textcoords="offset points", color=colour, ha=ha, va=va)
