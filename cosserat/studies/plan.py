"""A study in batches: which members are solved already, which are left, and the answer from all of them."""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
import time
import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import CosseratWarning, InputError
from cosserat.problem import Progress, silent
from cosserat.solution import Field
from cosserat.studies.family import Family, Task
from cosserat.studies.solving import Solved, solve_members
from cosserat.studies.stored import (
    ASIDE,
    BATCHES,
    Digests,
    Plan,
    batch_name,
    members_named,
    planned_members,
    read_family,
    read_plan,
    read_solved,
    told_of,
    write_plan,
    write_task,
)

BATCH_SECONDS = 60.0
"""Time that a batch should take: the start of a process is then 2 % of it, and a kill loses no more."""
MOST = 1 << 16
"""Most members of a batch."""
MOST_BATCHES = 10_000
"""Most batches of a study: a graph of more jobs takes Snakemake minutes and gigabytes."""
_SMALL = 5.0  # seconds of work that are one batch
_TRIED, _TRYING = 4096, 0.1  # members and seconds for the estimate
_BATCHES = 8  # batches at least, of a study that takes long
_NAME = re.compile(r"[0-9a-f]{24}")
_TOLD = 5  # files that are named one by one where they are not believed


def folder_of(answer: Path) -> Path:
    """The folder of a study's parts, beside its answer."""
    return answer.with_name(f"{answer.name.removesuffix('.nc')}.study")


def plan(found: Family, folder: Path, size: int | None = None, progress: Progress = silent) -> Plan:
    """The batches of a study, stored in its folder; an earlier plan of the same study is taken as it is.

    Members that a stored batch has solved are not planned again.  A plan that is damaged, or whose batches are, is made
    again.

    size : members of a batch; by default as many as take `BATCH_SECONDS`.  progress : called while members are named.

    Raises
    ------
    InputError : the folder cannot be written, or there would be too many batches.
    """
    if size is not None and not 1 <= size <= MOST:
        raise InputError(f"--batch is {size}; a batch has 1 to {MOST} members")
    task = found.task()
    digests = task.digests(progress)
    about = task.about + json.dumps(told_of(found), sort_keys=True)
    asked = hashlib.blake2b(digests.tobytes() + about.encode(), digest_size=16).hexdigest()
    wanted, first = np.unique(digests, return_index=True)
    known = read_plan(folder)
    if known is not None and known.study == asked and _holds_all(folder, known, wanted):
        return known
    try:
        (folder / BATCHES).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            f"cannot make the folder {folder / BATCHES}: {error.strerror}; choose another with --output"
        ) from None
    old, missing = _stored_already(folder, wanted)
    members = np.sort(first[missing])
    seconds = estimate(task) if members.size else 0.0
    size = batch_size(members.size, seconds) if size is None else size
    if members.size / size > MOST_BATCHES:
        raise InputError(
            f"{members.size} members in batches of {size} are more than {MOST_BATCHES} jobs, too many for a scheduler; "
            "take a larger --batch"
        )
    names = [*old, *_new_batches(folder, task, digests, members, size, progress)]
    made = Plan(asked, tuple(names), seconds)
    write_plan(folder, made, found)
    return made


def _holds_all(folder: Path, known: Plan, wanted: Digests) -> bool:
    """Whether the files of the batches of a plan are there, with all wanted members."""
    held = [_members(folder, name) for name in known.batches]
    whole = [own for own in held if own is not None]
    return len(whole) == len(held) > 0 and bool(np.isin(wanted, np.concatenate(whole)).all())


def _members(folder: Path, name: str) -> Digests | None:
    """The digests of the members of a batch, to solve or solved; None if neither file says so."""
    try:
        return planned_members(_task_file(folder, name))
    except InputError:
        pass
    try:
        return read_solved(answer_file(folder, name))[0]
    except InputError:
        return None


def _stored_already(folder: Path, wanted: Digests) -> tuple[list[str], NDArray[np.bool_]]:
    """The solved batches that hold wanted members, and which members no batch holds."""
    missing, names = np.ones(wanted.size, dtype=np.bool_), []
    for path in sorted((folder / BATCHES).glob("*.nc")):
        own = _members(folder, path.stem) if _NAME.fullmatch(path.stem) else None
        at = np.zeros_like(missing) if own is None else np.isin(wanted, own) & missing
        if at.any() and not _doubt(path):
            names.append(path.stem)
            missing &= ~at
    return names, missing


def _new_batches(
    folder: Path,
    task: Task,
    digests: Digests,
    members: NDArray[np.int64],
    size: int,
    progress: Progress,
) -> Iterator[str]:
    for begin in range(0, members.size, size):
        progress(0.0, f"{begin} of {members.size} members in batches")
        picked = members[begin : begin + size]
        own = digests[picked]
        name = batch_name(own, task.about)
        file = _task_file(folder, name)
        try:
            planned_members(file)
        except InputError:
            write_task(file, task.part(picked), own)
        yield name


def batch_size(members: int, seconds: float) -> int:
    """How many members a batch has, a power of two."""
    if members * seconds <= _SMALL:
        return max(1, min(members, MOST))
    by_time = 1 << max(0, min(16, int(math.log2(BATCH_SECONDS / seconds))))
    by_count = 1 << max(0, math.ceil(math.log2(members / _BATCHES)))
    return min(by_time, by_count, MOST)


