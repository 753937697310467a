"""Stored results of published cases and studies, as the workflow lays them out."""

from __future__ import annotations

import json
from pathlib import Path

import xarray as xr

from cosserat.data.netcdf import load, load_case
from cosserat.errors import InputError
from cosserat.studies.door import published_studies

STUDIES = "studies"
"""Folder of the answers of studies, beside that of the results of cases."""


def stored(folder: Path, name: str) -> xr.Dataset:
    """The result of a published case, or the answer of a published study; folder : of the cases.

    Raises
    ------
    InputError : the file is missing, damaged, changed, or holds something else.
    """
    if name not in published_studies():
        return load_case(folder, name)
    path = folder.parent / STUDIES / f"{name}.nc"
    answer = load(path, own=True)
    if json.loads(answer.attrs.get("study", "{}")).get("name") != name:
        raise InputError(f"{path} does not hold the study '{name}'; solve it again")
    return answer
