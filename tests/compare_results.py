"""Compare two folders of results, of the code before a change and after: `python -m tests.compare_results OLD NEW`.

Prints the largest change of every variable of every case, and fails if one is larger than allowed: with `--bits` none
at all, else 1e-9 of the variable's largest value or its round-off floor.  Variables and labels that were renamed are
compared by the table below.  Variables that follow from others, the attribute `derived` names them, may be new.  The
attributes `source` and `parameters` may differ; every other one may not.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

import numpy as np
import xarray as xr

import cosserat
from cosserat.data.dataset import without_derived
from cosserat.data.variables import VARIABLES

RENAMED = {"unknown": "dof", "refused_increments": "cutbacks", "branchings": "branch_switches"}
"""Old name of a variable, a dimension or a statistic -> its new name."""
EXEMPT = ("source", "parameters")
RELATIVE = 1e-9
REMAINDERS = ("residual_N", "rounding_N", "tolerance_N", "judged_kinetic_J", "unresolved_kinetic_J")
"""Statistics that are round-off, or follow it; the counts of iterations, cutbacks and steps may not change."""


def changes(old: xr.Dataset, new: xr.Dataset, *, bits: bool) -> list[tuple[str, float, bool]]:
    """Name, largest change and whether it is allowed, of every variable; a fault of another kind counts as infinite."""
    names = {key: RENAMED[key] for key in map(str, (*old.variables, *old.dims)) if key in RENAMED}
    old = old.rename(names)
    if "derived" not in old.attrs:
        new = without_derived(new)
    found = [
        (f"variable {name} is in one of both only", np.inf, False)
        for name in set(old.variables) ^ set(new.variables)
    ]
    for name in (key for key in new.variables if key in old.variables):
        before, after = old[name], new[name]
        if (
            before.dims != after.dims
            or before.shape != after.shape
            or before.dtype.kind != after.dtype.kind
        ):
            found.append((f"{name} has another shape", np.inf, False))
        elif before.dtype.kind == "f":
            change = float(np.abs(before.to_numpy() - after.to_numpy()).max(initial=0.0))
            floor = VARIABLES[str(name)].floor
            allowed = 0.0 if bits else RELATIVE * float(np.abs(before).max()) + floor
            found.append((str(name), change, change <= allowed))
        else:
            found.append((str(name), 0.0, list(before.to_numpy()) == list(after.to_numpy())))
        if str(name) not in RENAMED.values() and dict(before.attrs) != dict(after.attrs):
            found.append((f"attributes of {name}", np.inf, False))
    before_run, after_run = (json.loads(data.attrs.get("solver", "{}")) for data in (old, new))
    for key in sorted({RENAMED.get(key, key) for key in before_run} | set(after_run)):
        was = {RENAMED.get(name, name): value for name, value in before_run.items()}.get(key)
        same = was in (None, after_run.get(key)) or (not bits and key in REMAINDERS)  # None: a new one
        found.append((f"statistic {key}: {was} -> {after_run.get(key)}", 0.0 if same else np.inf, same))
    for key in sorted((set(old.attrs) | set(new.attrs)) - set(EXEMPT) - {"solver"}):
        if old.attrs.get(key) != new.attrs.get(key):
            found.append((f"attribute {key}", np.inf, False))
    return found


def main(arguments: list[str] | None = None) -> int:
    """Compare; 0 if all is as allowed."""
    parser = argparse.ArgumentParser(prog="python -m tests.compare_results", description=__doc__)
    parser.add_argument("old", type=Path, help="folder of netCDF files")
    parser.add_argument("new", type=Path, help="folder of netCDF files")
    parser.add_argument("--bits", action="store_true", help="allow no change at all")
    options = parser.parse_args(arguments)
    before, after = ({p.name for p in folder.glob("*.nc")} for folder in (options.old, options.new))
    faults = [f"{name} is in one of both folders only" for name in sorted(before ^ after)]
    for name in sorted(before & after):
        pair = [cosserat.load(folder / name) for folder in (options.old, options.new)]
        for variable, change, allowed in changes(*pair, bits=options.bits):
            if change or not allowed:
                print(f"{name:45} {variable:35} {change:.3g}{'' if allowed else '  NOT ALLOWED'}")
            if not allowed:
                faults.append(f"{name}: {variable}")
    print(f"{len(before & after)} files compared, {len(faults)} faults")
    return 1 if faults or not before & after else 0


if __name__ == "__main__":
    sys.exit(main())
