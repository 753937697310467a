"""Paths of fronts and anchors: piecewise-linear tracks through the body in the phases of a stride."""

from __future__ import annotations

import bisect
import itertools
from collections.abc import Sequence
from typing import Annotated

from pydantic_core import PydanticCustomError

from cosserat.parameters import Items
from cosserat.peristalsis.chambers import NEAR, Phase, Place

_MOST_POINTS = 5000
_MOST_COMPARED = 3_000_000  # pairs of tracks at the points of all
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


def check_work(tracks: Sequence[Sequence[tuple[float, ...]]]) -> None:
    """Raise PydanticCustomError if tracks have too many points to be compared with each other at once."""
    points = sum(map(len, tracks))
    if points > _MOST_POINTS or points * len(tracks) ** 2 > _MOST_COMPARED:
        raise PydanticCustomError(
            "gait",
            f"has {len(tracks)} tracks of {points} points together, too many to compare; give fewer of either",
        )


def check_track(name: str, track: Track, phases: int) -> None:
    """Raise PydanticCustomError if a track does not advance through a stride of so many phases, on the body."""
    if len(track) < 2:
        raise PydanticCustomError("gait", f"{name} has {len(track)} points; a track needs two or more")
    for (a, _), (b, _) in itertools.pairwise(track):
        if b <= a:
            raise PydanticCustomError(
                "gait", f"{name} goes from phase {a:g} to phase {b:g}; let its times increase"
            )
    if track[-1][0] > phases + PHASE_TOLERANCE:
        raise PydanticCustomError(
            "gait",
            f"{name} ends at phase {track[-1][0]:g}, but 'phases' has {phases}; end it there",
        )
    for phase, place in track:
        if not 0 <= place <= 1:
            raise PydanticCustomError(
                "gait",
                f"{name} is at {place:g} at phase {phase:g}, off the body; places run from 0 to 1",
            )


def distinct(phases: list[float]) -> list[float]:
    """Phases in increasing order, without duplicates."""
    ordered = sorted(phases)
    return [p for k, p in enumerate(ordered) if k == 0 or p - ordered[k - 1] > PHASE_TOLERANCE]
