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
from typing import Any, Literal, Self, TypeGuard, get_args, get_origin

from pydantic import BaseModel, ConfigDict, GetCoreSchemaHandler, ValidationError, model_validator
from pydantic_core import PydanticCustomError, core_schema

from cosserat.errors import InputError
from cosserat.synonyms import meant
from cosserat.text import brief, shortened, shown
from cosserat.units import NOTHING, sizes_in, to_si

FROM_FILE = {"units": "required"}
"""Validation context of values from a file: a number without its unit is an error."""


MOST_ITEMS = 1000
"""Most items of a list in a case, where nothing else is said."""


@dataclass(frozen=True)
class Quantity:
    r"""Annotation of a physical parameter: `length: Annotated[float, Quantity("m", r"\ell_0", above=0)]`.

    This is the one place where values become numbers.  Their sizes are those that make sense for the unit, by
    `cosserat.units.sizes_in`, if nothing narrower is given.

    unit : SI unit, "1" for a ratio.
    symbol, source : the letter of the thesis (LaTeX) and the equation or section it comes from.
    above, below, at_least, at_most : the range of the value.
    """

    unit: str
    symbol: str = ""
    source: str = ""
    above: float = -math.inf
    below: float = math.inf
    at_least: float | None = None
    at_most: float | None = None

    @functools.cached_property
    def least(self) -> float:
        """The least value; where the range is open, the bound itself."""
        smallest, largest = sizes_in(self.unit)
        if self.at_least is not None:
            return self.at_least
        return smallest if self.above == 0 else max(-largest, self.above)

    @functools.cached_property
    def most(self) -> float:
        """The largest value; where the range is open, the bound itself."""
        return min(sizes_in(self.unit)[1] if self.at_most is None else self.at_most, self.below)

    @property
    def range(self) -> str:
        """The range in words, in the SI unit."""
        bounds = [f"above {brief(self.above)}"] if math.isfinite(self.above) else []
        bounds += [f"at least {brief(self.least)}"] if self.least > self.above else []
        bounds += [
            f"at most {brief(self.most)}" if self.most < self.below else f"below {brief(self.below)}"
        ]
        return ", ".join(bounds)

    def check(self, value: object, info: core_schema.ValidationInfo) -> float:
        """Read and range-check one value."""
        return self.read(value, unit_required=from_file(info))

    def read(self, value: object, *, unit_required: bool) -> float:
        """Read and range-check one value; unit_required : whether a number needs its unit.

        Raises
        ------
        PydanticCustomError : it is not a number with such a unit, or out of range.
        """
        return self.checked(to_si(value, self.unit, unit_required=unit_required))

    def checked(self, number: float) -> float:
        """A number in the SI unit, if it is in the range.

        Raises
        ------
        PydanticCustomError : it is not.
        """
        fault = ""
        if number <= self.above:
            fault = f"above {brief(self.above)}"
        elif number >= self.below:
            fault = f"below {brief(self.below)}"
        elif self.at_least is not None and number < self.at_least:
            fault = f"at least {brief(self.at_least)}"
        elif not self.least <= number <= self.most:
            fault = self.range
        elif 0 < abs(number) < NOTHING and self.least <= 0:
            fault = f"0, or at least {brief(NOTHING)} in size"
        if fault:
            shown_number = f"{number:g}" if self.unit == "1" else f"{number:g} {self.unit}"
            raise PydanticCustomError("range", f"is {shown_number}; it must be {fault}")
        return number

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.with_info_plain_validator_function(self.check)


@dataclass(frozen=True)
class Count:
    """Annotation of a whole-number parameter with its least and its largest value."""

    symbol: str = ""
    source: str = ""
    at_least: int = 0
    at_most: int = 1_000_000

    def check(self, value: object) -> int:
        """Read and range-check one value."""
        if isinstance(value, bool) or not isinstance(value, numbers.Integral):
            raise PydanticCustomError("type", f"is {shown(value)}; it must be a whole number")
        if value < self.at_least:
            raise PydanticCustomError(
                "range", f"is {shown(int(value))}; it must be at least {self.at_least}"
            )
        if int(value) > self.at_most:
            raise PydanticCustomError(
                "range", f"is {shown(int(value))}; it must be at most {self.at_most}"
            )
        return int(value)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)


