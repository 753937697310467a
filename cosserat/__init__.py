"""Directed rods of Green and Naghdi's kind: solvers for E. G. Hemingway's thesis (Berkeley, 2020), and for your rod.

import cosserat
beam = cosserat.run("clamped_free")                       # a published case, as an xarray.Dataset
long = cosserat.case("clamped_free").vary("long", rod={"length": "10 m"})
print(cosserat.run(long).u.sel(axis="E2")[-1].item())     # its tip displacement in m
"""

from cosserat.cases.catalogue import Case
from cosserat.cases.catalogue import find as case
from cosserat.cases.catalogue import load as load_cases
from cosserat.cases.catalogue import published as cases
from cosserat.data.dataset import case_of, load, save
from cosserat.errors import CosseratError, InputError, NotConvergedError, UnsupportedRodError
from cosserat.run import run

__all__ = [
    "Case",
    "CosseratError",
    "InputError",
    "NotConvergedError",
    "UnsupportedRodError",
    "case",
    "case_of",
    "cases",
    "load",
    "load_cases",
    "run",
    "save",
]
