"""The keys of a case as plain text of at most 100 columns: `cosserat describe`."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence

from cosserat.describe.keys import Key, Value, common_keys, described, keys, title
from cosserat.errors import InputError
from cosserat.explain import cited
from cosserat.parameters import Count, Items, Quantity, nearest
from cosserat.text import shortened
from cosserat.units import what_is_in

WIDTH = 100
"""Longest line."""


def list_of_kinds() -> str:
    """Every kind with its description, a line each, and the keys of every case."""
    width = max(map(len, described()))
    lines = [f"{kind:<{width}}  {title(kind)}" for kind in described()]
    return "\n".join(
        [
            *lines,
            "",
            "'cosserat describe KIND' lists the keys of a case of that kind, 'cosserat describe KIND KEY' those",
            "of one table, such as rod.section or forces.  Every case may also have:",
            "",
            *(paragraph(key) for key in common_keys()),
        ]
    )


def description(words: Sequence[str]) -> str:
    """What `cosserat describe` answers to these words: a kind, perhaps with one of its keys behind it.

    Raises
    ------
    InputError : there is no such kind or key.
    """
    if not words:
        return list_of_kinds()
    kind, inner = " ".join(words), " ".join(words[:-1])
    return list_of_keys(inner, words[-1]) if inner in described() else list_of_keys(kind)


def list_of_keys(kind: str, under: str = "") -> str:
    """Every key of a kind with its type, unit, range, default, meaning and source.

    under : a key, such as rod.section or forces, of which and inside which the keys are.

    Raises
    ------
    InputError : there is no such kind or key.
    """
    found: Sequence[Key] = keys(kind)
    if under:
        named = [(key.path.replace("[]", ""), key) for key in found]
        found = [key for path, key in named if f"{path}.".startswith(f"{under}.")]
        if not found:
            level = list(dict.fromkeys(path for path, _ in named if path.count(".") == under.count(".")))
            raise InputError(
                f"there is no key '{shortened(under)}' in kind '{kind}'{nearest(under, level)}"
            )
    return "\n\n".join([f"{kind}: {title(kind)}", *(paragraph(key, told) for key, told in _once(found))])


def _once(found: Sequence[Key]) -> Iterator[tuple[Key, str]]:
    """The keys, without those inside tables that are like another; of such a table the path of that other."""
    alike: dict[tuple[type, ...], list[str]] = {}
    for key in found:
        if key.value.innermost.tables and not key.value.problem:
            alike.setdefault(key.value.innermost.tables, []).append(key.path)
    folded = {
        path: home
        for paths in alike.values()
        for home in [min(paths, key=lambda path: path.count("[]"))]
        for path in paths
        if path != home
    }
    inside = tuple(start for path in folded for start in (f"{path}.", f"{path}[]."))
    for key in found:
        if not key.path.startswith(inside):
            yield key, folded.get(key.path, "")


def paragraph(key: Key, like: str = "") -> str:
    """Description of a key, in a few lines; `like` : the path of a table that has the same keys inside."""
    where = f'   (where {key.by} = "{key.when}")' if key.when and key.name != key.by else ""
    lines = [f"{type_of(key)}; {need(key)}", key.meaning, thesis(key)]
    lines += [f"The keys inside are those of {like}."] if like else []
    wrapped = [
        textwrap.fill(" ".join(line.split()), WIDTH, initial_indent="    ", subsequent_indent="    ")
        for line in lines
        if line
    ]
    return "\n".join([key.path + where, *wrapped])


def type_of(key: Key) -> str:
    """Type of a key, with unit and range."""
    return _type(key.value)


def need(key: Key) -> str:
    """Whether a key is required, and its default."""
    if key.required:
        return "required"
    return "may be left out" if key.default in (None, "{}") else f"default {key.default}"


def thesis(key: Key) -> str:
    """Symbol and place in the thesis, if they are given."""
    about = key.value.innermost.about
    parts = [] if about is None or isinstance(about, Items) else [about.symbol, cited(about.source)]
    return f"Thesis: {', '.join(filter(None, parts))}" if any(parts) else ""


def span(about: Quantity | Count | Items) -> str:
    """The range of a quantity in its SI unit, of a count, or of the number of items of a list."""
    if isinstance(about, Count):
        return f"from {about.at_least} to {about.at_most}"
    return about.range


def _type(value: Value) -> str:
    if value.said:
        return value.said
    words = {
        "count": "a whole number",
        "name": "the name of a case, or a list of names",
        "keys": "a table of keys, as in a case",
        "number": "a number",
        "text": "a text",
        "truth": "true or false",
        "table": "a table",
    }
    if value.form == "quantity":
        assert isinstance(value.about, Quantity)
        unit = value.about.unit
        words["quantity"] = what_is_in(unit) + ("" if unit == "1" else f" in {unit}")
    if value.form == "word":
        return _either([f'"{word}"' for word in value.words])
    if value.form == "list":
        assert isinstance(value.about, Items)
        many = "" if value.about == Items() else f" of {span(value.about)}"
        items = value.items[0]
        if items.tables:
            return f"a list{many or ' of'} tables"
        return f"a list{many}, each item {_type(items)}"
    if value.form == "names":
        return f"a table of names, each with {_type(value.items[0])}"
    if value.form == "either":
        return _either([_type(item) for item in value.items])
    if value.form == "row":
        return f"[{', '.join(_type(item) for item in value.items)}]"
    if value.problem:
        return f'a table, a whole problem of kind "{value.problem}"'
    if value.form == "table" and value.items:
        return _either(["a table", *map(_type, value.items)])
    limits = span(value.about) if value.about else ""
    return words[value.form] + (f" ({limits})" if limits else "")


def _either(words: list[str]) -> str:
    return " or ".join(filter(None, (", ".join(words[:-1]), words[-1])))
