"""The calibration of section 2.8 repeated: stiffness and loads of the worm from measurements on worms."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Quantity
from cosserat.peristalsis.instant import InstantProblem
from cosserat.problem import ALONE, Problem, Run
from cosserat.problems.calibration import condition_of
from cosserat.problems.crawl import Crawl
from cosserat.solution import Field, Solution
from cosserat.thesis.earthworm import CIRCULAR, LONGITUDINAL, SEGMENT_50, refuse_segments

Array = NDArray[np.float64]
OUTCOMES = ("ratio of mu_1", "ratio of mu_3", "p in longitudinal", "p in circular")
"""Targets: the ratios (2.8.6) of segment 50, circular over longitudinal contraction, and its two pressures."""


class WormCalibration(Problem):
    """A worm, and the targets for its segment 50.

    The page says that it calibrated E, D and p "to match the expected outcomes", but does not say how.  ASSUME least
    squares of the four relative misfits, E2.27.
    """

    kind: Literal["worm calibration"] = "worm calibration"
    worm: Crawl
    """The worm whose E, D and p are fitted; its values are the start of the fit."""
    mu_1_ratio: Annotated[float, Quantity("1", r"\mu_1", "2.8.6", above=0)]
    """Radial stretch of segment 50, circular over longitudinal contraction."""
    mu_3_ratio: Annotated[float, Quantity("1", r"\mu_3", "2.8.6", above=0)]
    """Axial stretch of segment 50, circular over longitudinal contraction."""
    p_longitudinal: Annotated[float, Quantity("Pa", "p_{coelom}", "2.8.8", above=0)]
    """Coelomic pressure of segment 50 in longitudinal contraction."""
    p_circular: Annotated[float, Quantity("Pa", "p_{coelom}", "2.8.8", above=0)]
    """Coelomic pressure of segment 50 in circular contraction."""

    @model_validator(mode="after")
    def _can_be_fitted(self) -> Self:
        if self.worm.crawler.material.kind != "incompressible":
            raise PydanticCustomError(
                "worm",
                "'worm.crawler.material.kind' is 'compressible'; only 'incompressible' has a p_coelom",
            )
        refuse_segments(self.worm)
        if not (self.worm.loads.anchoring > 0 and self.worm.loads.advancing > 0):
            raise PydanticCustomError(
                "worm",
                "'worm.loads' has a load that is not above 0; give both; the fit starts from them",
            )
        return self

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """E, D and p of the fit, and ratios of the fitted and of the given worm's outcomes to the measured ones.

        Raises
        ------
        InputError : the loads collapse a section.  NotConvergedError : an instant has no solution.
        OutOfReachError : the surface of the worm cannot stay on the ground.
        """
        from scipy.optimize import least_squares

        def misfit(logarithms: Array) -> Array:
            return self.fractions(self.loaded(*np.exp(logarithms)), name) - 1

        body, loads = self.worm.crawler, self.worm.loads
        start = np.log([body.material_young, loads.anchoring, loads.advancing])
        fit = least_squares(misfit, start, xtol=1e-12, ftol=1e-12, gtol=1e-12)
        young, anchoring, advancing = np.exp(fit.x)
        fields: dict[str, Field] = {
            "fitted_young": ((), np.array(young)),
            "fitted_anchoring": ((), np.array(anchoring)),
            "fitted_advancing": ((), np.array(advancing)),
            "fitted_outcomes": (("outcome",), fit.fun + 1),
            "given_outcomes": (("outcome",), self.fractions(self.worm, name)),
        }
        statistics = {"misfit_evaluations": int(fit.nfev), "condition_number": condition_of(fit)}
        return Solution(fields, statistics, {"outcome": OUTCOMES})

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """Number of misfits."""
        return f"{statistics['misfit_evaluations']} evaluations of the misfits"

    def loaded(self, young: float, anchoring: float, advancing: float) -> Crawl:
        """The worm with this modulus [Pa], force [N] and pressure [Pa]."""
        body = self.worm.crawler
        return self.worm.replace(
            crawler=body.replace(material=body.material.replace(young=young)),
            loads=self.worm.loads.replace(anchoring=anchoring, advancing=advancing),
        )

    def fractions(self, worm: Crawl, name: str) -> Array:
        """Outcomes of segment 50 over their targets, in the order of `OUTCOMES`, shape (4,)."""
        (mu_1, mu_3, p), (long_1, long_3, long_p) = (
            self._segment(worm, phase, name) for phase in (CIRCULAR, LONGITUDINAL)
        )
        wanted = (self.mu_1_ratio, self.mu_3_ratio, self.p_longitudinal, self.p_circular)
        return np.array([mu_1 / long_1, mu_3 / long_3, long_p, p]) / wanted

    def _segment(self, worm: Crawl, phase: float, name: str) -> tuple[float, float, float]:
        """mu_1, mu_3 and pressure of segment 50."""
        regions = worm.gait.regions(phase)
        problem = InstantProblem(worm.crawler, worm.loads, regions, name)
        profile, _, _ = worm.solve_instant(problem, None)
        mu, _, mu_3, multiplier = profile.at(np.array([SEGMENT_50]))
        return float(mu[0, 0]), float(mu_3[0]), float(worm.pressure(mu, multiplier)[0])
