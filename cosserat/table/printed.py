"""What the thesis prints as inputs of Chapters 2 and 3: the one second copy of its numbers that the project allows.

The case files hold the same numbers, and a test holds each case of the thesis to this module.  Closed forms that rows
are judged by take their beams and loads from here, never from the case that was solved: where a case has another
modulus than the page, its answer moves and what is expected does not.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cosserat.analytic import Beam, PushPullRod
from cosserat.parameters import to_si


@dataclass(frozen=True)
class Input:
    """One input as the page gives it.

    value : a number as printed, with its unit; or what a sentence says (a direction, what a support holds).
    where : the place.
    unit : SI unit of a number, "1" for a ratio; empty for all else.
    assumed : where the page is silent or ambiguous, the entry of the errata that says what we take.
    """

    value: object
    where: str
    unit: str = ""
    assumed: str = ""

    @property
    def si(self) -> float:
        """The number in its SI unit."""
        return to_si(self.value, self.unit, unit_required=False)

    @property
    def plain(self) -> object:
        """What a case must hold: the number in its SI unit, or the value itself."""
        return self.si if self.unit else self.value


Inputs = Mapping[str, Input]
"""Inputs of a case by their place in it, such as "rod.length"."""

# --------------------------------------------------------------------------------------------------- Chapter 3

_FOUR = "section 3.5, 'In all four problems'"
_VIBRATION = "section 3.5, after eq. (3.5.16)"
_CLAMP = ["x3", "x2", "d3", "d2"]

_ROD: Inputs = {
    "rod.energy": Input("published", "eq. (3.4.11)"),
    "rod.vertices": Input("20", _FOUR, "1"),
    "rod.length": Input("5 m", _FOUR, "m"),
    "rod.height": Input("0.5 m", _FOUR, "m"),
    "rod.width": Input("0.5 m", _FOUR, "m"),
    "rod.young": Input("1 GPa", _FOUR, "Pa"),
    "rod.poisson": Input("0", "section 3.5, 'zero Poisson's ratio everywhere'", "1"),
    "rod.line_density": Input("250 kg/m", _FOUR, "kg/m"),
    "rod.shear_correction": Input("5/6", "section 3.5, A necking problem", "1", "E3.17"),
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

_G = Input("9.81 m/s^2", _FOUR, "m/s^2")
_LEFT = [{"at": "first", "hold": _CLAMP}]

_HANGING_BAR: Inputs = {
    **_ROD,
    "gravity.g": _G,
    "gravity.along": Input("E3", _FOUR),
    "supports": Input(
        [{"at": "first", "hold": ["x3", "x2", "d3"]}], "section 3.5, 'u . E3 = 0'", assumed="E3.16"
    ),
}
_CLAMPED_FREE: Inputs = {
    **_ROD,
    "gravity.g": _G,
    "gravity.along": Input("-E2", _FOUR),
    "supports": Input(_LEFT, "section 3.5, A clamped-free and clamped-clamped Timoshenko beam"),
}
_CLAMPED_CLAMPED: Inputs = {
    **_CLAMPED_FREE,
    "supports": Input([*_LEFT, {"at": "last", "hold": _CLAMP}], "section 3.5, before eq. (3.5.6)"),
}
_NECKING: Inputs = {
    **_ROD,
    "rod.poisson": Input("0.3", "section 3.5, before eq. (3.5.8)", "1"),
    "rod.shear_correction": Input("5/6", "section 3.5, A necking problem", "1"),
    "gravity": Input(None, _FOUR, assumed="E3.16"),
    "forces.0": Input({"at": "first", "along": "-E3"}, "section 3.5, (iv)", assumed="E3.16"),
    "forces.0.force": Input("1 kN", "section 3.5, before eq. (3.5.8)", "N"),
    "forces.1": Input({"at": "last", "along": "E3"}, "section 3.5, (iv)", assumed="E3.16"),
    "forces.1.force": Input("1 kN", "section 3.5, before eq. (3.5.8)", "N"),
    "supports": Input(
        [*_LEFT, {"at": "last", "hold": ["d3", "d2"]}], "section 3.5, A necking problem", assumed="E3.16"
    ),
}
_VIBRATING: Inputs = {
    **_ROD,
    "rod.length": Input("1 m", _VIBRATION, "m"),
    "rod.width": Input("0.1 m", _VIBRATION, "m"),
    "rod.height": Input("0.1 m", _VIBRATION, "m", "E3.19"),
    "rod.shear_correction": Input("5/6", _VIBRATION, "1"),
    "rod.line_density": Input("10 kg/m", f"{_VIBRATION}: 10^3 times the area", "kg/m", "E3.19"),
    "supports": Input(_LEFT, "section 3.5, 'clamped-free'"),
    "gravity": Input(None, _VIBRATION, assumed="E3.19"),
    "start.shape": Input("first beam mode", "section 3.5, 'in its first mode shape'"),
    "start.amplitude": Input("1 cm", "not given", "m", "E3.19"),
}
_DAMPED: Inputs = {"damping": Input("1", "section 3.5, 'towards critical damping'", "1", "E3.22")}
_K_1: Inputs = {
    "rod.shear_correction": Input("1", "given for no beam of the four problems", "1", "E3.17")
}
_HALVED: Inputs = {"rod.end_sections": Input("halved", "eq. (3.4.10)")}

CHAPTER_3: Mapping[str, Inputs] = {
    "hanging_bar": _HANGING_BAR,
    "clamped_free": _CLAMPED_FREE,
    "clamped_free_ends_halved": {**_CLAMPED_FREE, **_HALVED},
    "clamped_free_k_1": {**_CLAMPED_FREE, **_K_1},
    "clamped_free_k_1_ends_halved": {**_CLAMPED_FREE, **_K_1, **_HALVED},
    "clamped_clamped": _CLAMPED_CLAMPED,
    "clamped_clamped_ends_halved": {**_CLAMPED_CLAMPED, **_HALVED},
    "clamped_clamped_k_1": {**_CLAMPED_CLAMPED, **_K_1},
    "clamped_clamped_k_1_ends_halved": {**_CLAMPED_CLAMPED, **_K_1, **_HALVED},
    "necking": _NECKING,
    "necking_printed": {**_NECKING, "rod.poisson_coupling": Input("printed", "eq. (3.4.11)")},
    "vibration_c4_2": {**_VIBRATING, "rod.calibration.c4": Input("2.0", _VIBRATION, "1")},
    "vibration_c4_20": {**_VIBRATING, "rod.calibration.c4": Input("20", "Fig. 3.13", "1", "E3.19")},
    "relaxing_hanging_bar": {**_HANGING_BAR, **_DAMPED},
    "relaxing_clamped_free": {**_CLAMPED_FREE, **_DAMPED},
    "relaxing_clamped_clamped": {**_CLAMPED_CLAMPED, **_DAMPED},
    "relaxing_necking": {**_NECKING, **_DAMPED},
}
"""Inputs of the cases of Chapter 3 that are the thesis's, by case."""

