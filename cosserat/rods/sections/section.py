"""The interface of the cross-sections of a rod."""

from __future__ import annotations

from abc import abstractmethod
from typing import Annotated

from cosserat.parameters import Parameters, Quantity


class Section(Parameters):
    """A cross-section, symmetric about the plane of motion; y runs along E2, in the direction of its height.

    Each class has its own `shape` and lengths.  `height`, along E2, and `width`, along E1, are those of the rectangle
    round it.
    """

    shear_factor: Annotated[float, Quantity("1", "k", "3.4.13", above=0)]
    """Factor of the shear stiffness k mu A; 5/6 for a rectangle."""

    @property
    @abstractmethod
    def area(self) -> float:
        """Area A [m^2]."""

    @property
    @abstractmethod
    def second_moment(self) -> float:
        """Second moment of area about E1 through the area centre, I [m^4]."""

    @property
    def thinness(self) -> float:
        """A H^2 / I, with H the height: 12 for a rectangle [1]."""
        height: float = self.height  # type: ignore[attr-defined] # of each class
        return self.area * height**2 / self.second_moment
