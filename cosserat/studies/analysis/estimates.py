"""The error of a case by its mesh and its time step, estimated by solving it on coarser and finer ones."""

from __future__ import annotations

import re
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray as xr

from cosserat.arguments import FUNCTION, of_class, taking
from cosserat.cases.catalogue import Case, case_given
from cosserat.data.content import stamped
from cosserat.data.dataset import content_of, holding_what_is_needed, name_of
from cosserat.data.variables import VARIABLES
from cosserat.errors import CosseratError, InputError, OverLimitError
from cosserat.limits import LIMITS, Limits
from cosserat.problem import Progress, silent
from cosserat.progress import bar
from cosserat.runner import run
from cosserat.solution import Field
from cosserat.studies.analysis.refinements import Refinement, by_place, refinements
from cosserat.studies.analysis.sequences import (
    CONFIRMED,
    ROUND_OFF,
    SAID,
    STATES,
    Convergence,
    convergence,
)
from cosserat.studies.keys import case_with
from cosserat.studies.readouts import ReadOut, read_outs_by_name
from cosserat.text import printable, shortened, shown

USUAL = {
    "first_frequency": "natural_frequency at 0",
    "second_frequency": "natural_frequency at 1",
    "critical_load": "linear_load_factor at 0",
    "special_load": "min special_load_factor",
    "displacement": "max |u|",
    "bending_moment": "max |bending_moment|",
    "normal_force": "max |normal_force|",
    "last_strain_energy": "final strain_energy",
    "farthest": "max along",
    "pressure": "max p_coelom",
    "thinnest": "min mu_1",
}
"""Read-outs whose errors are estimated where none are named: those that the result has."""
_GROWTH = (2.0, 8.0)  # of the time from one mesh to the next finer one
_RK45 = "steps of 'rk45' follow from its tolerance, which is not refined"


@dataclass
class _Budget:
    """Time that is left, and what the meshes took."""

    limits: Limits
    began: float = field(default_factory=time.monotonic)

    @property
    def left(self) -> float:
        """Seconds."""
        return 3600 * self.limits.hours - (time.monotonic() - self.began)

    def allowed(self) -> Limits:
        """The limits of one more solve."""
        return Limits(hours=max(self.left, 1e-9) / 3600, gigabytes=self.limits.gigabytes)


