"""Solutions as xarray Datasets with units, meaning and origin; netCDF files that are whole or absent."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np
import xarray as xr

from cosserat.cases.catalogue import Case, parse
from cosserat.data.files import check_destination, uninterrupted, whole_or_absent
from cosserat.data.provenance import environment, source
from cosserat.data.variables import COORDINATES, LABELS, VARIABLES
from cosserat.errors import InputError, path_of
from cosserat.publications import reference
from cosserat.solution import Solution

P = TypeVar("P")
_FRAME = "frame"
"""Dimension of instants in a file, with `time` along it.  Tools of CF take a dimension named `time` for dates; here
times are plain seconds from the start."""
_ALONG = ("time", "point")
"""Dimensions that may come before those of one state."""


def to_dataset(case: Case, solution: Solution) -> xr.Dataset:
    """A solution with `units`, `long_name`, `symbol` and `equation` on every variable.

    Global attributes hold the case's parameters, the solver's statistics and the origin, but no date.  The attribute
    `derived` names the variables that follow from the others.

    Raises
    ------
    ValueError : a value is not finite, or a field is not known or has other dimensions than `data.variables` says.
    """
    solution, derived = _completed(solution)
    unknown = sorted(set(solution.fields) - set(VARIABLES))
    if unknown:
        raise ValueError(f"case '{case.name}': no such variables: {', '.join(unknown)}")
    variables: dict[str, xr.Variable] = {}
    for name, entry in VARIABLES.items():  # in the order of the table, whatever order they came in
        if name not in solution:
            continue
        dims, values = solution.fields[name]
        if values.ndim != len(dims) or dims not in (
            entry.dims,
            *((along, *entry.dims) for along in _ALONG),
        ):
            raise ValueError(
                f"case '{case.name}': variable '{name}' has dimensions {dims} and shape {values.shape}"
            )
        if not np.isfinite(values).all():
            raise ValueError(f"case '{case.name}': variable '{name}' is not finite")
        about = {
            "units": entry.units,
            "long_name": entry.long_name,
            "symbol": entry.symbol,
            "equation": entry.equation,
        }
        variables[name] = xr.Variable(dims, np.asarray(values, dtype=np.float64), about)
    used = {str(dim) for variable in variables.values() for dim in variable.dims}
    for dim, meaning in LABELS.items():
        if dim in used:
            variables[dim] = xr.Variable((dim,), list(solution.labels[dim]), {"long_name": meaning})
    dataset = xr.Dataset(variables).set_coords([name for name in COORDINATES if name in variables])
    dataset.attrs = {
        "Conventions": "CF-1.11",
        "title": case.title,
        "institution": "the cosserat project",
        "references": reference(),
        "comment": case.source or "a case of the user",
        "source": source(),
        "history": f"cosserat run {case.name}",
        "case": case.name,
        "parameters": _sorted_json(json.loads(case.model_dump_json())),
        "solver": _sorted_json(dict(solution.statistics)),
        "environment": _sorted_json(environment()),
    }
    if solution.warnings:
        dataset.attrs["warnings"] = "\n".join(solution.warnings)
    if derived:
        dataset.attrs["derived"] = " ".join(name for name in VARIABLES if name in derived)
    return dataset


def _completed(solution: Solution) -> tuple[Solution, set[str]]:
    """A solution with the fields that follow from its own, and their names."""
    if solution.derive is None:
        return solution, set()
    more = solution.derive()
    fields, labels = {**more.fields, **solution.fields}, {**more.labels, **solution.labels}
    names = set(more.fields) - set(solution.fields)
    return replace(solution, fields=fields, labels=labels), names


def without_derived(dataset: xr.Dataset) -> xr.Dataset:
    """What a Dataset stores of its states, without what follows from them."""
    names = str(dataset.attrs.get("derived", "")).split()
    left = dataset.drop_vars(names)
    used = {dim for variable in left.data_vars.values() for dim in variable.dims}
    left = left.drop_vars([name for name, place in left.coords.items() if not set(place.dims) <= used])
    left.attrs.pop("derived", None)
    return left


def warnings_of(dataset: xr.Dataset) -> list[str]:
    """Sentences about the use of the numbers; empty if all is well."""
    return str(dataset.attrs.get("warnings", "")).splitlines()


def case_of(dataset: xr.Dataset) -> Case:
    """The case that a Dataset was computed from.

    Raises
    ------
    InputError : the Dataset carries no parameters of this version.
    """
    if "parameters" not in dataset.attrs:
        raise InputError(
            f"{name_of(dataset)} has no attribute 'parameters'; use one that cosserat wrote"
        )
    try:
        return parse(dataset.attrs["parameters"])
    except InputError as error:
        raise InputError(f"{name_of(dataset)}: {error}") from None


def name_of(dataset: xr.Dataset) -> str:
    """Name of a Dataset in a sentence: the file that it was read from, if any."""
    return str(dataset.encoding.get("source", "this Dataset"))


def problem_of(dataset: xr.Dataset, asked: type[P]) -> P:
    """The problem that a Dataset was computed from, if it is one of these.

    Raises
    ------
    InputError : it is of another kind.
    """
    return case_of(dataset).problem_as(asked)


def statistics_of(dataset: xr.Dataset) -> dict[str, int | float]:
    """The solver's statistics that a Dataset carries.

    Raises
    ------
    InputError : it carries none.
    """
    try:
        return dict(json.loads(dataset.attrs["solver"]))
    except (KeyError, ValueError, TypeError):
        raise InputError(
            f"{name_of(dataset)} has no readable attribute 'solver'; use one that cosserat wrote"
        ) from None


def effort(dataset: xr.Dataset) -> str:
    """The effort of the solution in a few words, by the problem's kind."""
    sizes = {str(dim): size for dim, size in dataset.sizes.items()}
    return case_of(dataset).problem.summary(statistics_of(dataset), sizes)


