"""The digest at the end of every file that cosserat writes: SHA-256 of all bytes before it.

It is looked at before HDF5 opens the file: a damaged file can hang that library or give other numbers without a word.
HDF5 ignores what stands behind its own bytes, so other programs read these files as usual.  A program that changes one
cuts the digest off.
"""

from __future__ import annotations

import hashlib
import os
import re
from pathlib import Path
from typing import BinaryIO

_MARK = b"\ncosserat sha256:"
_HEX = 64
_LENGTH = len(_MARK) + _HEX + 1
_BLOCK = 1 << 20  # bytes read at once
_REMNANT = 6
"""So many bytes of the mark in their order tell a damaged digest from none."""


class DamagedError(Exception):
    """The bytes of a file are not those that its digest was made from."""


def seal(path: Path) -> None:
    """Put the digest of a file behind its bytes."""
    with path.open("rb+") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
        file.write(_MARK + digest.encode() + b"\n")


def digest_of(path: Path) -> str | None:
    """The digest that a file ends with, after all its bytes were compared with it; None if it has none.

    Raises
    ------
    OSError : the file cannot be read.
    DamagedError : the bytes have another digest, or only a part of the mark is left.
    """
    with path.open("rb") as file:
        size = os.fstat(file.fileno()).st_size
        end = _end(file, size)
        stored = re.fullmatch(re.escape(_MARK) + rb"([0-9a-f]{%d})\n" % _HEX, end[-_LENGTH:])
        if stored is None:
            if _is_marked(end):
                raise DamagedError
            return None
        file.seek(0)
        found, left = hashlib.sha256(), size - _LENGTH
        while left > 0:
            block = file.read(min(left, _BLOCK))
            found.update(block)
            left -= len(block) or left
    if found.hexdigest().encode() != stored[1]:
        raise DamagedError
    return found.hexdigest()


def is_marked(path: Path) -> bool:
    """Whether a file ends with a digest, perhaps a damaged one, so that cosserat wrote it.

    Raises
    ------
    OSError : the file cannot be read.
    """
    with path.open("rb") as file:
        return _is_marked(_end(file, os.fstat(file.fileno()).st_size))


def _end(file: BinaryIO, size: int) -> bytes:
    file.seek(max(0, size - 2 * _LENGTH))
    return file.read()


def _is_marked(end: bytes) -> bool:
    return any(_MARK[k : k + _REMNANT] in end for k in range(len(_MARK) - _REMNANT + 1))
