"""Processes killed at random times, which can do nothing about it."""

from __future__ import annotations

import functools
import os
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .processes import (
    HANGS,
    ROOT,
    call,
    copied,
    end,
    environment,
    expect_bytes,
    expect_names,
    expect_success,
    expect_whole_files,
    interruptible,
    run_words,
    start,
    stopped_motion,
    store,
    undisturbed,
    wait_for_parts,
)
from .table import Trial, expect, fault

KIND = "kill"


@fault(
    KIND,
    "a motion is killed",
    "What is stored is whole; the same command goes on from it to the same bytes and leaves nothing over.",
    20,
)
def _motion(trial: Trial) -> Iterator[None]:
    """Five kills, then the run to its end."""
    rng, usual = trial.rng, undisturbed("motion")
    for _ in range(5):
        killed_once(trial.folder, rng)
        yield
    expect_success(end(start(trial.folder, *run_words("motion", "motion.nc"))))
    expect_bytes(trial.folder / "motion.nc", usual.bytes)
    expect_names(trial.folder, "motion.nc")
    yield


def killed_once(folder: Path, rng: np.random.Generator) -> None:
    """Kill a motion after a random time or some parts; if it got to its end, it is begun anew next time."""
    usual, parts = undisturbed("motion"), folder / "motion.nc.parts"
    running = start(folder, *run_words("motion", "motion.nc"))
    if rng.random() < 0.5:
        wait_for_parts(running, parts, len(list(parts.glob("[0-9]*.nc"))) + int(rng.integers(1, 3)))
        time.sleep(rng.uniform(0, usual.seconds / 20))
    else:
        time.sleep(rng.uniform(0, usual.seconds))
    running.kill()
    running.communicate()
    expect_whole_files(folder)
    if (folder / "motion.nc").exists():
        expect_bytes(folder / "motion.nc", usual.bytes)
        (folder / "motion.nc").unlink()


@fault(
    KIND,
    "a picture is killed while it is drawn",
    "The picture is whole or absent, and the same command draws the same bytes.",
    6,
)
def _picture(trial: Trial) -> Iterator[None]:
    rng, result = trial.rng, undisturbed("path")
    for _ in range(2):
        running = start(trial.folder, "plot", result.path, "-o", "path.svg", marked=True)
        time.sleep(rng.uniform(0, 1.5 * result.seconds))
        running.kill()
        running.communicate()
        expect_whole_files(trial.folder)
        yield
    for name in ("path.svg", "again.svg"):
        expect_success(end(start(trial.folder, "plot", result.path, "-o", name)))
    expect_bytes(trial.folder / "path.svg", (trial.folder / "again.svg").read_bytes())
    expect_names(trial.folder, "path.svg", "again.svg")
    yield


@fault(
    KIND,
    "what a killed motion left",
    "It holds nobody: the run goes on at once to the same bytes.",
    3,
)
def _after_a_kill(trial: Trial) -> Iterator[None]:
    """Its parts, locks and temporary files, also if its process number is that of a live process of another."""
    copied(stopped_motion(), trial.folder)
    begun = [path for path in (trial.folder / "motion.nc.parts").iterdir() if path.suffix == ".part"]
    if trial.number == 1:
        for name in (
            f".motion.nc.host.{os.getpid()}.part",
            f".motion.nc.{os.uname().nodename}.{2**22 - 1}.part",
        ):
            (trial.folder / name).write_bytes(b"left")
    expect_success(call(trial.folder, *run_words("motion", "motion.nc")))
    expect_bytes(trial.folder / "motion.nc", undisturbed("motion").bytes)
    left = [f".motion.nc.host.{os.getpid()}.part"] if trial.number == 1 else []  # another machine's
    expect_names(trial.folder, "motion.nc", *left)
    expect(not any(path.exists() for path in begun), "temporary files of the killed process are left")
    yield


BATCH = ("hanging_bar", "clamped_free", "necking")
TARGETS = [f"results/cases/{name}.nc" for name in BATCH]


@fault(
    KIND,
    "the workflow is killed",
    "The same command goes on, without any other step, to the same bytes.",
    4,
)
def _workflow(trial: Trial) -> Iterator[None]:
    """Four kills of Snakemake and its jobs while it makes a few cases, then the run to its end."""
    yield from _killed_workflow(trial, TARGETS, [GROUP], _few_made(), kills=4, seconds=12.0)


