"""The answer of a study as a table with a row for each member."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

_LAST = ("status", "reason")


def is_answer(dataset: xr.Dataset) -> bool:
    """Whether a Dataset is the answer of a study."""
    return "study" in dataset.attrs and "status" in dataset


def of_members(answer: xr.Dataset) -> pd.DataFrame:
    """A row for each member in their order: coordinates, read-outs, "status" as a word, and "reason".

    Titles have units: "force [N]".  A member without an answer has empty read-outs (NaN).
    """
    status = answer["status"]
    dims = set(status.dims)
    words = np.array(str(status.attrs.get("flag_meanings", "")).split())
    coords = [
        str(name) for name, place in answer.coords.items() if place.dims and set(place.dims) <= dims
    ]
    own = [str(n) for n, v in answer.data_vars.items() if set(v.dims) == dims and n not in _LAST]
    columns: dict[str, Any] = {}
    for name in (
        sorted(coords, key=lambda name: (status.dims.index(answer[name].dims[0]), name not in dims))
        + own
    ):
        full = answer[name].broadcast_like(status).transpose(*status.dims)
        columns[named(answer, name)] = full.to_numpy().ravel()
    numbers = status.to_numpy().ravel()
    columns["status"] = words[numbers] if words.size > numbers.max(initial=0) else numbers
    columns["reason"] = answer["reason"].to_numpy().ravel() if "reason" in answer else ""
    return pd.DataFrame(columns)


def named(dataset: xr.Dataset, name: str, parts: list[str] | None = None) -> str:
    """Name of a column: variable, component and unit."""
    whole = "_".join([name, *(part.replace(" ", "_") for part in parts or [])])
    units = dataset[name].attrs.get("units")
    return whole if units is None else f"{whole} [{units}]"
