"""Figures of Chapter 2: muscles, gaits, and what they do to a robot and a worm."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from cosserat.figures import crawlers
from cosserat.figures.style import BODY, COMPUTED, CONSISTENT, EXACT, INK, VARIANT, canvas
from cosserat.models import doublets
from cosserat.models.earthworm import SEGMENT_50
from cosserat.models.peristalsis import Crawl
from cosserat.table.crawl_readouts import (
    LONGITUDINAL,
    SLOPES,
    at_phase,
    crawl,
    instants_per_stride,
    segment,
    slope,
)

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

PAUSE = "#ececec"
_STRETCHES = {"mu_1": COMPUTED, "mu_2": CONSISTENT, "mu_3": VARIANT}
_WIDTHS = {"mu_1": 2.4, "mu_2": 1.0, "mu_3": 1.4}  # mu_2 lies on mu_1 but for the weight
_LOADS = (
    Patch(facecolor=BODY, label="anchoring load"),
    Patch(facecolor=crawlers.THINNED, label="advancing load"),
)
_ANCHORED = Line2D([], [], color=crawlers.ANCHOR, marker="^", linestyle="none", label="anchor")


_TALL = 3.0  # how much heights are magnified in Fig. 2.1


def fig_2_1(data: Data) -> Figure:
    """One stride of the worm at the six times of the page, segment 50 in black; dotted, by the printed equations."""
    run, printed = data["worm"], data["worm_printed"]
    phases = [0, 1 / 3, 2 / 3, 1, 1.5, 2]
    names = ("0", "t_p/3", "2t_p/3", "t_p", "t_p + t_s/2", "t_p + t_s")
    gait = crawl(run).gait
    indices = [_nearest(run, gait.time(p)) for p in phases]
    labels = [
        f"$t_{k} = {name}$" + (f"\n= {gait.time(p):.2f} s" if p else " s")
        for k, (p, name) in enumerate(zip(phases, names, strict=True), start=1)
    ]
    figure, (ax,) = canvas(7.2, 5.4)
    crawlers.draw_snapshots(ax, run, indices, labels, mark=SEGMENT_50, tall=_TALL)
    lane, height = crawlers.lane_height(run, _TALL), 2e2 * _TALL * crawl(run).crawler.radius
    for number, p in enumerate(phases):
        state = printed.isel(time=_nearest(printed, gait.time(p)))
        along, top = 1e2 * state.along.to_numpy(), height * state.mu_1.to_numpy() - lane * number
        ax.plot(
            np.r_[along[0], along, along[-1]],
            np.r_[-lane * number, top, -lane * number],
            color=INK,
            linestyle=":",
            linewidth=1.2,
        )
    reach = 1e2 * np.array([run.along[indices], printed.along[indices]])
    ax.set(xlim=(reach.min() - 0.5, reach.max() + 0.5), title=f"heights × {_TALL:g}")
    looks = [
        *_LOADS,
        Patch(facecolor="black", label="segment 50"),
        _ANCHORED,
        Line2D([], [], color=INK, linestyle=":", label="by (2.2.20), (2.4.18) as printed"),
    ]
    figure.legend(handles=looks, loc="outside lower center", ncols=5, fontsize=8)
    return figure


def fig_2_2(data: Data, published: Mapping[str, float]) -> Figure:
    """Stretches and pressure of segment 50 over the strides, corrected and as printed, beside what Quillin measured."""
    figure, (top, bottom) = canvas(7.2, 5.4, 2, 1)
    for name, style in (("worm", "-"), ("worm_printed", ":")):
        run = segment(data[name])
        for variable, colour in _STRETCHES.items():
            top.plot(run.time, run[variable], style, color=colour, linewidth=_WIDTHS[variable])
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
            Line2D([], [], color=c, linewidth=_WIDTHS[v], label=rf"$\{v}$")
            for v, c in _STRETCHES.items()
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
    """One muscle of finite width, and rows of more and more of them."""
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


def fig_2_7(data: Data) -> Figure:
    """A cycle: (a) push from the rear anchor, (b) transition, (c) pull to the forward anchor, with both fronts."""
    run = data["soft_robot"]
    gait = crawl(run).gait
    parts = (
        ("(a) push: the rear holds", (1.0, 1.5, 2.0)),
        ("(b) transition: the forward end holds", (2.2, 2.8)),
        ("(c) pull: the forward end holds", (3.2, 3.6, 4.0)),
    )
    indices = [_nearest(run, gait.time(p)) for _, phases in parts for p in phases]
    labels = [f"$t_{k}$ = {float(run.time[i]):.1f} s" for k, i in enumerate(indices, start=1)]
    figure, (ax,) = canvas(7.2, 9.9)
    crawlers.draw_snapshots(ax, run, indices, labels)
    crawlers.draw_fronts(ax, run, indices)
    lane, first = crawlers.lane_height(run), 0
    for title, phases in parts:
        top = (0.78 - first) * lane
        ax.annotate(title, (0.45, top), xycoords=("axes fraction", "data"), ha="center")
        first += len(phases)
    ax.set_ylim(top=0.95 * lane)
    looks = [
        Line2D([], [], color=crawlers.GAMMA, linewidth=2.2, label=r"$\gamma(t)$"),
        Line2D([], [], color=crawlers.ETA, linewidth=2.2, label=r"$\eta(t)$"),
        *_LOADS,
        _ANCHORED,
    ]
    figure.legend(handles=looks, loc="outside lower center", ncols=5)
    return figure


T_STEP = 0.01
"""Time between the discrete values of Fig. 2.8 [s]."""


def fig_2_8(data: Data) -> Figure:
    """Discrete values of the robot's fronts: over both cycles, and closely where eta begins."""
    run = data["soft_robot"]
    problem = crawl(run)
    figure = Figure(figsize=(7.2, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=[1.5, 1])
    draw_gait(left, problem, run.time.to_numpy())
    _pauses(left, problem)
    begins = problem.gait.time(problem.gait.eta[0][0][0])
    about = np.array([begins + T_STEP * k for k in range(-5, 16)])
    draw_gait(right, problem, about, kinds=("eta",))
    right.axhline(1, color=EXACT, linewidth=0.8)
    right.set_yticks([0.985, 0.99, 0.995, 1.0])
    left.set(
        xlim=(0, float(run.time[-1]) + 0.5),
        ylim=(-0.02, 1.02),
        title=f"(a) every {run.time[1]:g} s, both cycles",
    )
    right.set(title=f"(b) $t_{{step}}$ = {T_STEP:g} s, where $\\eta$ begins")
    for ax in (left, right):
        ax.set(xlabel="time [s]", ylabel=r"$\gamma/\ell_0$, $\eta/\ell_0$ [1]")
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _pauses(ax: Axes, problem: Crawl) -> None:
    """The first phase of every stride, in which nothing moves."""
    gait = problem.gait
    for stride in range(problem.strides):
        begin = stride * gait.duration
        ax.axvspan(begin, begin + gait.phases[0], color=PAUSE, linewidth=0)
        middle = (begin + gait.phases[0] / 2, 0.5)
        ax.annotate("$t_{pause}$", middle, ha="center", va="center", rotation=90)


def draw_gait(
    ax: Axes,
    problem: Crawl,
    times: Array,
    *,
    kinds: tuple[str, ...] = ("gamma", "eta"),
    hollow: bool = False,
    label: str = "",
) -> None:
    """One marker for each front on the body at each time [s]; a front at an end of the body has left it."""
    for kind in kinds:
        colour = crawlers.FRONTS[kind]
        points = np.array(
            [
                (time, place)
                for time in times
                for place, found in crawlers.fronts_on_the_body(problem, time)
                if found == kind
            ]
        )
        ax.plot(
            *points.T,
            linestyle="none",
            marker="o" if kind == "gamma" else "s",
            markersize=3 if hollow else 2.5,
            markerfacecolor="none" if hollow else colour,
            markeredgewidth=0.6,
            color=colour,
            label=rf"$\{kind}$" + label,
        )


def fig_2_9(data: Data) -> Figure:
    """The robot crawls: its ends and anchor, its stretches, and its body through both cycles of Fig. 2.8."""
    run = data["soft_robot"]
    gait = crawl(run).gait
    figure = Figure(figsize=(7.2, 6.8), layout="constrained")
    panels = figure.subplot_mosaic([["a", "b"], ["c", "d"]], height_ratios=[1, 1.5])
    _paths(panels["a"], run)
    _stretches_when_eta_appears(panels["b"], run)
    phases = (1.0, 1.5, 2.0, 2.5, 3.4, 4.0)
    reach = 1e2 * float(run.along.min()) - 0.5, 1e2 * float(run.along.max()) + 0.5
    for letter, stride, name in (("c", 0, "first"), ("d", 1, "second")):
        indices = [_nearest(run, stride * gait.duration + gait.time(p)) for p in phases]
        labels = [f"{float(run.time[k]):.1f} s" for k in indices]
        crawlers.draw_snapshots(panels[letter], run, indices, labels)
        panels[letter].set(xlim=reach, title=f"({letter}) {name} cycle")
    figure.legend(handles=[*_LOADS, _ANCHORED], loc="outside lower center", ncols=3)
    return figure


def _stretches_when_eta_appears(ax: Axes, run: xr.Dataset) -> None:
    gait = crawl(run).gait
    appears = gait.time(gait.eta[0][0][0])
    state = run.isel(time=_nearest(run, appears))
    for variable, colour in _STRETCHES.items():
        ax.plot(
            run.xi_section * 1e2,
            state[variable],
            color=colour,
            linewidth=_WIDTHS[variable],
            label=rf"$\{variable}$",
        )
    ax.set(
        xlabel=r"$\xi$ [cm]",
        ylabel="stretch [1]",
        title=f"(b) stretches when $\\eta$ appears, {appears:.1f} s",
    )
    ax.legend(loc="center right")


def fig_2_11(data: Data) -> Figure:
    """The fronts of the worm's gait at its instants, and hollow those of other readings of the page's words."""
    run = data["worm"]
    problem = crawl(run)
    gait = problem.gait
    figure, (ax,) = canvas(7.2, 3.4)
    for name, other in data.items():
        if name != "worm":
            kinds = tuple(
                k for k in crawlers.FRONTS if getattr(crawl(other).gait, k) != getattr(gait, k)
            )
            reading = other.attrs["title"].partition(", ")[2]
            times = other.time.to_numpy()[::4]
            draw_gait(
                ax,
                crawl(other),
                times,
                kinds=kinds,
                hollow=True,
                label=f" in another reading: {reading}",
            )
    draw_gait(ax, problem, run.time.to_numpy())
    for phase, name in ((0.5, "$t_p/2$"), (1.0, "$t_p$"), (2.0, "$t_p + t_s$")):
        ax.axvline(gait.time(phase), color=EXACT, linewidth=0.8, zorder=1)
        ax.annotate(
            name,
            (gait.time(phase), 1),
            xycoords=("data", "axes fraction"),
            xytext=(0, 3),
            textcoords="offset points",
            ha="center",
        )
    ax.set(
        xlabel="time [s]",
        ylabel=r"$\gamma/\ell_0$, $\eta/\ell_0$ [1]",
        xlim=(0, float(run.time[-1])),
        ylim=(-0.02, 1.02),
    )
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=8)
    return figure


