"""Figures of Chapter 2: muscles, gaits, and their effect on a robot and a worm."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import NullFormatter
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures import crawlers
from cosserat.figures.style import COMPUTED, EXACT, FOURTH, INK, VARIANT, WIDTH, beside, canvas
from cosserat.peristalsis import doublets
from cosserat.problems.crawl import Crawl
from cosserat.thesis.earthworm import LONGITUDINAL, SEGMENT_50
from cosserat.thesis.table.crawl_readouts import (
    SLOPES,
    at_phase,
    segment,
    slope,
)

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_HEIGHT_MAGNIFICATION = 4.0  # magnification of heights in Fig. 2.1
_STANCE = "#efefef"  # ground of the time in which a worm pulls its rear part forward


def fig_2_1(data: Data) -> Figure:
    """One stride of the worm at six times, segment 50 in black; dotted, by the printed equations."""
    run, printed = data["worm"], data["worm_printed"]
    phases = [0, 1 / 3, 2 / 3, 1, 1.5, 2]
    names = ("0", "t_p/3", "2t_p/3", "t_p", "t_p + t_s/2", "t_p + t_s")
    gait = problem_of(run, Crawl).gait
    indices = [crawlers.nearest(run, gait.time(p)) for p in phases]
    labels = [
        f"$t_{k} = {name}$" + (f" = {gait.time(p):.2f} s" if p else " s")
        for k, (p, name) in enumerate(zip(phases, names, strict=True), start=1)
    ]
    figure, (ax,) = canvas(WIDTH, 6.1)
    tall = _HEIGHT_MAGNIFICATION
    crawlers.draw_snapshots(ax, run, indices, labels, mark=SEGMENT_50, tall=tall, above=True)
    lane = crawlers.lane_height(run, tall, above=True)
    height = 2e2 * tall * problem_of(run, Crawl).crawler.radius
    for number, p in enumerate(phases):
        state = printed.isel(time=crawlers.nearest(printed, gait.time(p)))
        along, top = 1e2 * state.along.to_numpy(), height * state.mu_1.to_numpy() - lane * number
        ax.plot(
            np.r_[along[0], along, along[-1]],
            np.r_[-lane * number, top, -lane * number],
            color=INK,
            linestyle=":",
            linewidth=1.2,
        )
    reach = 1e2 * np.array([run.along[indices], printed.along[indices]])
    ax.set(
        xlim=(reach.min() - 0.5, reach.max() + 0.5), xlabel=f"along the ground [cm], heights × {tall:g}"
    )
    looks = [
        *crawlers.legend_of_bodies(),
        Patch(facecolor="black", label="segment 50"),
        Line2D([], [], color=INK, linestyle=":", label="as printed"),
    ]
    figure.legend(handles=looks, loc="outside lower center", ncols=3)
    return figure


def fig_2_2(data: Data, published: Mapping[str, float]) -> Figure:
    """Stretches and pressure of segment 50 over the strides, corrected and as printed, and Quillin's measurements."""
    figure, (top, bottom) = canvas(WIDTH, 5.8, 2, 1)
    for name, style in (("worm", "-"), ("worm_printed", ":")):
        run = segment(data[name])
        for variable, colour in crawlers.STRETCHES.items():
            top.plot(run.time, run[variable], style, color=colour, linewidth=crawlers.WIDTHS[variable])
        bottom.plot(run.time, run.p_coelom / 1e3, style, color=INK)
    problem = problem_of(data["worm"], Crawl)
    free = problem.gait.duration + problem.gait.time(0.4)  # time where a label is beside no curve
    for variable, side in (("mu_1", -1), ("mu_3", 1)):
        ratio = published[f"2.8.6-{variable.replace('_', '')}-ratio"]
        level = ratio * float(at_phase(data["worm"], LONGITUDINAL)[variable])
        _measured(top, level, rf"{ratio:g} $\{variable}|_{{long}}$", free, side)
    for load in ("longitudinal", "circular"):
        level = published[f"2.8-p-{load}-measured"] / 1e3
        _measured(bottom, level, f"{level:g} kPa", free, 1)
    for ax in (top, bottom):
        _stances(ax, problem)
        ax.set_xlabel("time [s]")
    looks = [
        *(
            Line2D([], [], color=c, linewidth=crawlers.WIDTHS[v], label=rf"$\{v}$")
            for v, c in crawlers.STRETCHES.items()
        ),
        Line2D([], [], color=INK, label="corrected"),
        Line2D([], [], color=INK, linestyle=":", label="as printed"),
        Line2D([], [], color=EXACT, linestyle="--", label="measured"),
        Patch(facecolor=_STANCE, label="stance"),
    ]
    top.set(ylabel="stretch [1]", title="(a) stretches of segment 50", ylim=(0.74, 1.43))
    bottom.set(ylabel=r"$p_{coelom}$ [kPa]", title="(b) coelomic pressure of segment 50")
    bottom.set_ylim(top=0.92)
    figure.legend(handles=looks, loc="outside lower center", ncols=4)
    return figure


