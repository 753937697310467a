"""What was found once and is mended, a line each: the fault that it had, and the input again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from .families import SOLVE
from .judge import Input
from .schema import CASE, MEASURED, file_of
from .values import SURE

_RUN = ("run", CASE, "--file", "c.toml", "-o", "c.nc")
_LAYER = 'thickness = "1e300 m", width = "1 m", material = { young = "1 Pa", poisson = 0, density = "1 kg/m^3" }'
_LAYERS = f'section = {{ shape = "layers", layers = [{{ {_LAYER} }}] }}'
_CASES = f"""\
OverflowError | rod statics | prescribed_rotations = [{{ at = "first", by = "1.7e308 rad" }}]
OverflowError | rod statics | rod.stations = [{{ at = "0.1 m", density = {"9" * 400} }}]
OverflowError | rod path | rod.section = {{ shape = "tube", shear_factor = 0.5, diameter = "1e300 m", wall = "1 cm" }}
OverflowError | rod motion | damping = {{ kind = "stiffness", ratio = 0.02, frequency = "1e300 Hz" }}
OverflowError | posture | crawler.segments = [{{ length = "0.25 m", radius = "1e300 m" }}]
OverflowError | modes | rod = {{ material = "none", {_LAYERS} }}
ZeroDivisionError | rod statics | follower_line_loads = [{{ along = "E3", density = "1e100 N/m" }}]
ZeroDivisionError | critical loads | rod.stations = [{{ at = "0.1 m", young = 1e-300 }}]
ZeroDivisionError | body mass | body_mass = "1e-300 kg"
ZeroDivisionError | crawl | step = "500000000000 s"
ZeroDivisionError | rod motion | duration = "1e-300 s"
ZeroDivisionError | rod motion | every = "1e-300 s"
ValueError | critical loads | line_loads = [{{ along = "E3", density = "1.7e308 N/m" }}]
ValueError | rod motion | start = {{ shape = "reference", mode = 1, spin = "1e300 rad/s" }}
ValueError | rod motion | rod.stations = [{{ at = "0.1 m", young = 1.7e308 }}]
ValueError | rod motion | foundations = [{{ rotational_stiffness = "1.7e308 N*m/rad/m" }}]
ValueError | discretization errors | slender = {{ rod = {{ section = {{ height = "1e-300 m" }} }} }}
ValueError | discretization errors | slender.rod.section = {{ shape = "rectangle", height = "1.5e-12 m" }}
IndexError | discretization errors | necking = {{ forces = [] }}
AttributeError | calibration | hanging_bar = {{ like = "hanging_bar_consistent" }}
LinAlgError | worm calibration | worm = {{ crawler = {{ length = "1e-300 m" }} }}
a warning | crawl | gait.clearance = 5e-324
a warning | critical loads | search = {{ limit = 1e300 }}
a warning | rod statics | rod.material.young = "1e-300 Pa"
a warning | rod statics | prestrains = [{{ section = 1.7e308 }}]
a warning | posture | crawler.segments = [{{ length = "0.25 m", young = "1.7e308 Pa" }}]
endless | rod motion | duration = "1e300 s"
endless | rod motion | integrator = {{ step = "1e-15 s" }}
endless | rod statics | rod.length = "1 m^(9^9^9^9)"
"""
_LINES = """\
KeyError | --merged schema
two lines | run c --hours
two lines | plot c.nc --frames abc
"""
_FAMILIES: tuple[tuple[str, str, dict[str, Any]], ...] = (
    (
        "ValueError: no member in range",
        "study",
        {"vary": [{"sobol": 4, "rod": {"length": {"uniform": ["1e299 m", "1e300 m"]}}}]},
    ),
    ("endless: many read-outs", "study", {"keep": {f"k{n}": "u.E2 at last" for n in range(3000)}}),
    ("long sentence: whole variable", "study", {"keep_whole": ["a" * 5000]}),
    ("long sentence: read-out of a fit", "fit", {"keep": {"a" * 5000: "u.E2 at last"}}),
)


def _case(name: str, kind: str, written: str) -> Input:
    return Input(name, _RUN, {"c.toml": file_of(kind, {}) + written.encode()})


def _found() -> Iterator[tuple[str, Callable[[], Input]]]:
    for line in _CASES.splitlines():
        fault, kind, written = line.split(" | ")
        name = f"{fault}: {written[:50]}"
        yield name, partial(_case, name, kind, written)
    for line in _LINES.splitlines():
        fault, words = line.split(" | ")
        name = f"{fault}: {words}"
        yield name, partial(Input, name, tuple(words.split()), codes=SURE)
    for name, word, changes in _FAMILIES:
        yield name, partial(_family, name, word, changes)


def _family(name: str, word: str, changes: dict[str, Any]) -> Input:
    return Input(name, SOLVE[word], {"c.toml": file_of(word, changes), **MEASURED})


FOUND = dict(_found())
"""What makes each input by its name: naming them all is quick."""
