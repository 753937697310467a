"""Where numbered equations of the thesis are cited: in the package, its chapters, its tests, and its tables."""

from __future__ import annotations

import ast
import functools
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

NUMBER = r"([123]\.\d\.\d{1,3})"
FORMS = {
    "cosserat": r'"' + NUMBER + r'"',  # of a parameter or a variable
    "chapters": r"\\tag\{" + NUMBER + r"\}",
    "results": r"(?<=,)" + NUMBER + r"(?=[,\n])",  # of a row
}
"""How a folder cites an equation, besides (1.2.3)."""
RANGE = r"\((?P<section>[123]\.\d)\.(?P<first>\d{1,3})\)(?:_?\d)?(?:-|\s+to\s+)\((?P=section)\.(?P<last>\d{1,3})\)"
FOLDERS = ("cosserat", "chapters", "tests")
FILES = ("results/errata.toml", "results/tolerances.csv")
LISTS = ("left_out.py", "test_left_out.py", "citations.py", "equation_list.py", "test_links.py")
"""Files that cite as examples what they do not use."""


def cited(text: str, folder: str = "tests") -> set[str]:
    """Equations of a text of this folder: (1.2.3), eqs. (1.2.3)-(1.2.7) with all between, and its own form."""
    ranges = {
        f"{match['section']}.{number}"
        for match in re.finditer(RANGE, text)
        for number in range(int(match["first"]), int(match["last"]) + 1)
    }
    own = re.findall(FORMS[folder], text) if folder in FORMS else []
    return ranges | {*re.findall(r"\(" + NUMBER + r"\)", text), *own}


def sources(root: Path) -> list[Path]:
    """The files that may cite equations: package with its cases, chapters, tests, errata and tolerances."""
    found = [
        path
        for folder in FOLDERS
        for ending in ("py", "toml", "csv")
        for path in sorted((root / folder).rglob(f"*.{ending}"))
    ]
    return [path for path in [*found, *(root / file for file in FILES)] if path.name not in LISTS]


@dataclass(frozen=True)
class Place:
    """Where an equation is cited.

    path : of the file from the root of the checkout, with slashes.
    name : of the function or class at the margin whose lines cite it; empty for the head of a file.
    """

    path: str
    name: str


@functools.cache
def places(root: Path) -> Mapping[str, list[Place]]:
    """Every place that cites an equation, by its number."""
    found: dict[str, list[Place]] = {}
    for file in sources(root):
        path = file.relative_to(root).as_posix()
        for name, text in _parts(file):
            for number in cited(text, path.split("/")[0]):
                found.setdefault(number, []).append(Place(path, name))
    return found


def _parts(file: Path) -> Iterator[tuple[str, str]]:
    """The text of a file, that of each function and class apart."""
    text = file.read_text(encoding="utf-8")
    if file.suffix != ".py" or file.parent.name == "chapters":
        yield "", text
        return
    lines, head = text.splitlines(), []
    done = 0
    for node in ast.parse(text).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            first = min([node.lineno, *(mark.lineno for mark in node.decorator_list)]) - 1
            head += lines[done:first]
            done = node.end_lineno or first
            yield node.name, "\n".join(lines[first:done])
    yield "", "\n".join([*head, *lines[done:]])
