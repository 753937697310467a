"""Uncertainty bands: quantiles of a whole variable over the members of a study."""

from __future__ import annotations

import warnings
from collections.abc import Hashable, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from cosserat.arguments import NUMBERS, TEXT, TEXTS, taking
from cosserat.data.content import stamped
from cosserat.data.dataset import name_of
from cosserat.data.variables import COORDINATES, LABELS
from cosserat.errors import InputError
from cosserat.export.table import INSTANTS
from cosserat.parameters import nearest
from cosserat.studies.analysis.answered import answer_of, dims_of, keys_along, solved, unit_of
from cosserat.text import shown

USUAL = (0.05, 0.5, 0.95)
"""Quantiles by default."""
_MESHES = ("vertices", "sections", "elements")
_TIMES = ("duration", "every", "strides")
"""Last words of keys that decide where places and instants are."""


@taking(of=TEXT, quantiles=NUMBERS, over=TEXTS)
def bands(
    answer: xr.Dataset | str | Path,
    of: str,
    quantiles: Sequence[float] = USUAL,
    *,
    over: str | Sequence[str] | None = None,
) -> xr.Dataset:
    """Quantiles of a variable over the members of a study, place by place.

    The Dataset has the variable with `quantile` in place of the dimension of the members, in its unit, and `used`, the
    number of members with an answer.  Other factors stay dimensions.  `cosserat.plot` draws the bands.

    answer : of `cosserat.study` with variables that are kept whole, or the name of its file.
    of : name of the variable.  quantiles : probabilities between 0 and 1.
    over : dimensions of the members, by default those of random points and tables; of a list of values, quantiles
        have a meaning only where the values are equally probable.

    Raises
    ------
    InputError : the answer has no such variable or dimension, the points are no sample of their distribution, fewer
        than two members have an answer, members have different places, as of other meshes, or a quantile is not
        between 0 and 1.
    """
    data = answer_of(answer)
    if (
        of not in data.data_vars
        or data[of].dtype.kind != "f"
        or not set(dims_of(data)) <= set(data[of].dims)
    ):
        known = [str(n) for n, v in data.data_vars.items() if v.dtype.kind == "f"]
        raise InputError(
            f"{name_of(data)} has no variable {shown(of)} of its members{nearest(str(of), known)}; it has "
            f"{', '.join(known)}"
        )
    levels = np.unique(np.asarray(quantiles, dtype=np.float64))
    if not levels.size or not ((levels >= 0) & (levels <= 1)).all():
        raise InputError(f"bands has quantiles {shown(list(quantiles))}; they must be between 0 and 1")
    dims = _members(data, over)
    done = solved(data)
    used = done.sum(dims)
    _check_members(data, of, dims)
    with warnings.catch_warnings():
        warnings.filterwarnings(
            "ignore", "All-NaN slice"
        )  # places that only finer meshes of other factors have
        values = data[of].where(done).quantile(levels, dims, skipna=True, keep_attrs=True)
    left = [dim for dim in data[of].dims if dim not in dims]
    factors = [dim for dim in dims_of(data) if dim not in dims]
    values = values.transpose(*factors, "quantile", *[dim for dim in left if dim not in factors])
    about = {
        "units": unit_of(data[of]),
        "long_name": f"quantiles: {data[of].attrs.get('long_name', of)}",
    }
    made = xr.Dataset({of: values.assign_attrs({**data[of].attrs, **about})})
    made["used"] = used.astype(np.int64).assign_attrs(units="1", long_name="members with an answer")
    made["quantile"].attrs = {"units": "1", "long_name": "probability of a smaller value"}
    made.attrs = {**data.attrs, "bands": of}
    return stamped(made)


def _check_members(data: xr.Dataset, of: str, dims: list[str]) -> None:
    """Raise InputError if there are few members, some have no values, or they have values at different places."""
    values, done = data[of], solved(data)
    least = int(done.sum(dims).to_numpy().min(initial=values.size))
    own = [dim for dim in values.dims if dim not in dims_of(data)]
    called = f"'{of}' of {name_of(data)}"
    if not values.size:
        raise InputError(f"{called} is empty along {', '.join(map(str, own))}; take a part with values")
    if least < 2:
        raise InputError(f"{called} has {least} members with an answer; quantiles need at least two")
    there = values.notnull()
    if not bool((there.any(own) | ~done).all()):
        raise InputError(
            f"{called} has no number in a member with an answer: its mesh has no such place, or the answer was "
            "changed; keep a read-out such as 'u.E2 at last', or leave such members out"
        )
    moving = [key for dim in dims for key in keys_along(data, dim) if _moves(data[key], own)]
    if moving:
        raise InputError(
            f"{called} has members with different places along {', '.join(map(str, own))} by '{moving[0]}', where the "
            "same number is another place; take members of one value of it, or keep a read-out such as 'u.E2 at last'"
        )
    known = [data[str(name)] for name in data.variables if name in COORDINATES]
    for place in (there, *known):
        along = [dim for dim in dims if dim in place.dims]
        numbers = place.astype(np.float64).where(done)
        if along and bool((numbers.max(along) > numbers.min(along)).any()):
            raise InputError(
                f"{called} has members with different places along {', '.join(map(str, own))}, as of other meshes, "
                "where the same number is another place; take members of one mesh, or keep a read-out such as "
                "'u.E2 at last'"
            )


def _moves(key: xr.DataArray, own: list[Hashable]) -> bool:
    """Whether a key has several values and decides where places or instants along these dimensions are."""
    path = str(key.attrs["key"])
    word = path.rpartition(".")[2]
    places = word in _MESHES and any(dim not in (*LABELS, *INSTANTS) for dim in own)
    instants = "time" in own and (word in _TIMES or path == "step")
    return (places or instants) and len(set(key.to_numpy().tolist())) > 1


def _members(data: xr.Dataset, over: str | Sequence[str] | None) -> list[str]:
    """The dimensions of the members."""
    if over is not None:
        dims = [over] if isinstance(over, str) else list(dict.fromkeys(over))
        unknown = [dim for dim in dims if dim not in dims_of(data)]
        if unknown or not dims:
            raise InputError(
                f"{name_of(data)} has no members along {shown(unknown[0] if unknown else over)}; its factors are along "
                f"{', '.join(dims_of(data))}"
            )
        return dims
    dims = [dim for dim in dims_of(data) if keys_along(data, dim) and "key" not in data[dim].attrs]
    dims = [dim for dim in dims if data[dim].dtype.kind in "iu"]
    if not dims:
        raise InputError(
            f"{name_of(data)} has no random points, only lists of values; name the dimension of the members by 'over': "
            f"{', '.join(dims_of(data))}"
        )
    if any("trajectory" in data.coords and data["trajectory"].dims == (dim,) for dim in dims):
        raise InputError(
            f"{name_of(data)} has points for Morris's effects, which are no sample of their distributions; take 'sobol'"
        )
    return dims
