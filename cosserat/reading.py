"""Files that people give: read as text, up to a size."""

from __future__ import annotations

import errno
import os
import select
import stat
from pathlib import Path

MOST_BYTES = 30_000_000
"""Of a table that belongs to a publication; devices give bytes without end."""
_WAIT = 5.0  # seconds for somebody who writes to a pipe


def read_text(file: Path, most: int = MOST_BYTES) -> str:
    """The text of a file of at most so many bytes, with the ends of lines and without the mark of other systems.

    Raises
    ------
    OSError : it cannot be read, or is larger.  UnicodeDecodeError : it is not in UTF-8.
    """
    try:
        with os.fdopen(_opened(file), "rb") as opened:
            found = opened.read(most + 1)
    except ValueError:  # a zero byte, or half a character
        raise OSError(errno.EINVAL, "no file has such a name") from None
    if len(found) > most:
        raise OSError(errno.EFBIG, f"it is larger than {most / 1e6:g} MB")
    return found.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")


def _opened(file: Path) -> int:
    """The descriptor of a file, to read.

    Raises
    ------
    OSError : it cannot be read, or is a pipe to which nobody writes.
    """
    descriptor = os.open(file, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    kind = os.fstat(descriptor).st_mode
    if stat.S_ISDIR(kind):
        os.close(descriptor)
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if stat.S_ISFIFO(kind):
        if not select.select([descriptor], [], [], _WAIT)[0]:
            os.close(descriptor)
            raise OSError(errno.ENODATA, "nobody writes to this pipe")
        os.set_blocking(descriptor, True)
    return descriptor
