"""Reads netCDF files whole, one after another, in a process that can be stopped: `python probe.py FOLDER...`.

The folders are further ones in which libraries may be.
Each line of its input is a list in JSON: the path of a file, the most memory [bytes] and the most CPU time [s].  The
answer is a line, `read` or `failed`.  It ends with its input.  It imports nothing of cosserat.
"""

import contextlib
import json
import resource
import sys

sys.path += sys.argv[1:]
import netCDF4


def read(group: netCDF4.Dataset) -> None:
    """Read all attributes and variables of a group, and of the groups in it."""
    group.__dict__  # noqa: B018 - reads the attributes
    for variable in group.variables.values():
        variable.__dict__  # noqa: B018
        variable[...]
    for inner in group.groups.values():
        read(inner)


def answer(path: str) -> str:
    """Whether everything in a file can be read."""
    try:
        with netCDF4.Dataset(path) as whole:
            read(whole)
    except Exception:  # the libraries may say anything about what is in it
        return "failed"
    return "read"


def say(word: str) -> None:
    """Write a line, in bytes that no setting of the environment changes."""
    sys.stdout.buffer.write(word.encode() + b"\n")
    sys.stdout.buffer.flush()


def limit(which: int, most: int) -> None:
    """Set a limit of this process, as far as its parent may."""
    hard = resource.getrlimit(which)[1]
    resource.setrlimit(which, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))


if __name__ == "__main__":
    limit(resource.RLIMIT_CORE, 0)
    with contextlib.suppress(BrokenPipeError):
        say("ready")
        for line in sys.stdin.buffer:
            path, memory, seconds = json.loads(line)
            spent = resource.getrusage(resource.RUSAGE_SELF)
            limit(resource.RLIMIT_AS, memory)
            limit(resource.RLIMIT_CPU, int(spent.ru_utime + spent.ru_stime + seconds) + 1)
            say(answer(path))
