"""Motions: Fig. 3.13 and animations of the body, as SVG that plays in any browser by itself."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.exact import beams, elastica
from cosserat.figures.rod import draw_outline, outline
from cosserat.figures.style import BODY, COMPUTED, CONSISTENT, EXACT, INK, VARIANT, canvas
from cosserat.figures.supports import draw_supports
from cosserat.problems.motion import RodMotion
from cosserat.rods.kinematics import PLANAR
from cosserat.rods.problem import RodProblem
from cosserat.studies.calibration import beam_of

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_MODE_AMPLITUDE = 0.06  # largest displacement of a mode shape in a picture, in lengths of the rod
_WIDTH, _HEIGHT, _MARGIN = 640, 200, 12  # of an animation, in pixels


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


def anim_vibration(data: Data) -> str:
    """The beam with high shear stiffness over one period, displacements magnified."""
    run = data["vibration_c4_20"]
    period = 4 * np.pi / beams.first_frequency(beam_of(problem_of(run, RodProblem))) / 2
    return _animation(run.sel(time=slice(0, 0.963 * period)), magnified=10.0, seconds=2.0)


def anim_relaxation(data: Data) -> str:
    """The clamped-free beam settling under its weight, displacements magnified."""
    run = data["relaxing_clamped_free"]
    return _animation(run.sel(time=slice(0, 0.5)), magnified=20.0, seconds=4.0)


def _animation(data: xr.Dataset, *, magnified: float, seconds: float, frames: int = 60) -> str:
    chosen = np.unique(np.linspace(0, data.sizes["time"] - 1, frames).round().astype(int))
    x = data.x_ref.to_numpy() + magnified * (data.x.to_numpy()[chosen] - data.x_ref.to_numpy())
    d = data.d_ref.to_numpy() + magnified * (data.d.to_numpy()[chosen] - data.d_ref.to_numpy())
    surfaces = outline(x, d, problem_of(data, RodProblem))
    low, high = surfaces.min(axis=(0, 1)), surfaces.max(axis=(0, 1))
    scale = min((_WIDTH - 2 * _MARGIN) / (high - low)[0], (_HEIGHT - 2 * _MARGIN) / (high - low)[1])

    def path(points: Array, *, closed: bool) -> str:
        pixels = _MARGIN + scale * np.column_stack([points[:, 0] - low[0], high[1] - points[:, 1]])
        return "M" + "L".join(f"{a:.1f} {b:.1f}" for a, b in pixels) + ("Z" if closed else "")

    def moving(curves: Array, *, closed: bool, look: str) -> str:
        shapes = [path(points, closed=closed) for points in curves]
        values = ";".join(shapes)
        return (
            f'<path d="{shapes[0]}" {look}><animate attributeName="d" dur="{seconds}s" '
            f'repeatCount="indefinite" values="{values}"/></path>'
        )

    support = path(np.array([x[0, 0] - 1.5 * d[0, 0], x[0, 0] + 1.5 * d[0, 0]]), closed=False)
    height = int(scale * (high - low)[1]) + 2 * _MARGIN
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {height}" width="{_WIDTH}">'
        + moving(surfaces, closed=True, look=f'fill="{BODY}" stroke="{COMPUTED}"')
        + moving(x, closed=False, look=f'fill="none" stroke="{INK}" stroke-dasharray="5 4"')
        + f'<path d="{support}" stroke="{INK}" stroke-width="5"/></svg>\n'
    )
