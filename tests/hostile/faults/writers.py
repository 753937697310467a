"""Two processes that write the same output, and what killed ones leave behind."""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator

from .processes import (
    Done,
    call,
    end,
    expect_bytes,
    expect_names,
    expect_sentence,
    expect_success,
    run_words,
    start,
    undisturbed,
    wait_for_parts,
)
from .table import Trial, expect, fault

KIND = "two writers"
ONE = "One goes on, the other says so in one sentence at once, exit 2"


@fault(KIND, "a run of a motion that another process is running", f"{ONE}; the bytes are right.", 4)
def _second(trial: Trial) -> Iterator[None]:
    words = run_words("motion", "motion.nc")
    first = start(trial.folder, *words)
    wait_for_parts(first, trial.folder / "motion.nc.parts", 1)
    first.send_signal(signal.SIGSTOP)  # so that it does not end while the other begins
    second = call(trial.folder, *words)
    first.send_signal(signal.SIGCONT)
    expect_sentence(second, 2, naming=["motion.nc"])
    expect_success(end(first))
    expect_bytes(trial.folder / "motion.nc", undisturbed("motion").bytes)
    expect_names(trial.folder, "motion.nc")
    yield


PAIRS = ("motion", "statics", "crawl", "plot", "export")


@fault(
    KIND,
    "two that begin at the same time",
    f"{ONE}, or begins after the other has ended; the bytes are right.",
    20,
)
def _together(trial: Trial) -> Iterator[None]:
    case = PAIRS[trial.number % len(PAIRS)]
    result = undisturbed("statics").path
    if case == "plot":
        name, words = "x.svg", ("plot", result, "-o", "x.svg")
    elif case == "export":
        name, words = "x.csv", ("export", result, "-o", "x.csv")
    else:
        name, words = "x.nc", run_words(case, "x.nc")
    both = [start(trial.folder, *words)]
    time.sleep(trial.rng.exponential(0.05))
    both.append(start(trial.folder, *words))
    ended = [end(one) for one in both]
    _expect_one(ended, name)
    if case in ("plot", "export"):
        call(trial.folder, *words[:-1], f"again{name}")
        expect_bytes(trial.folder / name, (trial.folder / f"again{name}").read_bytes())
        expect_names(trial.folder, name, f"again{name}")
    else:
        expect_bytes(trial.folder / name, undisturbed(case).bytes)
        expect_names(trial.folder, name)
    yield


def _expect_one(ended: list[Done], name: str) -> None:
    """At least one with success; another with a sentence."""
    expect(any(done.code == 0 for done in ended), "; ".join(done.told for done in ended))
    for done in ended:
        if done.code == 0:
            expect_success(done)
        else:
            expect_sentence(done, 2, naming=[name])


@fault(KIND, "while one is stopped", f"{ONE}, however long the other has been standing still.", 1)
def _stopped(trial: Trial) -> Iterator[None]:
    words = run_words("motion", "motion.nc")
    first = start(trial.folder, *words)
    wait_for_parts(first, trial.folder / "motion.nc.parts", 1)
    first.send_signal(signal.SIGSTOP)
    second = call(trial.folder, *words)
    first.kill()
    first.communicate()
    expect_sentence(second, 2, naming=["motion.nc"])
    yield
