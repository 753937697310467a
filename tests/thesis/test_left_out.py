"""Every numbered item of the thesis is used, or is on the list of omissions with a reason."""

import re

import pytest
from conftest import ROOT

from cosserat.errors import InputError
from cosserat.thesis.figures.catalogue import FIGURES
from cosserat.thesis.table.citations import cited, places, sources
from cosserat.thesis.table.left_out import KINDS, LeftOut, read_left_out

LISTED = read_left_out(ROOT / "results/left_out.toml")
TABLE = r'"T(?:able )?(\d\.\d+)\b'
"""How a chapter shows a table of the thesis: as rows "T2.1", or with "Table 3.1 ..." over a column."""


def used():
    """What is used, by kind."""
    texts = {file: file.read_text(encoding="utf-8") for file in sources(ROOT)}
    drawn = (re.match(r"Fig\. (\d\.\d+):", entry.title) for entry in FIGURES.values())
    return {
        "equations": set().union(
            *(cited(text, file.relative_to(ROOT).parts[0]) for file, text in texts.items())
        ),
        "figures": {match[1] for match in drawn if match},
        "tables": {
            name
            for file, text in texts.items()
            if file.parent.name == "chapters"
            for name in re.findall(TABLE, text)
        },
    }


@pytest.mark.parametrize(
    ("folder", "text", "found"),
    [
        ("tests", "eq. (1.2.3)", {"1.2.3"}),
        ("tests", "eqs. (1.2.9)-(1.2.11), (1.3.4)", {"1.2.9", "1.2.10", "1.2.11", "1.3.4"}),
        ("tests", "(3.3.36)_4 to (3.3.38).", {"3.3.36", "3.3.37", "3.3.38"}),
        ("cosserat", 'Quantity("m", "L", "2.3.4")', {"2.3.4"}),
        ("tests", 'Quantity("m", "L", "2.3.4")', set()),
        ("chapters", r"\tag{3.4.11}", {"3.4.11"}),
        ("results", "tip,0.1,m,2.8.4,why\nend,1,m,2.8.6\n", {"2.8.4", "2.8.6"}),
        ("cosserat", "pip 23.0.1, 1.2.3.4, 0.1.2, 1.2.3, test_of_1_2_94", set()),
    ],
)
def test_citations_are_read(folder, text, found):
    assert cited(text, folder) == found


@pytest.fixture(scope="module")
def all_used():
    return used()


@pytest.mark.parametrize("kind", KINDS)
def test_every_numbered_item_is_used_or_left_out_with_a_reason(kind, all_used):
    there, listed = LISTED.numbered.names(kind), LISTED.names(kind)
    assert [name for name in there if name not in all_used[kind] and name not in listed] == []


@pytest.mark.parametrize("kind", KINDS)
def test_no_used_item_is_listed_as_left_out(kind, all_used):
    listed = LISTED.names(kind)
    assert [name for name in listed if name in all_used[kind]] == []
    assert len(listed) == len(set(listed))


@pytest.mark.parametrize("kind", KINDS)
def test_only_items_of_the_thesis_are_cited_or_listed(kind, all_used):
    there = set(LISTED.numbered.names(kind))
    assert all_used[kind] - there == set()
    assert set(LISTED.names(kind)) - there == set()


def test_reasons_point_to_what_is_used(all_used):
    pointed = set().union(*(cited(item.why) for item in LISTED.left_out))
    assert len(pointed) > 20
    assert pointed - all_used["equations"] == set()


def test_figures_cited_are_figures_of_the_thesis():
    there = LISTED.numbered.names("figures")
    text = "".join(file.read_text(encoding="utf-8") for file in sources(ROOT))
    assert set(re.findall(r"Figs?\. (\d\.\d+)", text)) <= set(there)


def test_counts_are_those_of_the_thesis():
    """399 equations: 205 in Chapter 1, 106 in Chapter 2, 88 in Chapter 3; 29 figures, 3 tables."""
    equations = LISTED.numbered.names("equations")
    assert [sum(name[0] == chapter for name in equations) for chapter in "123"] == [205, 106, 88]
    assert [len(LISTED.numbered.names(kind)) for kind in KINDS] == [399, 29, 3]


def test_places_are_written_as_the_thesis_cites_them():
    item = LeftOut(
        what="x",
        why="y",
        equations=("1.1.1-1.1.3", "1.2.4"),
        figures=("1.1-1.4", "2.1"),
        sections=("3.1",),
    )
    assert item.where == "(1.1.1)-(1.1.3), (1.2.4), Figs. 1.1-1.4, Fig. 2.1, section 3.1"
    assert item.names("figures") == ["1.1", "1.2", "1.3", "1.4", "2.1"]


@pytest.mark.parametrize("text", ["1", "1.2.9-1.2.3", "1.2.3-1.3.9", "a", "1.2.3 "])
def test_bad_ranges_are_refused(text):
    with pytest.raises(InputError, match="is no number or range"):
        LeftOut(what="x", why="y", equations=(text,)).names("equations")


def test_an_unreadable_list_is_refused(tmp_path):
    with pytest.raises(InputError, match="restore it from the repository"):
        read_left_out(tmp_path / "none.toml")
    (tmp_path / "list.toml").write_text("[[left_out]]\nwhat = 'x'\n")
    with pytest.raises(InputError, match="numbered"):
        read_left_out(tmp_path / "list.toml")


def test_places_name_the_function_that_cites_an_equation():
    found = places(ROOT)
    assert ("cosserat/rods/directed_rod.py", "lame") in {(p.path, p.name) for p in found["1.2.96"]}
    assert {p.path for p in found["1.2.93"]} >= {"chapters/ch1_directed_rod.py"}
    assert "9.9.9" not in found
