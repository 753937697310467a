"""Numbers of the thesis that follow from others of it, computed again without a solver.

These functions take no Dataset, so no answer of a solver can replace the arithmetic.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from cosserat.exact import beams
from cosserat.thesis import earthworm
from cosserat.thesis.table.printed import beam, number


def _mass() -> float:
    return number("worm", "crawler.mass")


def _diameter() -> float:
    """Rounded as in Table 2.1; section 2.8 uses this value."""
    return 2 * number("worm", "crawler.radius")


ARITHMETIC: dict[str, Callable[[], float]] = {
    "stride_scaling": lambda: 1e-3 * 15 * (1e3 * _mass()) ** 0.4,
    "stance_time": lambda: earthworm.stance_time(_mass()),
    "protrusion_time": lambda: earthworm.protrusion_time(_mass()),
    "resting_length": lambda: earthworm.resting_length(_mass()),
    "resting_diameter": lambda: earthworm.resting_diameter(_mass()),
    "circumference": lambda: earthworm.circumference(_diameter()),
    "peak_force": lambda: earthworm.peak_force(_diameter()),
    "peak_pressure": lambda: earthworm.peak_pressure(_diameter()),
    "first_root": lambda: beams.first_root() / np.pi,
    "first_factor": lambda: beams.first_root() ** 2,
    "kinetic_energy_period_of_beam_theory": lambda: float(
        np.pi / beams.first_frequency(beam("vibration_c4_20"))
    ),
}
"""Functions by their names in the table."""
