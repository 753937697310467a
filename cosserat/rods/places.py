"""Places along a rod: a vertex, a distance in metres, or a percentage of the length."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError, core_schema

from cosserat.parameters import Count, Quantity, Reader
from cosserat.text import shown

Array = NDArray[np.float64]
_NEAR = 1e-9  # distance to a vertex, as a fraction of the length, below which a place is that vertex


class PlaceName(Reader):
    """Annotation: a vertex, a distance from the first one along the reference centreline, or a part of its length."""

    @property
    def alternatives(self) -> Any:
        """A word, a vertex, a length or a percentage."""
        distance = Annotated[float, Quantity("m")] | Annotated[float, Quantity("%")]
        return Literal["first", "last"] | Annotated[int, Count()] | distance

    @property
    def said(self) -> str:
        """In words."""
        return '"first", "last", the index of a vertex, a distance such as "0.35 m", or a percentage such as "25 %"'

    def check(self, value: object, info: core_schema.ValidationInfo) -> str | int:
        """Read one place."""
        if isinstance(value, str):
            return value if value in ("first", "last") else _in_metres_or_percent(value)
        try:
            return Count().check(value)
        except PydanticCustomError:
            raise PydanticCustomError("type", f"is {shown(value)}; it must be {self.said}") from None


Place = Annotated[str | int, PlaceName()]


def _in_metres_or_percent(text: str) -> str:
    part = text.strip().endswith("%")
    try:
        number = Quantity("1" if part else "m").read(text, unit_required=True)
    except PydanticCustomError as error:
        if error.type == "range":
            raise
        raise PydanticCustomError("type", f"is {shown(text)}; it must be {PlaceName().said}") from None
    if number < 0:
        raise PydanticCustomError("range", f"is {shown(text)}; it must not be before the first vertex")
    rounded = float(f"{100 * number if part else number:.15g}")
    return f"{rounded!r} {'%' if part else 'm'}"


@dataclass(frozen=True)
class Located:
    """A place between the vertices `index` and `index + 1`, at a share of their edge from 0 to 1."""

    index: int
    share: float

    @property
    def weights(self) -> tuple[tuple[int, float], ...]:
        """The vertices beside it, with their weights in linear interpolation."""
        ends = ((self.index, 1 - self.share), (self.index + 1, self.share))
        return tuple((vertex, weight) for vertex, weight in ends if weight > 0)


def arc_of(at: str | int, arc: Array) -> float:
    """Arc length of a place [m]; arc : (N,) of the vertices."""
    if isinstance(at, int):
        return float(arc[at])
    if at in ("first", "last"):
        return float(arc[0 if at == "first" else -1])
    number, unit = at.split()
    return float(number) * (arc[-1] / 100 if unit == "%" else 1.0)


def located(at: str | int, arc: Array) -> Located:
    """The edge of a place and its share of it; arc : (N,) arc length of the vertices [m]."""
    if at in ("first", "last") or isinstance(at, int):
        return Located(vertex_at(at, arc), 0.0)
    place = arc_of(at, arc)
    near = int(np.abs(arc - place).argmin())
    if abs(arc[near] - place) <= _NEAR * arc[-1]:
        return Located(near, 0.0)
    index = int(np.clip(np.searchsorted(arc, place) - 1, 0, arc.size - 2))
    return Located(index, float((place - arc[index]) / (arc[index + 1] - arc[index])))


def vertex_at(at: str | int, arc: Array) -> int:
    """The vertex at a place, where there is one: `mesh` puts one at each place that it is given."""
    if isinstance(at, int):
        return at
    if at in ("first", "last"):
        return 0 if at == "first" else arc.size - 1
    place = located(at, arc)
    assert place.share == 0.0, at
    return place.index


def check_place(at: str | int, vertices: int, length: float, key: str) -> None:
    """Raise PydanticCustomError if a place, given below a key, is not on a rod of these vertices and this length."""
    if isinstance(at, int):
        if at >= vertices:
            raise PydanticCustomError(
                "range",
                f"'{key}' 'at' is {at}, but the rod's vertices are 0 to {vertices - 1}; "
                "choose one of those, 'first' or 'last'",
            )
    elif at not in ("first", "last") and arc_of(at, np.array([0.0, length])) > length * (1 + _NEAR):
        raise PydanticCustomError(
            "range",
            f"'{key}' 'at' is {at}, but the rod is {length:g} m long; choose a place on it",
        )


def equal_mesh(vertices: int, length: float | Array) -> Array:
    """Arc lengths of equally spaced vertices, (..., N) [m], of one or of several lengths (...)."""
    return np.linspace(0.0, length, vertices, axis=-1)


def mesh(vertices: int, length: float, places: Sequence[str | int]) -> Array:
    """Arc lengths (N,) of vertices [m], one of them at each given place, equally spaced between these.

    Raises
    ------
    PydanticCustomError : there are more places than vertices.
    """
    equal = equal_mesh(vertices, length)
    between = [at for at in places if not (isinstance(at, int) or at in ("first", "last"))]
    if all(located(at, equal).share == 0.0 for at in between):
        return equal
    cuts = [0.0]
    for place in sorted([*(min(arc_of(at, equal), length) for at in between), length]):
        if place > cuts[-1] + _NEAR * length:
            cuts.append(place)
    spans, edges = np.diff(cuts), vertices - 1
    if spans.size > edges:
        raise PydanticCustomError(
            "vertices",
            f"has {vertices} vertices, but {spans.size + 1} of its ends, supports, springs and masses need one each; "
            "use more 'rod.vertices'",
        )
    wanted = spans / length * edges
    counts = np.maximum(1, np.floor(wanted).astype(int))
    while counts.sum() != edges:
        step = int(np.sign(edges - counts.sum()))
        open_spans = np.flatnonzero(counts > 1) if step < 0 else np.arange(spans.size)
        counts[open_spans[(step * (wanted - counts))[open_spans].argmax()]] += step
    parts = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(cuts[:-1], cuts[1:], counts, strict=True)]
    return np.append(np.concatenate(parts), length)
