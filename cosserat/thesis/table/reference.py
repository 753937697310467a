"""Stored results of every case and study: their comparison with fresh ones, and their replacement."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from cosserat.data.content import stamped
from cosserat.data.dataset import case_of, without_derived
from cosserat.data.netcdf import load, save
from cosserat.data.variables import VARIABLES
from cosserat.errors import InputError
from cosserat.studies.door import study_of
from cosserat.studies.readouts import read_out

RELATIVE = 1e-9
"""Change allowed in a variable, relative to its largest stored value; the variable's round-off floor is added."""

_IGNORED_ATTRIBUTES = (
    "source",
    "environment",
    "solver",
    "history",
    "content",
)  # machine and number of steps


@dataclass(frozen=True)
class Change:
    """The largest change of one variable, its place, and the allowed change, in the variable's unit."""

    variable: str
    units: str
    largest: float
    where: dict[str, int]
    allowed: float

    @property
    def held(self) -> bool:
        """Whether the change is small enough."""
        return self.largest <= self.allowed

    def __str__(self) -> str:
        place = ", ".join(f"{dim} {index}" for dim, index in self.where.items()) or "its one value"
        return (
            f"{self.variable}: {self.largest:.3g} {self.units} at {place} (allowed {self.allowed:.3g})"
        )


def thin(dataset: xr.Dataset) -> xr.Dataset:
    """The stored part of a result: about as many values along each dimension as its kind of problem sets.

    What follows from the stored states is left out: its tests compare it with right values.  Of a study it is all.
    """
    if "study" in dataset.attrs:
        return stamped(dataset)
    dataset = without_derived(dataset)
    for dim, count in case_of(dataset).problem.thinned.items():
        if dim in dataset.sizes and not count:
            dataset = dataset.drop_dims(dim)
        elif dim in dataset.sizes:
            every = max(1, (dataset.sizes[dim] - 1) // count)
            dataset = dataset.isel({dim: slice(None, None, every)})
    return stamped(dataset)


def compare(fresh: xr.Dataset, stored: xr.Dataset) -> list[Change]:
    """Changes of every variable of a fresh result after `thin`.

    Raises
    ------
    InputError : different variables, shapes, units or parameters, or a value that is not finite.
    """
    if "study" in stored.attrs:
        return _compare_answers(fresh, stored)
    fresh, stored = thin(fresh), without_derived(stored)
    if set(fresh.variables) != set(stored.variables):
        raise InputError(
            f"variables differ: {sorted(map(str, set(fresh.variables) ^ set(stored.variables)))}"
        )
    for key in sorted((set(fresh.attrs) | set(stored.attrs)) - set(_IGNORED_ATTRIBUTES)):
        if key == "parameters" and case_of(fresh) == case_of(stored):
            continue  # also equal if a new parameter has its default
        if fresh.attrs.get(key) != stored.attrs.get(key):
            raise InputError(
                f"attribute '{key}' differs: {fresh.attrs.get(key)!r}, stored {stored.attrs.get(key)!r}"
            )
    return [_change(str(name), fresh, stored) for name in stored.variables if name in VARIABLES]


def _compare_answers(fresh: xr.Dataset, stored: xr.Dataset) -> list[Change]:
    """Changes of every variable of a study.

    Raises
    ------
    InputError : it is another study, or other members have an answer.
    """
    if study_of(fresh) != study_of(stored):
        raise InputError("the study differs from the stored one; run 'cosserat accept'")
    if not (fresh["status"].to_numpy() == stored["status"].to_numpy()).all():
        raise InputError("other members have an answer than in the stored study")
    return [_change(name, fresh, stored, variable) for name, variable in variables_read(stored).items()]


def variables_read(answer: xr.Dataset) -> dict[str, str]:
    """The variable of a result that each read-out or whole variable of a study reads, by the name in the answer."""
    texts = {str(name): one.attrs.get("read_out", "") for name, one in answer.data_vars.items()}
    return {
        name: read_out(name, text, "the study").variable if text else name
        for name, text in texts.items()
        if text or name in VARIABLES
    }


def _change(name: str, fresh: xr.Dataset, stored: xr.Dataset, variable: str = "") -> Change:
    new, old = fresh[name], stored[name]
    if new.dims != old.dims or new.shape != old.shape:
        raise InputError(f"variable '{name}' has shape {new.shape}, stored {old.shape}")
    if new.attrs != old.attrs:
        raise InputError(f"variable '{name}' has attributes {new.attrs}, stored {old.attrs}")
    if not (np.isfinite(new) == np.isfinite(old)).all():
        raise InputError(
            f"variable '{name}' holds values that are not finite, at other places than stored"
        )
    difference = np.where(np.isfinite(old), np.abs(new.to_numpy() - old.to_numpy()), 0.0)
    place = np.unravel_index(int(difference.argmax()), difference.shape)
    return Change(
        variable=name,
        units=old.attrs["units"],
        largest=float(difference.max()),
        where={str(dim): int(index) for dim, index in zip(old.dims, place, strict=True)},
        allowed=RELATIVE * float(np.abs(old).max()) + VARIABLES[variable or name].floor,
    )


def accept(fresh: xr.Dataset, path: Path, because: str) -> list[str]:
    """Store a Dataset as the reference of its case or study, with the reason; returns the changes, largest first.

    Raises
    ------
    InputError : no reason given, or the file cannot be written.
    """
    if len(because.split()) < 3:
        raise InputError(
            f"the reason {because!r} says too little; say in a sentence why the numbers may change"
        )
    report = ["no reference was stored before"]
    history = f"{fresh.attrs['history']}\n{because}"
    if path.exists():
        stored = load(path)
        history = f"{stored.attrs.get('history', fresh.attrs['history'])}\n{because}"
        try:
            changes = compare(fresh, stored)
            report = [
                str(change)
                for change in sorted(changes, key=lambda c: c.largest / c.allowed, reverse=True)
            ]
        except InputError as error:
            report = [f"not comparable with the stored reference: {error}"]
    save(thin(fresh).assign_attrs(history=history), path)
    return report
