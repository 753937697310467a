"""Bodies that vary along their length: segments with a radius, a modulus and muscles of their own.

derived: with the coordinates of a section counted from the lowest line, which lies straight on the ground, the rod of
section 2.3 keeps its energy (2.3.1) per reference length, with A(xi) and I(xi) of each section.  The directors are one
field along the body, so mu_alpha is continuous where the radius or the material jumps.  With w = k_G / k_G of the body
itself, the energy is stationary where (w mu_alpha')' = f_alpha inside the segments, and w mu_alpha' (hence m^alpha) is
continuous where they meet; mu_alpha' jumps with the inverse of w.  Muscles round the body pull within the section, so
p pi R^2 of (2.2.9) holds at every place; the longitudinal ones balance n = -D of their own place (2.2.7).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError, core_schema

from cosserat.parameters import Parameters, Quantity, Reader

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Ends = tuple[float, float]
NEAR = 1e-6  # joints nearer to a front or an end, as a fraction of the length, are moved onto it


@dataclass(frozen=True)
class Taper(Reader):
    """Annotation of a value along a segment: one value, or the two at its rear and front ends, linear between them."""

    quantity: Quantity

    @property
    def alternatives(self) -> Any:
        """One value, or a pair."""
        one: Any = Annotated[float, self.quantity]
        pair: Any = tuple[one, one]
        return one | pair

    def check(self, value: object, info: core_schema.ValidationInfo) -> Ends:
        """Read one value or a pair."""
        if not isinstance(value, list | tuple):
            one = self.quantity.check(value, info)
            return one, one
        if len(value) != 2:
            raise PydanticCustomError(
                "pair", f"has {len(value)} values; give one, or the two at the rear and the front end"
            )
        return self.quantity.check(value[0], info), self.quantity.check(value[1], info)


class BodySegment(Parameters):
    """A part of the body; each value is one, or two at its rear and its front end with a line between them."""

    length: Annotated[float, Quantity("m", above=0)]
    """Length of the resting segment."""
    radius: Annotated[Ends, Taper(Quantity("m", "R", "2.2.8", above=0))] | None = None
    """Radius, one or [rear, front]; by default that of the body.  The lowest line of the resting body is straight."""
    young: Annotated[Ends, Taper(Quantity("Pa", "E", "2.6.3", above=0))] | None = None
    """Young's modulus, one or [rear, front]; by default that of the body."""
    anchoring: Annotated[Ends, Taper(Quantity("1", r"\bar{D}", "2.2.7", at_least=0))] | None = None
    """Force of the longitudinal muscles over that of the load, one or [rear, front]; by default 1."""
    advancing: Annotated[Ends, Taper(Quantity("1", "p", "2.2.8", at_least=0))] | None = None
    """Pressure of the circular muscles over that of the load, one or [rear, front]; by default 1."""


class Scales(NamedTuple):
    """Radius, modulus and muscles over those of the body: at one place, or arrays of one shape."""

    radius: Any = 1.0
    young: Any = 1.0
    anchoring: Any = 1.0
    advancing: Any = 1.0

    @property
    def stretching(self) -> Any:
        """Of k_S, k_P and k_I: they go as E R^2, (2.6.17), (2.6.20)."""
        return self.young * self.radius**2

    @property
    def gradient(self) -> Any:
        """Of k_G, which goes as E R^4, (2.6.21), (2.6.22)."""
        return self.young * self.radius**4


@dataclass(frozen=True)
class Piece:
    """A segment between two fractions of the length, with the scales at its ends."""

    left: float
    right: float
    rear: Scales
    front: Scales


UNIFORM = (Piece(0.0, 1.0, Scales(), Scales()),)
"""The one piece of a body that does not vary."""


def pieces(segments: Sequence[BodySegment], radius: float, young: float) -> tuple[Piece, ...]:
    """The segments of a body of this radius [m] and modulus [Pa]."""
    if not segments:
        return UNIFORM
    ends = np.cumsum([0.0, *(s.length for s in segments)])
    cuts = [*(ends / ends[-1]).tolist()[:-1], 1.0]
    nominal = (("radius", radius), ("young", young), ("anchoring", 1.0), ("advancing", 1.0))
    found = []
    for segment, (left, right) in zip(segments, itertools.pairwise(cuts), strict=True):
        both = [[value / own for value in getattr(segment, name) or (own, own)] for name, own in nominal]
        rear, front = (Scales(*side) for side in zip(*both, strict=True))
        found.append(Piece(left, right, rear, front))
    return tuple(found)


def check_segments(segments: Sequence[BodySegment], length: float) -> None:
    """Raise PydanticCustomError if the segments are not as long as the body."""
    total = math.fsum(s.length for s in segments)
    if segments and abs(total - length) > NEAR * length:
        raise PydanticCustomError(
            "segments",
            f"has 'segments' of {total:g} m together and a 'length' of {length:g} m; let them be equal",
        )
    for number, segment in enumerate(segments):
        if segment.length < NEAR * length:
            raise PydanticCustomError(
                "segments",
                f"has 'segments.{number}' of {segment.length:g} m, less than a millionth of the body; leave it out",
            )


def mean_square(body: Sequence[Piece]) -> float:
    """Mean along the body of the square of the scale of the radius, exact for lines."""
    if body is UNIFORM:
        return 1.0
    return math.fsum(
        (p.right - p.left) * (p.rear.radius**2 + p.rear.radius * p.front.radius + p.front.radius**2) / 3
        for p in body
    )


def scales_at(body: Sequence[Piece], number: Ints, z: Array) -> Scales:
    """The scales at places z, each in the piece of that number; arrays of the shape of z."""
    left, right = (np.array([getattr(p, side) for p in body])[number] for side in ("left", "right"))
    along = (z - left) / (right - left)
    rear, front = (np.array([getattr(p, side) for p in body]) for side in ("rear", "front"))
    values = rear[number] + (front - rear)[number] * along[..., None]
    return Scales(*np.moveaxis(values, -1, 0))


def tabulated(body: Sequence[Piece]) -> Array:
    """A row for each piece, (P, 10): left, right, and the scales at its rear and at its front."""
    return np.array([(p.left, p.right, *p.rear, *p.front) for p in body])


def piece_at(body: Sequence[Piece], z: Array) -> Ints:
    """The number of the piece at places z, at a joint that ahead of it."""
    return np.searchsorted([p.right for p in body[:-1]], z, side="right")


@dataclass(frozen=True)
class Span:
    """A part of the body with one load in one piece: fractions of the length, number of the region and of the piece."""

    left: float
    right: float
    region: int
    piece: int


def spans(regions: Sequence[Any], body: Sequence[Piece]) -> tuple[Span, ...]:
    """The parts between the fronts (`right` of the regions) and the joints of the pieces.

    A joint nearer than NEAR to a front is moved onto it.
    """
    cuts = [regions[0].left, *(r.right for r in regions)]
    if body is UNIFORM:
        return tuple(Span(a, b, number, 0) for number, (a, b) in enumerate(itertools.pairwise(cuts)))
    joints = [p.right for p in body[:-1] if min(abs(p.right - cut) for cut in cuts) > NEAR]
    edges = sorted([*cuts, *joints])
    middles = np.array([(a + b) / 2 for a, b in itertools.pairwise(edges)])
    region = np.searchsorted(cuts[1:-1], middles, side="right")
    return tuple(
        Span(a, b, int(r), int(p))
        for (a, b), r, p in zip(itertools.pairwise(edges), region, piece_at(body, middles), strict=True)
    )