# --------------------------------------------------------------------------------------------------- Chapter 2

_ROBOT_S = "eq. (2.7.3)"
_PUSH_PULL = "eqs. (2.7.1), (2.7.2)"
_RESULTS = "section 2.8, Results"
_MEASURED = "section 2.8, Anticipated outcomes"

_G_2 = Input("9.81 m/s^2", "section 3.5; Chapter 2 gives none", "m/s^2", "E2.22")

_ROBOT: Inputs = {
    "crawler.length": Input("25.4 cm", _ROBOT_S, "m"),
    "crawler.radius": Input("2.54 cm", _ROBOT_S, "m"),
    "crawler.density": Input("1 g/cm^3", _ROBOT_S, "kg/m^3"),
    "crawler.mass": Input(None, _ROBOT_S),
    "crawler.material.kind": Input(
        "compressible", "section 2.7, 'the equations developed in Section 2.3'"
    ),
    "crawler.material.young": Input("10 kPa", _ROBOT_S, "Pa"),
    "crawler.material.poisson": Input("0.3", _ROBOT_S, "1"),
    "crawler.material.bulk": Input(None, _ROBOT_S),
    "loads.anchoring": Input("1 N", _ROBOT_S, "N"),
    "loads.advancing": Input("6.89 kPa", _ROBOT_S, "Pa"),
    "loads.gravity": _G_2,
    "loads.contact": Input("weight", "eq. (2.2.20), corrected"),
    "loads.advancing_force": Input(None, "eq. (2.3.7)"),
    "gait.phases": Input([5.0, 7.5, 2.5, 7.5], _PUSH_PULL),
    "gait.gamma": Input([[[1, 1], [2, 0.25], [3, 0]]], _PUSH_PULL),
    "gait.eta": Input([[[2, 1], [3, 0.75], [4, 0]]], _PUSH_PULL),
    "gait.anchor": Input([[[0, 0], [2, 0]], [[2, 1], [4, 1]]], "section 2.7", assumed="E2.16"),
    "gait.at_rest": Input("anchoring", "section 2.7, 'fully longitudinally contracted'"),
}
_WORM: Inputs = {
    "crawler.length": Input("250 mm", "Table 2.1", "m"),
    "crawler.radius": Input("7.6/2 mm", "Table 2.1, 2R", "m"),
    "crawler.mass": Input("10 g", "section 2.8", "kg"),
    "crawler.density": Input(None, "section 2.8", assumed="E2.22"),
    "crawler.material.kind": Input("incompressible", "section 2.8, eq. (2.8.8)"),
    "crawler.material.young": Input("2 kPa", _RESULTS, "Pa"),
    "loads.anchoring": Input("26.16 mN", f"{_RESULTS}, 0.6 of (2.8.3)", "N"),
    "loads.advancing": Input("1356.6 Pa", f"{_RESULTS}, 0.238 of (2.8.2)", "Pa"),
    "loads.gravity": _G_2,
    "loads.contact": Input("weight", "eq. (2.2.20), corrected"),
    "loads.multiplier": Input("balanced", "eq. (2.4.18), corrected"),
    "loads.advancing_force": Input(None, "eq. (2.4.14)"),
    "gait.phases": Input([3.15, 1.75], "Table 2.1"),
    "gait.gamma": Input([[[0, 1], [0.5, 0.75], [1, 0.5], [2, 0]]], "section 2.8", assumed="E2.15"),
    "gait.eta": Input([[[0, 0.5], [0.5, 0]], [[1, 1], [2, 0.5]]], "section 2.8"),
    "gait.anchor": Input(
        [[[0, 0.75], [0.5, 0.375]], [[0.5, 0], [1, 0]], [[1, 1], [2, 1]]], "section 2.8", assumed="E2.17"
    ),
}
_EARLY: Inputs = {
    "gait.anchor": Input(
        [[[0, 0.75], [1 / 3, 0.5]], [[1 / 3, 0], [1, 0]], [[1, 1], [2, 1]]], "Fig. 2.1", assumed="E2.17"
    )
}
_CONTACT: Inputs = {"loads.contact": Input("printed", "eq. (2.2.20)")}
_AS_PRINTED: Inputs = {**_CONTACT, "loads.multiplier": Input("printed", "eq. (2.4.18)")}
_CLIPPED: Inputs = {
    "gait.gamma": Input(
        [[[0, 0.98], [0.04, 0.98], [0.5, 0.75], [1, 0.5], [1.96, 0.02], [2, 0.02]]],
        "section 2.8 and after eq. (2.5.9)",
        assumed="E2.14",
    ),
    "gait.eta": Input(
        [[[0, 0.5], [0.48, 0.02], [0.5, 0.02]], [[1, 0.98], [1.04, 0.98], [2, 0.5]]],
        "section 2.8 and after eq. (2.5.9)",
        assumed="E2.14",
    ),
    "gait.sudden": Input("0.05", "after eq. (2.5.9)", "1", "E2.14"),
}
_AT_REST: Inputs = {
    **{place: given for place, given in _WORM.items() if place.startswith("crawler")},
    "loads.anchoring": Input(
        "0 N", f"{_MEASURED}, 'under the deformation of the worm's own weight'", "N"
    ),
    "loads.advancing": Input(
        "0 Pa", f"{_MEASURED}, 'under the deformation of the worm's own weight'", "Pa"
    ),
    "loads.gravity": _G_2,
    "regions": Input([{"begin": 0, "end": 1, "load": "anchoring"}], "one region, without a load"),
}


