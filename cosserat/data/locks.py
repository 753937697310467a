"""One writer at a time for each result, by locks of the operating system that end with their process."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator
from pathlib import Path

import filelock

from cosserat.errors import CosseratWarning, InputError

_PATIENCE = 0.2  # seconds in which a run that is just ending lets go


@contextlib.contextmanager
def only_writer(path: Path) -> Iterator[None]:
    """Hold the lock of a result; other processes, and machines that share the folder, are refused meanwhile.

    The lock is on a file ".NAME.lock" beside the result, which goes with it.  A process that holds the lock may ask for
    it again.  Where the file system has no locks, a warning says so.

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
        try:
            yield
        finally:
            if lock.lock_counter == 1:
                with contextlib.suppress(OSError):
                    file.unlink()
