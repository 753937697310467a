"""Figures of Chapter 2: muscles, gaits, and what they do to a robot and a worm."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from cosserat.figures import crawlers
from cosserat.figures.style import COMPUTED, EXACT, INK, VARIANT, canvas, over_one
from cosserat.models import doublets
from cosserat.models.earthworm import SEGMENT_50
from cosserat.models.gait import Gait
from cosserat.table.crawl_readouts import SLOPES, crawl, instants_per_stride, segment, slope

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]


def fig_2_1(data: Data) -> Figure:
    """One stride of the worm at the six times of the page, segment 50 in black."""
    run = data["worm"]
    phases = [0, 1 / 3, 2 / 3, 1, 1.5, 2]
    gait = crawl(run).gait
    indices = [int(np.abs(run.time.to_numpy() - gait.time(p)).argmin()) for p in phases]
    labels = [f"$t_{k}$ = {gait.time(p):.2f} s" for k, p in enumerate(phases, start=1)]
    return crawlers.snapshots(run, indices, labels, SEGMENT_50)


def fig_2_2(data: Data) -> Figure:
    """Stretches and pressure of segment 50 over the strides: corrected, and as printed."""
    figure, (top, bottom) = canvas(7.2, 4.6, 2, 1)
    for name, style in (("worm", "-"), ("worm_printed", ":")):
        run = segment(data[name])
        for variable, colour in (("mu_1", COMPUTED), ("mu_3", VARIANT)):
            top.plot(run.time, run[variable], style, color=colour)
        bottom.plot(run.time, run.p_coelom / 1e3, style, color=INK)
    looks = [
        Line2D([], [], color=COMPUTED, label=r"$\mu_1$"),
        Line2D([], [], color=VARIANT, label=r"$\mu_3$"),
        Line2D([], [], color=EXACT, label="corrected"),
        Line2D([], [], color=EXACT, linestyle=":", label="(2.4.18), (2.2.20) as printed"),
    ]
    top.set(xlabel="time [s]", ylabel="stretch [1]", title="(a) stretches of segment 50")
    bottom.set(
        xlabel="time [s]", ylabel=r"$p_{coelom}$ [kPa]", title="(b) coelomic pressure of segment 50"
    )
    figure.legend(handles=looks, loc="outside lower center", ncols=4)
    return figure


def fig_2_5(_: Data) -> Figure:
    """One muscle of finite width, and rows of more and more of them."""
    figure, (left, right) = canvas(7.2, 3.0, 1, 2)
    xi, one = np.linspace(0, 1, 2001), np.array([0.5])
    left.plot(
        xi, doublets.load(xi, one, 0.3, 1.0) / 10, color=COMPUTED, label=r"load, in $10\,P$ per length"
    )
    left.plot(xi, doublets.contact_force(xi, one, 0.3, 1.0), color=VARIANT, label="$n / P$")
    left.annotate(r"$\lambda$", (0.5, 0.72), ha="center")
    left.annotate("", (0.35, 0.7), (0.65, 0.7), arrowprops={"arrowstyle": "<->", "color": INK})
    left.set(
        xlabel=r"$\xi$ [length]",
        ylabel="load and force [$P$]",
        title="(a) one muscle in a window $\\lambda$",
    )
    left.legend(loc="lower left", fontsize=8)
    for count, colour in ((2, "#b8cfe4"), (6, "#6fa1cc"), (40, COMPUTED)):
        centres, width = doublets.row(0.25, 0.75, count)
        right.plot(
            xi, doublets.contact_force(xi, centres, width, 1.0), color=colour, label=f"{count} muscles"
        )
    right.plot([0.25, 0.25, 0.75, 0.75], [0, -1, -1, 0], color=EXACT, linestyle="--", label="(2.2.7)")
    right.set(xlabel=r"$\xi$ [length]", ylabel="$n / P$ [1]", title=r"(b) muscles from 0.25 to 0.75")
    right.legend(loc="center", fontsize=8)
    return figure


def fig_2_7(data: Data) -> Figure:
    """A cycle of push and pull: the robot at equal steps of its fronts."""
    run = data["soft_robot"]
    phases = [0, 1.5, 2, 2.5, 3, 3.5, 4]
    gait = crawl(run).gait
    first = run.time.to_numpy()
    indices = [int(np.abs(first - gait.time(p)).argmin()) for p in phases]
    return crawlers.snapshots(run, indices, [f"{first[i]:.1f} s" for i in indices], None)


def fig_2_8(data: Data) -> Figure:
    """The fronts of the robot's gait over both cycles."""
    return _fronts(data["soft_robot"])


