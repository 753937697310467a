"""The keys of case files as lists of definitions."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape

from IPython.display import HTML

from cosserat.describe import keys as listing
from cosserat.describe.keys import Key
from cosserat.describe.text import need, type_of
from cosserat.explain import cited
from cosserat.parameters import Count, Quantity
from cosserat.thesis.book.examples_of_keys import examples
from cosserat.thesis.book.tables import mathematics


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
            + (f"<p>{mathematics(escape(source))}</p>" if source else "")
            + _example(kind, key)
            + "</dd>"
        )
    return HTML(f'{before}<dl class="keys">{"".join(entries)}</dl>')


def _example(kind: str, key: Key) -> str:
    """The key as a published case writes it, and how many others do."""
    cases = examples().get((kind, key.path), [])
    if not cases:
        return ""
    name, value = cases[0]
    others = f" and {len(cases) - 1} more" if len(cases) > 1 else ""
    written = escape(f"{key.path.rsplit('.', 1)[-1]} = {value}", quote=False)
    return f"<p>As in <code>{name}</code>{others}: <code>{written}</code></p>"


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
