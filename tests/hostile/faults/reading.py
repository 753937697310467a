"""How `cosserat.load` reads files, each in a child that can be stopped: `python reading.py RIGHT FILE ...`.

A line for each file: "same" content as RIGHT, "refused" by its name, "said to be changed" by another program, or what
is not as promised.
"""

from __future__ import annotations

import os
import signal
import sys
import time
import warnings
from pathlib import Path

import xarray as xr

import cosserat
from cosserat.errors import CosseratError, CosseratWarning

LONGEST = 10.0
"""Seconds that a file may take."""
VERDICTS = (
    "same",
    "refused",
    "said to be changed",
    "read as other content without a word",
    "refused in other than one sentence with the file's name",
    "an exception that is none of the package's",
)
HANGS, DIES = f"no end within {LONGEST:g} s", "the process dies"


def verdict(path: Path, right: xr.Dataset) -> str:
    """How one file is read."""
    child = os.fork()
    if child == 0:
        os._exit(_read(path, right))
    until = time.monotonic() + LONGEST
    while time.monotonic() < until:
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            code = os.waitstatus_to_exitcode(status)
            return VERDICTS[code] if code >= 0 else DIES
        time.sleep(0.001)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return HANGS


def _read(path: Path, right: xr.Dataset) -> int:
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    try:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            same = cosserat.load(path).identical(right)
        words = any(issubclass(one.category, CosseratWarning) for one in told)
        return 0 if same else 2 if words else 3
    except CosseratError as error:
        return 1 if path.name in str(error) and "\n" not in str(error) else 4
    except BaseException:
        return 5


def main(right: str, *files: str) -> None:
    """Print how each of the files is read."""
    dataset = cosserat.load(right)
    for file in files:
        print(verdict(Path(file), dataset), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