def _as_worm(worm: Inputs) -> Inputs:
    """Inputs of a worm that is a part of another case."""
    return {f"worm.{place}": given for place, given in worm.items()}


_MASSES: Inputs = {
    **_as_worm(_WORM),
    "masses": Input(
        [1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2], "the range of the page's reference [50]"
    ),
    "muscles": Input("constant stress", "section 2.8, 'irrespective of body mass'", assumed="E2.13"),
}
_TARGETS: Inputs = {
    "mu_1_ratio": Input("0.75", "eq. (2.8.6)", "1"),
    "mu_3_ratio": Input("1.60", "eq. (2.8.6)", "1"),
    "p_longitudinal": Input("0.3 kPa", _MEASURED, "Pa"),
    "p_circular": Input("0.8 kPa", _MEASURED, "Pa"),
}

CHAPTER_2: Mapping[str, Inputs] = {
    "soft_robot": _ROBOT,
    "soft_robot_printed_contact": {**_ROBOT, **_CONTACT},
    "soft_robot_reference": _ROBOT,
    "soft_robot_held": {
        **_ROBOT,
        "loads.advancing_force": Input("continuous", "eq. (2.4.14)", assumed="E2.10"),
    },
    "worm": _WORM,
    "worm_early": {**_WORM, **_EARLY},
    "worm_printed": {**_WORM, **_AS_PRINTED},
    "worm_printed_early": {**_WORM, **_AS_PRINTED, **_EARLY},
    "worm_balanced": {**_WORM, **_CONTACT},
    "worm_balanced_early": {**_WORM, **_CONTACT, **_EARLY},
    "worm_clipped": {**_WORM, **_CLIPPED},
    "worm_released": {**_WORM, "loads.advancing_force": Input("none", "eq. (2.3.7)", assumed="E2.10")},
    "worm_reference": _WORM,
    "worm_at_rest": _AT_REST,
    "worm_masses": _MASSES,
    "worm_masses_constant_pressure": {
        **_MASSES,
        "muscles": Input("strip tension, constant pressure", "eqs. (2.8.2), (2.8.3)", assumed="E2.13"),
    },
    "worm_masses_strip": {
        **_MASSES,
        "masses": Input([2e-3, 3e-3, 5e-3, 7e-3, 1e-2], "where the worm can stay on the ground"),
        "muscles": Input("strip tension", "eqs. (2.8.1), (2.8.3)", assumed="E2.13"),
    },
    "worm_calibration": {**_as_worm(_WORM), **_TARGETS},
    "worm_calibration_printed": {**_as_worm({**_WORM, **_AS_PRINTED}), **_TARGETS},
}
"""Inputs of the cases of Chapter 2, all of which are the thesis's, by case."""

