"""Files that are whole or absent, checked before anything is computed for them."""

from __future__ import annotations

import contextlib
import glob
import os
import platform
import signal
import threading
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

from cosserat.errors import InputError


def check_destination(path: Path, *suffixes: str) -> None:
    """Raise InputError for a file that cannot be written, before anything is computed.

    Raises
    ------
    InputError : the folder is missing or cannot be written to, or the path is a folder, a device or of another kind.
    """
    remedy = "choose another with --output"
    try:
        path.exists()
    except (OSError, ValueError) as error:
        raise InputError(f"{path} cannot name a file ({error}); {remedy}") from None
    if not path.parent.is_dir():
        raise InputError(f"the folder {path.parent} does not exist; make it first or {remedy}")
    if path.is_dir():
        raise InputError(f"{path} is a folder; give the name of a file with --output")
    if path.exists() and not path.is_file():
        raise InputError(f"{path} is not a regular file; {remedy}")
    if not os.access(path.parent, os.W_OK):
        raise InputError(f"the folder {path.parent} cannot be written to; {remedy}")
    if suffixes and path.suffix not in suffixes:
        written = " or ".join(suffix[1:] for suffix in suffixes)
        ends = " or ".join(f"'{suffix}'" for suffix in suffixes)
        raise InputError(f"{path} would be written as {written}; let its name end in {ends}")


@contextlib.contextmanager
def whole_or_absent(path: Path) -> Iterator[Path]:
    """A temporary file beside `path`; it replaces `path` when the block succeeds.

    Temporary files of killed processes of this machine for the same `path` are deleted first.

    Raises
    ------
    InputError : the system refuses to write.
    """
    ours = f".{path.name}.{platform.node()}."
    temporary = path.with_name(f"{ours}{os.getpid()}.part")
    try:
        for left in path.parent.glob(f"{glob.escape(ours)}*.part"):
            if not _is_running(left.name.removeprefix(ours).removesuffix(".part")):
                left.unlink(missing_ok=True)
        yield temporary
        temporary.replace(path)
    except OSError as error:
        reason = error.strerror or error
        raise InputError(f"cannot write {path}: {reason}; check name, space and permissions") from None
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink()


def _is_running(process: str) -> bool:
    """Whether a process of this machine, by its number, is alive; True if it is not a number: another's file."""
    if not process.isdecimal():
        return True
    try:
        os.kill(int(process), 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        return True
    return True


@contextlib.contextmanager
def uninterrupted() -> Iterator[None]:
    """Delay a Ctrl-C until the block has ended: inside, it would leave xarray's locks taken for ever.

    Only Python's main thread is interrupted; in other threads this does nothing.
    """
    if (
        threading.current_thread() is not threading.main_thread()
        or signal.getsignal(signal.SIGINT) is None
    ):
        yield
        return
    waiting: list[tuple[int, FrameType | None]] = []
    usual = signal.signal(signal.SIGINT, lambda number, frame: waiting.append((number, frame)))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, usual)
        if waiting and callable(usual):
            usual(*waiting[0])
