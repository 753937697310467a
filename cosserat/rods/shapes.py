"""Shapes of a centreline: straight, an arc, a curvature along the rod, or points that a spline joins.

A shape is the angle of its tangent along its arc length.  derived: the edge from s to s + h is a chord of the circle
whose curvature K is the mean of that of the shape, so the discrete rod turns by K h there, to second order, and its
vertices follow the shape to second order.  An edge is as long as the shape between its vertices, so that the length
and the mass of the rod are those of the shape.
"""

from __future__ import annotations

import functools
from abc import abstractmethod
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Parameters, Quantity
from cosserat.rods.naming import Direction, unit_vector
from cosserat.rods.quadrature import gauss
from cosserat.tables import Columns, Rows

Array = NDArray[np.float64]
_NEAR = 1e-6  # difference of two lengths, as a fraction, up to which they are the same
_PIECES = 32  # of the arc length between two points


class Shape(Parameters):
    """The shape of a centreline by its arc length."""

    @abstractmethod
    def angles(self, arc: Array) -> Array:
        """Angle of the tangent from E3 towards E2 at arc lengths (N,) [m]: (N,) [rad]; whole turns count."""

    @property
    def origin(self) -> Array:
        """The first point, shape (2,) [m]."""
        return np.zeros(2)

    @property
    def straight(self) -> bool:
        """Whether it is a straight line from the origin along E3."""
        return False

    def curvatures(self, arc: Array) -> Array:
        """Mean curvature between arc lengths (N,) [m]: (N - 1,) [1/m]."""
        means: Array = np.diff(self.angles(arc)) / np.diff(arc)
        return means

    def check(self, key: str, length: float) -> None:
        """Raise PydanticCustomError if it does not fit a rod of that length [m]; key : its name."""


class Directed(Shape):
    """A shape that begins at the origin in a direction."""

    along: Direction = "E3"
    """Direction in which the rod begins."""

    @property
    def first(self) -> float:
        """Angle of the first tangent from E3 towards E2 [rad]."""
        return float(np.arctan2(*unit_vector(self.along)[::-1]))


class Straight(Directed):
    """Straight."""

    kind: Literal["straight"] = "straight"

    @property
    def straight(self) -> bool:
        """Along E3."""
        return self.first == 0.0

    def angles(self, arc: Array) -> Array:
        """The same everywhere."""
        return np.full_like(arc, self.first)

    def curvatures(self, arc: Array) -> Array:
        """Zero."""
        return np.zeros(arc.shape[-1] - 1)


class Arc(Directed):
    """An arc."""

    kind: Literal["arc"] = "arc"
    curvature: Annotated[float, Quantity("m^-1", "K", "3.3.23")]
    """Curvature, positive from E3 towards E2."""

    @property
    def straight(self) -> bool:
        """Along E3 without curvature."""
        return self.curvature == 0.0 and self.first == 0.0

    def angles(self, arc: Array) -> Array:
        """Linear in the arc length."""
        return self.first + self.curvature * arc

    def curvatures(self, arc: Array) -> Array:
        """The same everywhere."""
        return np.full(arc.size - 1, self.curvature)


class CurvatureTable(Directed):
    """A curvature that varies along the rod."""

    kind: Literal["curvature"] = "curvature"
    curvature: Annotated[Rows, Columns((("at", "m"), ("curvature", "m^-1")))]
    """Curvatures, positive from E3 towards E2, from the first to the last vertex."""
    between: Literal["linear", "spline"] = "linear"
    """Whether the curvature is linear between the rows, or a cubic spline through them."""

    def check(self, key: str, length: float) -> None:
        """Require a table from end to end."""
        first, last = self.curvature[0][0], self.curvature[-1][0]
        if abs(first) > _NEAR * length or abs(last - length) > _NEAR * length:
            raise PydanticCustomError(
                "range",
                f"'{key}' has curvatures from {first:g} m to {last:g} m, but the rod goes from 0 to {length:g} m; "
                "give them from end to end",
            )

    def angles(self, arc: Array) -> Array:
        """The integral of the curvature."""
        from scipy.interpolate import CubicSpline, make_interp_spline

        at, values = np.array(self.curvature).T
        found = (
            CubicSpline(at, values) if self.between == "spline" else make_interp_spline(at, values, 1)
        )
        angles: Array = self.first + found.antiderivative()(arc)
        return angles


