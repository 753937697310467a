"""The answer of a study as a table with a row for each member."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from cosserat.data.dataset import name_of
from cosserat.errors import InputError

_LAST = ("status", "reason")


def is_answer(dataset: xr.Dataset) -> bool:
    """Whether a Dataset is the answer of a study, or a part of it that a user took."""
    return "study" in dataset.attrs and not {"bands", "analysis"} & set(dataset.attrs)


def dims_of_members(answer: xr.Dataset) -> tuple[str, ...]:
    """The dimensions of the members: of "status", or without it those of the varied keys, the slowest first.

    Raises
    ------
    InputError : it has neither, or "status" holds no numbers.
    """
    if "status" in answer:
        if answer["status"].dtype.kind not in "iuf":
            raise InputError(
                f"{name_of(answer)} has a 'status' of type {answer['status'].dtype}, which is a number for each "
                "member; use the answer as cosserat made it"
            )
        return tuple(map(str, answer["status"].dims))
    dims = {str(dim) for place in answer.coords.values() if "key" in place.attrs for dim in place.dims}
    if not dims:
        raise InputError(
            f"{name_of(answer)} is of a study and has neither 'status' nor varied keys that tell members apart; keep "
            "one of them"
        )
    orders = [tuple(map(str, values.dims)) for values in answer.data_vars.values()]
    order = next((own for own in orders if dims <= set(own)), tuple(sorted(dims)))
    return tuple(dim for dim in order if dim in dims)


def of_members(answer: xr.Dataset) -> pd.DataFrame:
    """A row for each member in their order: coordinates, read-outs, "status" as a word, and "reason".

    Titles have units: "force [N]".  A member without an answer has empty read-outs (NaN).  Where a user took a part of
    an answer, or means of it, "status" is empty for what has none.

    Raises
    ------
    InputError : as of `dims_of_members`.
    """
    dims = dims_of_members(answer)
    every = xr.DataArray(np.zeros([answer.sizes[dim] for dim in dims]), dims=dims)
    coords = [
        str(name) for name, place in answer.coords.items() if place.dims and set(place.dims) <= set(dims)
    ]
    own = [str(n) for n, v in answer.data_vars.items() if set(v.dims) == set(dims) and n not in _LAST]
    columns: dict[str, Any] = {}
    for name in (
        sorted(coords, key=lambda name: (dims.index(str(answer[name].dims[0])), name not in dims)) + own
    ):
        full = answer[name].variable.set_dims({dim: answer.sizes[dim] for dim in dims}).transpose(*dims)
        columns[named(answer, name)] = full.to_numpy().ravel()
    columns["status"] = _words(answer, every.size)
    whole = "reason" in answer and set(answer["reason"].dims) == set(dims)
    reasons = answer["reason"].transpose(*dims).to_numpy().ravel() if whole else np.full(every.size, "")
    columns["reason"] = [text if isinstance(text, str) else "" for text in reasons]
    return pd.DataFrame(columns)


def _words(answer: xr.Dataset, count: int) -> NDArray[Any]:
    """The status of each member as a word, or its number where the meanings are lost; empty where there is none."""
    if "status" not in answer:
        return np.full(count, "", dtype=object)
    numbers = answer["status"].to_numpy().ravel()
    words = str(answer["status"].attrs.get("flag_meanings", "")).split()
    if not words:
        return numbers
    known = [int(one) if np.isfinite(one) and one == int(one) else -1 for one in numbers]
    return np.array([words[k] if 0 <= k < len(words) else "" for k in known], dtype=object)


def named(dataset: xr.Dataset, name: str, parts: list[str] | None = None) -> str:
    """Name of a column: variable, component and unit."""
    whole = "_".join([name, *(part.replace(" ", "_") for part in parts or [])])
    units = dataset[name].attrs.get("units")
    return whole if units is None else f"{whole} [{units}]"