@dataclass
class _Meshes:
    """What one refinement has found: the values of the read-outs by the number of intervals, and what went wrong.

    floors : of each read-out, changes below which are round-off.
    """

    how: Refinement
    values: dict[int, dict[str, float]]
    floors: Mapping[str, float]
    seconds: dict[int, float] = field(default_factory=dict)
    said: list[str] = field(default_factory=list)

    def convergence(self, name: str) -> Convergence:
        """What the meshes tell of one read-out."""
        counts = np.array(sorted(self.values), dtype=np.float64)
        values = np.array([self.values[int(count)][name] for count in counts])
        return convergence(1 / counts, values, self.floors[name])

    def is_enough(self) -> bool:
        """Whether no other mesh is needed."""
        if len(self.values) < 3:
            return False
        first = next(iter(self.values.values()))
        return all(self.convergence(name).state in (CONFIRMED, ROUND_OFF) for name in first)

    def predicted(self, count: int) -> float:
        """Seconds that a mesh will take, from the finest that was timed."""
        if not self.seconds:
            return 0.0
        finest = max(self.seconds)
        growth = _GROWTH[0]
        if finest // 2 in self.seconds:
            growth = float(np.clip(self.seconds[finest] / self.seconds[finest // 2], *_GROWTH))
        return float(self.seconds[finest] * growth ** np.log2(count / finest))


@taking(
    limits=LIMITS,
    result=of_class(xr.Dataset, "the Dataset of cosserat.run, or leave it out"),
    progress=FUNCTION,
)
def estimate_error(
    case: Case | str,
    of: Mapping[str, str] | None = None,
    *,
    limits: Limits | None = None,
    result: xr.Dataset | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """The estimated error of read-outs of a case by its mesh and its time step.

    The case is solved on coarser and finer meshes: at least two others, and more where they are needed to confirm an
    order and the limits allow.  Of each read-out, such as "tip", the Dataset has "tip", the value of the case itself,
    and "tip_error", its estimated error, in its unit; and along `refinement`, whose names are the refined keys,
    "tip_errors", "tip_order", "tip_limit" and "tip_state" as of `cosserat.orders`.  Where the values do not behave like
    a power of the mesh, there is a state and no number (NaN).  The attribute `warnings` names what could not be solved.

    of : read-outs by name, such as {"tip": "u.E2 at last"}; by default some that the result has.
    limits : most time for all meshes together; by default 24 hours.  result : that of the case itself, if it was
        solved before.  progress : as of `cosserat.run`.

    Raises
    ------
    InputError : the case has no mesh or no such read-out, a read-out names a vertex by its number, or `result` is not
        that of one case, or only a part of it.
    CosseratError : the case itself has no solution, as of `cosserat.run`.
    """
    known = case_given(case, "estimate_error")
    ways, asked = what_to_estimate(known, of)
    budget = _Budget(limits or Limits())
    if result is not None:
        _check_result(result)
    own = run(known, limits=budget.allowed(), progress=progress) if result is None else result
    with holding_what_is_needed(own, "an estimate of its errors"):
        keep = asked or tuple(one for one in _usual(known) if _has(own, one))
        values = _values(own, keep)
    floors = {one.name: VARIABLES[one.variable].floor for one in keep}
    found = [_Meshes(how, {how.count: values}, floors) for how in ways]
    if progress is not None:
        _solve(known, found, keep, budget, progress)
    else:
        with bar(f"{known.name}: meshes") as report:
            _solve(known, found, keep, budget, report)
    return _dataset(known, keep, values, found)


def _check_result(result: xr.Dataset) -> None:
    """Raise InputError for what is not the result of one case, whole and of numbers."""
    if content := content_of(result):
        raise InputError(f"{name_of(result)} holds {content}; give as 'result' that of the case itself")
    for name in map(str, result.variables):
        if name not in VARIABLES:
            continue
        values, dims = result[name], VARIABLES[name].dims
        if values.dims[-len(dims) :] != dims if dims else len(values.dims) > 1:
            raise InputError(
                f"'{name}' of {name_of(result)} is along {shown(values.dims)}, not {shown(dims)}; give as 'result' the "
                "whole one, as cosserat made it"
            )
        if values.dtype.kind != "f" or not bool(np.isfinite(values).all()):
            raise InputError(
                f"'{name}' of {name_of(result)} is not finite everywhere; give as 'result' one that cosserat made"
            )


def _solve(
    case: Case, found: list[_Meshes], keep: tuple[ReadOut, ...], budget: _Budget, report: Progress
) -> None:
    table = by_place(case.problem)
    for number, meshes in enumerate(found):
        others = meshes.how.others()
        for done, count in enumerate(others):
            if meshes.is_enough():
                break
            report(
                (number + done / len(others)) / len(found),
                f"{meshes.how.paths[0]} = {meshes.how.said(count)}",
            )
            if meshes.predicted(count) > budget.left:
                meshes.said.append(
                    f"{meshes.how.said(count)} would take longer than the limit --hours leaves"
                )
                break
            _solve_mesh(case, table, meshes, count, keep, budget)


def _solve_mesh(
    case: Case,
    table: Mapping[str, Any],
    meshes: _Meshes,
    count: int,
    keep: tuple[ReadOut, ...],
    budget: _Budget,
) -> None:
    began = time.monotonic()
    try:
        other = case_with(case, table, meshes.how.values(count), case.name)
        solved = run(other, limits=budget.allowed(), progress=silent)
        meshes.values[count] = _values(solved, keep)
        meshes.seconds[count] = time.monotonic() - began
    except OverLimitError:
        meshes.said.append(f"{meshes.how.said(count)} would take longer than the limit --hours leaves")
    except CosseratError as error:
        meshes.said.append(f"{meshes.how.said(count)} has no answer ({printable(str(error))[:200]})")


def what_to_estimate(
    case: Case, of: Mapping[str, str] | None
) -> tuple[tuple[Refinement, ...], tuple[ReadOut, ...]]:
    """The ways to refine a case, and the read-outs that are named, if any.

    Raises
    ------
    InputError : the case has no mesh, or a read-out is none or names a vertex by its number.
    """
    ways, called = refinements(case.problem), f"the errors of '{shortened(case.name)}'"
    if not ways:
        raise InputError(
            f"the case '{case.name}' is of kind '{case.problem.kind}', which has no mesh to refine; take another case"
        )
    asked = read_outs_by_name({} if of is None else of, called)
    for one in asked:
        places = {"vertex", "edge"} & set(VARIABLES[one.variable].dims)
        if places and re.fullmatch(r"0*[1-9]\d*", one.at):
            raise InputError(
                f"{called}: {shown(one.text)} names a place by its number, which is another one on another mesh; "
                "write first, last or metres"
            )
    return ways, asked


def _usual(case: Case) -> tuple[ReadOut, ...]:
    return read_outs_by_name(USUAL, case.name)


def _has(own: xr.Dataset, one: ReadOut) -> bool:
    """Whether a result has a read-out."""
    try:
        _values(own, (one,))
    except InputError:
        return False
    return True


def _values(data: xr.Dataset, keep: tuple[ReadOut, ...]) -> dict[str, float]:
    fields: dict[str, Field] = {
        str(name): (tuple(map(str, values.dims)), values.to_numpy())
        for name, values in data.variables.items()
        if values.dtype.kind == "f"
    }
    labels = {
        str(name): tuple(map(str, values.to_numpy()))
        for name, values in data.coords.items()
        if values.dtype.kind in "UTO"
    }
    return {one.name: float(one.of(fields, labels)) for one in keep}


def _dataset(
    case: Case, keep: tuple[ReadOut, ...], values: Mapping[str, float], found: list[_Meshes]
) -> xr.Dataset:
    made = xr.Dataset(coords={"refinement": [meshes.how.paths[0] for meshes in found]})
    made["refinement"].attrs = {"long_name": "the refined key"}
    for one in keep:
        name, value, unit = one.name, values[one.name], one.units
        each = [meshes.convergence(name) for meshes in found]
        errors = np.array([_or_nan(c.error(value)) for c in each])
        along = ("refinement",)
        made[name] = ((), value, {"units": unit, "long_name": one.long_name, "read_out": one.text})
        made[f"{name}_error"] = (
            (),
            errors.sum(),
            {"units": unit, "long_name": f"estimated error of '{name}'"},
        )
        for what, numbers, about in (
            (
                "errors",
                errors,
                {"units": unit, "long_name": f"estimated error of '{name}' by the refined key"},
            ),
            (
                "order",
                np.array([_or_nan(c.order) for c in each]),
                {"units": "1", "long_name": "observed order"},
            ),
            ("limit", np.array([_or_nan(c.limit) for c in each]), {"units": unit, "long_name": "limit"}),
        ):
            made[f"{name}_{what}"] = (along, numbers, about)
        meaning = {
            "long_name": f"how '{name}' converges",
            "flag_values": np.arange(len(STATES), dtype=np.int8),
            "flag_meanings": " ".join(STATES),
        }
        made[f"{name}_state"] = (along, np.array([c.state for c in each], dtype=np.int8), meaning)
    said = [f"{m.how.paths[0]}: {sentence}" for m in found for sentence in m.said]
    if getattr(getattr(case.problem, "integrator", None), "method", "") == "rk45":
        said.append(f"integrator.step: {_RK45}")
    solved = [f"{m.how.paths[0]}: {', '.join(map(m.how.said, sorted(m.values)))}" for m in found]
    made.attrs = {"title": f"{case.title}: errors", "meshes": "\n".join(solved), "analysis": "errors"}
    if said:
        made.attrs["warnings"] = "\n".join(said)
    return stamped(made)


def _or_nan(value: float | None) -> float:
    return np.nan if value is None else value


def lines(made: xr.Dataset) -> list[str]:
    """An estimate as lines for people."""
    names = [str(name) for name, values in made.data_vars.items() if "read_out" in values.attrs]
    said = ["estimated errors, with", *(f"  {line}" for line in made.attrs["meshes"].splitlines())]
    for name in names:
        about = made[name].attrs
        total = float(made[f"{name}_error"])
        unit = "" if about["units"] == "1" else f" {about['units']}"
        error = (
            f"estimated error {total:.2g}{unit}" if np.isfinite(total) else "no estimate of its error"
        )
        said.append(f"{about['read_out']} = {float(made[name]):.9g}{unit}, {error}")
        for k, key in enumerate(made["refinement"].to_numpy()):
            own = {part: float(made[f"{name}_{part}"][k]) for part in ("errors", "order", "limit")}
            words = SAID[int(made[f"{name}_state"][k])]
            if np.isfinite(own["limit"]):
                words = f"error {own['errors']:.2g}, order {own['order']:.2f}, limit {own['limit']:.9g}; {words}"
            said.append(f"  {key}: {words}")
    return said
