"""Figures of Chapter 2: muscles, gaits, and their effect on a robot and a worm."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures import crawlers
from cosserat.figures.style import COMPUTED, EXACT, INK, VARIANT, canvas
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

_HEIGHT_MAGNIFICATION = 3.0  # magnification of heights in Fig. 2.1


def fig_2_1(data: Data) -> Figure:
    """One stride of the worm at six times, segment 50 in black; dotted, by the printed equations."""
    run, printed = data["worm"], data["worm_printed"]
    phases = [0, 1 / 3, 2 / 3, 1, 1.5, 2]
    names = ("0", "t_p/3", "2t_p/3", "t_p", "t_p + t_s/2", "t_p + t_s")
    gait = problem_of(run, Crawl).gait
    indices = [crawlers.nearest(run, gait.time(p)) for p in phases]
    labels = [
        f"$t_{k} = {name}$" + (f"\n= {gait.time(p):.2f} s" if p else " s")
        for k, (p, name) in enumerate(zip(phases, names, strict=True), start=1)
    ]
    figure, (ax,) = canvas(7.2, 5.4)
    crawlers.draw_snapshots(ax, run, indices, labels, mark=SEGMENT_50, tall=_HEIGHT_MAGNIFICATION)
    lane, height = (
        crawlers.lane_height(run, _HEIGHT_MAGNIFICATION),
        2e2 * _HEIGHT_MAGNIFICATION * problem_of(run, Crawl).crawler.radius,
    )
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
    ax.set(xlim=(reach.min() - 0.5, reach.max() + 0.5), title=f"heights × {_HEIGHT_MAGNIFICATION:g}")
    looks = [
        *crawlers.legend_of_bodies(),
        Patch(facecolor="black", label="segment 50"),
        Line2D([], [], color=INK, linestyle=":", label="by (2.2.20), (2.4.18) as printed"),
    ]
    figure.legend(handles=looks, loc="outside lower center", ncols=5, fontsize=8)
    return figure


def fig_2_2(data: Data, published: Mapping[str, float]) -> Figure:
    """Stretches and pressure of segment 50 over the strides, corrected and as printed, and Quillin's measurements."""
    figure, (top, bottom) = canvas(7.2, 5.4, 2, 1)
    for name, style in (("worm", "-"), ("worm_printed", ":")):
        run = segment(data[name])
        for variable, colour in crawlers.STRETCHES.items():
            top.plot(run.time, run[variable], style, color=colour, linewidth=crawlers.WIDTHS[variable])
        bottom.plot(run.time, run.p_coelom / 1e3, style, color=INK)
    for variable in ("mu_1", "mu_3"):
        ratio = published[f"2.8.6-{variable.replace('_', '')}-ratio"]
        level = ratio * float(at_phase(data["worm"], LONGITUDINAL)[variable])
        _measured(top, level, rf"{ratio:g} $\{variable}|_{{long}}$")
    for load in ("longitudinal", "circular"):
        level = published[f"2.8-p-{load}-measured"] / 1e3
        _measured(bottom, level, f"{level:g} kPa")
    looks = [
        *(
            Line2D([], [], color=c, linewidth=crawlers.WIDTHS[v], label=rf"$\{v}$")
            for v, c in crawlers.STRETCHES.items()
        ),
        Line2D([], [], color=INK, label="corrected"),
        Line2D([], [], color=INK, linestyle=":", label="(2.2.20), (2.4.18) as printed"),
        Line2D([], [], color=EXACT, linestyle="--", label="measured by Quillin"),
    ]
    top.set(xlabel="time [s]", ylabel="stretch [1]", title="(a) stretches of segment 50")
    bottom.set(
        xlabel="time [s]", ylabel=r"$p_{coelom}$ [kPa]", title="(b) coelomic pressure of segment 50"
    )
    figure.legend(handles=looks, loc="outside lower center", ncols=6, fontsize=8)
    return figure


def _measured(ax: Axes, level: float, label: str) -> None:
    """A measured level, its number at the right edge."""
    ax.axhline(level, color=EXACT, linestyle="--", linewidth=1.0, zorder=1)
    ax.annotate(
        label,
        (1, level),
        xycoords=("axes fraction", "data"),
        xytext=(3, 0),
        textcoords="offset points",
        va="center",
        color=EXACT,
        fontsize=8,
    )


