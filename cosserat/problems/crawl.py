"""Problems of Chapter 2: one instant of a rod under muscle loads, and a crawl: a gait repeated over several strides."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Count, Items, Parameters, Quantity
from cosserat.peristalsis import anchors
from cosserat.peristalsis.gait import Gait, Instant
from cosserat.peristalsis.ground import Pose, Step, placed
from cosserat.peristalsis.instant import Common, InstantProblem, holds_force
from cosserat.peristalsis.region import Muscle, Region
from cosserat.problem import ALONE, Forecast, Run
from cosserat.problems.crawler import CrawlerProblem, statistics_of
from cosserat.solution import Field, Solution

Array = NDArray[np.float64]
_SECONDS = {"banded": 5e-4, "collocation": 0.05}  # about the time of an instant
_STORED = 10  # about so many numbers are stored of each section at each instant
_MIN_REGION_LENGTH = 1e-6  # as a fraction of the length; a shorter region is empty
_EQUAL_LOADS_TOLERANCE = 1e-3  # loads that differ on less of the body are the same


class Segment(Parameters):
    """Range of a load, in fractions of the reference length."""

    begin: Annotated[float, Quantity("1", r"\tilde{\gamma}", "2.3.14")]
    """Start of the region, from the rear end."""
    end: Annotated[float, Quantity("1", r"\tilde{\eta}", "2.3.14")]
    """End of the region, from the rear end."""
    load: Muscle
    """The active muscles: longitudinal ones anchor, circular ones advance, and where it is relaxed none act."""
    force: Annotated[float, Quantity("N", r"\bar{D}", "2.2.7", at_least=0)] | None = None
    """Force of the longitudinal muscles of an anchoring region; by default that of 'loads.anchoring'."""
    pressure: Annotated[float, Quantity("Pa", "p", "2.2.8")] | None = None
    """Pressure of the circular muscles of an advancing region; by default that of 'loads.advancing'."""

    @model_validator(mode="after")
    def _has_its_own_load(self) -> Self:
        for name, load in (("force", "anchoring"), ("pressure", "advancing")):
            if getattr(self, name) is not None and self.load != load:
                raise PydanticCustomError(
                    "regions", f"has a '{name}' but is '{self.load}'; only an {load} region has one"
                )
        return self


class Posture(CrawlerProblem):
    """One instant: any sequence of regions, from the rear end to the front end."""

    kind: Literal["posture"] = "posture"
    regions: Annotated[tuple[Segment, ...], Items(1, 500)]
    """Ranges of the loads, from the rear end to the front end, without gaps."""

    @model_validator(mode="after")
    def _cover_the_body(self) -> Self:
        expected = 0.0
        for number, region in enumerate(self.regions):
            if region.end - region.begin < _MIN_REGION_LENGTH:
                raise PydanticCustomError(
                    "regions",
                    f"'regions.{number}' from {region.begin:g} to {region.end:g} is empty; leave it out or widen it",
                )
            if abs(region.begin - expected) > _MIN_REGION_LENGTH:
                what = (
                    "overlaps the one before it" if region.begin < expected else "leaves a gap before it"
                )
                raise PydanticCustomError(
                    "regions",
                    f"'regions.{number}' begins at {region.begin:g} and {what}; let it begin at {expected:g}",
                )
            expected = region.end
        if abs(expected - 1) > _MIN_REGION_LENGTH:
            raise PydanticCustomError(
                "regions", f"'regions' end at {expected:g}; they must cover the body from 0 to 1"
            )
        return self

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """Stretches and shape, the rear end at the origin.

        Raises
        ------
        InputError : the loads collapse a section.  NotConvergedError : no solution.
        OutOfReachError : the surface cannot stay on the ground.
        """
        return self.solution(self.solved(name))

    @property
    def instant(self) -> Instant:
        """The regions as an instant of a gait, anchored at the rear."""
        regions = (
            Region(r.begin, r.end, r.load, own=r.force if r.load == "anchoring" else r.pressure)
            for r in self.regions
        )
        return Instant(0.0, 0.0, tuple(regions), 0.0)

    def problem(self, name: str) -> InstantProblem:
        """The equations."""
        return InstantProblem(self.crawler, self.loads, self.instant.regions, name)

    def solved(self, name: str) -> Pose:
        """The body; raises what `solve` does."""
        problem = self.problem(name)
        profile, nodal, tilt = self.solve_instant(problem, None)
        return Pose(self.instant, problem, profile, self.length_along(profile), nodal, tilt)

    def solution(self, pose: Pose) -> Solution:
        """The result of a solved pose."""
        fields = self.fields([pose.profile], [pose.along], [pose.instant.regions])
        flat = {
            key: (dims[1:], values[0]) if dims[0] == "time" else (dims, values)
            for key, (dims, values) in fields.items()
        }
        return Solution(flat, statistics_of(self, 1, [pose.profile.effort], pose.tilt))


@dataclass(frozen=True)
class Stages:
    """A crawl that is solved.

    at_full : the problems of the instants of a stride under their full loads.  poses : of every stage of the crawl.
    """

    at_full: list[InstantProblem]
    poses: list[list[Pose]]

    @property
    def every(self) -> list[Pose]:
        """The poses of all stages."""
        return list(itertools.chain(*self.poses))


class Crawl(CrawlerProblem):
    """A gait over several strides."""

    kind: Literal["crawl"] = "crawl"
    thinned: ClassVar[Mapping[str, int]] = {"time": 40, "section": 20}
    gait: Gait
    strides: Annotated[int, Count(at_least=1, at_most=10_000)] = 3
    """Number of strides."""
    step: Annotated[float, Quantity("s", "t_{step}", "2.5.9", above=0)]
    """Longest time between two instants."""

    @model_validator(mode="after")
    def _is_possible(self) -> Self:
        self.gait.check_step(self.step)
        pulls = self.loads.anchoring > 0 or any(chamber.force for chamber in self.gait.chambers)
        if not (pulls and holds_force(self.crawler, self.loads)):
            return self
        phase = self.gait.idle_phase(self.step)
        if phase is not None:
            raise PydanticCustomError(
                "gait",
                f"at phase {phase:g} no region anchors, and the force in the advancing ones would jump to "
                "zero; keep an anchoring region, or set loads.advancing_force = 'none'",
            )
        return self

    def thin_anchors(self) -> list[Instant]:
        """The instants of a stride whose anchor lies in a thin region, by `anchors.lies_thin`."""
        instants = self.gait.instants(self.step)
        return _thin(instants, self.problems(instants, "the anchor"))

    def thin_anchor_warning(self) -> str | None:
        """One sentence on `thin_anchors`, None if there are none."""
        return anchors.warning(self.thin_anchors(), self.gait.instants(self.step), self.crawler.length)

    def problems(
        self, instants: Sequence[Instant], name: str, start: float = 0.0
    ) -> list[InstantProblem]:
        """The problems of instants, in a stride that begins at the time `start` [s]."""
        body, loads = self.crawler, self.loads
        common = Common.of(body, loads)
        return [
            InstantProblem(body, loads, m.regions, f"{name} at t = {start + m.time:.4g} s", common)
            for m in instants
        ]

    @property
    def forecast(self) -> Forecast:
        """Instants, and the sections that are stored of each."""
        instants = self.strides * self.gait.duration / self.step
        seconds, numbers = _SECONDS[self.solver] * instants, _STORED * instants * self.places.size
        remedy = "take a longer 'step' or fewer 'strides'"
        return Forecast.of(seconds, numbers, f"{instants:.3g} instants", remedy)

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """Every instant of the gait, each placed on the ground by its anchor, eqs. (2.5.10), (2.5.11).

        Raises
        ------
        InputError : the loads collapse a section.  NotConvergedError : an instant has no solution.
        OutOfReachError : the surface cannot stay on the ground.
        """
        return self.solution(self.solved(name, run))

    def solution(self, solved: Stages) -> Solution:
        """The result of solved stages."""
        steps = placed(self.strides_of(solved.poses), self.gait.duration)
        instants, poses = self.gait.instants(self.step), solved.every
        said = (
            anchors.warning(_thin(instants, solved.at_full), instants, self.crawler.length),
            self.first_stride_warning(),
        )
        return Solution(
            self._fields(steps),
            statistics_of(
                self, len(steps), [p.profile.effort for p in poses], max(p.tilt for p in poses)
            ),
            warnings=tuple(warning for warning in said if warning is not None),
        )

    def stages(self, instants: Sequence[Instant]) -> list[list[Instant]]:
        """Instants that are solved: the first stride, and the rest of a later one if the first begins relaxed."""
        rises = [self.gait.rise(m.time) for m in instants]
        if min(rises) == 1:
            return [list(instants)]
        risen = [m.risen(rise) for m, rise in zip(instants, rises, strict=True)]
        return [risen, list(instants[1:])] if self.strides > 1 else [risen]

    def strides_of(self, stages: Sequence[list[Any]]) -> list[list[Any]]:
        """What belongs to the instants of every stride, from that of the stages."""
        later = stages[1] if len(stages) > 1 else stages[0][1:]
        return [stages[0], *[later] * (self.strides - 1)]

    def solved(self, name: str, run: Run = ALONE) -> Stages:
        """The stages with their poses.

        Raises
        ------
        InputError, NotConvergedError, OutOfReachError : as `solve`.
        """
        instants = self.gait.instants(self.step)
        whole = self.problems(instants, name)
        for problem in whole:
            problem.check_collapse()
        stages, found = self.stages(instants), Stages(whole, [])
        total = sum(map(len, stages))
        for number, stage in enumerate(stages):
            problems = whole
            if self.gait.rise(0.0) < 1:
                problems = self.problems(stage, name, number * self.gait.duration)
            found.poses.append(self._solved(stage, problems, found.every, run, total))
        return found

    def _solved(
        self,
        instants: Sequence[Instant],
        problems: Sequence[InstantProblem],
        before: list[Pose],
        run: Run,
        total: int,
    ) -> list[Pose]:
        """The poses of a stride, each solved from the one before; total : how many the run solves."""
        poses: list[Pose] = []
        nodal = before[-1].nodal if before else None
        pairs = zip(instants, problems, strict=True)
        for number, (instant, problem) in enumerate(pairs, start=len(before) + 1):
            profile, nodal, tilt = self.solve_instant(problem, nodal)
            poses.append(Pose(instant, problem, profile, self.length_along(profile), nodal, tilt))
            run.progress(number / total, f"{number} of {total} instants")
        return poses

    def first_stride_warning(self) -> str | None:
        """One sentence if the first stride begins in another state than the later ones, else None."""
        changed = self.gait.first_change()
        if changed < _EQUAL_LOADS_TOLERANCE:
            return None
        return (
            f"first stride: at t = 0 the loads on {changed:.3g} of the body are not those at the end of a stride, so "
            "the first stride differs from the later ones; look at these, or let the loads rise from a relaxed body "
            "with 'gait.ramp'"
        )

    def check_collapse(self, name: str) -> None:
        """Check the homogeneous states of all instants of a stride, before anything is solved.

        Raises
        ------
        InputError : the loads collapse a section; names the load and that instant.
        """
        for problem in self.problems(self.gait.instants(self.step), name):
            problem.check_collapse()

    def _fields(self, steps: list[Step]) -> dict[str, Field]:
        fields = self.fields(
            [s.pose.profile for s in steps],
            [s.pose.along + s.rear for s in steps],
            [s.pose.instant.regions for s in steps],
        )
        places = np.array([s.pose.instant.anchor for s in steps])
        return {
            "time": (("time",), np.array([s.time for s in steps])),
            **fields,
            "anchor": (("time",), places * self.crawler.length),
            "anchor_along": (("time",), np.array([s.anchor for s in steps])),
        }


def _thin(instants: Sequence[Instant], problems: Sequence[InstantProblem]) -> list[Instant]:
    pairs = zip(instants, problems, strict=True)
    return [instant for instant, problem in pairs if anchors.lies_thin(problem, instant.anchor)]