def _stances(ax: Axes, problem: Crawl) -> None:
    """The second part of every stride, shaded."""
    gait, protrusion = problem.gait, problem.gait.time(1.0)
    parts = [
        (k * gait.duration + protrusion, gait.duration - protrusion) for k in range(problem.strides)
    ]
    ax.broken_barh(
        parts, (0, 1), transform=ax.get_xaxis_transform(), color=_STANCE, linewidth=0, zorder=0
    )


def _measured(ax: Axes, level: float, label: str, time: float, side: int) -> None:
    """A measured level, its number above (1) or below (-1) it at a time [s]."""
    ax.axhline(level, color=EXACT, linestyle="--", linewidth=1.0, zorder=1)
    va = "bottom" if side > 0 else "top"
    beside(ax, (time, level), label, (0, 2.5 * side), ha="center", va=va, color=EXACT)


def fig_2_5(_: Data) -> Figure:
    """The load of one muscle of finite width, its force, and the force of rows of several."""
    figure, axes = canvas(WIDTH, 6.2, 3, 1)
    xi, one, window = np.linspace(0, 1, 2001), np.array([0.5]), 0.3
    axes[0].plot(xi, doublets.load(xi, one, window, 1.0), color=COMPUTED)
    ends = 0.5 - window / 2, 0.5 + window / 2
    arrow = {"arrowstyle": "<->", "color": INK, "shrinkA": 0, "shrinkB": 0}
    axes[0].annotate("", (ends[0], 8.2), (ends[1], 8.2), arrowprops=arrow)
    beside(axes[0], (ends[1], 8.2), r"window $\lambda$", (5, 0))
    axes[1].plot(xi, doublets.contact_force(xi, one, window, 1.0), color=COMPUTED)
    for count, colour, line in ((2, FOURTH, ":"), (6, VARIANT, "-."), (40, COMPUTED, "-")):
        centres, width = doublets.row(0.25, 0.75, count)
        force = doublets.contact_force(xi, centres, width, 1.0)
        axes[2].plot(xi, force, line, color=colour, label=f"{count} muscles")
    axes[2].plot([0.25, 0.25, 0.75, 0.75], [0, -1, -1, 0], color=EXACT, linestyle="--", label="(2.2.7)")
    axes[0].set(ylabel="load [$P$ / length]", title="(a) load of one muscle", ylim=(-9.5, 9.5))
    axes[1].set(ylabel="force $n / P$ [1]", title="(a) its force", ylim=(-1.15, 0.15))
    axes[2].set(ylabel="force $n / P$ [1]", title="(b) muscles from 0.25 to 0.75", ylim=(-2.1, 0.15))
    for ax in axes:
        ax.set_xlabel(r"$\xi$ [length]")
    axes[2].set_yticks([-1.0, -0.5, 0.0])
    axes[2].legend(loc="lower center", ncols=2)
    return figure


