"""Factors of a study as columns of values: lists, tables from CSV files, and points with distributions."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import InputError
from cosserat.problem import Problem
from cosserat.reading import read_text
from cosserat.studies.designs import DESIGNS, Points, number_of_points
from cosserat.studies.distributions import correlated, distribution, is_distribution
from cosserat.studies.keys import VariedKey, read_value, varied_key
from cosserat.studies.study import MOST_MEMBERS, Factor
from cosserat.text import shortened, shown

Values = NDArray[Any]
TITLE = re.compile(r"\s*(?P<key>[\w.]+)\s*(?:[\[(]\s*(?P<unit>[^\])]*?)\s*[\])])?\s*")
"""A title of a column: a key with its unit in brackets."""
_MOST_BYTES = 200_000_000


@dataclass(frozen=True)
class Columns:
    """The members of one factor.

    dim : name of its dimension.  keys : the varied keys.  values : of each key, (n,): floats in SI units, or objects.
    names : of the values along the dimension.  about : integers that place them in a design, each (n,).
    design : the word of the design, or "".
    """

    dim: str
    keys: tuple[VariedKey, ...]
    values: tuple[Values, ...]
    names: tuple[str, ...] = ()
    about: Mapping[str, NDArray[np.int64]] = field(default_factory=dict)
    design: str = ""

    @property
    def size(self) -> int:
        """The number of its members."""
        return len(self.values[0])


def columns(
    factor: Factor, problem: Problem, study: str, folder: Path, *, unit_required: bool
) -> Columns:
    """The members of a factor.

    problem : whose keys are varied.  study : its name in errors.  folder : where the files that it names are.

    Raises
    ------
    InputError : a key is unknown, a value is not valid, or a range is empty.
    """
    if factor.table:
        found = _from_table(factor, problem, study, folder)
    else:
        keys = tuple(varied_key(problem, path, study) for path in factor.varied)
        if factor.design:
            found = _from_points(factor, keys, study, unit_required=unit_required)
        else:
            found = _from_lists(factor, keys, study, unit_required=unit_required)
    if factor.names is not None and len(factor.names) != found.size:
        raise InputError(
            f"{study}: 'names' has {len(factor.names)} names for {found.size} values; give as many"
        )
    if factor.name and not factor.name.isidentifier():
        raise InputError(
            f"{study}: {shown(factor.name)} cannot name a dimension; use letters, digits and '_'"
        )
    return found


def _from_lists(
    factor: Factor, keys: tuple[VariedKey, ...], study: str, *, unit_required: bool
) -> Columns:
    values = []
    for key, given in zip(keys, factor.varied.values(), strict=True):
        if is_distribution(given):
            raise InputError(
                f"{study}: '{key.path}' has a distribution, but the factor has no points; add 'sobol = 1024'"
            )
        if not isinstance(given, Sequence | np.ndarray) or isinstance(given, str) or not len(given):
            raise InputError(
                f"{study}: '{key.path}' is {shown(given)}; give a list of values, or a distribution"
            )
        if len(given) > MOST_MEMBERS:
            raise InputError(
                f"{study}: '{key.path}' has {len(given)} values; it may have up to {MOST_MEMBERS}"
            )
        read = [
            read_value(
                key, _plain(item), f"{study}: item {number} of '{key.path}'", unit_required=unit_required
            )
            for number, item in enumerate(given)
        ]
        values.append(_column(key, read))
    lengths = {len(column) for column in values}
    if len(lengths) > 1:
        said = ", ".join(f"'{key.path}' {len(column)}" for key, column in zip(keys, values, strict=True))
        raise InputError(
            f"{study}: keys of one factor are varied together, but they have different numbers of values ({said}); "
            "give them as many, or factors of their own"
        )
    if len(keys) > 1 and not factor.name:
        raise InputError(f"{study}: {len(keys)} keys are varied together; give their dimension a 'name'")
    return Columns(
        factor.name or (keys[0].last if len(keys) == 1 else ""), keys, tuple(values), factor.names or ()
    )


def _plain(item: object) -> object:
    return item.item() if isinstance(item, np.generic) else item


def _column(key: VariedKey, read: list[object]) -> Values:
    if key.is_number and all(isinstance(item, int | float) for item in read):
        return np.array(read)
    column = np.empty(len(read), dtype=object)
    column[:] = read
    return column


def _from_points(
    factor: Factor, keys: tuple[VariedKey, ...], study: str, *, unit_required: bool
) -> Columns:
    laws = []
    for key, given in zip(keys, factor.varied.values(), strict=True):
        if not is_distribution(given):
            raise InputError(
                f"{study}: '{key.path}' is {shown(given)}; a factor with points takes a distribution, such as "
                '{ uniform = ["1 GPa", "2 GPa"] }'
            )
        own = factor.covariance is None
        laws.append(distribution(key, given, study, unit_required=unit_required, own=own))
    count = getattr(factor, factor.design)
    members = number_of_points(factor.design, count, len(keys))
    if members > MOST_MEMBERS:
        raise InputError(
            f"{study}: {factor.design} = {count} gives {members} members; a study may have up to {MOST_MEMBERS}"
        )
    try:
        points = DESIGNS[factor.design](count, len(keys), factor.seed)
    except InputError as error:
        raise InputError(f"{study}: {error}") from None
    cube = points.cube
    if factor.covariance is not None:
        covariance = _covariance(factor.covariance, keys, [law.law for law in laws], study)
        deviations = np.sqrt(np.diag(covariance))
        laws = [law.with_deviation(float(size)) for law, size in zip(laws, deviations, strict=True)]
        cube = _mixed(points, covariance / np.outer(deviations, deviations), study)
    values = tuple(
        _counted(key, law.values(cube[:, k]))
        for k, (key, law) in enumerate(zip(keys, laws, strict=True))
    )
    return Columns(factor.name or "member", keys, values, (), points.about, factor.design)


def _counted(key: VariedKey, values: NDArray[np.float64]) -> Values:
    """Whole numbers for a key that counts."""
    return values if key.quantity else np.floor(values).astype(np.int64)


def _mixed(points: Points, correlation: NDArray[np.float64], study: str) -> NDArray[np.float64]:
    if points.about:
        raise InputError(f"{study}: a design for indices needs independent keys; leave 'covariance' out")
    try:
        return correlated(points.cube, correlation)
    except np.linalg.LinAlgError:
        raise InputError(
            f"{study}: 'covariance' is not positive definite; no keys vary like that"
        ) from None


def _covariance(
    rows: Sequence[Sequence[float]], keys: Sequence[VariedKey], laws: Sequence[str], study: str
) -> NDArray[np.float64]:
    count = len(keys)
    if set(laws) != {"normal"}:
        raise InputError(
            f"{study}: a 'covariance' is one of normal keys; give each {{ normal = [mean] }}"
        )
    if len(rows) != count or any(len(row) != count for row in rows):
        raise InputError(
            f"{study}: 'covariance' must have {count} rows of {count} numbers, in the order of the keys"
        )
    found = np.array(rows, dtype=np.float64)
    if not np.isfinite(found).all() or not (found == found.T).all() or not (np.diag(found) > 0).all():
        raise InputError(
            f"{study}: 'covariance' must be symmetric, with variances above 0 on its diagonal"
        )
    return found


def _from_table(factor: Factor, problem: Problem, study: str, folder: Path) -> Columns:
    rows = rows_of(folder / factor.table, factor.table, study)
    header, body = rows[0], rows[1:]
    keys, units = [], []
    for title in header:
        found = TITLE.fullmatch(title)
        if found is None:
            raise InputError(
                f"{study}: {factor.table} has a column {shown(title)}; name a key, as in rod.length [mm]"
            )
        keys.append(varied_key(problem, found["key"], study))
        units.append(found["unit"] or "")
    if not body:
        raise InputError(f"{study}: {factor.table} has no rows below its header")
    if len(body) > MOST_MEMBERS:
        raise InputError(
            f"{study}: {factor.table} has {len(body)} rows; a study may have up to {MOST_MEMBERS} members"
        )
    for key, unit in zip(keys, units, strict=True):
        if unit and key.quantity is None:
            raise InputError(
                f"{study}: {factor.table}: '{key.path}' takes no unit, but its column has [{unit}]"
            )
    values = []
    for k, (key, unit) in enumerate(zip(keys, units, strict=True)):
        read = [
            cell(row, k, key, unit, f"{study}: {factor.table}, row {n + 1}")
            for n, row in enumerate(body)
        ]
        values.append(_column(key, read))
    return Columns(factor.name or "member", tuple(keys), tuple(values), factor.names or ())


def rows_of(path: Path, name: str, study: str) -> list[list[str]]:
    """The rows of a CSV file, the header first; name : of the file, and study : in errors.

    Raises
    ------
    InputError : it cannot be read, or its rows have different lengths.
    """
    try:
        text = read_text(path, _MOST_BYTES)
    except OSError as error:
        raise InputError(f"{study}: cannot read the table {name}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise InputError(f"{study}: the table {name} is not in UTF-8") from None
    try:
        rows = [
            row
            for row in csv.reader(io.StringIO(text), strict=True)
            if any(cell.strip() for cell in row)
        ]
    except csv.Error as error:
        raise InputError(f"{study}: {name} is no table of comma-separated values ({error})") from None
    if not rows:
        raise InputError(f"{study}: the table {name} is empty; its first row names the keys")
    for number, row in enumerate(rows):
        if len(row) != len(rows[0]):
            raise InputError(
                f"{study}: {name}, row {number}: has {len(row)} cells, and the header {len(rows[0])}; give as many"
            )
    return rows


def cell(row: list[str], k: int, key: VariedKey, unit: str, where: str) -> object:
    """One value: a number in the unit of its column, or with a unit of its own.

    Raises
    ------
    InputError : it is not valid, or has no unit.
    """
    text = row[k].strip()
    place = f"{where}: '{key.path}'"
    if key.quantity is None:
        if key.is_number and key.about.value.form != "either":
            if not re.fullmatch(r"[+-]?\d{1,18}", text):
                raise InputError(f"{place} is {shown(text)}; it must be a whole number")
            return read_value(key, int(text), place, unit_required=False)
        counted = key.is_number and re.fullmatch(r"\d{1,18}", text)
        return read_value(key, int(text) if counted else text, place, unit_required=True)
    plain = re.fullmatch(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", text)
    if plain and unit and key.unit != "1":
        text = f"{text} {unit}"
    elif plain and key.unit != "1":
        raise InputError(
            f"{place} is {shown(shortened(text))}, without a unit; put it into the header: {key.path} [{key.unit}]"
        )
    return read_value(key, text, place, unit_required=True)
