"""Parameter objects: frozen, validated, every physical value in SI units inside and with its unit outside.

A parameter class derives from `Parameters` and annotates its fields with `Quantity` or `Count`.  In a case
file a dimensional value is a text with its unit ("5 m", "1 GPa"); in Python it may also be a plain number in SI units.
"""

from __future__ import annotations

import ast
import difflib
import functools
import inspect
import itertools
import math
import numbers
import re
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Self, get_args, get_origin

from pydantic import BaseModel, ConfigDict, GetCoreSchemaHandler, ValidationError, model_validator
from pydantic_core import ErrorDetails, PydanticCustomError, core_schema

from cosserat.errors import InputError
from cosserat.synonyms import meant
from cosserat.units import how_to_write, to_si

FROM_FILE = {"units": "required"}
"""Validation context of values from a file: a number without its unit is an error."""


@dataclass(frozen=True)
class Quantity:
    r"""Annotation of a physical parameter: `length: Annotated[float, Quantity("m", r"\ell_0", above=0)]`.

    unit : SI unit, "1" for a ratio.
    symbol, source : the letter of the thesis (LaTeX) and the equation or section it comes from.
    above, below, at_least : the range of the value.
    """

    unit: str
    symbol: str = ""
    source: str = ""
    above: float = -math.inf
    below: float = math.inf
    at_least: float = -math.inf

    def check(self, value: object, info: core_schema.ValidationInfo) -> float:
        """Read and range-check one value."""
        number = to_si(value, self.unit, unit_required=from_file(info))
        shown = f"{number:g}" if self.unit == "1" else f"{number:g} {self.unit}"
        if number <= self.above:
            raise PydanticCustomError("range", f"is {shown}; it must be above {self.above:g}")
        if number >= self.below:
            raise PydanticCustomError("range", f"is {shown}; it must be below {self.below:g}")
        if number < self.at_least:
            raise PydanticCustomError("range", f"is {shown}; it must be at least {self.at_least:g}")
        return number

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.with_info_plain_validator_function(self.check)


@dataclass(frozen=True)
class Count:
    """Annotation of a whole-number parameter with its least value."""

    symbol: str = ""
    source: str = ""
    at_least: int = 0
    at_most: int = 20_000_000

    def check(self, value: object) -> int:
        """Read and range-check one value."""
        if isinstance(value, bool) or not isinstance(value, numbers.Integral):
            raise PydanticCustomError("type", f"is {value!r}; it must be a whole number")
        if value < self.at_least:
            raise PydanticCustomError("range", f"is {value}; it must be at least {self.at_least}")
        if int(value) > self.at_most:
            raise PydanticCustomError("range", f"is {value}; it must be at most {self.at_most}")
        return int(value)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)


class Reader:
    """Base of annotations that read a value by a rule of their own; descriptions and schemas follow its forms."""

    @property
    def alternatives(self) -> Any:
        """The forms, as a type with annotations."""
        raise NotImplementedError

    @property
    def said(self) -> str:
        """The type in words, for a description; empty where the alternatives say it."""
        return ""

    def check(self, value: object, info: core_schema.ValidationInfo) -> object:
        """Read one value.

        Raises
        ------
        PydanticCustomError : it has none of these forms.
        """
        raise NotImplementedError

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.with_info_plain_validator_function(self.check)


def from_file(info: core_schema.ValidationInfo) -> bool:
    """Whether a value comes from a file, where a number needs its unit."""
    return info.context is not None and info.context.get("units") == "required"


@dataclass(frozen=True)
class OneOf:
    """Annotation of a word that names an entry of a registry."""

    registry: Mapping[str, object]

    def check(self, value: object) -> str:
        """Read one word."""
        if not isinstance(value, str) or value not in self.registry:
            known = " or ".join(map(repr, self.registry))
            raise PydanticCustomError("word", f"is {value!r}; it must be {known}")
        return value

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)


class Dropped(str):
    """The mark of an inherited key that is dropped: the word "none" that said so, or "" for a value of None.

    TOML has no null.  Tables are merged before their class is known, so the class reads the mark: where "none" is one
    of the words of a key the word counts, and elsewhere the key is as if it had never been given.
    """

    __slots__ = ()


def _reads_none(annotation: Any) -> bool:
    """Whether "none" is a word of this type, and not the name of a file or the like."""
    if isinstance(annotation, Reader):
        return _reads_none(annotation.alternatives)
    if isinstance(annotation, OneOf) or get_origin(annotation) is Literal:
        return "none" in (annotation.registry if isinstance(annotation, OneOf) else get_args(annotation))
    marks = getattr(
        annotation, "__metadata__", ()
    )  # with a mark, the type is only that of the checked value
    return any(map(_reads_none, marks or get_args(annotation)))


