"""Paths of fronts and anchors: piecewise-linear tracks through the body in the phases of a stride."""

from __future__ import annotations

import bisect
from typing import Annotated

from cosserat.parameters import Items
from cosserat.peristalsis.chambers import NEAR, Phase, Place

PHASE_TOLERANCE = NEAR
"""Phases closer than this are one."""
Track = Annotated[tuple[tuple[Phase, Place], ...], Items(at_most=10_000)]
"""A piecewise-linear path: points (phase, place)."""


def follow(track: Track, phase: float) -> float | None:
    """The place of a track at a time; it begins just after its first point, except at the start of the stride."""
    begin, end = track[0][0], track[-1][0]
    near = PHASE_TOLERANCE
    if phase > end + near or phase < begin - near or (phase < begin + near and begin > near):
        return None
    return place_of(track, phase)


def place_of(track: Track, phase: float) -> float:
    """The place of a track at a phase, beyond its ends that of its end."""
    ahead = bisect.bisect_right(track, phase, key=lambda point: point[0])
    if ahead in (0, len(track)):
        return track[max(0, ahead - 1)][1]
    (begin, start), (end, stop) = track[ahead - 1], track[ahead]
    return (stop - start) / (end - begin) * (phase - begin) + start
