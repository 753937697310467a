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
from cosserat.figures.style import BODY, COMPUTED, EXACT, INK, WIDTH, Picture, beside, canvas
from cosserat.problems.crawl import Crawl
from cosserat.thesis.table.printed import number

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]


def fig_2_7(data: Data) -> Figure:
    """A cycle: (a) push from the rear anchor, (b) transition, (c) pull to the forward anchor, with both fronts."""
    run = data["soft_robot"]
    gait = problem_of(run, Crawl).gait
    parts = (
        ("(a) push: the rear end holds", 0.5, (1.0, 1.5, 2.0)),
        ("(b) transition: the front end holds", 0.53, (2.2, 2.8)),
        ("(c) pull: the front end holds", 0.33, (3.2, 3.6, 4.0)),
    )
    indices = [crawlers.nearest(run, gait.time(p)) for *_, phases in parts for p in phases]
    labels = [f"$t_{k}$ =\n{float(run.time[i]):.1f} s" for k, i in enumerate(indices, start=1)]
    figure, (ax,) = canvas(WIDTH, 8.4)
    crawlers.draw_snapshots(ax, run, indices, labels)
    crawlers.draw_fronts(ax, run, indices)
    lane, first = crawlers.lane_height(run), 0
    for title, middle, phases in parts:
        top = (0.78 - first) * lane
        ax.annotate(title, (middle, top), xycoords=("axes fraction", "data"), ha="center")
        first += len(phases)
    ax.set_ylim(top=0.95 * lane)
    looks = [
        Line2D([], [], color=crawlers.GAMMA, linewidth=2.2, label=r"$\gamma(t)$"),
        Line2D([], [], color=crawlers.ETA, linewidth=2.2, label=r"$\eta(t)$"),
        *crawlers.legend_of_bodies(),
    ]
    figure.legend(handles=looks, loc="outside lower center", ncols=3)
    return figure


T_STEP = number("soft_robot", "t_step")
"""Time between the discrete values of Fig. 2.8 [s]."""


def fig_2_8(data: Data) -> Figure:
    """Discrete values of the robot's fronts: over both cycles, and in detail where eta begins."""
    run = data["soft_robot"]
    problem = problem_of(run, Crawl)
    figure, (both, close) = canvas(WIDTH, 5.4, 2, 1)
    _fill_regions(both, run)
    draw_gait(both, problem, run.time.to_numpy())
    _pauses(both, problem)
    for kind, phase in (("gamma", 1.5), ("eta", 2.5)):
        for stride in range(problem.strides):
            _name_front(both, problem, kind, phase, stride)
    begins = problem.gait.time(problem.gait.eta[0][0][0])
    about = np.array([begins + T_STEP * k for k in range(-5, 16)])
    draw_gait(close, problem, about, kinds=("eta",))
    close.axhline(1, color=EXACT, linewidth=0.8)
    close.set_yticks([0.985, 0.99, 0.995, 1.0])
    both.set(
        xlim=(0, float(run.time[-1])),
        ylim=(-0.02, 1.02),
        title=f"(a) every {run.time[1]:g} s, both cycles",
    )
    close.set(title=f"(b) $t_{{step}}$ = {T_STEP:g} s, where $\\eta$ begins")
    for ax in (both, close):
        ax.set(xlabel="time [s]", ylabel=r"$\gamma/\ell_0$, $\eta/\ell_0$ [1]")
    figure.legend(handles=crawlers.legend_of_bodies()[:2], loc="outside lower center", ncols=2)
    return figure


def _fill_regions(ax: Axes, run: xr.Dataset) -> None:
    """The load of each part of the body over time, in the colours of the drawn bodies."""
    places = np.linspace(0, 1, run.sizes["section"])
    ax.contourf(run.time, places, run.advancing.to_numpy().T, [0.5, 1.5], colors=[crawlers.THINNED])
    ax.set_facecolor(BODY)
    ax.grid(visible=False)


def _name_front(ax: Axes, problem: Crawl, kind: str, phase: float, stride: int) -> None:
    """The letter of a front, to the right of its line at a phase of a stride."""
    time = problem.gait.time(phase)
    found = [place for place, name in crawlers.fronts_on_the_body(problem, time) if name == kind]
    where = (stride * problem.gait.duration + time, found[0])
    beside(ax, where, rf"$\{kind}$", (5, 4), color=crawlers.FRONTS[kind], va="bottom")


def _pauses(ax: Axes, problem: Crawl) -> None:
    """The first phase of every stride, in which nothing moves."""
    gait = problem.gait
    for stride in range(problem.strides):
        begin = stride * gait.duration
        middle = (begin + gait.phases[0] / 2, 0.5)
        ax.annotate("$t_{pause}$", middle, ha="center", va="center", rotation=90)
        ax.vlines(begin + gait.phases[0], 0, 1, color=EXACT, linestyle=":", linewidth=1.0, zorder=1)


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
            markersize=3,
            color=colour,
            markeredgewidth=0,
        )


