"""Orders of convergence of an answer over meshes or time steps."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from cosserat.arguments import TEXT, TEXTS, taking
from cosserat.data.content import stamped
from cosserat.data.dataset import name_of
from cosserat.data.variables import VARIABLES
from cosserat.errors import InputError
from cosserat.studies.analysis.answered import answer_of, dims_of, read_out, read_outs, unit_of
from cosserat.studies.analysis.sequences import STATES, convergence
from cosserat.studies.door import case_of_study
from cosserat.studies.readouts import read_out as parsed
from cosserat.text import shown

Array = NDArray[np.float64]
MESHES = ("vertices", "sections", "elements", "step")
"""Last words of the keys that refine a case: numbers of points, of elements, and times."""


@taking(along=TEXT, of=TEXTS)
def orders(
    answer: xr.Dataset | str | Path, along: str | None = None, of: str | Sequence[str] | None = None
) -> xr.Dataset:
    """Observed orders and limits of read-outs over finer and finer meshes, with an estimate of their errors.

    Of each read-out, such as "tip", the Dataset has "tip" on the finest mesh, "tip_limit" by Richardson's extrapolation
    and "tip_error", the estimated error of "tip", in its unit; "tip_order"; "tip_orders" of each three neighbouring
    meshes along `triple`, the finest last; and "tip_state", an integer with meanings.  Other factors stay dimensions.
    Where the values do not change in one direction, or not with one order, there is a state and no number (NaN).  With
    three meshes nothing confirms the order, and the error is estimated with more caution.

    answer : of `cosserat.study` with a list for one key, or the name of its file; a member without an answer is left
        out.
    along : the key of the meshes, as the coordinate is called; by default "vertices", "sections", "elements" or "step".
    of : names of read-outs, by default all.

    Raises
    ------
    InputError : the answer has no such key or read-out, or the key is no positive number.
    """
    data = answer_of(answer)
    along = _along(data, along)
    dim = str(data[along].dims[0])
    h = sizes_of(data, along)
    names = read_outs(data) if of is None else (of,) if isinstance(of, str) else tuple(of)
    others = [other for other in dims_of(data) if other != dim]
    made = xr.Dataset(
        coords={name: place for name, place in data.coords.items() if set(place.dims) <= set(others)}
    )
    for name in names:
        values = read_out(data, name)
        rows = values.transpose(*others, dim).to_numpy()
        found = np.empty(rows.shape[:-1], dtype=object)
        finest = np.full(rows.shape[:-1], np.nan)
        for index in np.ndindex(found.shape):
            there = np.isfinite(rows[index])
            found[index] = convergence(h[there], rows[index][there], _floor(values))
            if there.any():
                finest[index] = rows[index][there][h[there].argmin()]
        _add(made, name, (others, unit_of(values)), finest, found, h.size - 2)
    made.attrs = {
        "title": f"{data.attrs.get('title', '')}: convergence over '{along}'",
        "along": along,
        "analysis": "orders",
    }
    return stamped(made)


def _along(data: xr.Dataset, along: str | None) -> str:
    """The coordinate of the meshes.

    Raises
    ------
    InputError : there is none, more than one fits, or it is no positive number along a dimension of its own.
    """
    dims = dims_of(data)
    known = [
        str(n)
        for n, c in data.coords.items()
        if len(c.dims) == 1 and c.dims[0] in dims and c.dtype.kind in "fi"
    ]
    if along is None:
        fitting = [n for n in known if str(data[n].attrs.get("key", "")).rpartition(".")[2] in MESHES]
        if len(fitting) != 1:
            said = (
                f"{len(fitting)} keys of meshes ({', '.join(fitting)})"
                if fitting
                else "no key of meshes"
            )
            raise InputError(
                f"{name_of(data)} varies {said}; name one of its keys by 'along': {', '.join(known)}"
            )
        along = fitting[0]
    if along not in known:
        raise InputError(
            f"{name_of(data)} has no numbers {shown(along)} of a key; it has {', '.join(known)}"
        )
    values = data[along].to_numpy()
    if not (values > 0).all() or len(set(values.tolist())) < values.size:
        raise InputError(f"'{along}' of {name_of(data)} must be positive numbers, each given once")
    return along


def sizes_of(data: xr.Dataset, along: str) -> Array:
    """The sizes h of the meshes: one over the number of edges or elements, or the time step itself.

    A motion takes equal steps between two frames, so its own step is used.
    """
    values, key = data[along].to_numpy().astype(np.float64), str(data[along].attrs.get("key", ""))
    if key.rpartition(".")[2] in ("vertices", "sections"):
        return 1 / (values - 1)
    if data[along].dtype.kind == "i":
        return 1 / values
    if key != "integrator.step":
        return values
    between = getattr(case_of_study(data).problem, "between_frames", None)
    varied = {str(place.attrs.get("key", "")) for place in data.coords.values()}
    if between is None or varied & {"every", "duration"}:
        return values
    return np.asarray(between / np.ceil(between / values * (1 - 1e-9)))


def _floor(values: xr.DataArray) -> float:
    """Changes of a read-out below this are round-off."""
    text = values.attrs.get("read_out")
    return (
        0.0 if text is None else VARIABLES[parsed(str(values.name), text, "the answer").variable].floor
    )


def _add(
    made: xr.Dataset,
    name: str,
    about: tuple[list[str], str],
    finest: Array,
    found: NDArray[np.object_],
    triples: int,
) -> None:
    """Put what was found of one read-out into a Dataset; about : its dimensions and its unit."""
    dims, unit = about

    def taken(pick: str) -> Array:
        values = [getattr(one, pick) for one in found.ravel()]
        return np.array([np.nan if v is None else v for v in values], dtype=np.float64).reshape(
            found.shape
        )

    errors = [
        _or_nan(one.error(value)) for one, value in zip(found.ravel(), finest.ravel(), strict=True)
    ]
    observed = np.full((*found.shape, max(triples, 0)), np.nan)
    for row, one in zip(observed.reshape(found.size, -1), found.ravel(), strict=True):
        for k, order in enumerate(reversed(one.orders)):
            row[-1 - k] = _or_nan(order)
    made[name] = (dims, finest, {"units": unit, "long_name": f"'{name}' on the finest mesh"})
    made[f"{name}_limit"] = (dims, taken("limit"), {"units": unit, "long_name": f"limit of '{name}'"})
    made[f"{name}_error"] = (
        dims,
        np.array(errors, dtype=np.float64).reshape(found.shape),
        {"units": unit, "long_name": f"estimated error of '{name}' on the finest mesh"},
    )
    made[f"{name}_order"] = (
        dims,
        taken("order"),
        {"units": "1", "long_name": f"observed order of '{name}'"},
    )
    made[f"{name}_orders"] = (
        (*dims, "triple"),
        observed,
        {"units": "1", "long_name": f"order of '{name}' by three meshes"},
    )
    made[f"{name}_state"] = (
        dims,
        np.array([one.state for one in found.ravel()], dtype=np.int8).reshape(found.shape),
        {
            "long_name": f"how '{name}' converges",
            "flag_values": np.arange(len(STATES), dtype=np.int8),
            "flag_meanings": " ".join(STATES),
        },
    )


def _or_nan(value: float | None) -> float:
    return np.nan if value is None else value
