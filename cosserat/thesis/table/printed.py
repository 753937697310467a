"""Inputs printed in Chapters 2 and 3 of the thesis: the only second copy of its numbers in the project.

The case files hold the same numbers, and a test compares each case of the thesis with this module.  Closed forms for
rows take their beams and loads from here, never from the solved case: if a case has another modulus than the thesis,
its answer changes and the expected number does not.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping

import numpy as np

from cosserat.exact.beams import Beam, PushPullRod
from cosserat.thesis.table.given import Input, Inputs
from cosserat.thesis.table.printed_crawlers import CHAPTER_2, INPUT_SOURCES

# --------------------------------------------------------------------------------------------------- Chapter 3

_IN_ALL_FOUR = "section 3.5, 'In all four problems'"
_IN_VIBRATION = "section 3.5, after eq. (3.5.16)"
_CLAMP = ["x3", "x2", "d3", "d2"]

_ROD: Inputs = {
    "rod.energy": Input("published", "eq. (3.4.11)"),
    "rod.vertices": Input("20", _IN_ALL_FOUR, "1"),
    "rod.length": Input("5 m", _IN_ALL_FOUR, "m"),
    "rod.section.shape": Input("rectangle", _IN_ALL_FOUR),
    "rod.section.height": Input("0.5 m", _IN_ALL_FOUR, "m"),
    "rod.section.width": Input("0.5 m", _IN_ALL_FOUR, "m"),
    "rod.material.young": Input("1 GPa", _IN_ALL_FOUR, "Pa"),
    "rod.material.poisson": Input("0", "section 3.5, 'zero Poisson's ratio everywhere'", "1"),
    "rod.material.line_density": Input("250 kg/m", _IN_ALL_FOUR, "kg/m"),
    "rod.section.shear_factor": Input("5/6", "section 3.5, A necking problem", "1", "E3.17"),
    "rod.calibration.c1": Input("1/2", "Fig. 3.9", "1"),
    "rod.calibration.c2": Input("1/2", "Fig. 3.12", "1"),
    "rod.calibration.c3": Input("0.99", "Fig. 3.10", "1"),
    "rod.calibration.c4": Input("2.01", "Fig. 3.10", "1"),
    "rod.calibration.c5": Input("1", "Fig. 3.10", "1"),
    "rod.calibration.c6": Input("1/2", "Fig. 3.12", "1"),
    "rod.calibration.c7": Input("1.66", "Fig. 3.12", "1"),
    "rod.end_sections": Input("full", "eq. (3.4.10)", assumed="E3.9"),
    "rod.poisson_coupling": Input("halved", "eq. (3.4.11)", assumed="E3.2"),
}

_GRAVITY = Input("9.81 m/s^2", _IN_ALL_FOUR, "m/s^2")
_CLAMPED_FIRST = [{"at": "first", "fixed": _CLAMP}]

_HANGING_BAR: Inputs = {
    **_ROD,
    "gravity.g": _GRAVITY,
    "gravity.along": Input("E3", _IN_ALL_FOUR),
    "supports": Input(
        [{"at": "first", "fixed": ["x3", "x2", "d3"]}], "section 3.5, 'u . E3 = 0'", assumed="E3.16"
    ),
}
_CLAMPED_FREE: Inputs = {
    **_ROD,
    "gravity.g": _GRAVITY,
    "gravity.along": Input("-E2", _IN_ALL_FOUR),
    "supports": Input(_CLAMPED_FIRST, "section 3.5, A clamped-free and clamped-clamped Timoshenko beam"),
}
_CLAMPED_CLAMPED: Inputs = {
    **_CLAMPED_FREE,
    "supports": Input(
        [*_CLAMPED_FIRST, {"at": "last", "fixed": _CLAMP}], "section 3.5, before eq. (3.5.6)"
    ),
}
_NECKING: Inputs = {
    **_ROD,
    "rod.material.poisson": Input("0.3", "section 3.5, before eq. (3.5.8)", "1"),
    "rod.section.shear_factor": Input("5/6", "section 3.5, A necking problem", "1"),
    "gravity": Input(None, _IN_ALL_FOUR, assumed="E3.16"),
    "forces.0": Input({"at": "first", "along": "-E3"}, "section 3.5, (iv)", assumed="E3.16"),
    "forces.0.force": Input("1 kN", "section 3.5, before eq. (3.5.8)", "N"),
    "forces.1": Input({"at": "last", "along": "E3"}, "section 3.5, (iv)", assumed="E3.16"),
    "forces.1.force": Input("1 kN", "section 3.5, before eq. (3.5.8)", "N"),
    "supports": Input(
        [*_CLAMPED_FIRST, {"at": "last", "fixed": ["d3", "d2"]}],
        "section 3.5, A necking problem",
        assumed="E3.16",
    ),
}
_VIBRATING: Inputs = {
    **_ROD,
    "rod.length": Input("1 m", _IN_VIBRATION, "m"),
    "rod.section.width": Input("0.1 m", _IN_VIBRATION, "m"),
    "rod.section.height": Input("0.1 m", _IN_VIBRATION, "m", "E3.19"),
    "rod.section.shear_factor": Input("5/6", _IN_VIBRATION, "1"),
    "rod.material.line_density": Input(
        "10 kg/m", f"{_IN_VIBRATION}: 10^3 times the area", "kg/m", "E3.19"
    ),
    "supports": Input(_CLAMPED_FIRST, "section 3.5, 'clamped-free'"),
    "gravity": Input(None, _IN_VIBRATION, assumed="E3.19"),
    "start.shape": Input("first beam mode", "section 3.5, 'in its first mode shape'"),
    "start.amplitude": Input("1 cm", "not given", "m", "E3.19"),
}
_DAMPED: Inputs = {"damping.ratio": Input("1", "section 3.5, 'towards critical damping'", "1", "E3.22")}
_K_1: Inputs = {
    "rod.section.shear_factor": Input("1", "given for no beam of the four problems", "1", "E3.17")
}
_HALVED_ENDS: Inputs = {"rod.end_sections": Input("halved", "eq. (3.4.10)")}

CHAPTER_3: Mapping[str, Inputs] = {
    "hanging_bar": _HANGING_BAR,
    "clamped_free": _CLAMPED_FREE,
    "clamped_free_ends_halved": {**_CLAMPED_FREE, **_HALVED_ENDS},
    "clamped_free_k_1": {**_CLAMPED_FREE, **_K_1},
    "clamped_free_k_1_ends_halved": {**_CLAMPED_FREE, **_K_1, **_HALVED_ENDS},
    "clamped_clamped": _CLAMPED_CLAMPED,
    "clamped_clamped_ends_halved": {**_CLAMPED_CLAMPED, **_HALVED_ENDS},
    "clamped_clamped_k_1": {**_CLAMPED_CLAMPED, **_K_1},
    "clamped_clamped_k_1_ends_halved": {**_CLAMPED_CLAMPED, **_K_1, **_HALVED_ENDS},
    "necking": _NECKING,
    "necking_printed": {**_NECKING, "rod.poisson_coupling": Input("printed", "eq. (3.4.11)")},
    "vibration_c4_2": {**_VIBRATING, "rod.calibration.c4": Input("2.0", _IN_VIBRATION, "1")},
    "vibration_c4_20": {**_VIBRATING, "rod.calibration.c4": Input("20", "Fig. 3.13", "1", "E3.19")},
    "relaxing_hanging_bar": {**_HANGING_BAR, **_DAMPED},
    "relaxing_clamped_free": {**_CLAMPED_FREE, **_DAMPED},
    "relaxing_clamped_clamped": {**_CLAMPED_CLAMPED, **_DAMPED},
    "relaxing_necking": {**_NECKING, **_DAMPED},
}
"""Inputs of the cases of Chapter 3 that the thesis has, by case."""

PRINTED: Mapping[str, Inputs] = {**CHAPTER_2, **CHAPTER_3}
"""Inputs of the cases of both chapters, by case."""

SOLVER_KEYS = (
    "newton",
    "integrator",
    "duration",
    "every",
    "mesh",
    "tolerance",
    "solver",
    "collocation_tolerance",
    "sections",
    "strides",
    "step",
)
"""Keys of a case for the solver and the stored values, which the thesis does not give."""


def number(case: str, place: str) -> float:
    """A printed number in its SI unit: an input of a case ("necking", "forces.1.force"), or a source of inputs."""
    given = PRINTED[case].get(place) or INPUT_SOURCES[case][place]
    return given.si


@functools.cache
def beam(case: str) -> Beam:
    """The beam of a case of Chapter 3 for the closed forms; I = W H^3 / 12 of the printed rectangle."""
    wide, high = number(case, "rod.section.width"), number(case, "rod.section.height")
    return Beam(
        length=number(case, "rod.length"),
        area=wide * high,
        second_moment=wide * high**3 / 12,
        young=number(case, "rod.material.young"),
        poisson=number(case, "rod.material.poisson"),
        line_density=number(case, "rod.material.line_density"),
        shear_correction=number(case, "rod.section.shear_factor"),
    )


def push_pull_rod() -> PushPullRod:
    """The soft robot for its closed form, the stiffnesses by eq. (2.6.20) from the printed E, nu and R."""
    robot = functools.partial(number, "soft_robot")
    radius = robot("crawler.radius")
    area, poisson = np.pi * radius**2, robot("crawler.material.poisson")
    k_s = robot("crawler.material.young") * area * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
    return PushPullRod(
        k_s=k_s,
        k_p=poisson / (1 - poisson) * k_s,
        k_g=robot("crawler.material.young") * np.pi * radius**4 / (8 * (1 + poisson)),
        length=robot("crawler.length"),
        radius=radius,
        weight=robot("crawler.density") * area * robot("loads.gravity"),
        anchoring=robot("loads.anchoring"),
        advancing=robot("loads.advancing") * area,
    )
