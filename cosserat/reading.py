"""Files that people give: read as text, up to a size."""

from __future__ import annotations

import errno
from pathlib import Path

MOST_BYTES = 30_000_000
"""Of a table that belongs to a publication; devices give bytes without end."""


def read_text(file: Path, most: int = MOST_BYTES) -> str:
    """The text of a file of at most so many bytes, with the ends of lines and without the mark of other systems.

    Raises
    ------
    OSError : it cannot be read, or is larger.  UnicodeDecodeError : it is not in UTF-8.
    """
    try:
        with file.open("rb") as opened:
            found = opened.read(most + 1)
    except ValueError:  # a zero byte, or half a character
        raise OSError(errno.EINVAL, "no file has such a name") from None
    if len(found) > most:
        raise OSError(errno.EFBIG, f"it is larger than {most / 1e6:g} MB")
    return found.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
