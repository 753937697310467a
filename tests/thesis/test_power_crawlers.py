"""The rows of Chapter 2 notice changes: the quick part of `cosserat power`."""

import pytest
from conftest import ROOT

import cosserat
from cosserat.studies.door import published_studies
from cosserat.thesis.table import printed
from cosserat.thesis.table.power import notices
from cosserat.thesis.table.power_crawlers import (
    AT_REST,
    BODY_MASSES,
    CALIBRATIONS,
    CHANGES,
    READINGS,
    ROBOT,
    WORM,
)
from cosserat.thesis.table.tolerances import read_table

ROWS = read_table(ROOT / "results/tolerances.csv")
QUICK = [
    "robot: E x 1.01",
    "robot: g x 1.01",
    "robot: v x 2",
    "robot: mu_3 of (2.3.10) as printed",
    "robot: k_G x 1.01",
    "worm at rest: m x 1.01",
    "worm: dy9 of (2.4.18) corrected",
    "worm: (2.2.20) as printed",
    "worm: section 2.3's junctions",
]


@pytest.mark.parametrize("what", QUICK)
def test_a_change_of_a_crawler_is_noticed_or_has_a_reason(what):
    change = next(change for change in CHANGES if change.what == what)
    assert notices(change, ROWS).sound


@pytest.mark.parametrize(
    "case", ["soft_robot", "worm", "worm_at_rest", "worm_masses", "worm_calibration"]
)
def test_every_printed_number_of_a_case_is_changed_once(case):
    """This includes the gait.  The inputs of a worm within another case are changed in the case of that worm."""
    changed = {place for change in CHANGES if case in change.cases for place in change.places}
    numbers = {
        place
        for place, held in printed.PRINTED[case].items()
        if held.unit or place.startswith("gait")
        if not held.unit or held.si != 0  # of muscles at rest there is nothing to scale
    }
    assert numbers - changed - {"gait.at_rest"} == set()


def test_changed_inputs_are_of_the_thesis_and_have_distinct_names():
    names = [change.what for change in CHANGES]
    assert len(set(names)) == len(names) > 50
    asked = {case for change in CHANGES for case in change.cases}
    assert asked == {*ROBOT, *WORM, *READINGS, *AT_REST, *BODY_MASSES, *CALIBRATIONS}
    assert asked <= {*cosserat.published(), *published_studies()}
    for case in asked:
        assert any(row.case == case for row in ROWS)
