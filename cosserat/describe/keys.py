"""Every key of a case, with its type, unit, default, range and meaning from the parameter classes.

The text of `cosserat describe`, the schemas for editors and the page of the book come from this list.
"""

from __future__ import annotations

import functools
import pkgutil
import types
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from cosserat.cases.catalogue import Case
from cosserat.errors import InputError
from cosserat.explain import docstrings
from cosserat.kinds import FIT_CLASS, STUDY_CLASS
from cosserat.parameters import (
    Count,
    Items,
    OneOf,
    Quantity,
    Reader,
    chooser,
    nearest,
)
from cosserat.problem import Problem
from cosserat.publications import FIT, STUDY, kinds
from cosserat.tables import ShortForm
from cosserat.text import shortened

Form = Literal[
    "quantity",
    "count",
    "number",
    "word",
    "name",
    "names",
    "keys",
    "text",
    "truth",
    "table",
    "list",
    "row",
    "either",
]


@dataclass(frozen=True)
class Value:
    """The type of a value.

    about : unit and range of a quantity or a count; how many items a list has.
    words : the allowed words.
    tables : the possible classes of a table; several differ in one key, such as `kind`.
    items : types of the items of a list, of the places of a row, or of the alternatives of "either"; of a table,
        its short form.
    said : the type in words, if its parts do not say it.
    """

    form: Form
    about: Quantity | Count | Items | None = None
    words: tuple[str, ...] = ()
    tables: tuple[type[BaseModel], ...] = ()
    items: tuple[Value, ...] = ()
    said: str = ""

    @property
    def innermost(self) -> Value:
        """The value itself, or the innermost item of nested lists."""
        return self.items[0].innermost if self.form == "list" else self

    @property
    def problem(self) -> str:
        """The kind, if it is a whole problem, whose keys are those of its kind; else empty."""
        return _kind_of(self.tables[0]) if self.tables else ""


@dataclass(frozen=True)
class Key:
    """One key.

    path : as in a case file, dotted; "forces[].at" is a key of each table of a list.
    when, by : the word of its table, such as "circle", and the key with this word, such as "shape", if there is a
        choice.
    default : as in a case file; None if the key is required or has no default.
    """

    path: str
    value: Value
    required: bool
    default: str | None
    meaning: str
    when: str = ""
    by: str = ""

    @property
    def name(self) -> str:
        """The last part of the path."""
        return self.path.rpartition(".")[2]

    @property
    def inside(self) -> str:
        """Prefix of the paths of the keys inside it, if it is a table or a list of tables."""
        return f"{self.path}[]." if self.value.form == "list" else f"{self.path}."


LIKE = Key(
    "like",
    Value("name"),
    required=False,
    default=None,
    meaning="The case, or a list of cases, from which this one inherits what it does not give itself; "
    'the word "none" drops an inherited key that may be left out.',
)
"""The key of every case that is in no class: the reader follows it."""


@functools.cache
def common_keys() -> tuple[Key, ...]:
    """The keys of every case, in addition to those of its kind."""
    about = [
        Key(name, Value("text"), required=False, default=None, meaning=docstrings(Case)[name])
        for name in ("title", "source")
    ]
    return (*about, LIKE)


@functools.cache
def keys(kind: str) -> tuple[Key, ...]:
    """The keys of one kind, in the order in which the classes declare them; `kind` is the first.

    A table that is a whole problem is one key: the keys inside it are those of its own kind.

    Raises
    ------
    InputError : there is no such kind.
    """
    if kind not in described():
        raise InputError(f"there is no kind '{shortened(kind)}'{nearest(kind, list(described()))}")
    found = list(_keys(described()[kind], "", "", "kind"))
    return tuple(sorted(found, key=lambda key: key.path != "kind"))


def title(kind: str) -> str:
    """Description of a kind: the first paragraph of its class."""
    return _paragraph(described()[kind])


@functools.cache
def described() -> Mapping[str, type[BaseModel]]:
    """The classes of all that a case file may hold, by kind: problems, studies and fits."""
    classes: dict[str, type[BaseModel]] = {name: kind.problem_class() for name, kind in kinds().items()}
    return classes | {
        STUDY: pkgutil.resolve_name(STUDY_CLASS),
        FIT: pkgutil.resolve_name(FIT_CLASS),
    }


@functools.cache
def _names() -> Mapping[type[Problem], str]:
    return {kind.problem_class(): name for name, kind in kinds().items()}


def _kind_of(owner: type[BaseModel]) -> str:
    return _names()[owner] if issubclass(owner, Problem) else ""


