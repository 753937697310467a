"""A worm whose muscles act in five regions: plateaus and layers."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cosserat.data.dataset import case_of, problem_of
from cosserat.figures import crawlers
from cosserat.figures.style import INK, PAPER
from cosserat.problems.crawl import Crawl, Posture
from cosserat.runner import run

Data = Mapping[str, xr.Dataset]

FIVE = ("anchoring", "advancing", "anchoring", "advancing", "anchoring")
"""Loads of the regions from the rear end to the front end, each a fifth of the body."""
_SECTIONS = 1001  # the layers of the picture are smooth
_TALL = 3.0  # magnification of heights
_GROUND = {"facecolor": PAPER, "edgecolor": "none", "pad": 1.0}  # of a name beside its arrow


def fig_five_regions(data: Data) -> Figure:
    """The body from the side, its stretches along it, and one layer in radii of the body."""
    muscles, ends = problem_of(data["worm"], Crawl).loads, np.linspace(0, 1, len(FIVE) + 1)
    regions = [
        {"begin": begin, "end": end, "load": load}
        for begin, end, load in zip(ends[:-1], ends[1:], FIVE, strict=True)
    ]
    loads = {"anchoring": muscles.anchoring, "advancing": muscles.advancing}
    worm = case_of(data["worm_at_rest"])
    state = run(worm.vary("five_regions", loads=loads, regions=regions, sections=_SECTIONS))
    posture = problem_of(state, Posture)
    figure = Figure(figsize=(5.0, 6.0), layout="constrained")
    body, curves, layer = figure.subplots(3, 1, height_ratios=[0.5, 1, 1])
    crawlers.draw_crawler(body, state, posture.crawler.radius, tall=_TALL)
    body.set(aspect="equal", yticks=[], xlabel="along the ground [cm]")
    body.set_title(f"(a) the body from the side, heights × {_TALL:g}")
    body.grid(visible=False)
    body.spines["left"].set_visible(False)
    _stretches(curves, state)
    _layer(layer, state, posture)
    handles = [*crawlers.legend_of_bodies()[:2], *curves.get_lines()[: len(crawlers.STRETCHES)]]
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


def _stretches(ax: Axes, state: xr.Dataset) -> None:
    """The three stretches along the body at rest, a plateau and a layer named."""
    fraction = state.xi_section / state.xi_section[-1]
    for k, load in enumerate(FIVE):
        if load == "advancing":
            ax.axvspan(k / 5, (k + 1) / 5, color=crawlers.THINNED, alpha=0.4, linewidth=0)
    for name, colour in crawlers.STRETCHES.items():
        ax.plot(
            fraction, state[name], color=colour, linewidth=crawlers.WIDTHS[name], label=rf"$\{name}$"
        )
    top = float(state.mu_3.max())
    ax.annotate("plateau", (0.3, top + 0.08), ha="center", va="bottom")
    arrow = {"arrowstyle": "->", "color": INK}
    ax.annotate("layer", (0.2, 1.02), (0.1, top), ha="center", arrowprops=arrow, bbox=_GROUND)
    ax.set(
        xlabel=r"$\tilde z = \xi / \ell_0$ [1]",
        ylabel="stretch [1]",
        xlim=(0, 1),
        ylim=(None, top + 0.2),
        title="(b) five plateaus, four layers",
    )


def _layer(ax: Axes, state: xr.Dataset, posture: Posture) -> None:
    """The layer at the first junction, with lengths in radii of the resting body."""
    radius = posture.crawler.radius
    offset = ((state.xi_section - posture.regions[0].end * posture.crawler.length) / radius).to_numpy()
    near = np.abs(offset) <= 2
    for name, colour in crawlers.STRETCHES.items():
        ax.plot(offset[near], state[name][near], color=colour, linewidth=crawlers.WIDTHS[name])
    ax.axvspan(0, 2, color=crawlers.THINNED, alpha=0.4, linewidth=0)
    level = float(state.mu_3.max()) - 0.12
    decay = 1 / np.sqrt(8)
    ax.annotate("", (0, level), (decay, level), arrowprops={"arrowstyle": "<->", "color": INK})
    ax.annotate(
        r"$R/\sqrt{8}$",
        (decay, level),
        xytext=(6, 0),
        textcoords="offset points",
        va="center",
        bbox=_GROUND,
    )
    ax.set(
        xlabel=r"distance from the junction, over $R$ [1]",
        ylabel="stretch [1]",
        xlim=(-2, 2),
        title="(c) the first layer, over the radius of the body",
    )
