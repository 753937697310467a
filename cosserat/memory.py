"""A limit of memory: a process that watches the one that works, since libraries do not bear its lack.

LLVM and HDF5 end a process that gets no memory, with words of their own or without any, and OpenBLAS asks for its work
space for ever, deaf to signals.  So under a limit ('ulimit -v', or that of a batch system) the work is done in a child,
and its parent says what became of it.  Without a limit there is one process.
"""

from __future__ import annotations

import contextlib
import io
import math
import os
import signal
import sys
from types import FrameType

from cosserat.signals import SIGNALS, Stopped

LEAST = 1_000_000_000
"""Bytes of address space that a small run needs: most are those of compilers and of linear algebra."""
_LATEST = 5  # seconds in which a child ends after a signal
_DEATHS = (signal.SIGSEGV, signal.SIGABRT, signal.SIGBUS)
_WITH_PARENT = 1  # of <sys/prctl.h>: the signal when the parent ends
_MACHINE, _OWN = "/proc/meminfo", "/proc/self/statm"


def watched(limit: int) -> int | None:
    """Go on in a child process under a limit [bytes]; returns None there, and in the parent the child's exit status.

    Signals to end are blocked in the child, which minds them first.
    """
    signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    if limit < LEAST:
        return _failed(
            f"the limit of {limit / 1e6:.0f} MB of address space is too small, cosserat needs {LEAST / 1e6:.0f} MB; "
            "raise it by 'ulimit -v', or ask the batch system for more memory"
        )
    words = os.memfd_create("words")
    child = os.fork()
    if child == 0:
        _end_with_parent()
        _keep_words_of_libraries(words)
        _reserve()
        return None
    number, status = _end_of(child)
    code = os.waitstatus_to_exitcode(status)
    if number is not None and code < 0:
        stopped = Stopped(number)
        print(f"cosserat: {stopped}", file=sys.stderr)
        return stopped.status
    if -code in _DEATHS:
        return _failed(
            f"there is not enough memory: a library gave up under the limit of {limit / 1e6:.0f} MB of address space; "
            "use fewer vertices, sections, elements or frames, or raise the limit by 'ulimit -v'"
        )
    os.lseek(words, 0, os.SEEK_SET)
    with contextlib.suppress(OSError):  # nobody may read them any more
        os.write(2, os.read(words, 1 << 20))
    if code < 0:
        with contextlib.suppress(OSError):  # of SIGKILL
            signal.signal(-code, signal.SIG_DFL)
        os.kill(os.getpid(), -code)
    return code


def free() -> float:
    """Memory that this process can still get [bytes]: of the machine, and under its limit; all there is elsewhere."""
    found = [math.inf]
    with contextlib.suppress(OSError, ValueError):
        with open(_MACHINE) as file:
            lines = dict(line.split(":", 1) for line in file)
        found.append(1024.0 * int(lines["MemAvailable"].split()[0]))
    if (limit := limit_of_memory()) is not None:
        with contextlib.suppress(OSError):
            with open(_OWN) as file:
                pages = int(file.read().split()[0])
            found.append(float(limit - pages * os.sysconf("SC_PAGE_SIZE")))
    return min(found)


def limit_of_memory() -> int | None:
    """Most address space of this process [bytes]; None where there is no limit."""
    if sys.platform != "linux":
        return None
    import resource

    found = resource.getrlimit(resource.RLIMIT_AS)[0]
    return None if found == resource.RLIM_INFINITY else found


def _failed(sentence: str) -> int:
    print(f"cosserat: {sentence}", file=sys.stderr)
    return 2


def _end_with_parent() -> None:
    import ctypes

    ctypes.CDLL(None).prctl(_WITH_PARENT, signal.SIGKILL)


def _keep_words_of_libraries(file: int) -> None:
    """Let what compiled code prints as an error go into a file; Python's own words go where they went."""
    if sys.stderr is None:
        return
    usual = sys.stderr
    kept = open(os.dup(2), "wb", 0)  # noqa: SIM115 - for as long as the process lives
    sys.stderr = io.TextIOWrapper(kept, usual.encoding, usual.errors, write_through=True)
    os.dup2(file, 2)


def _reserve() -> None:
    """Let both libraries of linear algebra take their work space as long as there is some."""
    import numpy as np
    from scipy.linalg import blas

    matrix = np.eye(300)
    blas.dgemm(1.0, matrix, matrix)
    blas.dtbsv(2, np.ones((3, 300)), matrix[0])
    matrix @ matrix


def _end_of(child: int) -> tuple[int | None, int]:
    """Wait for a child that hears of signals to end, and is killed if it stays; returns the signal and its end."""
    heard: list[int] = []

    def tell(number: int, _: FrameType | None) -> None:
        heard.append(number)
        os.kill(child, number)
        signal.alarm(_LATEST)

    signal.signal(signal.SIGALRM, lambda *_: os.kill(child, signal.SIGKILL))
    for one in SIGNALS:
        if signal.getsignal(one) is not signal.SIG_IGN:
            signal.signal(one, tell)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
    _, status = os.waitpid(child, 0)
    signal.alarm(0)
    return heard[0] if heard else None, status
