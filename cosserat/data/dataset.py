"""Solutions as xarray Datasets with units, meaning and origin."""

from __future__ import annotations

import contextlib
import itertools
import json
from collections.abc import Iterator
from dataclasses import replace
from typing import TypeVar

import numpy as np
import xarray as xr

from cosserat.cases.catalogue import Case, parse
from cosserat.data.content import is_as_computed, stamp, stamped
from cosserat.data.provenance import environment, source
from cosserat.data.variables import COORDINATES, LABELS, VARIABLES
from cosserat.errors import CosseratError, InputError
from cosserat.publications import reference
from cosserat.solution import Solution
from cosserat.text import printable

P = TypeVar("P")
INTACT = "intact"
"""Key of a Dataset's encoding: whether it was read from a file whose digest holds."""
_OTHER_CONTENTS = {
    "bands": "quantiles of a study",
    "study": "the answer of a study",
    "fit": "the answer of a fit",
    "design": "the answer of a design",
    "method": "sensitivities",
    "analysis": "",
}  # in words, by an attribute; of the last one its value
_SHORT = 150  # characters of a foreign error in a sentence
FORMAT = 1
"""Number of the format of files, raised when an older version could misread a new one."""
_ALONG = ("time", "point", "special")
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
        **origin(case.title, case.source or "a case of the user"),
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
    return stamp(dataset)


def origin(title: str, comment: str) -> dict[str, str]:
    """The global attributes of everything that is stored: what it is, and the code that made it."""
    return {
        "Conventions": f"CF-1.11 cosserat-{FORMAT}",
        "title": title,
        "institution": "the cosserat project",
        "references": reference(),
        "comment": comment,
        "source": source(),
    }


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
    return stamped(left)


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
        return parse(str(dataset.attrs["parameters"]))
    except InputError as error:
        wrote, own = version_of(dataset), source().split(",")[0]
        other = f", written by {wrote} and read by {own}," if wrote != own else ""
        raise InputError(f"{name_of(dataset)}{other}: {error}") from None


def content_of(dataset: xr.Dataset) -> str:
    """What a Dataset holds in place of the result of one case, in words; empty if it is such a result."""
    for attribute, words in _OTHER_CONTENTS.items():
        if attribute in dataset.attrs:
            return words or printable(str(dataset.attrs[attribute]))[:_SHORT]
    return ""


def name_of(dataset: xr.Dataset) -> str:
    """Name of a Dataset in a sentence: the file that it was read from, if any."""
    return str(dataset.encoding.get("source", "this Dataset"))


@contextlib.contextmanager
def holding_what_is_needed(dataset: xr.Dataset, purpose: str) -> Iterator[None]:
    """Turn what goes wrong with a Dataset into one sentence, with the error itself as its cause.

    Raises
    ------
    InputError : it lacks something, or holds it in another form, as a user or another program may have changed it.
    CosseratError : it is as it was computed, so the fault is in cosserat.
    """
    try:
        yield
    except CosseratError:
        raise
    except Exception as error:
        what = printable(f"{type(error).__name__}: {error}")[:_SHORT]
        if dataset.encoding.get(INTACT) and is_as_computed(dataset):
            raise CosseratError(
                f"{purpose} failed for {name_of(dataset)} ({what}); this is a fault of cosserat: please report it"
            ) from error
        raise InputError(
            f"{name_of(dataset)} does not hold what {purpose} needs ({what}); use it as cosserat made it"
        ) from error


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


def version_of(dataset: xr.Dataset) -> str:
    """The version that wrote a Dataset, such as "cosserat 0.1.0"."""
    return printable(str(dataset.attrs.get("source", "another program")).split(",")[0])


def _sorted_json(value: object) -> str:
    return json.dumps(value, sort_keys=True)


def by_name(values: xr.DataArray) -> Iterator[tuple[str, xr.DataArray]]:
    """A variable; of named points and supports, the part of each and its component, with a blank and their names."""
    named = [dim for dim in ("probe", "support") if dim in values.dims]
    dims = named + [dim for dim in ("axis",) if named and dim in values.dims]
    for at in itertools.product(*(range(values.sizes[dim]) for dim in dims)):
        names = ", ".join(str(values[dim].to_numpy()[k]) for dim, k in zip(dims, at, strict=True))
        yield f" {names}".rstrip(), values.isel(dict(zip(dims, at, strict=True)))