def fig_2_12(data: Data) -> Figure:
    """The anchored point of the worm, in both readings of the schedule."""
    figure, axes = canvas(WIDTH, 4.4, 2, 1)
    for ax, (name, title, colour, parts) in zip(
        axes,
        (
            ("worm", "(a) the rear end holds from $t_p/2$", COMPUTED, 2),
            ("worm_early", "(b) the rear end holds from $t_p/3$", VARIANT, 3),
        ),
        strict=True,
    ):
        run = data[name]
        crawl = problem_of(run, Crawl)
        first = crawl.gait.time(1.0) / parts
        ax.plot(run.time, run.anchor / crawl.crawler.length, "o", markersize=3, color=colour)
        for stride in range(crawl.strides):
            turn = stride * crawl.gait.duration + first
            ax.axvline(turn, color=EXACT, linestyle=":", linewidth=1.2, zorder=1)
        beside(ax, (first, 0.85), f"$t_p/{parts}$", (4, 0), color=EXACT)
        ax.set(xlabel="time [s]", ylabel=r"$\xi_A / \ell_0$ [1]", title=title, ylim=(-0.06, 1.06))
    return figure


_LAWS = (
    ("worm_masses", "constant stress", COMPUTED, "o"),
    ("worm_masses_constant_pressure", "strip tension, constant $p$", VARIANT, "s"),
    ("worm_masses_strip", "strip tension", INK, "^"),
)
"""Runs of worms of every mass, with the law of their muscles, its colour and its marker."""


def fig_masses(data: Data) -> Figure:
    """Stride, speed, frequency and stretches of worms of every mass, beside the slopes of the literature."""
    figure, axes = canvas(WIDTH, 9.8, 4, 1)
    rising = dict.fromkeys(("worm_masses", "worm_masses_constant_pressure"), (-2, 13))
    rising["worm_masses_strip"] = (-12, 9)
    _of_mass(axes[0], data, "stride", "m", rising)
    _of_mass(axes[1], data, "speed", "m/s", rising)
    _of_mass(axes[2], data, "frequency", "1/s", {"worm_masses_constant_pressure": (12, 3)})
    axes[2].set_yticks([0.2, 0.25, 0.3, 0.35], ["0.2", "0.25", "0.3", "0.35"])
    _extremes(axes[3], data)
    for ax, letter in zip(axes, "abcd", strict=True):
        ax.set(xlabel="body mass [g]", title=f"({letter}) {ax.get_title(loc='left')}")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _of_mass(
    ax: Axes, data: Data, variable: str, unit: str, asides: Mapping[str, tuple[float, float]]
) -> None:
    """A number of worms over their mass, and slopes, each `asides` of the first point of its curve."""
    for name, law, colour, marker in _LAWS:
        run = data[name]
        grams, values = run.body_mass.to_numpy() * 1e3, run[variable].to_numpy()
        ax.loglog(grams, values, color=colour, marker=marker, label=law)
        if name in asides:
            beside(ax, (grams[0], values[0]), _signed(slope(run, variable)), asides[name], color=colour)
    grams = data["worm_masses"].body_mass.to_numpy() * 1e3
    anchored = float(data["worm_masses"][variable][-1])
    known = anchored * (grams / grams[-1]) ** SLOPES[variable]
    ax.loglog(grams, known, color=EXACT, linestyle="--", label="literature")
    ax.set(
        ylabel=f"{variable} [{unit}]",
        title=f"{variable}: slopes, in the literature {_signed(SLOPES[variable])}",
    )
    ax.yaxis.set_minor_formatter(NullFormatter())
    ax.margins(y=0.12)


def _signed(value: float) -> str:
    return f"{value:.2f}".replace("-", "\N{MINUS SIGN}")


def _extremes(ax: Axes, data: Data) -> None:
    """The largest and the smallest stretch of segment 50 over the mass."""
    for name, _, colour, marker in _LAWS:
        run = data[name]
        grams = run.body_mass.to_numpy() * 1e3
        for variable, line, text in (("mu_3_most", "-", "longest"), ("mu_3_least", "--", "shortest")):
            ax.semilogx(grams, run[variable], line, color=colour, marker=marker)
            if name == "worm_masses":
                beside(ax, (grams[0], float(run[variable][0])), text, (0, 10), color=colour)
    ax.set(ylabel=r"$\mu_3$ [1]", title=r"extremes of $\mu_3$ in segment 50")
