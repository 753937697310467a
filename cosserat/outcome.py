"""What a problem gives back: named arrays and the solver's statistics, without units or metadata.

The names are those of `cosserat.data.variables`, which knows dimensions, units and meaning.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Outcome:
    """fields : arrays by variable name, SI units.  statistics : what the solver did, by name.

    along : the dimension that a field with one more than it has in `data.variables` begins with.
    warnings : what a user should know before using the numbers, a sentence each that begins with a name.
    """

    fields: Mapping[str, NDArray[np.float64]]
    statistics: Mapping[str, int | float]
    along: str = "time"
    warnings: tuple[str, ...] = ()
