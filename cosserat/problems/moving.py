"""Results that move with a parameter to first order: their differences over small steps are derivatives."""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import replace
from typing import cast

import numpy as np

from cosserat.problem import Problem
from cosserat.problems.many import family_of
from cosserat.problems.rates import Moves, Settled, field_rates, has_rates
from cosserat.problems.rates import moves as rates_of
from cosserat.problems.static import FIELDS, RodStatics, State, equilibrium_solution
from cosserat.problems.tangents import (
    AT_CRITICAL,
    Body,
    Motion,
    Moved,
    Moving,
    Nearby,
    NearKey,
    move,
    total_mass,
)
from cosserat.publications import kinds
from cosserat.rods.loads.load import LoadedRod
from cosserat.rods.resolution import check_crossing
from cosserat.solution import FieldRates, Solution
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver

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


class MovedFields:
    """Fields of a static problem whose rates are known.

    rates : of the fields of one result.  number : of the parameter among theirs.
    """

    lacks = ""

    def __init__(self, rates: FieldRates, number: int) -> None:
        self.rates, self.number = rates, number

    def solution(self, step: float) -> Solution:
        """The fields after a step, to first order."""
        return Solution(self.rates.after(0, self.number, step), {}, self.rates.labels)


def moving_statics(problem: RodStatics, nearby: Sequence[Nearby], name: str, wanted: Set[str]) -> Motion:
    """The equilibrium of a problem, moving with each of several parameters.

    Raises
    ------
    NotConvergedError, CrossingError : there is no equilibrium.
    """
    base = Body.of(problem)
    point, _ = problem.equilibrium(base.geometry, base.system, name)
    moved = [Moved(near, base, point) for near in nearby]
    found = MovedStatics(Moved(lambda _: problem, base, point), name, {"every"}).solution(0.0)
    check_crossing(base.geometry, found["x"], found["d"], problem.rod.below, name)
    settled, keys = _settled(problem, nearby, base, point)
    ways: list[Moving] = [MovedStatics(one, name, wanted) for one in moved]
    lost, rates = [""] * len(moved), None
    rated: dict[int, int] = {}
    if settled is not None:
        moves = rates_of(settled, keys)
        rates = _field_rates(settled, moves, point, wanted) if wanted <= _QUICK else None
        numbers = {
            k: keys.index(one.key)
            for k, one in enumerate(nearby)
            if isinstance(one, NearKey) and one.key in keys
        }
        rated = {k: number for k, number in numbers.items() if moves.known[0, number]}
        for k, number in rated.items():
            lost[k] = AT_CRITICAL if moves.critical[0] else ""
            if rates is not None:
                ways[k] = MovedFields(rates, number)
            else:
                _set_rates(moved[k], moves, number)
    left = [k for k in range(len(moved)) if k not in rated]
    for k, why in zip(left, move([moved[k] for k in left]) if left else (), strict=True):
        lost[k] = why
    return Motion(found, tuple(ways), tuple(lost), rates, rated)


def _settled(
    problem: RodStatics, nearby: Sequence[Nearby], base: Body, point: Equilibrium
) -> tuple[Settled | None, list[str]]:
    """The equilibrium as one of a family, with those of its keys that have rates there; None without any."""
    near = [one for one in nearby if isinstance(one, NearKey)]
    columns = {one.key: np.array([one.after(0.0)]) for one in near}
    columns = {key: values for key, values in columns.items() if has_rates(problem, key, values)}
    family = family_of(problem, base.system) if columns and point.factor == 1.0 else None
    if family is None:
        return None, []
    body = LoadedRod(problem.rod, base.geometry, masses=problem.masses)
    members = base.system.member
    return Settled(problem, columns, base.system, family, members, body, point.q[None]), list(columns)


def _field_rates(settled: Settled, moves: Moves, point: Equilibrium, wanted: Set[str]) -> FieldRates:
    """Rates of the wanted fields, the mass of the rod among them."""
    problem, geometry = settled.problem, settled.body.geometry
    state = State(problem.rod, geometry, point.q[None], settled.members.dead, point.reaction[None])
    found = field_rates(state, moves, wanted & set(FIELDS))
    if "total_mass" not in wanted:
        return found
    now = {
        name: (("member", *dims), values[None])
        for name, (dims, values) in total_mass(problem, geometry)[0].items()
    }
    grown = moves.growth.mass[0][:, None] * problem.rod.part_masses(geometry).sum()
    change = {"total_mass": (("member", "axis"), np.repeat(grown, len(found.labels["axis"]), axis=1))}
    return replace(found, now={**found.now, **now}, change={**found.change, **change})


def _set_rates(moved: Moved, moves: Moves, number: int) -> None:
    """Set what moves beyond the strains of no step, which keep the place of the first vertex."""
    split = moved.base.problem.rod.kinematics.split
    kept = split(moved.point.q).copy()
    kept[:, 0] -= kept[0, 0].copy()
    kept[:, 0] *= moves.growth.length[0, number]
    kept[:, 1:] *= moves.growth.height[0, number]
    moved.rate = moves.q[0, number] - kept.ravel()
    moved.reaction_rate = moves.reaction[0, number]


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
