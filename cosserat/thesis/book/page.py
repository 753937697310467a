"""Functions for chapters: stored data, drawn figures, rows of the report, and lines of the library.

A chapter computes no published case again and types no result; it reads results of the workflow and asserts its rows.
"""

from __future__ import annotations

import base64
import inspect
import re
import textwrap
from collections.abc import Sequence
from html import escape
from importlib import resources
from pathlib import Path
from typing import Any

import xarray as xr
from IPython.display import HTML, Markdown

from cosserat.data.netcdf import load
from cosserat.describe import keys as listing
from cosserat.describe.keys import Key
from cosserat.describe.text import need, type_of
from cosserat.errors import InputError, OutOfToleranceError
from cosserat.explain import cited
from cosserat.parameters import Count, Quantity
from cosserat.thesis.figures.catalogue import entry
from cosserat.thesis.table.errata import Erratum, read_errata
from cosserat.thesis.table.left_out import LeftOutList, read_left_out
from cosserat.thesis.table.tolerances import read_report


def results() -> Path:
    """The folder `results` of this checkout, from any working directory in it."""
    for folder in (Path.cwd(), *Path.cwd().parents):
        if (folder / "results" / "tolerances.csv").is_file():
            return folder / "results"
    raise InputError(
        f"no results/tolerances.csv above {Path.cwd()}; run the chapter inside a checkout of cosserat"
    )


def data(case: str) -> xr.Dataset:
    """The stored Dataset of a case."""
    return load(results() / "cases" / f"{case}.nc")


def study(name: str) -> xr.Dataset:
    """The stored answer of a published study."""
    return load(results() / "studies" / f"{name}.nc")


def written(name: str) -> Markdown:
    """A published study as its case file has it, with the base of its case.

    Raises
    ------
    InputError : there is no such study.
    """
    text = (resources.files("cosserat.thesis.cases") / "studies.toml").read_text(encoding="utf-8")
    tables = re.split(r"^(?=\[\w)", text, flags=re.MULTILINE)[1:]  # each with what follows it
    own = [part for part in tables if re.match(rf"\[{re.escape(name)}\]", part)]
    if not own:
        raise InputError(f"there is no study '{name}'")
    base = re.search(r'^of = "(\w+)"', own[0], flags=re.MULTILINE)
    bases = [part for part in tables if base and part.startswith(f"[{base[1]}]")]
    code = "\n\n".join(part.strip() for part in [*bases, *own])
    return Markdown(f"```toml\n{code}\n```")


def figure(name: str, caption: str) -> HTML:
    """A drawn figure with its number and a caption."""
    picture = base64.b64encode((results() / "figures" / f"{name}.svg").read_bytes()).decode()
    title = entry(name).title
    text = f"<b>{escape(title)}.</b> {_mathematics(caption)}"
    image = f'<img alt="{escape(title)}" src="data:image/svg+xml;base64,{picture}">'
    return HTML(f'<figure class="plot" id="{name}">{image}<figcaption>{text}</figcaption></figure>')


def animation(name: str, caption: str) -> HTML:
    """A drawn animation with a button that stops and starts it."""
    drawing = (results() / "figures" / f"{name}.svg").read_text(encoding="utf-8")
    text = f"<b>{escape(entry(name).title)}.</b> {_mathematics(caption)}"
    toggle = (
        "const s=this.closest('figure').querySelector('svg');"
        "s.animationsPaused()?s.unpauseAnimations():s.pauseAnimations()"
    )
    button = f'<button type="button" onclick="{toggle}">play / pause</button>'
    return HTML(
        f'<figure class="plot" id="{name}">{drawing}<div>{button}</div><figcaption>{text}</figcaption></figure>'
    )


def rows(*prefixes: str) -> HTML:
    """The rows of the report whose ids begin with the prefixes, as a table; a failed row stops the chapter.

    Raises
    ------
    OutOfToleranceError : a claim does not hold.
    InputError : there is no such row.
    """
    found = [row for row in read_report(results() / "report.csv") if row["id"].startswith(prefixes)]
    if not found:
        raise InputError(f"the report has no row that begins with {' or '.join(prefixes)}")
    failed = [row["id"] for row in found if row["verdict"] == "FAILS"]
    if failed:
        raise OutOfToleranceError(
            f"rows {', '.join(failed)} of the results table fail; see results/report.csv"
        )
    lines = [
        [
            row["id"],
            row["quantity"],
            row["published"],
            amount(row["expected"], row["units"]),
            amount(row["measured"], row["units"]),
            f"{float(row['error_over_tolerance']):.2f}",
            row["verdict"],
        ]
        for row in found
    ]
    return table(
        lines,
        ("row", "quantity", "printed text", "expected", "measured", "error / tolerance", "verdict"),
    )


