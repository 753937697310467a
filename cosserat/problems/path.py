"""The equilibrium path of a consistent rod as its loads grow, past limit points and bifurcations."""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace
from functools import cache
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.errors import CrossingError, NotConvergedError
from cosserat.parameters import Count, Parameters, Quantity
from cosserat.problem import ALONE, Forecast, Run
from cosserat.problems.forecasts import of_path
from cosserat.problems.grown import GrownProblem
from cosserat.problems.outputs import (
    coupled_energies,
    energies,
    of_equilibria,
    outputs,
    parts_of_energy,
    work_along,
)
from cosserat.problems.special import SPECIAL_FIELDS, special_fields
from cosserat.rods.problem import RodProblem
from cosserat.rods.reference import Geometry
from cosserat.rods.resolution import check_crossing, coarse
from cosserat.rods.rod import Rod
from cosserat.solution import Field, Solution
from cosserat.solvers.continuation import ArcLengthSettings, trace_path
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver
from cosserat.solvers.incremental import unloaded
from cosserat.solvers.special import SpecialPoint, special_points

Array = NDArray[np.float64]
_STORED = {"strain_energy", "attached_energy", "load_potential", "total_load_work", "support_work"}
"""Energies and works along a path, which are left out where none is needed."""


class ArcSettings(Parameters):
    """Settings of the path; arcs combine radians of the section that rotates most with fractions of the load."""

    first: Annotated[float, Quantity("1", above=0)] = 0.05
    """Length of the first arc."""
    longest: Annotated[float, Quantity("1", above=0)] = 0.3
    """Length of the longest arc."""
    count: Annotated[int, Count(at_least=1, at_most=100_000)] = 500
    """Most arcs."""
    limit: Annotated[float, Quantity("1", above=1)] = 3.0
    """Fraction of the load, in either direction, beyond which the path fails."""
    branch: Literal["leave", "stay"] = "leave"
    """At a bifurcation, whether to leave along the softest motion or to stay on the path."""


class RodPath(GrownProblem):
    """Equilibria along a path, as the loads grow together from zero.

    The path ends when they reach their full size, or after the last arc.  Limit points, bifurcations and the first
    instability are located between its points to round-off.  Two that undo each other within one arc are found from a
    thousandth of the arc apart, if no third is in it: shorter arcs see more.
    """

    kind: Literal["rod path"] = "rod path"
    thinned: ClassVar[Mapping[str, int]] = {"special": 0}
    arc: ArcSettings = ArcSettings()

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if not self.rod.strain_energy.large_rotations:
            raise PydanticCustomError(
                "energy", "needs rod.energy = 'consistent'; the published rod has no paths"
            )
        return self

    @property
    def forecast(self) -> Forecast:
        """The points that a path to the full load has at least."""
        return of_path(self, self.arc.count, self.arc.longest)

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """Every point of the path; it ends after 'arc.count' arcs at the latest, which the statistics record.

        Raises
        ------
        UnsupportedRodError : a rigid motion is left free.
        NotConvergedError : the path could not be followed; the error has the load reached and the last state.
        """
        geometry = self.geometry
        system, warnings = self.grown(geometry, name)
        solver = EquilibriumSolver(system, self.newton, name)
        solver.limit_remedy = "raise 'arc.limit'"
        solver.remedy = "take a smaller 'arc.first' and 'arc.longest', or check supports and loads"
        arc = ArcLengthSettings(
            self.arc.first,
            self.arc.longest,
            self.arc.count,
            until=1.0,
            limit=self.arc.limit,
            branches=int(self.arc.branch == "leave"),
        )
        points: list[Equilibrium] = []
        at_rest, split = self.rod.strain_energy.reference(geometry), self.rod.kinematics.split
        below, furthest = self.rod.below, 0.0
        try:
            for point in trace_path(solver, unloaded(solver), arc):
                reached = f"{point.factor:.4g} of the load"
                vectors = split(at_rest + point.unframed(system).q)
                check_crossing(geometry, vectors[:, 0], vectors[:, 1], below, f"{name}, {reached}")
                points.append(point)
                furthest = max(furthest, point.factor)
                run.progress(min(furthest, 1.0), reached)
        except (NotConvergedError, CrossingError) as error:
            if points:
                error.reached = _solution(self, geometry, points, solver)
            raise
        found = _solution(self, geometry, points, solver, run)
        found = replace(found, warnings=(*warnings, *found.warnings))
        if not run.wants(SPECIAL_FIELDS):
            return found
        return _with_special_points(found, self.rod, geometry, points, solver)

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """Number of points, and the load reached."""
        reached = statistics["load_factor_reached"]
        end = "" if reached == 1 else "; that was the last arc, raise 'arc.count' to continue"
        special = [
            f"{count} {word}{'s' * (count > 1)}"
            for word in ("limit point", "bifurcation")
            if (count := int(statistics.get(f"{word.replace(' ', '_')}s", 0)))
        ]
        if "first_instability_load_factor" in statistics:
            first = statistics["first_instability_load_factor"]
            special.append(f"first unstable at {first:.8g} of the load")
        end = "".join(f", {words}" for words in special) + end
        return (
            f"{statistics['points']} points, {statistics['unstable_points']} of them unstable, up to {reached:.4g} of "
            f"the load, {statistics['iterations']} Newton iterations{end}"
        )


