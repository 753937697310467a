"""Read-outs of the crawlers of Chapter 2."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr

from cosserat.data.dataset import problem_of
from cosserat.problems.crawl import Crawl
from cosserat.thesis.earthworm import CIRCULAR, LONGITUDINAL, SEGMENT_50
from cosserat.thesis.table.printed import number, push_pull_rod
from cosserat.thesis.table.reading import Measurement

SLOPES = {"stride": 0.41, "speed": 0.33, "frequency": -0.07}
"""Powers of the body mass that Quillin measured on earthworms, the thesis's reference [50]; the thesis prints 0.4 for
the stride, (2.8.4), and none of the others."""


def instants_per_stride(data: xr.Dataset) -> int:
    """Stored times from the start of one stride to the start of the next."""
    return (data.sizes["time"] - 1) // problem_of(data, Crawl).strides


def segment(data: xr.Dataset) -> xr.Dataset:
    """Stored values of segment 50."""
    places = np.linspace(0, 1, data.sizes["section"])
    return data.isel(section=int(np.abs(places - SEGMENT_50).argmin()))


def strides(data: xr.Dataset) -> np.ndarray:
    """Stride lengths by eq. (2.8.5), one for each stride [m]."""
    front = data.along.isel(section=-1).to_numpy()[:: instants_per_stride(data)]
    return np.diff(front)


def at_phase(data: xr.Dataset, phase: float) -> xr.Dataset:
    """Segment 50 at a phase of the last stride."""
    problem = problem_of(data, Crawl)
    when = (problem.strides - 1) * problem.gait.duration + problem.gait.time(phase)
    return segment(data).isel(time=int(np.abs(data.time.to_numpy() - when).argmin()))


def slope(data: xr.Dataset, variable: str) -> float:
    """The exponent of the body mass in a variable, by least squares of the logarithms."""
    return power(data, data[variable])


def power(data: xr.Dataset, values: xr.DataArray) -> float:
    """The exponent of the body mass in any positive numbers, one for each body mass."""
    return float(np.polyfit(np.log(data.body_mass), np.log(values), 1)[0])


def _at(variable: str, phase: float) -> Callable[[xr.Dataset], Measurement]:
    return lambda data: Measurement(float(at_phase(data, phase)[variable]))


def _ratio(variable: str) -> Callable[[xr.Dataset], Measurement]:
    """Circular over longitudinal contraction, eq. (2.8.10)."""

    def read(data: xr.Dataset) -> Measurement:
        circular, longitudinal = (float(at_phase(data, p)[variable]) for p in (CIRCULAR, LONGITUDINAL))
        return Measurement(circular / longitudinal)

    return read


def _slope(variable: str) -> Callable[[xr.Dataset], Measurement]:
    """The exponent of the body mass, and that of the literature."""
    return lambda data: Measurement(slope(data, variable), SLOPES[variable])


def _strain_slope(number: int) -> Callable[[xr.Dataset], Measurement]:
    """The exponent of a strain of section 2.8, between circular and longitudinal contraction; expected is zero."""

    def read(data: xr.Dataset) -> Measurement:
        circular, longitudinal = ("least", "most") if number == 1 else ("most", "least")
        ratio = data[f"mu_{number}_{circular}"] / data[f"mu_{number}_{longitudinal}"]
        return Measurement(power(data, abs(ratio - 1)), 0.0)

    return read


def _rest_pressure(data: xr.Dataset) -> Measurement:
    return Measurement(float(data.p_coelom.isel(section=data.sizes["section"] // 2)))


def _cycle_displacement(data: xr.Dataset) -> Measurement:
    """Displacement of the soft robot in the cycle with the largest error, and the closed form of the printed robot.

    The front end advances until a fraction T of the body is left for gamma, and is then anchored.
    """
    rod = push_pull_rod()
    expected = rod.stretched_length(number("soft_robot", "T") * rod.length) - rod.stretched_length(
        rod.length
    )
    cycles = strides(data)
    return Measurement(float(cycles[np.abs(cycles - expected).argmax()]), expected)


READOUTS: dict[str, Callable[[xr.Dataset], Measurement]] = {
    "stride": lambda data: Measurement(float(strides(data)[-1])),
    "cycle_displacement": _cycle_displacement,
    "rest_pressure": _rest_pressure,
    "mu_1_circular": _at("mu_1", CIRCULAR),
    "mu_3_circular": _at("mu_3", CIRCULAR),
    "mu_1_longitudinal": _at("mu_1", LONGITUDINAL),
    "mu_3_longitudinal": _at("mu_3", LONGITUDINAL),
    "p_circular": _at("p_coelom", CIRCULAR),
    "p_longitudinal": _at("p_coelom", LONGITUDINAL),
    "mu_1_ratio": _ratio("mu_1"),
    "mu_3_ratio": _ratio("mu_3"),
    "stride_slope": _slope("stride"),
    "speed_slope": _slope("speed"),
    "stride_exponent": lambda data: Measurement(slope(data, "stride")),
    "strain_across_slope": _strain_slope(1),
    "strain_along_slope": _strain_slope(3),
    "fitted_young": lambda data: Measurement(float(data.fitted_young)),
    "fitted_anchoring_share": lambda data: Measurement(
        float(data.fitted_anchoring) / number("worm", "D_peak")
    ),
    "fitted_advancing_share": lambda data: Measurement(
        float(data.fitted_advancing) / number("worm", "p_peak")
    ),
}
"""Read-outs by their names in the table."""
