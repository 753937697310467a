"""The members of a task solved: what is kept of each, its status, and the reason where there is no answer."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextvars import copy_context
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

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
from cosserat.problem import Problem, Run, silent
from cosserat.problems.columns import unit
from cosserat.problems.tangents import total_mass
from cosserat.solution import Field, FieldRates, Many, Solution
from cosserat.studies.family import Task, derivative_name
from cosserat.studies.keys import put, table_of
from cosserat.text import printable
from cosserat.threads import solving

if TYPE_CHECKING:
    from cosserat.rods.problem import RodProblem

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
PLACES = ("xi", "xi_edge", "xi_section", "time")
"""Variables that say where or when the values of others are."""
_MOVES_NO_PLACE = (
    *(
        "forces.",
        "couples.",
        "line_loads.",
        "line_couples.",
        "follower_",
        "pressures.",
        "gravity.",
        "loads.",
    ),
    *("rod.material.", "rod.section.", "crawler.material.", "crawler.radius", "imperfection."),
)
"""Beginnings of keys with which places and instants stay the same."""
_CHUNK = 4096  # members that a thread solves at once


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
            {name: np.full(members, np.nan) for name in task.names},
            {},
            {},
            {},
            np.full(members, NOT_YET, dtype=np.int8),
            np.full(members, "", dtype=object),
            np.full(members, -1, dtype=np.int32),
        )

    def keep(self, name: str, dims: tuple[str, ...], members: NDArray[np.int64], values: Array) -> None:
        """Keep a whole variable of some members, (k, ...); where sizes differ, ends are filled with no number."""
        size = values.shape[1:]
        stored = (
            self.whole[name][1]
            if name in self.whole
            else np.empty((self.status.size, *(0 for _ in size)))
        )
        largest = tuple(map(max, stored.shape[1:], size))
        if largest != stored.shape[1:]:
            larger = np.full((self.status.size, *largest), np.nan)
            larger[tuple(map(slice, stored.shape))] = stored
            stored = larger
        place: tuple[Any, ...] = (members, *map(slice, size))
        stored[place] = values
        self.whole[name] = (("member", *dims), stored)


def solve_members(
    task: Task, progress: Callable[[float, str], None] = silent, threads: int = 1
) -> Solved:
    """Solve every member of a task, each from its own reference: the answer depends neither on others nor on order.

    A member without an answer keeps its status and the reason.  threads : for members that compiled loops can solve.
    """
    found = Solved.nothing(task, task.size)
    with solving():
        left = _solve_together(task, found, progress, threads)
        table = table_of(task.base.problem, task.keys)
        lost = 0
        for number, member in enumerate(left):
            _solve_one(task, table, int(member), found)
            lost += found.status[member] not in (SOLVED, WARNED)
            done = task.size - len(left) + number + 1
            without = f", {lost} without an answer" if lost else ""
            progress(done / task.size, f"{done} of {task.size} members{without}")
    return found


def _solve_together(
    task: Task, found: Solved, progress: Callable[[float, str], None], threads: int
) -> NDArray[np.int64]:
    """Solve what compiled loops can solve, by threads; returns the members that are left."""
    every, problem = np.arange(task.size), task.base.problem
    names = sorted(_read_of(task))
    along = {dim for name in task.keep_whole for dim in VARIABLES[name].dims}
    names += [name for name in PLACES if set(VARIABLES[name].dims) <= along and name not in names]
    if not all(column.dtype.kind == "f" for column in task.columns):
        return every
    parts = [every[begin : begin + _CHUNK] for begin in range(0, task.size, _CHUNK)]
    left = []
    with ThreadPoolExecutor(threads) as pool:
        solve = partial(_solve_part, task, problem, names)
        begun = [pool.submit(copy_context().run, solve, part) for part in parts]
        for part, future in zip(parts, begun, strict=True):
            many = future.result()
            if many is None:
                pool.shutdown(cancel_futures=True)
                return every
            left.append(_keep_many(task, many, part, found))
            progress((part[-1] + 1) / task.size, f"{part[-1] + 1} of {task.size} members")
    return np.concatenate(left)


def _read_of(task: Task) -> set[str]:
    """The names of the fields that are read of each member."""
    return {name for one in task.keep for name in one.needs()} | set(task.keep_whole)


def _solve_part(
    task: Task, problem: Problem, names: Sequence[str], part: NDArray[np.int64]
) -> Many | None:
    columns = {key: column[part] for key, column in zip(task.keys, task.columns, strict=True)}
    return problem.solve_many(columns, names, task.by)


def _keep_many(task: Task, many: Many, part: NDArray[np.int64], found: Solved) -> NDArray[np.int64]:
    """Keep the answers of the members of a part that are solved; returns the others.

    A member without a finite read-out is left too: its own problem says why.
    """
    values = {one.name: one.of(many.fields, many.labels, part.size) for one in task.keep}
    kept = many.solved & np.logical_and.reduce(
        [np.isfinite(own) for own in values.values()] or [many.solved]
    )
    rows = np.flatnonzero(kept)
    to = part[rows]
    for name, own in values.items():
        found.values[name][to] = own[rows]
    for name in task.keep_whole:
        dims, whole = many.fields[name]
        found.keep(name, dims[1:], to, whole[rows])
        found.labels |= {dim: tuple(many.labels[dim]) for dim in dims if dim in many.labels}
        _keep_places(task, found, dims[1:], {own: (d[1:], v[0]) for own, (d, v) in many.fields.items()})
    found.iterations[to] = many.statistics["iterations"][rows]
    found.status[to] = SOLVED
    lost = _keep_rates(task, many.rates, rows, to, found) if many.rates is not None else {}
    for member in (set(many.warnings) | set(lost)) & set(rows.tolist()):
        said = [*many.warnings.get(member, ()), *lost.get(member, ())]
        found.status[part[member]], found.reason[part[member]] = (
            WARNED,
            "; ".join(said)[:_LONGEST_REASON],
        )
    others: NDArray[np.int64] = part[~kept]
    return others


def _keep_rates(
    task: Task, rates: FieldRates, rows: NDArray[np.int64], to: NDArray[np.int64], found: Solved
) -> dict[int, list[str]]:
    """Keep the derivatives of the read-outs of the members in some rows of a part; returns why some do not exist.

    to : numbers of these members.
    """
    from cosserat.studies.derivatives import lacking, rated  # workers start without them

    every = {one.name: rated(one, rates) for one in task.keep}
    lost: dict[int, list[str]] = {}
    for k, path in enumerate(task.by):
        steps = unit(task.columns[task.keys.index(path)][to])
        for name, own in every.items():
            why = {row: said for (row, number), said in own.why.items() if number == k}
            values = own.value[:, k].copy()
            values[list(why)] = np.nan
            found.values[derivative_name(name, path)][to] = values[rows] / steps
            for row, said in why.items():
                lost.setdefault(row, []).append(lacking(name, path, said))
    return lost


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
        solution = problem.solve("the member", Run(wanted=_read_of(task)))
        _keep(task, _needed(task, problem, solution), member, found)
        lost = _differentiate(task, problem, member, found)
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
    said = [*solution.warnings, *lost]
    found.status[member] = WARNED if said else SOLVED
    found.reason[member] = "; ".join(said)[:_LONGEST_REASON]


def _differentiate(task: Task, problem: Problem, member: int, found: Solved) -> list[str]:
    """Keep the derivatives of the read-outs of one member; returns why some do not exist."""
    if not task.by:
        return []
    from cosserat.studies.derivatives import derivatives, parameter  # workers start without them

    own = [parameter(problem, path, "the member") for path in task.by]
    exact = derivatives(problem, own, task.keep, "the member")
    for (name, path), derivative in exact.by.items():
        found.values[derivative_name(name, path)][member] = derivative.value
    return [sentence.removeprefix("the member: ") for sentence in exact.missing.values()]


def _needed(task: Task, problem: Problem, solution: Solution) -> Solution:
    """A solution with the fields that are kept, also those that follow from others."""
    names = _read_of(task)
    if names <= set(solution.fields):
        return solution
    fields, labels = dict(solution.fields), dict(solution.labels)
    if solution.derive is not None:
        more = solution.derive(names - set(fields))
        fields, labels = {**more.fields, **fields}, {**more.labels, **labels}
    if "total_mass" in names - set(fields) and hasattr(problem, "rod"):
        own, words = total_mass(rod_problem := cast("RodProblem", problem), rod_problem.geometry)
        fields, labels = fields | own, labels | words
    return Solution(fields, {}, labels)


def _keep(task: Task, solution: Solution, member: int, found: Solved) -> None:
    values = {one.name: one.of(solution.fields, solution.labels) for one in task.keep}
    for name, value in values.items():
        if not np.isfinite(value):
            raise ValueError(f"'{name}' is not finite")
    for name in task.keep_whole:
        if name not in solution.fields:
            raise InputError(f"the result has no variable '{name}'")
        dims, own = solution.fields[name]
        found.keep(name, dims, np.array([member]), own[None])
        found.labels |= {dim: tuple(solution.labels[dim]) for dim in dims if dim in solution.labels}
        _keep_places(task, found, dims, solution.fields)
    for name, value in values.items():
        found.values[name][member] = value


def _keep_places(task: Task, found: Solved, dims: tuple[str, ...], fields: Mapping[str, Field]) -> None:
    """Keep the places along the dimensions of whole variables, if they are those of every member."""
    if not all(key.startswith(_MOVES_NO_PLACE) for key in task.keys):
        return
    for name in PLACES:
        if (
            name in fields
            and fields[name][0] == VARIABLES[name].dims
            and set(fields[name][0]) <= set(dims)
        ):
            found.beside.setdefault(name, fields[name])


def _fail(found: Solved, member: int, status: int, error: Exception) -> None:
    said = str(error) if isinstance(error, CosseratError) else f"{type(error).__name__}: {error}"
    found.status[member] = status
    found.reason[member] = printable(said.removeprefix("the member: "))[:_LONGEST_REASON]