def _with_special_points(
    found: Solution, rod: Rod, geometry: Geometry, points: list[Equilibrium], solver: EquilibriumSolver
) -> Solution:
    """A path with its limit points and bifurcations."""
    special: list[SpecialPoint] = []
    after: list[int] = []
    for before, beyond in solver.crossings:
        crossed = special_points(solver.system, solver.name, before, beyond)
        within = [point.unframed(solver.system) for point in crossed]
        special += within
        after += len(within) * [next(k for k, point in enumerate(points) if point is before)]
    fields, labels, statistics = special_fields(rod, geometry, special)
    if special:
        fields["special_after"] = (("special",), np.array(after, float))
    return replace(
        found,
        fields={**found.fields, **fields},
        statistics={**found.statistics, **statistics},
        labels={**found.labels, "special": labels},
    )


def _solution(
    problem: RodProblem,
    geometry: Geometry,
    points: list[Equilibrium],
    solver: EquilibriumSolver,
    run: Run = ALONE,
) -> Solution:
    rod, system = problem.rod, solver.system.unframed
    points = [point.unframed(solver.system) for point in points]
    vectors = rod.vectors(geometry, np.array([point.q for point in points]))
    x, d = vectors[..., 0, :].copy(), vectors[..., 1, :].copy()
    parts = cache(lambda: parts_of_energy(system, points))
    along, vector = ("point",), ("vertex", "axis")
    fields: dict[str, Field] = {
        "load_factor": (along, np.array([point.factor for point in points])),
        "stable": (along, np.array([float(point.stable) for point in points])),
        "xi": (("vertex",), geometry.arc_length),
        "x_ref": (vector, geometry.X),
        "d_ref": (vector, geometry.D),
        "x": ((*along, *vector), x),
        "d": ((*along, *vector), d),
    }
    if run.wants({"potential"}):
        strain, attached, coupled = parts()
        fields["potential"] = (along, strain + attached + coupled)
    statistics = {
        "points": len(points),
        "iterations": solver.iterations,
        "load_factor_reached": points[-1].factor,
        "unstable_points": sum(not point.stable for point in points),
    }
    warnings = [*solver.warnings(), *coarse(d)]
    if not points[-1].stable:
        warnings.append(
            "unstable end: the last point of the path is an unstable equilibrium, where a body does not stay"
        )

    def derive(names: Set[str] = frozenset()) -> Solution:
        coupled = coupled_energies(system, points)
        found = outputs(of_equilibria(problem, geometry, system, points, "point", coupled), names)
        stored: dict[str, Array] = {}
        if not names or names & _STORED:
            stored = energies(system, points, parts()) | work_along(system, points)
        more = {name: (along, values) for name, values in stored.items()}
        return replace(found, fields={**found.fields, **more})

    return Solution(fields, statistics, {"axis": rod.kinematics.axes}, tuple(warnings), derive)