@dataclass(frozen=True)
class Items:
    """Annotation of a list: how many items it has; without this one, up to `MOST_ITEMS`."""

    at_least: int = 0
    at_most: int = MOST_ITEMS

    @property
    def range(self) -> str:
        """The range in words."""
        return f"from {self.at_least} to {self.at_most}"

    def count(self, items: int) -> None:
        """Raise PydanticCustomError if a list cannot have so many items."""
        if not self.at_least <= items <= self.at_most:
            raise PydanticCustomError(
                "items", f"has {items} item{'s' * (items != 1)}; it must have {self.range}"
            )

    def check(self, value: object) -> object:
        """Count the items of a list before they are read; what is no list is left to its own check."""
        if is_list(value):
            self.count(len(value))
        return value

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_before_validator_function(self.check, handler(source))


def is_list(value: object) -> TypeGuard[Sequence[Any]]:
    """Whether a value is a list, a tuple or an array."""
    return isinstance(value, list | tuple) or getattr(value, "ndim", 0) > 0


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
            raise PydanticCustomError("word", f"is {shown(value)}; it must be {known}")
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


def _check_length(key: str, value: object, marks: Sequence[object]) -> None:
    """Raise PydanticCustomError for a list that is too long, if it has no rule of its own."""
    items = len(value) if is_list(value) else 0
    if items > MOST_ITEMS and not any(isinstance(mark, Items | Reader) for mark in marks):
        raise PydanticCustomError(
            "items", f"has {items} items in '{key}'; it may have up to {MOST_ITEMS}"
        )


class Parameters(BaseModel):
    """Base of every parameter object: frozen, and unknown keys are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    def __init__(self, **values: Any) -> None:
        try:
            super().__init__(**values)
        except ValidationError as error:
            raise InputError(_explained(error, type(self), type(self).__name__)) from None

    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined] # values from files never come here

    @model_validator(mode="before")
    @classmethod
    def _without_dropped(cls, values: Any) -> Any:
        """The values without dropped keys; a "none" that drops nothing is an error."""
        if not isinstance(values, Mapping):
            return values
        kept: dict[str, Any] = {}
        for key, value in values.items():
            field = cls.model_fields.get(key)
            if field is not None:
                _check_length(key, value, field.metadata)
            named = isinstance(value, str) and (isinstance(value, Dropped) or value == "none")
            field = field if named else None
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
            raise InputError(_explained(error, cls, name)) from None

    def replace(self, **changes: Any) -> Self:
        """A copy with the named fields changed, validated like the original.

        Raises
        ------
        InputError : a change is not valid.
        """
        return self.read({**dict(self), **changes}, type(self).__name__, units_required=False)


def _explained(error: ValidationError, owner: type[BaseModel], name: str) -> str:
    from cosserat.explain import explain  # it reads the classes of this module

    return explain(error, owner, name)


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


def classes_in(annotation: object) -> Choice:
    """Parameter classes in an annotation, at any depth."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [found for part in get_args(annotation) for found in classes_in(part)]


def tables_with_a_choice(
    owner: type[BaseModel], before: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], str]]:
    """Path of each table inside a class for which there are several classes, and the key that chooses one."""
    for name, field in owner.model_fields.items():
        if get_origin(field.annotation) is tuple:
            continue  # a list is replaced as a whole
        tables = classes_in(field.annotation)
        if key := chooser(tables):
            yield (*before, name), key
        for table in tables:
            yield from tables_with_a_choice(table, (*before, name))


def nearest(word: str, known: list[str], cutoff: float = 0.8) -> str:
    """The clause after an unknown word: the known one that is meant, or the nearest one, or all of them.

    cutoff : likeness, up to 1, from which a word counts as near.
    """
    said = meant(word, known)
    close = [said] if said else difflib.get_close_matches(word[:100], known, n=1, cutoff=cutoff)
    if close:
        return f"; did you mean '{shortened(close[0])}'?"
    names = [shortened(name) for name in known]
    fitting = sum(length < _LISTED for length in itertools.accumulate(len(name) + 2 for name in names))
    more = f" and {len(names) - fitting} more" if len(names) > fitting else ""
    return f"; known are: {', '.join(names[:fitting])}{more}"


_LISTED = 450  # most characters of the known words that a sentence lists
