"""Progress of long work: a bar in terminals and notebooks, lines elsewhere."""

from __future__ import annotations

import contextlib
import os
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from cosserat.problem import Progress

_AFTER, _EVERY = 1.0, 0.1  # seconds before a bar appears, and between its changes
_LOOK = "{desc}: {percentage:3.0f}%|{bar}| {elapsed}<{remaining}{postfix}"
_COMPILING = "compiling, once for each version of cosserat"
_FIRST_LINE, _SLOWER = 6.0, 1.5  # seconds before the first line, and growth of the time between lines


@contextlib.contextmanager
def bar(title: str, since: float | None = None) -> Iterator[Progress]:
    """A function that reports progress: as a bar of tqdm, which goes when the block ends, or as lines.

    The bar appears after a second, if standard error is a terminal or the code runs in a notebook.  Elsewhere, as in
    the log of a batch system, lines come after six seconds and then ever more slowly.  The environment variable
    TQDM_DISABLE=1 switches both off.

    since : when the work began, by `time.monotonic`, for the lines; now by default.
    """
    if not ((sys.stderr is not None and sys.stderr.isatty()) or _in_notebook()):
        lines = Lines(title, since=since)
        with _told_of_compiling(lambda: lines(0.0, _COMPILING)):
            yield lines
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that a notebook without ipywidgets has a bar of text
        from tqdm.auto import tqdm
    with tqdm(
        total=1.0,
        desc=title,
        bar_format=_LOOK,
        leave=False,
        delay=_AFTER,
        mininterval=_EVERY,
        miniters=0,
    ) as shown:

        def report(fraction: float, words: str) -> None:
            shown.set_postfix_str(words, refresh=False)
            shown.update(fraction - shown.n)

        with _told_of_compiling(lambda: report(shown.n, _COMPILING)):
            yield report


@contextlib.contextmanager
def _told_of_compiling(tell: Callable[[], None]) -> Iterator[None]:
    """Call a function whenever Numba begins to compile a kernel, which takes seconds where none are cached."""
    if "numba" not in sys.modules:
        yield
        return
    from numba.core import event

    class Told(event.Listener):
        def on_start(self, event: object) -> None:
            tell()

        def on_end(self, event: object) -> None:
            pass

    with event.install_listener("numba:compile", Told()):
        yield


@dataclass
class Lines:
    """Progress as lines on standard error."""

    title: str
    clock: Callable[[], float] = time.monotonic
    wait: float = _FIRST_LINE
    since: float | None = None
    began: float = field(init=False)

    def __post_init__(self) -> None:
        self.began = self.clock() if self.since is None else self.since

    def __call__(self, fraction: float, words: str) -> None:
        """Print a line if it is time for one."""
        passed = self.clock() - self.began
        if passed < self.wait or os.environ.get("TQDM_DISABLE", "0") not in ("", "0"):
            return
        self.wait = max(_SLOWER * self.wait, passed)
        if fraction > 0:
            left = duration(passed * (1 / fraction - 1))
            words = f"{fraction:.0%}, {words}, about {left} left"
        if sys.stderr is not None:  # there is none where a program has no console
            print(f"{self.title}: {words}", file=sys.stderr, flush=True)


def duration(seconds: float) -> str:
    """A time for a sentence, such as "40 s", "3 min" or "2.5 h"."""
    for unit, scale in (("years", 3.156e7), ("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 1.5 * scale:
            return f"{seconds / scale:.3g} {unit}"
    return f"{seconds:.3g} s"


def size(count: float) -> str:
    """A number of bytes for a sentence, such as "4.8 MB"."""
    for unit, scale in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if count >= scale:
            return f"{count / scale:.3g} {unit}"
    return f"{count:.0f} bytes"


def _in_notebook() -> bool:
    """Whether the code runs in a Jupyter kernel."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return shell is not None and "IPKernelApp" in shell.config
