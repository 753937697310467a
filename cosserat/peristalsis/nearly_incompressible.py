"""How near the compressible rod of section 2.3 comes to the incompressible one of section 2.4 as nu tends to 1/2."""

from __future__ import annotations

import numpy as np

from cosserat.peristalsis.crawler import Compressible, Crawler, Loads
from cosserat.peristalsis.instant import Instant, Region
from cosserat.solvers.regions import RegionSettings

_REGIONS = (
    Region(0.0, 0.25, "anchoring"),
    Region(0.25, 0.75, "advancing"),
    Region(0.75, 1.0, "anchoring"),
)
_PLACES = np.linspace(0.0, 1.0, 2001)


def apart(crawler: Crawler, loads: Loads, poisson: float, share: float) -> float:
    """Largest difference of mu_1, mu_2 between an incompressible body and one of Poisson's ratio `poisson`.

    Both of the same Young's modulus, under the same share of the loads and of the weight, with the junctions of section
    2.4: the contact force goes on through the advancing half between two anchoring quarters.

    derived: the linear volume mu_1 + mu_2 + mu_3 = 3, which the one keeps at nu = 1/2, eq. (2.3.2), and the product of
    the stretches, which the other keeps, eq. (2.4.1), differ by products of two strains.

    Raises
    ------
    InputError : the loads collapse a section.  NotConvergedError : no solution.
    """
    weak = loads.replace(
        anchoring=share * loads.anchoring,
        advancing=share * loads.advancing,
        gravity=share * loads.gravity,
        advancing_force="continuous",
    )
    soft = crawler.replace(material=Compressible(young=crawler.material_young, poisson=poisson))
    mu = [
        Instant(body, weak, _REGIONS, f"nu = {poisson:g}")
        .solve(RegionSettings(), None)[0]
        .at(_PLACES)[0]
        for body in (soft, crawler)
    ]
    return float(np.abs(mu[0] - mu[1]).max())
