"""Processes killed at random times, which can do nothing about it."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from .processes import (
    ROOT,
    call,
    copied,
    end,
    environment,
    expect_bytes,
    expect_names,
    expect_success,
    expect_whole_files,
    run_words,
    start,
    stopped_motion,
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
    copy = _checkout(trial.folder)
    yield from _killed_workflow(trial, copy, TARGETS, kills=4, seconds=12.0)


@fault(
    KIND,
    "the whole workflow is killed",
    "As above, for all cases, figures and pages of the book.",
    1,
)
def _whole_workflow(trial: Trial) -> Iterator[None]:
    """Four kills of `snakemake all`, then the run to its end."""
    copy = _checkout(trial.folder)
    yield from _killed_workflow(trial, copy, ["all"], kills=4, seconds=150.0)


def _checkout(folder: Path) -> Path:
    """A copy of the tracked files."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    for name in listed.stdout.splitlines():
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
    return folder


def _killed_workflow(
    trial: Trial, copy: Path, targets: list[str], *, kills: int, seconds: float
) -> Iterator[None]:
    rng = trial.rng
    right = _made(copy, targets)
    shutil.rmtree(copy / "results" / "cases")
    for _ in range(kills):
        running = _snakemake(copy, targets)
        time.sleep(rng.uniform(0, seconds))
        os.killpg(running.pid, signal.SIGKILL)
        running.communicate()
        expect_whole_files(copy / "results")
        yield
    found = _made(copy, targets)
    differing = [name for name in right if found.get(name) != right[name]]
    expect(not differing, f"other bytes than without a kill: {' '.join(differing)}")
    yield


def _made(copy: Path, targets: list[str]) -> dict[str, bytes]:
    """What the workflow makes: results, figures and judgement, without notebooks and pages, which have random marks."""
    running = _snakemake(copy, targets)
    text, _ = running.communicate(timeout=3600)
    expect(running.returncode == 0, f"the workflow failed: {text[-300:]!r}")
    made = [
        *copy.glob("results/cases/*.nc"),
        *copy.glob("results/figures/*.svg"),
        *copy.glob("results/*.*"),
    ]
    return {str(path.relative_to(copy)): path.read_bytes() for path in made if path.is_file()}


def _snakemake(copy: Path, targets: list[str]) -> subprocess.Popen[str]:
    return subprocess.Popen(
        ["snakemake", *targets],
        cwd=copy,
        env={**environment(), "PYTHONPATH": str(copy)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