def fig_2_12(data: Data) -> Figure:
    """Where the worm holds on: both readings of the schedule."""
    figure, (ax,) = canvas(7.2, 2.6)
    for name, label, colour, size in (
        ("worm_late", "rear from $t_p/2$", VARIANT, 5),
        ("worm", "rear from $t_p/3$", COMPUTED, 2),
    ):
        run = data[name]
        ax.plot(
            run.time,
            run.anchor / crawl(run).crawler.length,
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


def anim_worm(data: Data) -> str:
    """Two strides of the worm in real time."""
    run = data["worm"]
    count = 2 * instants_per_stride(run)
    part = run.isel(time=slice(0, count + 1))
    return crawlers.animation(part, seconds=float(part.time[-1]), mark=SEGMENT_50)


def anim_robot(data: Data) -> str:
    """Two cycles of the robot, four times as fast."""
    run = data["soft_robot"]
    return crawlers.animation(run, seconds=float(run.time[-1]) / 4)


def _nearest(run: xr.Dataset, time: float) -> int:
    """Index of the stored instant nearest to a time [s]."""
    return int(np.abs(run.time.to_numpy() - time).argmin())


def _paths(ax: Axes, run: xr.Dataset) -> None:
    for section, label, colour in ((0, "rear end", COMPUTED), (-1, "front end", INK)):
        ax.plot(run.time, run.along.isel(section=section) * 1e2, color=colour, label=label)
    ax.plot(run.time, run.anchor_along * 1e2, ".", color=crawlers.ANCHOR, markersize=3, label="anchor")
    ax.set(xlabel="time [s]", ylabel="along the ground [cm]", title="(a) paths")
    ax.legend(fontsize=8)
