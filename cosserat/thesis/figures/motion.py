"""Motions: Fig. 3.13 and natural modes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.exact import beams, elastica
from cosserat.figures.rod import draw_outline
from cosserat.figures.style import BODY, COMPUTED, CONSISTENT, EXACT, VARIANT, canvas
from cosserat.figures.supports import draw_supports
from cosserat.problems.motion import RodMotion
from cosserat.rods.kinematics import PLANAR
from cosserat.rods.problem import RodProblem
from cosserat.studies.calibration import beam_of

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_MODE_AMPLITUDE = 0.06  # largest displacement of a mode shape in a picture, in lengths of the rod


def fig_3_13(data: Data) -> Figure:
    """Kinetic energies and tip displacements of the two beams released from the first mode shape."""
    figure, (left, right) = canvas(7.2, 3.1, 1, 2)
    for name, label, colour, line in (
        ("vibration_c4_2", "$c_4 = 2$", VARIANT, "-"),
        ("vibration_c4_20", "$c_4 = 20$", COMPUTED, "-"),
        ("vibration_consistent", "consistent rod", CONSISTENT, "--"),
    ):
        run = data[name]
        tip = run.x.sel(axis="E2").isel(vertex=-1) * 1e3
        left.plot(run.time, run.kinetic_energy, line, color=colour, label=label, linewidth=1.0)
        right.plot(run.time, tip, line, color=colour, linewidth=1.0)
    omega = beams.first_frequency(beam_of(problem_of(data["vibration_c4_20"], RodProblem)))
    last = float(data["vibration_c4_20"].time[-1])
    for ax, length in ((left, np.pi / omega), (right, 2 * np.pi / omega)):
        for start in np.arange(0, last, length):
            ax.axvline(
                start,
                color=EXACT,
                linestyle=":",
                linewidth=0.9,
                label=None if start else "periods by (3.5.15)",
            )
    exact = (
        2
        * np.pi
        / elastica.timoshenko_frequencies(
            beam_of(problem_of(data["vibration_consistent"], RodProblem)), 1
        )[0]
    )
    returns = np.arange(0, last, exact)
    right.plot(returns, np.full(returns.size, 11.5), "v", color=CONSISTENT, markersize=4, clip_on=False)
    left.plot([], [], "v", color=CONSISTENT, markersize=4, label="exact Timoshenko periods, in (b)")
    left.set(xlabel="time [s]", ylabel="kinetic energy [J]", title="(a) kinetic energy, period halved")
    right.set(xlabel="time [s]", ylabel="tip displacement [mm]", title="(b) displacement")
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def fig_modes(data: Data) -> Figure:
    """The four lowest modes of the beam with high shear stiffness, with both signs."""
    figure, axes = canvas(7.2, 3.6, 2, 2)
    problem = problem_of(data["vibration_c4_20"], RodMotion)
    found = problem.modes(len(axes))
    geometry = problem.geometry
    for ax, frequency, shape, letter in zip(
        axes, found.angular_frequency, found.shape, "abcd", strict=True
    ):
        field = _MODE_AMPLITUDE * problem.rod.length * shape / np.abs(shape).max()
        x, d = np.split(field.reshape(-1, len(PLANAR.dofs)), 2, axis=1)
        for sign, colours in (
            (-1, {"facecolor": "none", "edgecolor": EXACT, "linestyle": ":"}),
            (1, {"facecolor": BODY, "edgecolor": COMPUTED}),
        ):
            draw_outline(ax, geometry.X + sign * x, geometry.D + sign * d, problem, **colours)
        draw_supports(ax, problem, geometry.X, geometry.D)
        ax.set_aspect("equal", adjustable="datalim")
        ax.set(
            xlabel=r"along $\mathbf{E}_3$ [m]",
            ylabel=r"along $\mathbf{E}_2$ [m]",
            title=f"({letter}) {frequency:,.0f} rad/s",
        )
    return figure
