"""Full sections of simple shapes, and one that is given by its area and second moment."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Quantity
from cosserat.rods.sections.section import Homogeneous


def cowper_of_a_rectangle(poisson: Any) -> Any:
    """10 (1 + nu) / (12 + 11 nu)."""
    return 10 * (1 + poisson) / (12 + 11 * poisson)


class Rectangle(Homogeneous):
    """A rectangle."""

    proportions_in_cowper: ClassVar[bool] = False
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
        return self.width * self.height * self.height * self.height / 12

    @property
    def thinness(self) -> float:
        """A H^2 / I = 12, without round-off [1]."""
        return 12.0

    def cowper(self, poisson: Any) -> Any:
        """10 (1 + nu) / (12 + 11 nu) [1]."""
        return cowper_of_a_rectangle(poisson)


class Square(Homogeneous):
    """A square with sides along E1 and E2."""

    proportions_in_cowper: ClassVar[bool] = False
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
        return self.side * self.side

    @property
    def second_moment(self) -> float:
        """I = a^4 / 12 [m^4]."""
        return self.area * self.area / 12

    def cowper(self, poisson: Any) -> Any:
        """10 (1 + nu) / (12 + 11 nu) [1]."""
        return cowper_of_a_rectangle(poisson)


class Ellipse(Homogeneous):
    """An ellipse with axes along E1 and E2."""

    shape: Literal["ellipse"] = "ellipse"
    height: Annotated[float, Quantity("m", above=0)]
    """Whole axis along E2, in the plane of motion."""
    width: Annotated[float, Quantity("m", above=0)]
    """Whole axis along E1, across the plane of motion."""

    @property
    def area(self) -> float:
        """A = pi W H / 4 [m^2]."""
        return math.pi * self.width * self.height / 4

    @property
    def second_moment(self) -> float:
        """I = pi W H^3 / 64 [m^4]."""
        return self.area * self.height * self.height / 16

    def cowper(self, poisson: Any) -> Any:
        """12 (1 + nu) a^2 (3 a^2 + b^2) / ((40 + 37 nu) a^4 + (16 + 10 nu) a^2 b^2 + nu b^4), a along E2 [1]."""
        a, b = self.height * self.height, self.width * self.width
        below = (40 + 37 * poisson) * a * a + (16 + 10 * poisson) * a * b + poisson * b * b
        return 12 * (1 + poisson) * a * (3 * a + b) / below


class Circle(Homogeneous):
    """A circle."""

    stays_in_proportion: ClassVar[bool] = True
    shape: Literal["circle"] = "circle"
    diameter: Annotated[float, Quantity("m", above=0)]
    """Diameter."""

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
        """A = pi d^2 / 4 [m^2]."""
        return math.pi * self.diameter * self.diameter / 4

    @property
    def second_moment(self) -> float:
        """I = pi d^4 / 64 [m^4]."""
        return self.area * self.diameter * self.diameter / 16

    def cowper(self, poisson: Any) -> Any:
        """6 (1 + nu) / (7 + 6 nu) [1]."""
        return 6 * (1 + poisson) / (7 + 6 * poisson)


class Given(Homogeneous):
    """A section of one material whose area and second moment are given."""

    shape: Literal["given"] = "given"
    area: Annotated[float, Quantity("m^2", "A", above=0)]
    """Area."""
    second_moment: Annotated[float, Quantity("m^4", "I", above=0)]
    """Second moment of area about E1 through the area centre."""
    height: Annotated[float, Quantity("m", "H", above=0)]
    """Height in the plane of motion, whose middle is the area centre; directors reach the upper surface."""

    @model_validator(mode="after")
    def _possible(self) -> Self:
        if self.second_moment > self.area * self.height**2 / 4 * (1 + 1e-12):
            raise PydanticCustomError(
                "range",
                f"'second_moment' is {self.second_moment:g} m^4; it must be at most "
                f"{self.area * self.height**2 / 4:g} m^4, that of this area at the two surfaces",
            )
        return self

    def cowper(self, poisson: Any) -> Any:
        """There is none."""
        raise PydanticCustomError(
            "shear",
            "has 'shear_factor' = 'cowper', but shape = 'given' has no such factor; give a number",
        )
