"""Every case of the thesis has the inputs that the thesis prints."""

import functools
import re
from typing import get_args

import numpy as np
import pytest
from conftest import ROOT, base_of

import cosserat
from cosserat.studies.door import find_study, published_studies
from cosserat.thesis import earthworm
from cosserat.thesis.table import printed
from cosserat.thesis.table.errata import read_errata

CHAPTER_2, CHAPTER_3 = (
    re.findall(
        r"^\[([a-z]\w*)\]", (ROOT / f"cosserat/thesis/cases/{name}.toml").read_text(), flags=re.MULTILINE
    )
    for name in ("chapter2", "chapter3")
)
UNPRINTED_CASES = {
    "stretched": "a shape of our choice; its rod is held by the four problems that it is like",
    "sheared": "as the one before",
    "inflated": "as the one before",
    "bent_rod": "a shape to draw Figs. 3.1, 3.4 and 3.6 from, which have no numbers",
    "calibration": "its four problems are held below",
    "convergence": "our own rod",
    "hanging_bar_consistent": "our own rod",
    "clamped_free_consistent": "our own rod",
    "clamped_clamped_consistent": "our own rod",
    "necking_consistent": "our own rod",
    "necking_plane_strain": "our own rod",
    "vibration_consistent": "our own rod",
    "tumbling": "our own rod",
    "elastica": "our own rod",
    "roll_up": "our own rod",
    "column_path": "our own rod",
    "arch_path": "our own rod",
    "cone": "a rod of our choice, like a published one",
    "two_materials": "as the one before",
    "two_materials_consistent": "our own rod",
    "low_centreline": "a centreline of our choice",
    "low_centreline_consistent": "our own rod",
    "couple": "a load of our choice",
    "turned_support": "our own rod",
    "hook": "a reference of our choice",
    "hook_printed": "as the one before",
}
"""Cases of Chapter 3 that do not claim to be the thesis's, and what they are."""


def at(table, place):
    """What a case holds at a place such as "forces.0.force"."""
    for key in place.split("."):
        table = table[int(key)] if isinstance(table, list | tuple) else table[key]
    return table


@functools.cache
def inputs_of(name):
    """The inputs of a case, or of the one that a study varies with the values of its keys."""
    if name not in published_studies():
        return cosserat.case(name).problem.model_dump()
    found = find_study(name)
    (factor,) = found.factors
    varied = {key.path: list(own) for key, own in zip(factor.keys, factor.values, strict=True)}
    return found.base.problem.model_dump() | varied


def plain(value):
    """Tuples as lists, as TOML has them."""
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return {key: plain(item) for key, item in value.items()} if isinstance(value, dict) else value


def flat(table, defaults, prefix=""):
    """Places of a case that are not at their default, down to numbers."""
    for key, value in table.items():
        field = defaults.get(key)
        if field is not None and not field.is_required() and value == plain(field.default):
            continue
        if isinstance(value, dict):
            inner = fields_of(field.annotation, value) if field is not None else {}
            yield from flat(value, inner, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}"


def fields_of(annotation, value):
    """The keys that the class of a table has, of several classes the one of its `kind`."""
    if hasattr(annotation, "model_fields"):
        kind = annotation.model_fields.get("kind")
        return annotation.model_fields if kind is None or value.get("kind") == kind.default else {}
    return next((found for part in get_args(annotation) if (found := fields_of(part, value))), {})


def holds(held, value):
    """A number to rounding; of a table only the keys that the thesis gives."""
    if isinstance(held, float):
        return value == pytest.approx(held, rel=1e-12)
    if isinstance(held, list) and len(held) == len(value):
        return all(map(holds, held, value))
    if isinstance(held, dict):
        return all(value[key] == inner for key, inner in held.items())
    return value == held


@pytest.mark.parametrize(
    ("name", "place"), [(n, p) for n, held in printed.PRINTED.items() for p in held]
)
def test_a_case_has_the_printed_input(name, place):
    held = printed.PRINTED[name][place]
    value = plain(at(inputs_of(name), place))
    assert holds(held.plain, value), f"{name}: {place} is {value}, {held.where} prints {held.value}"


@pytest.mark.parametrize("name", printed.PRINTED)
def test_all_other_inputs_of_a_case_of_the_thesis_are_defaults(name):
    """An input beyond those of the thesis would have no check."""
    problem = (base_of(name) if name in published_studies() else cosserat.case(name)).problem
    table = plain(problem.model_dump())
    said = [
        place
        for place in flat(table, type(problem).model_fields)
        if not place.endswith("kind")
        and place.removeprefix("worm.").split(".")[0] not in printed.SOLVER_KEYS
    ]
    held = printed.PRINTED[name]
    assert [p for p in said if not any(h == p or h.startswith(f"{p}.") for h in held)] == []


