"""Where a crawling body is along the ground, eqs. (2.5.10), (2.5.11)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cosserat.peristalsis.gait import Instant
from cosserat.peristalsis.instant import InstantProblem
from cosserat.peristalsis.profile import Profile

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Pose:
    """The body at an instant of a stride.

    problem : the one that its profile solves.  along : (M, p + 1) distance along the ground from the rear end [m].
    nodal : the start of the next solve.  tilt : the largest sine of it.
    """

    instant: Instant
    problem: InstantProblem
    profile: Profile
    along: Array
    nodal: Array | None
    tilt: float

    def along_at(self, place: float) -> float:
        """Distance along the ground from the rear end to a place [m]."""
        return float(self.profile.mesh.interpolate(self.along, np.array([place]))[0])


@dataclass(frozen=True)
class Step:
    """One time of a crawl: the body there, and where its rear end and its anchor are along the ground [m]."""

    time: float
    pose: Pose
    rear: float
    anchor: float


def placed(strides: Sequence[Sequence[Pose]], duration: float) -> list[Step]:
    """Poses on the ground: the anchor of an instant stays where it was at the instant before.

    strides : the poses of each.  duration : of one [s].
    """
    steps: list[Step] = []
    for number, poses in enumerate(strides):
        for pose in poses:
            place, anchor = pose.instant.anchor, pose.along_at(pose.instant.anchor)
            rear = steps[-1].rear + (steps[-1].pose.along_at(place) - anchor) if steps else 0.0
            steps.append(Step(number * duration + pose.instant.time, pose, rear, rear + anchor))
    return steps
