"""Error sentences: what validation found, in the words of a case."""

from __future__ import annotations

import ast
import difflib
import functools
import inspect
import itertools
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Literal, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails
from pydantic_core.core_schema import ErrorType

from cosserat.quantities import Count, Quantity, Reader
from cosserat.synonyms import meant
from cosserat.text import shortened, shown
from cosserat.units import how_to_write

Choice = list[type[BaseModel]]
"""Parameter classes for one place: one, or several that differ in one key, such as `kind` or `shape`."""


def chooser(choice: Sequence[type[BaseModel]]) -> str:
    """The key by which several classes for one place differ: each has its own word for it; empty if there is none."""
    for name in choice[0].model_fields if len(choice) > 1 else ():
        fields = [c.model_fields.get(name) for c in choice]
        words = [f.default for f in fields if f is not None and get_origin(f.annotation) is Literal]
        if len(set(words)) == len(choice):
            return name
    return ""


def classes_in(annotation: object) -> Choice:
    """Parameter classes in an annotation, at any depth."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [found for part in get_args(annotation) for found in classes_in(part)]


_MOST_FAULTS = 8  # that a sentence names
_MOST_SAID = 400  # characters about several faults
_MOST_MISSING = 3  # keys that are named after these faults

_EXPECTED = {
    "model_type": "a table of keys",
    "model_attributes_type": "a table of keys",
    "dict_type": "a table of keys",
    "union_tag_not_found": "a table of keys",
    "string_type": "a text",
    "string_sub_type": "a text",
    "string_unicode": "a text",
    "tuple_type": "a list",
    "list_type": "a list",
    "too_long": "a shorter list",
    "too_short": "a longer list",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
}
"""What must stand in the place of a value, by pydantic's name of the fault."""


def explain(error: ValidationError, owner: type[BaseModel], name: str) -> str:
    """One sentence with the faults that validation found, up to a few; a key may be missing as another is misspelt."""
    faults = sorted(error.errors(include_url=False), key=lambda fault: fault["type"] == "missing")
    clauses = list(_once(_clause(fault, owner) for fault in faults[:_MOST_FAULTS]))
    lengths = itertools.accumulate(map(len, clauses))
    told = max(1, sum(length < _MOST_SAID for length in lengths))
    missing = [_path(fault, owner) for fault in faults[told:] if fault["type"] == "missing"]
    missing = missing[:_MOST_MISSING]
    others = len(faults) - told - len(missing)
    more = [f"also missing: {', '.join(map(repr, missing))}"] if missing else []
    more += [f"and {others} more"] if others else []
    return f"{name}: " + "; ".join([*clauses[:told], *more])


def _once(clauses: Iterable[str]) -> Iterator[str]:
    """The clauses, each list of known words only where it is first."""
    told: set[str] = set()
    for clause in clauses:
        fault, _, known = clause.partition("; known are: ")
        yield fault if known in told else clause
        told |= {known} - {""}


def _path(fault: ErrorDetails, owner: type[BaseModel]) -> str:
    """The key of a fault, as in a case file."""
    parts = [
        shortened(str(part))
        for n, part in enumerate(fault["loc"])
        if not _chosen(part, _choice_at(owner, fault["loc"][:n]))
    ]
    return shortened(".".join(parts), 100)


def _clause(fault: ErrorDetails, owner: type[BaseModel]) -> str:
    loc, kind, given = fault["loc"], fault["type"], fault["input"]
    path = _path(fault, owner)
    if kind == "missing":
        return f"'{path}' is missing{_what_it_is(owner, loc)}"
    if kind == "extra_forbidden":
        keys = list(_choice_at(owner, loc[:-1])[0].model_fields)
        return f"'{path}' is not a key{nearest(str(loc[-1]), keys)}"
    if kind == "literal_error":
        return f"'{path}' is {shown(given)}; it must be {fault['ctx']['expected']}"
    if kind == "union_tag_invalid":
        key = chooser(_choice_at(owner, loc))
        tag = shown(fault["ctx"]["tag"])
        return f"'{path}.{key}' is {tag}; it must be {fault['ctx']['expected_tags']}"
    if kind == "union_tag_not_found" and isinstance(given, Mapping):
        choice = _choice_at(owner, loc)
        return f"'{path}.{chooser(choice)}' is missing: write {_words(choice, chooser(choice))}"
    if kind in _EXPECTED or kind in _OF_PYDANTIC:
        expected = _EXPECTED.get(kind, "as 'cosserat describe' says")
        return f"'{path}' is {shown(given)}; it must be {expected}"
    return f"'{path}' {fault['msg']}" if path else fault["msg"]


_OF_PYDANTIC = frozenset(get_args(ErrorType))
"""Faults whose words are pydantic's and not ours."""


