"""Named read-outs: a Dataset in, one measured number and, where a closed form judges it, the number expected.

A row of `results/tolerances.csv` names its read-out here.  Shares of a curve are largest deviations over the vertices
divided by the largest ordinate of the closed form.  Closed forms take their beam and loads from `table.printed`, not
from the case that was solved, unless they are handed another beam.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from cosserat import analytic, elastica
from cosserat.data.dataset import problem_of as posed
from cosserat.models.calibration import beam_of
from cosserat.models.rod_problem import RodProblem
from cosserat.table import crawl_readouts, printed
from cosserat.table.reading import Reading

Array = NDArray[np.float64]

THIN = 0.005
"""Radius over length of our slender rods; their square sections have the bending stiffness of a circle."""


def problem_of(data: xr.Dataset) -> RodProblem:
    """The rod problem that a Dataset was computed from.

    Raises
    ------
    InputError : it was not computed from one.
    """
    return posed(data, RodProblem, "is not of one rod; use the result of one that is")


def weight_of(problem: RodProblem) -> float:
    """g of a problem under its own weight [m/s^2]."""
    assert problem.gravity is not None
    return problem.gravity.g


def tension_of(problem: RodProblem) -> float:
    """n of a bar pulled at its last vertex [N]."""
    return problem.forces[-1].force


def midspan(values: Array) -> float:
    """The value at mid-span: of the middle vertex, or the mean of the two nearest it if their number is even."""
    half = values.size // 2
    return float(values[half] if values.size % 2 else values[half - 1 : half + 1].mean())


def vertices_of(data: xr.Dataset, beam: analytic.Beam) -> Array:
    """Where the vertices of a uniform rod of the beam's length are, shape (N,) [m]."""
    return np.linspace(0.0, beam.length, data.sizes["vertex"])


def half_height(beam: analytic.Beam) -> float:
    """Where the lateral surface of a rectangle stands, H/2 = sqrt(3 I / A) [m]."""
    return float(np.sqrt(3 * beam.second_moment / beam.area))


def _under_weight(
    data: xr.Dataset, case: str, curve: analytic.BeamCurve, beam: analytic.Beam | None
) -> tuple[analytic.Beam, Array]:
    """The beam, printed unless another is given, and a closed form of it under the printed g."""
    beam = beam or printed.beam(case)
    return beam, curve(beam, printed.number(case, "gravity.g"), vertices_of(data, beam))


def hanging_bar_curve(data: xr.Dataset, beam: analytic.Beam | None = None) -> tuple[Array, Array]:
    """u . E3 at the vertices, computed and by eq. (3.5.2) [m]."""
    _, exact = _under_weight(data, "hanging_bar", analytic.hanging_bar_displacement, beam)
    return data.u.sel(axis="E3").to_numpy(), exact


def clamped_free_curve(data: xr.Dataset, beam: analytic.Beam | None = None) -> tuple[Array, Array]:
    """u . E2 at the vertices, computed and by eq. (3.5.3) [m]."""
    _, exact = _under_weight(data, "clamped_free", analytic.clamped_free_displacement, beam)
    return data.u.sel(axis="E2").to_numpy(), exact


def clamped_free_directors(data: xr.Dataset, beam: analytic.Beam | None = None) -> tuple[Array, Array]:
    """delta . E3 at the lateral surface, computed and by eqs. (3.5.1), (3.5.4) [m]."""
    beam, exact = _under_weight(data, "clamped_free", analytic.clamped_free_director, beam)
    return data.delta.sel(axis="E3").to_numpy(), exact * half_height(beam)


def clamped_clamped_curve(data: xr.Dataset, beam: analytic.Beam | None = None) -> tuple[Array, Array]:
    """u . E2 at the vertices, computed and by eq. (3.5.6) [m]."""
    _, exact = _under_weight(data, "clamped_clamped", analytic.clamped_clamped_displacement, beam)
    return data.u.sel(axis="E2").to_numpy(), exact


def clamped_clamped_directors(
    data: xr.Dataset, beam: analytic.Beam | None = None
) -> tuple[Array, Array]:
    """delta . E3 at the lateral surface, computed and by eqs. (3.5.1), (3.5.7) [m]."""
    beam, exact = _under_weight(data, "clamped_clamped", analytic.clamped_clamped_director, beam)
    return data.delta.sel(axis="E3").to_numpy(), exact * half_height(beam)


def necking_curve(
    data: xr.Dataset,
    theory: analytic.NeckingTheory = "printed",
    beam: analytic.Beam | None = None,
) -> tuple[Array, Array]:
    """lambda - 1 at the vertices, computed and by eq. (3.5.8) with beta of the named theory [1]."""
    beam = beam or printed.beam("necking")
    beta = analytic.necking_decay(beam, theory)
    pull = printed.number("necking", "forces.1.force")
    exact = analytic.necking_strain(beam, pull, beta, vertices_of(data, beam))
    return data.lam.to_numpy() - 1, exact


def at_tip(curves: tuple[Array, Array]) -> Reading:
    """Both curves at the last vertex."""
    return Reading(float(curves[0][-1]), float(curves[1][-1]))


def at_midspan(curves: tuple[Array, Array]) -> Reading:
    """Both curves at mid-span."""
    return Reading(midspan(curves[0]), midspan(curves[1]))


