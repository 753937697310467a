"""The one door: a case in, a Dataset out."""

from __future__ import annotations

import xarray as xr

from cosserat.cases.catalogue import Case, find
from cosserat.data.dataset import to_dataset


def run(case: Case | str) -> xr.Dataset:
    """Solve a case, given itself or by the name of a published one.

    The Snakemake rule, a notebook and a script all come through here.

    Raises
    ------
    InputError : no case of that name, or its rod is not supported.
    NotConvergedError : no solution within the tolerance.
    """
    known = find(case) if isinstance(case, str) else case
    return to_dataset(known, known.problem.solve(f"case '{known.name}'"))
