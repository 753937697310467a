"""Chapters use the public doors of the package alone, as a reader can, and teach in the same form."""

import ast
import re
import sys

import pytest
from conftest import ROOT

from cosserat.errors import InputError
from cosserat.thesis.book import page
from cosserat.thesis.table.errata import read_errata

CHAPTERS = sorted((ROOT / "chapters").glob("*.py"))
DIRECTIVE = r"^# \.\. auto\w+:: (cosserat\.[\w.]+)"
DOCUMENTED = set(re.findall(DIRECTIVE, (ROOT / "chapters/python_api.py").read_text(), re.MULTILINE))
DOCUMENTED_MODULES = {name.rpartition(".")[0] for name in DOCUMENTED}


def imported(source):
    """What a chapter imports, as full names; of `import a.b` the module."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def is_public(name):
    """Whether a chapter may import it: the package, a documented name or module, NumPy, or the standard library."""
    first = name.split(".")[0]
    if first != "cosserat":
        return first == "numpy" or first in sys.stdlib_module_names
    return name in ("cosserat", "cosserat.thesis.book.page") or name in DOCUMENTED | DOCUMENTED_MODULES


def inside(source):
    """What a chapter imports besides."""
    return [name for name in imported(source) if not is_public(name)]


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ("import cosserat\nimport csv, numpy as np\nfrom pathlib import Path", []),
        ("from cosserat.thesis.book import page", []),
        ("from cosserat.rods.rod import Rod\nfrom cosserat.rods import rod", []),
        ("from cosserat.errors import CrossingError", []),
        ("from cosserat.rods.rod import AnySection", ["cosserat.rods.rod.AnySection"]),
        ("from cosserat.peristalsis import crawler, ground", ["cosserat.peristalsis.ground"]),
        ("if True:\n    import scipy.linalg", ["scipy.linalg"]),
    ],
)
def test_imports_from_inside_of_the_package_are_noticed(source, found):
    assert inside(source) == found


@pytest.mark.parametrize("chapter", CHAPTERS, ids=lambda file: file.stem)
def test_a_chapter_uses_the_public_doors_alone(chapter):
    assert inside(chapter.read_text()) == []


def noted(source):
    """The entries of the errata table that a chapter has as notes beside its text."""
    calls = re.findall(r"^page\.misprint\((.*?)\)$", source, re.MULTILINE | re.DOTALL)
    return {name for call in calls for name in re.findall(r'"(E[\d.]+)"', call)}


@pytest.mark.parametrize("number", [2, 3])
def test_every_entry_of_a_chapter_is_a_note_beside_its_text(number):
    known = {
        name for name in read_errata(ROOT / "results/errata.toml") if name.startswith(f"E{number}.")
    }
    shown = [
        noted(chapter.read_text()) for chapter in CHAPTERS if chapter.stem.startswith(f"ch{number}")
    ]
    assert known
    assert set().union(*shown) == known


def test_an_excerpt_ends_before_a_line_or_with_the_function_and_names_a_line_that_is_missing():
    function = "cosserat.peristalsis.doublets.contact_force"
    whole, part = page.excerpt(function, "tents ="), page.excerpt(function, "tents =", "return")
    assert "return force" in whole.data
    assert "tents =" in part.data
    assert "return force" not in part.data
    assert "offset =" not in whole.data
    with pytest.raises(InputError, match="contact_force has no line with 'nothing'"):
        page.excerpt(function, "tents =", "nothing")


def test_a_folded_output_opens_from_its_summary():
    shown = page.folded("a < b in $\\mu_1$", page.table([[1]], ("one",))).data
    assert shown.startswith('<details class="verdict"><summary>a &lt; b in <span class="math')
    assert shown.index("</summary>") < shown.index("<table") < shown.index("</details>")
