"""Keys of a rod problem that may differ between many, as columns of values in place of numbers.

The values are put into copies of the parameter objects, which are not validated again: their ranges are checked
before, a whole column at a time.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from cosserat.problems.static import RodStatics
from cosserat.quantities import Quantity
from cosserat.rods.elasticity import INCOMPRESSIBLE
from cosserat.rods.problem import LOADS
from cosserat.rods.sections.plain import Circle, Ellipse, Rectangle, Square
from cosserat.solvers.banded import Mask

Array = NDArray[np.float64]
OF_LOADS = {"forces": "force", "line_loads": "density", "gravity": "g"}
"""Keys of loads that may differ between members, and which number of theirs."""
OF_BODY = (
    "rod.length",
    *(f"rod.section.{name}" for name in ("height", "width", "side", "diameter")),
    *(f"rod.material.{name}" for name in ("young", "poisson", "shear_modulus", "bulk_modulus")),
    *(f"rod.material.{name}" for name in ("density", "line_density")),
)
"""Keys of the rod that may differ between members."""
_SECTIONS = (Rectangle, Square, Ellipse, Circle)


def fits(problem: RodStatics, key: str, columns: Mapping[str, Array]) -> bool:
    """Whether a key may differ between members of this problem; columns : all keys that differ."""
    if key not in OF_BODY:
        kind, *_, number = key.split(".")
        return OF_LOADS.get(kind) == number and quantity_of(problem, key) is not None
    rod = problem.rod
    if quantity_of(problem, key) is None or type(rod.section) not in _SECTIONS:
        return False
    if problem.gravity is not None and problem.masses:
        return False
    if rod.energy != "consistent" or rod.stations or not rod.rest.straight or problem.imperfection:
        return False
    return key != "rod.length" or not _has_places(problem)


def _has_places(problem: RodStatics) -> bool:
    """Whether it names a place in metres, which another length would move."""
    places = [item.at for _, item in problem.constraints()]
    places += [item.at for key in ("masses", "probes") for item in getattr(problem, key)]
    places += [at for load in LOADS for item in problem.loads_of(load) for at in item.places]
    stretched = any(item.start or item.end is not None for item in problem.line_loads)
    return stretched or not all(at in ("first", "last") or isinstance(at, int) for at in places)


def quantity_of(problem: RodStatics, key: str) -> Quantity | None:
    """The range of a key that has a number; None if it has none."""
    at: Any = problem
    *path, last = key.split(".")
    for part in path:
        at = _child(at, part)
    if at is None or getattr(at, last, None) is None:
        return None
    owner: type[BaseModel] = type(at)
    return _quantity(owner, last)


@functools.cache
def _quantity(owner: type[BaseModel], name: str) -> Quantity | None:
    """The range of a field; None if it has none."""
    field = owner.model_fields[name]
    marks = [*field.metadata, *(mark for part in get_args(field.annotation) for mark in _marks(part))]
    return next((mark for mark in marks if isinstance(mark, Quantity)), None)


def _marks(annotation: Any) -> tuple[Any, ...]:
    return getattr(annotation, "__metadata__", ())


def _child(at: Any, part: str) -> Any:
    """A part of a parameter object or of a list; None if there is none."""
    if isinstance(at, tuple):
        return at[int(part)] if part.isdecimal() and int(part) < len(at) else None
    return getattr(at, part, None)


def put_inside(at: Any, path: Sequence[str], values: Array | float) -> Any:
    """A copy of a parameter object or a list with values in place of a number, not validated."""
    return _put_all(at, [(path, values)])


def _put_all(at: Any, put: Sequence[tuple[Sequence[str], Array | float]]) -> Any:
    """A copy with several, of paths that do not meet; what they do not enter is shared."""
    inside: dict[str, list[tuple[Sequence[str], Array | float]]] = {}
    for (head, *rest), values in put:
        inside.setdefault(head, []).append((rest, values))
    changed = {
        head: _put_all(_child(at, head), own) if own[0][0] else own[0][1] for head, own in inside.items()
    }
    if isinstance(at, tuple):
        return tuple(changed.get(str(number), item) for number, item in enumerate(at))
    return at.model_copy(update=changed)


def in_range(problem: RodStatics, columns: Mapping[str, Array]) -> Mask:
    """Which members, (M,), have values that a single problem would accept."""
    return holds(problem, columns, with_columns(problem, columns))


def holds(problem: RodStatics, columns: Mapping[str, Array], varied: RodStatics) -> Mask:
    """The same where the columns have been put into a copy of the problem."""
    found = np.ones(next(iter(columns.values())).size, dtype=np.bool_)
    for key, values in columns.items():
        quantity = quantity_of(problem, key)
        assert quantity is not None  # the caller has looked
        found &= quantity.holds(values)
    if not any(key.startswith("rod.material.") for key in columns):
        return found
    with np.errstate(all="ignore"):
        poisson = np.broadcast_to(varied.rod.poisson, (found.size, 1))[:, 0]
    found &= (poisson > -1) & (poisson < 0.5)
    if problem.rod.lateral_constraint == "incompressible":
        found &= poisson >= INCOMPRESSIBLE
    return found


def with_columns(problem: RodStatics, columns: Mapping[str, Array]) -> RodStatics:
    """A copy with columns (M, 1) in place of numbers."""
    varied: RodStatics = _put_all(
        problem, [(key.split("."), values[:, None]) for key, values in columns.items()]
    )
    return varied


def unit(values: Array) -> Array:
    """What a step of a key is a fraction of: its value, or one where that is zero."""
    return np.where(values == 0, 1.0, values)
