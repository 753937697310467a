"""The comparison with other packages: the part that runs without them."""

import csv
import sys
from pathlib import Path

import pytest
from conftest import ROOT

from cosserat.errors import CosseratError, InputError
from cosserat.thesis.figures.catalogue import draw
from cosserat.thesis.peers import compare


def test_all_packages_solve_the_same_problems():
    problems = compare.problems()
    assert [problem.elements for problem in problems] == [19, 20, 40, 80, 20, 200, 2000]
    for problem, ours in problems.items():
        assert ours.rod.vertices == problem.elements + 1
        assert problem.bending * 1e2 < problem.axial * problem.length**2


FAKE = """
import json, sys
problem = json.loads(sys.argv[1])
if problem["kind"] == "vibration":
    print("{}")
    raise SystemExit
if problem["elements"] == 80:
    raise SystemExit("the licence has run out")
print(json.dumps({"python": "3", "fake": "1.2"}), flush=True)
for line in sys.stdin:
    with open(sys.argv[0][:-6] + "prescribed_rotations", "a") as log:
        log.write(sys.argv[0][-6:-3] + " ")
    print("a banner\\n" + json.dumps({"seconds": 2.0, "whole": 3.0, "tip": 1.0, "profile": [1.0] * 20}), flush=True)
"""


@pytest.fixture
def fakes(tmp_path, monkeypatch):
    """Two packages that take two seconds for everything and do not move."""
    for name in ("one.py", "two.py"):
        (tmp_path / name).write_text(FAKE)
    monkeypatch.setattr(
        compare, "SCRIPTS", {name: str(tmp_path / f"{name}.py") for name in ("one", "two")}
    )
    return tmp_path


def some(monkeypatch, *kept):
    problems = {p: ours for p, ours in compare.problems().items() if (p.kind, p.elements) in kept}
    monkeypatch.setattr(compare, "problems", lambda: problems)


def test_packages_alternate_and_the_table_names_the_machine(fakes, monkeypatch):
    some(monkeypatch, ("weight", 19), ("force", 20), ("vibration", 20))
    solve, turns, said = compare._solve, fakes / "prescribed_rotations", []

    def ours(*given):
        with turns.open("a") as log:
            log.write("our ")
        return solve(*given)

    monkeypatch.setattr(compare, "_solve", ours)
    lines = list(compare.compare(Path(sys.executable), said.append, runs=3))
    # one run of ours compiles
    each = ["our", *["our", "one", "two"] * 3]
    assert turns.read_text().split() == [*each, *each, *["our"] * 4]
    assert "(a) clamped-free, 19 elements, run 3 of 3" in said
    assert [line.package for line in lines] == [*["cosserat", "one", "two"] * 2, "cosserat"]
    for line in lines:
        assert line.runs == 3
        if line.package == "cosserat":
            assert 0 < line.least <= line.seconds <= line.most
            assert line.whole > line.least
            assert line.error < 5e-4
            assert {"cosserat", "python", "numpy", "scipy", "numba"} == {
                used.split()[0] for used in line.versions.split(", ")
            }
        else:
            assert (line.least, line.seconds, line.most, line.whole) == (2, 2, 2, 3)
            assert line.error > 0.1
            assert line.versions == "python 3, fake 1.2"
        assert line.processor
        assert line.load >= 0
        assert len(line.date.split("-")) == 3
    compare.write(lines, fakes / "peers.csv")
    with (fakes / "peers.csv").open(newline="") as file:
        assert [row["package"] for row in csv.DictReader(file)] == [line.package for line in lines]


def test_a_missing_or_failing_package_is_reported(fakes, monkeypatch):
    python = Path(sys.executable)
    some(monkeypatch, ("force", 80))
    with pytest.raises(
        CosseratError, match=r"one.py failed on \(b\) .*80 elements: the licence has run out"
    ):
        list(compare.compare(python, print))
    monkeypatch.setattr(compare, "SCRIPTS", {"Exudyn": "with_exudyn.py"})
    with pytest.raises(CosseratError, match=r"with_exudyn.py failed on .*No module named 'exudyn'"):
        list(compare.compare(python, print))
    with pytest.raises(InputError, match="there is no Python /none/python; make the environment with"):
        list(compare.compare(Path("/none/python"), print))


def test_the_stored_table_is_complete():
    """The chapter shows it; `snakemake peers` writes another."""
    with (ROOT / "results" / "peers.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == list(compare.Line.__dataclass_fields__)
    measured = {(row["problem"], row["package"]) for row in rows}
    wanted = {
        (p.name, package) for p in compare.problems() for package in ("cosserat", *compare.SCRIPTS)
    }
    assert wanted - measured == {("(c) vibration, 2000 elements", "PyElastica")}
    assert measured <= wanted
    for row in rows:
        assert float(row["least"]) <= float(row["seconds"]) <= float(row["most"])
        assert row["date"] >= "2026"
        assert all(row[key] for key in row)


def test_the_picture_has_every_measurement_and_names_a_table_that_is_missing(tmp_path):
    with (ROOT / "results" / "peers.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    figure = draw("fig_peers", {}, ROOT / "results" / "tolerances.csv")
    drawn = [
        tuple(point) for ax in figure.axes for line in ax.get_lines() for point in line.get_xydata()
    ]
    assert sorted(drawn) == sorted((float(row["seconds"]), float(row["error"])) for row in rows)
    with pytest.raises(InputError, match=r"there is no .*peers.csv; restore it with 'git checkout"):
        draw("fig_peers", {}, tmp_path / "tolerances.csv")
