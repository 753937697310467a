"""The first picture of the README and of the book: problems that the package solves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures.crawlers import ANCHOR, nearest
from cosserat.figures.rod import outline
from cosserat.figures.style import BODY, COMPUTED, EARLIER, EXACT, INK, WIDTH, Picture
from cosserat.problems.crawl import Crawl
from cosserat.rods.problem import RodProblem

Array = NDArray[np.float64]

_FRACTIONS = (0, 1 / 4, 1 / 2, 3 / 4)  # of the second stride
_HEIGHT_MAGNIFICATION = 3.0  # magnification of heights of the worm
_THICKNESS_MAGNIFICATION = 3.0  # magnification of the slender rods
_WORM_DISTANCE = 1.5  # from one worm to the next, in its own height at rest
_SECTIONS = 84  # of a drawn worm; every second one has a line
_COLOUR_LEVELS = 8  # of colour, from the thinnest section to the fattest
_COLOURS = LinearSegmentedColormap.from_list("sections", ["#eaa552", "#f6e8d3", "#9cc1e2"])
_E2_TO_THE_RIGHT = np.array([[0.0, 1.0], [1.0, 0.0]])  # E2 to the right, E3 up


def fig_opening(data: Mapping[str, xr.Dataset]) -> Figure:
    """A worm that crawls above a column that buckles, an arch that snaps and a rod that is thrown."""
    figure = Picture(figsize=(WIDTH, 8.0), layout="constrained")
    chord = data["arch_path"].x_ref.to_numpy()[-1]
    level = np.column_stack([chord, [chord[1], -chord[0]]]) / np.hypot(*chord)
    grid = figure.add_gridspec(3, 2, height_ratios=(1.75, 1, 1.05))
    places = (grid[1, 0], grid[1, 1], grid[2, :])
    _draw_worm(figure.add_subplot(grid[0, :]), data["worm"])
    for place, (name, title, shown, thick, turn) in zip(
        places,
        (
            (
                "column_path",
                "A column buckles",
                (0, 6, 8, 10, 12, 15),
                _THICKNESS_MAGNIFICATION,
                _E2_TO_THE_RIGHT,
            ),
            ("arch_path", "An arch snaps through", (0, 12, 20, 28, 35), _THICKNESS_MAGNIFICATION, level),
            ("tumbling", "A rod is thrown and tumbles", (0, 20, 40, 60, 80, 100), 1.0, _E2_TO_THE_RIGHT),
        ),
        strict=True,
    ):
        ax = figure.add_subplot(place)
        _draw_rods(ax, data[name], shown, thick, turn)
        ax.set_title(title)
    return figure


def _draw_worm(ax: Axes, run: xr.Dataset) -> None:
    """Four times of a stride below each other, heights magnified: sections by colour, and lines equidistant at rest."""
    problem = problem_of(run, Crawl)
    height = 2e2 * _HEIGHT_MAGNIFICATION * problem.crawler.radius
    least, most = float(run.mu_1.min()), float(run.mu_1.max())
    drawn = np.linspace(0, run.sizes["section"] - 1, _SECTIONS).round().astype(int)
    indices = [nearest(run, (1 + fraction) * problem.gait.duration) for fraction in _FRACTIONS]
    reach = 1e2 * run.along[indices]
    for number, index in enumerate(indices):
        state = run.isel(time=index, section=drawn)
        z, mu = 1e2 * state.along.to_numpy(), state.mu_1.to_numpy()
        base = -_WORM_DISTANCE * height * number
        top = base + height * mu
        levels = np.round(_COLOUR_LEVELS * (mu - least) / (most - least))
        for part in np.split(np.arange(z.size), np.flatnonzero(np.diff(levels)) + 1):
            strip = slice(part[0], part[-1] + 2)
            colour = _COLOURS(levels[part[0]] / _COLOUR_LEVELS)
            ax.fill_between(z[strip], base, top[strip], color=colour, linewidth=0.3)
        low = np.full_like(z, base)
        _draw_lines(ax, np.c_[z, low][::2], np.c_[z, top][::2], INK, 0.3)
        ax.plot(np.r_[z[0], z, z[-1]], np.r_[base, top, base], color=INK, linewidth=0.9)
        ax.annotate(
            f"{_FRACTIONS[number] * problem.gait.duration:.1f} s",
            (1, base),
            xycoords=("axes fraction", "data"),
            xytext=(0, 4),
            textcoords="offset points",
            ha="right",
        )
        ax.axhline(base, color=EXACT, linewidth=0.7, zorder=0)
        foot = float(state.anchor_along) * 1e2
        ax.plot([foot], [base], marker="^", color=ANCHOR, markersize=7, clip_on=False, zorder=5)
    ax.set(
        title="An earthworm crawls: thin sections grow long,\nfat ones grow short and hold on",
        xlabel=f"along the ground [cm], heights × {_HEIGHT_MAGNIFICATION:g}",
        yticks=[],
        xlim=(float(reach.min()) - 2, float(reach.max()) + 5),
        ylim=(-_WORM_DISTANCE * height * (len(_FRACTIONS) - 1) - 0.3 * height, 1.2 * height),
    )
    ax.set_aspect("equal")
    ax.grid(visible=False)
    ax.spines["left"].set_visible(False)
    ax.legend(
        handles=_legend(), loc="upper center", bbox_to_anchor=(0.5, -0.22), ncols=3, columnspacing=1.0
    )


def _legend() -> list[Artist]:
    return [
        Patch(facecolor=_COLOURS(0.0), label="thin and long"),
        Patch(facecolor=_COLOURS(1.0), label="fat and short"),
        Line2D([], [], color=ANCHOR, marker="^", linestyle="none", label="holds on here"),
    ]


def _draw_rods(ax: Axes, run: xr.Dataset, shown: Sequence[int], thick: float, turn: Array) -> None:
    """Some states of a path or a motion as bodies with their sections; the last one is dark."""
    problem = problem_of(run, RodProblem)
    for k in shown:
        x, d = run.x.to_numpy()[k] @ turn, thick * run.d.to_numpy()[k] @ turn
        last = k == shown[-1]
        colour = COMPUTED if last else EARLIER
        ax.fill(*outline(x, d, problem).T, facecolor=BODY, edgecolor=colour, linewidth=0.9)
        _draw_lines(ax, (x - d)[::2], (x + d)[::2], colour, 0.5)
    ax.set_aspect("equal", adjustable="datalim")
    ax.locator_params(nbins=3)
    ax.set(xlabel="[m]" if thick == 1 else f"[m], thickness × {thick:g}", ylabel="[m]")


def _draw_lines(ax: Axes, feet: Array, heads: Array, colour: str, width: float) -> None:
    """Lines from points to others, both of shape (n, 2), as one path."""
    ends = np.stack([feet, heads, np.full_like(feet, np.nan)], axis=1).reshape(-1, 2)
    ax.plot(*ends.T, color=colour, linewidth=width)
