"""Cases from TOML files.  The published ones are part of the package; users write their own."""

from __future__ import annotations

import functools
import json
import re
import reprlib
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, SerializeAsAny
from pydantic_core import PydanticCustomError

from cosserat.errors import InputError, path_of
from cosserat.parameters import Dropped, Parameters, nearest, tables_with_a_choice
from cosserat.problem import Problem
from cosserat.publications import kinds, published_tables, titles

P = TypeVar("P")


def _check_name(name: str) -> str:
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_-]*", name):
        raise PydanticCustomError(
            "name", f"is {name!r}, which cannot name a file; use letters, digits, '_' and '-'"
        )
    return name


class Case(Parameters):
    """One computation: a name, a title, its place in the thesis, and the problem itself."""

    name: Annotated[str, AfterValidator(_check_name)]
    """Name of the case: of its table in a file, and of its result file."""
    title: str
    """Description in a few words; the name by default."""
    source: str = ""
    """Its place in the thesis, or its origin."""
    problem: SerializeAsAny[Problem]
    """The problem to solve."""

    def __repr__(self) -> str:
        about = (self.problem.kind, self.problem.body, self.source or "a case of the user")
        return f"<Case '{self.name}': {'; '.join(filter(None, about))}>"

    __str__ = __repr__

    def vary(self, name: str, **changes: Any) -> Case:
        """A case of another name with parts of the problem changed: `case.vary("long", rod={"length": "10 m"})`.

        Tables merge key by key, lists are replaced, and numbers may be in SI units or texts with a unit.  The word
        "none" drops a key of this case.

        Raises
        ------
        InputError : a key is unknown or a value is not valid.
        """
        table = _merge(_given(self.problem.model_dump()), changes)
        problem = type(self.problem).read(table, f"case '{name}'", units_required=False)
        return Case.read({"name": name, "title": name, "problem": problem}, "case")

    def problem_as(self, asked: type[P]) -> P:
        """The problem, if it is one of these.

        Raises
        ------
        InputError : it is of another kind.
        """
        if not isinstance(self.problem, asked):
            fitting = [name for name, kind in kinds().items() if issubclass(kind.problem_class(), asked)]
            raise InputError(
                f"the case '{self.name}' is of kind '{self.problem.kind}'; use one of kind "
                + " or ".join(f"'{name}'" for name in fitting)
            )
        return self.problem


@functools.cache
def published() -> Mapping[str, Case]:
    """The cases of the thesis by name, in the order of the files."""
    return {name: _published_case(name) for name in titles()}


@functools.cache
def _published_case(name: str) -> Case:
    return _build(name, published_tables())


def find(name: str, file: str | Path | None = None) -> Case:
    """The case of that name: from `file` if one is given, else from the published ones.

    Raises
    ------
    InputError : no such case or file, or the case is not valid.
    """
    if not isinstance(name, str):
        raise InputError(
            f"a case is found by its name, a text such as 'clamped_free', not by {reprlib.repr(name)}"
        )
    if file is None and name in titles():
        return _published_case(name)
    if file is not None:
        tables = _read(file)
        if name in tables and not name.startswith("_"):
            return _build(name, published_tables() | tables, path_of(file).parent)
    known = published() if file is None else load(file)
    if name not in known:
        place = "" if file is None else f" in {file}"
        raise InputError(f"there is no case '{name}'{place}{nearest(name, list(known))}")
    return known[name]


def load(file: str | Path) -> Mapping[str, Case]:
    """All cases of a TOML file, by name; `like` may name a published case.

    Raises
    ------
    InputError : the file cannot be read, is not TOML, or one of its cases is not valid.
    """
    tables = _read(file)
    return _build_all(tables, published_tables() | tables, path_of(file).parent)


def _read(file: str | Path) -> dict[str, Any]:
    """The tables of a case file."""
    file = path_of(file)
    text = ""
    try:
        text = file.read_text(encoding="utf-8-sig")
        tables = tomllib.loads(text)
    except OSError as error:
        raise InputError(
            f"cannot read the case file {file}: {error.strerror}; give the path of a TOML file"
        ) from None
    except UnicodeDecodeError:
        raise InputError(
            f"{file} is not TOML: it is not in UTF-8 (perhaps in UTF-16 or Latin-1); save it as UTF-8"
        ) from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{file} is not TOML: {error}; {_remedy(str(error), text)}") from None
    stray = [key for key, value in tables.items() if not isinstance(value, dict)]
    if stray:
        raise InputError(
            f"{file}: '{stray[0]}' is outside a case; put it below the case's name, such as [my_rod]"
        )
    if not tables:
        raise InputError(f"{file} holds no case; begin one with its name, such as [my_rod]")
    return tables


