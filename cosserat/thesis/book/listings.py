"""Lines of the library and of its case files, beside the equations."""

from __future__ import annotations

import inspect
import pkgutil
import re
import textwrap
from importlib import resources
from typing import Any

from IPython.display import Markdown

from cosserat.errors import InputError


def source(thing: Any) -> Markdown:
    """The lines of the library that define a function or class, given itself or its full name."""
    found = _found(thing)
    return _code(found, inspect.getsource(getattr(found, "py_func", found)))


def excerpt(thing: Any, first: str, last: str = "") -> Markdown:
    """The lines of a function from the one with `first` up to, but without, the one with `last`, or to its end.

    Raises
    ------
    InputError : the function has no such line.
    """
    found = _found(thing)
    lines = inspect.getsource(getattr(found, "py_func", found)).splitlines()
    start = _line(found, lines, first, 0)
    stop = _line(found, lines, last, start + 1) if last else len(lines)
    return _code(found, "\n".join(lines[start:stop]))


def _line(thing: Any, lines: list[str], text: str, begin: int) -> int:
    """The number of the first line with a text, not before the line `begin`."""
    for number in range(begin, len(lines)):
        if text in lines[number]:
            return number
    raise InputError(f"{thing.__qualname__} has no line with '{text}'")


def _found(thing: Any) -> Any:
    """A function or class by its full name, such as "cosserat.rods.directed_rod.forces"."""
    if not isinstance(thing, str):
        return thing
    try:
        return pkgutil.resolve_name(thing)
    except (ImportError, AttributeError, ValueError):
        raise InputError(f"the library has no '{thing}'") from None


def _code(thing: Any, text: str) -> Markdown:
    place = f"{thing.__module__.replace('.', '/')}.py"
    return Markdown(
        f"`{thing.__qualname__}` in `{place}`\n\n```python\n{textwrap.dedent(text).strip()}\n```"
    )


def _without_next_title(table: str) -> str:
    """A table of a case file without the comment lines that stand over the next one."""
    lines = table.strip().splitlines()
    while lines and (lines[-1].startswith("#") or not lines[-1].strip()):
        lines.pop()
    return "\n".join(lines)


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
    code = "\n\n".join(_without_next_title(part) for part in [*bases, *own])
    return Markdown(f"```toml\n{code}\n```")
