"""Problems of Chapter 2: one instant of a rod under muscle loads, and a crawl: a gait repeated over several strides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Count, Items, Parameters, Quantity
from cosserat.peristalsis import anchors
from cosserat.peristalsis.body import piece_at, scales_at
from cosserat.peristalsis.crawler import Crawler, Loads
from cosserat.peristalsis.gait import Gait, Instant
from cosserat.peristalsis.ground import Pose, Step, placed
from cosserat.peristalsis.instant import Common, InstantProblem, holds_force
from cosserat.peristalsis.profile import Profile, check_tilt
from cosserat.peristalsis.region import Muscle, Region, strength_along
from cosserat.problem import ALONE, Forecast, Problem, Run
from cosserat.solution import Field, Solution
from cosserat.solvers.regions import RegionSettings

Array = NDArray[np.float64]
_SECONDS = {"banded": 5e-4, "collocation": 0.05}  # about the time of an instant
_STORED = 10  # about so many numbers are stored of each section at each instant
_MIN_REGION_LENGTH = 1e-6  # as a fraction of the length; a shorter region is empty
_EQUAL_LOADS_TOLERANCE = 1e-3  # loads that differ on less of the body are the same


class CrawlerProblem(Problem):
    """The common part of an instant and a crawl."""

    thinned: ClassVar[Mapping[str, int]] = {"section": 20}
    crawler: Crawler
    loads: Loads
    solver: Literal["banded", "collocation"] = "banded"
    """Solver of an instant: "collocation" is the thesis's, `scipy.integrate.solve_bvp`, and slower."""
    collocation_tolerance: Annotated[float, Quantity("1", at_least=1e-13, below=1e-2)] = 1e-4
    """Tolerance of "collocation"."""
    mesh: RegionSettings = RegionSettings()
    sections: Annotated[int, Count(at_least=2, at_most=100_001)] = 251
    """Equally spaced cross-sections at which results are stored."""

    @model_validator(mode="after")
    def _fits_the_body(self) -> Self:
        if self.crawler.segments and (
            self.solver == "collocation" or self.loads.multiplier == "printed"
        ):
            what = (
                "'solver' = 'collocation'"
                if self.solver == "collocation"
                else "'loads.multiplier' = 'printed'"
            )
            raise PydanticCustomError(
                "segments",
                f"{what} is for a uniform body; take the default, or leave out 'crawler.segments'",
            )
        return self

    @property
    def body(self) -> str:
        """Length, radius and material of the crawler."""
        crawler = self.crawler
        return f"crawler of {crawler.length:g} m, radius {crawler.radius:g} m, {crawler.material.kind}"

    @property
    def places(self) -> Array:
        """z = xi / l_0 of the stored sections."""
        return np.linspace(0.0, 1.0, self.sections)

    def solve_instant(
        self, problem: InstantProblem, before: Array | None
    ) -> tuple[Profile, Array | None, float]:
        """Stretches of an instant, the start of the next solve, and the largest sine of tilt."""
        if self.solver == "banded":
            profile, nodal = problem.solve(self.mesh, before)
        else:
            profile, nodal = problem.collocate(self.mesh, self.collocation_tolerance), None
        return profile, nodal, check_tilt(profile, self.crawler, problem.name)

    def length_along(self, profile: Profile) -> Array:
        """Distance along the ground from the rear end, eq. (2.5.8), at the points of the mesh [m]."""
        tilt = profile.slope[..., 0] * profile.radius / self.crawler.length
        integrand: Array = np.sqrt(profile.mu_3**2 - tilt**2)  # (2.5.6)
        return profile.mesh.cumulative(integrand) * self.crawler.length

    def pressure(self, mu: Array, multiplier: Array) -> Array:
        """Coelomic pressure, eqs. (2.8.8), (2.8.9), of an incompressible body with its own radius and modulus [Pa]."""
        k_i, k_g = self.crawler.incompressible_stiffnesses
        mu_1, mu_2 = mu[..., 0], mu[..., 1]
        reactive = multiplier * k_g / self.crawler.length**2 - k_i * (2 - (mu_1 + mu_2))
        result: Array = -reactive * (mu_1 * mu_2) / self.crawler.area
        return result

    def fields(
        self, profiles: list[Profile], placed: list[Array], regions: list[Sequence[Region]]
    ) -> dict[str, Field]:
        """Stored variables, times by sections; `placed` are the positions along the ground at the mesh points."""
        z, body = self.places, self.crawler
        scales = scales_at(body.pieces, piece_at(body.pieces, z), z)
        radius = scales.radius * body.radius
        on = [profile.at(z) for profile in profiles]
        mu, slope = np.array([a[0] for a in on]), np.array([a[1] for a in on])
        mu_3, multiplier = np.array([a[2] for a in on]), np.array([a[3] for a in on])
        values = {
            "mu_1": mu[..., 0],
            "mu_2": mu[..., 1],
            "mu_3": mu_3,
            "mu_1_slope": slope[..., 0] / body.length,
            "height": radius * (mu[..., 0] - 1),  # (2.5.7)
            "along": np.array([p.mesh.interpolate(s, z) for p, s in zip(profiles, placed, strict=True)]),
            "advancing": np.array([strength_along(r, z, "advancing") for r in regions]),
        }
        if body.material.kind == "incompressible":
            own = scales.stretching  # (2.8.8) with k_I, k_G and A of the place
            values["p_coelom"] = scales.young * self.pressure(mu, multiplier / own)
        fields: dict[str, Field] = {key: (("time", "section"), value) for key, value in values.items()}
        if body.segments:
            fields["resting_radius"] = (("section",), radius)
        if any(r.state != (r.load, 1.0, None) or r.load == "relaxed" for row in regions for r in row):
            muscles: tuple[tuple[str, Muscle, float, Array], ...] = (
                ("muscle_force", "anchoring", self.loads.anchoring, scales.anchoring),
                ("muscle_pressure", "advancing", self.loads.advancing, scales.advancing),
            )
            for name, load, usual, scale in muscles:
                strengths = [scale * strength_along(row, z, load, usual) for row in regions]
                fields[name] = (("time", "section"), np.array(strengths))
        return fields | {"xi_section": (("section",), z * body.length)}

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """Instants, and the work of the solver."""
        how = (
            f"{statistics['newton_iterations']} Newton iterations"
            if "newton_iterations" in statistics
            else f"solve_bvp with up to {statistics['most_nodes']} nodes"
        )
        return f"{statistics['instants']} instants, {how}"


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
        regions = [
            Region(r.begin, r.end, r.load, own=r.force if r.load == "anchoring" else r.pressure)
            for r in self.regions
        ]
        problem = InstantProblem(self.crawler, self.loads, regions, name)
        profile, _, tilt = self.solve_instant(problem, None)
        fields = self.fields([profile], [self.length_along(profile)], [regions])
        flat = {
            key: (dims[1:], values[0]) if dims[0] == "time" else (dims, values)
            for key, (dims, values) in fields.items()
        }
        return Solution(flat, _statistics(self, 1, [profile.effort], tilt))


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
        return _thin(self._problems(self.gait.instants(self.step), "the anchor"))

    def thin_anchor_warning(self) -> str | None:
        """One sentence on `thin_anchors`, None if there are none."""
        return anchors.warning(self.thin_anchors(), self.gait.instants(self.step), self.crawler.length)

    def _problems(
        self, instants: Sequence[Instant], name: str, start: float = 0.0
    ) -> list[tuple[Instant, InstantProblem]]:
        """Instants and their problems, in a stride that begins at the time `start` [s]."""
        body, loads = self.crawler, self.loads
        common = Common.of(body, loads)
        return [
            (m, InstantProblem(body, loads, m.regions, f"{name} at t = {start + m.time:.4g} s", common))
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
        instants = self.gait.instants(self.step)
        whole = self._problems(instants, name)
        for _, problem in whole:
            problem.check_collapse()
        strides = self._poses(whole, name, run)
        steps = placed(strides, self.gait.duration)
        solved = {id(pose): pose for poses in strides for pose in poses}.values()
        said = (
            anchors.warning(_thin(whole), instants, self.crawler.length),
            self.first_stride_warning(),
        )
        return Solution(
            self._fields(steps),
            _statistics(
                self, len(steps), [p.profile.effort for p in solved], max(p.tilt for p in solved)
            ),
            warnings=tuple(warning for warning in said if warning is not None),
        )

    def _poses(
        self, whole: list[tuple[Instant, InstantProblem]], name: str, run: Run
    ) -> list[list[Pose]]:
        """The poses of every stride; those of instants with the same loads are the same."""
        rises = [self.gait.rise(m.time) for m, _ in whole]
        if min(rises) == 1:
            first = self._solved(whole, [], run, len(whole))
            return [first, *[first[1:]] * (self.strides - 1)]
        risen = [m.risen(rise) for (m, _), rise in zip(whole, rises, strict=True)]
        again = [m for m, _ in whole[1:]] if self.strides > 1 else []
        total = len(risen) + len(again)
        first = self._solved(self._problems(risen, name), [], run, total)
        later = self._solved(self._problems(again, name, self.gait.duration), first, run, total)
        return [first, *[later] * (self.strides - 1)]

    def _solved(
        self,
        problems: list[tuple[Instant, InstantProblem]],
        before: list[Pose],
        run: Run,
        total: int,
    ) -> list[Pose]:
        """The poses of a stride, each solved from the one before; total : how many the run solves."""
        poses: list[Pose] = []
        nodal = before[-1].nodal if before else None
        for number, (instant, problem) in enumerate(problems, start=len(before) + 1):
            profile, nodal, tilt = self.solve_instant(problem, nodal)
            poses.append(Pose(instant, profile, self.length_along(profile), nodal, tilt))
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
        for _, problem in self._problems(self.gait.instants(self.step), name):
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


def _thin(problems: Sequence[tuple[Instant, InstantProblem]]) -> list[Instant]:
    return [instant for instant, problem in problems if anchors.lies_thin(problem, instant.anchor)]


def _statistics(
    problem: CrawlerProblem, instants: int, effort: Sequence[int], tilt: float
) -> dict[str, int | float]:
    statistics: dict[str, int | float] = {"instants": instants, "largest_sine_of_tilt": tilt}
    if problem.solver == "banded":
        return statistics | {"newton_iterations": sum(effort)}
    return statistics | {"most_nodes": max(effort)}
