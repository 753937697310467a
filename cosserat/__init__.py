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
    from cosserat.data.dataset import case_of, load, save
    from cosserat.errors import CosseratError, InputError, NotConvergedError, UnsupportedRodError
    from cosserat.export.table import to_dataframe
    from cosserat.figures.doors import animate, plot
    from cosserat.runner import modes, run

_HOMES = {
    "Case": ("cosserat.cases.catalogue", "Case"),
    "case": ("cosserat.cases.catalogue", "find"),
    "published": ("cosserat.cases.catalogue", "published"),
    "load_cases": ("cosserat.cases.catalogue", "load"),
    "case_of": ("cosserat.data.dataset", "case_of"),
    "load": ("cosserat.data.dataset", "load"),
    "save": ("cosserat.data.dataset", "save"),
    "CosseratError": ("cosserat.errors", "CosseratError"),
    "InputError": ("cosserat.errors", "InputError"),
    "NotConvergedError": ("cosserat.errors", "NotConvergedError"),
    "UnsupportedRodError": ("cosserat.errors", "UnsupportedRodError"),
    "to_dataframe": ("cosserat.export.table", "to_dataframe"),
    "animate": ("cosserat.figures.doors", "animate"),
    "plot": ("cosserat.figures.doors", "plot"),
    "modes": ("cosserat.runner", "modes"),
    "run": ("cosserat.runner", "run"),
}

__all__ = [
    "Case",
    "CosseratError",
    "InputError",
    "NotConvergedError",
    "UnsupportedRodError",
    "animate",
    "case",
    "case_of",
    "load",
    "load_cases",
    "modes",
    "plot",
    "published",
    "run",
    "save",
    "to_dataframe",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'cosserat' has no attribute '{name}'")
    module, attribute = _HOMES[name]
    value = globals()[name] = getattr(importlib.import_module(module), attribute)
    return value


def __dir__() -> list[str]:
    return __all__
