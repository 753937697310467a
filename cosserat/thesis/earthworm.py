"""Earthworms of every size: the empirical scalings of Table 2.1, and the same gait at another body mass."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Quantity
from cosserat.problem import ALONE, Problem, Run
from cosserat.problems.crawl import Crawl
from cosserat.solution import Field, Solution

Array = NDArray[np.float64]

Muscles = Literal["strip tension", "strip tension, constant pressure", "constant stress"]
MUSCLE_LAWS: dict[Muscles, tuple[float, float]] = {
    "strip tension": (1.0, -1.0),
    "strip tension, constant pressure": (1.0, 0.0),
    "constant stress": (2.0, 0.0),
}
"""Powers of the radius that scale the anchoring force and the advancing pressure.

In section 2.8 a strip of muscle one millimetre wide has the same tension in every worm.  The force is then
proportional to the circumference.  The pressure is inversely proportional to the radius by hoop balance, or constant
as the 5.7 kPa of the thesis.  Muscle of constant stress whose thickness is proportional to the radius gives the third
law.
"""

SEGMENT_50 = 3 / 5
"""Place of segment 50, two fifths of the length from the front end, section 2.8."""

CIRCULAR, LONGITUDINAL = 1.5, 0.5
"""Phases at which it lies well inside an advancing and an anchoring region: t_p + t_s/2 and t_p/2."""

STRIP_TENSION = 0.186 * 9.80665e-3
"""Peak tension of a strip of longitudinal muscle, eq. (2.8.1) [N]."""
STRIP_WIDTH = 1e-3
"""Width of that strip, section 2.8 [m]."""


def peak_force(diameter: float) -> float:
    """Force of strips of longitudinal muscle side by side round the body, eq. (2.8.3) [N]; diameter in m."""
    return STRIP_TENSION * circumference(diameter) / STRIP_WIDTH


def peak_pressure(diameter: float) -> float:
    """The pressure (2.8.2) by its probable derivation, E2.13: the force over diameter and strip width [Pa]."""
    return peak_force(diameter) / (diameter * STRIP_WIDTH)


def circumference(diameter: float) -> float:
    """Circumference of a round body, section 2.8 [m]; diameter in m."""
    return float(np.pi * diameter)


def stance_time(mass: float) -> float:
    """t_s = 1.6 m^0.04, m in g, Table 2.1 [s]; mass in kg."""
    return float(1.6 * (1e3 * mass) ** 0.04)


def protrusion_time(mass: float) -> float:
    """t_p = 2.5 m^0.1, m in g, Table 2.1 [s]; mass in kg."""
    return float(2.5 * (1e3 * mass) ** 0.1)


def resting_length(mass: float) -> float:
    """l_0 = 10^2 m^0.397 mm, m in g, Table 2.1 [m]; mass in kg."""
    return float(0.1 * (1e3 * mass) ** 0.397)


def resting_diameter(mass: float) -> float:
    """2 R = 10^0.6 m^0.278 mm, m in g, Table 2.1 [m]; mass in kg."""
    return float(1e-3 * 10**0.6 * (1e3 * mass) ** 0.278)


def refuse_segments(worm: Crawl) -> None:
    """Raise PydanticCustomError if the body of a worm varies: those of section 2.8 do not."""
    if worm.crawler.segments:
        raise PydanticCustomError(
            "segments",
            "'worm.crawler.segments' is given; the worms of section 2.8 are uniform; leave it out",
        )


class BodyMass(Problem):
    """The crawl of a worm of another body mass, under one law for its muscles.

    Table 2.1 replaces length, radius, mass and durations of the worm, and the law replaces its loads.  It makes one
    stride.
    """

    kind: Literal["body mass"] = "body mass"
    worm: Crawl
    """The worm that is scaled."""
    body_mass: Annotated[float, Quantity("kg", "m", "2.8.4", above=0)]
    """Body mass to which it is scaled."""
    muscles: Muscles = "constant stress"
    """Scaling law of the force and the pressure of the muscles with the body mass."""

    @model_validator(mode="after")
    def _can_be_scaled(self) -> Self:
        refuse_segments(self.worm)
        if len(self.worm.gait.phases) != 2:
            raise PydanticCustomError(
                "phases",
                f"'worm.gait.phases' has {len(self.worm.gait.phases)}; give two, protrusion and stance; "
                "Table 2.1 replaces their durations",
            )
        return self

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """Stride, speed, frequency and the extreme stretches of segment 50.

        Raises
        ------
        InputError : the loads collapse a section.  NotConvergedError : an instant has no solution.
        OutOfReachError : the surface of the worm cannot stay on the ground.
        """
        crawl = self.scaled()
        crawl.check_collapse(name)
        solved = crawl.solve(name, Run(run.progress))
        at = int(np.argmin(np.abs(crawl.places - SEGMENT_50)))
        mu_1, mu_3 = solved["mu_1"][:, at], solved["mu_3"][:, at]
        stride = float(solved["along"][-1, -1] - solved["along"][0, -1])
        duration = stance_time(self.body_mass) + protrusion_time(self.body_mass)
        values = {
            "stride": stride,
            "speed": stride / duration,
            "frequency": 1 / duration,
            "mu_1_least": mu_1.min(),
            "mu_1_most": mu_1.max(),
            "mu_3_least": mu_3.min(),
            "mu_3_most": mu_3.max(),
        }
        fields: dict[str, Field] = {key: ((), np.array(value)) for key, value in values.items()}
        return Solution(fields, solved.statistics, warnings=solved.warnings)

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """That of its crawl."""
        return Crawl.summary(statistics, sizes)

    def scaled(self) -> Crawl:
        """One stride of the worm of that mass: Table 2.1 for body and times, `MUSCLE_LAWS` for the loads."""
        mass = self.body_mass
        radius = resting_diameter(mass) / 2
        force, pressure = MUSCLE_LAWS[self.muscles]
        grown = radius / self.worm.crawler.radius
        loads = self.worm.loads
        return self.worm.replace(
            crawler=self.worm.crawler.replace(
                length=resting_length(mass), radius=radius, mass=mass, density=None
            ),
            loads=loads.replace(
                anchoring=loads.anchoring * grown**force, advancing=loads.advancing * grown**pressure
            ),
            gait=self.worm.gait.replace(phases=(protrusion_time(mass), stance_time(mass))),
            strides=1,
        )