def fig_2_9(data: Data) -> Figure:
    """The robot while it crawls: its ends, its anchor, and its shape on the ground at the start of every cycle."""
    run = data["soft_robot"]
    figure, (left, right, below) = over_one(7.2, 6.6, (1.0, 1.1))
    _paths(left, run)
    for variable, colour, label in (("mu_1", COMPUTED, r"$\mu_1$"), ("mu_3", VARIANT, r"$\mu_3$")):
        middle = run.isel(time=int(np.abs(run.time.to_numpy() - 12.5).argmin()))
        right.plot(run.xi_section * 1e2, middle[variable], color=colour, label=label)
    right.set(
        xlabel=r"$\xi$ [cm]", ylabel="stretch [1]", title="(b) stretches when $\\eta$ appears, 12.5 s"
    )
    right.legend()
    starts = list(range(0, run.sizes["time"], instants_per_stride(run)))
    labels = [f"{float(run.time[k]):.1f} s" for k in starts]
    crawlers.draw_snapshots(below, run, starts, labels, None)
    below.set_title("(c) at the start of every cycle and at the end of the last")
    return figure


def fig_2_11(data: Data) -> Figure:
    """The fronts of the worm's gait."""
    return _fronts(data["worm"])


def fig_2_12(data: Data) -> Figure:
    """Where the worm holds on: both readings of the schedule."""
    figure, (ax,) = canvas(7.2, 2.6)
    for name, label, colour, size in (
        ("worm", "rear from $t_p/2$", COMPUTED, 5),
        ("worm_early", "rear from $t_p/3$", VARIANT, 2),
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


def _fronts(run: xr.Dataset) -> Figure:
    """gamma and eta over time, a front that has left the body not drawn."""
    figure, (ax,) = canvas(7.2, 2.6)
    problem = crawl(run)
    gait = problem.gait
    phases = np.linspace(0, len(gait.phases), 601)
    for kind, colour in (("gamma", crawlers.GAMMA), ("eta", crawlers.ETA)):
        for stride in range(problem.strides):
            times = np.array([gait.time(p) for p in phases]) + stride * gait.duration
            places = np.array([_front(gait, kind, p) for p in phases])
            label = rf"$\{kind} / \ell_0$" if stride == 0 else None
            ax.plot(times, places, color=colour, label=label)
    ax.set(xlabel="time [s]", ylabel="place [1]", ylim=(-0.03, 1.03))
    ax.legend(loc="upper right")
    return figure


def _front(gait: Gait, kind: str, phase: float) -> float:
    found = [place for place, name in gait.fronts(phase) if name == kind]
    return found[0] if found else np.nan


def _paths(ax: Axes, run: xr.Dataset) -> None:
    for section, label, colour in ((0, "rear end", COMPUTED), (-1, "front end", INK)):
        ax.plot(run.time, run.along.isel(section=section) * 1e2, color=colour, label=label)
    ax.plot(run.time, run.anchor_along * 1e2, ".", color=VARIANT, markersize=3, label="anchor")
    ax.set(xlabel="time [s]", ylabel="along the ground [cm]", title="(a) paths")
    ax.legend(fontsize=8)
