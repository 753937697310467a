"""Full sections of simple shapes."""

from __future__ import annotations

from typing import Annotated, Literal

from cosserat.parameters import Quantity
from cosserat.rods.sections.section import Section


class Rectangle(Section):
    """A rectangle."""

    shape: Literal["rectangle"] = "rectangle"
    height: Annotated[float, Quantity("m", "H", "section 3.5", above=0)]
    """Height of the section, in the plane of motion."""
    width: Annotated[float, Quantity("m", "W", "section 3.5", above=0)]
    """Width of the section, across the plane of motion."""

    @property
    def area(self) -> float:
        """A = W H [m^2]."""
        return self.width * self.height

    @property
    def second_moment(self) -> float:
        """I = W H^3 / 12 [m^4]."""
        return self.width * self.height**3 / 12

    @property
    def thinness(self) -> float:
        """A H^2 / I = 12, without round-off [1]."""
        return 12.0


class Square(Section):
    """A square."""

    shape: Literal["square"] = "square"
    side: Annotated[float, Quantity("m", above=0)]
    """Side of the square: its height and its width."""

    @property
    def height(self) -> float:
        """Height along E2 [m]."""
        return self.side

    @property
    def width(self) -> float:
        """Width along E1 [m]."""
        return self.side

    @property
    def area(self) -> float:
        """A = a^2 [m^2]."""
        return self.side**2

    @property
    def second_moment(self) -> float:
        """I = a^4 / 12 [m^4]."""
        return self.side**4 / 12
