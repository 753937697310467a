"""Springs at one place of a rod: straight ones, and rotational ones, such as an elastic clamp.

The rod has a vertex there: a spring inside an edge would miss a part of the compliance there, to first order.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from cosserat.parameters import Quantity
from cosserat.rods.attachments.attachment import Attachment
from cosserat.rods.loads.load import LoadedRod
from cosserat.rods.places import Located, Place, located


class Spring(Attachment):
    """A spring from one place of the rod to the ground, at rest in the reference."""

    at: Place
    """The place; the rod has a vertex there."""
    stiffness: Annotated[float, Quantity("N/m", above=0)] | None = None
    """Force per displacement in its direction."""
    rotational_stiffness: Annotated[float, Quantity("N*m/rad", above=0)] | None = None
    """Moment per angle of the section, counted through whole turns; "N*m" is read too."""

    @property
    def stiffnesses(self) -> tuple[float, float]:
        """Both."""
        return self.stiffness or 0.0, self.rotational_stiffness or 0.0

    @property
    def places(self) -> tuple[str | int, ...]:
        """Its place."""
        return (self.at,)

    def shares(self, body: LoadedRod) -> Iterator[tuple[Located, float]]:
        """One."""
        yield located(self.at, body.geometry.arc_length), 1.0
