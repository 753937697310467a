"""Plain tables, and mathematics, code and symbols in the outputs of cells."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape

from IPython.display import HTML

_GREEK = "Delta|Pi|gamma|eta|kappa|lambda|mu|nu|phi|psi|rho|sigma|tau|theta|xi"
_SYMBOL = re.compile(
    rf"(?<![\\\w$])(?P<greek>{_GREEK})(?P<index>_\w+)?(?!\w)"
    r"|(?<![\w\\./])(?P<letter>[A-Za-z])_(?P<under>\w{1,2})(?![\w(])"
    r"|(?<!\w)(?P<part>K?)c(?P<number>[1-7])(?!\w)"
    r"|(?<![\w.])(?P<base>\d+|[A-Za-z])\^(?P<power>-?[\d.]*\d|\w)(?!\w)"
)
"""Symbols as plain text has them: "mu_1", "t_p", "Kc3", "10^0.4"."""


def table(lines: Sequence[Sequence[object]], columns: Sequence[str]) -> HTML:
    """A plain table; text between dollars is mathematics.

    columns : if the first one begins with "Table 3.1", links of that name lead to this table.
    """
    name = re.match(r"Table (\d\.\d)", columns[0])
    rows = [row([mathematics(escape(str(value))) for value in line]) for line in lines]
    heads = [mathematics(escape(head)) for head in columns]
    return framed(rows, heads, anchor=f"table-{name[1]}" if name else "")


def row(cells: Sequence[str], *, marks: str = "", head: str = "") -> str:
    """A row of a table from the HTML of its cells.

    marks : attributes of the row.  head : the HTML of a heading before the cells.
    """
    return f"<tr{marks and f' {marks}'}>{head}{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"


def framed(
    rows: Sequence[str], columns: Sequence[str], *, anchor: str = "", what: str = "", foot: str = ""
) -> HTML:
    """A table of rows; each column has a name, as HTML.

    anchor : where links lead to.  foot : a line below the rows.
    what : what the rows are, such as "equations"; the reader then filters and sorts them.
    """
    head = "".join(f'<th scope="col">{name}</th>' for name in columns)
    last = f'<tfoot><tr><td colspan="{len(columns)}">{foot}</td></tr></tfoot>' if foot else ""
    place = f' id="{anchor}"' if anchor else ""
    table = (
        f'<table class="rows"{place} tabindex="0"><thead><tr>{head}</tr></thead>'
        f"<tbody>{''.join(rows)}</tbody>{last}</table>"
    )
    return HTML(f'<div class="filtered" data-what="{what}">{table}</div>' if what else table)


def unit(text: str) -> str:
    """A unit as HTML, with raised powers."""
    return re.sub(r"\^(-?\d+)", r"<sup>\1</sup>", escape(text))


def folded(summary: str, body: HTML) -> HTML:
    """An output that opens from one line."""
    line = mathematics(escape(summary))
    return HTML(f'<details class="verdict"><summary>{line}</summary>{body.data}</details>')


def mathematics(html: str) -> str:
    """Text between dollars as mathematics of the book: MathJax ignores dollars in outputs."""
    return re.sub(r"\$([^$]+)\$", r'<span class="math notranslate nohighlight">\\(\1\\)</span>', html)


def tens(number: float, digits: int = 1) -> str:
    """A number with so many digits and a power of ten, as mathematics."""
    digit, power = f"{number:.{digits - 1}e}".split("e")
    return f"${digit} \\cdot 10^{{{int(power)}}}$"


def prose(text: str) -> str:
    """A sentence of a table as HTML: mathematics between dollars, code between backquotes, *emphasis*."""
    parts = re.split(r"(\$[^$]+\$|`[^`]+`)", escape(text, quote=False))
    parts[::2] = [re.sub(r"\*(\w[^*]*)\*", r"<em>\1</em>", part) for part in parts[::2]]
    html = "".join(re.sub(r"^`(.*)`$", r"<code>\1</code>", part) for part in parts)
    return mathematics(html)


def typeset(text: str) -> str:
    """A plain text as HTML, with symbols such as mu_1, t_p, Kc3 and 10^3 as mathematics."""
    return mathematics(_SYMBOL.sub(_as_mathematics, escape(text, quote=False)))


def _as_mathematics(symbol: re.Match[str]) -> str:
    index = (symbol["index"] or symbol["under"] or "").lstrip("_")
    if symbol["greek"]:
        return f"$\\{symbol['greek']}{f'_{{{index}}}' if index else ''}$"
    if symbol["letter"]:
        return f"${symbol['letter']}_{{{index}}}$"
    if symbol["number"]:
        before = "{}_K " if symbol["part"] else ""
        return f"${before}c_{symbol['number']}$"
    return f"${symbol['base']}^{{{symbol['power']}}}$"
