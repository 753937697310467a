"""Sections with walls: tubes, hollow rectangles and I sections.

Their stretch along E2 is that of the material: a wall contracts by Poisson's ratio times the strain along the rod.  A
tube that ovalises, whose walls bend, is another mechanism, and much softer; no section here has it.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Quantity
from cosserat.rods.sections.section import Homogeneous
from cosserat.rods.variation import Scales, Station, scales_at, walls_vary

Array = NDArray[np.float64]


class _Limit(NamedTuple):
    """A wall and what it must be below, or at most [m]."""

    key: str
    wall: float
    most: float
    said: str
    allowed: bool = False
    """Whether the limit itself is allowed."""

    @property
    def kept(self) -> bool:
        return bool(self.wall < self.most or (self.allowed and self.wall <= self.most))


class Walled(Homogeneous):
    """A section whose walls may be thicker or thinner along a rod, whatever its outline does."""

    @property
    @abstractmethod
    def _limits(self) -> tuple[_Limit, ...]:
        """What its walls must keep."""

    @abstractmethod
    def _here(self, s: Scales, wall: Any) -> Self:
        """The section with its lengths at places, arrays in place of numbers; wall : factor of its walls."""

    def _at(self, s: Scales) -> Self | None:
        """The section at places; None if all its lengths along E1 and along E2 scale alike."""
        return None if s.wall is None else self._here(s, s.wall)

    @model_validator(mode="after")
    def _has_a_hole(self) -> Self:
        for limit in self._limits:
            if not limit.kept:
                raise PydanticCustomError(
                    "range",
                    f"'{limit.key}' is {limit.wall:g} m; it must be {limit.said}, {limit.most:g} m",
                )
        return self

    def check_stations(self, stations: Sequence[Station]) -> None:
        """Require walls that the outline holds at every station; between them both are linear."""
        self._check_proportions(stations)
        if not walls_vary(stations):
            return
        for station in stations:
            if station.wall is None and station.height != station.width:
                raise PydanticCustomError(
                    "stations",
                    f"'stations' has height = {station.height:g} and width = {station.width:g} at {station.at:g} m "
                    "without 'wall', which others have; give it there too",
                )
            scales = scales_at([station], np.array(station.at))
            for limit in self._here(scales, station.thickness)._limits:
                if not limit.kept:
                    raise PydanticCustomError(
                        "stations",
                        f"'stations' makes '{limit.key}' {limit.wall:g} m at {station.at:g} m; it must be "
                        f"{limit.said}, {limit.most:g} m there",
                    )

    def area_along(self, s: Scales) -> Array:
        """Area at places [m^2]."""
        here = self._at(s)
        return super().area_along(s) if here is None else np.asarray(here.area)

    def second_moment_along(self, s: Scales) -> Array:
        """Second moment of area about E1 through the area centre, at places [m^4]."""
        here = self._at(s)
        return super().second_moment_along(s) if here is None else np.asarray(here.second_moment)

    def shear_factor_along(self, s: Scales, poisson: Array) -> Any:
        """The shear factor at places with a Poisson's ratio [1]."""
        here = self._at(s)
        return (self if here is None else here).shear_factor_for(poisson)

    def mass_along(self, s: Scales) -> Array:
        """Mass per length at places over the nominal one [1]."""
        return super().mass_along(s) if s.wall is None else s.density * self.area_along(s) / self.area

    def mass_spread_along(self, s: Scales) -> Array:
        """`mass_spread` at places [1]."""
        here = self._at(s)
        return super().mass_spread_along(s) if here is None else np.asarray(here.mass_spread)


class Tube(Walled):
    """A round tube."""

    stays_in_proportion: ClassVar[bool] = True
    shape: Literal["tube"] = "tube"
    diameter: Annotated[float, Quantity("m", above=0)]
    """Outer diameter."""
    wall: Annotated[float, Quantity("m", above=0)]
    """Thickness of the wall, below half the diameter."""

    @property
    def _limits(self) -> tuple[_Limit, ...]:
        return (_Limit("wall", self.wall, self.diameter / 2, "below half the diameter"),)

    def _here(self, s: Scales, wall: Any) -> Self:
        return self.model_copy(update={"diameter": self.diameter * s.height, "wall": self.wall * wall})

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


def _thin_walled(poisson: Any, m: Any, across: Any) -> Any:
    """Cowper's factor of flanges and webs that are thin; across : the part of the flanges in the denominator."""
    webs = 12 + 72 * m + 150 * m**2 + 90 * m**3 + poisson * (11 + 66 * m + 135 * m**2 + 90 * m**3)
    return 10 * (1 + poisson) * (1 + 3 * m) ** 2 / (webs + across)


class HollowRectangle(Walled):
    """A rectangle with a hollow inside and one thickness of wall."""

    shape: Literal["hollow rectangle"] = "hollow rectangle"
    height: Annotated[float, Quantity("m", above=0)]
    """Outer height, in the plane of motion."""
    width: Annotated[float, Quantity("m", above=0)]
    """Outer width, across the plane of motion."""
    wall: Annotated[float, Quantity("m", above=0)]
    """Thickness of the wall, below half the height and half the width."""

    @property
    def _limits(self) -> tuple[_Limit, ...]:
        return (
            _Limit("wall", self.wall, self.height / 2, "below half the height"),
            _Limit("wall", self.wall, self.width / 2, "below half the width"),
        )

    def _here(self, s: Scales, wall: Any) -> Self:
        outline = {"height": self.height * s.height, "width": self.width * s.width}
        return self.model_copy(update={**outline, "wall": self.wall * wall})

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


class ISection(Walled):
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

    @property
    def _limits(self) -> tuple[_Limit, ...]:
        return (
            _Limit("flange", self.flange, self.height / 2, "below half the height"),
            _Limit("web", self.web, self.width, "at most the width", allowed=True),
        )

    def _here(self, s: Scales, wall: Any) -> Self:
        outline = {"height": self.height * s.height, "width": self.width * s.width}
        return self.model_copy(update={**outline, "flange": self.flange * wall, "web": self.web * wall})

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
