"""One writer at a time for each result, by locks of the operating system that end with their process.

NFS and Lustre pass them on to other machines unless they are mounted otherwise; some file systems never do.
"""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator
from pathlib import Path

import filelock

from cosserat.errors import CosseratWarning, InputError

_PATIENCE = 0.2  # seconds in which a run that is just ending lets go
_MOUNTS = Path("/proc/self/mounts")  # of Linux: what is mounted, where, its type and its options
_WITHOUT = {
    "nfs": ("nolock", "local_lock=flock", "local_lock=all"),
    "lustre": ("localflock",),
    "cifs": ("nobrl",),
}
"""Options with which these file systems keep locks to one machine."""
_NEVER = ("9p", "virtiofs", "vboxsf", "fuse.sshfs", "fuse.rclone", "fuse.s3fs", "fuse.vmhgfs-fuse")
"""Shared file systems that always do."""


@contextlib.contextmanager
def only_writer(path: Path) -> Iterator[None]:
    """Hold the lock of a result; other processes, and machines that share the folder, are refused meanwhile.

    The lock is on a file ".NAME.lock" beside the result, which goes with it.  A process that holds the lock may ask for
    it again.  Where the file system has no locks, or none that other machines see, a warning says so.

    Raises
    ------
    InputError : another process writes this result.
    """
    path = path.resolve()
    file = path.with_name(f".{path.name}.lock")
    lock = filelock.FileLock(file, timeout=_PATIENCE, is_singleton=True, fallback_to_soft=False)
    try:
        held = lock.acquire()
    except filelock.Timeout:
        raise InputError(
            f"another run is writing {path}; wait for its end, or choose another file with --output"
        ) from None
    except (OSError, NotImplementedError) as error:
        warnings.warn(
            f"the folder {path.parent} takes no locks ({error}); see to it that no other run writes {path.name}",
            CosseratWarning,
            stacklevel=3,
        )
        yield
        return
    with held:
        if lock.lock_counter == 1 and (kind := keeps_locks_here(path.parent)):
            warnings.warn(
                f"the file system of {path.parent} ({kind}) takes locks for this machine alone; see to it that no run "
                f"on another one writes {path.name}",
                CosseratWarning,
                stacklevel=3,
            )
        try:
            yield
        finally:
            if lock.lock_counter == 1:
                with contextlib.suppress(OSError):
                    file.unlink()


def keeps_locks_here(folder: Path) -> str:
    """The type of a file system whose locks other machines do not see; empty if they do, or if nobody shares it."""
    try:
        lines = [line.split() for line in _MOUNTS.read_text(errors="replace").splitlines()]
    except OSError:
        return ""
    above = {str(one) for one in (folder, *folder.parents)}
    found = [(place.replace("\\040", " "), kind, options) for _, place, kind, options, *_ in lines]
    _, kind, options = max(
        (one for one in found if one[0] in above), key=lambda one: len(one[0]), default=("", "", "")
    )
    without = _WITHOUT.get("nfs" if kind == "nfs4" else kind, ())
    return kind if kind in _NEVER or set(without) & set(options.split(",")) else ""