def fig_2_5(_: Data) -> Figure:
    """One muscle of finite width, and rows of several."""
    figure, (left, right) = canvas(7.2, 3.0, 1, 2)
    xi, one = np.linspace(0, 1, 2001), np.array([0.5])
    left.plot(
        xi, doublets.load(xi, one, 0.3, 1.0) / 10, color=COMPUTED, label=r"load, in $10\,P$ per length"
    )
    left.plot(xi, doublets.contact_force(xi, one, 0.3, 1.0), color=VARIANT, label="$n / P$")
    left.annotate(r"$\lambda$", (0.5, 0.79), ha="center")
    left.annotate("", (0.35, 0.74), (0.65, 0.74), arrowprops={"arrowstyle": "<->", "color": INK})
    left.set(
        xlabel=r"$\xi$ [length]",
        ylabel="load and force [$P$]",
        title="(a) one muscle in a window $\\lambda$",
        ylim=(-1.5, 1.0),
    )
    left.legend(loc="lower left", fontsize=8)
    for count, colour in ((2, "#b8cfe4"), (6, "#6fa1cc"), (40, COMPUTED)):
        centres, width = doublets.row(0.25, 0.75, count)
        right.plot(
            xi, doublets.contact_force(xi, centres, width, 1.0), color=colour, label=f"{count} muscles"
        )
    right.plot([0.25, 0.25, 0.75, 0.75], [0, -1, -1, 0], color=EXACT, linestyle="--", label="(2.2.7)")
    right.set(
        xlabel=r"$\xi$ [length]",
        ylabel="$n / P$ [1]",
        title=r"(b) muscles from 0.25 to 0.75",
        ylim=(-1.5, 0.06),
    )
    right.legend(loc="lower center", ncols=2, fontsize=8)
    return figure


def fig_2_12(data: Data) -> Figure:
    """The anchored point of the worm, in both readings of the schedule."""
    figure, (ax,) = canvas(7.2, 2.6)
    for name, label, colour, size in (
        ("worm", "rear from $t_p/2$", COMPUTED, 5),
        ("worm_early", "rear from $t_p/3$", VARIANT, 2),
    ):
        run = data[name]
        ax.plot(
            run.time,
            run.anchor / problem_of(run, Crawl).crawler.length,
            "o",
            markersize=size,
            color=colour,
            label=label,
        )
    ax.set(xlabel="time [s]", ylabel=r"$\xi_A / \ell_0$ [1]")
    ax.legend(loc="center right")
    return figure


def fig_masses(data: Data) -> Figure:
    """Stride, speed, frequency and stretches of worms of every mass, beside the slopes of the literature."""
    figure, axes = canvas(7.2, 5.4, 2, 2)
    runs = (
        ("worm_masses", "constant stress", COMPUTED, "o"),
        ("worm_masses_constant_pressure", "strip tension, constant $p$", VARIANT, "s"),
        ("worm_masses_strip", "strip tension", "#3a7d44", "^"),
    )
    panels = (("stride", "stride [m]"), ("speed", "speed [m/s]"), ("frequency", "frequency [1/s]"))
    for ax, (variable, label) in zip(axes, panels, strict=False):
        for name, law, colour, marker in runs:
            run = data[name]
            steep = slope(run, variable)
            ax.loglog(
                run.body_mass * 1e3,
                run[variable],
                color=colour,
                marker=marker,
                label=f"{law}: {steep:.2f}",
            )
        grams = data["worm_masses"].body_mass.to_numpy() * 1e3
        anchored = float(data["worm_masses"][variable][-1])
        known = anchored * (grams / grams[-1]) ** SLOPES[variable]
        ax.loglog(grams, known, color=EXACT, linestyle="--", label=f"literature: {SLOPES[variable]:g}")
        ax.set(xlabel="body mass [g]", ylabel=label)
        ax.legend(fontsize=7)
    for name, _, colour, marker in runs:
        run = data[name]
        for variable in ("mu_3_least", "mu_3_most"):
            axes[3].semilogx(run.body_mass * 1e3, run[variable], color=colour, marker=marker)
    axes[3].set(xlabel="body mass [g]", ylabel=r"extreme $\mu_3$ of segment 50 [1]")
    return figure
