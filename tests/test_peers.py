"""The comparison with other packages, as far as it needs none of them."""

import csv
import sys
from pathlib import Path

import pytest

from cosserat.errors import CosseratError
from cosserat.peers import compare


def test_the_problems_are_the_same_for_everyone():
    posed = compare.problems()
    assert [problem.elements for problem in posed] == [19, 20, 40, 80, 20, 200, 2000]
    for problem, ours in posed.items():
        assert ours.rod.vertices == problem.elements + 1
        assert problem.bending * 1e2 < problem.axial * problem.length**2


def test_our_lines_and_the_table(tmp_path):
    lines = []
    for problem, ours in compare.problems().items():
        if problem.elements < 30:
            lines.append(compare._ours(problem, ours))
    for line, allowed in zip(lines, (5e-4, 2e-4, 3e-4), strict=True):
        assert line.error < allowed
        assert 0 < line.least <= line.seconds <= line.most
        assert line.runs == compare.RUNS >= 5
    compare.write(lines, tmp_path / "peers.csv")
    with (tmp_path / "peers.csv").open(newline="") as file:
        assert [row["package"] for row in csv.DictReader(file)] == ["cosserat"] * 3


def test_a_package_that_is_not_there_is_said_to_be_so():
    problem = next(iter(compare.problems()))
    with pytest.raises(
        CosseratError, match=r"with_exudyn.py failed on \(a\) .*No module named 'exudyn'"
    ):
        compare._ask(Path(sys.executable), "with_exudyn.py", problem)
