"""What the threads of a program share: libraries that know one thread only, and settings of the whole process.

HDF5, Matplotlib and pint end the process, draw something else or know no unit if two threads call them at once: threads
wait for one another.  Solvers run side by side; what they set for the process stays until the last of them has ended.
"""

from __future__ import annotations

import contextlib
import functools
import os
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from typing import Any

from threadpoolctl import ThreadpoolController


def one_at_a_time() -> contextlib.AbstractContextManager[bool]:
    """A lock that one thread holds at a time; a fork waits for it, whose child would find it closed for ever."""
    lock = threading.RLock()
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(
            before=lock.acquire, after_in_parent=lock.release, after_in_child=lock.release
        )
    return lock


class _Settings:
    """Those of the process while any of its threads solves."""

    def __init__(self) -> None:
        self._own = one_at_a_time()
        self._usual = contextlib.ExitStack()
        self._solving = 0

    def enter(self) -> None:
        with self._own:
            if self._solving == 0:
                self._usual.enter_context(_libraries(len(sys.modules)).limit(limits=1))
                self._usual.enter_context(warnings.catch_warnings())
                warnings.simplefilter("always")
                warnings.showwarning = functools.partial(_keep, warnings.showwarning)
            self._solving += 1

    def leave(self) -> None:
        with self._own:
            self._solving -= 1
            if self._solving == 0:
                self._usual.close()


# A fork takes the last of these locks first, as threads do that need two of them.
FILES = one_at_a_time()
"""Whoever calls HDF5 holds it."""
UNITS = one_at_a_time()
"""Whoever calls pint holds it."""
_settings = _Settings()
DRAWING = one_at_a_time()
"""Whoever calls Matplotlib holds it."""
_KEPT: ContextVar[set[str] | None] = ContextVar("kept", default=None)


@contextlib.contextmanager
def solving() -> Iterator[set[str]]:
    """One thread of linear algebra, as more change the last digits, and warnings of libraries kept from the screen.

    They name lines of code and no key of a case.  Yields the first lines of those that came so far.
    """
    kept: set[str] = set()
    token = _KEPT.set(kept)
    _settings.enter()
    try:
        yield kept
    finally:
        _settings.leave()
        _KEPT.reset(token)


def _keep(show: Callable[..., None], message: Warning | str, *where: Any, **more: Any) -> None:
    """Keep a warning of a thread that solves, and show that of another one."""
    kept = _KEPT.get()
    if kept is None:
        show(message, *where, **more)
    else:
        kept.add(str(message).splitlines()[0])


@functools.lru_cache(maxsize=1)
def _libraries(modules: int) -> ThreadpoolController:
    """The libraries of linear algebra in this process.

    modules : how many are loaded; more may bring another library.
    """
    return ThreadpoolController()
