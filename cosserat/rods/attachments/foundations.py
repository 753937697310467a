"""Winkler's elastic foundation: independent springs along a stretch of a rod."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
from pydantic_core import PydanticCustomError

from cosserat.parameters import Quantity
from cosserat.rods.attachments.attachment import Attachment
from cosserat.rods.loads.load import LoadedRod
from cosserat.rods.places import Located
from cosserat.rods.rod import Rod

_GAUSS = ((1 - 3**-0.5) / 2, (1 + 3**-0.5) / 2)
"""Gauss's two points of a unit interval, exact for the square of a linear function."""


class Foundation(Attachment):
    """An elastic foundation of Winkler's kind along a stretch of the rod, at rest in the reference."""

    stiffness: Annotated[float, Quantity("Pa", above=0)] | None = None
    """Force per length of the rod and displacement in its direction, in N/m per m."""
    rotational_stiffness: Annotated[float, Quantity("N*m/rad/m", above=0)] | None = None
    """Moment per length of the rod and angle of its sections; "N" is read too."""
    start: Annotated[float, Quantity("m", at_least=0)] = 0.0
    """Start of the stretch along the reference centreline."""
    end: Annotated[float, Quantity("m", above=0)] | None = None
    """End of the stretch; the end of the rod by default."""

    @property
    def stiffnesses(self) -> tuple[float, float]:
        """Both, per length."""
        return self.stiffness or 0.0, self.rotational_stiffness or 0.0

    def end_on(self, rod: Rod) -> float:
        """End of the stretch [m]."""
        return rod.length if self.end is None else self.end

    def check(self, rod: Rod) -> None:
        """Require a start before the end, both on the rod."""
        end = self.end_on(rod)
        if not self.start < end <= rod.length * (1 + 1e-12):
            raise PydanticCustomError(
                "range",
                f"'foundations' has one from {self.start:g} m to {end:g} m, but the rod goes from 0 to "
                f"{rod.length:g} m; let it begin before it ends, on the rod",
            )

    def shares(self, body: LoadedRod) -> Iterator[tuple[Located, float]]:
        """Two springs on the covered part of each edge, which have the energy of linear displacements along it."""
        arc = body.geometry.arc_length
        low, high = np.maximum(arc[:-1], self.start), np.minimum(arc[1:], self.end_on(body.rod))
        for index in np.flatnonzero(high > low):
            covered = float(high[index] - low[index])
            for point in _GAUSS:
                share = (low[index] + point * covered - arc[index]) / (arc[index + 1] - arc[index])
                yield Located(int(index), float(share)), covered / 2
