"""Right values of every type of the schema, and tables with what they need."""

from __future__ import annotations

import functools
import math
from typing import Any

from pydantic import BaseModel

from cosserat.describe.keys import Value, _value, _whole
from cosserat.parameters import Count, Quantity

_USUAL = {
    "m": 0.1, "m^2": 1e-4, "m^4": 1e-9, "Pa": 1e6, "kg": 0.1, "kg*m^2": 1e-4, "kg/m^3": 1000.0, "s": 0.001,
    "Hz": 100.0, "N": 0.1, "N/m": 0.1, "N*m": 0.01, "K": 10.0, "K^-1": 1e-5, "rad": 0.1, "1": 0.5, "m/s": 0.1,
}  # fmt: skip
"""An ordinary size of each quantity, in SI units."""
_COMPLETED: dict[str, tuple[dict[str, Any], ...]] = {
    "Material": (
        {"young": "1 MPa", "poisson": 0.3, "density": "1000 kg/m^3"},
        {"young": "1 MPa", "shear_modulus": "0.4 MPa", "line_density": "1 kg/m"},
        {"young": "1 MPa", "bulk_modulus": "1 MPa", "density": "1000 kg/m^3"},
    ),
    "HollowRectangle": ({"wall": "0.01 m"},),
    "Tube": ({"wall": "0.01 m"},),
    "ISection": ({"flange": "0.01 m", "web": "0.01 m"},),
    "Stiffnesses": ({"gyration": "0.02 m"},),
    "CurvatureTable": ({"curvature": [["0 m", "1 m^-1"], ["1 m", "0 m^-1"]]},),
    "Spring": ({"rotational_stiffness": "1 N*m/rad"}, {"stiffness": "1 N/m", "along": "E2"}),
    "Foundation": ({"stiffness": "1 Pa", "along": "E2"}, {"rotational_stiffness": "1 N*m/rad/m"}),
    "Prestrain": ({"extension": 0.01},),
    "Temperature": ({"change": "10 K"},),
    "BaseMotion": (
        {"acceleration": "1 m/s^2"},
        {"record": [["0 s", "0 m/s^2"], ["1 s", "1 m/s^2"]]},
    ),
    "MassDamping": ({"ratio": 0.02}, {"rate": "1 1/s"}),
    "RayleighDamping": (
        {"ratios": [0.01, 0.02], "modes": [1, 2]},
        {"ratios": [0.01, 0.02], "frequencies": ["1 Hz", "2 Hz"]},
    ),
    "StiffnessDamping": ({"ratio": 0.02, "frequency": "1 Hz"}, {"time": "1 us"}),
    "ModalDamping": ({"ratio": 0.02, "modes": 2}, {"ratios": [0.02]}),
    "Start": ({"mode": 1},),
    "Compressible": ({"young": "1 kPa", "poisson": 0.3}, {"young": "1 kPa", "bulk": "1 kPa"}),
    "BodySegment": ({"length": "0.25 m"},),
    "Segment": (
        {"begin": 0, "end": 1, "load": "advancing"},
        {"begin": 0, "end": 1, "load": "anchoring", "force": "1 N"},
    ),
    "Gait": ({"phases": ["3.15 s", "1.75 s"]},),
    "Measured": ({"table": [["0 s", "0.1 m"], ["4.9 s", "0 m"]], "length": "0.1 m"},),
    "Chamber": ({"begin": 0, "end": 1, "schedule": [[0, 1, "anchoring"]]},),
    "Factor": ({"rod": {"length": ["1 m", "1.1 m"]}},),
}
"""Keys beside those that a class requires, without which its table is not complete: of several choices, the first one
that has the key in question."""


def type_of(owner: type[BaseModel], name: str) -> Value:
    """The type of a key."""
    value = _value(_whole(owner.model_fields[name]))
    assert value is not None
    return value


def chosen(owner: type[BaseModel]) -> dict[str, str]:
    """The key, with its word, by which a table is chosen among others."""
    words = {
        name: field.default for name, field in owner.model_fields.items() if name in ("kind", "shape")
    }
    return {name: word for name, word in words.items() if isinstance(word, str)}


@functools.cache
def example(owner: type[BaseModel], key: str = "") -> dict[str, Any]:
    """A table of a class with what it needs; `key` : the one that will be given another value."""
    needed = {
        name: right(type_of(owner, name))
        for name, field in owner.model_fields.items()
        if field.is_required()
    }
    choices = _COMPLETED.get(owner.__name__, ({},))
    more = next((choice for choice in choices if key in choice), choices[0])
    return {**chosen(owner), **needed, **more}


def right(value: Value, number: int = 0) -> Any:
    """A value that the type allows; `number` : of an item in a list."""
    match value.form:
        case "quantity":
            assert isinstance(value.about, Quantity)
            size = _within(value.about, number)
            return size if value.about.unit == "1" else f"{size:g} {value.about.unit}"
        case "count":
            assert isinstance(value.about, Count)
            return max(value.about.at_least, min(3, value.about.at_most))
        case "word":
            return value.words[0]
        case "names" | "keys":
            return {"tip": "u.E2 at last"}
        case "name" | "text":
            return "a text"
        case "truth":
            return True
        case "table":
            return example(value.tables[0])
        case "list":
            rows = value.items[0].form == "row"
            return [right(value.items[0], n) for n in range(3 if rows else 1)]
        case "row":
            return [right(item, number) for item in value.items]
        case "either":
            return right(value.items[0], number)


def _within(about: Quantity, number: int) -> float:
    """An ordinary number in the range of a quantity."""
    size = _USUAL.get(about.unit, 1.0) * (number + 1)
    if max(about.least, about.above) < size < min(about.most, about.below):
        return size
    if math.isfinite(about.above) and math.isfinite(about.below):
        return (about.above + about.below) / 2
    return (max(about.least, 0.0) + about.most) / 2
