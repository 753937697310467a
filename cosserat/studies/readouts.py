"""Read-outs: numbers by name that are kept of every member of a study.

    "u.E2 at last"              a component at the last vertex
    "max |kappa|"               the largest size of a variable
    "x.E3 at 1.2 m"             between two vertices, by linear interpolation along the reference
    "x.E3 at 50 %"              likewise at a part of the length
    "natural_frequency at 0"    the first mode
    "kinetic_energy at 0.5 s"   between two instants, by linear interpolation
    "max |u.E2| at last"        over what is left after a place was taken: here the instants of a motion
    "load_factor where |u.E2| at last reaches 5 cm"    the first time, by linear interpolation between instants

Words before the variable: max, min, mean, norm (the root of the sum of squares), range (max less min), final (at the
last instant or point of a path) and change (from the first one to the last).  The order is always the same: components,
the place, sizes |...|, and then what the word says.  With "where" all of it is done at every instant, change is from
the first one, and the numbers found are interpolated; final names an instant itself and has no "where".  The value of a
member of a study is bit-equal to that of its own result.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from cosserat.data.variables import LABELS, VARIABLES
from cosserat.errors import InputError, OutOfReachError
from cosserat.parameters import nearest
from cosserat.solution import Field
from cosserat.studies.between import at_level, first_met, interpolated, place, reaches, taken
from cosserat.text import shown
from cosserat.units import to_si

Array = NDArray[np.float64]

_FORM = re.compile(
    r"\s*(?:(?P<over>max|min|mean|norm|range|final|change)\s+)?(?P<bar>\|?)\s*(?P<name>[A-Za-z_]\w*)(?P<labels>(?:\.[\w-]+)*)"
    r"\s*(?P<end>\|?)(?:\s+at\s+(?P<at>.{1,40}?))?\s*"
)
_REACHES = re.compile(r"(?P<value>.+?)\s+where\s+(?P<inner>.+?)\s+reaches\s+(?P<level>.+)")
_LONGEST = 200
_SHORT, _MOST_MEANT = (
    3,
    4,
)  # letters of a word that is looked for in others; variables that an error names
_ALONG = {"vertex": "xi", "edge": "xi_edge", "section": "xi_section", "time": "time"}
"""Dimensions with a coordinate in units, and the variable that holds it."""
_INSTANTS = ("time", "point")
_OVER: dict[str, Callable[[Array], Array]] = {
    "max": lambda rows: rows.max(axis=-1),
    "min": lambda rows: rows.min(axis=-1),
    "mean": lambda rows: rows.mean(axis=-1),
    "range": lambda rows: rows.max(axis=-1) - rows.min(axis=-1),
    "norm": lambda rows: np.sqrt((rows * rows).sum(axis=-1)),
}
"""What is done along the last, contiguous axis: sums then have the same bits for one member and for many."""


@dataclass(frozen=True)
class ReadOut:
    """One read-out.

    name : of the variable in the answer.  text : as it is written.  variable : of a result.  labels : components.
    over : what is done with the values that are left, or "" for one value.  size : whether absolute values count.
    at : the place or the instant, as it is written; "" for none.
    where, level : another read-out, and the value that it reaches at the instant of this one; None for none.
    """

    name: str
    text: str
    variable: str
    labels: tuple[str, ...]
    over: str
    size: bool
    at: str
    where: ReadOut | None = None
    level: float = 0.0

    @property
    def units(self) -> str:
        """The unit of its values."""
        return VARIABLES[self.variable].units

    @property
    def sized(self) -> bool:
        """Whether `picked` takes the sizes |...|, since it combines values of several instants."""
        return self.where is not None or self.over == "change"

    @property
    def long_name(self) -> str:
        """Its meaning in words."""
        return f"{VARIABLES[self.variable].long_name}: {self.text}"

    def needs(self) -> set[str]:
        """The variables of a result that it reads."""
        dims = VARIABLES[self.variable].dims
        found = {self.variable} if self.where is None else {self.variable} | self.where.needs()
        if not self.at:
            return found
        _, unit = place(self.at)
        wanted = {"s": ("time",), "": ()}.get(unit, ("vertex", "edge", "section"))
        found |= {_ALONG[dim] for dim in wanted if dim in dims or dim == "time"}
        return found | ({"xi"} if unit == "%" and "edge" in dims else set())

    def of(
        self, fields: Mapping[str, Field], labels: Mapping[str, Sequence[str]], members: int = 0
    ) -> Array:
        """Its value, or (members,) of them.

        fields : variables of a result with their dimensions; those with `members` have a first axis more, `member`.

        Raises
        ------
        InputError : the result has no such variable or component, or more than one value is left.
        """
        dims, values = self.picked(fields, labels)
        if self.where is not None:
            return values
        values = np.abs(values) if self.size and not self.sized else values
        left = tuple(k for k, dim in enumerate(dims) if dim != "member")
        if self.over in _OVER:
            rows = np.moveaxis(values, dims.index("member"), 0) if "member" in dims else values[None]
            values = _OVER[self.over](np.ascontiguousarray(rows).reshape(len(rows), -1))
            values = values if "member" in dims else taken(values, 0, 0)
        elif left:
            names = ", ".join(f"{dims[k]} ({values.shape[k]})" for k in left)
            raise InputError(
                f"'{self.name}': {shown(self.text)} leaves more than one value, along {names}; name a component, a "
                "place with 'at', or max, min, mean, norm or range before it"
            )
        return np.asarray(values, dtype=np.float64) + np.zeros(
            members if members and "member" not in dims else ()
        )

    def picked(
        self, fields: Mapping[str, Field], labels: Mapping[str, Sequence[str]]
    ) -> tuple[tuple[str, ...], Array]:
        """The values that are left after components, places and instants were taken, with their dimensions.

        Raises
        ------
        InputError : the result has no such variable, component or place.
        OutOfReachError : the level of `where` is not reached.
        """
        if self.where is not None:
            return (), np.asarray(self._where(self.where, fields, labels))
        return self._ends(*self._read(fields, labels))

    def _read(
        self, fields: Mapping[str, Field], labels: Mapping[str, Sequence[str]]
    ) -> tuple[tuple[str, ...], Array]:
        """The values of the components at the place."""
        if self.variable not in fields:
            raise InputError(
                f"'{self.name}': the result has no variable '{self.variable}'{nearest(self.variable, list(fields))}"
            )
        dims, values = self._components(*fields[self.variable], labels)
        return self._placed(dims, values, fields) if self.at else (dims, values)

    def _where(
        self, other: ReadOut, fields: Mapping[str, Field], labels: Mapping[str, Sequence[str]]
    ) -> float:
        """The value at the instant where another read-out first reaches the level."""
        values, found = self._series(fields, labels), other._series(fields, labels)
        if found.shape != values.shape:
            raise InputError(
                f"'{self.name}': {shown(self.text)} needs two values along the same instants"
            )
        met = first_met(found, self.level)
        if met is None:
            raise OutOfReachError(
                f"'{self.name}': {shown(other.text)} does not reach {self.level:g}; it goes from "
                f"{found.min():g} to {found.max():g}"
            )
        return at_level(values, *met)

    def _series(self, fields: Mapping[str, Field], labels: Mapping[str, Sequence[str]]) -> Array:
        """One number at every instant, (n,)."""
        dims, values = self._read(fields, labels)
        found = [dim for dim in dims if dim in _INSTANTS]
        if not found:
            raise InputError(
                f"'{self.name}': '{self.variable}' has no instants at which something is reached"
            )
        axis = dims.index(found[0])
        rows = np.moveaxis(np.abs(values) if self.size else values, axis, 0).reshape(
            values.shape[axis], -1
        )
        if self.over in _OVER:
            return _OVER[self.over](np.ascontiguousarray(rows))
        if rows.shape[1] > 1:
            raise InputError(
                f"'{self.name}': {shown(self.text)} leaves more than one value at an instant"
            )
        return rows[:, 0] - rows[0, 0] if self.over == "change" else rows[:, 0]

    def _ends(self, dims: tuple[str, ...], values: Array) -> tuple[tuple[str, ...], Array]:
        """What is asked for at the last instant."""
        if self.over not in ("final", "change"):
            return dims, values
        if self.over == "change" and not set(dims) & set(_INSTANTS):
            raise InputError(
                f"'{self.name}': '{self.variable}' has no instants between which it changes; leave out 'change'"
            )
        values = np.abs(values) if self.size and self.sized else values
        left, last = self._instant(dims, values, -1)
        return left, last if self.over == "final" else last - self._instant(dims, values, 0)[1]

    def _components(
        self, dims: tuple[str, ...], values: Array, labels: Mapping[str, Sequence[str]]
    ) -> tuple[tuple[str, ...], Array]:
        for label in self.labels:
            found = [dim for dim in dims if dim in LABELS and label in labels.get(dim, ())]
            if not found:
                known = [word for dim in dims if dim in LABELS for word in labels.get(dim, ())]
                raise InputError(
                    f"'{self.name}': '{self.variable}' has no component {shown(label)}{nearest(label, known)}"
                )
            axis = dims.index(found[0])
            values = taken(values, list(labels[found[0]]).index(label), axis)
            dims = dims[:axis] + dims[axis + 1 :]
        return dims, values

    def _placed(
        self, dims: tuple[str, ...], values: Array, fields: Mapping[str, Field]
    ) -> tuple[tuple[str, ...], Array]:
        number, unit = place(self.at)
        if unit == "s":
            return self._between(dims, values, "time", number, fields)
        places = [dim for dim in dims if dim not in (*_INSTANTS, *LABELS, "member")]
        if not places:
            raise InputError(
                f"'{self.name}': '{self.variable}' has no places, but {shown(self.text)} names one"
            )
        if unit:
            return self._between(dims, values, places[0], number, fields, part=unit == "%")
        axis = dims.index(places[0])
        count, index = values.shape[axis], int(number)
        if not -count <= index < count:
            raise InputError(
                f"'{self.name}': there is no {places[0]} {index}; they are numbered from 0 to {count - 1}"
            )
        return dims[:axis] + dims[axis + 1 :], taken(values, index, axis)

    def _instant(
        self, dims: tuple[str, ...], values: Array, index: int
    ) -> tuple[tuple[str, ...], Array]:
        found = [dim for dim in dims if dim in _INSTANTS]
        if not found:
            return dims, values
        axis = dims.index(found[0])
        return dims[:axis] + dims[axis + 1 :], taken(values, index, axis)

    def _between(
        self,
        dims: tuple[str, ...],
        values: Array,
        dim: str,
        at: float,
        fields: Mapping[str, Field],
        *,
        part: bool = False,
    ) -> tuple[tuple[str, ...], Array]:
        """Linear interpolation along a dimension with a coordinate; part : whether `at` is a part of the length."""
        length = "xi" if part and dim == "edge" else _ALONG.get(dim, "")
        if dim not in dims or not {_ALONG.get(dim, ""), length} <= set(fields):
            raise InputError(
                f"'{self.name}': '{self.variable}' has no {'instants' if dim == 'time' else 'places along it'}, but "
                f"{shown(self.text)} names one"
            )
        axis = dims.index(dim)
        along, where = fields[_ALONG[dim]]
        left, moved = dims[:axis] + dims[axis + 1 :], np.moveaxis(values, axis, -1)
        ends = fields[length][1][..., -1] if part else 1.0
        if "member" in dims:
            rows = where if "member" in along else np.broadcast_to(where, (len(moved), where.size))
            places = np.broadcast_to(at * np.asarray(ends), len(moved))
            every = zip(rows, moved, places, strict=True)
            return left, np.array([interpolated(row, own, float(there)) for row, own, there in every])
        at *= float(ends)
        if not reaches(where, at):
            raise InputError(
                f"'{self.name}': {shown(self.at)} is outside the result, from {where[0]:g} to {where[-1]:g}"
            )
        return left, interpolated(where, moved, at)


def meant_variable(word: str) -> str:
    """The clause after a name that no variable of a result has: those that are meant, or where to find them."""
    lower, short = word.lower(), len(word) <= _SHORT
    called = [name for name in VARIABLES if lower in name.lower()]
    about = [name for name, one in VARIABLES.items() if lower in one.long_name.lower()]
    found = [] if short else called or about
    if not found:
        close = nearest(word, list(VARIABLES))
        known = "; 'cosserat show' lists the variables of a result, such as one of its case"
        return close if "did you mean" in close else known
    names = " or ".join(f"'{name}'" for name in found[:_MOST_MEANT])
    return f"; did you mean {names}?"


def read_outs_by_name(given: object, name: str) -> tuple[ReadOut, ...]:
    """Read-outs from texts by name; name : of what takes them, in errors.

    Raises
    ------
    InputError : they have no names, or one is no read-out.
    """
    if not isinstance(given, Mapping):
        raise InputError(
            f"{name}: the read-outs are {shown(given)}; give each a name, such as {{'tip': 'u.E2 at last'}}"
        )
    return tuple(read_out(str(word), text, name) for word, text in given.items())


def read_out(name: str, text: object, study: str) -> ReadOut:
    """A read-out from its text; study : in errors.

    Raises
    ------
    InputError : it is no read-out.
    """
    reaches = (
        _REACHES.fullmatch(text.strip()) if isinstance(text, str) and len(text) <= _LONGEST else None
    )
    if reaches is not None:
        return _reaching(name, reaches, study)
    found = _FORM.fullmatch(text) if isinstance(text, str) and len(text) <= _LONGEST else None
    if found is None or bool(found["bar"]) != bool(found["end"]):
        raise InputError(
            f"{study}: '{name}' is {shown(text)}; write a variable of the result, such as \"u.E2 at last\" or "
            '"max |kappa|"'
        )
    variable, at = found["name"], found["at"] or ""
    if variable not in VARIABLES:
        raise InputError(
            f"{study}: '{name}' reads '{variable}', which no result has{meant_variable(variable)}"
        )
    try:
        if at:
            place(at)
    except PydanticCustomError as error:
        raise InputError(f"{study}: '{name}' {error.message()}") from None
    labels = tuple(part for part in found["labels"].split(".") if part)
    return ReadOut(
        name, str(text).strip(), variable, labels, found["over"] or "", bool(found["bar"]), at
    )


def _reaching(name: str, found: re.Match[str], study: str) -> ReadOut:
    """The read-out of a value where another one reaches a level."""
    own, other = read_out(name, found["value"], study), read_out(name, found["inner"], study)
    if "final" in (own.over, other.over):
        raise InputError(
            f"{study}: '{name}' is {shown(found[0].strip())}; 'final' and 'where' name two instants, keep one of them"
        )
    unit = unit_to_read(other.units)
    try:
        level = to_si(found["level"], unit, unit_required=True)
    except PydanticCustomError as error:
        raise InputError(f"{study}: '{name}' reaches a level that {error.message()}") from None
    return replace(own, text=found[0].strip(), where=other, level=level)


def unit_to_read(unit: str) -> str:
    """A unit of a variable, "kg m2 s-1", as texts with units are read: "kg*m^2*s^-1"."""
    return re.sub(r"(?<=[A-Za-z])(-?[\d.]+)", r"^\1", unit).replace(" ", "*")
