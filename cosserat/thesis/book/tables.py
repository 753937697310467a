"""Plain tables, and mathematics in the outputs of cells."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape

from IPython.display import HTML


def table(lines: Sequence[Sequence[object]], columns: Sequence[str]) -> HTML:
    """A plain table; text between dollars is mathematics."""
    head = "".join(f'<th scope="col">{mathematics(escape(name))}</th>' for name in columns)
    body = "".join(
        "<tr>" + "".join(f"<td>{mathematics(escape(str(value)))}</td>" for value in line) + "</tr>"
        for line in lines
    )
    return HTML(
        f'<table class="rows" tabindex="0"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'
    )


def folded(summary: str, body: HTML) -> HTML:
    """An output that opens from one line."""
    line = mathematics(escape(summary))
    return HTML(f'<details class="verdict"><summary>{line}</summary>{body.data}</details>')


def mathematics(html: str) -> str:
    """Text between dollars as mathematics of the book: MathJax ignores dollars in outputs."""
    return re.sub(r"\$([^$]+)\$", r'<span class="math notranslate nohighlight">\\(\1\\)</span>', html)