def _share(curves: tuple[Array, Array]) -> Reading:
    computed, exact = curves
    return Reading(float(np.abs(computed - exact).max() / np.abs(exact).max()), 0.0)


def period(times: Array, values: Array) -> float:
    """Period of the sinusoid that fits a record best, in least squares, near its strongest line [s]."""
    line = np.abs(np.fft.rfft(values - values.mean()))
    step = times[1] - times[0]
    strongest = 2 * np.pi * (1 + int(line[1:].argmax())) / (step * times.size)
    width = 2 * np.pi / (step * times.size)

    def misfit(omega: float) -> float:
        columns = np.column_stack([np.ones_like(times), np.cos(omega * times), np.sin(omega * times)])
        return float(((values - columns @ np.linalg.lstsq(columns, values, rcond=None)[0]) ** 2).sum())

    best = minimize_scalar(
        misfit,
        bounds=(strongest - width, strongest + width),
        method="bounded",
        options={"xatol": 1e-9 * strongest},
    )
    return float(2 * np.pi / best.x)


def _kinetic_energy_period(data: xr.Dataset) -> Reading:
    return Reading(period(data.time.to_numpy(), data.kinetic_energy.to_numpy()))


def _displacement_period(data: xr.Dataset) -> Reading:
    tip = data.x.sel(axis="E2").isel(vertex=-1).to_numpy()
    return Reading(period(data.time.to_numpy(), tip))


def _recovered(problem: str, coefficient: str) -> Callable[[xr.Dataset], Reading]:
    """A coefficient as the calibration recovers it at the published number of vertices."""

    def read(data: xr.Dataset) -> Reading:
        fitted = data[f"{problem}_coefficients"].isel(
            mesh=int(np.argmax(data.vertices.to_numpy() == 20))
        )
        (dim,) = fitted.dims
        return Reading(float(fitted.sel({dim: coefficient})))

    return read


def buckling_share(data: xr.Dataset) -> Array:
    """Axial load of a clamped-free column as a share of Euler's, pi^2 EI / (4 L^2), at every point of its path."""
    problem = problem_of(data)
    beam = beam_of(problem)
    euler = np.pi**2 / 4 * beam.bending_stiffness / beam.length**2
    share: Array = data.load_factor.to_numpy() * problem.forces[0].force / euler
    return share


def _elastica_tip(data: xr.Dataset) -> Reading:
    """Sideways displacement of the tip of a rod of one metre, and that of Reissner's with P L^2 / EI = 10."""
    axial = 4 / THIN**2  # EA L^2 / EI
    exact, _ = elastica.shearable_tip(10.0, axial, 5 / 6 / 2 * axial)
    return Reading(float(data.u.sel(axis="E2")[-1]), exact)


def _column_tip(data: xr.Dataset) -> Reading:
    """Tip of a column of one metre, and that of the exact elastica at twice Euler's load, pi^2 EI / (4 L^2)."""
    exact = elastica.column_tip(2 * np.pi**2 / 4)[0]
    return Reading(abs(float(data.x.sel(axis="E2")[-1, -1])), exact)


def _timoshenko_period(data: xr.Dataset) -> Reading:
    exact = 2 * np.pi / elastica.timoshenko_frequencies(printed.beam("vibration_c4_20"), 1)[0]
    return Reading(_displacement_period(data).measured, float(exact))


def _roll_up(data: xr.Dataset) -> Reading:
    """Distance of the end from the start of a rod of one metre."""
    return Reading(float(np.hypot(*data.x[-1].to_numpy())), 0.0)


READOUTS: dict[str, Callable[[xr.Dataset], Reading]] = {
    "hanging_bar_tip": lambda data: at_tip(hanging_bar_curve(data)),
    "hanging_bar_profile": lambda data: _share(hanging_bar_curve(data)),
    "largest_director_displacement": lambda data: Reading(float(np.abs(data.delta).max()), 0.0),
    "clamped_free_tip": lambda data: at_tip(clamped_free_curve(data)),
    "clamped_free_profile": lambda data: _share(clamped_free_curve(data)),
    "clamped_free_directors": lambda data: _share(clamped_free_directors(data)),
    "clamped_clamped_midspan": lambda data: at_midspan(clamped_clamped_curve(data)),
    "clamped_clamped_profile": lambda data: _share(clamped_clamped_curve(data)),
    "clamped_clamped_directors": lambda data: _share(clamped_clamped_directors(data)),
    "recovered_c2": _recovered("necking", "c2"),
    "recovered_c3": _recovered("clamped_free", "c3"),
    "recovered_c4": _recovered("clamped_free", "c4"),
    "recovered_c5": _recovered("clamped_free", "c5"),
    "recovered_c6": _recovered("necking", "c6"),
    "recovered_c7": _recovered("necking", "c7"),
    "kinetic_energy_period": _kinetic_energy_period,
    "displacement_period": _displacement_period,
    "necking_midspan": lambda data: at_midspan(necking_curve(data)),
    "necking_profile": lambda data: _share(necking_curve(data)),
    "elastica_tip": _elastica_tip,
    "column_tip": _column_tip,
    "timoshenko_period": _timoshenko_period,
    "roll_up": _roll_up,
    "necking_free_section": lambda data: _share(necking_curve(data, "free section")),
    **crawl_readouts.READOUTS,
}
"""Read-outs by the name that a row gives."""
