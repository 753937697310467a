"""A result as one tidy table, for spreadsheets and pandas.

A row is one place of the body at one instant, or the whole body at one instant.  Its column `place` says which:
"vertex", "edge", "section", "mesh", ..., or "whole"; `number` counts the places from 0.  The other columns are the
variables of the result, each with its unit, vectors with one column for each component.  A value stands in the rows of
the place where it was computed and nowhere else: edge values are not interpolated to vertices, and energies are not
repeated along the body.  What does not depend on time, such as the reference position, is repeated at every instant.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from cosserat.data.dataset import opened
from cosserat.data.files import check_destination, whole_or_absent
from cosserat.data.variables import LABELS
from cosserat.errors import InputError
from cosserat.parameters import nearest

INSTANTS = ("time", "point", "mode")
"""Dimensions of instants: of a motion, a path, and natural modes."""
WHOLE = "whole"
"""Place of the values that belong to the body as a whole."""


def to_dataframe(result: xr.Dataset | str | Path, place: str | None = None) -> pd.DataFrame:
    """A result as one tidy table: a row for each place of the body, or the whole of it, at each instant.

    Columns are `place`, `number` (of the place, from 0), the instant (`time [s]`, or the number of the point of a
    path), and one for each variable and component, named with its unit: `x_E2 [m]`.  Values are where they were
    computed; other cells are empty (NaN).

    result : a Dataset, or the name of its file.
    place : only the rows of this place, such as "vertex", without the columns that are empty there.

    Raises
    ------
    InputError : the result has no such place, or its file cannot be read.
    """
    dataset = opened(result)
    tables = {name: _rows(dataset, name) for name in _places(dataset)}
    if place is not None:
        if place not in tables:
            raise InputError(f"the result has no place '{place}'{nearest(place, list(tables))}")
        return tables[place]
    whole = pd.concat(tables.values(), ignore_index=True)
    columns = dict.fromkeys(name for table in tables.values() for name in table.columns)
    return whole[list(columns)]


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


def _split(values: xr.DataArray) -> tuple[str | None, str, list[str]]:
    """Dimensions of a variable: the instant, the place, and the components."""
    dims = [str(dim) for dim in values.dims]
    instant = dims.pop(0) if dims and dims[0] in INSTANTS else None
    place = WHOLE if not dims or dims[0] in LABELS else dims.pop(0)
    if dims and place == WHOLE and dims[-1] not in LABELS:  # such as measures by meshes
        place = dims.pop()
    return instant, place, dims


def _places(dataset: xr.Dataset) -> list[str]:
    """Places of a result, in the order of its variables; the whole body comes last."""
    found = dict.fromkeys(_split(dataset[name])[1] for name in _numeric(dataset))
    return [name for name in found if name != WHOLE] + [WHOLE] * (WHOLE in found)


def _numeric(dataset: xr.Dataset) -> list[str]:
    """Names of the variables that are numbers: coordinates first."""
    names = [str(name) for name in (*dataset.coords, *dataset.data_vars)]
    return [name for name in names if dataset[name].dtype.kind in "fiub"]


def _rows(dataset: xr.Dataset, place: str) -> pd.DataFrame:
    """The rows of one place: all instants, and the places of each."""
    known = {name: _split(dataset[name]) for name in _numeric(dataset) if name not in dataset.indexes}
    here = {name: split for name, split in known.items() if split[1] == place}
    along = next((instant for instant, _, _ in here.values() if instant is not None), None)
    # coordinates of the instants, such as the load factor, stand in every row
    here = {n: s for n, s in known.items() if s == (along, WHOLE, []) and n in dataset.coords} | here
    count = dataset.sizes[along] if along else 1
    size = 1 if place == WHOLE else dataset.sizes[place]
    columns: dict[str, object] = {
        "place": place,
        "number": np.tile(np.arange(size), count),
    }
    if along is not None:
        labels = dataset[along].to_numpy()
        columns[_named(dataset, along)] = np.repeat(labels, size)
    order = [d for d in (along, place) if d is not None and d != WHOLE]
    for name, (_, _, components) in here.items():
        values = dataset[name]
        missing = {dim: dataset.sizes[dim] for dim in order if dim not in values.dims}
        full = values.expand_dims(missing).transpose(*components, *order).to_numpy()
        for index in np.ndindex(full.shape[: len(components)]):
            parts = [_label(dataset, dim, k) for dim, k in zip(components, index, strict=True)]
            columns[_named(dataset, name, parts)] = full[index].ravel()
    return pd.DataFrame(columns, index=range(size * count))


def _label(dataset: xr.Dataset, dim: str, number: int) -> str:
    return str(dataset[dim].to_numpy()[number])


def _named(dataset: xr.Dataset, name: str, parts: list[str] | None = None) -> str:
    """Name of a column: variable, component and unit."""
    whole = "_".join([name, *(part.replace(" ", "_") for part in parts or [])])
    units = dataset[name].attrs.get("units")
    return whole if units is None else f"{whole} [{units}]"
