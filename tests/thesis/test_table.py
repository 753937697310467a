"""The results table: every claim agrees with the numbers, a wrong number fails, and bad rows are refused."""

import ast
import inspect
import math
import os
import re
import shutil
import threading
from pathlib import Path

import pytest
from conftest import ROOT

import cosserat
from cosserat import reading
from cosserat.errors import InputError, OutOfToleranceError
from cosserat.studies.door import published_studies
from cosserat.thesis.outputs.manifest import read as read_manifest
from cosserat.thesis.table.arithmetic import ARITHMETIC
from cosserat.thesis.table.errata import read_errata
from cosserat.thesis.table.left_out import read_left_out
from cosserat.thesis.table.measure import check, judge, measure, outcomes, sentence, summary
from cosserat.thesis.table.readouts import READOUTS, midspan
from cosserat.thesis.table.tolerances import (
    REPORT_COLUMNS,
    Judged,
    Row,
    read_report,
    read_table,
    write_report,
)

TABLE = ROOT / "results/tolerances.csv"
ROWS = read_table(TABLE)
CASES = {row.case for row in ROWS if row.case}
ATTEMPTED = [row for row in ROWS if row.standing != "not attempted"]


@pytest.fixture(scope="module")
def folder(solved):
    for name in CASES:
        assert solved[name].attrs
    return solved.folder


def a_row(**changes):
    known = {
        "id": "r",
        "where": "here",
        "quantity": "q",
        "units": "m",
        "published": "2 mm",
        "kind": "printed",
        "case": "clamped_free",
        "readout": "clamped_free_tip",
        "tolerance": 1e-5,
        "tolerance_kind": "abs",
        "claim": "within",
        "why": "because",
        "standing": "reproduced",
    }
    return Row.read({**known, **changes}, "row")


def judged(measured, expected=2e-3, **changes):
    return Judged.model_construct(row=a_row(**changes), expected=expected, measured=measured)


def test_every_claim_of_the_table_holds(folder, tmp_path):
    report = tmp_path / "report.csv"
    write_report(measure(ROWS, folder), report)
    assert "0 claims fail" in check(read_report(report))


@pytest.mark.parametrize("row", ATTEMPTED, ids=lambda row: row.id)
def test_values_just_inside_and_just_outside_are_judged_right(row, solved):
    expected = judge(row, solved).expected
    if row.claim == "within":
        middle, allowed = expected, row.tolerance * (abs(expected) if row.tolerance_kind == "rel" else 1)
    else:
        middle, allowed = row.found, row.found_tolerance
    for sign in (-1, 1):
        inside, outside = (
            Judged.model_construct(
                row=row, expected=expected, measured=middle + sign * allowed * fraction
            )
            for fraction in (0.999, 1.001)
        )
        assert inside.holds
        assert not outside.holds


@pytest.mark.parametrize("row", ATTEMPTED, ids=lambda row: row.id)
def test_no_row_accepts_a_distant_number(row, solved):
    """A number that lies outside its tolerance does not lie within the tolerance of the value found."""
    expected = judge(row, solved).expected
    for measured in (0.0, -1.0, 1e6, 2 * (row.found or expected), (row.found or expected) / 2):
        if row.claim == "outside" or measured != expected:
            assert not Judged.model_construct(row=row, expected=expected, measured=measured).holds


@pytest.mark.parametrize("row", ATTEMPTED, ids=lambda row: row.id)
def test_values_found_outside_are_outside(row, solved):
    """No number that meets the published tolerance is also near enough to what we say is found."""
    if row.claim == "within":
        return
    expected = judge(row, solved).expected
    tolerance = row.tolerance * (abs(expected) if row.tolerance_kind == "rel" else 1)
    assert abs(row.found - expected) > tolerance + row.found_tolerance
    assert row.found_tolerance < 0.01 * abs(row.found)


def test_no_two_rows_of_one_case_measure_the_same_number(solved):
    """Equal to a millionth of what the tolerance allows, from the same side of the same published number."""
    seen = {}
    for row in ATTEMPTED:
        item = judge(row, solved)
        number = (row.case, row.kind == "arithmetic", f"{item.error_over_tolerance:.6g}")
        twin = seen.setdefault(number, row.id)
        assert twin == row.id or item.error == 0, f"{row.id} measures what {twin} measures"


