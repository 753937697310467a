"""Directed rods of Green and Naghdi's kind: solvers for E. G. Hemingway's thesis (Berkeley, 2020), and for your rod.

    import cosserat
    beam = cosserat.run("clamped_free")                       # a published case, as an xarray.Dataset
    long = cosserat.case("clamped_free").vary("long", rod={"length": "10 m"})
    bent = cosserat.run(long)
    print(bent.u.sel(axis="E2")[-1].item())                   # its tip displacement in m
    cosserat.plot(bent, "long.png")                           # its picture

Names are imported when first used, which keeps the command line quick.
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cosserat.cases.catalogue import Case, published
    from cosserat.cases.catalogue import find as case
    from cosserat.cases.catalogue import load as load_cases
    from cosserat.data.dataset import case_of
    from cosserat.data.netcdf import load, save
    from cosserat.errors import CosseratError, InputError, NotConvergedError, UnsupportedRodError
    from cosserat.export.table import to_dataframe
    from cosserat.figures.doors import animate, plot
    from cosserat.limits import Limits
    from cosserat.runner import modes, run
    from cosserat.studies.analysis.bands import bands
    from cosserat.studies.analysis.design import design
    from cosserat.studies.analysis.estimates import estimate_error
    from cosserat.studies.analysis.fit import fit
    from cosserat.studies.analysis.indices import indices
    from cosserat.studies.analysis.orders import orders
    from cosserat.studies.door import study
    from cosserat.studies.sensitivity import sensitivity

_HOMES = {
    "cosserat.cases.catalogue": (
        ("Case", "Case"),
        ("case", "find"),
        ("published", "published"),
        ("load_cases", "load"),
    ),
    "cosserat.data.dataset": (("case_of", "case_of"),),
    "cosserat.data.netcdf": (
        ("load", "load"),
        ("save", "save"),
    ),
    "cosserat.errors": (
        ("CosseratError", "CosseratError"),
        ("InputError", "InputError"),
        ("NotConvergedError", "NotConvergedError"),
        ("UnsupportedRodError", "UnsupportedRodError"),
    ),
    "cosserat.export.table": (("to_dataframe", "to_dataframe"),),
    "cosserat.figures.doors": (
        ("animate", "animate"),
        ("plot", "plot"),
    ),
    "cosserat.limits": (("Limits", "Limits"),),
    "cosserat.studies.analysis.bands": (("bands", "bands"),),
    "cosserat.studies.analysis.estimates": (("estimate_error", "estimate_error"),),
    "cosserat.studies.analysis.indices": (("indices", "indices"),),
    "cosserat.studies.analysis.orders": (("orders", "orders"),),
    "cosserat.studies.analysis.design": (("design", "design"),),
    "cosserat.studies.analysis.fit": (("fit", "fit"),),
    "cosserat.studies.door": (("study", "study"),),
    "cosserat.studies.sensitivity": (("sensitivity", "sensitivity"),),
    "cosserat.runner": (
        ("modes", "modes"),
        ("run", "run"),
    ),
}
"""Public names and what they are called in each module."""

__all__ = [
    "Case",
    "CosseratError",
    "InputError",
    "Limits",
    "NotConvergedError",
    "UnsupportedRodError",
    "animate",
    "bands",
    "case",
    "case_of",
    "design",
    "estimate_error",
    "fit",
    "indices",
    "load",
    "load_cases",
    "modes",
    "orders",
    "plot",
    "published",
    "run",
    "save",
    "sensitivity",
    "study",
    "to_dataframe",
]


def __getattr__(name: str) -> Any:
    for module, names in _HOMES.items():
        if name in dict(names):
            value = globals()[name] = getattr(importlib.import_module(module), dict(names)[name])
            return value
    raise AttributeError(f"module 'cosserat' has no attribute '{name}'")


def __dir__() -> list[str]:
    return __all__