def estimate(task: Task) -> float:
    """Seconds that one member takes, from ever more of them: many together may take far less than one alone."""
    solve_members(task.part(slice(0, 1)))  # the first one loads what is compiled
    count, seconds = 1, np.inf
    while True:
        picked = np.unique(np.linspace(0, task.size - 1, min(task.size, count)).astype(np.int64))
        began = time.perf_counter()
        solve_members(task.part(picked))
        passed = time.perf_counter() - began
        seconds = min(seconds, passed / picked.size)
        if passed > _TRYING or picked.size >= min(task.size, _TRIED):
            return float(seconds)
        count *= 4


def _task_file(folder: Path, name: str) -> Path:
    return folder / BATCHES / f"{name}.npz"


def answer_file(folder: Path, name: str) -> Path:
    """The file with the answers of a batch."""
    return folder / BATCHES / f"{name}.nc"


def left(folder: Path, made: Plan) -> list[str]:
    """The batches that are not solved yet; a warning names files in their places that are not their answers."""
    missing, doubts = [], []
    for name in made.batches:
        path = answer_file(folder, name)
        doubt = _doubt(path) if os.path.lexists(path) else ""
        if doubt or not os.path.lexists(path):
            missing.append(name)
        doubts += [doubt] if doubt else []
    for doubt in doubts[:_TOLD]:
        warnings.warn(doubt, CosseratWarning, stacklevel=2)
    if len(doubts) > _TOLD:
        more = f"so it is with {len(doubts) - _TOLD} more files in {folder / BATCHES}"
        warnings.warn(more, CosseratWarning, stacklevel=2)
    return missing


def _doubt(path: Path) -> str:
    """Why a file is not the answer of its batch; "" if it is."""
    try:
        read_solved(path)
    except InputError as error:
        return str(error)
    return ""


def set_aside(folder: Path, names: Sequence[str]) -> None:
    """Rename files that stand in the places of answers that are to be solved; none is replaced.

    Raises
    ------
    InputError : the folder cannot be written.
    """
    for path in (answer_file(folder, name) for name in names):
        if not os.path.lexists(path):
            continue
        free, number = path.with_name(path.name + ASIDE), 1
        while os.path.lexists(free):
            number += 1
            free = path.with_name(f"{path.name}{ASIDE}{number}")
        try:
            path.rename(free)
        except OSError as error:
            raise InputError(
                f"cannot rename {path}: {error.strerror}; check the permissions of its folder, or delete it"
            ) from None


def members_in(folder: Path, name: str) -> int:
    """The number of members of a batch to solve.

    Raises
    ------
    InputError : its file is missing or damaged.
    """
    return len(members_named(_task_file(folder, name)))


def gathered(folder: Path, *, partial: bool = False) -> tuple[Family, Solved]:
    """The study in a folder and the answers of its members.

    partial : members whose batch is not solved yet, or whose file is not its answer, have the status "not_yet"; if not,
        that is an error.

    Raises
    ------
    InputError : a batch is missing or damaged.
    """
    made, found = read_family(folder)
    task = found.task()
    wanted, inverse = np.unique(task.digests(), return_inverse=True)
    whole = Solved.nothing(task, wanted.size)
    passed_over = set(left(folder, made)) if partial else set()
    for name in made.batches:
        path = answer_file(folder, name)
        if name in passed_over:
            continue
        if not os.path.lexists(path):
            raise InputError(f"the batch {path} is missing; run the same command again")
        own, part = read_solved(path)
        at = np.searchsorted(wanted, own)
        at[at == wanted.size] = 0
        _put(whole, part, np.flatnonzero(wanted[at] == own), at)
    return found, _spread(whole, inverse)


def _put(whole: Solved, part: Solved, rows: NDArray[np.int64], at: NDArray[np.int64]) -> None:
    """Put some rows of a batch at their places."""
    to = at[rows]
    for name, values in part.values.items():
        whole.values[name][to] = values[rows]
    for name, (dims, values) in part.whole.items():
        whole.keep(name, dims[1:], to, values[rows])
    whole.beside |= part.beside
    whole.labels |= part.labels
    for name in ("status", "reason", "iterations"):
        getattr(whole, name)[to] = getattr(part, name)[rows]


def _spread(unique: Solved, inverse: NDArray[np.int64]) -> Solved:
    """The answers of all members from those of different ones."""

    def field(given: Field) -> Field:
        return given[0], given[1][inverse]

    return Solved(
        {name: values[inverse] for name, values in unique.values.items()},
        {name: field(given) for name, given in unique.whole.items()},
        unique.beside,
        unique.labels,
        unique.status[inverse],
        unique.reason[inverse],
        unique.iterations[inverse],
    )


def sweep(folder: Path, made: Plan) -> int:
    """Delete batches that the plan does not use; returns how many."""
    used, gone = set(made.batches), set()
    for path in (folder / BATCHES).glob("*.n*"):
        ours = path.suffix in (".nc", ".npz") and _NAME.fullmatch(path.stem)
        if ours and path.stem not in used:
            path.unlink()
            gone.add(path.stem)
    return len(gone)