def test_arithmetic_rows_solve_nothing_and_are_only_recomputed():
    """The functions take no Dataset, the rows name no case, and none has the standing 'reproduced'."""
    rows = [row for row in ATTEMPTED if row.kind == "arithmetic"]
    assert {row.readout for row in rows} == set(ARITHMETIC)
    for row in rows:
        assert not inspect.signature(ARITHMETIC[row.readout]).parameters
        assert (row.case, row.standing) == ("", "recomputed")
    tree = ast.parse((ROOT / "cosserat/thesis/table/arithmetic.py").read_text())
    modules = [node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    assert not [name for name in modules if re.search(r"runner|data|solvers|readouts", name)]


@pytest.mark.parametrize("measured", [float("nan"), float("inf"), None])
@pytest.mark.parametrize("claim", ["within", "outside"])
def test_nan_makes_no_claim_true(measured, claim):
    found = {"found": 3e-3, "found_tolerance": 1e-4} if claim == "outside" else {}
    item = judged(measured, claim=claim, standing="assumption", erratum="E1", **found)
    assert not item.holds
    assert item.verdict == "FAILS"


def test_a_tolerance_a_thousand_times_its_error_is_reported_loose():
    assert judged(2e-3 + 0.9e-8).verdict == "within, loose"
    assert judged(2e-3 + 1.1e-8).verdict == "within"


def test_published_texts_are_read_with_their_units():
    assert a_row().expected == pytest.approx(2e-3)
    assert a_row(published="1/2", units="1").expected == 0.5
    with pytest.raises(Exception, match="which is not a number with a unit"):
        _ = a_row(published="about two").expected


def test_only_numbers_of_the_page_are_of_kind_printed():
    """Ours (C-...) and those of the thesis's sources come from a closed form or a source, and say so."""
    for row in ATTEMPTED:
        ours, cited = row.id.startswith("C-"), "reference [" in row.where
        assert (row.kind == "literature") == cited, row.id
        assert row.kind == "analytic" or not ours, row.id
        assert ours == row.ours
        assert row.kind not in ("printed", "arithmetic") or row.where.startswith(
            ("section", "eq", "after eq", "Fig", "Table")
        )


def test_every_row_has_one_source_of_its_expected_number(solved):
    """The expected number is either printed or from the read-out, never both and never neither."""
    for row in ATTEMPTED:
        if row.kind == "arithmetic":
            assert row.expected is not None
            continue
        reading = READOUTS[row.readout](solved[row.case])
        assert (row.expected is None) != (reading.expected is None), row.id


def unusual(row):
    """The numbers that a row prints, in its own and in SI units, if they have two significant digits or more."""
    digits = re.match(r"-?([\d.]+)", row.published)[1]
    significant = digits.lstrip("0.").replace(".", "") if "." in digits else digits.strip("0")
    return {abs(float(digits)), abs(row.expected)} if len(significant) > 1 else set()


ALIKE = {
    # loads and places of exercises, in words of their own
    "ch2_peristalsis.py": {0.25, 0.75},  # ends of regions, on a body of length one
    "ch3_rods.py": {0.25},  # an area
    "ch4_consistent.py": {0.25},
    "chapter2.py": {
        0.25,
        0.75,
        0.85,
    },  # where the muscles of Fig. 2.5(b) begin and end, and places in a drawing
    # places, angles and widths in a drawing
    "beams.py": {0.24, 0.75, 0.85, 1.75},
    "chapter1.py": {0.25, 0.85, 1.6},
    "consistent.py": {1.6},
    "crawlers.py": {0.25},
    "deformations.py": {0.25},
    "edge_strains.py": {1.6},
    "gaits.py": {0.25, 0.78, 0.99, 1.35, 7.6},
    "geometry.py": {0.75, 0.85, 1.35, 1.75},
    "opening.py": {1.75},
    "played.py": {0.75},
    "pulling.py": {0.24},
    "strokes.py": {1.6},
    "worm_parts.py": {0.85, 1.75},
}
"""Literals that are not the published number that they equal, by file."""


def test_published_numbers_are_written_in_the_table_alone():
    """No number of a read-out, a figure or a chapter is one that the thesis prints; `printed.py` is the second copy."""
    published = set().union(*(unusual(row) for row in ROWS if row.expected is not None))
    assert {0.0386, 38.6, 0.75, 23.88, 0.59686} <= published
    thesis = (f"cosserat/thesis/{room}" for room in ("table", "figures", "book"))
    folders = [ROOT / folder for folder in (*thesis, "cosserat/figures", "chapters")]
    assert all([*folder.glob("*.py")] for folder in folders)
    typed = {
        (file.name, node.value)
        for folder in folders
        for file in folder.glob("*.py")
        if not file.name.startswith("printed")
        for node in ast.walk(ast.parse(file.read_text()))
        if isinstance(node, ast.Constant) and isinstance(node.value, float)
        if any(math.isclose(node.value, number, rel_tol=1e-9) for number in published)
    }
    assert not {(file, number) for file, number in typed if number not in ALIKE.get(file, ())}
    assert {(file, number) for file, own in ALIKE.items() for number in own} <= typed


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"why": None}, "'why' is missing"),
        ({"tolerance": None}, "needs tolerance"),
        ({"case": None}, "needs case"),
        ({"tolerance": "0"}, "it must be above 0"),
        ({"readout": "tip"}, "unknown read-out 'tip'"),
        ({"standing": "erratum"}, "names no entry of the errata"),
        ({"claim": "outside"}, "cannot stand as 'reproduced'"),
        (
            {"claim": "outside", "standing": "assumption", "erratum": "E1"},
            "does not say what is found there; give 'found' and 'found_tolerance'",
        ),
        ({"found": "1", "found_tolerance": "1"}, "leave out 'found'"),
        ({"kind": "arithmetic"}, "unknown read-out"),
        ({"kind": "arithmetic", "readout": "first_root"}, "leave 'case' empty"),
        (
            {"kind": "arithmetic", "readout": "first_root", "case": None},
            "stands as 'reproduced'; only rows of kind 'arithmetic', and all of them, have the standing 'recomputed'",
        ),
        ({"standing": "recomputed"}, "is of kind 'printed' and stands as 'recomputed'"),
        ({"tolerence": "1"}, "did you mean 'tolerance'"),
        ({"standing": "done"}, "it must be 'reproduced'"),
    ],
)
def test_incomplete_rows_do_not_load(change, sentence):
    kept = {key: value for key, value in change.items() if value is not None}
    known = {
        key: value
        for key, value in a_row().model_dump().items()
        if key not in change and value not in ("", None)
    }
    with pytest.raises(InputError, match=sentence):
        Row.read({**known, **kept}, "row")


