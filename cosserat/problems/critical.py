"""Critical loads of a rod: by the linear criterion, and by the true one, each with its modes."""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Count, Parameters, Quantity
from cosserat.problem import ALONE, Forecast, Run
from cosserat.problems.forecasts import of_modes
from cosserat.problems.grown import GrownProblem
from cosserat.problems.outputs import coupled_energies, of_equilibria, outputs
from cosserat.problems.posed import PosedProblem
from cosserat.problems.special import scaled, special_fields
from cosserat.rods.problem import LOADS, RodProblem
from cosserat.rods.reference import Geometry
from cosserat.rods.rod import Rod
from cosserat.solution import Field, Solution
from cosserat.solvers.banded import Vector
from cosserat.solvers.continuation import ArcLengthSettings
from cosserat.solvers.critical import (
    LinearCriterion,
    first_special_point,
    linear_criterion,
)
from cosserat.solvers.equilibrium import EquilibriumSolver
from cosserat.solvers.special import SpecialPoint
from cosserat.solvers.system import MechanicalSystem


class SearchSettings(Parameters):
    """Search along the path of equilibria; arcs combine radians of the section that rotates most with the load."""

    first: Annotated[float, Quantity("1", above=0)] = 0.05
    """Length of the first arc; the load counts in multiples of the lowest critical load of the linear criterion."""
    longest: Annotated[float, Quantity("1", above=0)] = 0.3
    """Length of the longest arc."""
    count: Annotated[int, Count(at_least=1, at_most=100_000)] = 500
    """Most arcs."""
    limit: Annotated[float, Quantity("1", above=0)] = 3.0
    """Where the search ends: a multiple of the lowest load of the linear criterion; of the loads themselves if it has
    none."""


