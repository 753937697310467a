"""A result as one tidy table, for spreadsheets and pandas.

A row is one place of the body at one instant, or the whole body at one instant.  Its column `place` says which:
"vertex", "edge", "section", "mesh", ..., or "whole"; `number` counts the places from 0.  The other columns are the
variables of the result, each with its unit, vectors with one column for each component.  A value stands in the rows of
the place where it was computed and nowhere else: edge values are not interpolated to vertices, and energies are not
repeated along the body.  What does not depend on time, such as the reference position, is repeated at every instant.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from cosserat.arguments import TEXT, taking
from cosserat.data.dataset import name_of
from cosserat.data.files import check_destination, whole_or_absent
from cosserat.data.netcdf import opened
from cosserat.data.variables import LABELS
from cosserat.errors import InputError
from cosserat.export.members import is_answer, named, of_members
from cosserat.parameters import nearest
from cosserat.text import shortened

INSTANTS = ("time", "point", "mode", "special")
"""Dimensions of instants: of a motion, a path, natural modes, and special points of a path."""
WHOLE = "whole"
"""Place of the values that belong to the body as a whole."""


@taking(place=TEXT)
def to_dataframe(result: xr.Dataset | str | Path, place: str | None = None) -> pd.DataFrame:
    """A result as one tidy table: a row for each place of the body, or the whole of it, at each instant.

    Columns are `place`, `number` (of the place, from 0), the instant (`time [s]`, or the number of the point of a
    path), and one for each variable and component, named with its unit: `x_E2 [m]`.  Values are where they were
    computed; other cells are empty (NaN).

    result : a Dataset, or the name of its file.
    place : only the rows of this place, such as "vertex", without the columns that are empty there.

    The answer of a study gives a row for each member: the varied keys, the read-outs, "status" and "reason", without
    the variables that are kept whole.  It may be a part or means that were taken of it.

    Raises
    ------
    InputError : the result has no such place or no numbers, or its file cannot be read.
    """
    dataset = opened(result)
    if is_answer(dataset):
        if place is not None:
            raise InputError(
                f"an answer of a study has a row for each member and no place '{shortened(place)}'; leave it out"
            )
        return of_members(dataset)
    known = {name: _split(dataset[name]) for name in _numeric(dataset)}
    places = list(dict.fromkeys(split.place for split in known.values()))
    if place is not None and place not in places:
        raise InputError(f"the result has no place '{shortened(place)}'{nearest(place, places)}")
    tables = [
        _rows(dataset, known, instant, one)
        for one in sorted(places, key=WHOLE.__eq__)
        for instant in _instants(known, one)
        if place in (None, one)
    ]
    if not tables:
        raise InputError(f"{name_of(dataset)} has no numbers for a table; give a result of cosserat")
    columns = dict.fromkeys(name for table in tables for name in table.columns)
    return pd.concat(tables, ignore_index=True)[list(columns)]


def write_csv(dataset: xr.Dataset, path: Path, place: str | None = None) -> None:
    """Write the tidy table as CSV in UTF-8, whole or not at all; numbers read back to the same bits.

    Raises
    ------
    InputError : the result has no such place, or the destination cannot be written.
    """
    check_destination(path, ".csv")
    table = to_dataframe(dataset, place)
    with whole_or_absent(path) as temporary:
        table.to_csv(temporary, index=False, lineterminator="\n", encoding="utf-8")


@dataclass(frozen=True)
class _Split:
    """Dimensions of a variable: the instant, if any, the place, and the components."""

    instant: str | None
    place: str
    components: tuple[str, ...] = ()


def _split(values: xr.DataArray) -> _Split:
    dims = [str(dim) for dim in values.dims]
    instant = dims.pop(0) if dims and dims[0] in INSTANTS else None
    place = next((dim for dim in dims if dim not in LABELS), WHOLE)
    return _Split(instant, place, tuple(dim for dim in dims if dim != place))


def _instants(known: Mapping[str, _Split], place: str) -> list[str | None]:
    """The instants of the values at a place; only None if none of them has any."""
    found = dict.fromkeys(split.instant for split in known.values() if split.place == place)
    return [instant for instant in found if instant is not None] or [None]


def _numeric(dataset: xr.Dataset) -> list[str]:
    """Names of the variables that are numbers, those first that place the others; `time` is an instant itself."""
    names = [str(name) for name in (*dataset.coords, *dataset.data_vars) if name not in dataset.indexes]
    return [name for name in names if dataset[name].dtype.kind in "fiub"]


def _rows(
    dataset: xr.Dataset, known: Mapping[str, _Split], instant: str | None, place: str
) -> pd.DataFrame:
    """The rows of one place: all instants of one kind, and the places of each."""
    count = 1 if instant is None else dataset.sizes[instant]
    size = 1 if place == WHOLE else dataset.sizes[place]
    columns: dict[str, Any] = {"place": place, "number": np.tile(np.arange(size), count)}
    if instant is not None:
        columns |= {name: _whole(np.repeat(of, size)) for name, of in _labels(dataset, instant).items()}
    order = [dim for dim in (instant, place) if dim is not None and dim != WHOLE]
    for name, split in known.items():
        # coordinates of the instants, such as the load factor, stand in every row
        everywhere = split == _Split(instant, WHOLE) and name in dataset.coords
        if not everywhere and (split.place != place or split.instant not in (instant, None)):
            continue
        values = dataset[name]
        missing = {dim: dataset.sizes[dim] for dim in order if dim not in values.dims}
        full = values.expand_dims(missing).transpose(*split.components, *order).to_numpy()
        for index in np.ndindex(full.shape[: len(split.components)]):
            parts = [_label(dataset, dim, k) for dim, k in zip(split.components, index, strict=True)]
            columns[named(dataset, name, parts)] = full[index].ravel()
    return pd.DataFrame(columns, index=range(size * count))


def _labels(dataset: xr.Dataset, instant: str) -> dict[str, NDArray[Any]]:
    """Columns that tell instants apart: their times, or their numbers and, if they have any, their names."""
    numbers = np.arange(dataset.sizes[instant])
    if instant not in dataset.coords:
        return {instant: numbers}
    labels = dataset[instant].to_numpy()
    if labels.dtype.kind in "fiub":
        return {named(dataset, instant): labels}
    return {instant: numbers, f"{instant}_name": labels}


def _whole(values: NDArray[Any]) -> Any:
    """Whole numbers stay so beside empty cells."""
    return pd.array(values, dtype="Int64") if values.dtype.kind == "i" else values


def _label(dataset: xr.Dataset, dim: str, number: int) -> str:
    return str(dataset[dim].to_numpy()[number])
