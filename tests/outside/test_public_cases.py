"""Quick problems of every kind compared with independent codes; `python -m tests.outside` runs all of them."""

import textwrap
from pathlib import Path

import pytest

from . import lines
from .__main__ import main
from .checks import CHECKS, QUICK, Row, inputs
from .wishes import ELSEWHERE


@pytest.mark.parametrize("name", sorted(QUICK))
def test_a_quick_case_holds(name):
    rows = list(CHECKS[name]())
    assert rows
    assert [row for row in rows if not row.holds] == []


def test_quick_cases_cover_every_kind():
    asked = {inputs()[name].problem.kind for name in QUICK if name in inputs()}
    bodies = {"rod statics", "rod path", "rod motion", "modes", "critical loads", "posture", "crawl"}
    assert asked >= bodies


def test_right_values_of_other_wishes_are_in_tests_of_their_own():
    for wish, places in ELSEWHERE.items():
        for place in places:
            file, name = place.split(": ")
            assert f"def {name}(" in (Path(__file__).parents[1] / file).read_text(), (wish, place)


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


# ---------------------------------------------------------------- lines


def test_each_case_has_its_lines():
    assert set(lines.table()) == set(CHECKS)
    for name, entry in lines.table().items():
        toml, python = lines.count(lines.now(), entry["now"])
        assert toml >= 3, name
        assert python >= 1, name
        assert "before" in entry or entry["unsaid"], name


def test_lines_are_counted_with_all_that_a_case_inherits():
    """By hand: comments and blank lines do not count, and 106 characters are two lines."""
    long = "a = " + "1" * 102
    toml = f"""
        [_base] # what others share
        kind = "x"

        [one]
        like = "_base"
        {long}
        [one.rod]
        # nothing
        length = "1 m"
        [two]
        b = 1
        """
    python = """
        def answer(data):
            \"\"\"Read.

            More of it.
            \"\"\"
            return (
                data.x
            )  # it
        found = 1
        """
    text = lines.Files((textwrap.dedent(toml),), (textwrap.dedent(python),))
    assert lines.in_toml(text, ["one"]) == 8
    assert lines.in_toml(text, ["two"]) == 2
    assert lines.in_toml(text, ["one", "two"]) == 10
    assert lines.in_python(text, ["def answer", "found"]) == 5
    with pytest.raises(KeyError, match="no statement begins with 'lost'"):
        lines.in_python(text, ["lost"])


def test_the_command_prints_lines_before_and_now(capsys, monkeypatch):
    try:
        lines.before()
    except lines.NoHistoryError:
        pytest.skip("this copy of the repository does not have its whole history")
    assert main(["--lines"]) == 0
    said = capsys.readouterr().out.split("\n")
    assert len(said) == len(CHECKS) + 4
    assert any(line.startswith("buckling ") for line in said)
    lines.before.cache_clear()
    monkeypatch.setattr(lines, "BEFORE", "0" * 40)
    assert main(["--lines"]) == 1
    assert "fetch the whole history" in capsys.readouterr().err
