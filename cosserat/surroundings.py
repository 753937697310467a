"""What a process finds around itself: its three streams, its current folder, its way to show pictures."""

from __future__ import annotations

import os
import sys


def open_streams() -> None:
    """Give streams that a shell closed to nobody; else the next file that is opened would take their place."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115 - for as long as the process lives


def show_no_windows() -> None:
    """Forget how pictures are shown on a screen: the command line only writes files, and need not have that library."""
    os.environ.pop("MPLBACKEND", None)


def has_current_folder() -> bool:
    """Whether the current folder is still there."""
    try:
        os.getcwd()
    except OSError:
        return False
    return True
