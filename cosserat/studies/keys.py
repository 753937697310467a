"""Keys of a case by their dotted paths, such as "rod.material.young" or "forces.0.force", and other values of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from pydantic import BaseModel
from pydantic_core import PydanticCustomError

from cosserat.cases.catalogue import Case, given
from cosserat.describe.keys import Key, keys
from cosserat.errors import InputError
from cosserat.parameters import Count, Quantity, nearest
from cosserat.problem import Problem
from cosserat.text import shortened, shown

MOST_PARTS = 12
"""Most parts of a dotted path."""


@dataclass(frozen=True)
class VariedKey:
    """A key of a case that a study varies.

    path : dotted, the items of lists by number.  about : its unit and range, if it is a number.
    """

    path: str
    about: Key

    @property
    def last(self) -> str:
        """The last word of the path."""
        return self.path.rpartition(".")[2]

    @property
    def meaning(self) -> str:
        """Its meaning in a few words."""
        return self.about.meaning.split(";")[0].rstrip(".") or self.last.replace("_", " ")

    @property
    def quantity(self) -> Quantity | None:
        """Unit and range, if it is a quantity."""
        about = self._numbers
        return about if isinstance(about, Quantity) else None

    @property
    def is_number(self) -> bool:
        """Whether it is a quantity or a count."""
        return self._numbers is not None

    @property
    def _numbers(self) -> Quantity | Count | None:
        value = self.about.value
        forms = [value, *value.items] if value.form == "either" else [value]
        return next((form.about for form in forms if isinstance(form.about, Quantity | Count)), None)

    def _stays(self, value: object) -> bool:
        """Whether it is another form than the number: a word, a row, or a distance where a number counts vertices."""
        forms = self.about.value.items if self.about.value.form == "either" else ()
        if not isinstance(value, str):
            return isinstance(value, Sequence) and any(form.form in ("row", "list") for form in forms)
        if any(value in form.words for form in forms):
            return True
        lengths = [form.about for form in forms if isinstance(form.about, Quantity)]
        return isinstance(self._numbers, Count) and any(_reads(length, value) for length in lengths)

    @property
    def unit(self) -> str:
        """The SI unit, "1" for a count."""
        return self.quantity.unit if self.quantity else "1"

    def read(self, value: object, *, unit_required: bool) -> object:
        """A value in SI units; what is no number stays as it is.

        Raises
        ------
        PydanticCustomError : it is no such number, or out of range.
        """
        about = self._numbers
        if self._stays(value):
            return value
        if isinstance(about, Quantity):
            return about.read(value, unit_required=unit_required)
        return about.check(value) if isinstance(about, Count) else value


def _reads(quantity: Quantity, text: str) -> bool:
    try:
        quantity.read(text, unit_required=True)
    except PydanticCustomError:
        return False
    return True


def varied_key(problem: Problem, path: str, name: str) -> VariedKey:
    """The key of a problem at a path; name : of the study in errors.

    Raises
    ------
    InputError : there is no such key.
    """
    parts = path.split(".")
    if len(parts) > MOST_PARTS:
        raise InputError(f"{name}: the key {shown(path)} has more than {MOST_PARTS} parts")
    owners: list[Any] = [problem]
    for number, part in enumerate(parts[:-1]):
        owners.append(_inside(owners[-1], part, ".".join(parts[: number + 1]), name))
    owner, general, known = owners[-1], _general(parts), keys(problem.kind)
    fitting = [key for key in known if key.path == general and _is_of(key, owner)]
    item = None if fitting else _item(known, parts, owners)
    if item is not None:
        _inside(owner, parts[-1], path, name)
        return VariedKey(path, item)
    if not fitting:
        parent = path.rpartition(".")[0]
        if isinstance(owner, int | float | str):
            raise InputError(
                f"{name}: {shown(path)} names a key inside '{parent}', which has none; give a list of values, or with "
                "points a distribution: uniform, log_uniform, normal or truncated"
            )
        here = [key.path for key in known if key.path.rpartition(".")[0] == general.rpartition(".")[0]]
        raise InputError(
            f"{name}: a case of kind '{problem.kind}' has no key {shown(path)}{nearest(general, here)}"
        )
    if general == "kind" or isinstance(owner, Sequence):
        raise InputError(f"{name}: {shown(path)} cannot be varied; vary the keys inside it")
    return VariedKey(path, fitting[0])


def _general(parts: Sequence[str]) -> str:
    """A path as `Key` has it: "forces[].force"."""
    return ".".join("[]" if part.isdecimal() else part for part in parts).replace(".[]", "[]")


def _item(known: Sequence[Key], parts: Sequence[str], owners: Sequence[Any]) -> Key | None:
    """The key of one value inside a list of values or of rows, such as gait.phases.0; owners : of every part."""
    named = max((n for n, part in enumerate(parts) if not part.isdecimal()), default=-1) + 1
    general = _general(parts[:named])
    lists = [key for key in known if key.path == general and _is_of(key, owners[named - 1])]
    if not lists or named == len(parts):
        return None
    value = lists[0].value
    for part in parts[named:]:
        forms = value.items if value.form == "either" else (value,)
        inner = next((form for form in forms if form.form in ("list", "row")), None)
        if inner is None or (inner.form == "row" and int(part) >= len(inner.items)):
            return None
        value = inner.items[0 if inner.form == "list" else int(part)]
    place = ".".join(parts[named:])
    first = lists[0].meaning.split(";")[0].rstrip(".")
    return (
        None
        if value.form in ("table", "list", "row")
        else replace(lists[0], path=_general(parts), value=value, meaning=f"{first}: item {place}")
    )


def _inside(owner: Any, part: str, path: str, name: str) -> Any:
    """What is at one part of a path in an object."""
    if isinstance(owner, tuple):
        if not part.isdecimal() or int(part) >= len(owner):
            raise InputError(
                f"{name}: {shown(path)} names no item of a list of {len(owner)}; count from 0, as in forces.0.force"
            )
        return owner[int(part)]
    found = (
        getattr(owner, part, None)
        if isinstance(owner, BaseModel) and part in type(owner).model_fields
        else None
    )
    if found is None:
        raise InputError(
            f"{name}: the case has no {shown(path)} to vary a key of; give it in the case first"
        )
    return found


def _is_of(key: Key, owner: Any) -> bool:
    """Whether a key is one of an object, where several classes share a path."""
    last = key.name
    if not isinstance(owner, BaseModel) or last not in type(owner).model_fields:
        return False
    return not key.when or not key.by or str(getattr(owner, key.by, key.when)) == key.when


def table_of(problem: Problem, paths: Iterable[str] | None = None) -> dict[str, Any]:
    """The keys of a problem as nested tables in SI units, for `put` and `case_with`.

    paths : of the keys that will be put, by default any.  What none of them enters stays an object, which is not read
    again.
    """
    if paths is None:
        return given(problem.model_dump())
    table: dict[str, Any] = _opened(problem, [path.split(".") for path in paths])
    return table


def _opened(owner: Any, paths: Sequence[Sequence[str]]) -> Any:
    """What is at a place: a table or a list if paths go on from there."""
    entering = [path for path in paths if path]
    if not entering:
        return owner

    def inside(part: str, value: Any) -> Any:
        return _opened(value, [rest for first, *rest in entering if first == part])

    if isinstance(owner, BaseModel):
        found = {name: inside(name, getattr(owner, name)) for name in type(owner).model_fields}
        return given(found)
    return [inside(str(number), item) for number, item in enumerate(owner)]


def put(table: Mapping[str, Any], path: Sequence[str], value: object) -> dict[str, Any]:
    """A copy of nested tables with another value at a path; what is not on the path is shared."""
    first, *rest = path
    changed = dict(table)
    changed[first] = _put_inside(changed.get(first), rest, value) if rest else value
    return changed


def _put_inside(inner: Any, path: Sequence[str], value: object) -> Any:
    if isinstance(inner, Mapping):
        return put(inner, path, value)
    items, number = list(inner), int(path[0])
    items[number] = _put_inside(items[number], path[1:], value) if path[1:] else value
    return items


def case_with(base: Case, table: Mapping[str, Any], values: Mapping[str, object], name: str) -> Case:
    """The case with some keys changed: table : that of its problem, by `table_of`.  name : of the new case.

    Raises
    ------
    InputError : the changed case is not valid.
    """
    for path, value in values.items():
        table = put(table, path.split("."), value)
    problem = type(base.problem).read(table, f"case '{shortened(name)}'", units_required=False)
    return Case(name=name, title=base.title, source=base.source, problem=problem)


def read_value(key: VariedKey, value: object, place: str, *, unit_required: bool) -> object:
    """A value of a key; place : where it stands, in errors.

    Raises
    ------
    InputError : it is not valid.
    """
    try:
        return key.read(value, unit_required=unit_required)
    except PydanticCustomError as error:
        said = key.about.value.said
        words = f"is {shown(value)}; it must be {said}" if said else error.message()
        raise InputError(f"{place} {words}") from None
