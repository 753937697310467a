"""Inputs printed in Chapter 2 of the thesis; see `cosserat.thesis.table.printed`."""

from __future__ import annotations

from collections.abc import Mapping

from cosserat.thesis.table.given import Input, Inputs

_ROBOT_INPUTS = "eq. (2.7.3)"
_PUSH_PULL = "eqs. (2.7.1), (2.7.2)"
_IN_RESULTS = "section 2.8, Results"
_IN_ANTICIPATED_OUTCOMES = "section 2.8, Anticipated outcomes"

_G_2 = Input("9.81 m/s^2", "section 3.5; Chapter 2 gives none", "m/s^2", "E2.22")

_ROBOT: Inputs = {
    "crawler.length": Input("25.4 cm", _ROBOT_INPUTS, "m"),
    "crawler.radius": Input("2.54 cm", _ROBOT_INPUTS, "m"),
    "crawler.density": Input("1 g/cm^3", _ROBOT_INPUTS, "kg/m^3"),
    "crawler.mass": Input(None, _ROBOT_INPUTS),
    "crawler.material.kind": Input(
        "compressible", "section 2.7, 'the equations developed in Section 2.3'"
    ),
    "crawler.material.young": Input("10 kPa", _ROBOT_INPUTS, "Pa"),
    "crawler.material.poisson": Input("0.3", _ROBOT_INPUTS, "1"),
    "crawler.material.bulk": Input(None, _ROBOT_INPUTS),
    "loads.anchoring": Input("1 N", _ROBOT_INPUTS, "N"),
    "loads.advancing": Input("6.89 kPa", _ROBOT_INPUTS, "Pa"),
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
    "crawler.material.young": Input("2 kPa", _IN_RESULTS, "Pa"),
    "loads.anchoring": Input("26.16 mN", f"{_IN_RESULTS}, 0.6 of (2.8.3)", "N"),
    "loads.advancing": Input("1356.6 Pa", f"{_IN_RESULTS}, 0.238 of (2.8.2)", "Pa"),
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
_EARLY_SWITCH: Inputs = {
    "gait.anchor": Input(
        [[[0, 0.75], [1 / 3, 0.5]], [[1 / 3, 0], [1, 0]], [[1, 1], [2, 1]]], "Fig. 2.1", assumed="E2.17"
    )
}
_PRINTED_CONTACT: Inputs = {"loads.contact": Input("printed", "eq. (2.2.20)")}
_PRINTED_EQUATIONS: Inputs = {**_PRINTED_CONTACT, "loads.multiplier": Input("printed", "eq. (2.4.18)")}
_STOPPED_FRONTS: Inputs = {
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
        "0 N", f"{_IN_ANTICIPATED_OUTCOMES}, 'under the deformation of the worm's own weight'", "N"
    ),
    "loads.advancing": Input(
        "0 Pa", f"{_IN_ANTICIPATED_OUTCOMES}, 'under the deformation of the worm's own weight'", "Pa"
    ),
    "loads.gravity": _G_2,
    "regions": Input([{"begin": 0, "end": 1, "load": "anchoring"}], "one region, without a load"),
}


def _as_worm(worm: Inputs) -> Inputs:
    """Inputs of a worm within another case."""
    return {f"worm.{place}": given for place, given in worm.items()}


_MASSES: Inputs = {
    **_as_worm(_WORM),
    "body_mass": Input(
        [1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2], "the range of the thesis's reference [50]"
    ),
    "muscles": Input("constant stress", "section 2.8, 'irrespective of body mass'", assumed="E2.13"),
}
_CALIBRATION_TARGETS: Inputs = {
    "mu_1_ratio": Input("0.75", "eq. (2.8.6)", "1"),
    "mu_3_ratio": Input("1.60", "eq. (2.8.6)", "1"),
    "p_longitudinal": Input("0.3 kPa", _IN_ANTICIPATED_OUTCOMES, "Pa"),
    "p_circular": Input("0.8 kPa", _IN_ANTICIPATED_OUTCOMES, "Pa"),
}

CHAPTER_2: Mapping[str, Inputs] = {
    "soft_robot": _ROBOT,
    "soft_robot_printed_contact": {**_ROBOT, **_PRINTED_CONTACT},
    "soft_robot_reference": _ROBOT,
    "soft_robot_held": {
        **_ROBOT,
        "loads.advancing_force": Input("continuous", "eq. (2.4.14)", assumed="E2.10"),
    },
    "worm": _WORM,
    "worm_early": {**_WORM, **_EARLY_SWITCH},
    "worm_printed": {**_WORM, **_PRINTED_EQUATIONS},
    "worm_printed_early": {**_WORM, **_PRINTED_EQUATIONS, **_EARLY_SWITCH},
    "worm_balanced": {**_WORM, **_PRINTED_CONTACT},
    "worm_balanced_early": {**_WORM, **_PRINTED_CONTACT, **_EARLY_SWITCH},
    "worm_clipped": {**_WORM, **_STOPPED_FRONTS},
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
        "body_mass": Input([2e-3, 3e-3, 5e-3, 7e-3, 1e-2], "where the worm can stay on the ground"),
        "muscles": Input("strip tension", "eqs. (2.8.1), (2.8.3)", assumed="E2.13"),
    },
    "worm_calibration": {**_as_worm(_WORM), **_CALIBRATION_TARGETS},
    "worm_calibration_printed": {**_as_worm({**_WORM, **_PRINTED_EQUATIONS}), **_CALIBRATION_TARGETS},
}
"""Inputs of the cases of Chapter 2 by case; all cases are those of the thesis."""

INPUT_SOURCES: Mapping[str, Inputs] = {
    "soft_robot": {
        "l_0 in inches": Input("10 in", "Fig. 2.8", "m"),
        "p in psi": Input("1 psi", _ROBOT_INPUTS, "Pa"),
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
        "share of D_peak": Input("0.6", _IN_RESULTS, "1"),
        "share of p_peak": Input("0.238", _IN_RESULTS, "1"),
        "T_long": Input("0.186", "eq. (2.8.1), in gram-force", "1"),
        "T_circ": Input("0.3", "eq. (2.8.1), in gram-force", "1"),
        "strip": Input("1 mm", "before eq. (2.8.1)", "m"),
        "segment 50": Input("2/5", "after eq. (2.8.6), from the anterior end", "1"),
    },
}
"""Printed numbers from which inputs of a case follow."""
