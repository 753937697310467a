"""The members of a task solved: what is kept of each, its status, and the reason where there is no answer."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from cosserat.data.variables import VARIABLES
from cosserat.errors import (
    CosseratError,
    CrossingError,
    DivergedError,
    InputError,
    NotConvergedError,
    OutOfReachError,
    UnstableError,
)
from cosserat.problem import Problem, silent
from cosserat.solution import Field, Solution
from cosserat.studies.family import Task
from cosserat.studies.keys import put, table_of
from cosserat.text import printable

Array = NDArray[np.float64]
SOLVED, WARNED, NOT_CONVERGED, NO_STATE, REFUSED, FAULT, NOT_YET = range(7)
STATUS = (
    "solved",
    "solved_with_warning",
    "not_converged",
    "no_such_state",
    "refused_input",
    "fault",
    "not_yet",
)
"""Meanings of the variable "status", in the order of its values; from the third on there is no answer."""
_NO_STATE = (CrossingError, DivergedError, OutOfReachError, UnstableError)
_LONGEST_REASON = 400


@dataclass
class Solved:
    """The answers of M members.

    values : of each read-out, (M,), not a number where there is none.  whole : of each whole variable, (M, ...), with
    its dimensions and, by dimension, its labels and places.  status : (M,).  reason : (M,) texts.
    iterations : (M,) of the solver, -1 where it counts none.
    """

    values: dict[str, Array]
    whole: dict[str, Field]
    beside: dict[str, Field]
    labels: dict[str, tuple[str, ...]]
    status: NDArray[np.int8]
    reason: NDArray[np.object_]
    iterations: NDArray[np.int32]

    @classmethod
    def nothing(cls, task: Task, members: int) -> Solved:
        """No member solved yet."""
        return cls(
            {one.name: np.full(members, np.nan) for one in task.keep},
            {},
            {},
            {},
            np.full(members, NOT_YET, dtype=np.int8),
            np.full(members, "", dtype=object),
            np.full(members, -1, dtype=np.int32),
        )


def solve_members(task: Task, progress: Callable[[float, str], None] = silent) -> Solved:
    """Solve every member of a task, each from its own reference: the answer depends neither on others nor on order.

    A member without an answer keeps its status and the reason.
    """
    found = Solved.nothing(task, task.size)
    with warnings.catch_warnings(), threadpool_limits(1):
        warnings.simplefilter("ignore")
        left = _solve_together(task, found, progress)
        table = table_of(task.base.problem)
        for number, member in enumerate(left):
            _solve_one(task, table, int(member), found)
            done = task.size - len(left) + number + 1
            progress(done / task.size, f"{done} of {task.size} members")
    return found


def _solve_together(
    task: Task, found: Solved, progress: Callable[[float, str], None]
) -> NDArray[np.int64]:
    """Solve what compiled loops can solve; returns the members that are left."""
    return np.arange(task.size)


def _solve_one(task: Task, table: Mapping[str, object], member: int, found: Solved) -> None:
    """Solve one member and keep its answer."""
    try:
        for path, value in task.values(member).items():
            table = put(table, path.split("."), value)
        problem: Problem = type(task.base.problem).read(table, "the member", units_required=False)
    except InputError as error:
        _fail(found, member, REFUSED, error)
        return
    try:
        solution = problem.solve("the member")
        _keep(task, _needed(task, solution), member, found)
    except NotConvergedError as error:
        found.iterations[member] = error.iterations
        _fail(found, member, NOT_CONVERGED, error)
        return
    except _NO_STATE as error:
        _fail(found, member, NO_STATE, error)
        return
    except CosseratError as error:
        _fail(found, member, REFUSED if isinstance(error, InputError) else NO_STATE, error)
        return
    except (ArithmeticError, ValueError, np.linalg.LinAlgError, MemoryError) as error:
        _fail(found, member, FAULT, error)
        return
    found.iterations[member] = int(solution.statistics.get("iterations", -1))
    found.status[member] = WARNED if solution.warnings else SOLVED
    found.reason[member] = "; ".join(solution.warnings)


def _needed(task: Task, solution: Solution) -> Solution:
    """A solution with the fields that are kept, also those that follow from others."""
    names = {name for one in task.keep for name in one.needs()} | set(task.keep_whole)
    if names <= set(solution.fields) or solution.derive is None:
        return solution
    more = solution.derive()
    return Solution({**more.fields, **solution.fields}, {}, {**more.labels, **solution.labels})


def _keep(task: Task, solution: Solution, member: int, found: Solved) -> None:
    values = {one.name: one.of(solution.fields, solution.labels) for one in task.keep}
    for name, value in values.items():
        if not np.isfinite(value):
            raise ValueError(f"'{name}' is not finite")
    for name in task.keep_whole:
        if name not in solution.fields:
            raise InputError(f"the result has no variable '{name}'")
        dims, own = solution.fields[name]
        keep_whole(found, name, dims, own, member, solution.labels)
        for along in dims:
            _beside(found, along, solution.fields)
    for name, value in values.items():
        found.values[name][member] = value


def keep_whole(
    found: Solved,
    name: str,
    dims: tuple[str, ...],
    own: Array,
    member: int,
    labels: Mapping[str, Sequence[str]],
) -> None:
    """Keep a whole variable of one member.

    Raises
    ------
    InputError : it has another size than that of the members before.
    """
    if name not in found.whole:
        found.whole[name] = (("member", *dims), np.full((found.status.size, *own.shape), np.nan))
        found.labels |= {dim: tuple(labels[dim]) for dim in dims if dim in labels}
    stored = found.whole[name][1]
    if stored.shape[1:] != own.shape:
        raise InputError(
            f"'{name}' has the shape {own.shape}, and {stored.shape[1:]} in other members; keep read-outs of it in "
            "place of 'keep_whole'"
        )
    stored[member] = own


def _beside(found: Solved, dim: str, fields: Mapping[str, Field]) -> None:
    """Keep the coordinate along a dimension of whole variables."""
    for name in ("xi", "xi_edge", "xi_section", "time"):
        if (
            name in fields
            and name not in found.beside
            and fields[name][0] == (dim,) == VARIABLES[name].dims
        ):
            found.beside[name] = fields[name]


def _fail(found: Solved, member: int, status: int, error: Exception) -> None:
    said = str(error) if isinstance(error, CosseratError) else f"{type(error).__name__}: {error}"
    found.status[member] = status
    found.reason[member] = printable(said.removeprefix("the member: "))[:_LONGEST_REASON]
