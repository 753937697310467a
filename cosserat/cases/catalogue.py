"""Cases from TOML files.  The published ones are part of the package; users write their own."""

from __future__ import annotations

import functools
import json
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, SerializeAsAny

from cosserat.cases.tables import Tables, merged
from cosserat.errors import InputError, path_of
from cosserat.parameters import Dropped, Parameters, nearest
from cosserat.problem import Problem
from cosserat.publications import FIT, STUDY, kinds, published_tables, titles
from cosserat.reading import read_text
from cosserat.text import Title, checked_name, shortened, shown

P = TypeVar("P")

_MOST_BYTES = 1_000_000  # of a case file
_MOST_JSON = 20_000_000
_MOST_CASES = 1000
_MOST_DOTS = 30
_PART = r"""(?:[\w-]+|"(?:[^"\\\n]|\\.){0,200}"|'[^'\n]{0,200}')[ \t]*\.[ \t]*"""
_LONG_KEY = re.compile(rf"(?<![\w\-\"'\\])(?:{_PART}){{{_MOST_DOTS}}}")
_NO_NEED = "no case needs it"


def _check_name(name: str) -> str:
    remedy = ", which cannot name a file; use letters, digits, '_' and '-'"
    return checked_name(name, r"[A-Za-z][A-Za-z0-9_-]*", remedy)


class Case(Parameters):
    """One computation: a name, a title, its place in the thesis, and the problem itself."""

    name: Annotated[str, AfterValidator(_check_name)]
    """Name of the case: of its table in a file, and of its result file."""
    title: Title
    """Description in a few words; the name by default."""
    source: Title = ""
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
        table = merged(given(self.problem.model_dump()), changes)
        problem = type(self.problem).read(table, f"case '{shortened(str(name))}'", units_required=False)
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
    return _build(name, Tables(published_tables()))


def find(name: str, file: str | Path | None = None) -> Case:
    """The case of that name: from `file` if one is given, else from the published ones.

    Raises
    ------
    InputError : no such case or file, or the case is not valid.
    """
    if not isinstance(name, str):
        raise InputError(
            f"a case is found by its name, a text such as 'clamped_free', not by {shown(name)}"
        )
    if file is None and name in titles():
        return _published_case(name)
    tables = {} if file is None else _read(file)
    if file is not None and name in _names(tables):
        return _build(name, Tables(published_tables() | tables), path_of(file).parent)
    if tables.get(name, {}).get("kind") == FIT:
        raise InputError(f"'{name}' is a fit, not a case; solve it by 'cosserat fit {name}'")
    if _is_study((published_tables() | tables).get(name, {})):
        raise InputError(
            f"'{name}' is a study, not a case; solve it by 'cosserat study {name}', or one case of it by --member"
        )
    place, known = ("", list(titles())) if file is None else (f" in {file}", _names(tables))
    raise InputError(f"there is no case '{shortened(name)}'{place}{nearest(name, known)}")


def case_given(case: Case | str, function: str) -> Case:
    """The case that a function was called with, by itself or by the name of a published one.

    Raises
    ------
    InputError : it is neither, or there is none of that name.
    """
    if isinstance(case, str):
        return find(case)
    if not isinstance(case, Case):
        raise InputError(f"{function} takes a case or the name of a published one, not {shown(case)}")
    return case


def find_base(name: str, file: str | Path | None = None) -> Case:
    """What a study varies: a case of `file`, a published one, or a base of cases whose name begins with '_'.

    Raises
    ------
    InputError : there is none of that name, or it is not valid.
    """
    own = {} if file is None else _read(file)
    tables = published_tables() | own
    known = [other for other, table in tables.items() if not _is_about_cases(table)]
    if name not in known:
        raise InputError(
            f"there is no case '{shortened(name)}' for a study to vary{nearest(name, known)}"
        )
    folder = path_of(file).parent if file is not None and name in own else None
    return _build(name, Tables(tables), folder)


def load(file: str | Path) -> Mapping[str, Case]:
    """All cases of a TOML file, by name; a case may be like a published one.

    Raises
    ------
    InputError : the file cannot be read, is not TOML, or one of its cases is not valid.
    """
    tables = _read(file)
    known = Tables(published_tables() | tables)
    return {name: _build(name, known, path_of(file).parent) for name in _names(tables)}


def study_tables(file: str | Path | None = None) -> dict[str, dict[str, Any]]:
    """The tables of the studies of a case file, or of the published ones, by name; `cosserat.studies` reads them.

    Raises
    ------
    InputError : the file cannot be read.
    """
    tables = published_tables() if file is None else _read(file)
    known = Tables(published_tables() | tables)
    names = [name for name, table in tables.items() if _is_study(table) and not name.startswith("_")]
    return {name: known.inherited(name) | _titles(tables[name]) for name in names}