def _words(choice: Choice, key: str) -> str:
    """The words of several classes for the key by which they differ."""
    return " or ".join(repr(c.model_fields[key].default) for c in choice)


def _what_it_is(owner: type[BaseModel], path: tuple[int | str, ...]) -> str:
    """The clause after a missing key: its meaning, its symbol and source, and how to write it."""
    key = str(path[-1])
    place = next((c for c in _choice_at(owner, path[:-1]) if key in c.model_fields), None)
    if place is None:
        return ""
    field = place.model_fields[key]
    own = docstrings(place).get(key)
    meaning = [_first_sentence(own)]
    remedy = "see the cases in cosserat/thesis/cases for examples"
    tables = classes_in(field.annotation)
    for about in field.metadata:
        if isinstance(about, Quantity | Count):
            letter = re.sub(r"\\(?:mathbf|bar|tilde)|[\\{}]", "", about.symbol)
            meaning.append(" of ".join(filter(None, (letter, cited(about.source)))))
            least = f"write a whole number, {about.at_least} or more" if isinstance(about, Count) else ""
            remedy = least or how_to_write(getattr(about, "unit", "1"))
        elif isinstance(about, Reader) and about.said:
            remedy = f"write {about.said}"
    if tables:
        needed = [name for name, inner in tables[0].model_fields.items() if inner.is_required()]
        meaning += [] if own else [_first_sentence(tables[0].__doc__)]
        tables_of = "list of tables" if get_origin(field.annotation) is tuple else "table"
        if choosing := chooser(tables):
            needed = [f"{choosing} = {_words(tables, choosing)}", "its keys"]
        remedy = f"write a {tables_of} with {', '.join(needed) or 'its keys'}"
    elif get_origin(field.annotation) is Literal:
        remedy = f"write {' or '.join(map(repr, get_args(field.annotation)))}"
    elif field.annotation is str and not any(isinstance(m, Quantity | Reader) for m in field.metadata):
        remedy = "write a text"
    return ", ".join(["", *filter(None, meaning)]) + f": {remedy}"


def cited(source: str) -> str:
    """A place in the thesis for a sentence: an equation by its number, anything else as given."""
    return f"eq. ({source})" if re.fullmatch(r"\d+(\.\d+){2}", source) else source


@functools.cache
def docstrings(owner: type[BaseModel]) -> Mapping[str, str]:
    """The docstrings of the fields of a class, with those of its bases."""
    found: dict[str, str] = {}
    for place in reversed(owner.__mro__):
        if not (issubclass(place, BaseModel) and inspect.get_annotations(place)) or place is BaseModel:
            continue
        body = ast.parse(textwrap.dedent(inspect.getsource(place))).body[0]
        assert isinstance(body, ast.ClassDef)
        for field, below in itertools.pairwise(body.body):
            if not isinstance(field, ast.AnnAssign):
                continue
            found.pop(key := ast.unparse(field.target), "")
            if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
                found[key] = inspect.cleandoc(str(below.value.value))
    return found


def _first_sentence(text: str | None) -> str:
    first = re.split(r"[.:;](?:\s|$)", (text or "").strip())[0]
    return first[:1].lower() + first[1:]


def _chosen(kind: int | str, choice: Choice) -> Choice:
    """The classes of one kind among several; validation puts the kind into the path like a key."""
    name = chooser(choice)
    return [c for c in choice if c.model_fields[name].default == kind] if name else []


def _choice_at(owner: type[BaseModel], path: tuple[int | str, ...]) -> Choice:
    """The possible parameter classes at a path of nested tables, lists and kinds."""
    choice = [owner]
    for part in path:
        fields = [c.model_fields[str(part)] for c in choice if str(part) in c.model_fields]
        choice = _chosen(part, choice) or (classes_in(fields[0].annotation) if fields else choice)
    return choice or [owner]


def nearest(word: str, known: list[str], cutoff: float = 0.8) -> str:
    """The clause after an unknown word: the known one that is meant, or the nearest one, or all of them.

    cutoff : likeness, up to 1, from which a word counts as near.
    """
    said = meant(word, known)
    close = [said] if said else difflib.get_close_matches(word[:100], known, n=1, cutoff=cutoff)
    if close:
        return f"; did you mean '{shortened(close[0])}'?"
    if not known:
        return ""
    names = [shortened(name) for name in known]
    fitting = sum(length < _LISTED for length in itertools.accumulate(len(name) + 2 for name in names))
    more = f" and {len(names) - fitting} more" if len(names) > fitting else ""
    return f"; known are: {', '.join(names[:fitting])}{more}"


_LISTED = 300  # most characters of the known words that a sentence lists
