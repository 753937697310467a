"""Signals to end: a run stops with one line, and can be resumed.

The first signal raises `Stopped` in the main thread.  Compiled code and libraries cannot be interrupted by an
exception, and some swallow it: if the process still runs after a few seconds, a thread ends it.  Nothing is lost by
that, since every file is whole or absent.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from types import FrameType

SIGNALS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
"""Signals that ask a run to end: Ctrl-C, a batch system's, and a closed terminal's."""
_WORDS = {"SIGINT": "interrupted", "SIGTERM": "terminated", "SIGHUP": "its terminal was closed"}
_GRACE = 3.0  # seconds in which a run ends by itself
received: list[int] = []
"""Signals to end that have come: after the first, whatever goes wrong is its doing."""


class Stopped(KeyboardInterrupt):
    """A signal asked the run to end; as a KeyboardInterrupt, libraries let it pass."""

    def __init__(self, number: int, more: str = "no incomplete file was written") -> None:
        super().__init__(f"{_WORDS[signal.Signals(number).name]}; {more}")
        self.number = number
        self.status = 128 + number
        """The exit status of a process that this signal ended, as shells have it."""


def end_by_signals() -> None:
    """Let signals to end raise `Stopped`, and end the process if it does not end by itself.

    A signal that the process was told to ignore, as by nohup, stays ignored.
    """
    heard, written = os.pipe()
    os.set_blocking(written, False)
    signal.set_wakeup_fd(written, warn_on_full_buffer=False)
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _stop)
    sys.unraisablehook = _unraisable
    if hasattr(signal, "pthread_sigmask"):  # a parent may have blocked them until somebody minds them
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
    with contextlib.suppress(RuntimeError):  # no thread can be started where memory is short
        threading.Thread(target=_watch, args=(heard,), daemon=True).start()


def ignore_signals() -> None:
    """Let a process that has done its work, or has stopped, end undisturbed."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)


@contextlib.contextmanager
def uninterrupted() -> Iterator[None]:
    """Delay signals to end until the block has ended: inside, an exception would leave a library broken or locked.

    Only Python's main thread is interrupted; in other threads this does nothing.
    """
    usual = {number: signal.getsignal(number) for number in SIGNALS}
    if threading.current_thread() is not threading.main_thread() or None in usual.values():
        yield
        return
    waiting: list[tuple[int, FrameType | None]] = []
    for number, handler in usual.items():
        if callable(handler):
            signal.signal(number, lambda *given: waiting.append(given))
    try:
        yield
    finally:
        for number, handler in usual.items():
            signal.signal(number, handler)
        for given in waiting[:1]:
            handler = usual[signal.Signals(given[0])]
            if callable(handler):
                handler(*given)


def _stop(number: int, frame: FrameType | None) -> None:
    received.append(number)
    if len(received) == 1:  # a second one would come amid the end of the run
        raise Stopped(number)


def _unraisable(given: sys.UnraisableHookArgs) -> None:
    """Say nothing of a `Stopped` that came amid a call of compiled code and went no further; `_watch` ends the run."""
    if not isinstance(given.exc_value, Stopped):
        sys.__unraisablehook__(given)


def _watch(heard: int) -> None:
    """End the process some seconds after a signal to end."""
    ours = {int(number) for number in SIGNALS if signal.getsignal(number) is _stop}
    while (number := os.read(heard, 1)[0]) not in ours:
        pass
    time.sleep(_GRACE)
    stopped = Stopped(number)
    with contextlib.suppress(OSError):
        os.write(2, f"cosserat: {stopped}\n".encode())
    os._exit(stopped.status)