class Parameters(BaseModel):
    """Base of every parameter object: frozen, and unknown keys are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    def __init__(self, **values: Any) -> None:
        try:
            super().__init__(**values)
        except ValidationError as error:
            raise InputError(explain(error, type(self), type(self).__name__)) from None

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined] # values from files never come here

    @model_validator(mode="before")
    @classmethod
    def _without_dropped(cls, values: Any) -> Any:
        """The values without dropped keys; a "none" that drops nothing is an error."""
        if not isinstance(values, Mapping):
            return values
        kept: dict[str, Any] = {}
        for key, value in values.items():
            named = isinstance(value, str) and (isinstance(value, Dropped) or value == "none")
            field = cls.model_fields.get(key) if named else None
            word = field is not None and (
                (field.annotation is str and not field.metadata)
                or any(map(_reads_none, field.metadata or [field.annotation]))
            )
            if isinstance(value, Dropped):
                kept |= {key: str(value)} if value and word else {}
            elif field is not None and not word:
                raise PydanticCustomError(
                    "none",
                    f"gives '{key}' as 'none', which drops a key that 'like' brings in, and 'like' brings in none; "
                    "leave it out",
                )
            else:
                kept[key] = value
        return kept

    @classmethod
    def read(
        cls,
        values: Mapping[str, Any],
        name: str,
        *,
        units_required: bool = True,
        folder: Path | None = None,
    ) -> Self:
        """Build from a plain mapping; `name` : its name in error sentences.

        units_required : a dimensional number needs its unit, as in every file; if not, such a number is in SI.
        folder : where the files that it names are; the current one by default.

        Raises
        ------
        InputError : unknown or missing key, wrong type or unit, out of range; one clause for each fault.
        """
        try:
            context = {**(FROM_FILE if units_required else {}), "folder": folder}
            return cls.model_validate(values, context=context)
        except ValidationError as error:
            raise InputError(explain(error, cls, name)) from None

    def replace(self, **changes: Any) -> Self:
        """A copy with the named fields changed, validated like the original.

        Raises
        ------
        InputError : a change is not valid.
        """
        return self.read({**dict(self), **changes}, type(self).__name__, units_required=False)


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


def explain(error: ValidationError, owner: type[BaseModel], name: str) -> str:
    """One sentence with every fault that validation found."""
    return f"{name}: " + "; ".join(_clause(fault, owner) for fault in error.errors(include_url=False))


def _clause(fault: ErrorDetails, owner: type[BaseModel]) -> str:
    loc = fault["loc"]
    path = ".".join(
        str(part) for n, part in enumerate(loc) if not _chosen(part, _choice_at(owner, loc[:n]))
    )
    match fault["type"]:
        case "missing":
            return f"'{path}' is missing{_what_it_is(owner, loc)}"
        case "extra_forbidden":
            keys = list(_choice_at(owner, loc[:-1])[0].model_fields)
            return f"'{path}' is not a key{nearest(str(loc[-1]), keys)}"
        case "literal_error":
            return f"'{path}' is {fault['input']!r}; it must be {fault['ctx']['expected']}"
        case "union_tag_invalid":
            key = chooser(_choice_at(owner, loc))
            return (
                f"'{path}.{key}' is {fault['ctx']['tag']!r}; it must be {fault['ctx']['expected_tags']}"
            )
        case "union_tag_not_found":
            choice = _choice_at(owner, loc)
            return f"'{path}.{chooser(choice)}' is missing: write {_words(choice, chooser(choice))}"
        case "model_type" | "model_attributes_type" | "dict_type":
            return f"'{path}' is {fault['input']!r}; it must be a table of keys"
        case "string_type":
            return f"'{path}' is {fault['input']!r}; it must be a text"
        case "tuple_type":
            return f"'{path}' is {fault['input']!r}; it must be a list"
        case _:
            return f"'{path}' {fault['msg']}" if path else fault["msg"]


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
    tables = _classes_in(field.annotation)
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


def _classes_in(annotation: object) -> Choice:
    """Parameter classes in an annotation, at any depth."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [found for part in get_args(annotation) for found in _classes_in(part)]


def _chosen(kind: int | str, choice: Choice) -> Choice:
    """The classes of one kind among several; validation puts the kind into the path like a key."""
    name = chooser(choice)
    return [c for c in choice if c.model_fields[name].default == kind] if name else []


def _choice_at(owner: type[BaseModel], path: tuple[int | str, ...]) -> Choice:
    """The possible parameter classes at a path of nested tables, lists and kinds."""
    choice = [owner]
    for part in path:
        fields = [c.model_fields[str(part)] for c in choice if str(part) in c.model_fields]
        choice = _chosen(part, choice) or (_classes_in(fields[0].annotation) if fields else choice)
    return choice or [owner]


def tables_with_a_choice(
    owner: type[BaseModel], before: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], str]]:
    """Path of each table inside a class for which there are several classes, and the key that chooses one."""
    for name, field in owner.model_fields.items():
        if get_origin(field.annotation) is tuple:
            continue  # a list is replaced as a whole
        tables = _classes_in(field.annotation)
        if key := chooser(tables):
            yield (*before, name), key
        for table in tables:
            yield from tables_with_a_choice(table, (*before, name))


def nearest(word: str, known: list[str], cutoff: float = 0.8) -> str:
    """The clause after an unknown word: the known one that is meant, or the nearest one, or all of them.

    cutoff : likeness, up to 1, from which a word counts as near.
    """
    said = meant(word, known)
    close = [said] if said else difflib.get_close_matches(word, known, n=1, cutoff=cutoff)
    return f"; did you mean '{close[0]}'?" if close else f"; known are: {', '.join(known)}"
