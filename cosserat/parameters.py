"""Parameter objects: frozen, validated, every physical value in SI units inside and with its unit outside.

A parameter class derives from `Parameters` and annotates its fields with `Quantity` or `Count`.  In a case
file a dimensional value is a text with its unit ("5 m", "1 GPa"); in Python it may also be a plain number in SI units.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, Self, get_args, get_origin

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from cosserat.errors import InputError
from cosserat.explain import chooser, classes_in, explain, nearest
from cosserat.quantities import (
    FROM_FILE,
    MOST_ITEMS,
    Count,
    Items,
    OneOf,
    Quantity,
    Reader,
    from_file,
    is_list,
)

__all__ = [
    "FROM_FILE",
    "MOST_ITEMS",
    "Count",
    "Dropped",
    "Items",
    "OneOf",
    "Parameters",
    "Quantity",
    "Reader",
    "chooser",
    "from_file",
    "is_list",
    "nearest",
    "tables_with_a_choice",
]


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


def _has_own_length(annotation: Any) -> bool:
    """Whether a rule of its own says how long a list of this type may be."""
    inner = (*getattr(annotation, "__metadata__", ()), *get_args(annotation))
    return isinstance(annotation, Items | Reader) or any(map(_has_own_length, inner))


def _check_length(key: str, value: Sequence[object], annotations: Sequence[object]) -> None:
    """Raise PydanticCustomError for a list that is too long, if it has no rule of its own."""
    items = len(value)
    if items > MOST_ITEMS and not any(map(_has_own_length, annotations)):
        raise PydanticCustomError(
            "items", f"has {items} items in '{key}'; it may have up to {MOST_ITEMS}"
        )


@functools.cache
def _may_be_none(kind: type[BaseModel], key: str) -> bool:
    """Whether "none" is a word of a key."""
    field = kind.model_fields[key]
    if field.annotation is str and not field.metadata:
        return True
    return any(map(_reads_none, field.metadata or [field.annotation]))


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
        fields = cls.model_fields
        for key, value in values.items():
            if not isinstance(value, str):
                if is_list(value) and key in fields:
                    _check_length(key, value, [fields[key].annotation, *fields[key].metadata])
                kept[key] = value
                continue
            named = isinstance(value, Dropped) or value == "none"
            field = fields.get(key) if named else None
            word = field is not None and _may_be_none(cls, key)
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

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy with some fields changed and not validated; what was computed from the old ones is left behind."""
        copied = super().model_copy(update=update, deep=deep)
        for name in copied.__dict__.keys() - type(self).model_fields.keys():
            del copied.__dict__[name]
        return copied

    def replace(self, **changes: Any) -> Self:
        """A copy with the named fields changed, validated like the original.

        Raises
        ------
        InputError : a change is not valid.
        """
        return self.read({**dict(self), **changes}, type(self).__name__, units_required=False)


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
