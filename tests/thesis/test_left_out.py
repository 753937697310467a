"""Every numbered item of the thesis is used, or is on the list of omissions with a reason."""

import re
import subprocess

import pytest
from conftest import ROOT

from cosserat.errors import InputError
from cosserat.thesis.figures.catalogue import FIGURES
from cosserat.thesis.table.left_out import KINDS, LeftOut, read_left_out

LISTED = read_left_out(ROOT / "results/left_out.toml")
OWN = ("left_out.py", "test_left_out.py", "test_links.py")  # they cite what is not used

NUMBER = r"([123]\.\d\.\d{1,3})"
FORMS = {
    "cosserat": r'"' + NUMBER + r'"',  # of a parameter or a variable
    "chapters": r"\\tag\{" + NUMBER + r"\}",
    "results": r"(?<=,)" + NUMBER + r"(?=[,\n])",  # of a row
}
"""How a folder cites an equation, besides (1.2.3)."""
RANGE = r"\((?P<section>[123]\.\d)\.(?P<first>\d{1,3})\)(?:_?\d)?(?:-|\s+to\s+)\((?P=section)\.(?P<last>\d{1,3})\)"
TABLE = r'"T(?:able )?(\d\.\d+)\b'
"""How a chapter shows a table of the thesis: as rows "T2.1", or with "Table 3.1 ..." over a column."""


def cited(text, folder="tests"):
    """Equations of a text of this folder: (1.2.3), eqs. (1.2.3)-(1.2.7) with all between, and its own form."""
    ranges = {
        f"{match['section']}.{number}"
        for match in re.finditer(RANGE, text)
        for number in range(int(match["first"]), int(match["last"]) + 1)
    }
    own = re.findall(FORMS[folder], text) if folder in FORMS else []
    return ranges | {*re.findall(r"\(" + NUMBER + r"\)", text), *own}


def sources():
    """Package with its cases, chapters, tests, errata and tolerances."""
    places = ["cosserat", "chapters", "tests", "results/errata.toml", "results/tolerances.csv"]
    done = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", *places],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    files = [ROOT / line for line in done.stdout.splitlines() if not line.endswith(OWN)]
    return [file for file in files if file.is_file() and file.suffix in (".py", ".toml", ".csv")]


def used():
    """What is used, by kind."""
    texts = {file: file.read_text(encoding="utf-8") for file in sources()}
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
    text = "".join(file.read_text(encoding="utf-8") for file in sources())
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
