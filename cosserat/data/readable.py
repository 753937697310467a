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
    try:
        size = path.stat().st_size
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}; run its case again") from None
    seconds = _TIME + size / _SPEED
    try:
        answer = _reader.answer(path, _MEMORY + _COPIES * size, seconds)
    except TimeoutError:
        raise InputError(
            f"{path} is damaged, or this machine very busy: reading it did not end in {seconds:.0f} s; try again, or "
            "run its case again"
        ) from None
    if answer != "read":
        raise InputError(
            f"cannot read {path}: it is no netCDF file, or damaged; give a result of cosserat, or run its case again"
        )


class _End:
    """An end of a pipe, by its descriptor: a program may close all there are, and get its number for another file."""

    def __init__(self, descriptor: int) -> None:
        self.descriptor = descriptor
        self._known = os.fstat(descriptor)

    @property
    def open(self) -> bool:
        """Whether it is still this end."""
        try:
            return os.path.samestat(os.fstat(self.descriptor), self._known)
        except OSError:
            return False

    def close(self) -> None:
        """Close it, if it is."""
        if self.open:
            os.close(self.descriptor)


class _Reader:
    """The process that tries files."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._ends: tuple[_End, ...] = ()  # to write to, and to read from

    def answer(self, path: Path, memory: int, seconds: float) -> str:
        """What it says of a file; nothing if the file ended it twice, since once may be somebody's kill.

        Raises
        ------
        TimeoutError : there is no answer in time.
        """
        request = json.dumps([os.path.realpath(path), memory, seconds]) + "\n"
        try:
            for _ in range(2):
                self._start()
                if said := self._asked(request.encode(), seconds):
                    return said
                self.end()
        except BaseException:  # also of a signal: the next answer would be that of this file
            self.end()
            raise
        return ""

    def end(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            with suppress(OSError):
                self._process.wait()
        self.forget()

    def forget(self) -> None:
        """Leave it to the process from which this one was forked."""
        process, self._process = self._process, None
        if process is not None and process.returncode is None:
            process.returncode = 0  # as far as this one may know
        ends, self._ends = self._ends, ()
        for one in ends:
            one.close()

    def _start(self) -> None:
        """Have the process ready for a file.

        Raises
        ------
        InputError : it does not start.
        """
        running = self._process is not None and self._process.poll() is None
        if running and all(one.open for one in self._ends):
            return
        self.end()
        # -P: nothing beside the program is a library; what this process finds on its path, it finds too
        alone = "-I" if sys.flags.isolated else "-P"
        command = [sys.executable or "python3", alone, str(_PROGRAM), *map(str, sys.path)]
        try:
            heard, say = os.pipe()
            self._ends = (_End(say),)
            try:
                hear, said = os.pipe()
            except OSError:
                os.close(heard)
                raise
            self._ends = (_End(say), _End(hear))
            try:
                self._process = subprocess.Popen(
                    command, stdin=heard, stdout=said, stderr=subprocess.DEVNULL, start_new_session=True
                )
            finally:
                os.close(heard)
                os.close(said)
            ready = self._line(_START) == "ready"
        except OSError as error:
            raise InputError(_no_start(str(error.strerror or error))) from None
        if not ready:
            raise InputError(_no_start(f"{command[0]} ended at once: it lacks memory, or netCDF4"))

    def _asked(self, request: bytes, seconds: float) -> str:
        try:
            os.write(self._ends[0].descriptor, request)
        except BrokenPipeError:
            return ""
        return self._line(seconds)

    def _line(self, seconds: float) -> str:
        """The next line that the process writes, without its end; nothing if the process has ended."""
        line = b""
        with selectors.DefaultSelector() as waiting:
            waiting.register(self._ends[1].descriptor, selectors.EVENT_READ)
            while not line.endswith(b"\n"):
                if not waiting.select(seconds):
                    raise TimeoutError(f"it said nothing for {seconds:.0f} s")
                if not (more := os.read(self._ends[1].descriptor, 1000)):
                    return ""
                line += more
        return line[:-1].decode()


def _no_start(why: str) -> str:
    return f"cannot start the process that tries a file before it is read ({why}); end other programs and try again"


_reader = _Reader()
atexit.register(_reader.end)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_reader.forget)
