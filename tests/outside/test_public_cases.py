"""Quick problems of every kind compared with independent codes; `python -m tests.outside` runs all of them."""

import pytest

from .__main__ import main
from .checks import CHECKS, QUICK, Row, inputs


@pytest.mark.parametrize("name", sorted(QUICK))
def test_a_quick_case_holds(name):
    rows = list(CHECKS[name]())
    assert rows
    assert [row for row in rows if not row.holds] == []


def test_quick_cases_cover_every_kind():
    asked = {inputs()[name].problem.kind for name in QUICK if name in inputs()}
    assert asked >= {"rod statics", "rod path", "rod motion", "posture", "crawl"}


def test_a_row_outside_its_tolerance_fails():
    for found in (1.2, 0.8, 0.0, -1.0, 1e6, float("nan"), float("inf")):
        assert not Row("", 1.0, found, 0.1, "").holds
    assert Row("", 1.0, 1.05, 0.1, "").holds


def test_the_command_prints_a_table_and_fails_where_a_row_does_not_hold(capsys, monkeypatch):
    assert main(["toggle"]) == 0
    assert "every row holds" in capsys.readouterr().out
    assert main(["togle"]) == 2
    assert "there is no case 'togle'" in capsys.readouterr().err
    monkeypatch.setitem(CHECKS, "toggle", lambda: iter([Row("x", 1.0, 2.0, 0.1, "nothing")]))
    assert main(["toggle"]) == 1
    assert "DOES NOT HOLD" in capsys.readouterr().out