def _remedy(error: str, text: str) -> str:
    """The remedy for a text that is not TOML, by what people often write."""
    if re.search(r"immutable|Cannot (?:overwrite|declare)", error):
        return "give each key once; to a table written between braces nothing can be added elsewhere"
    place = re.search(r"at line (\d+)", error)
    line = text.split("\n")[int(place[1]) - 1] if place else ""
    number = r"=\s*[+-]?\d[\d_]*"
    if re.search(rf"{number},\d", line):
        return "for a decimal comma write a decimal point"
    if re.search(rf"{number}(?:\.\d*)?(?:[eE][+-]?\d+)?\s*[^\W\d_]", line):
        return 'write a number that has a unit between quotation marks, such as "2.5 mm"'
    if "key part" in error and line.rstrip().endswith(("{", ",")):
        return 'keep a table between braces on one line, or write its keys with dots, such as rod.length = "1 m"'
    return "see the published cases in cosserat/thesis/cases for examples"


def parse(parameters: str) -> Case:
    """The case in the `parameters` attribute of a Dataset, JSON in SI units.

    Raises
    ------
    InputError : the text is not such a case.
    """
    try:
        table = json.loads(parameters)
        if not isinstance(table, dict) or not isinstance(table.get("problem"), dict):
            raise InputError("there is no table 'problem'")
        problem = _read_problem(dict(table["problem"]), "problem", units_required=False)
        return Case.read({**table, "problem": problem}, "case")
    except (json.JSONDecodeError, InputError) as error:
        raise InputError(
            f"the parameters are not those of a case of this version of cosserat ({error}); run the case again by "
            "its name"
        ) from None


def _build_all(asked: Mapping[str, Any], known: Mapping[str, Any], folder: Path) -> dict[str, Case]:
    return {name: _build(name, known, folder) for name in asked if not name.startswith("_")}


def _build(name: str, known: Mapping[str, Any], folder: Path | None = None) -> Case:
    """A case of these tables; files that it names are in the folder."""
    table = _inherit(name, known, ())
    own = known[name]
    title, source = (own.get(key, "") for key in ("title", "source"))  # a title is not inherited
    problem = _read_problem(table, f"case '{name}'", units_required=True, folder=folder)
    about = {"name": name, "title": title or name, "source": source, "problem": problem}
    return Case.read(about, f"case '{name}'")


def _read_problem(
    table: dict[str, Any], name: str, *, units_required: bool, folder: Path | None = None
) -> Problem:
    """The problem of a table, read by the class of its kind."""
    kind = table.pop("kind", "")
    if not isinstance(kind, str) or kind not in kinds():
        raise InputError(f"{name}: 'kind' is {kind!r}{nearest(str(kind), list(kinds()))}")
    reader = kinds()[kind].problem_class().read
    return reader(table, name, units_required=units_required, folder=folder)


def _inherit(name: str, known: Mapping[str, Any], seen: tuple[str, ...]) -> dict[str, Any]:
    """The table of a case with everything inherited by `like`."""
    if name in seen:
        raise InputError(
            f"case '{name}': its 'like' refers back to itself ({' -> '.join((*seen, name))}); remove the cycle"
        )
    if name not in known:
        raise InputError(
            f"case '{seen[-1]}': 'like' names no case: {name!r}{nearest(name, list(known))}"
        )
    table: dict[str, Any] = {}
    own = {key: value for key, value in known[name].items() if key not in ("title", "source")}
    bases = own.pop("like", [])
    for base in bases if isinstance(bases, list) else [bases]:
        table = _merge(table, _inherit(str(base), known, (*seen, name)))
    for key, value in own.items():
        if isinstance(value, dict) and "like" in value:  # a whole case as a part of this one
            part = {inner: given for inner, given in value.items() if inner != "like"}
            own[key] = _merge(_inherit(str(value["like"]), known, (*seen, name)), part)
    return _merge(table, own)


def _merge(
    base: Mapping[str, Any], own: Mapping[str, Any], path: tuple[str, ...] = ()
) -> dict[str, Any]:
    """Both tables, key by key; a table of another shape or kind replaces the one of the base as a whole.

    The word "none" marks a key of the base as dropped.
    """
    merged = dict(base)
    for key, value in own.items():
        old, inner = merged.get(key), (*path, key)
        if isinstance(value, dict) and isinstance(old, dict):
            kept = dict.fromkeys(old, Dropped()) if _is_another(old, value, inner) else old
            merged[key] = _merge(kept, value, inner)
        elif isinstance(value, str) and value == "none" and key in merged:
            merged[key] = Dropped(value)
        else:
            merged[key] = value
    return merged


def _given(table: Mapping[str, Any]) -> dict[str, Any]:
    """A table whose values of None are marked as dropped: another kind of table inside it may not have these keys."""
    return {
        key: _given(value) if isinstance(value, dict) else Dropped() if value is None else value
        for key, value in table.items()
    }


def _is_another(base: Mapping[str, Any], own: Mapping[str, Any], path: tuple[str, ...]) -> bool:
    """Whether a table makes another choice than the one of the base, where there is a choice of classes."""
    differing = [
        key for key, value in own.items() if isinstance(value, str) and base.get(key, value) != value
    ]
    return bool(differing) and _choosers().get(path) in differing


@functools.cache
def _choosers() -> Mapping[tuple[str, ...], str]:
    """Key that chooses the class of a table, by the path of the table in problems of any kind."""
    return {
        path: key
        for kind in kinds().values()
        for path, key in tables_with_a_choice(kind.problem_class())
    }
