"""Results that move with a parameter to first order: their differences over small steps are derivatives."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import replace
from typing import cast

import numpy as np

from cosserat.problem import Problem
from cosserat.problems.moving_rows import moved_by_rows
from cosserat.problems.static import FIELDS, RodStatics, State, equilibrium_solution
from cosserat.problems.tangents import Body, Motion, Moved, Nearby, move, total_mass
from cosserat.publications import kinds
from cosserat.rods.resolution import check_crossing
from cosserat.solution import Solution
from cosserat.solvers.equilibrium import EquilibriumSolver

_QUICK = {*FIELDS, "total_mass"} - {"applied_force"}
"""Fields that need no more than the state."""


class MovedStatics:
    """The result of a static problem; wanted : the fields that are read."""

    lacks = ""

    def __init__(self, moved: Moved, name: str, wanted: Set[str]) -> None:
        self.moved, self.name, self.wanted = moved, name, wanted

    def solution(self, step: float) -> Solution:
        """Fields of the equilibrium after a step, to first order, at least those that are wanted."""
        return self._few(step) if self.wanted <= _QUICK else self._whole(step)

    def _few(self, step: float) -> Solution:
        """The wanted ones alone."""
        rod, geometry = self.moved.shape(step)
        point = self.moved.state(step).unframed(self.moved.system(step))
        state = State(rod, geometry, point.q, np.zeros_like(point.q), point.reaction)
        fields = {name: (FIELDS[name][0], FIELDS[name][1](state)) for name in self.wanted & set(FIELDS)}
        labels = {"axis": rod.kinematics.axes, "dof": rod.kinematics.dofs}
        if "total_mass" in self.wanted:
            body = self.moved.body(step)
            fields |= total_mass(body.problem, body.geometry)[0]
        return Solution(fields, {}, labels)

    def _whole(self, step: float) -> Solution:
        body = self.moved.body(step)
        problem = cast("RodStatics", body.problem)
        solver = EquilibriumSolver(body.system, problem.newton, self.name)
        found = equilibrium_solution(problem, body.geometry, self.moved.state(step), solver)
        fields, labels = total_mass(problem, body.geometry)
        return replace(found, fields={**found.fields, **fields}, labels={**found.labels, **labels})


def moving_statics(problem: RodStatics, nearby: Sequence[Nearby], name: str, wanted: Set[str]) -> Motion:
    """The equilibrium of a problem, moving with each of several parameters.

    Raises
    ------
    NotConvergedError, CrossingError : there is no equilibrium.
    """
    base = Body.of(problem)
    point, _ = problem.equilibrium(base.geometry, base.system, name)
    moved = moved_by_rows(problem, nearby, base, point)
    found = MovedStatics(Moved(lambda _: problem, base, point), name, {"every"}).solution(0.0)
    check_crossing(base.geometry, found["x"], found["d"], problem.rod.below, name)
    lost = move(moved) if moved else []
    return Motion(found, tuple(MovedStatics(one, name, wanted) for one in moved), tuple(lost))


def moves_exactly(problem: Problem) -> bool:
    """Whether `moving` has a form for a problem."""
    return problem.has_tangent and kinds()[problem.kind].moving_function() is not None


def moving(problem: Problem, nearby: Sequence[Nearby], name: str, wanted: Set[str]) -> Motion | None:
    """The result of a problem, moving with each of several parameters; None for one that has no such form.

    wanted : names of the fields that move, at least.

    Raises
    ------
    CosseratError : there is no result.
    """
    if not moves_exactly(problem):
        return None
    function = kinds()[problem.kind].moving_function()
    assert function is not None  # it moves exactly
    return cast("Motion", function(problem, nearby, name, wanted))