def test_a_repeated_id_is_refused(tmp_path):
    lines = TABLE.read_text().splitlines()
    (tmp_path / "t.csv").write_text("\n".join([*lines, lines[1]]))
    with pytest.raises(InputError, match="the id 2.7-displacement occurs more than once"):
        read_table(tmp_path / "t.csv")


def test_a_share_is_of_the_published_number_that_the_table_names(solved):
    row = next(row for row in ROWS if row.id == "2.8-stride-error")
    stride = READOUTS[row.readout](solved[row.case]).measured
    assert judge(row, solved).measured == pytest.approx(abs(stride / 38.6e-3 - 1))


@pytest.mark.parametrize("other", ["2.8-strid", "F3.10-tip"])
def test_a_share_of_an_unknown_or_unprinted_number_is_refused(tmp_path, other):
    (tmp_path / "t.csv").write_text(TABLE.read_text().replace(",2.8.4-stride,", f",{other},"))
    with pytest.raises(InputError, match=r"row '2\.8-stride-error': 'against' is '.*'; give the id"):
        read_table(tmp_path / "t.csv")


def test_a_claim_that_fails_is_named_after_the_report_is_written(folder, tmp_path):
    strict = [row.replace(tolerance=1e-12) if row.id == "F3.10-tip" else row for row in ROWS]
    report = tmp_path / "report.csv"
    write_report(measure(strict, folder), report)
    assert report.exists()
    with pytest.raises(OutOfToleranceError, match=r"F3\.10-tip: tip displacement .* measured -0\.0369"):
        check(read_report(report))


def test_an_erratum_that_stops_being_one_is_noticed(folder, tmp_path):
    """A row claimed outside its tolerance fails once it lies within, wherever it says that it is found."""
    wide = [row.replace(tolerance=10.0) if row.id == "F3.12-midspan-printed" else row for row in ROWS]
    report = tmp_path / "report.csv"
    write_report(measure(wide, folder), report)
    with pytest.raises(OutOfToleranceError, match=r"F3\.12-midspan-printed"):
        check(read_report(report))


def test_files_of_another_case_and_missing_files_are_refused(folder, tmp_path):
    with pytest.raises(InputError, match=r"there is no file .*run the case first"):
        measure(ROWS, tmp_path)
    cases, studies = tmp_path / "cases", tmp_path / "studies"
    for place in (cases, studies):
        place.mkdir()
        for name in CASES & {file.stem for file in (folder.parent / place.name).glob("*.nc")}:
            shutil.copy(folder.parent / place.name / f"{name}.nc", place)
    shutil.copy(cases / "clamped_free.nc", cases / "necking.nc")
    with pytest.raises(InputError, match="holds the case 'clamped_free'; run 'necking' again"):
        measure(ROWS, cases)
    shutil.copy(studies / "worm_masses.nc", studies / "calibration.nc")
    with pytest.raises(InputError, match="does not hold the study 'calibration'; solve it again"):
        measure(ROWS, cases)


