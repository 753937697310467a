"""The interface of all kinds of problems: parameters that can be solved."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from cosserat.parameters import Parameters
from cosserat.solution import Many, Solution

Progress = Callable[[float, str], None]
"""Called with the fraction done, from 0 to 1, and a few words."""


class Checkpoints(Protocol):
    """Numbered parts of a long run, kept so that an interrupted run can resume."""

    def load(self, number: int) -> Solution | None:
        """A stored part; None if it has not been computed yet."""

    def save(self, number: int, part: Solution, *, whole: bool) -> None:
        """Store a part; an incomplete one is stored separately, and no run resumes from it."""


def silent(fraction: float, words: str) -> None:
    """Report nothing."""


@dataclass(frozen=True)
class Run:
    """Services for a problem while it is solved: a progress report, and a store of parts.

    wanted : names of the fields that are read, all of them by default; others that take time may be left out.
    """

    progress: Progress = silent
    checkpoints: Checkpoints | None = None
    wanted: Set[str] | None = None

    def wants(self, names: Set[str]) -> bool:
        """Whether some of these fields are read."""
        return self.wanted is None or bool(self.wanted & names)


ALONE = Run()
"""A run that reports nothing and stores nothing."""


@dataclass(frozen=True)
class Forecast:
    """What solving a problem will take, as far as it can be foreseen; `cosserat.limits` compares it.

    seconds : time.  size : bytes of the result.  work, stored : what takes them, in words.  less_work, less_stored :
    the remedies.  memory : bytes that the work needs beside the result.
    """

    seconds: float = 0.0
    size: float = 0.0
    work: str = "the run"
    less_work: str = "make it smaller"
    stored: str = "the result"
    less_stored: str = "make it smaller"
    memory: float = 0.0

    @classmethod
    def of(cls, seconds: float, numbers: float, what: str, remedy: str) -> Forecast:
        """Where the same things take time and space: so many seconds, and stored numbers."""
        return cls(seconds, 8.0 * numbers, what, remedy, what, remedy)


class Problem(Parameters, ABC):
    """Base of every kind of problem; `cosserat.kinds` lists them."""

    if TYPE_CHECKING:
        kind: str  # each class names its own
    thinned: ClassVar[Mapping[str, int]] = {}
    """Dimensions thinned in a stored reference, with the approximate number of values kept; 0 keeps nothing."""

    @property
    def body(self) -> str:
        """The body in a few words, with units; empty if there is none."""
        return ""

    @property
    def forecast(self) -> Forecast:
        """What solving it will take; nothing worth naming by default."""
        return Forecast()

    def solve_many(
        self,
        columns: Mapping[str, NDArray[np.float64]],
        wanted: Sequence[str],
        by: Sequence[str] = (),
    ) -> Many | None:
        """The problem for many values of some keys at once; None where each is solved by itself, as by default.

        columns : values (M,) by dotted keys, in SI units.  wanted : names of the fields to give.
        by : keys with which these move.
        """
        return None

    @property
    def has_tangent(self) -> bool:
        """Whether its result moves exactly with parameters, if results of its kind do."""
        return True

    @abstractmethod
    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """Solve the problem; `name` : name of the case in errors."""

    @classmethod
    @abstractmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """The effort of the solution in a few words, from its statistics and the sizes of its dimensions."""
