"""The answer of a study as a labelled Dataset over its factors."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from cosserat.data.content import stamped
from cosserat.data.dataset import origin
from cosserat.data.provenance import environment
from cosserat.data.variables import LABELS, VARIABLES
from cosserat.errors import FailedMembersError
from cosserat.studies.factors import Columns
from cosserat.studies.family import Family, derivative_name
from cosserat.studies.keys import VariedKey
from cosserat.studies.solving import NOT_CONVERGED, STATUS, WARNED, Solved


def answer(found: Family, solved: Solved) -> xr.Dataset:
    """The Dataset of a study: a dimension for each factor, its keys as coordinates, and what is kept as variables."""
    dims, shape = found.dims(), found.shape
    coords: dict[str, Any] = {}
    for factor, dim in zip(found.factors, dims, strict=True):
        coords |= _coordinates(found, factor, dim)
    variables: dict[str, Any] = {}
    method = _method(found)
    for one in found.keep:
        about = {"units": one.units, "long_name": one.long_name, "read_out": one.text}
        variables[one.name] = (dims, solved.values[one.name].reshape(shape), about)
        for key in found.by:
            told = {
                "units": derivative_unit(one.units, cf_unit(key.unit)),
                "long_name": f"derivative of {one.name} by {key.path}",
                "key": key.path,
                "method": method,
            }
            values = solved.values[derivative_name(one.name, key.path)].reshape(shape)
            variables[f"{one.name}_by_{found.names[key.path]}"] = (dims, values, told)
    for name, (own, values) in solved.whole.items():
        variables[name] = ((*dims, *own[1:]), values.reshape(*shape, *values.shape[1:]), _about(name))
    for name, (own, values) in solved.beside.items():
        coords[name] = (own, values, _about(name))
    used = {dim for own, *_ in variables.values() for dim in own}
    coords |= {
        dim: ((dim,), list(words), {"long_name": LABELS[dim]})
        for dim, words in solved.labels.items()
        if dim in used
    }
    variables["status"] = (dims, solved.status.reshape(shape), _STATUS)
    variables["reason"] = (
        dims,
        solved.reason.reshape(shape),
        {"long_name": "why a member has no answer, or a warning about its numbers"},
    )
    about = {"units": "1", "long_name": "iterations of the solver; -1 where it counts none"}
    variables["iterations"] = (dims, solved.iterations.reshape(shape), about)
    dataset = xr.Dataset(variables, coords)
    for name in map(str, dataset.coords):
        if dataset[name].dtype.kind == "f":
            dataset[name].encoding["_FillValue"] = None
    dataset.attrs = {
        **origin(found.title, found.study.source or "a study of the user"),
        "history": f"cosserat study {found.name}",
        "study": found.asked,
        "environment": json.dumps(environment(), sort_keys=True),
    }
    return stamped(dataset)


def _method(found: Family) -> str:
    """How derivatives are taken, if there are some."""
    if not found.by:
        return ""
    from cosserat.studies.derivatives import method_of

    return method_of(found.base.problem)


_STATUS = {
    "long_name": "whether a member has an answer",
    "flag_values": np.arange(len(STATUS), dtype=np.int8),
    "flag_meanings": " ".join(STATUS),
}


def _about(name: str) -> dict[str, str]:
    entry = VARIABLES[name]
    return {
        "units": entry.units,
        "long_name": entry.long_name,
        "symbol": entry.symbol,
        "equation": entry.equation,
    }


def _coordinates(found: Family, factor: Columns, dim: str) -> dict[str, Any]:
    """The coordinates of one factor: its keys, its names, its numbers, and places in a design."""
    coords: dict[str, Any] = {}
    for key, values in zip(factor.keys, factor.values, strict=True):
        written, about = _written(key, values)
        coords[found.names[key.path]] = ((dim,), written, about)
    if factor.names:
        coords[dim] = ((dim,), list(factor.names), {"long_name": "name of the values"})
    elif dim not in coords:
        coords[dim] = (
            (dim,),
            np.arange(factor.size),
            {"units": "1", "long_name": "number of the member"},
        )
    for name, values in factor.about.items():
        coords[name] = (
            (dim,),
            values,
            {"units": "1", "long_name": f"{name} of the design '{factor.design}'"},
        )
    return coords


def _written(key: VariedKey, values: NDArray[Any]) -> tuple[Any, dict[str, str]]:
    about = {"long_name": key.meaning, "key": key.path}
    if values.dtype.kind in "fi":
        return values, {"units": cf_unit(key.unit), **about}
    return [
        item if isinstance(item, str) else json.dumps(item, sort_keys=True) for item in values
    ], about


def derivative_unit(of: str, by: str) -> str:
    """The unit of a derivative, as udunits reads it: of "m" by "Pa" it is "m Pa-1"."""
    top = [part for part in of.split() if part != "1"]
    return " ".join(top + [_inverted(part) for part in by.split() if part != "1"]) or "1"


def _inverted(part: str) -> str:
    """One over a unit with its power: "s-2" gives "s2"."""
    name = part.rstrip("-0123456789")
    power = -int(part[len(name) :] or 1)
    return name if power == 1 else f"{name}{power}"


def cf_unit(unit: str) -> str:
    """A unit as udunits reads it: "N*m^2" as "N m2"."""
    top, *below = unit.replace("*", " ").replace("^", "").split("/")
    names = [f"{name}-1" for part in below for name in part.split()] if below else []
    return (
        " ".join([part for part in top.split() if part != "1"] + [_inverse(name) for name in names])
        or "1"
    )


def _inverse(name: str) -> str:
    plain = name.removesuffix("-1")
    digits = plain.lstrip("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ")
    return f"{plain[: len(plain) - len(digits)]}-{digits or 1}"


def failed(data: xr.Dataset) -> int:
    """How many members of an answer have none."""
    return int((data["status"] >= NOT_CONVERGED).sum())


def check_solved(data: xr.Dataset, where: str) -> None:
    """Raise FailedMembersError if some members have no answer; where : the answer is."""
    if failed(data):
        raise FailedMembersError(
            f"{failed(data)} of {data['status'].size} members have no answer; 'status' and 'reason' in {where} say why"
        )


def counts(data: xr.Dataset) -> str:
    """How many members have which status, in words."""
    status = data["status"].to_numpy()
    total = {word.replace("_", " "): int((status == number).sum()) for number, word in enumerate(STATUS)}
    solved = total.pop("solved") + total["solved with warning"]
    warned = total.pop("solved with warning")
    parts = [
        f"{solved} of {status.size} members solved" + (f" ({warned} with a warning)" if warned else "")
    ]
    return ", ".join(parts + [f"{number} {word}" for word, number in total.items() if number])


__all__ = ["WARNED", "answer", "check_solved", "counts", "failed"]
