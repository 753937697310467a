"""Single entry point: a case in, a Dataset out."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from cosserat.cases.catalogue import Case, find
from cosserat.data.checkpoints import Parts
from cosserat.data.dataset import statistics_of, to_dataset
from cosserat.data.variables import VARIABLES
from cosserat.errors import CrossingError, InputError, NotConvergedError, path_of
from cosserat.problem import Progress, Run
from cosserat.progress import bar
from cosserat.solution import Solution


def run(
    case: Case | str, *, result: str | Path | None = None, progress: Progress | None = None
) -> xr.Dataset:
    """Solve a case, given by itself or by the name of a published one.

    The Snakemake rule, notebooks and scripts all use this function.

    result : the future file of the Dataset; a long run keeps its parts beside it, and an interrupted one resumes
        from them to the same numbers.
    progress : called with the progress of a long run; by default a bar shows it in terminals and notebooks.

    Raises
    ------
    InputError : no case of that name, its rod is not supported, or the stored parts are of another run.
    NotConvergedError, DivergedError, OutOfReachError : no solution; a motion keeps its parts up to there, and for a
        growing load the error's `dataset` is the part reached.
    """
    known = find(case) if isinstance(case, str) else case
    if not isinstance(known, Case):
        raise InputError(f"run takes a case or the name of a published one, not {case!r}")
    kept = None if result is None else _Stored(known, Parts(path_of(result)))
    shown = bar(known.name) if progress is None else contextlib.nullcontext(progress)
    try:
        with shown as report:
            solution = known.problem.solve(f"case '{known.name}'", Run(report, kept))
    except (NotConvergedError, CrossingError) as error:
        if error.reached is not None:
            error.dataset = to_dataset(known, error.reached)
        raise
    return to_dataset(known, solution)


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

    known = find(case) if isinstance(case, str) else case
    if not isinstance(known, Case):
        raise InputError(f"modes takes a case or the name of a published one, not {case!r}")
    problem = RodModes.of(known.problem_as(RodProblem), count)
    title = f"{known.title}: natural modes"
    return run(Case(name=f"{known.name}_modes", title=title, source=known.source, problem=problem))


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
