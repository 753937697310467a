"""Motions: frames of the body, the path of its last vertex, and energies."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from cosserat.data.dataset import problem_of
from cosserat.figures.rod import draw_loads, draw_outline, magnification
from cosserat.figures.style import BODY, COMPUTED, EXACT, VARIANT, canvas
from cosserat.figures.supports import draw_masses, draw_supports
from cosserat.rods.problem import RodProblem

_SHAPES = 7  # frames of a motion in one picture


def picture(data: xr.Dataset) -> Figure:
    """The picture of `cosserat plot` for a motion: the body in some frames, the path of the last vertex, energies."""
    figure, (left, right) = canvas(7.2, 3.4, 1, 2)
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
    draw_loads(left, problem, x[-1], d[-1])
    left.plot(*x[:, -1].T, color=VARIANT, linewidth=0.8, label="last vertex")
    left.set_aspect("equal", adjustable="datalim")
    left.set(
        xlabel=r"along $\mathbf{E}_3$ [m]",
        ylabel=r"along $\mathbf{E}_2$ [m]",
        title=f"{data.attrs['title']}, displacements × {magnified:g}",
    )
    right.plot(data.time, data.kinetic_energy, color=COMPUTED, label="kinetic")
    right.plot(data.time, data.strain_energy, color=VARIANT, label="strain")
    right.set(xlabel="time [s]", ylabel="energy [J]")
    for ax in (left, right):
        ax.legend()
    return figure
