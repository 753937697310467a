"""Whether a netCDF file can be read, found out in a process that can be stopped.

A damaged file can keep HDF5 for ever, or end the process that reads it.  One process tries all the files of a program;
it starts with the first of them and is started again after one that it did not survive.
"""

from __future__ import annotations

import atexit
import json
import os
import selectors
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

from cosserat.errors import InputError

_PROGRAM = Path(__file__).with_name("probe.py")
_START = 60.0  # seconds for the start of the process, on a busy machine or a slow disk
_TIME = 6.0  # seconds for a file, and more by its size
_SPEED = 1e7  # bytes a second of a slow disk
_MEMORY = 2 << 30  # bytes, and more by the size
_COPIES = 20  # of a file in memory
_WITHOUT = sys.platform == "emscripten"
"""A page has no second process; the browser stops a page that does not answer."""


def check_readable(path: Path) -> None:
    """Raise InputError if a file cannot be read with limited time and memory; one thread at a time may ask."""
    if _WITHOUT:
        return
    size = path.stat().st_size
    seconds = _TIME + size / _SPEED
    try:
        answer = _reader.answer(path, _MEMORY + _COPIES * size, seconds)
    except TimeoutError:
        raise InputError(
            f"{path} is damaged: reading it did not end in {seconds:.0f} s; delete it and run its case again"
        ) from None
    if answer != "read":
        raise InputError(
            f"cannot read {path}: it is no netCDF file, or damaged; give a result of cosserat, or run its case again"
        )


class _Reader:
    """The process that tries files."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None

    def answer(self, path: Path, memory: int, seconds: float) -> str:
        """What it says of a file; nothing if the file ended it twice, since once may be somebody's kill.

        Raises
        ------
        TimeoutError : there is no answer in time.
        """
        request = [str(path.absolute()), memory, seconds]
        try:
            for _ in range(2):
                if said := _asked(self._started(), request, seconds):
                    return said
                self.end()
        except BaseException:  # also of a signal: the next answer would be that of this file
            self.end()
            raise
        return ""

    def end(self) -> None:
        """End the process."""
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            with suppress(OSError), process:
                pass

    def forget(self) -> None:
        """Leave it to the process from which this one was forked."""
        process, self._process = self._process, None
        if process is not None:
            process.returncode = 0  # as far as this one may know
            with suppress(OSError), process:
                pass

    def _started(self) -> subprocess.Popen[str]:
        """The process, ready for a file.

        Raises
        ------
        InputError : it does not start.
        """
        if self._process is not None and self._process.poll() is None:
            return self._process
        self.end()
        command = [
            sys.executable or "python3",
            "-P",
            str(_PROGRAM),
        ]  # -P: nothing beside it is a library
        pipe, away = subprocess.PIPE, subprocess.DEVNULL
        try:
            process = subprocess.Popen(
                command, stdin=pipe, stdout=pipe, stderr=away, text=True, start_new_session=True
            )
            self._process = process
            ready = _line(process, _START) == "ready"
        except OSError as error:
            raise InputError(_no_start(str(error.strerror or error))) from None
        if not ready:
            raise InputError(_no_start(f"{command[0]} ended at once: it lacks memory, or netCDF4"))
        return process


def _no_start(why: str) -> str:
    return f"cannot start the process that tries a file before it is read ({why}); end other programs and try again"


def _asked(process: subprocess.Popen[str], request: list[object], seconds: float) -> str:
    assert process.stdin is not None
    try:
        process.stdin.write(json.dumps(request) + "\n")
        process.stdin.flush()
    except BrokenPipeError:
        return ""
    return _line(process, seconds)


def _line(process: subprocess.Popen[str], seconds: float) -> str:
    """The next line that a process writes, without its end; nothing if the process has ended."""
    assert process.stdout is not None
    with selectors.DefaultSelector() as waiting:
        waiting.register(process.stdout, selectors.EVENT_READ)
        if not waiting.select(seconds):
            raise TimeoutError(f"it said nothing for {seconds:.0f} s")
    return process.stdout.readline().rstrip("\n")


_reader = _Reader()
atexit.register(_reader.end)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_reader.forget)
