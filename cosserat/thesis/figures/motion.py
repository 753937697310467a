"""Motions: Fig. 3.13 and natural modes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.exact import beams, elastica
from cosserat.figures.rod import draw_outline
from cosserat.figures.style import (
    ALONG_E3,
    BODY,
    COMPUTED,
    CONSISTENT,
    EARLIER,
    EXACT,
    VARIANT,
    WIDTH,
    canvas,
)
from cosserat.figures.supports import draw_supports
from cosserat.problems.calibration import beam_of
from cosserat.problems.motion import RodMotion
from cosserat.rods.kinematics import PLANAR
from cosserat.rods.problem import RodProblem

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_BEAMS = (
    ("vibration_c4_2", "$c_4 = 2$", VARIANT, "-"),
    ("vibration_c4_20", "$c_4 = 20$", COMPUTED, "-"),
    ("vibration_consistent", "consistent rod", CONSISTENT, "--"),
)
"""Runs of Fig. 3.13, with their names, colours and lines."""

_MOVED = (4, 9, 14, 19)  # vertices with an arrow from one extreme of a mode to the other
_LEAST_ARROW = 0.01  # shortest displacement with an arrow, in lengths of the rod
_MODE_AMPLITUDE = 0.06  # largest displacement of a mode shape in a picture, in lengths of the rod


def fig_3_13(data: Data) -> Figure:
    """Kinetic energies of the first mode, tip displacements, and the ripple of the stiffer beam's whole energy."""
    figure, (top, bottom, last_panel) = canvas(WIDTH, 7.4, 3, 1)
    stiff = data["vibration_c4_20"]
    for name, label, colour, line in _BEAMS:
        run = data[name]
        tip = run.x.sel(axis="E2").isel(vertex=-1) * 1e3
        top.plot(run.time, first_mode_energy(run), line, color=colour, label=label)
        bottom.plot(run.time, tip, line, color=colour)
    beam = beam_of(problem_of(stiff, RodProblem))
    omega, last = beams.first_frequency(beam), float(stiff.time[-1])
    for ax, length in ((top, np.pi / omega), (bottom, 2 * np.pi / omega)):
        for start in np.arange(0, last, length):
            label = "" if start else "periods by (3.5.15)"
            ax.axvline(start, color=EXACT, linestyle=":", linewidth=0.9, label=label)
    consistent = beam_of(problem_of(data["vibration_consistent"], RodProblem))
    exact = 2 * np.pi / elastica.timoshenko_frequencies(consistent, 1)[0]
    returns = np.arange(0, last, exact)
    bottom.plot(returns, np.full(returns.size, 11.5), "v", color=CONSISTENT, markersize=4, clip_on=False)
    top.plot([], [], "v", color=CONSISTENT, markersize=4, label="exact Timoshenko periods")
    top.set(xlabel="time [s]", ylabel="kinetic energy [J]", title="(a) first mode, period halved")
    _draw_ripple(last_panel, stiff)
    bottom.set(xlabel="time [s]", ylabel="tip displacement [mm]", title="(b) displacement")
    figure.legend(*top.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def first_mode_energy(run: xr.Dataset) -> Array:
    """The part of the kinetic energy that is in the first mode of the beam at rest, (time,) [J]."""
    problem = problem_of(run, RodMotion)
    rates = np.concatenate([run.x_rate.to_numpy(), run.d_rate.to_numpy()], axis=2)
    mass = problem.system(problem.geometry).inertia
    speed = problem.modes(1).coordinates(mass, rates.reshape(run.sizes["time"], -1))[:, 0]
    energy: Array = speed**2 / 2
    return energy


def _draw_ripple(ax: Axes, run: xr.Dataset) -> None:
    """The first pulses of the whole kinetic energy, and of the part in the first mode."""
    part = run.isel(time=slice(0, run.sizes["time"] // 4))
    ax.plot(part.time, part.kinetic_energy, color=EARLIER, linewidth=0.8, label="whole")
    ax.plot(part.time, first_mode_energy(part), color=COMPUTED, label="first mode")
    ax.legend(loc="upper center", bbox_to_anchor=(0.6, 1.0))
    ax.set(
        xlabel="time [s]",
        ylabel="kinetic energy [J]",
        title="(c) whole energy and first mode, $c_4 = 20$",
    )


def fig_modes(data: Data) -> Figure:
    """The four lowest modes of the beam with high shear stiffness: sections in one extreme, outline in the other."""
    figure, axes = canvas(WIDTH, 6.4, 4, 1)
    problem = problem_of(data["vibration_c4_20"], RodMotion)
    found = problem.modes(len(axes))
    geometry = problem.geometry
    for ax, frequency, shape, letter in zip(
        axes, found.angular_frequency, found.shape, "abcd", strict=True
    ):
        field = _MODE_AMPLITUDE * problem.rod.length * shape / np.abs(shape).max()
        u, delta = np.split(field.reshape(-1, len(PLANAR.dofs)), 2, axis=1)
        x, d = geometry.X + u, geometry.D + delta
        ghost = {"facecolor": "none", "edgecolor": EXACT, "linestyle": ":"}
        draw_outline(ax, geometry.X - u, geometry.D - delta, problem, **ghost)
        draw_outline(ax, x, d, problem, facecolor=BODY, edgecolor=COMPUTED)
        ends = np.stack([x - d, x + d, np.full_like(x, np.nan)], axis=1).reshape(-1, 2)
        ax.plot(*ends.T, color=COMPUTED, linewidth=0.8)
        draw_supports(ax, problem, geometry.X, geometry.D)
        for k in _MOVED:
            if np.hypot(*u[k]) > _LEAST_ARROW * problem.rod.length:
                arrow = {"arrowstyle": "-|>", "color": VARIANT, "shrinkA": 0, "shrinkB": 0}
                ax.annotate("", tuple(x[k]), tuple(geometry.X[k] - u[k]), arrowprops=arrow, zorder=5)
        ax.set_aspect("equal")
        ax.set(
            xlabel=ALONG_E3,
            ylabel=r"$\mathbf{E}_2$ [m]",
            xlim=(-0.05 * problem.rod.length, 1.1 * problem.rod.length),
            ylim=(-0.14 * problem.rod.length, 0.14 * problem.rod.length),
            title=f"({letter}) {frequency:,.0f} rad/s",
        )
    return figure
