"""Named read-outs: a Dataset in, one measured number and, where a closed form judges it, the number expected.

A row of `results/tolerances.csv` names its read-out here.  Shares of a curve are largest deviations over the vertices
divided by the largest ordinate of the closed form.
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
from cosserat.table import crawl_readouts
from cosserat.table.reading import Reading

Array = NDArray[np.float64]


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


def hanging_bar_curve(data: xr.Dataset) -> tuple[Array, Array]:
    """u . E3 at the vertices, computed and by eq. (3.5.2) [m]."""
    problem = problem_of(data)
    exact = analytic.hanging_bar_displacement(beam_of(problem), weight_of(problem), data.xi.to_numpy())
    return data.u.sel(axis="E3").to_numpy(), exact


def clamped_free_curve(data: xr.Dataset) -> tuple[Array, Array]:
    """u . E2 at the vertices, computed and by eq. (3.5.3) [m]."""
    problem = problem_of(data)
    exact = analytic.clamped_free_displacement(beam_of(problem), weight_of(problem), data.xi.to_numpy())
    return data.u.sel(axis="E2").to_numpy(), exact


def clamped_free_directors(data: xr.Dataset) -> tuple[Array, Array]:
    """delta . E3 at the lateral surface, computed and by eqs. (3.5.1), (3.5.4) [m]."""
    problem = problem_of(data)
    exact = analytic.clamped_free_director(beam_of(problem), weight_of(problem), data.xi.to_numpy())
    return data.delta.sel(axis="E3").to_numpy(), exact * problem.rod.height / 2


def clamped_clamped_curve(data: xr.Dataset) -> tuple[Array, Array]:
    """u . E2 at the vertices, computed and by eq. (3.5.6) [m]."""
    problem = problem_of(data)
    exact = analytic.clamped_clamped_displacement(
        beam_of(problem), weight_of(problem), data.xi.to_numpy()
    )
    return data.u.sel(axis="E2").to_numpy(), exact


def clamped_clamped_directors(data: xr.Dataset) -> tuple[Array, Array]:
    """delta . E3 at the lateral surface, computed and by eqs. (3.5.1), (3.5.7) [m]."""
    problem = problem_of(data)
    exact = analytic.clamped_clamped_director(beam_of(problem), weight_of(problem), data.xi.to_numpy())
    return data.delta.sel(axis="E3").to_numpy(), exact * problem.rod.height / 2


def necking_curve(data: xr.Dataset, theory: analytic.NeckingTheory = "printed") -> tuple[Array, Array]:
    """lambda - 1 at the vertices, computed and by eq. (3.5.8) with beta of the named theory [1]."""
    problem = problem_of(data)
    beam = beam_of(problem)
    beta = analytic.necking_decay(beam, theory)
    exact = analytic.necking_strain(beam, tension_of(problem), beta, data.xi.to_numpy())
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


def _beam_theory_period(data: xr.Dataset) -> Reading:
    """Of the kinetic energy, by eq. (3.5.15): half the period of the beam."""
    return Reading(float(np.pi / analytic.first_frequency(beam_of(problem_of(data)))))


def _stretching_coefficient(data: xr.Dataset) -> Reading:
    """The c1 at which the tip would stand where eq. (3.5.2) puts it; the tip displacement goes as 1 / c1."""
    computed, exact = hanging_bar_curve(data)
    calibration = problem_of(data).rod.calibration
    assert calibration is not None
    return Reading(calibration.c1 * float(computed[-1] / exact[-1]))


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
    """Sideways displacement of the tip over the length, and that of Reissner's rod of the same stiffnesses."""
    problem = problem_of(data)
    beam = beam_of(problem)
    unit = beam.bending_stiffness / beam.length**2
    exact, _ = elastica.shearable_tip(
        problem.forces[0].force / unit, beam.axial_stiffness / unit, beam.shear_stiffness / unit
    )
    return Reading(float(data.u.sel(axis="E2")[-1]) / beam.length, exact)


def _column_tip(data: xr.Dataset) -> Reading:
    """Tip of the column at its full load, and that of the exact elastica."""
    load = float(buckling_share(data)[-1]) * np.pi**2 / 4
    return Reading(abs(float(data.x.sel(axis="E2")[-1, -1])), elastica.column_tip(load)[0])


def _timoshenko_period(data: xr.Dataset) -> Reading:
    exact = 2 * np.pi / elastica.timoshenko_frequencies(beam_of(problem_of(data)), 1)[0]
    return Reading(_displacement_period(data).measured, float(exact))


def _roll_up(data: xr.Dataset) -> Reading:
    """Distance of the end from the start over the length."""
    return Reading(float(np.hypot(*data.x[-1].to_numpy())) / problem_of(data).rod.length, 0.0)


READOUTS: dict[str, Callable[[xr.Dataset], Reading]] = {
    "stretching_coefficient": _stretching_coefficient,
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
    "first_root": lambda _: Reading(analytic.first_root() / np.pi),
    "first_factor": lambda _: Reading(analytic.first_root() ** 2),
    "kinetic_energy_period": _kinetic_energy_period,
    "displacement_period": _displacement_period,
    "beam_theory_period": _beam_theory_period,
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