class Points(Shape):
    """A cubic spline through points in the plane, where they are: the first is the first vertex."""

    kind: Literal["points"] = "points"
    points: Annotated[Rows, Columns((("E3", "m"), ("E2", "m")), increasing=False)]
    """Points of the centreline, in order."""
    tangent: Direction | None = None
    """Direction of the rod at the first point; that of the spline by default."""

    @model_validator(mode="after")
    def _points_differ(self) -> Self:
        for number, (a, b) in enumerate(zip(self.points[:-1], self.points[1:], strict=True)):
            if a == b:
                raise PydanticCustomError(
                    "twice",
                    f"has 'points' with ({a[0]:g} m, {a[1]:g} m) in rows {number} and {number + 1}; leave one out",
                )
        return self

    @property
    def origin(self) -> Array:
        """The first point."""
        return np.array(self.points[0])

    @property
    def length(self) -> float:
        """Arc length of the spline [m]."""
        return float(self._curve.arc[-1])

    @property
    def _curve(self) -> Curve:
        return curve(self.points, self.tangent)

    def check(self, key: str, length: float) -> None:
        """Require the length of the spline."""
        if abs(self.length - length) > _NEAR * length:
            raise PydanticCustomError(
                "length",
                f"'{key}' has points along {self.length:.9g} m, but 'length' is {length:.9g} m; "
                "leave 'length' out (length = 'none' removes an inherited one)",
            )

    def angles(self, arc: Array) -> Array:
        """Of the tangent of the spline."""
        return self._curve.angles(arc)


AnyShape = Annotated[Straight | Arc | CurvatureTable | Points, Field(discriminator="kind")]
"""A shape of any kind."""


@dataclass(frozen=True)
class Curve:
    """A plane curve by a parameter, with its arc length and the angle of its tangent at a grid of it.

    derivative : of the point by the parameter.  grid, arc, angle : (G,) parameter, arc length [m], angle [rad].
    """

    derivative: Any
    grid: Array
    arc: Array
    angle: Array

    def angles(self, arc: Array) -> Array:
        """Angle of the tangent at arc lengths (N,) [m]."""
        t = np.interp(arc, self.arc, self.grid)
        near = np.interp(t, self.grid, self.angle)
        angle = np.arctan2(*self.derivative(t).T[::-1])
        whole: Array = angle + 2 * np.pi * np.round((near - angle) / (2 * np.pi))
        return whole


@functools.lru_cache(maxsize=16)
def curve(points: Rows, tangent: str | float | tuple[float, float] | None) -> Curve:
    """The cubic spline through points [m], its parameter the length of their polygon."""
    from scipy.interpolate import CubicSpline

    through = np.array(points)
    knots = np.insert(np.cumsum(np.linalg.norm(np.diff(through, axis=0), axis=1)), 0, 0.0)
    first: Any = "not-a-knot" if tangent is None else (1, unit_vector(tangent))
    derivative = CubicSpline(knots, through, bc_type=(first, "not-a-knot")).derivative()
    steps = np.arange(_PIECES * (knots.size - 1) + 1) / _PIECES
    grid = np.interp(steps, np.arange(knots.size), knots)
    nodes, weights = gauss(grid)
    speeds = np.linalg.norm(derivative(nodes), axis=-1)
    arc = np.insert(np.cumsum((speeds * weights).sum(axis=1)), 0, 0.0)
    angle = np.unwrap(np.arctan2(*derivative(grid).T[::-1]))
    return Curve(derivative, grid, arc, angle)
