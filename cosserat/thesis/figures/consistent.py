"""The consistent rod: its errors, its large deflections and its paths."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.exact import elastica
from cosserat.figures.path import draw_path, draw_shapes
from cosserat.figures.style import BODY, COMPUTED, EXACT, INK, VARIANT, canvas
from cosserat.thesis.table.readouts import buckling_ratio

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]


def fig_convergence(data: Data) -> Figure:
    """Errors over the number of edges, and the published rod beside them."""
    figure, (left, right) = canvas(7.2, 4.4, 1, 2)
    run = data["convergence"]
    edges = run.vertices.to_numpy() - 1
    for k, name in enumerate(run.measure.to_numpy()):
        ax = right if str(name).startswith("frequency") else left
        ax.loglog(edges, run.errors[k], marker=".", label=str(name))
    published = data["calibration"]
    off = np.abs(published.clamped_free_published - 1)
    left.loglog(
        published.vertices - 1, off, color=VARIANT, marker="s", label="clamped-free tip, published rod"
    )
    left.set_ylim(bottom=1e-8)  # room for the legend
    for ax, title in ((left, "(a) statics"), (right, "(b) vibration")):
        ax.loglog(edges, 3 * edges**-2.0, color=EXACT, linestyle="--", label="second order")
        ax.set(xlabel="edges [1]", ylabel="relative error [1]", title=title)
        ax.legend(fontsize=5.5, loc="lower left")
    return figure


def fig_far(data: Data) -> Figure:
    """Shapes under a lateral dead force and under a couple at the tip, of a buckled column and of a snapping arch."""
    figure, axes = canvas(7.2, 5.2, 2, 2)
    titles = (
        ("elastica", "(a) dead force, $PL^2/EI = 10$"),
        ("roll_up", r"(b) couple $2\pi EI/L$"),
        ("column_path", "(c) column beyond Euler's load"),
        ("arch_path", "(d) hinged arch"),
    )
    for ax, (name, title) in zip(axes, titles, strict=True):
        draw_shapes(ax, data[name])
        ax.set(xlabel=r"along $\mathbf{E}_3$ [m]", ylabel=r"along $\mathbf{E}_2$ [m]", title=title)
        ax.set_aspect("equal", adjustable="datalim")
    return figure


def fig_paths(data: Data) -> Figure:
    """Load over displacement, stable points filled: the column beside the exact elastica, and the arch."""
    figure, (left, right) = canvas(7.2, 3.2, 1, 2)
    column, arch = data["column_path"], data["arch_path"]
    ratio = buckling_ratio(column)
    draw_path(left, np.abs(column.x.sel(axis="E2").isel(vertex=-1).to_numpy()), ratio, column)
    angles = np.linspace(0.01, 2.3, 60)
    loads = [elastica.column_load(a) for a in angles]
    exact = [elastica.column_tip(load)[0] for load in loads]
    left.plot(exact, np.array(loads) / (np.pi**2 / 4), color=EXACT, label="exact elastica", zorder=1)
    left.set(xlabel="lateral tip displacement [m]", ylabel="load / Euler's load [1]", title="(a) column")
    left.legend()
    middle = arch.sizes["vertex"] // 2
    draw_path(
        right, arch.x.sel(axis="E2").isel(vertex=middle).to_numpy(), arch.load_factor.to_numpy(), arch
    )
    right.set(xlabel="height of the middle [m]", ylabel="load / full load [1]", title="(b) hinged arch")
    return figure


def fig_tumbling(data: Data) -> Figure:
    """A thrown rod: its outline at equal times, and the changes of energy and momenta from their start."""
    figure, (left, right) = canvas(7.2, 3.2, 1, 2)
    flight = data["tumbling"]
    x, d = flight.x.to_numpy(), flight.d.to_numpy()
    for k in range(0, x.shape[0], 10):
        outline = np.vstack([x[k] + d[k], (x[k] - d[k])[::-1], (x[k] + d[k])[:1]])
        left.plot(*outline.T, color=COMPUTED if k == 0 else BODY, linewidth=0.9)
        left.plot(*x[k].T, color=INK, linewidth=0.5)
    left.set_aspect("equal", adjustable="datalim")
    left.set(
        xlabel=r"along $\mathbf{E}_3$ [m]", ylabel=r"along $\mathbf{E}_2$ [m]", title="(a) every 25 ms"
    )
    energy = (flight.kinetic_energy + flight.strain_energy).to_numpy()[:, None]
    kept = (
        ("energy", energy, COMPUTED),
        ("momentum", flight.momentum.to_numpy(), VARIANT),
        ("angular momentum", flight.angular_momentum.to_numpy()[:, None], INK),
    )
    for label, values, colour in kept:
        strayed = np.linalg.norm(values - values[0], axis=1) / np.linalg.norm(values[0])
        right.semilogy(flight.time[1:], np.maximum(strayed[1:], 1e-17), color=colour, label=label)
    right.set(
        xlabel="time [s]",
        ylabel="relative change [1]",
        title="(b) conserved quantities",
        ylim=(1e-17, 1e-6),
    )
    right.axhline(1e-8, color=EXACT, linestyle="--", linewidth=0.8)
    right.legend()
    return figure