def amount(number: str, unit: str) -> str:
    """A number of the report with four digits and its unit."""
    return f"{float(number):.4g}" + ("" if unit == "1" else f"\u00a0{unit}")


def table(lines: Sequence[Sequence[object]], columns: Sequence[str]) -> HTML:
    """A plain table; text between dollars is mathematics."""
    head = "".join(f"<th>{_mathematics(escape(name))}</th>" for name in columns)
    body = "".join(
        "<tr>" + "".join(f"<td>{_mathematics(escape(str(value)))}</td>" for value in line) + "</tr>"
        for line in lines
    )
    return HTML(f'<table class="rows"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>')


def _mathematics(html: str) -> str:
    """Text between dollars as mathematics of the book: MathJax ignores dollars in outputs."""
    return re.sub(r"\$([^$]+)\$", r'<span class="math notranslate nohighlight">\\(\1\\)</span>', html)


def common_keys() -> HTML:
    """The keys of all kinds, as a list of definitions."""
    return _definitions("every case", listing.common_keys())


def keys(kind: str) -> HTML:
    """Every key of a kind, as a list of definitions with an address each.

    Raises
    ------
    InputError : there is no such kind.
    """
    return _definitions(kind, listing.keys(kind), f"<p>{_prose(listing.title(kind))}</p>")


def _definitions(kind: str, found: Sequence[Key], before: str = "") -> HTML:
    entries = []
    for key in found:
        address = anchor(kind, key)
        where = f' where <code>{key.by} = "{key.when}"</code>' if key.when and key.name != key.by else ""
        about = key.value.innermost.about
        marks = (
            [f"${about.symbol}$" if about.symbol else "", cited(about.source)]
            if isinstance(about, Quantity | Count)
            else []
        )
        source = ", ".join(filter(None, marks))
        entries.append(
            f'<dt id="{address}"><a href="#{address}"><code>{key.path}</code></a>{where}</dt>'
            f"<dd><p>{_linked(key)}; {escape(need(key))}</p><p>{_prose(key.meaning)}</p>"
            + (f"<p>{_mathematics(escape(source))}</p>" if source else "")
            + "</dd>"
        )
    return HTML(f'{before}<dl class="keys">{"".join(entries)}</dl>')


def anchor(kind: str, key: Key) -> str:
    """The address of a key on the page of all keys."""
    words = ".".join(filter(None, (kind, key.path.replace("[]", ""), key.when)))
    return words.replace(" ", "-")


def _linked(key: Key) -> str:
    """The type of a key; a whole problem leads to the keys of its kind."""
    kind = key.value.problem
    link = f'<a href="#{kind.replace(" ", "-")}">{kind}</a>'
    return escape(type_of(key), quote=False).replace(f'"{kind}"', link) if kind else escape(type_of(key))


def _prose(text: str) -> str:
    """A docstring as a paragraph; text between backquotes is code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(" ".join(text.split())))


def errata(*standings: str) -> dict[str, Erratum]:
    """The entries of the errata table with one of the standings, or all."""
    known = read_errata(results() / "errata.toml")
    return {name: item for name, item in known.items() if not standings or item.standing in standings}


def left_out() -> LeftOutList:
    """Parts of the thesis that are left out, with the reasons."""
    return read_left_out(results() / "left_out.toml")


def source(thing: Any) -> Markdown:
    """The lines of the library that define a function or class."""
    return _code(thing, inspect.getsource(getattr(thing, "py_func", thing)))


def excerpt(thing: Any, first: str, last: str) -> Markdown:
    """The lines of a function from the one with `first` up to, but without, the one with `last`."""
    lines = inspect.getsource(getattr(thing, "py_func", thing)).splitlines()
    start = next(number for number, line in enumerate(lines) if first in line)
    stop = next(number for number, line in enumerate(lines) if last in line and number > start)
    return _code(thing, "\n".join(lines[start:stop]))


def _code(thing: Any, text: str) -> Markdown:
    place = f"{thing.__module__.replace('.', '/')}.py"
    return Markdown(
        f"`{thing.__qualname__}` in `{place}`\n\n```python\n{textwrap.dedent(text).strip()}\n```"
    )


def text(sentence: str) -> Markdown:
    """A sentence with measured numbers in it."""
    return Markdown(sentence)
