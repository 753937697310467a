"""Where each numbered equation of the thesis is: in this book, in the library, in a test, or left out."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path

from IPython.display import HTML

from cosserat.errors import InputError
from cosserat.thesis.book.tables import framed, prose, row
from cosserat.thesis.book.verdicts import errata, report
from cosserat.thesis.book.workflow import results
from cosserat.thesis.table.citations import Place, cited, places
from cosserat.thesis.table.left_out import LeftOut, LeftOutList, read_left_out

_MOST = 4  # places of one sort that a line names
_COLUMNS = ("equation", "in the book", "in the library", "in a test", "misprints and rows")


def left_out() -> LeftOutList:
    """Parts of the thesis that are left out, with the reasons."""
    return read_left_out(results() / "left_out.toml")


def left_out_table() -> HTML:
    """What is left out, each number an address to which links lead."""
    rows = [
        row(
            (
                prose(item.what),
                f'<span class="no-links">{_anchors(item)}{escape(item.where)}</span>',
                prose(item.why),
            )
        )
        for item in left_out().left_out
    ]
    return framed(rows, ("what", "in the thesis", "why"))


def _anchors(item: LeftOut) -> str:
    """An empty element for each number of an item of the list."""
    words = {
        "equations": ("eq", "Eq. ({})"),
        "figures": ("fig", "Fig. {}"),
        "tables": ("table", "Table {}"),
    }
    return "".join(
        f'<span id="{prefix}-{name}" data-about="{escape(f"{form.format(name)} is left out: {item.what}")}"></span>'
        for kind, (prefix, form) in words.items()
        for name in item.names(kind)
    )


def equations() -> HTML:
    """Every equation that is not left out, with the places that have it.

    Raises
    ------
    InputError : an equation is nowhere.
    """
    listed = left_out()
    left = set(listed.names("equations"))
    numbers = [name for name in listed.numbered.names("equations") if name not in left]
    found, judged, shown = places(results().parent), _judged(), displayed(results().parent)
    nowhere = [name for name in numbers if not found.get(name)]
    if nowhere:
        raise InputError(
            f"no file has the equations {', '.join(nowhere)}; list them in results/left_out.toml with the reason"
        )
    rows = [
        row(
            (
                f"({name})",
                "shown" if name in shown else "",
                _names(found[name]),
                _tests(found[name]),
                ", ".join(judged.get(name, ())),
            ),
            marks=f'id="eq-{name}" data-about="Eq. ({name}) and the places that use it"',
        )
        for name in numbers
    ]
    return framed(rows, _COLUMNS, what="equations")


def displayed(root: Path) -> set[str]:
    """Numbers of the equations that a chapter displays."""
    return {
        number
        for path in sorted((root / "chapters").glob("*.py"))
        for line in path.read_text(encoding="utf-8").splitlines()
        if "\\tag{" in line
        for number in cited(line[line.index("\\tag{") :], "chapters")
    }


def counts() -> dict[str, int]:
    """How many equations are shown, are in the library alone, in tests alone, elsewhere alone, and left out."""
    listed, found, shown = left_out(), places(results().parent), displayed(results().parent)
    left = set(listed.names("equations"))
    told = {"shown": 0, "library": 0, "tests": 0, "elsewhere": 0, "left out": len(left)}
    for name in listed.numbered.names("equations"):
        folders = {place.path.split("/")[0] for place in found.get(name, ())}
        if name in shown:
            told["shown"] += 1
        elif name not in left:
            told[
                "library" if "cosserat" in folders else "tests" if "tests" in folders else "elsewhere"
            ] += 1
    return told


def _names(found: Sequence[Place]) -> str:
    """Functions and classes of the package, each in its file."""
    inside = sorted(
        (place for place in found if place.path.startswith("cosserat/") and place.path.endswith(".py")),
        key=lambda place: (not place.name, place.path),
    )
    shown = [
        (_code(place.name) + " in " if place.name else "") + _code(place.path)
        for place in inside[:_MOST]
    ]
    return "<br>".join(shown) + _more(len(inside))


def _tests(found: Sequence[Place]) -> str:
    files = list(dict.fromkeys(place.path for place in found if place.path.startswith("tests/")))
    return "<br>".join(f"<code>{escape(path)}</code>" for path in files[:_MOST]) + _more(len(files))


def _code(text: str) -> str:
    """Code as Sphinx writes it, for links of definitions."""
    return f'<code><span class="pre">{escape(text)}</span></code>'


def _more(number: int) -> str:
    return f"<br>and {number - _MOST} more" if number > _MOST else ""


def _judged() -> dict[str, list[str]]:
    """Errata and rows of the report by the equations that they are about."""
    found: dict[str, list[str]] = {}
    for name, item in errata().items():
        for number in cited(item.where):
            found.setdefault(number, []).append(name)
    for judged in report():
        for number in cited(judged["where"]):
            found.setdefault(number, []).append(judged["id"])
    return found
