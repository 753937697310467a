"""Read-outs of the crawlers of Chapter 2."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr

from cosserat import analytic
from cosserat.data.dataset import problem_of
from cosserat.models.earthworm import SEGMENT_50
from cosserat.models.peristalsis import Crawl
from cosserat.table.reading import Reading

SLOPES = {"stride": 0.41, "speed": 0.33, "frequency": -0.07, "mu_3_most": 0.0}
"""Powers of the body mass that Quillin measured on earthworms, the thesis's reference [50]; the thesis prints none."""

CIRCULAR, LONGITUDINAL = 1.5, 0.5
"""Phases at which segment 50 lies well inside an advancing and an anchoring region: t_p + t_s/2 and t_p/2."""


def crawl(data: xr.Dataset) -> Crawl:
    """The crawl that a Dataset was computed from.

    Raises
    ------
    InputError : it was computed from another kind of case.
    """
    return problem_of(data, Crawl, "has no gait; use the result of a crawl")


def instants_per_stride(data: xr.Dataset) -> int:
    """Stored times from the start of one stride to the start of the next."""
    return (data.sizes["time"] - 1) // crawl(data).strides


def segment(data: xr.Dataset) -> xr.Dataset:
    """What is stored of segment 50."""
    places = np.linspace(0, 1, data.sizes["section"])
    return data.isel(section=int(np.abs(places - SEGMENT_50).argmin()))


def strides(data: xr.Dataset) -> np.ndarray:
    """Stride lengths by eq. (2.8.5), one for each stride [m]."""
    front = data.along.isel(section=-1).to_numpy()[:: instants_per_stride(data)]
    return np.diff(front)


def at_phase(data: xr.Dataset, phase: float) -> xr.Dataset:
    """Segment 50 at a phase of the last stride."""
    problem = crawl(data)
    when = (problem.strides - 1) * problem.gait.duration + problem.gait.time(phase)
    return segment(data).isel(time=int(np.abs(data.time.to_numpy() - when).argmin()))


def slope(data: xr.Dataset, variable: str) -> float:
    """The power of the body mass with which a variable grows, by least squares of the logarithms."""
    return float(np.polyfit(np.log(data.body_mass), np.log(data[variable]), 1)[0])


def _at(variable: str, phase: float) -> Callable[[xr.Dataset], Reading]:
    return lambda data: Reading(float(at_phase(data, phase)[variable]))


def _ratio(variable: str) -> Callable[[xr.Dataset], Reading]:
    """Circular over longitudinal contraction, eq. (2.8.10)."""

    def read(data: xr.Dataset) -> Reading:
        circular, longitudinal = (float(at_phase(data, p)[variable]) for p in (CIRCULAR, LONGITUDINAL))
        return Reading(circular / longitudinal)

    return read


def _slope(variable: str) -> Callable[[xr.Dataset], Reading]:
    """The power of the body mass, and the one that the literature gives."""
    return lambda data: Reading(slope(data, variable), SLOPES[variable])


def _rest_pressure(data: xr.Dataset) -> Reading:
    return Reading(float(data.p_coelom.isel(section=data.sizes["section"] // 2)))


def _cycle_displacement(data: xr.Dataset) -> Reading:
    """Of the soft robot, and by the closed form: the front goes on while gamma travels, and holds from then on."""
    problem = crawl(data)
    body, loads = problem.crawler, problem.loads
    k_s, k_p, k_g = body.stiffnesses
    rod = analytic.PushPullRod(
        k_s=k_s,
        k_p=k_p,
        k_g=k_g,
        length=body.length,
        radius=body.radius,
        weight=body.line_density * loads.gravity,
        anchoring=loads.anchoring,
        advancing=loads.advancing * body.area,
    )
    gone = problem.gait.fronts(2)[0][0] * body.length  # where gamma is when the anchor changes
    return Reading(
        float(strides(data)[-1]), rod.stretched_length(gone) - rod.stretched_length(body.length)
    )


READOUTS: dict[str, Callable[[xr.Dataset], Reading]] = {
    "stride": lambda data: Reading(float(strides(data)[-1])),
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
    "frequency_slope": _slope("frequency"),
    "strain_slope": _slope("mu_3_most"),
}
"""Read-outs by the name that a row gives."""