def test_every_case_of_chapter_3_has_printed_inputs_or_a_reason():
    assert set(printed.CHAPTER_3) | set(UNPRINTED_CASES) == set(CHAPTER_3)
    assert not set(printed.CHAPTER_3) & set(UNPRINTED_CASES)


def test_every_case_of_chapter_2_has_printed_inputs():
    assert set(printed.CHAPTER_2) == set(CHAPTER_2)


def test_inputs_of_chapter_2_follow_from_the_numbers_behind_them():
    """A cycle by (2.7.1) and (2.7.2), loads as shares of their peaks, the worm by Table 2.1."""

    def robot(place):
        return printed.number("soft_robot", place)

    def worm(place):
        return printed.number("worm", place)

    through, fraction = robot("crawler.length") / robot("v"), robot("T")
    alone = (1 - fraction) * through
    phases = printed.PRINTED["soft_robot"]["gait.phases"].plain
    assert phases == pytest.approx([robot("t_pause"), alone, fraction * through, alone])
    assert sum(phases) == pytest.approx(robot("t_pause") + through * (2 - fraction))
    assert printed.PRINTED["soft_robot"]["gait.gamma"].plain[0][1] == [2, fraction]
    assert robot("crawler.length") == pytest.approx(robot("l_0 in inches"))
    assert robot("loads.advancing") == pytest.approx(robot("p in psi"), abs=5)
    assert worm("loads.anchoring") == pytest.approx(worm("share of D_peak") * worm("D_peak"), rel=1e-12)
    assert worm("loads.advancing") == pytest.approx(worm("share of p_peak") * worm("p_peak"), rel=1e-12)
    assert 2 * worm("crawler.radius") == pytest.approx(worm("2R"))
    assert np.pi * worm("2R") == pytest.approx(worm("circumference"), abs=5e-6)
    assert pytest.approx(1 - worm("segment 50")) == earthworm.SEGMENT_50
    assert worm("strip") == earthworm.STRIP_WIDTH
    assert pytest.approx(worm("T_long") * 9.80665e-3) == earthworm.STRIP_TENSION


@pytest.mark.parametrize("grams", [0.01, 1.0, 10.0])
def test_table_2_1_is_that_of_the_page_at_every_mass(grams):
    """The eight numbers of Table 2.1, written a second time."""
    mass = 1e-3 * grams
    assert earthworm.stance_time(mass) == pytest.approx(1.6 * grams**0.04)
    assert earthworm.protrusion_time(mass) == pytest.approx(2.5 * grams**0.1)
    assert earthworm.resting_length(mass) == pytest.approx(1e-3 * 10**2 * grams**0.397)
    assert earthworm.resting_diameter(mass) == pytest.approx(1e-3 * 10**0.6 * grams**0.278)


def test_the_calibration_is_of_the_four_problems_at_the_published_mesh():
    procedure = base_of("calibration").problem
    for name in ("hanging_bar", "clamped_free", "clamped_clamped", "necking"):
        assert getattr(procedure, name) == cosserat.case(name).problem
    assert procedure.vertices == printed.number("necking", "rod.vertices")


def test_assumed_inputs_are_assumptions_or_questions_of_the_errata():
    errata = read_errata(ROOT / "results/errata.toml")
    for held in printed.PRINTED.values():
        for place, given in held.items():
            if given.assumed:
                standing = errata[given.assumed].standing
                assert standing in ("assumption", "question"), f"{place}: {given.assumed} is {standing}"


def test_the_closed_forms_take_the_printed_rectangle():
    """I = W H^3 / 12, written a second time: neither from the rod nor from the solved case."""
    beam = printed.beam("clamped_free")
    assert beam.second_moment == pytest.approx(0.5 * 0.5**3 / 12)
    assert beam.bending_stiffness == pytest.approx(1e9 * 0.0625 / 12)
    assert printed.beam("necking").poisson == 0.3


def test_the_closed_form_of_the_robot_takes_the_printed_round_rod():
    """Stiffnesses of E = 10 kPa, nu = 0.3, R = 2.54 cm by (2.6.20), typed out: 27.3 N, 11.7 N and 1.26 mN m^2."""
    rod = printed.push_pull_rod()
    assert (rod.k_s, rod.k_p, rod.k_g) == pytest.approx((27.284, 11.693, 1.25733e-3), rel=1e-4)
    assert (rod.weight, rod.anchoring, rod.advancing) == pytest.approx((19.883, 1, 13.965), rel=1e-4)