def save(dataset: xr.Dataset, path: str | Path) -> None:
    """Write a netCDF file under a temporary name and rename it, so that no half-written file is ever seen.

    The same Dataset gives the same bytes.  Instants are along the dimension `frame` of the file, with `time` as their
    coordinate in plain seconds.

    Raises
    ------
    InputError : the destination cannot be written.
    """
    path = path_of(path)
    check_destination(path, ".nc")
    encoding = {
        str(name): {"_FillValue": None}
        for name, variable in dataset.variables.items()
        if variable.dtype.kind == "f"
    }
    with whole_or_absent(path) as temporary, uninterrupted():
        written = dataset.rename_dims(time=_FRAME) if "time" in dataset.dims else dataset
        written.to_netcdf(temporary, engine="netcdf4", format="NETCDF4", encoding=encoding)


def load(path: str | Path) -> xr.Dataset:
    """Read a netCDF file whole into memory.

    Raises
    ------
    InputError : the file is missing or cannot be read as netCDF.
    """
    path = path_of(path)
    if path.is_dir():
        raise InputError(f"{path} is a folder; give the name of a netCDF file")
    if not path.is_file():
        raise InputError(
            f"there is no file {path}; run the case first ('cosserat run CASE --output {path}')"
        )
    try:
        with uninterrupted(), xr.open_dataset(path, engine="netcdf4") as dataset:
            read = dataset.load()
            return read.swap_dims({_FRAME: "time"}) if _FRAME in read.dims and "time" in read else read
    except (OSError, ValueError, RuntimeError) as error:
        raise InputError(
            f"cannot read {path} as netCDF ({error}); delete it and run its case again"
        ) from None


def opened(result: xr.Dataset | str | Path) -> xr.Dataset:
    """A result, given by itself or by the name of its file.

    Raises
    ------
    InputError : the file is missing or cannot be read as netCDF.
    """
    return result if isinstance(result, xr.Dataset) else load(result)


def _sorted_json(value: object) -> str:
    return json.dumps(value, sort_keys=True)


def by_name(values: xr.DataArray) -> Iterator[tuple[str, xr.DataArray]]:
    """A variable; of named points and supports, the part of each and its component, with a blank and their names."""
    named = [dim for dim in ("probe", "support") if dim in values.dims]
    dims = named + [dim for dim in ("axis",) if named and dim in values.dims]
    for at in itertools.product(*(range(values.sizes[dim]) for dim in dims)):
        names = ", ".join(str(values[dim].to_numpy()[k]) for dim, k in zip(dims, at, strict=True))
        yield f" {names}".rstrip(), values.isel(dict(zip(dims, at, strict=True)))
