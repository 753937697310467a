"""The one door: a case in, a Dataset out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from cosserat.cases.catalogue import Case, find
from cosserat.data.dataset import to_dataset
from cosserat.data.parts import Parts
from cosserat.errors import CrossingError, InputError, NotConvergedError, path_of
from cosserat.models.peristalsis import Crawl
from cosserat.models.rod_course import Course, resumed
from cosserat.models.rod_motion import RodMotion
from cosserat.outcome import Outcome

Progress = Callable[[float, str], None]
"""Told the share done, from 0 to 1, and a few words."""


def run(
    case: Case | str, *, result: str | Path | None = None, progress: Progress | None = None
) -> xr.Dataset:
    """Solve a case, given itself or by the name of a published one.

    The Snakemake rule, a notebook and a script all come through here.

    result : where the Dataset will be saved; a long run keeps its parts beside it and goes on from them when it
        is run again, to the same numbers.
    progress : told how far a long run is.

    Raises
    ------
    InputError : no case of that name, its rod is not supported, or the stored parts are of another run.
    NotConvergedError, DivergedError, OutOfReachError : no solution; what a motion computed before stays in its parts,
        and what a growing load reached is the error's `dataset`.
    """
    known = find(case) if isinstance(case, str) else case
    if not isinstance(known, Case):
        raise InputError(f"run takes a case or the name of a published one, not {case!r}")
    name = f"case '{known.name}'"
    try:
        outcome = _outcome_of(known, name, None if result is None else path_of(result), progress)
    except (NotConvergedError, CrossingError) as error:
        if error.reached is not None:
            error.dataset = to_dataset(known, error.reached)
        raise
    return to_dataset(known, outcome)


def _outcome_of(known: Case, name: str, result: Path | None, progress: Progress | None) -> Outcome:
    if isinstance(known.problem, RodMotion):
        return _in_parts(known, known.problem, name, Parts(result) if result else None, progress)
    if isinstance(known.problem, Crawl):
        return known.problem.crawl(name, progress)
    return known.problem.solve(name)


def _in_parts(
    case: Case, problem: RodMotion, name: str, store: Parts | None, progress: Progress | None
) -> Outcome:
    course, state = Course.of(problem, name), problem.begin()
    done: list[Outcome] = []
    for number in range(course.parts):
        stored = store.load(number) if store else None
        if store and stored is not None:
            store.refuse_others(stored, to_dataset(case, Outcome({}, {})))
            outcome = _outcome(stored)
            state = resumed(dict(outcome.fields))
        else:
            outcome, state, stopped = course.part(number, state)
            if store and outcome.fields:
                store.save(number, to_dataset(case, outcome), whole=stopped is None)
            if stopped:
                raise stopped
        done.append(outcome)
        if progress:
            progress(
                (number + 1) / course.parts,
                f"{outcome.fields['time'][-1]:.4g} of {problem.duration:g} s",
            )
    whole = _joined(done, course.legs)
    return replace(whole, warnings=course.warnings(whole))


def _outcome(stored: xr.Dataset) -> Outcome:
    from cosserat.data.dataset import statistics_of
    from cosserat.data.variables import VARIABLES

    fields = {str(name): stored[name].to_numpy() for name in stored.variables if name in VARIABLES}
    return Outcome(fields, statistics_of(stored))


def _joined(parts: list[Outcome], legs: int) -> Outcome:
    """One outcome: what has a time is joined along it, every `legs`-th of which is a frame; statistics are summed."""
    from cosserat.data.variables import VARIABLES

    fields = {}
    for name, first in parts[0].fields.items():
        timed = first.ndim > len(VARIABLES[name].dims) or "time" in VARIABLES[name].dims
        fields[name] = np.concatenate([part.fields[name] for part in parts])[::legs] if timed else first
    statistics = {key: sum(part.statistics[key] for part in parts) for key in parts[0].statistics}
    return Outcome(fields, statistics)
