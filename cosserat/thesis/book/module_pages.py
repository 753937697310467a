"""Pages with the source of the modules that the book names, each line as it is, small."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from html import escape
from importlib import resources

_NAMED = re.compile(r"\bcosserat/((?:\w+/)*\w+\.py)\b")
_HOME = '<p><a href="../index.html">The first page of the book</a></p>'
_SHOWN = {"Comment": "c1", "Literal.String.Doc": "sd", "Keyword": "k"}
"""Tokens with a class of their own; text in other colours would double a page."""


def pages(texts: Iterable[str]) -> Iterator[tuple[str, dict[str, str], str]]:
    """Name, context and template of a page for each module of the package that the texts name."""
    package = resources.files("cosserat")
    named = {name for text in texts for name in _NAMED.findall(text)}
    for name in sorted(named):
        file = package / name
        if file.is_file():
            path = f"cosserat/{name}"
            yield (
                address(path),
                {"title": path, "body": body(path, file.read_text("utf-8"))},
                "page.html",
            )


def address(path: str) -> str:
    """The name of the page of a module, without its ending."""
    return f"source/{path.removesuffix('.py').replace('/', '.')}"


def body(path: str, text: str) -> str:
    """The source of a module as HTML; every function and class at the margin is an anchor with its full name."""
    module = path.removesuffix(".py").replace("/", ".")
    starts = {
        node.lineno: f"{module}.{node.name}"
        for node in ast.parse(text).body
        if isinstance(node, ast.FunctionDef | ast.ClassDef)
    }
    lines = coloured(text).split("\n")
    marked = [
        f'<span id="{starts[number]}"></span>{line}' if number in starts else line
        for number, line in enumerate(lines, 1)
    ]
    return (
        f'<h1>{path}</h1>{_HOME}<div id="module" class="highlight source"><pre tabindex="0">'
        + "\n".join(marked)
        + "</pre></div>"
    )


def coloured(text: str) -> str:
    """Python with comments, docstrings and keywords in spans."""
    from pygments.lexers.python import PythonLexer

    parts = []
    for token, value in PythonLexer(stripnl=False).get_tokens(text):
        shown = next(
            (mark for kind, mark in _SHOWN.items() if str(token).startswith(f"Token.{kind}")), ""
        )
        if not shown or not value.strip():
            parts.append(escape(value, quote=False))
        else:
            lines = (
                f'<span class="{shown}">{escape(line, quote=False)}</span>' if line.strip() else line
                for line in value.split("\n")
            )
            parts.append("\n".join(lines))
    return "".join(parts).rstrip("\n")
