"""Files that are whole or absent, checked before anything is computed for them."""

from __future__ import annotations

import contextlib
import errno
import glob
import os
import platform
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path

from cosserat.errors import InputError, path_of
from cosserat.progress import size

_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def check_destination(path: Path, *suffixes: str, inputs: Sequence[Path] = ()) -> None:
    """Raise InputError for a file that cannot be written, before anything is computed.

    inputs : files that are read, which it may not replace.

    Raises
    ------
    InputError : the folder is missing or cannot be written to, or the path is a folder, a device, of another kind or
        an input.
    """
    remedy = "choose another with --output"
    path_of(path)
    if not path.parent.is_dir():
        raise InputError(f"the folder {path.parent} does not exist; make it first or {remedy}")
    if path.is_dir():
        raise InputError(f"{path} is a folder; give the name of a file with --output")
    if path.exists() and not path.is_file():
        raise InputError(f"{path} is not a regular file; {remedy}")
    if not os.access(path.parent, os.W_OK):
        raise InputError(f"the folder {path.parent} cannot be written to; {remedy}")
    if any(path.exists() and given.exists() and path.samefile(given) for given in inputs):
        raise InputError(f"{path} is also read, and would be replaced; {remedy}")
    if suffixes and path.suffix not in suffixes:
        written = " or ".join(suffix[1:] for suffix in suffixes)
        ends = " or ".join(f"'{suffix}'" for suffix in suffixes)
        raise InputError(f"{path} would be written as {written}; let its name end in {ends}")
    if path.suffix == ".nc":
        netcdf_path(path)


def netcdf_path(path: Path) -> Path:
    """The path for netCDF, to which a backslash is a slash, and for xarray, to which a first "~" is a home.

    Raises
    ------
    InputError : it would be the path of another file.
    """
    whole = path.absolute()
    if os.sep == "/" and "\\" in str(whole):
        raise InputError(
            f"{path} has a backslash, which netCDF takes for a slash; take a name without it"
        )
    return whole


@contextlib.contextmanager
def whole_or_absent(path: Path, need: int | None = None) -> Iterator[Path]:
    """A temporary file beside `path`; it replaces `path` when the block succeeds.

    Temporary files of killed processes of this machine for the same `path` are deleted first.  A link is followed: the
    file that it leads to is replaced.

    need : number of bytes that will be written, for the sentence about a full disk, if it is known.

    Raises
    ------
    InputError : the system refuses to write.
    """
    path = path.resolve() if path.is_symlink() else path
    ours = f".{path.name}.{platform.node()}."
    temporary = path.with_name(f"{ours}{os.getpid()}.part")
    try:
        for left in path.parent.glob(f"{glob.escape(ours)}*.part"):
            if not _is_running(left.name.removeprefix(ours).removesuffix(".part")):
                left.unlink(missing_ok=True)
        yield temporary
        temporary.replace(path)
    except OSError as error:
        raise refusal(error, path, temporary, need) from None
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink()


def refusal(error: OSError, path: Path, temporary: Path, need: int | None = None) -> InputError:
    """The error for a system that refuses to write, with the remedy.

    temporary : the file or the folder with what was written so far.  need : number of bytes, if it is known.
    """
    reason = error.strerror or str(error)
    free = shutil.disk_usage(path.parent).free if path.parent.is_dir() else 0
    if error.errno not in _FULL and (need is None or free > need):
        return InputError(f"cannot write {path}: {reason}; check name, space and permissions")
    files = temporary.rglob("*") if temporary.is_dir() else [temporary]
    written = sum(file.stat().st_size for file in files if file.is_file())
    needed = f"more than {size(written)}" if need is None else size(need)
    room = f"it needs {needed}, and {size(free)} are free in {path.parent}"
    return InputError(f"cannot write {path}: {reason}: {room}; free some space or choose another disk")


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