BEHIND: Mapping[str, Inputs] = {
    "soft_robot": {
        "l_0 in inches": Input("10 in", "Fig. 2.8", "m"),
        "p in psi": Input("1 psi", _ROBOT_S, "Pa"),
        "v": Input("2.54 cm/s", "Fig. 2.8", "m/s"),
        "t_pause": Input("5 s", "Fig. 2.8", "s"),
        "t_step": Input("0.01 s", "Fig. 2.8", "s"),
        "T": Input("0.25", "Fig. 2.8 and before eq. (2.7.2)", "1"),
    },
    "worm": {
        "2R": Input("7.6 mm", "Table 2.1", "m"),
        "circumference": Input("23.88 mm", "before eq. (2.8.2)", "m"),
        "D_peak": Input("43.6 mN", "eq. (2.8.3)", "N"),
        "p_peak": Input("5.7 kPa", "eq. (2.8.2)", "Pa"),
        "share of D_peak": Input("0.6", _RESULTS, "1"),
        "share of p_peak": Input("0.238", _RESULTS, "1"),
        "T_long": Input("0.186", "eq. (2.8.1), in gram-force", "1"),
        "T_circ": Input("0.3", "eq. (2.8.1), in gram-force", "1"),
        "strip": Input("1 mm", "before eq. (2.8.1)", "m"),
        "segment 50": Input("2/5", "after eq. (2.8.6), from the anterior end", "1"),
    },
}
"""Printed numbers that are inputs of no case themselves; inputs are made of them."""

PRINTED: Mapping[str, Inputs] = {**CHAPTER_2, **CHAPTER_3}
"""Both."""

OURS = (
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
"""Keys of a case that say how it is solved and what is stored, on which the page says nothing."""


def number(case: str, place: str) -> float:
    """A printed number in its SI unit: of a case ("necking", "forces.1.force"), or one that inputs are made of."""
    given = PRINTED[case].get(place) or BEHIND[case][place]
    return given.si


@functools.cache
def beam(case: str) -> Beam:
    """The beam of a case of Chapter 3 as the closed forms know it; I = W H^3 / 12 of the printed rectangle."""
    wide, high = number(case, "rod.width"), number(case, "rod.height")
    return Beam(
        length=number(case, "rod.length"),
        area=wide * high,
        second_moment=wide * high**3 / 12,
        young=number(case, "rod.young"),
        poisson=number(case, "rod.poisson"),
        line_density=number(case, "rod.line_density"),
        shear_correction=number(case, "rod.shear_correction"),
    )


def push_pull_rod() -> PushPullRod:
    """The soft robot as its closed form knows it, the stiffnesses by eq. (2.6.20) of the printed E, nu and R."""
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
