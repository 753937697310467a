"""Motions: frames of the body, the path of its last vertex, energies, and the displacements of named points."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from cosserat.data.dataset import problem_of
from cosserat.figures.rod import draw_loads, draw_outline, magnification
from cosserat.figures.style import (
    ALONG_E2,
    ALONG_E3,
    BODY,
    COMPUTED,
    EXACT,
    VARIANT,
    canvas,
    plain,
    title_of,
)
from cosserat.figures.supports import draw_masses, draw_supports
from cosserat.rods.problem import RodProblem

_SHAPES = 7  # frames of a motion in one picture


def picture(data: xr.Dataset) -> Figure:
    """The picture of `cosserat plot`: the body in some frames, the path of its last vertex, energies, named points."""
    named = int("probe_displacement" in data)
    figure, (left, right, *below) = canvas(7.2, 3.4 + 3.0 * named, 1 + named, 2)
    problem = problem_of(data, RodProblem)
    X, D = data.x_ref.to_numpy(), data.d_ref.to_numpy()
    magnified = magnification(data.x.to_numpy() - X, problem.rod.length)
    x, d = X + magnified * (data.x.to_numpy() - X), D + magnified * (data.d.to_numpy() - D)
    last = x.shape[0] - 1
    for number in np.unique(np.linspace(0, last, _SHAPES).round().astype(int))[:-1]:
        draw_outline(left, x[number], d[number], problem, facecolor="none", edgecolor=EXACT, alpha=0.6)
    draw_outline(left, x[-1], d[-1], problem, facecolor=BODY, edgecolor=COMPUTED, label="last frame")
    draw_supports(left, problem, x[-1], D)
    draw_masses(left, problem, x[-1], d[-1])
    draw_loads(left, problem, x[-1], d[-1], float(data.time[-1]))
    left.plot(*x[:, -1].T, color=VARIANT, linewidth=0.8, label="last vertex")
    left.set_aspect("equal", adjustable="datalim")
    left.set(
        xlabel=ALONG_E3,
        ylabel=ALONG_E2,
    )
    left.set_title(f"{title_of(data)}, displacements × {magnified:g}", pad=24)  # above the legend
    right.plot(data.time, data.kinetic_energy, color=COMPUTED, label="kinetic")
    right.plot(data.time, data.strain_energy, color=VARIANT, label="strain")
    right.set(xlabel="time [s]", ylabel="energy [J]")
    for ax, axis in zip(below, ("E3", "E2"), strict=False):
        for name in data.probe.to_numpy():
            ax.plot(data.time, data.probe_displacement.sel(probe=name, axis=axis), label=plain(name))
        ax.set(xlabel="time [s]", ylabel=f"displacement along {axis} [m]")
    for ax in (left, right, *below):
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    return figure
