"""The consistent rod: its errors, its large deflections and its paths."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.exact import elastica
from cosserat.figures.path import draw_path, draw_shapes
from cosserat.figures.style import (
    ALONG_E2,
    ALONG_E3,
    BODY,
    COMPUTED,
    EARLIER,
    EXACT,
    INK,
    VARIANT,
    WIDTH,
    Picture,
    beside,
    canvas,
)
from cosserat.thesis.table.readouts import buckling_ratio

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]


_STATIC = {
    "clamped-free displacement": ("", 0),
    "clamped-free directors": ("clamped-free, directors", 5),
    "clamped-clamped displacement": ("clamped-clamped", 0),
    "necking section stretch": ("necking", 15),
    "elastica displacement, P = 1": ("", 0),
    "elastica displacement, P = 5": ("", 0),
    "elastica displacement, P = 10": ("elastica, 3 loads; clamped-free", -7),
    "elastica directors, P = 10": ("elastica, directors", -1),
}
"""Names at the ends of the lines of static errors, and how far above their ends they are [points]; near lines share."""
_VIBRATION = {"frequency 5": 4, "frequency 4": -1, "frequency 3": -3}
"""The same of the frequencies whose lines end near each other."""


def fig_convergence(data: Data) -> Figure:
    """Errors over the number of edges, and the published rod beside them."""
    figure, axes = canvas(WIDTH, 7.0, 2, 1)
    run = data["convergence"]
    edges = run.vertices.to_numpy() - 1
    for name in run.measure.to_numpy():
        vibrates = str(name).startswith("frequency")
        ax, errors = axes[int(vibrates)], run.errors.sel(measure=name).to_numpy()
        ax.loglog(edges, errors, color=EXACT, marker=".", linewidth=1.0)
        text, up = (str(name), _VIBRATION.get(str(name), 0)) if vibrates else _STATIC[str(name)]
        beside(ax, (edges[-1], errors[-1]), text, (6, up), color=INK)
    published = data["calibration"]
    off = np.abs(published.clamped_free_published.to_numpy() - 1)
    count = published.vertices.to_numpy() - 1
    axes[0].loglog(count, off, color=VARIANT, marker="s", linewidth=1.8)
    beside(axes[0], (count[-1], off[-1]), "clamped-free tip,\npublished rod", (6, 0), color=VARIANT)
    for ax, title in zip(axes, ("(a) statics", "(b) vibration"), strict=True):
        _slope_triangle(ax, edges, float(ax.get_ylim()[0]))
        ax.set(xlabel="edges [1]", ylabel="relative error [1]", title=title, xlim=(8, 4000))
        ax.set_xticks([10, 20, 40, 80, 160, 320], ["10", "20", "40", "80", "160", "320"])
        ax.minorticks_off()
    return figure


def _slope_triangle(ax: Axes, edges: Array, low: float) -> None:
    """One bold triangle of second order in the lower left corner: six times the edges, a part of the error in 36."""
    left, right, base = float(edges[0]), 6.0 * float(edges[0]), 1.6 * low
    corners = np.array([[left, base], [left, 36 * base], [right, base], [left, base]])
    ax.loglog(*corners.T, color=INK, linewidth=1.8, solid_joinstyle="miter")
    beside(ax, (left, base), "slope \N{MINUS SIGN}2", (5, 9), color=INK, fontweight="bold")


def fig_far(data: Data) -> Figure:
    """Shapes under a lateral dead force and under a couple at the tip, of a buckled column and of a snapping arch."""
    figure, axes = canvas(WIDTH, 4.7, 2, 2)
    titles = (
        ("elastica", "(a) force $10 EI/L^2$"),
        ("roll_up", r"(b) couple $2\pi EI/L$"),
        ("column_path", "(c) buckled column"),
        ("arch_path", "(d) hinged arch"),
    )
    for ax, (name, title) in zip(axes, titles, strict=True):
        draw_shapes(ax, data[name])
        ax.set(xlabel=ALONG_E3, ylabel=ALONG_E2, title=title)
        ax.set_aspect("equal")
        ax.set(xlim=(-0.2, 1.05), ylim=(-0.1, 0.9), xticks=[0, 0.5, 1], yticks=[0, 0.5])
    return figure


def fig_paths(data: Data) -> Figure:
    """Load over displacement, stable points filled: the column beside the exact elastica, and the arch."""
    figure, (top, bottom) = canvas(WIDTH, 6.0, 2, 1)
    column, arch = data["column_path"], data["arch_path"]
    angles = np.linspace(0.01, 2.3, 60)
    loads = [elastica.column_load(a) for a in angles]
    exact = [elastica.column_tip(load)[0] for load in loads]
    top.plot(
        exact,
        np.array(loads) / (np.pi**2 / 4),
        color=EXACT,
        linewidth=5,
        label="exact elastica",
        zorder=1,
    )
    draw_path(
        top, np.abs(column.x.sel(axis="E2").isel(vertex=-1).to_numpy()), buckling_ratio(column), column
    )
    top.set(xlabel="lateral tip displacement [m]", ylabel="load / Euler's load [1]", title="(a) column")
    middle = arch.sizes["vertex"] // 2
    draw_path(
        bottom, arch.x.sel(axis="E2").isel(vertex=middle).to_numpy(), arch.load_factor.to_numpy(), arch
    )
    bottom.set(xlabel="height of the middle [m]", ylabel="load / full load [1]", title="(b) hinged arch")
    return figure


def fig_tumbling(data: Data) -> Figure:
    """A thrown rod: its body at equal times, and the changes of energy and momenta from their start."""
    figure = Picture(figsize=(WIDTH, 5.6), layout="constrained")
    top, bottom = figure.subplots(2, 1, height_ratios=[1, 1.3])
    flight = data["tumbling"]
    x, d = (values.to_numpy()[..., ::-1] for values in (flight.x, flight.d))  # E2 to the right, E3 up
    shown = range(0, x.shape[0], 20)
    for k in shown:
        body = np.vstack([x[k] + d[k], (x[k] - d[k])[::-1]])
        top.fill(
            *body.T, facecolor=BODY, edgecolor=COMPUTED if k == shown[-1] else EARLIER, linewidth=1.0
        )
        below = k in (20, 100)  # where another body is above
        end = body[body[:, 1].argmin() if below else body[:, 1].argmax()]
        text, va = f"{1e3 * float(flight.time[k]):.0f} ms", "top" if below else "bottom"
        beside(top, (end[0], end[1]), text, (9, -3) if below else (0, 3), ha="center", va=va)
    top.set_aspect("equal")
    top.set(xlabel=ALONG_E2, ylabel=ALONG_E3, title="(a) flight")
    top.margins(0.06, 0.2)
    energy = (flight.kinetic_energy + flight.strain_energy).to_numpy()[:, None]
    kept = (
        ("energy", energy, COMPUTED, "-"),
        ("momentum", flight.momentum.to_numpy(), VARIANT, "-."),
        ("angular momentum", flight.angular_momentum.to_numpy()[:, None], INK, "--"),
    )
    for label, values, colour, line in kept:
        strayed = np.linalg.norm(values - values[0], axis=1) / np.linalg.norm(values[0])
        bottom.semilogy(flight.time[1:], np.maximum(strayed[1:], 1e-17), line, color=colour, label=label)
    bottom.set(
        xlabel="time [s]",
        ylabel="relative change [1]",
        title="(b) conserved quantities",
        ylim=(1e-17, 1e-6),
    )
    bottom.axhline(1e-8, color=EXACT, linestyle="--", linewidth=0.8)
    beside(bottom, (0, 1e-8), "tolerance of the energy", (0, 2), color=EXACT, va="bottom")
    figure.legend(*bottom.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure
