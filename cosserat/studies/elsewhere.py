"""Runs on Slurm: which of their jobs wait or run, and how they are ended.

The Slurm plugin of Snakemake names every job of a run by one identifier, which Snakemake writes into its log.  A
Snakefile holds a lock on `.snakemake/running` as long as its Snakemake lives (`alone`): host and process stand in it.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, TextIO

from cosserat.errors import InputError
from cosserat.text import shown

_ANSWER = 60.0  # seconds in which squeue and scancel answer
_END = 60.0  # seconds in which cancelled jobs leave the queue: Slurm kills them after its KillWait, 30 s
_POLITE = 10.0  # seconds in which a Snakemake whose jobs are cancelled ends by itself
_RUN = re.compile(r"SLURM run ID: ([\w-]+)")
_COMMENT = re.compile(r"rule_(?P<rule>.+?)(?:_wildcards_(?P<wildcards>.+))?")


class Job(NamedTuple):
    """A job that waits or runs on Slurm.

    id : its number at Slurm.
    state : Slurm's word for its state, such as PENDING or RUNNING.
    batch : what the rule makes for these wildcards (the digest of a batch of a study), or the rule that has none.
    """

    id: str
    state: str
    batch: str


def jobs(folder: Path) -> list[Job]:
    """Jobs on Slurm that belong to runs of Snakemake in a folder, also of one that was killed.

    Empty where no run in the folder used Slurm.

    Raises
    ------
    InputError : a run used Slurm, and its squeue is missing here, fails, or does not answer.
    """
    return [job for _, job in _listed(folder)]


def alone(folder: Path, *, change: bool = True) -> TextIO:
    """Wait until no other Snakemake runs in a folder, end what a killed one left on Slurm, and return the lock.

    Whoever keeps the file that is returned holds the lock.  A job that is left would delete and make anew what the next
    run makes and reads.  Lines on stderr tell what is waited for, what is ended, and which Slurm does not answer.

    change : whether to end jobs; a dry run does not.
    """
    file = Path(folder) / ".snakemake/running"
    file.parent.mkdir(exist_ok=True)
    running = file.open("a")
    wait_for(running)
    running.truncate(0)
    print(socket.gethostname(), os.getpid(), file=running, flush=True)
    try:
        for job in end(folder) if change else ():
            print(f"ended job {job.id} on Slurm, which a killed run left: {job.batch}", file=sys.stderr)
    except InputError as error:
        print(f"jobs of an earlier run may be left: {error}", file=sys.stderr)
    return running


def wait_for(file: TextIO) -> None:
    """Lock a file, and say on stderr if that takes time."""
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        print(
            "waiting for another run in this folder, or for jobs that a killed one left", file=sys.stderr
        )
        fcntl.flock(file, fcntl.LOCK_EX)


def cancel(folder: Path) -> list[Job]:
    """End the Snakemake that runs in a folder with the jobs it has on Slurm, and return those jobs.

    What is finished stays; the command that started the run continues it.

    Raises
    ------
    InputError : Snakemake runs on another machine; no Slurm answers here; jobs do not end.
    """
    process = _running(folder)
    if process is not None:
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, signal.SIGTERM)  # submits no more, and waits for its jobs
    ended = end(folder)
    if process is not None and not _until(lambda: _running(folder) is None, _POLITE):
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
        ended += end(folder)
    return ended


def end(folder: Path) -> list[Job]:
    """End the jobs on Slurm of runs in a folder whose Snakemake no longer runs, and return them.

    Raises
    ------
    InputError : no Slurm answers here, or jobs are still there after a minute.
    """
    listed = _listed(folder)
    for run in dict.fromkeys(run for run, _ in listed):
        _call("scancel", f"--name={run}")
    if not _until(lambda: not _listed(folder), _END if listed else 0.0):
        left = ", ".join(job.id for job in jobs(folder))
        raise InputError(
            f"Slurm has not ended job {left} within {_END:g} s of scancel; look at it with squeue"
        )
    return [job for _, job in listed]


def _listed(folder: Path) -> list[tuple[str, Job]]:
    runs = _runs(folder)
    if not runs:
        return []
    answer = _call("squeue", "--noheader", f"--name={','.join(runs)}", "--format=%j|%i|%T|%k")
    found = []
    for line in answer.splitlines():
        run, number, state, comment = (word.strip() for word in line.split("|", 3))
        made = _COMMENT.fullmatch(comment)
        found.append((run, Job(number, state, (made["wildcards"] or made["rule"]) if made else comment)))
    return found


def _runs(folder: Path) -> list[str]:
    """Identifiers of the runs on Slurm in a folder, the oldest first."""
    logs = sorted((Path(folder) / ".snakemake/log").glob("*.snakemake.log"))
    return [found for log in logs for found in _RUN.findall(log.read_text(errors="replace"))]


def _call(program: str, *arguments: str) -> str:
    try:
        done = subprocess.run(
            [program, *arguments],
            capture_output=True,
            text=True,
            errors="replace",
            check=True,
            timeout=_ANSWER,
        )
    except FileNotFoundError:
        raise InputError(
            f"the run used Slurm and there is no {program} on this machine; ask where Slurm's commands are"
        ) from None
    except subprocess.TimeoutExpired:
        raise InputError(
            f"{program} did not answer within {_ANSWER:g} s; try again when Slurm answers"
        ) from None
    except subprocess.CalledProcessError as error:
        said = (error.stderr.strip().splitlines() or [f"exit code {error.returncode}"])[0]
        raise InputError(f"{program} failed ({shown(said)}); try again when Slurm answers") from None
    return done.stdout


def _running(folder: Path) -> int | None:
    """The process of the Snakemake that runs in a folder, if one does."""
    try:
        file = (Path(folder) / ".snakemake/running").open()
    except FileNotFoundError:
        return None
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            host, _, process = file.read().partition(" ")
        else:
            return None
    if host != socket.gethostname() or not process.strip().isdecimal():
        raise InputError(f"Snakemake runs in {folder} on {shown(host)}; cancel it there")
    return int(process)


def _until(reached: Callable[[], bool], seconds: float) -> bool:
    """Whether something is so within a time."""
    latest = time.monotonic() + seconds
    while not reached():
        if time.monotonic() >= latest:
            return False
        time.sleep(0.5)
    return True