def fig_2_9(data: Data) -> Figure:
    """The robot crawls: its ends and anchor, its stretches, and its body through both cycles of Fig. 2.8."""
    run = data["soft_robot"]
    gait = problem_of(run, Crawl).gait
    figure = Picture(figsize=(WIDTH, 7.6), layout="constrained")
    panels = figure.subplot_mosaic([["a", "a"], ["b", "b"], ["c", "d"]], height_ratios=[1, 1, 1.4])
    _paths(panels["a"], run)
    _stretches_when_eta_appears(panels["b"], run)
    phases = (1.0, 1.5, 2.0, 2.5, 3.4, 4.0)
    reach = 1e2 * float(run.along.min()) - 0.5, 1e2 * float(run.along.max()) + 0.5
    for letter, stride, name in (("c", 0, "first"), ("d", 1, "second")):
        indices = [crawlers.nearest(run, stride * gait.duration + gait.time(p)) for p in phases]
        labels = [f"{float(run.time[k]):.1f} s" for k in indices]
        crawlers.draw_snapshots(panels[letter], run, indices, labels, lines=18)
        panels[letter].set(xlim=reach, title=f"({letter}) {name} cycle", xlabel="along the ground [cm]")
    figure.legend(handles=crawlers.legend_of_bodies(), loc="outside lower center", ncols=3)
    return figure


def _stretches_when_eta_appears(ax: Axes, run: xr.Dataset) -> None:
    gait = problem_of(run, Crawl).gait
    appears = gait.time(gait.eta[0][0][0])
    state = run.isel(time=crawlers.nearest(run, appears))
    for variable, colour in crawlers.STRETCHES.items():
        values = state[variable].to_numpy()
        width = crawlers.WIDTHS[variable]
        ax.plot(run.xi_section * 1e2, values, color=colour, linewidth=width)
        aside = (4, -7) if variable == "mu_1" else (4, 5)
        end = (1e2 * float(run.xi_section[-1]), values[-1])
        beside(ax, end, rf"$\{variable}$", aside, color=colour)
    ax.margins(y=0.12)
    ax.set(
        xlabel=r"$\xi$ [cm]",
        ylabel="stretch [1]",
        title=f"(b) stretches when $\\eta$ appears, {appears:.1f} s",
    )


def fig_2_11(data: Data) -> Figure:
    """The fronts of the worm's gait at its instants, and as lines the other readings of "then speeds up", E2.15."""
    run = data["worm"]
    problem = problem_of(run, Crawl)
    gait = problem.gait
    figure, (ax,) = canvas(WIDTH, 4.2)
    _fill_regions(ax, run)
    draw_gait(ax, problem, run.time.to_numpy())
    turns, place = gait.gamma[0][1]
    for gone, line, reading in (
        (2, "--", "one speed from $t_p/2$ to $t_p + t_s$"),
        (1, ":", "at the rear end at $t_p$"),
    ):
        for stride in range(problem.strides):
            times = stride * gait.duration + np.array([gait.time(turns), gait.time(gone)])
            label = None if stride else rf"$\gamma$ in another reading: {reading}"
            ax.plot(times, [place, 0], line, color=crawlers.GAMMA, linewidth=1.2, label=label)
    for kind, phase, stride in (
        ("gamma", 0.25, 0),
        ("eta", 1.5, 0),
        ("gamma", 0.25, 1),
        ("eta", 1.5, 1),
    ):
        _name_front(ax, problem, kind, phase, stride)
    _name_phases(ax, problem)
    ax.set(
        xlabel="time [s]",
        ylabel=r"$\gamma/\ell_0$, $\eta/\ell_0$ [1]",
        xlim=(0, float(run.time[-1])),
        ylim=(-0.02, 1.02),
    )
    handles = [*crawlers.legend_of_bodies()[:2], *ax.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside lower center", ncols=1)
    return figure


def _name_phases(ax: Axes, problem: Crawl) -> None:
    """The durations of protrusion and stance above each stride, and the middle of the first protrusion."""
    gait = problem.gait
    blended = ax.get_xaxis_transform()
    arrow = {"arrowstyle": "<->", "color": INK, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 7}
    for stride in range(problem.strides):
        times = stride * gait.duration + np.array([0.0, gait.time(1.0), gait.duration])
        for begin, end, name in ((*times[:2], "$t_p$"), (*times[1:], "$t_s$")):
            ax.annotate(
                "", (begin, 1.03), (end, 1.03), xycoords=blended, textcoords=blended, arrowprops=arrow
            )
            ax.annotate(name, ((begin + end) / 2, 1.05), xycoords=blended, ha="center", va="bottom")
            ax.axvline(end, color=EXACT, linewidth=0.8, zorder=1)
    half = gait.time(0.5)
    ax.axvline(half, color=EXACT, linestyle=":", linewidth=1.0, zorder=1)
    beside(ax, (half, 0), "$t_p/2$", (4, 7), color=INK)


def _paths(ax: Axes, run: xr.Dataset) -> None:
    for section, label, colour in ((0, "rear end", COMPUTED), (-1, "front end", INK)):
        ax.plot(run.time, run.along.isel(section=section) * 1e2, color=colour, label=label)
    ax.plot(run.time, run.anchor_along * 1e2, ".", color=crawlers.ANCHOR, markersize=3, label="anchor")
    ax.set(xlabel="time [s]", ylabel="along the ground [cm]", title="(a) paths")
    ax.legend(loc="upper left", ncols=3)
    ax.set_ylim(top=1e2 * float(run.along.max()) * 1.35)