def _keys(owner: type[BaseModel], before: str, when: str, by: str) -> Iterator[Key]:
    for name, field in sorted(owner.model_fields.items(), key=lambda item: item[0] != by):
        value = _value(_whole(field))
        assert value is not None, f"{owner.__name__}.{name} can only be nothing"
        key = Key(
            f"{before}{name}",
            value,
            required=field.is_required() or (name == by and bool(when or not before)),
            default=None
            if field.is_required() or field.default is None
            else _written(field.default, value),
            meaning=_meaning(owner, name, value),
            when=when,
            by=by,
        )
        yield key
        if value.problem:
            continue
        tables = value.innermost.tables
        choosing = chooser(tables)
        for table in tables:
            word = str(table.model_fields[choosing].default) if choosing else when
            yield from _keys(table, key.inside, word, choosing or by)


def _whole(field: FieldInfo) -> Any:
    """The annotation of a field in its class, before pydantic splits it."""
    return Annotated[field.annotation, *field.metadata] if field.metadata else field.annotation


def _meaning(owner: type[BaseModel], name: str, value: Value) -> str:
    """The docstring of a field; for a `kind`, a table or a list of tables without one, that of the class."""
    if name in docstrings(owner):
        return docstrings(owner)[name]
    tables = (owner,) if name in ("kind", "shape") else value.innermost.tables
    return _paragraph(tables[0]) if len(tables) == 1 else ""


def _paragraph(owner: type[BaseModel]) -> str:
    return " ".join((owner.__doc__ or "").strip().split("\n\n")[0].split())


def _value(annotation: Any) -> Value | None:
    """The values allowed by an annotation; None if there are none."""
    about: list[Any] = []
    while get_origin(annotation) is Annotated:
        about += annotation.__metadata__
        annotation = annotation.__origin__
    short = tuple(Value("quantity", mark.about) for mark in about if isinstance(mark, ShortForm))
    for mark in about:
        if isinstance(mark, Quantity | Count):
            return Value("quantity" if isinstance(mark, Quantity) else "count", mark)
        if isinstance(mark, OneOf):
            return Value("word", words=tuple(mark.registry))
        if isinstance(mark, Reader):
            forms = _value(mark.alternatives)
            assert forms is not None
            return replace(forms, said=mark.said)
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin in (Union, types.UnionType):
        found = [value for part in parts if (value := _value(part)) is not None]
        if len(found) == 1:
            return replace(found[0], items=found[0].items + short)
        if not all(value.tables for value in found):
            return Value("either", items=tuple(found))
        return Value("table", tables=tuple(table for value in found for table in value.tables))
    if origin is Literal:
        return Value("word", words=parts)
    if origin in (tuple, dict):
        return _list_or_row(parts, about) if origin is tuple else _named(parts[1])
    if annotation is types.NoneType:
        return None
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return Value("table", tables=(annotation,))
    return Value(_PLAIN[annotation])


_PLAIN: Mapping[type, Form] = {str: "text", bool: "truth", float: "number"}


def _named(annotation: Any) -> Value:
    """A table whose names are free, with values that are alike; or one of the keys of a case."""
    inner = None if annotation is Any else _value(annotation)
    return Value("keys") if inner is None else Value("names", items=(inner,))


def _list_or_row(parts: tuple[Any, ...], about: list[Any]) -> Value:
    """The values of a tuple: a list of items that are alike, or a row of places."""
    items = tuple(value for part in parts if part is not ... and (value := _value(part)) is not None)
    if ... not in parts:
        return Value("row", items=items)
    return Value("list", next((mark for mark in about if isinstance(mark, Items)), Items()), items=items)


def _written(default: Any, value: Value) -> str:
    """A default as a person would write it in a case file."""
    if isinstance(default, BaseModel):
        return f'{{ kind = "{default.kind}" }}' if len(value.tables) > 1 else "{}"  # type: ignore[attr-defined]
    if value.form == "quantity":
        assert isinstance(value.about, Quantity)
        number = f"{default!r}".removesuffix(".0")
        return number if value.about.unit == "1" else f'"{number} {value.about.unit}"'
    if value.form == "row":
        parts = zip(default, value.items, strict=True)
        return f"[{', '.join(_written(part, item) for part, item in parts)}]"
    if isinstance(default, bool):
        return str(default).lower()
    if isinstance(default, str):
        return f'"{default}"'
    if default == {}:
        return "{}"
    assert isinstance(default, int) or default == ()
    return "[]" if default == () else str(default)
