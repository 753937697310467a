"""Rows of the results table notice changes of the rods; `cosserat power` runs the whole list."""

import pytest
from conftest import ROOT

from cosserat.cases.catalogue import find
from cosserat.cli import main
from cosserat.errors import InputError, OutOfToleranceError
from cosserat.thesis.table import power, power_rods
from cosserat.thesis.table.power import Change, edited, notices, table
from cosserat.thesis.table.printed import CHAPTER_3
from cosserat.thesis.table.tolerances import read_table

ROWS = read_table(ROOT / "results/tolerances.csv")


@pytest.mark.parametrize(
    "change",
    [
        change
        for change in power_rods.CHANGES
        if change.what.startswith(("large strains", "hanging bar", "necking"))
        or change.what in ("beams: E x 1.1", "beams: c4 x 1.02", "beams: mass of parts x 1.25")
        or change.what in ("calibration: E x 1.1", "calibration: L x 1.02")
    ],
    ids=lambda change: change.what,
)
def test_a_change_of_a_rod_at_rest_is_noticed_or_has_a_reason(change):
    noticed = notices(change, ROWS)
    assert noticed.sound, str(noticed)


def test_rows_of_the_thesis_and_of_the_consistent_rod_use_separate_cases():
    own = {row.case for row in ROWS if row.ours}
    assert not own & {row.case for row in ROWS if not row.ours}


def test_unchanged_cases_are_noticed_by_no_row():
    for cases in (power_rods.BAR, power_rods.BEAMS, power_rods.NECKING, power_rods.LARGE_STRAINS):
        assert notices(Change("nothing", cases), ROWS).rows == ()


def test_every_printed_number_of_chapter_3_is_among_the_changes():
    """Each printed input of a case of the thesis is changed somewhere, under the same name."""
    printed = {place for held in CHAPTER_3.values() for place, given in held.items() if given.unit}
    changed = {place for change in power_rods.CHANGES for place in change.places}
    assert printed - changed == {"damping.ratio"}  # of the way to rest, not of the rest


def test_every_row_that_reads_a_case_is_tried_by_some_change():
    asked = {case for change in power.changes() for case in change.cases}
    assert [row.id for row in ROWS if row.case and row.case not in asked] == []


def test_a_change_that_gives_a_bad_case_raises_an_error():
    with pytest.raises(InputError, match="'rod.material.young' is -1 Pa"):
        notices(Change("E", ("hanging_bar",), ("rod.material.young",), lambda _: -1.0), ROWS)


def test_a_change_changes_the_named_inputs_alone():
    change = Change("n", (), ("forces.0.force", "forces.1.force"), lambda force: 2 * force)
    case = find("necking")
    assert [force.force for force in edited(case, change).problem.forces] == [2e3, 2e3]
    assert edited(case, change).problem.rod == case.problem.rod
    assert edited(case, change).name == "necking"


def test_wrong_physics_is_removed_after_its_trial():
    from cosserat.rods.energies import hemingway_kernel

    kept = (hemingway_kernel.assemble, hemingway_kernel.stretching)
    with power_rods.quadratic_wells():
        assert hemingway_kernel.stretching is not kept[1]
    assert (hemingway_kernel.assemble, hemingway_kernel.stretching) == kept


@pytest.mark.parametrize(
    ("change", "noticed"),
    [
        (Change("nothing", ("hanging_bar",)), ()),
        (
            Change(
                "E", ("hanging_bar",), ("rod.material.young",), lambda E: 2 * E, unseen="nobody looks"
            ),
            ("F3.9-profile",),
        ),
    ],
)
def test_a_change_that_is_unseen_without_a_reason_or_seen_in_spite_of_one_fails(
    monkeypatch, change, noticed
):
    monkeypatch.setattr(power, "changes", lambda: (change,))
    lines = []
    with pytest.raises(OutOfToleranceError, match="changes that no row notices and that have no reason"):
        lines.extend(table(ROWS))
    assert tuple(row.split()[0] for row in notices(change, ROWS).rows) == noticed


def test_the_command_prints_the_rows_that_notice(capsys):
    code = main(["power", "--table", str(ROOT / "results/tolerances.csv"), "made quadratic", "bar: k"])
    out = capsys.readouterr().out
    assert code == 0
    assert "hanging bar: k x 1.02" in out
    assert "none: nothing shears" in out
    assert "F3.7-centreline" in out


def test_the_inflation_is_that_of_the_inflated_case():
    import cosserat

    assert cosserat.run("inflated").mu_edge.to_numpy() == pytest.approx(power_rods.INFLATION)
