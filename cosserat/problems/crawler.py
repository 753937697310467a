"""What an instant and a crawl have in common: the body, its loads, the solver, and the fields that are stored."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Count, Quantity
from cosserat.peristalsis.body import piece_at, scales_at
from cosserat.peristalsis.crawler import Crawler, Loads
from cosserat.peristalsis.instant import InstantProblem
from cosserat.peristalsis.profile import Profile, check_tilt
from cosserat.peristalsis.region import Muscle, Region, strength_along
from cosserat.problem import Problem
from cosserat.solution import Field
from cosserat.solvers.regions import RegionSettings

Array = NDArray[np.float64]


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
    def has_tangent(self) -> bool:
        """Whether its result moves exactly with parameters: that of the banded solver does."""
        return self.solver == "banded"

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


def statistics_of(
    problem: CrawlerProblem, instants: int, effort: Sequence[int], tilt: float
) -> dict[str, int | float]:
    """Statistics of the solver; effort : of each pose that was solved."""
    statistics: dict[str, int | float] = {"instants": instants, "largest_sine_of_tilt": tilt}
    if problem.solver == "banded":
        return statistics | {"newton_iterations": sum(effort)}
    return statistics | {"most_nodes": max(effort)}
