"""An answer read back: its factors, its keys, its read-outs, and which members are solved."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr

from cosserat.data.dataset import name_of
from cosserat.data.netcdf import opened
from cosserat.errors import InputError
from cosserat.export.members import dims_of_members
from cosserat.parameters import nearest
from cosserat.studies.solving import NOT_CONVERGED
from cosserat.text import shown


def answer_of(given: xr.Dataset | str | Path) -> xr.Dataset:
    """The answer of a study, given by itself or by the name of its file.

    Raises
    ------
    InputError : it is no answer of a study, or its file cannot be read.
    """
    data = opened(given)
    if "study" not in data.attrs or "status" not in data:
        raise InputError(
            f"{name_of(data)} is no answer of a study: it has no 'study' and 'status'; use one of cosserat.study"
        )
    dims_of_members(data)  # refuses a status that is no number
    return data


def dims_of(answer: xr.Dataset) -> tuple[str, ...]:
    """The dimensions of the factors, the slowest first."""
    return tuple(map(str, answer["status"].dims))


def keys_along(answer: xr.Dataset, dim: str) -> tuple[str, ...]:
    """The coordinates of the varied keys along one dimension."""
    return tuple(
        str(name)
        for name, place in answer.coords.items()
        if "key" in place.attrs and place.dims == (dim,)
    )


def solved(answer: xr.Dataset) -> xr.DataArray:
    """Which members have an answer, along the dimensions of the factors."""
    return answer["status"] < NOT_CONVERGED


def read_outs(answer: xr.Dataset) -> tuple[str, ...]:
    """The names of the variables with one number for each member."""
    dims = set(answer["status"].dims)
    return tuple(
        str(name)
        for name, values in answer.data_vars.items()
        if values.dtype.kind == "f" and set(values.dims) == dims
    )


def read_out(answer: xr.Dataset, of: str) -> xr.DataArray:
    """A read-out, not a number where a member has no answer.

    Raises
    ------
    InputError : the answer has no read-out of that name, or a solved member has no number.
    """
    known = read_outs(answer)
    if of not in known:
        raise InputError(
            f"{name_of(answer)} has no read-out {shown(of)}{nearest(str(of), list(known))}"
            + (f"; it has {', '.join(known)}" if known else "")
        )
    values, done = answer[of], solved(answer)
    if not np.isfinite(values.where(done, 0.0)).all():
        raise InputError(
            f"'{of}' of {name_of(answer)} has no number in a member that its 'status' calls solved; use the answer as "
            "cosserat made it"
        )
    return values.where(done)


def unit_of(values: xr.DataArray) -> str:
    """The unit of a variable or coordinate, "1" if it has none."""
    return str(values.attrs.get("units", "1"))
