"""Cases solved by the package beside right values of codes that share nothing with it: what all of them use."""

import functools
import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import cosserat

from .reissner import Rod
from .timoshenko import Piece

ORDER = 0.15
"""Of the measured order of convergence from 2: a value two meshes apart then leaves a tenth of the error."""
FILES = ("cases.toml", "wishes.toml")


@dataclass(frozen=True)
class Row:
    """What was found beside what is right; `tolerance` is absolute, and comes from the mesh."""

    what: str
    right: float
    found: float
    tolerance: float
    source: str

    @property
    def error(self) -> float:
        return self.found - self.right

    @property
    def holds(self) -> bool:
        return bool(abs(self.error) <= self.tolerance)


Check = Callable[[], Iterator[Row]]
CHECKS: dict[str, Check] = {}
QUICK: set[str] = set()


def check(*, quick: bool = False) -> Callable[[Check], Check]:
    """Put a function that yields rows on the list; quick ones are among the ordinary tests."""

    def enter(function: Check) -> Check:
        CHECKS[function.__name__] = function
        if quick:
            QUICK.add(function.__name__)
        return function

    return enter


@functools.cache
def inputs():
    """Every case of this folder by name."""
    files = [cosserat.load_cases(Path(__file__).with_name(file)) for file in FILES]
    return {name: case for cases in files for name, case in cases.items()}


def run(name, **changes):
    case = inputs()[name]
    return cosserat.run(case.vary(name, **changes) if changes else case)


def rectangle(name, curvature=0.0):
    """The rod of a case with a rectangular section for `reissner`, read from its input."""
    rod = inputs()[name].problem.rod
    return Rod.rectangle(
        rod.length, rod.height, rod.width, rod.young, rod.poisson, rod.shear_correction, curvature
    )


def piece(name, **changes):
    """The beam of a case with a rectangular section for `timoshenko`."""
    rod = inputs()[name].problem.rod
    rod = rod.replace(material=rod.material.replace(**changes))
    return Piece.rectangle(
        rod.length, rod.height, rod.width, rod.young, rod.line_density, rod.poisson, rod.shear_correction
    )


def converging(what, right, found, fraction, source, scale=None):
    """Rows of a value on meshes each twice as fine as the one before: the last value and the order of the errors.

    share : of the value, or of `scale`, that the last mesh may miss.
    """
    errors = np.abs(np.array(found) - right)
    yield Row(what, right, found[-1], fraction * abs(scale or right), source)
    for coarse, fine in itertools.pairwise(errors):
        yield Row(f"order of {what}", 2.0, float(np.log2(coarse / fine)), ORDER, "theory")


def last(data, axis="E2"):
    """Where the last vertex is [m]."""
    return float(data.x.sel(axis=axis).isel(vertex=-1))


def displaced(data, axis="E2", probe="tip"):
    """Displacement of a named point, of a state or of all of them [m]."""
    return data.probe_displacement.sel(probe=probe, axis=axis).to_numpy()[()]


def frequencies(name, count, **changes):
    """The lowest frequencies of a case of kind "modes" [Hz]."""
    return run(name, count=count, **changes).natural_frequency.to_numpy()


def finer(vertices, changes=None):
    """Changes of a case and another number of vertices."""
    changes = changes or {}
    return {**changes, "rod": {**changes.get("rod", {}), "vertices": vertices}}
