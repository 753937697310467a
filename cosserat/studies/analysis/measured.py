"""Measured data for a fit: conditions of every row, what was measured there, and how far it is off."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from cosserat.errors import InputError, path_of
from cosserat.parameters import nearest
from cosserat.problem import Problem
from cosserat.studies.factors import TITLE, cell, rows_of
from cosserat.studies.keys import VariedKey, read_value, varied_key
from cosserat.studies.readouts import ReadOut, unit_to_read
from cosserat.text import shortened, shown
from cosserat.units import to_si

Array = NDArray[np.float64]
MOST_ROWS = 50_000
"""Most rows of the data of a fit."""
Columns = Mapping[str, Sequence[object]]
_DEVIATION = "_deviation"


@dataclass(frozen=True)
class Measured:
    """Data of R rows.

    keys : the conditions.  conditions : their values, (R,) each, floats in SI units or objects.
    values : of each read-out, (R,), not a number where it was not measured.
    deviations : standard deviations of each read-out, (R,), or None where none are given.
    """

    keys: tuple[VariedKey, ...]
    conditions: tuple[NDArray[np.object_], ...]
    values: Mapping[str, Array]
    deviations: Mapping[str, Array | None]

    @property
    def size(self) -> int:
        """The number of rows."""
        return len(next(iter(self.values.values())))


def measured(
    data: str | Path | Columns | pd.DataFrame,
    problem: Problem,
    read_outs: Sequence[ReadOut],
    deviations: Mapping[str, object],
    name: str,
) -> Measured:
    """Data from a CSV file with units in its header, or from columns by name, with numbers in SI units.

    deviations : standard deviations of read-outs, for those without a column of their own; name : in errors.

    Raises
    ------
    InputError : a column or a value is not valid.
    """
    if isinstance(data, pd.DataFrame):
        data = {str(title): column.to_list() for title, column in data.items()}
    if isinstance(data, Mapping):
        titles, units = list(map(str, data)), [""] * len(data)
        columns, where = [list(column) for column in data.values()], name
        lengths = {len(column) for column in columns}
        if len(lengths) != 1 or lengths == {0}:
            raise InputError(
                f"{name}: the columns of 'data' have different lengths or no rows; give them as many"
            )
    else:
        titles, units, columns, where = _from_file(path_of(data), name)
    if len(columns[0]) > MOST_ROWS:
        raise InputError(
            f"{where} has {len(columns[0])} rows; a fit takes up to {MOST_ROWS}: give every second one, or their means"
        )
    for title, times in Counter(titles).items():
        if times > 1:
            raise InputError(f"{where} has the column {shown(title)} {times} times; give it once")
    by_name = {one.name: one for one in read_outs}
    other = set(deviations) - set(by_name)
    if other:
        raise InputError(
            f"{name}: 'deviations' names {shown(min(other))}, which is not fitted{nearest(min(other), list(by_name))}"
        )
    own = [title for title in titles if title in by_name]
    if set(own) != set(by_name):
        lacking = shortened(", ".join(sorted(set(by_name) - set(own))))
        raise InputError(
            f"{where} has no column {lacking}; name one for each read-out, such as 'tip [mm]'"
        )
    strict = not isinstance(data, Mapping)
    found: dict[str, Array] = {}
    keys, conditions = [], []
    for title, unit, column in zip(titles, units, columns, strict=True):
        base = title.removesuffix(_DEVIATION)
        if base in by_name:
            found[title] = _numbers(column, by_name[base].units, unit, f"{where}: '{title}'", strict)
        else:
            key = varied_key(problem, title, where)
            keys.append(key)
            conditions.append(_conditions(column, key, unit, where, strict))
    spread = {one.name: _spread(one, found, deviations, len(columns[0]), name) for one in read_outs}
    return Measured(tuple(keys), tuple(conditions), {word: found[word] for word in by_name}, spread)


def _from_file(path: Path, name: str) -> tuple[list[str], list[str], list[list[object]], str]:
    """Titles, units and columns of a file, and what it is called in errors."""
    header, *body = rows_of(path, path.name, name)
    if not body:
        raise InputError(f"{name}: {path.name} has no rows below its header")
    titles, units = [], []
    for title in header:
        found = TITLE.fullmatch(title)
        if found is None:
            raise InputError(
                f"{name}: {path.name} has a column {shown(title)}; name a key or a read-out, as in rod.length [mm]"
            )
        titles.append(found["key"])
        units.append(found["unit"] or "")
    return titles, units, [list(column) for column in zip(*body, strict=True)], f"{name}: {path.name}"


def _numbers(column: Sequence[object], si: str, unit: str, where: str, strict: bool) -> Array:
    """Numbers of a read-out in its SI unit; an empty cell was not measured."""
    wanted = unit_to_read(si)
    found = np.full(len(column), np.nan)
    for number, given in enumerate(column):
        item = given.item() if isinstance(given, np.generic) else given
        if isinstance(item, str):
            item = item.strip()
            if not item:
                continue
            plain = re.fullmatch(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", item)
            item = f"{item} {unit}" if plain and unit else item
        try:
            found[number] = to_si(item, wanted, unit_required=strict)
        except PydanticCustomError as error:
            raise InputError(f"{where}, row {number + 1}: {error.message()}") from None
    return found


def _conditions(
    column: Sequence[object], key: VariedKey, unit: str, where: str, strict: bool
) -> NDArray[np.object_]:
    """Values of a key."""
    found = np.empty(len(column), dtype=object)
    for number, given in enumerate(column):
        place = f"{where}, row {number + 1}"
        if strict:
            found[number] = cell([str(given)], 0, key, unit, place)
        else:
            item = given.item() if isinstance(given, np.generic) else given
            found[number] = read_value(key, item, f"{place}: '{key.path}'", unit_required=False)
    return found


def _spread(
    one: ReadOut, found: Mapping[str, Array], deviations: Mapping[str, object], count: int, name: str
) -> Array | None:
    """Standard deviations of a read-out, or None."""
    column = found.get(f"{one.name}{_DEVIATION}")
    if column is None and one.name in deviations:
        column = np.full(
            count, _numbers([deviations[one.name]], one.units, "", f"{name}: '{one.name}'", False)[0]
        )
    if column is not None:
        bad = ~(column > 0) & np.isfinite(found[one.name])
        if bad.any():
            number = int(np.argmax(bad))
            raise InputError(
                f"{name}: the standard deviation of '{one.name}' is {column[number]:g} in row {number + 1}; it must "
                "be above 0"
            )
    return column
