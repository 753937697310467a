"""What the workflow has stored, as chapters read it."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from cosserat.data.netcdf import load
from cosserat.errors import InputError


def results() -> Path:
    """The folder `results` of this checkout, from any working directory in it."""
    for folder in (Path.cwd(), *Path.cwd().parents):
        if (folder / "results" / "tolerances.csv").is_file():
            return folder / "results"
    raise InputError(
        f"no results/tolerances.csv above {Path.cwd()}; run the chapter inside a checkout of cosserat"
    )


def data(case: str) -> xr.Dataset:
    """The stored Dataset of a case."""
    return load(results() / "cases" / f"{case}.nc")


def study(name: str) -> xr.Dataset:
    """The stored answer of a published study."""
    return load(results() / "studies" / f"{name}.nc")
