"""Single entry point: a case in, a Dataset out."""

from __future__ import annotations

import contextlib
from collections.abc import Set
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from cosserat.arguments import FUNCTION, taking
from cosserat.cases.catalogue import Case, case_given
from cosserat.data.checkpoints import Parts
from cosserat.data.content import stamped
from cosserat.data.dataset import statistics_of, to_dataset, warnings_of
from cosserat.data.files import check_destination
from cosserat.data.locks import only_writer
from cosserat.data.variables import VARIABLES
from cosserat.errors import (
    NO_MEMORY,
    CrossingError,
    NotConvergedError,
    OverLimitError,
    path_of,
)
from cosserat.limits import LIMITS, Limits, Watched
from cosserat.problem import Progress, Run
from cosserat.progress import bar
from cosserat.solution import Solution
from cosserat.solvers.heartbeat import listening
from cosserat.text import LONGEST_NAME, LONGEST_TITLE
from cosserat.threads import solving


@taking(progress=FUNCTION, limits=LIMITS)
def run(
    case: Case | str,
    *,
    result: str | Path | None = None,
    progress: Progress | None = None,
    limits: Limits | None = None,
) -> xr.Dataset:
    """Solve a case, given by itself or by the name of a published one.

    The Snakemake rule, notebooks and scripts all use this function.

    result : the future file of the Dataset; a long run keeps its parts beside it, and an interrupted one resumes
        from them to the same numbers.
    progress : called with the progress of a long run; by default a bar shows it in terminals and notebooks, and lines
        elsewhere.
    limits : most time and space that the run may take; by default 24 hours and 10 GB.

    Raises
    ------
    InputError : no case of that name, its rod is not supported, the result cannot be written, the stored parts are of
        another run, or another process is writing the same result.
    OverLimitError : it takes more time or space than the limits allow.
    NotConvergedError, DivergedError, OutOfReachError : no solution; a motion keeps its parts up to there, and for a
        growing load the error's `dataset` is the part reached.
    """
    known = case_given(case, "run")
    path = None if result is None else path_of(result)
    if path is not None:
        check_destination(path)
    allowed, name = limits or Limits(), f"case '{known.name}'"
    allowed.check(known.problem.forecast, name, path)
    kept = None if path is None else _Stored(known, Parts(path))
    if kept is not None:
        kept.parts.check()
    shown = bar(known.name) if progress is None else contextlib.nullcontext(progress)
    with (
        contextlib.nullcontext() if path is None else only_writer(path),
        solving() as warned,
    ):
        try:
            with shown as report:
                watched = Watched(report, allowed, name)
                with listening(watched.hear):
                    solution = known.problem.solve(name, Run(watched, kept))
        except MemoryError as error:
            raise OverLimitError(f"{name}: {NO_MEMORY}") from error
        except (NotConvergedError, CrossingError) as error:
            if error.reached is not None:
                error.dataset = to_dataset(known, error.reached)
            raise
        dataset = to_dataset(known, solution)
    return _with_warnings(dataset, warned)


def _with_warnings(dataset: xr.Dataset, warned: Set[str]) -> xr.Dataset:
    """A Dataset with a sentence about the numerical warnings of its solution."""
    if not warned:
        return dataset
    sentence = f"numerics: {', '.join(sorted(warned))} in the solution; check the sizes of the values of the case"
    return stamped(dataset.assign_attrs(warnings="\n".join([*warnings_of(dataset), sentence])))


def modes(case: Case | str, count: int = 6) -> xr.Dataset:
    """The lowest natural modes of the rod of a case, given by itself or by the name of a published one.

    They are those about its equilibrium under all loads, or of a motion about the reference.  The Dataset is that of a
    case of kind "modes", called like this one with "_modes" behind.

    Raises
    ------
    InputError : the case is of no rod, or `count` is not a number of modes.
    NotConvergedError : the loads lead to no equilibrium.
    """
    from cosserat.problems.modes import RodModes
    from cosserat.rods.problem import RodProblem

    known = case_given(case, "modes")
    problem = RodModes.of(known.problem_as(RodProblem), count)
    name = f"{known.name[: LONGEST_NAME - 6]}_modes"
    title = f"{known.title[: LONGEST_TITLE - 20]}: natural modes"
    return run(Case(name=name, title=title, source=known.source, problem=problem))


@dataclass(frozen=True)
class _Stored:
    """Parts of a run on disk, as `cosserat.problem.Checkpoints`."""

    case: Case
    parts: Parts

    def load(self, number: int) -> Solution | None:
        stored = self.parts.load(number)
        if stored is None:
            return None
        self.parts.check_same_run(stored, to_dataset(self.case, Solution({}, {})))
        fields = {
            str(name): (tuple(map(str, variable.dims)), variable.to_numpy())
            for name, variable in stored.variables.items()
            if name in VARIABLES
        }
        labels = {
            str(name): tuple(map(str, variable.to_numpy()))
            for name, variable in stored.variables.items()
            if name not in VARIABLES
        }
        return Solution(fields, statistics_of(stored), labels)

    def save(self, number: int, part: Solution, *, whole: bool) -> None:
        self.parts.save(number, to_dataset(self.case, part), whole=whole)
