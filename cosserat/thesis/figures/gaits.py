"""Figures 2.7 to 2.9 and 2.11: the fronts of a gait, and the robot that they drive."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures import crawlers
from cosserat.figures.style import COMPUTED, EXACT, INK, canvas
from cosserat.problems.crawl import Crawl
from cosserat.thesis.table.printed import number

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_PAUSE_COLOUR = "#ececec"


def fig_2_7(data: Data) -> Figure:
    """A cycle: (a) push from the rear anchor, (b) transition, (c) pull to the forward anchor, with both fronts."""
    run = data["soft_robot"]
    gait = problem_of(run, Crawl).gait
    parts = (
        ("(a) push: the rear holds", (1.0, 1.5, 2.0)),
        ("(b) transition: the forward end holds", (2.2, 2.8)),
        ("(c) pull: the forward end holds", (3.2, 3.6, 4.0)),
    )
    indices = [crawlers.nearest(run, gait.time(p)) for _, phases in parts for p in phases]
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
        *crawlers.legend_of_bodies(),
    ]
    figure.legend(handles=looks, loc="outside lower center", ncols=5)
    return figure


T_STEP = number("soft_robot", "t_step")
"""Time between the discrete values of Fig. 2.8 [s]."""


def fig_2_8(data: Data) -> Figure:
    """Discrete values of the robot's fronts: over both cycles, and in detail where eta begins."""
    run = data["soft_robot"]
    problem = problem_of(run, Crawl)
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
        ax.axvspan(begin, begin + gait.phases[0], color=_PAUSE_COLOUR, linewidth=0)
        middle = (begin + gait.phases[0] / 2, 0.5)
        ax.annotate("$t_{pause}$", middle, ha="center", va="center", rotation=90)


def draw_gait(
    ax: Axes,
    problem: Crawl,
    times: Array,
    *,
    kinds: tuple[str, ...] = ("gamma", "eta"),
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
            markersize=2.5,
            color=colour,
            label=rf"$\{kind}$",
        )


def fig_2_9(data: Data) -> Figure:
    """The robot crawls: its ends and anchor, its stretches, and its body through both cycles of Fig. 2.8."""
    run = data["soft_robot"]
    gait = problem_of(run, Crawl).gait
    figure = Figure(figsize=(7.2, 6.8), layout="constrained")
    panels = figure.subplot_mosaic([["a", "b"], ["c", "d"]], height_ratios=[1, 1.5])
    _paths(panels["a"], run)
    _stretches_when_eta_appears(panels["b"], run)
    phases = (1.0, 1.5, 2.0, 2.5, 3.4, 4.0)
    reach = 1e2 * float(run.along.min()) - 0.5, 1e2 * float(run.along.max()) + 0.5
    for letter, stride, name in (("c", 0, "first"), ("d", 1, "second")):
        indices = [crawlers.nearest(run, stride * gait.duration + gait.time(p)) for p in phases]
        labels = [f"{float(run.time[k]):.1f} s" for k in indices]
        crawlers.draw_snapshots(panels[letter], run, indices, labels)
        panels[letter].set(xlim=reach, title=f"({letter}) {name} cycle")
    figure.legend(handles=crawlers.legend_of_bodies(), loc="outside lower center", ncols=3)
    return figure


def _stretches_when_eta_appears(ax: Axes, run: xr.Dataset) -> None:
    gait = problem_of(run, Crawl).gait
    appears = gait.time(gait.eta[0][0][0])
    state = run.isel(time=crawlers.nearest(run, appears))
    for variable, colour in crawlers.STRETCHES.items():
        ax.plot(
            run.xi_section * 1e2,
            state[variable],
            color=colour,
            linewidth=crawlers.WIDTHS[variable],
            label=rf"$\{variable}$",
        )
    ax.set(
        xlabel=r"$\xi$ [cm]",
        ylabel="stretch [1]",
        title=f"(b) stretches when $\\eta$ appears, {appears:.1f} s",
    )
    ax.legend(loc="center right")


def fig_2_11(data: Data) -> Figure:
    """The fronts of the worm's gait at its instants, and as lines the other readings of "then speeds up", E2.15."""
    run = data["worm"]
    problem = problem_of(run, Crawl)
    gait = problem.gait
    figure, (ax,) = canvas(7.2, 3.4)
    draw_gait(ax, problem, run.time.to_numpy())
    turns, place = gait.gamma[0][1]
    for gone, line, reading in (
        (2, "--", "one speed from $t_p/2$ to $t_p + t_s$"),
        (1, ":", "0 at $t_p$"),
    ):
        for stride in range(problem.strides):
            times = stride * gait.duration + np.array([gait.time(turns), gait.time(gone)])
            label = None if stride else rf"$\gamma$ in another reading: {reading}"
            ax.plot(times, [place, 0], line, color=crawlers.GAMMA, linewidth=1.0, label=label)
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
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=4, fontsize=8)
    return figure


def _paths(ax: Axes, run: xr.Dataset) -> None:
    for section, label, colour in ((0, "rear end", COMPUTED), (-1, "front end", INK)):
        ax.plot(run.time, run.along.isel(section=section) * 1e2, color=colour, label=label)
    ax.plot(run.time, run.anchor_along * 1e2, ".", color=crawlers.ANCHOR, markersize=3, label="anchor")
    ax.set(xlabel="time [s]", ylabel="along the ground [cm]", title="(a) paths")
    ax.legend(fontsize=8)
