"""Regions of the body, each with one load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Muscle = Literal["anchoring", "advancing", "relaxed"]


@dataclass(frozen=True)
class Region:
    """Range of one of the loads, in fractions of the length.

    amplitude : part of the load that acts.  own : its full strength [N or Pa], if not that of the loads.
    """

    left: float
    right: float
    load: Muscle
    amplitude: float = 1.0
    own: float | None = None

    @property
    def state(self) -> tuple[Muscle, float, float | None]:
        """What acts, wherever it is."""
        return self.load, self.amplitude, self.own


def merged(regions: Sequence[Region]) -> tuple[Region, ...]:
    """The same loads without junctions between equal ones."""
    found = [regions[0]]
    for region in regions[1:]:
        if region.state == found[-1].state:
            found[-1] = replace(found[-1], right=region.right)
        else:
            found.append(region)
    return tuple(found)


def continued(forces: Sequence[float | None]) -> list[float | None]:
    """Forces of regions without one: that of the nearest region behind that has one, else of the nearest ahead.

    That is the condition that closes (2.4.19), at gamma.
    """
    found = list(forces)
    for order in (range(1, len(found)), range(len(found) - 2, -1, -1)):
        for number in order:
            if found[number] is None:
                found[number] = found[number - 1 if order.step > 0 else number + 1]
    return found


def strength_along(
    regions: Sequence[Region], z: Array, load: Muscle, usual: float | None = None
) -> Array:
    """Force or pressure of the muscles of one kind at places z [N or Pa], zero where the others act.

    usual : where a region has none of its own; by default one wherever these muscles act.
    """
    cuts = [r.right for r in regions[:-1]]
    own = [
        0.0
        if r.load != load
        else 1.0
        if usual is None
        else (usual if r.own is None else r.own) * r.amplitude
        for r in regions
    ]
    result: Array = np.array(own)[np.searchsorted(cuts, z, side="right")]
    return result


def changed(before: Sequence[Region], after: Sequence[Region]) -> float:
    """The fraction of the body on which two sets of regions have different loads."""
    return sum(
        max(0.0, min(a.right, b.right) - max(a.left, b.left))
        for a in before
        for b in after
        if a.load != b.load
    )


def load_behind(front: str) -> Muscle:
    """The load behind a front, "gamma" or "eta"."""
    return "anchoring" if front == "gamma" else "advancing"


def load_ahead(front: str) -> Muscle:
    """The load before a front."""
    return "advancing" if front == "gamma" else "anchoring"
