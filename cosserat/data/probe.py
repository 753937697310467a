"""Reads a netCDF file whole and says nothing: `python probe.py FILE BYTES`, in a process that can be stopped.

It exits with 0 if everything can be read with at most so many bytes of memory.  It imports nothing of cosserat.
"""

import resource
import sys

import netCDF4


def read(group: netCDF4.Dataset) -> None:
    """Read all attributes and variables of a group, and of the groups in it."""
    group.__dict__  # noqa: B018 - reads the attributes
    for variable in group.variables.values():
        variable.__dict__  # noqa: B018
        variable[...]
    for inner in group.groups.values():
        read(inner)


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_AS, (int(sys.argv[2]),) * 2)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with netCDF4.Dataset(sys.argv[1]) as whole:
        read(whole)
