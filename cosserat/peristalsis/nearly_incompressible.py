"""The compressible rod of section 2.3 compared with the incompressible one of section 2.4 as nu tends to 1/2."""

from __future__ import annotations

import numpy as np

from cosserat.peristalsis.crawler import Compressible, Crawler, Loads
from cosserat.peristalsis.instant import InstantProblem
from cosserat.peristalsis.region import Region
from cosserat.solvers.regions import RegionSettings

_REGIONS = (
    Region(0.0, 0.25, "anchoring"),
    Region(0.25, 0.75, "advancing"),
    Region(0.75, 1.0, "anchoring"),
)
_PLACES = np.linspace(0.0, 1.0, 2001)


def largest_difference(crawler: Crawler, loads: Loads, poisson: float, fraction: float) -> float:
    """Largest difference of mu_1, mu_2 between an incompressible body and one of Poisson's ratio `poisson`.

    Both have the same Young's modulus and the same fraction of the loads and of the weight, with the junctions of
    section 2.4: the contact force continues through the advancing half between two anchoring quarters.

    derived: at nu = 1/2 the compressible rod keeps the sum mu_1 + mu_2 + mu_3 = 3, eq. (2.3.2), the incompressible one
    the product of the stretches, eq. (2.4.1); they differ by products of two strains.

    Raises
    ------
    InputError : the loads collapse a section.  NotConvergedError : no solution.
    """
    weak = loads.replace(
        anchoring=fraction * loads.anchoring,
        advancing=fraction * loads.advancing,
        gravity=fraction * loads.gravity,
        advancing_force="continuous",
    )
    soft = crawler.replace(material=Compressible(young=crawler.material_young, poisson=poisson))
    mu = [
        InstantProblem(body, weak, _REGIONS, f"nu = {poisson:g}")
        .solve(RegionSettings(), None)[0]
        .at(_PLACES)[0]
        for body in (soft, crawler)
    ]
    return float(np.abs(mu[0] - mu[1]).max())