class RodCriticalLoads(GrownProblem):
    """Critical loads as multiples of the given loads, which grow together from zero.

    The linear criterion (linear buckling) adds to the stiffness where they begin the geometric one, of the loads and
    of the stresses that they cause, in the shape there: it is for rods that hardly bend before they buckle.  The true
    criterion follows the equilibria themselves to the first that is singular, a bifurcation or a limit point.  The
    largest displacement of a mode is one.  Displacements, forces, moments, stresses and reactions are those in this
    critical state.
    """

    kind: Literal["critical loads"] = "critical loads"
    count: Annotated[int, Count(at_least=1, at_most=100_000)] = 4
    """Most critical loads of the linear criterion, from the lowest; only loads of the given sign count."""
    search: SearchSettings = SearchSettings()
    """The search for the true one."""

    @model_validator(mode="after")
    def _has_a_load(self) -> Self:
        if not any(
            self.loads_of(key) for key in (*LOADS, "prescribed_displacements", "prescribed_rotations")
        ):
            raise PydanticCustomError(
                "unloaded",
                "has no load that could grow to a critical one; give one, such as in 'forces'",
            )
        return self

    @classmethod
    def of(cls, problem: RodProblem, count: int) -> Self:
        """The critical loads of the rod of another problem; those of a motion have no time function."""
        own = (PosedProblem if problem.in_time else GrownProblem).model_fields
        names = [name for name in dict.fromkeys((*own, "newton")) if hasattr(problem, name)]
        return cls(**{name: getattr(problem, name) for name in names}, count=count)

    @property
    def forecast(self) -> Forecast:
        """The linear criterion; how long the path to the true one is cannot be foreseen."""
        return of_modes(self, self.count, always_dense=True)

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """Both criteria; `name` : name of the case in errors.

        Raises
        ------
        UnsupportedRodError : a rigid motion is left free.
        UnstableError : the rod is unstable where the loads begin.
        NotConvergedError : the path cannot be followed to its first special point.
        """
        geometry = self.geometry
        system, warnings = self.grown(geometry, name)
        solver, linear, true, reached = self.criteria(system, name)
        linear = replace(linear, mode=system.frame.out(linear.mode))
        lowest = float(linear.factor[0]) if linear.factor.size else 1.0
        found = [] if true is None else [true.unframed(system)]
        special, labels, statistics = special_fields(self.rod, geometry, found)
        if linear.factor.size:
            statistics["linear_load_factor"] = lowest
        statistics |= {"load_factor_reached": float(reached), "iterations": solver.iterations}
        start = system.frame.out(system.start)
        fields = {**_start(self.rod, geometry, start), **linear_fields(self.rod, linear), **special}
        words = {"axis": self.rod.kinematics.axes, "special": labels}
        warnings += self._warnings(linear, true, reached, system.symmetric)

        def derive(names: Set[str] = frozenset()) -> Solution:
            """Forces, moments, stresses, reactions and energies in the critical state."""
            points, body = [one.point for one in found], system.unframed
            if not points:
                return Solution({}, {})
            couples = coupled_energies(body, points)
            return outputs(of_equilibria(self, geometry, body, points, "special", couples), names)

        return Solution(fields, statistics, words, warnings, derive)

    def criteria(
        self, system: MechanicalSystem, name: str
    ) -> tuple[EquilibriumSolver, LinearCriterion, SpecialPoint | None, float]:
        """The solver, what both criteria find in the frames of the system, and the load factor reached.

        Raises
        ------
        UnstableError : the rod is unstable where the loads begin.
        NotConvergedError : the path cannot be followed to its first special point.
        """
        solver = EquilibriumSolver(system, self.newton, name)
        solver.remedy = "take a smaller 'search.first' and 'search.longest', or check supports and loads"
        solver.limit_remedy = "check supports and loads"
        linear = linear_criterion(solver, self.count)
        lowest = float(linear.factor[0]) if linear.factor.size else 1.0
        arc = ArcLengthSettings(
            self.search.first,
            self.search.longest,
            self.search.count,
            until=self.search.limit,
            limit=2 * self.search.limit,
            branches=0,
        )
        true, reached = first_special_point(solver, arc, lowest)
        return solver, linear, true, reached

    def _warnings(
        self, linear: LinearCriterion, true: SpecialPoint | None, reached: float, symmetric: bool
    ) -> tuple[str, ...]:
        """What was not found, and what neither criterion sees."""
        found = []
        if not linear.factor.size:
            found.append(
                "no linear critical load: the linear criterion has none for loads of this sign, however large"
            )
        if true is None:
            found.append(
                f"no critical load: the path is stable up to {reached:.6g} of the loads, where the search ended; raise "
                "'search.limit' or 'search.count' to look further"
            )
        if not symmetric:
            found.append(
                "flutter: a load has no potential, so that the rod may flutter below these loads of divergence; see "
                "kind = 'modes' at some loads"
            )
        return tuple(found)

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """Both critical loads, as multiples of the loads."""
        true, linear = (
            statistics.get(key) for key in ("first_instability_load_factor", "linear_load_factor")
        )
        kind = "a limit point" if statistics["limit_points"] else "a bifurcation"
        said = [
            f"no instability up to {statistics['load_factor_reached']:.6g} of the loads"
            if true is None
            else f"unstable from {true:.8g} of the loads on, {kind}",
            "none by the linear criterion" if linear is None else f"linear criterion {linear:.8g}",
        ]
        return "; ".join(said)


def _start(rod: Rod, geometry: Geometry, u: Vector) -> dict[str, Field]:
    """The reference, and displaced from it by u the place where the loads begin."""
    vector, vectors = ("vertex", "axis"), rod.vectors(geometry, u)
    return {
        "xi": (("vertex",), geometry.arc_length),
        "x_ref": (vector, geometry.X),
        "d_ref": (vector, geometry.D),
        "x": (vector, vectors[:, 0]),
        "d": (vector, vectors[:, 1]),
    }


def linear_fields(rod: Rod, linear: LinearCriterion) -> dict[str, Field]:
    """Factors and modes of the linear criterion; nothing where it has none."""
    if not linear.factor.size:
        return {}
    shapes = np.array([scaled(rod.kinematics, mode) for mode in linear.mode])
    along = ("mode", "vertex", "axis")
    return {
        "linear_load_factor": (("mode",), linear.factor),
        "linear_u": (along, shapes[:, 0]),
        "linear_delta": (along, shapes[:, 1]),
    }
