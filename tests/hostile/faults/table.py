"""The table of faults: what is promised, how often it is tried, and how each is judged."""

from __future__ import annotations

import csv
import platform
import tempfile
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

COLUMNS = ("kind", "fault", "promise", "tried", "as promised", "not as promised", "first failure")


class NotAsPromisedError(AssertionError):
    """What was found in place of what is promised."""


class CannotBeTriedError(Exception):
    """This machine or user cannot produce the fault: what is lacking."""


def expect(condition: object, found: str) -> None:
    """Raise NotAsPromisedError with what was found unless the condition holds."""
    if not condition:
        raise NotAsPromisedError(found)


@dataclass(frozen=True)
class Trial:
    """One attempt at a fault.

    folder : empty, for this attempt alone.  number, seed : with the fault's name they decide every random choice.
    """

    fault: Fault
    number: int
    seed: int
    folder: Path

    @property
    def rng(self) -> np.random.Generator:
        return np.random.default_rng([self.seed, zlib.crc32(self.fault.name.encode()), self.number])

    @property
    def command(self) -> str:
        """What repeats this attempt alone."""
        return (
            f"python -m tests.hostile.faults --only '{self.fault.name}' --seed {self.seed} "
            f"--from {self.number} --count 1"
        )


Attempt = Callable[[Trial], Iterator[None]]
"""Yields once for everything that was tried and went as promised; raises NotAsPromisedError for what did not."""


@dataclass(frozen=True)
class Fault:
    """A row of the table.

    kind : the class of faults that it belongs to.  promise : a sentence.  count : attempts in the whole table.
    """

    kind: str
    name: str
    promise: str
    count: int
    attempt: Attempt


FAULTS: dict[str, Fault] = {}
"""By name, in the order of the table."""


def fault(kind: str, name: str, promise: str, count: int) -> Callable[[Attempt], Attempt]:
    """Enter a function into the table."""

    def enter(attempt: Attempt) -> Attempt:
        FAULTS[name] = Fault(kind, name, promise, count, attempt)
        return attempt

    return enter


@dataclass
class Tally:
    """What came of a fault."""

    fault: Fault
    kept: int = 0
    failures: list[tuple[str, str]] = field(default_factory=list)
    lacking: str = ""

    @property
    def line(self) -> dict[str, str]:
        first = f"{self.failures[0][1]}; {self.failures[0][0]}" if self.failures else ""
        failed = len(self.failures)
        cells = (
            self.fault.kind,
            self.fault.name,
            self.fault.promise,
            self.kept + failed,
            self.kept,
            failed,
        )
        return dict(zip(COLUMNS, (*map(str, cells), self.lacking or first), strict=True))


def tried(one: Fault, *, count: int, seed: int = 0, first: int = 0) -> Tally:
    """Try a fault so many times, each in a folder of its own that is deleted afterwards."""
    tally = Tally(one, lacking="" if count else "not tried yet")
    for number in range(first, first + count):
        with tempfile.TemporaryDirectory(prefix="fault-", ignore_cleanup_errors=True) as folder:
            trial = Trial(one, number, seed, Path(folder))
            try:
                for _ in one.attempt(trial):
                    tally.kept += 1
            except NotAsPromisedError as found:
                told = str(found).replace(folder, "FOLDER").replace(platform.node(), "HOST")
                tally.failures.append((trial.command, told))
            except CannotBeTriedError as lack:
                tally.lacking = f"not tried: {lack}"
                break
    return tally


def store(tallies: list[Tally], path: Path) -> None:
    """Put these rows into the file, in the order of the table; rows of other faults that it holds stay."""
    lines = {tally.fault.name: tally.line for tally in tallies}
    if path.is_file():
        with path.open(newline="", encoding="utf-8") as stream:
            lines = {line["fault"]: line for line in csv.DictReader(stream)} | lines
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(lines[name] for name in FAULTS if name in lines)
