"""Crawls and postures that move with parameters, by the tangent of every instant.

derived: the rear end moves by the difference of two distances of an anchor from it, eqs. (2.5.10), (2.5.11), so its
rate is the sum of the differences of theirs.  The instants at the events of a gait, where tracks turn, begin or end and
the anchor changes, go with these; the others keep their phases.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import InputError
from cosserat.peristalsis.ground import Pose
from cosserat.peristalsis.moved_pose import OF_STRETCHES, Mask, MovedPose, SectionFields, scale_rates
from cosserat.peristalsis.rates import Layout, Numbers, numbers_rate, profile_rates, stacked
from cosserat.peristalsis.tracks import PHASE_TOLERANCE
from cosserat.problems.crawl import Crawl, Posture
from cosserat.problems.crawler import CrawlerProblem
from cosserat.problems.tangents import Motion, Nearby
from cosserat.solution import Solution

Array = NDArray[np.float64]
_SINGULAR = (
    "an instant is at a limit point or a bifurcation, where it has no derivative; change the loads a bit"
)
_STEP = "'step' says how many instants there are, and a result changes at once with their number"
_EVENTS = "two events of the gait at one time come apart with it, and their order counts; move one a bit"
_PASSES = "an event of the gait passes an instant with it; take another 'step'"
_LACKS = "muscles act on one side of a front and not on the other, so what they do at a section jumps"


@dataclass(frozen=True)
class Rate:
    """How a field moves with J parameters: rates (J, ...) of its values, and where it has a kink."""

    values: Array
    kinks: Mask


class MovedCrawl:
    """A result that moves with one parameter, to first order.

    base : the result.  rates : of its fields by name.  number : of the parameter.
    """

    lacks = _LACKS

    def __init__(self, base: Solution, rates: Mapping[str, Rate], number: int) -> None:
        self.base, self.rates, self.number = base, rates, number

    def solution(self, step: float) -> Solution:
        """Fields after a step."""
        fields = {}
        for name, rate in self.rates.items():
            dims, values = self.base.fields[name]
            moved = values + step * rate.values[self.number]
            kinks = rate.kinks[self.number]
            if kinks.any():  # the same to both sides: no derivative
                moved = moved + abs(step) * np.abs(values).max() * kinks
            fields[name] = (dims, moved)
        return Solution(fields, {}, self.base.labels)


def moving_crawl(problem: Crawl, nearby: Sequence[Nearby], name: str, wanted: Set[str]) -> Motion:
    """A crawl and how it moves with each parameter.

    Raises
    ------
    InputError, NotConvergedError, OutOfReachError : there is no such crawl.
    """
    solved = problem.solved(name)
    layout = Layout.of([pose.instant for pose in solved.every], problem.crawler.pieces)

    def numbers(changed: Crawl) -> Numbers:
        own = layout if _keeps_fronts(problem, changed) else _carried(problem, changed)
        return Numbers.of(own, changed.crawler, changed.loads, changed.gait.duration)

    base = problem.solution(solved)
    names = set(wanted) & set(base.fields)

    def rates(moved: Sequence[MovedPose]) -> dict[str, Rate]:
        return _of_crawl(problem, solved.poses, moved, names)

    return _motion(solved.every, base, nearby, names, (numbers, rates))


def moving_posture(problem: Posture, nearby: Sequence[Nearby], name: str, wanted: Set[str]) -> Motion:
    """A posture and how it moves with each parameter; raises what `moving_crawl` does."""
    pose = problem.solved(name)
    base = problem.solution(pose)
    names = set(wanted) & set(base.fields)

    def numbers(changed: Posture) -> Numbers:
        own = Layout.of([changed.instant], changed.crawler.pieces)
        return Numbers.of(own, changed.crawler, changed.loads, 0.0)

    def rates(moved: Sequence[MovedPose]) -> dict[str, Rate]:
        found = SectionFields(moved[0], problem.places).named(names)
        of_body = _of_body(problem, moved[0].numbers, names)
        return {name: Rate(*own) for name, own in found.items()} | of_body

    return _motion([pose], base, nearby, names, (numbers, rates))


def _motion(
    poses: Sequence[Pose],
    base: Solution,
    nearby: Sequence[Nearby],
    wanted: set[str],
    ways: tuple[Callable[[Any], Numbers], Callable[[Sequence[MovedPose]], dict[str, Rate]]],
) -> Motion:
    """How poses move; ways : the numbers of a changed problem, and the rates of fields from moved poses."""
    numbers, fields = ways
    found: list[Numbers] = []
    lost, place = [""] * len(nearby), [0] * len(nearby)
    for k, near in enumerate(nearby):
        try:
            found.append(numbers_rate(_after(numbers, near)))
            place[k] = len(found) - 1
        except InputError as error:
            lost[k] = str(error)
    if not found:
        return Motion(base, tuple(MovedCrawl(base, {}, 0) for _ in nearby), tuple(lost))
    moved = _moved(poses, stacked(found), whole=bool(wanted & OF_STRETCHES))
    if moved is None:
        return Motion(base, tuple(MovedCrawl(base, {}, 0) for _ in nearby), (_SINGULAR,) * len(lost))
    rates = fields(moved)
    return Motion(base, tuple(MovedCrawl(base, rates, own) for own in place), tuple(lost))


def _after(numbers: Callable[[Any], Numbers], near: Nearby) -> Callable[[float], Numbers]:
    return lambda step: numbers(near(step))


def _keeps_fronts(problem: Crawl, changed: Crawl) -> bool:
    """Whether fronts, anchors and joints of a changed crawl are where they are.

    Raises
    ------
    InputError : the number of its instants may not be theirs.
    """
    if changed.step != problem.step:
        raise InputError(_STEP)
    joints, own = ([(p.left, p.right) for p in one.crawler.pieces] for one in (problem, changed))
    return joints == own and (changed.gait is problem.gait or changed.gait == problem.gait)


def _carried(problem: Crawl, changed: Crawl) -> Layout:
    """The instants of a changed gait: those at its events go with them, the others stay at their phases.

    Raises
    ------
    InputError : there are no such instants.
    """
    before, after = np.array(problem.gait.breaks()), np.array(changed.gait.breaks())
    if before.size != after.size:
        raise InputError(_EVENTS)
    phases = np.array(problem.gait.divided(problem.step))
    event = np.searchsorted(before[:-1], phases - PHASE_TOLERANCE)
    phases = np.where(np.abs(before[event] - phases) <= PHASE_TOLERANCE, after[event], phases)
    if (np.diff(phases) <= 0).any():
        raise InputError(_PASSES)
    stages = changed.stages([changed.gait.instant(float(phase)) for phase in phases])
    return Layout.of([m for stage in stages for m in stage], changed.crawler.pieces)


def _moved(poses: Sequence[Pose], rates: Numbers, *, whole: bool) -> list[MovedPose] | None:
    """The poses with their rates by J parameters; None where one has none."""
    cuts = np.cumsum([0, *(len(pose.problem.spans) for pose in poses)]).tolist()
    found = []
    for pose, (begin, end) in zip(poses, pairwise(cuts), strict=True):
        assert pose.nodal is not None  # the solver is the banded one
        own = rates.part(slice(begin, end))
        moved = profile_rates(pose.problem, pose.profile, pose.nodal, pose.along, own)
        if moved is None:
            return None
        found.append(MovedPose(pose, moved, own, whole=whole))
    return found


def _of_crawl(
    problem: Crawl, stages: Sequence[Sequence[Pose]], moved: Sequence[MovedPose], wanted: set[str]
) -> dict[str, Rate]:
    """Rates of the wanted fields of a crawl, (J, T) or (J, T, K); moved : the poses of all its stages."""
    numbers, first = moved[0].numbers, len(stages[0])
    order = [list(range(first)), list(range(first, len(moved)))][: len(stages)]
    strides = problem.strides_of(order)
    steps = [k for stride in strides for k in stride]
    duration = np.repeat(np.arange(len(strides)), [len(stride) for stride in strides])
    length, places = problem.crawler.length, np.array([moved[k].pose.instant.anchor for k in steps])
    rear, anchor = _ground(moved, steps)
    found: dict[str, Array] = {
        "time": numbers.times[:, steps] + duration * numbers.duration[:, None],
        "anchor": numbers.anchors[:, steps] * length + places * numbers.body[:, :1],
        "anchor_along": rear + anchor,
    }
    rates = {name: Rate(own, np.zeros(own.shape, np.bool_)) for name, own in found.items()}
    sections = [SectionFields(one, problem.places).named(wanted) for one in moved]
    for name in sections[0]:
        values = np.stack([one[name][0] for one in sections], axis=1)[:, steps]
        kinks = np.stack([one[name][1] for one in sections], axis=1)[:, steps]
        rates[name] = Rate(values + rear[..., None] if name == "along" else values, kinks)
    return rates | _of_body(problem, numbers, wanted)


def _ground(moved: Sequence[MovedPose], steps: Sequence[int]) -> tuple[Array, Array]:
    """Rates (J, T) of the places of the rear end, and of the distances of the anchors from it, as `ground.placed`."""
    known: dict[tuple[int, int], Array] = {}

    def along(pose: int, at: int) -> Array:
        """Rate of the distance of one pose to the anchor of another."""
        if (pose, at) not in known:
            place = moved[at].pose.instant.anchor
            known[pose, at] = moved[pose].along_rate(place, moved[at].numbers.anchors[:, at])
        return known[pose, at]

    anchor = np.array([along(k, k) for k in steps])
    before = np.array([along(k, at) for k, at in pairwise(steps)])
    moves = before - anchor[1:]
    rear = np.concatenate([np.zeros_like(anchor[:1]), np.cumsum(moves, axis=0)])
    return rear.T, anchor.T


def _of_body(problem: CrawlerProblem, numbers: Numbers, wanted: set[str]) -> dict[str, Rate]:
    """Rates of the wanted fields of the resting body."""
    found = {"xi_section": problem.places * numbers.body[:, :1]}
    if problem.crawler.segments:
        pieces = problem.crawler.pieces
        scales, rates = scale_rates(pieces, numbers.pieces, problem.places)
        found["resting_radius"] = (
            rates[0] * problem.crawler.radius + scales.radius * numbers.body[:, 1:2]
        )
    return {
        name: Rate(own, np.zeros(own.shape, np.bool_)) for name, own in found.items() if name in wanted
    }
