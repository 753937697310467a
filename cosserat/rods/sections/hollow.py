"""Sections with walls: tubes, hollow rectangles and I sections.

Their stretch along E2 is that of the material: a wall contracts by Poisson's ratio times the strain along the rod.  A
tube that ovalises, whose walls bend, is another mechanism, and much softer; no section here has it.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Quantity
from cosserat.rods.sections.section import Homogeneous


def _check_wall(key: str, wall: float, whole: float, of: str) -> None:
    """Raise PydanticCustomError if two walls are thicker than the whole."""
    if 2 * wall >= whole:
        raise PydanticCustomError(
            "range", f"'{key}' is {wall:g} m; it must be below half the {of}, {whole / 2:g} m"
        )


class Tube(Homogeneous):
    """A round tube."""

    stays_in_proportion: ClassVar[bool] = True
    shape: Literal["tube"] = "tube"
    diameter: Annotated[float, Quantity("m", above=0)]
    """Outer diameter."""
    wall: Annotated[float, Quantity("m", above=0)]
    """Thickness of the wall, below half the diameter."""

    @model_validator(mode="after")
    def _has_a_hole(self) -> Self:
        _check_wall("wall", self.wall, self.diameter, "diameter")
        return self

    @property
    def inner(self) -> float:
        """Inner diameter [m]."""
        return self.diameter - 2 * self.wall

    @property
    def height(self) -> float:
        """Height along E2 [m]."""
        return self.diameter

    @property
    def width(self) -> float:
        """Width along E1 [m]."""
        return self.diameter

    @property
    def area(self) -> float:
        """A = pi t (d - t), which is pi (d^2 - d_i^2) / 4 [m^2]."""
        return math.pi * self.wall * (self.diameter - self.wall)

    @property
    def second_moment(self) -> float:
        """I = A (d^2 + d_i^2) / 16, which is pi (d^4 - d_i^4) / 64 [m^4]."""
        return self.area * (self.diameter**2 + self.inner**2) / 16

    def cowper(self, poisson: Any) -> Any:
        """6 (1 + nu) (1 + m^2)^2 / ((7 + 6 nu) (1 + m^2)^2 + (20 + 12 nu) m^2), m = d_i / d [1]."""
        m = (self.inner / self.diameter) ** 2
        both = (1 + m) ** 2
        return 6 * (1 + poisson) * both / ((7 + 6 * poisson) * both + (20 + 12 * poisson) * m)


def _thin_walled(poisson: Any, m: float, across: Any) -> Any:
    """Cowper's factor of flanges and webs that are thin; across : the part of the flanges in the denominator."""
    webs = 12 + 72 * m + 150 * m**2 + 90 * m**3 + poisson * (11 + 66 * m + 135 * m**2 + 90 * m**3)
    return 10 * (1 + poisson) * (1 + 3 * m) ** 2 / (webs + across)


class HollowRectangle(Homogeneous):
    """A rectangle with a hollow inside and one thickness of wall."""

    shape: Literal["hollow rectangle"] = "hollow rectangle"
    height: Annotated[float, Quantity("m", above=0)]
    """Outer height, in the plane of motion."""
    width: Annotated[float, Quantity("m", above=0)]
    """Outer width, across the plane of motion."""
    wall: Annotated[float, Quantity("m", above=0)]
    """Thickness of the wall, below half the height and half the width."""

    @model_validator(mode="after")
    def _has_a_hole(self) -> Self:
        _check_wall("wall", self.wall, self.height, "height")
        _check_wall("wall", self.wall, self.width, "width")
        return self

    @property
    def area(self) -> float:
        """A = 2 t (W + H - 2 t) [m^2]."""
        return 2 * self.wall * (self.width + self.height - 2 * self.wall)

    @property
    def second_moment(self) -> float:
        """I = (W H^3 - W_i H_i^3) / 12 [m^4]."""
        inner = (self.width - 2 * self.wall) * (self.height - 2 * self.wall) ** 3
        return (self.width * self.height**3 - inner) / 12

    def cowper(self, poisson: Any) -> Any:
        """That of a box of thin walls with the midlines of these, b across and h high; m = n = b / h [1].

        10 (1 + nu) (1 + 3 m)^2 over 12 + 72 m + 150 m^2 + 90 m^3 + nu (11 + 66 m + 135 m^2 + 90 m^3)
        + 10 n^2 ((3 + nu) m + 3 m^2).
        """
        n = (self.width - self.wall) / (self.height - self.wall)
        return _thin_walled(poisson, n, 10 * n**2 * ((3 + poisson) * n + 3 * n**2))


class ISection(Homogeneous):
    """An I: two flanges across the plane of motion, and a web between them in this plane."""

    shape: Literal["I"] = "I"
    height: Annotated[float, Quantity("m", above=0)]
    """Whole height, in the plane of motion."""
    width: Annotated[float, Quantity("m", above=0)]
    """Width of the flanges, across the plane of motion."""
    flange: Annotated[float, Quantity("m", above=0)]
    """Thickness of each flange, below half the height."""
    web: Annotated[float, Quantity("m", above=0)]
    """Thickness of the web, at most the width."""

    @model_validator(mode="after")
    def _has_a_web(self) -> Self:
        _check_wall("flange", self.flange, self.height, "height")
        if self.web > self.width:
            raise PydanticCustomError(
                "range", f"'web' is {self.web:g} m; it must be at most the width, {self.width:g} m"
            )
        return self

    @property
    def area(self) -> float:
        """A = W H - (W - t) (H - 2 f), f of the flanges, t of the web [m^2]."""
        return 2 * self.width * self.flange + self.web * (self.height - 2 * self.flange)

    @property
    def second_moment(self) -> float:
        """I = (W H^3 - (W - t) (H - 2 f)^3) / 12 [m^4]."""
        beside = (self.width - self.web) * (self.height - 2 * self.flange) ** 3
        return (self.width * self.height**3 - beside) / 12

    def cowper(self, poisson: Any) -> Any:
        """That of thin flanges b wide, h apart between midlines; m = 2 b f / (h t), n = b / h [1].

        10 (1 + nu) (1 + 3 m)^2 over 12 + 72 m + 150 m^2 + 90 m^3 + nu (11 + 66 m + 135 m^2 + 90 m^3)
        + 30 n^2 (m + m^2) + 5 nu n^2 (8 m + 9 m^2).
        """
        apart = self.height - self.flange
        m, n = 2 * self.width * self.flange / (apart * self.web), self.width / apart
        across = 30 * n**2 * (m + m**2) + 5 * poisson * n**2 * (8 * m + 9 * m**2)
        return _thin_walled(poisson, m, across)