def test_every_row_names_a_known_case_and_entry_of_the_errata():
    errata = read_errata(ROOT / "results/errata.toml")
    for row in ROWS:
        assert not row.erratum or row.erratum in errata, row.id
        assert not row.case or row.case in {*cosserat.published(), *published_studies()}, row.id
        assert row.standing != "recomputed" or row.claim == "within" or row.erratum, row.id
        if row.standing == "erratum":
            assert errata[row.erratum].standing == "erratum", row.id
        if row.standing == "assumption":  # of a question we take one reading
            assert errata[row.erratum].standing in ("assumption", "question"), row.id


def test_every_row_is_attempted_and_the_readme_has_the_summary(folder, tmp_path):
    readme = " ".join((ROOT / "README.md").read_text().split())
    write_report(measure(ROWS, folder), tmp_path / "report.csv")
    assert sentence(read_report(tmp_path / "report.csv")) in readme
    assert "Every row of the results table is attempted" in readme
    assert ATTEMPTED == ROWS


def test_every_read_out_is_used():
    assert {row.readout for row in ATTEMPTED} == set(READOUTS) | set(ARITHMETIC)


def test_another_reading_refers_to_a_number_of_the_table(tmp_path):
    text = TABLE.read_text()
    for wrong in ("2.8-strid", "T2.1-ts"):
        (tmp_path / "t.csv").write_text(re.sub(r",2\.8-stride\n", f",{wrong}\n", text))
        with pytest.raises(InputError, match=f"'reading_of' is '{wrong}'; give the id of the first row"):
            read_table(tmp_path / "t.csv")


def lines(*rows):
    """Lines of a report: id, standing, claim, expected, error, and the rest empty."""
    names = ("id", "kind", "standing", "claim", "expected", "error", "reading_of")
    return [
        dict.fromkeys(REPORT_COLUMNS, "") | dict(zip(names, row, strict=True)) | {"verdict": "within"}
        for row in rows
    ]


def test_a_summary_counts_numbers_by_their_best_reading_and_names_what_is_missed():
    report = lines(
        ("a", "printed", "reproduced", "within", "1", "0", ""),
        ("b", "printed", "erratum", "within", "1", "0", ""),
        ("b-2", "printed", "erratum", "outside", "1", "0.5", "b"),
        ("c", "printed", "assumption", "outside", "2", "1", ""),
        ("c-2", "printed", "assumption", "outside", "2", "0.4", "c"),
        ("d", "analytic", "assumption", "outside", "0", "0.03", ""),
        ("e", "arithmetic", "recomputed", "outside", "1", "1", ""),
        ("f", "literature", "assumption", "outside", "1", "1", ""),
        ("C-g", "analytic", "reproduced", "within", "1", "0", ""),
    )
    assert outcomes(report[:7]) == {
        "a": "reproduced",
        "b": "erratum",
        "c": "missed",
        "d": "missed",
        "e": "recomputed",
    }
    text = summary(report)
    assert text.startswith(
        "Of the thesis's 5 numbers, curves and statements: 1 reproduced as printed, 1 only with a misprint that the "
        "errata name, 2 missed (the worst, c, by 20 %), 1 arithmetic on other numbers of the thesis "
        "(1 of them not as printed). Of 1 exact answers that judge our own rod it meets 1.\n"
    )
    assert "Missed, in the nearest reading by: c 20 %, d 3 %\n" in text
    assert (
        "Other readings of the same numbers: 2 rows; the first readings meet 2 of 4 computed numbers."
        in text
    )
    assert "Measurements of its sources: 1 rows, 0 within their tolerance." in text


def test_midspan_of_even_and_odd_rods():
    import numpy as np

    assert midspan(np.array([0.0, 1.0, 5.0])) == 1.0
    assert midspan(np.array([0.0, 1.0, 2.0, 5.0])) == 1.5


def test_missing_tables_are_refused(tmp_path):
    with pytest.raises(InputError, match="cannot read the table"):
        read_table(tmp_path / "none.csv")
    with pytest.raises(InputError, match="there is no report"):
        read_report(tmp_path / "none.csv")
    with pytest.raises(InputError, match="cannot read the errata"):
        read_errata(tmp_path / "none.toml")


@pytest.mark.parametrize("read", [read_table, read_report, read_errata, read_left_out, read_manifest])
def test_a_device_that_gives_bytes_without_end_is_no_table(read):
    with pytest.raises(InputError, match=r"/dev/zero"):
        read(Path("/dev/zero"))


def test_a_pipe_is_a_table_if_somebody_writes_to_it(tmp_path, monkeypatch):
    monkeypatch.setattr(reading, "_WAIT", 0.2)
    os.mkfifo(tmp_path / "table.csv")
    with pytest.raises(InputError, match="nobody writes to this pipe"):
        read_table(tmp_path / "table.csv")
    threading.Thread(target=lambda: (tmp_path / "table.csv").write_bytes(TABLE.read_bytes())).start()
    assert read_table(tmp_path / "table.csv") == ROWS