def _titles(table: Mapping[str, Any]) -> dict[str, Any]:
    return {key: table[key] for key in ("title", "source") if key in table}


def _names(tables: Mapping[str, Any]) -> list[str]:
    """The names of the cases of a file, without bases of cases and studies."""
    return [
        name for name, table in tables.items() if not name.startswith("_") and not _is_about_cases(table)
    ]


def fit_tables(file: str | Path) -> dict[str, dict[str, Any]]:
    """The tables of the fits of a case file, by name; `cosserat.studies` reads them.

    Raises
    ------
    InputError : the file cannot be read.
    """
    return {name: table for name, table in _read(file).items() if table.get("kind") == FIT}


def _is_about_cases(table: Mapping[str, Any]) -> bool:
    """Whether a table is no case, but about cases."""
    return _is_study(table) or table.get("kind") == FIT


def _is_study(table: Mapping[str, Any]) -> bool:
    return table.get("kind") == STUDY or "vary" in table


def _read(file: str | Path) -> dict[str, Any]:
    """The tables of a case file."""
    file = path_of(file)
    text = ""
    try:
        text = read_text(file, _MOST_BYTES)
        if _LONG_KEY.search(text):
            raise InputError(
                f"{file} has a key of more than {_MOST_DOTS} parts; no key of a case has so many"
            )
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
        said = shortened(str(error), 200)
        raise InputError(f"{file} is not TOML: {said}; {_remedy(str(error), text)}") from None
    except RecursionError:
        raise InputError(
            f"{file} has lists or tables inside each other, too deep to read; {_NO_NEED}"
        ) from None
    except ValueError:
        raise InputError(f"{file} has a whole number of thousands of digits; {_NO_NEED}") from None
    stray = [key for key, value in tables.items() if not isinstance(value, dict)]
    if stray:
        raise InputError(
            f"{file}: '{shortened(stray[0])}' is outside a case; put it below the case's name, such as [my_rod]"
        )
    if len(tables) > _MOST_CASES:
        raise InputError(f"{file} has {len(tables)} cases; write up to {_MOST_CASES} into one file")
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
        table = _from_json(parameters)
        problem = _read_problem(dict(table["problem"]), "problem", units_required=False)
        return Case.read({**table, "problem": problem}, "case")
    except InputError as error:
        said = shortened(str(error), 350)
        raise InputError(
            f"the parameters are not those of a case of this version of cosserat ({said}); run the case again by "
            "its name"
        ) from None


def _from_json(text: str) -> dict[str, Any]:
    """The table of a case in JSON."""
    if not isinstance(text, str):
        raise InputError(f"{shown(text)} is no text")
    if len(text) > _MOST_JSON:
        raise InputError(f"they are longer than {_MOST_JSON / 1e6:g} million characters")
    try:
        table = json.loads(text)
    except json.JSONDecodeError as error:
        raise InputError(str(error)) from None
    except RecursionError:
        raise InputError("lists or tables are inside each other, too deep to read") from None
    except ValueError:
        raise InputError("a whole number has thousands of digits") from None
    if not isinstance(table, dict) or not isinstance(table.get("problem"), dict):
        raise InputError("there is no table 'problem'")
    return table


def _build(name: str, known: Tables, folder: Path | None = None) -> Case:
    """A case of these tables; files that it names are in the folder."""
    table, own = known.inherited(name), known[name]
    title, source = (own.get(key, "") for key in ("title", "source"))  # a title is not inherited
    called = f"case '{shortened(name)}'"
    problem = _read_problem(table, called, units_required=True, folder=folder)
    plain = name.lstrip("_")  # of a base
    about = {
        "name": plain,
        "title": plain if title == "" else title,
        "source": source,
        "problem": problem,
    }
    return Case.read(about, called)


def _read_problem(
    table: dict[str, Any], name: str, *, units_required: bool, folder: Path | None = None
) -> Problem:
    """The problem of a table, read by the class of its kind."""
    kind = table.pop("kind", "")
    if not isinstance(kind, str) or kind not in kinds():
        near = nearest(shortened(str(kind)), list(kinds()))
        raise InputError(f"{name}: 'kind' is {shown(kind)}{near}")
    reader = kinds()[kind].problem_class().read
    return reader(table, name, units_required=units_required, folder=folder)


def given(table: Mapping[str, Any]) -> dict[str, Any]:
    """A table whose values of None are marked as dropped: another kind of table inside it may not have these keys."""
    return {
        key: given(value) if isinstance(value, dict) else Dropped() if value is None else value
        for key, value in table.items()
    }
