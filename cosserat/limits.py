"""Limits of a run: its time and the size of its result, estimated before they are spent."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cosserat import memory
from cosserat.arguments import of_class
from cosserat.errors import InputError, OverLimitError
from cosserat.parameters import Parameters, Quantity
from cosserat.problem import Forecast, Progress
from cosserat.progress import duration, size

HOURS = 24.0
GIGABYTES = 10.0
_OFTEN = 0.1  # seconds between two reports of a solver
_COPIES = 2  # of the values of a long run on disk: its parts, and the result that is made of them


class Limits(Parameters):
    """What a run may take; more is refused before it begins, or stops it where that could not be foreseen."""

    hours: Annotated[float, Quantity("1", above=0)] = HOURS
    """Longest time of the run [h]."""
    gigabytes: Annotated[float, Quantity("1", above=0)] = GIGABYTES
    """Largest result [GB]."""

    def check(self, forecast: Forecast, name: str, result: Path | None) -> None:
        """Raise an error for a run that would take more than allowed, or more than its disk has.

        Raises
        ------
        OverLimitError : it takes too much time or space.  InputError : its disk has too little space.
        """
        if forecast.seconds > 3600 * self.hours:
            raise OverLimitError(
                f"{name}: {forecast.work} would take about {duration(forecast.seconds)}, over the limit of "
                f"{self.hours:g} h; {forecast.less_work}, or raise the limit --hours"
            )
        if forecast.memory > (there := memory.free()):
            raise InputError(
                f"{name}: {forecast.work} need about {size(forecast.memory)} of memory, and {size(there)} are free; "
                f"{forecast.less_work}"
            )
        if forecast.size > 1e9 * self.gigabytes:
            raise OverLimitError(
                f"{name}: {forecast.stored} would take {size(forecast.size)}, over the limit of {self.gigabytes:g} GB; "
                f"{forecast.less_stored}, or raise the limit --gigabytes"
            )
        if result is None:
            return
        free, need = shutil.disk_usage(result.parent).free, _COPIES * forecast.size
        if need > free:
            raise InputError(
                f"{name}: {forecast.stored} need {size(need)} while it runs, and {size(free)} are free in "
                f"{result.parent}; {forecast.less_stored}, or write to another disk with --output"
            )


LIMITS = of_class(Limits, "cosserat.Limits(hours=..., gigabytes=...)")
"""Limits as an argument of a function."""


@dataclass
class Watched:
    """Progress of a run, which is stopped after its time: by its own reports and by the iterations of its solvers."""

    report: Progress
    limits: Limits
    name: str
    clock: Callable[[], float] = time.monotonic

    def __post_init__(self) -> None:
        self._began = self._told = self.clock()
        self._last: tuple[float, str] | None = None

    def __call__(self, fraction: float, words: str) -> None:
        """Report, and raise OverLimitError after the time that the run may take."""
        self._last = fraction, words
        self._tell(fraction, words)

    def hear(self, load: float, iterations: int) -> None:
        """Report an iteration of a solver: where the run tells of no progress, what is done of the load."""
        if self.clock() - self._told < _OFTEN:
            return
        words = f"{iterations} iterations"
        if load:
            words = f"{load:.4g} of the load, {words}"
        self._tell(*self._last or (0.0, words))

    def _tell(self, fraction: float, words: str) -> None:
        self._told = self.clock()
        self.report(fraction, words)
        if self._told - self._began > 3600 * self.limits.hours:
            raise OverLimitError(
                f"{self.name} stopped after {duration(3600 * self.limits.hours)}, at {words}; raise the limit --hours"
            )