@fault(
    KIND,
    "the whole workflow is killed",
    "As above, for all cases, studies, figures and pages of the book; also by SIGTERM and Ctrl-C.",
    2,
)
def _whole_workflow(trial: Trial) -> Iterator[None]:
    """Ten kills of `snakemake all` in a checkout in which nothing was made or compiled, then the run to its end."""
    yield from _killed_workflow(trial, ["all"], WAYS, _whole_made(), kills=10, seconds=50.0)


@dataclass(frozen=True)
class Way:
    """A signal, and whether it goes to Snakemake and all its jobs or to Snakemake alone."""

    number: signal.Signals
    group: bool

    def end(self, running: subprocess.Popen[str]) -> None:
        """Send it, if Snakemake still runs, and wait for the end of Snakemake."""
        if running.poll() is None:
            (os.killpg if self.group else os.kill)(running.pid, self.number)
        try:
            running.wait(HANGS)
        except subprocess.TimeoutExpired:
            os.killpg(running.pid, signal.SIGKILL)
            expect(False, f"{self.number.name}: no end after {HANGS:g} s")


GROUP = Way(signal.SIGKILL, group=True)
WAYS = (
    GROUP,
    Way(signal.SIGKILL, group=False),
    Way(signal.SIGTERM, group=False),
    Way(signal.SIGINT, group=True),
)
"""A kill of all, a kill after which jobs outlive Snakemake, a batch system's end, and Ctrl-C."""


@functools.cache
def _few_made() -> dict[str, bytes]:
    return _made(_checkout(store() / "few"), TARGETS)


@functools.cache
def _whole_made() -> dict[str, bytes]:
    return _made(_checkout(store() / "whole"), ["all"])


def _checkout(folder: Path) -> Path:
    """A copy of the tracked files."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    for name in listed.stdout.splitlines():
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
    return folder


def _killed_workflow(
    trial: Trial,
    targets: list[str],
    ways: Sequence[Way],
    right: dict[str, bytes],
    *,
    kills: int,
    seconds: float,
) -> Iterator[None]:
    """Kills, each after a random part of the seconds; then the same command, and what it made."""
    copy, rng = _checkout(trial.folder), trial.rng
    for number in range(kills):
        running = _snakemake(copy, targets)
        time.sleep(rng.uniform(0, seconds))
        ways[number % len(ways)].end(running)
        expect_whole_files(copy / "results")
        yield
    found = _made(copy, targets)
    differing = [name for name in found | right if found.get(name) != right.get(name)]
    expect(not differing, f"other bytes than without a kill: {' '.join(differing[:9])}")
    yield


def _made(copy: Path, targets: list[str]) -> dict[str, bytes]:
    """All files below `results` after the workflow has run to its end, without its times and words.

    The folders of studies are left out: their plans depend on how fast the machine was.
    """
    running = _snakemake(copy, targets)
    running.wait(3600)
    told = (copy / ".snakemake/told").read_text()
    expect(running.returncode == 0, f"the workflow failed: {told[-300:]!r}")
    files = {path.relative_to(copy / "results"): path for path in (copy / "results").rglob("*")}
    return {
        str(name): path.read_bytes()
        for name, path in files.items()
        if path.is_file()
        and name.parts[0] not in ("logs", "benchmarks")
        and not any(part.endswith(".study") for part in name.parts)
    }


def _snakemake(copy: Path, targets: list[str]) -> subprocess.Popen[str]:
    """Its words go into a file, which jobs that outlive it hold open."""
    (copy / ".snakemake").mkdir(exist_ok=True)
    with (copy / ".snakemake/told").open("w") as told:
        return subprocess.Popen(
            ["snakemake", *targets],
            cwd=copy,
            env={**environment(), "PYTHONPATH": str(copy)},
            stdin=subprocess.DEVNULL,
            stdout=told,
            stderr=subprocess.STDOUT,
            text=True,
            preexec_fn=interruptible,  # noqa: PLW1509 - this process has no other threads
            start_new_session=True,
        )
