"""A sign of life from inside a solver: whoever runs it can show progress, and stop it by an exception."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from contextvars import ContextVar

Listener = Callable[[float, int], None]
"""Called with the fraction of the load, 0 where there is none, and the number of iterations so far."""
_LISTENER: ContextVar[Listener | None] = ContextVar("listener", default=None)


def beat(fraction: float, iterations: int) -> None:
    """Tell the listener, if there is one; solvers call it once in every iteration."""
    listener = _LISTENER.get()
    if listener is not None:
        listener(fraction, iterations)


@contextlib.contextmanager
def listening(listener: Listener) -> Iterator[None]:
    """Let a function hear the solvers that run in the block."""
    token = _LISTENER.set(listener)
    try:
        yield
    finally:
        _LISTENER.reset(token)
