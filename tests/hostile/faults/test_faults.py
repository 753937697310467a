"""One quick attempt of each class of faults, and the table in which a failure would show."""

import csv
import shutil
from collections.abc import Iterator

import pytest

from . import catalogue  # noqa: F401  (its modules enter their faults)
from .processes import ROOT, Done, expect_sentence, expect_whole_files, undisturbed
from .table import COLUMNS, FAULTS, Fault, NotAsPromisedError, Trial, expect, store, tried

QUICK = (
    ("Ctrl-C from the first line of the program on", 0),
    ("SIGTERM from the first line of the program on", 0),
    ("SIGHUP from the first line of the program on", 0),
    ("loaded in Python", 1),
    ("the output is the input", 0),
    ("a closed pipe", 0),
    ("a closed pipe", 10),
    ("the current folder is gone", 1),
)
"""Names of faults, and the number of the attempt that is a test."""
LONGER = (
    ("two are swapped", 0),
    ("standard output is full", 0),
    ("what a killed motion left", 0),
    ("while one is stopped", 0),
    ("no file may be longer than a limit", 1),
)
"""Those among the tests of the workflow."""


@pytest.mark.parametrize(
    ("name", "number"),
    [*QUICK, *(pytest.param(*one, marks=pytest.mark.workflow) for one in LONGER)],
)
def test_a_fault_ends_as_promised(name, number):
    tally = tried(FAULTS[name], count=1, first=number)
    assert tally.failures == []
    assert tally.kept > 0, tally.lacking


def test_every_class_of_faults_has_a_quick_attempt():
    assert {FAULTS[name].kind for name, _ in (*QUICK, *LONGER)} == {one.kind for one in FAULTS.values()}


def test_the_stored_table_has_every_fault():
    """The chapter shows it; the command writes another."""
    with (ROOT / "results" / "faults.csv").open(newline="", encoding="utf-8") as stream:
        lines = list(csv.DictReader(stream))
    assert [line["fault"] for line in lines] == list(FAULTS)
    assert tuple(lines[0]) == COLUMNS
    for line in lines:
        one = FAULTS[line["fault"]]
        assert (line["kind"], line["promise"]) == (one.kind, one.promise)
        failed = int(line["not as promised"])
        assert int(line["tried"]) == int(line["as promised"]) + failed
        assert bool(failed) <= bool(line["first failure"])
        assert int(line["tried"]) > 0 or line["first failure"]


def test_what_is_not_as_promised_is_counted_and_can_be_repeated(tmp_path):
    def attempt(trial: Trial) -> Iterator[None]:
        yield
        expect(trial.number != 2, f"a file in {trial.folder}")

    tally = tried(Fault("toy", "toy", "Nothing fails.", 3, attempt), count=3, seed=5)
    assert tally.kept == 3
    ((command, found),) = tally.failures
    assert found == "a file in FOLDER"
    assert command == "python -m tests.hostile.faults --only 'toy' --seed 5 --from 2 --count 1"
    assert tally.line["not as promised"] == "1"


def test_rows_of_other_faults_stay_in_the_stored_table(tmp_path):
    names = list(FAULTS)[:2]

    def attempt(trial: Trial) -> Iterator[None]:
        yield

    for name in reversed(names):
        store(
            [tried(Fault("toy", name, "Nothing fails.", 1, attempt), count=1)], tmp_path / "faults.csv"
        )
    lines = (tmp_path / "faults.csv").read_text().splitlines()
    assert [line.split(",")[1] for line in lines[1:]] == names


@pytest.mark.parametrize(
    "done",
    [
        Done(1, "", "Traceback (most recent call last):\n  File\nOSError: no space"),
        Done(2, "", ""),
        Done(2, "", "cosserat: cannot write x.nc\nand more"),
        Done(2, "", "cosserat: cannot write another"),
        Done(0, "", "cosserat: cannot write x.nc"),
        Done(-15, "", "cosserat: cannot write x.nc"),
    ],
)
def test_the_judge_of_sentences_sees_what_is_none(done):
    expect_sentence(Done(2, "", "cosserat: cannot write x.nc: full"), 2, naming=["x.nc"])
    with pytest.raises(NotAsPromisedError):
        expect_sentence(done, 2, naming=["x.nc"])


@pytest.mark.parametrize("name", ["x.nc", "x.svg", "x.csv"])
def test_the_judge_of_files_sees_one_that_is_cut(name, tmp_path):
    whole = {"x.svg": b"<svg><g/></svg>", "x.csv": b"a,b\n1,2\n"}
    if name == "x.nc":
        shutil.copy(undisturbed("motion").path, tmp_path / name)
    else:
        (tmp_path / name).write_bytes(whole[name])
    expect_whole_files(tmp_path)
    (tmp_path / name).write_bytes((tmp_path / name).read_bytes()[:-3])
    with pytest.raises(NotAsPromisedError):
        expect_whole_files(tmp_path)
