"""Extension of Sphinx's autodoc: docstrings are plain text, parameter classes take keys."""

from __future__ import annotations

import functools
import inspect
import re
from typing import TYPE_CHECKING, Any

from cosserat.parameters import Parameters

if TYPE_CHECKING:
    from sphinx.application import Sphinx

_TERM = re.compile(r"(\w[\w, ]*) : (.*)")


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect the functions of this module; Sphinx calls this."""
    from sphinx.util.inspect import TypeAliasForwardRef

    setattr(TypeAliasForwardRef, "__repr__", lambda alias: alias.name)  # noqa: B010 - a name, also of a property
    app.connect("autodoc-process-docstring", _set_lines)
    app.connect("autodoc-process-signature", _signature)
    app.connect("autodoc-skip-member", _skips)
    return {"parallel_read_safe": True}


def _set_lines(_: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    lines[:] = as_markup(lines)


def as_markup(lines: list[str]) -> list[str]:
    """The lines of a docstring as reStructuredText; its only markup is code, sections and lists of terms.

    A paragraph that begins with "name : " is such a list, each term at the margin or after two blanks.
    """
    text = re.sub(r"(?<=\w)_(?=\W|$)|[*|\\]", r"\\\g<0>", "\n".join(lines).strip())
    text = re.sub(r"(?m)^(\w+)\n-+\n", r"\1:\n\n", text)
    paragraphs = [_terms(part) if _TERM.match(part) else part for part in text.split("\n\n")]
    return [*"\n\n".join(paragraphs).split("\n"), ""]


def _terms(paragraph: str) -> str:
    """A list of terms, one per item."""
    items = re.split(r"\n(?=\S)", re.sub(r"(?<=\.)  (?=\w[\w, ]* : )", "\n", paragraph))
    found = [(_TERM.match(item), " ".join(item.split())) for item in items]
    return "\n".join(
        f"* ``{term[1]}``: {text[len(term[1]) + 3 :]}" if term else f"  {text}" for term, text in found
    )


def _signature(
    _: Sphinx,
    what: str,
    name: str,
    thing: Any,
    options: Any,
    signature: str | None,
    returned: str | None,
) -> tuple[str | None, str | None]:
    """Signature: keys of a parameter class, with "=..." if they have a default; otherwise types by their names."""
    if isinstance(thing, type) and issubclass(thing, Parameters):
        fields = thing.model_fields.items()
        keys = [key if field.is_required() else f"{key}=..." for key, field in fields if key != "kind"]
        return f"({', '.join(['*', *keys])})" if keys else "()", None
    return signature and _short(signature), returned and _short(returned)


def _short(signature: str) -> str:
    """Arrays as "NDArray[float64]", and other types and functions by their names."""
    signature = signature.replace("<factory>", "...")
    signature = re.sub(r"(?:TypeAlias)?ForwardRef\('(\w+)'[^)]*\)|<function (\w+)>", r"\1\2", signature)
    return re.sub(r"~?(?:\w+\.)*ndarray\[.*?dtype\[~?(?:\w+\.)*(\w+)\]\]", r"NDArray[\1]", signature)


def _skips(_: Sphinx, what: str, name: str, thing: Any, skip: bool, options: Any) -> bool | None:
    """Skip members that are not methods: keys of parameter classes have their own page."""
    described = isinstance(thing, property | classmethod | functools.cached_property)
    called = inspect.isroutine(thing) and getattr(thing, "__name__", "") == name
    return None if called or described else True
