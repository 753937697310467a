"""Signals that ask a process to stop: Ctrl-C, a batch system's SIGTERM, a closed terminal's SIGHUP."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

from .processes import (
    Done,
    end,
    expect_bytes,
    expect_names,
    expect_sentence,
    expect_success,
    expect_whole_files,
    run_words,
    start,
    undisturbed,
)
from .table import Trial, expect, fault

KIND = "signal"
SOON = 5.0
"""Seconds of the process's own time within which it ends."""
CODES = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGHUP: 129}
ANSWER = "Within five seconds one line; exit {code}; nothing invalid is left"


def _enter(number: signal.Signals, what: str) -> None:
    """The faults of one signal: in a motion, in its first second, and in long work that keeps no parts."""
    answer = ANSWER.format(code=CODES[number])

    @fault(KIND, f"{what} in a motion", f"{answer}, and the same command goes on to the same bytes.", 4)
    def motion(trial: Trial) -> Iterator[None]:
        usual, rng = undisturbed("motion"), trial.rng
        for _ in range(2):
            _stopped(trial.folder, "motion", number, rng.uniform(0, usual.seconds))
            yield
        expect_success(end(start(trial.folder, *run_words("motion", "motion.nc"))))
        expect_bytes(trial.folder / "motion.nc", usual.bytes)
        expect_names(trial.folder, "motion.nc")
        yield

    @fault(KIND, f"{what} from the first line of the program on", f"{answer}.", 10)
    def beginning(trial: Trial) -> Iterator[None]:
        for _ in range(2):
            _stopped(trial.folder, "motion", number, trial.rng.exponential(0.2))
            yield

    @fault(KIND, f"{what} in long work without parts", f"{answer}.", 8)
    def long(trial: Trial) -> Iterator[None]:
        case = LONG[trial.number % len(LONG)]
        ended = _stopped(trial.folder, case, number, trial.rng.uniform(0, 4))
        expect_names(trial.folder, *([f"{case}.nc"] if ended else []))
        yield


@fault(KIND, "SIGHUP under nohup", "The run goes on to its end.", 1)
def _nohup(trial: Trial) -> Iterator[None]:
    running = start(
        trial.folder,
        *run_words("statics", "statics.nc"),
        marked=True,
        before=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN),
    )
    running.send_signal(signal.SIGHUP)
    expect_success(end(running))
    yield


LONG = ("long_statics", "long_path", "long_crawl", "long_posture")


def _stopped(folder: Path, case: str, number: signal.Signals, seconds: float) -> bool:
    """A run that gets a signal so many seconds after the beginning of `main`; whether it had ended by then."""
    running = start(folder, *run_words(case, f"{case}.nc"), marked=True)
    time.sleep(seconds)
    before = _own_seconds(running)
    running.send_signal(number)
    done, used = _ended(running)
    if done.code == 0 and (folder / f"{case}.nc").exists():
        expect_success(done)
        return True
    expect_sentence(done, CODES[number])
    expect(used - before < SOON, f"{used - before:.1f} s of its own time until it ended")
    expect_whole_files(folder)
    return False


def _own_seconds(running: subprocess.Popen[str]) -> float:
    """The processor time of a live process; of one that has ended, nothing."""
    try:
        fields = Path(f"/proc/{running.pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _ended(running: subprocess.Popen[str]) -> tuple[Done, float]:
    """The end of a process, and its own time shortly before."""
    used, until = 0.0, time.monotonic() + 60
    while running.poll() is None and time.monotonic() < until:
        used = _own_seconds(running) or used
        time.sleep(0.05)
    return end(running, 1.0), used


for _number, _what in (
    (signal.SIGINT, "Ctrl-C"),
    (signal.SIGTERM, "SIGTERM"),
    (signal.SIGHUP, "SIGHUP"),
):
    _enter(_number, _what)
