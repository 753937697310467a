"""Static problems of the discrete planar rod, section 3.5."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import NotConvergedError, UnsupportedRodError
from cosserat.problem import ALONE, Run
from cosserat.problems.outputs import energies, of_equilibria, outputs, parts_of_energy
from cosserat.problems.posed import PosedProblem
from cosserat.rods.holding import free_motions
from cosserat.rods.problem import RodProblem
from cosserat.rods.reference import Geometry, Strains, strains
from cosserat.rods.resolution import check_crossing, coarse
from cosserat.rods.rod import Rod
from cosserat.solution import Field, Many, Solution
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver, NewtonSettings
from cosserat.solvers.loading import coupled_energy
from cosserat.solvers.modes import Modes, modes
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]
_MOTIONS = ("translation along E3", "translation along E2", "rotation")


class RodStatics(PosedProblem):
    """Equilibrium of a rod under its weight and point forces."""

    kind: Literal["rod statics"] = "rod statics"
    newton: NewtonSettings = NewtonSettings()

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """Find the equilibrium; `name` : name of the case in errors.

        Raises
        ------
        UnsupportedRodError : a rigid motion is left free.
        NotConvergedError : no equilibrium within the tolerance.
        CrossingError : neighbouring sections of the equilibrium cross.
        """
        geometry = self.geometry
        system = self.system(geometry)
        point, solver = self.equilibrium(geometry, system, name)
        found = equilibrium_solution(self, geometry, point, solver)
        check_crossing(geometry, found["x"], found["d"], self.rod.below, name)
        return replace(found, warnings=(*solver.warnings(), *coarse(found["d"])))

    def solve_many(
        self, columns: Mapping[str, Array], wanted: Sequence[str], by: Sequence[str] = ()
    ) -> Many | None:
        """The equilibria of many rods in one compiled loop, where it and its formulas fit them."""
        from cosserat.problems.many import solve_many

        return solve_many(self, columns, wanted, by) if set(wanted) <= set(FIELDS) else None

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """Iterations and the remaining unbalanced force."""
        return (
            f"{statistics['iterations']} Newton iterations, largest unbalanced force "
            f"{statistics['residual_N']:.2g} N (allowed {statistics['tolerance_N']:.2g} N)"
        )

    def modes(self, count: int, name: str = "the rod") -> Modes:
        """The lowest natural frequencies and shapes of small motions about the equilibrium.

        Raises
        ------
        UnsupportedRodError, NotConvergedError : there is no equilibrium.
        UnstableError : small motions about the equilibrium grow.
        """
        geometry = self.geometry
        system = self.system(geometry)
        point, _ = self.equilibrium(geometry, system, name)
        return modes_about(system, point, count, name)

    def equilibrium(
        self, geometry: Geometry, system: MechanicalSystem, name: str
    ) -> tuple[Equilibrium, EquilibriumSolver]:
        """The equilibrium as all loads grow together, in displacements, with its solver."""
        check_supports(system, name)
        solver = EquilibriumSolver(system, self.newton, name)
        try:
            return self.settled(geometry, solver)
        except NotConvergedError as error:
            last = error.state
            if last is not None:
                found = equilibrium_solution(self, geometry, last, solver)
                reached = {"load_factor_reached": last.factor}
                error.reached = replace(found, statistics=dict(found.statistics) | reached)
            raise


def modes_about(system: MechanicalSystem, point: Equilibrium, count: int, name: str) -> Modes:
    """The lowest natural frequencies and shapes of small motions about an equilibrium.

    Raises
    ------
    UnstableError : small motions about it grow.
    """
    found = modes(system, point.q, count, name, supported=True, history=point.history)
    return replace(found, shape=system.frame.out(found.shape))


class State:
    """A displaced rod, or several at once: axes before the others, of all arrays, are of several rods.

    q, load, reaction : (..., n) displacements [m], forces of the loads and of the supports [N].
    """

    def __init__(self, rod: Rod, geometry: Geometry, q: Array, load: Array, reaction: Array) -> None:
        self.rod, self.geometry, self.q, self.load, self.reaction = rod, geometry, q, load, reaction

    @cached_property
    def moved(self) -> Array:
        """Displacements of positions and directors, (..., N, 2, 2) [m]."""
        return self.rod.kinematics.split(self.q)

    @cached_property
    def vectors(self) -> Array:
        """Positions and directors, (..., N, 2, 2) [m]."""
        return self.rod.vectors(self.geometry, self.q)

    @cached_property
    def measured(self) -> Strains:
        """The strain measures."""
        return strains(self.geometry, self.vectors[..., 0, :], self.vectors[..., 1, :])

    def of_vertices(self, values: Array) -> Array:
        """Values of the DOFs (..., n) by vertex, (..., N, DOFs of a vertex)."""
        return values.reshape(*values.shape[:-1], -1, self.rod.kinematics.per_vertex)


_VECTOR, _FORCE = ("vertex", "axis"), ("vertex", "dof")
FIELDS: dict[str, tuple[tuple[str, ...], Callable[[State], Array]]] = {
    "xi": (("vertex",), lambda s: s.geometry.arc_length),
    "xi_edge": (
        ("edge",),
        lambda s: (s.geometry.arc_length[..., 1:] + s.geometry.arc_length[..., :-1]) / 2,
    ),
    "x_ref": (_VECTOR, lambda s: s.geometry.X),
    "d_ref": (_VECTOR, lambda s: s.geometry.D),
    "x": (_VECTOR, lambda s: s.vectors[..., 0, :]),
    "d": (_VECTOR, lambda s: s.vectors[..., 1, :]),
    "u": (_VECTOR, lambda s: s.moved[..., 0, :]),
    "delta": (_VECTOR, lambda s: s.moved[..., 1, :]),
    "mu_edge": (("edge",), lambda s: s.measured.mu_edge),
    "mu": (("vertex",), lambda s: s.measured.mu),
    "lam": (("vertex",), lambda s: s.measured.lam),
    "phi": (("vertex",), lambda s: s.measured.phi),
    "kappa": (("vertex",), lambda s: s.measured.kappa),
    "applied_force": (_FORCE, lambda s: s.of_vertices(s.load)),
    "support_force": (_FORCE, lambda s: s.of_vertices(s.reaction)),
}
"""Fields of an equilibrium by name: the dimensions of one state, and the values."""


def check_supports(system: MechanicalSystem, name: str) -> None:
    """Raise UnsupportedRodError if neither supports nor springs resist a rigid motion."""
    free = free_motions(system)
    left = [motion for motion, fraction in zip(_MOTIONS, free, strict=True) if fraction > 0.1]
    if left:
        raise UnsupportedRodError(
            f"{name}: the supports leave the rod free to move ({', '.join(left)}); "
            "add one to 'supports', such as at = 'first', fixed = 'clamped', or 'springs' that hold it"
        )


def equilibrium_solution(
    problem: RodProblem, geometry: Geometry, point: Equilibrium, solver: EquilibriumSolver
) -> Solution:
    """Fields of one equilibrium, in displacements, and what follows from them."""
    rod = problem.rod
    point, system = point.unframed(solver.system), solver.system.unframed
    state = State(rod, geometry, point.q, point.factor * system.dead_load, point.reaction)
    coupled = np.array([coupled_energy(system, point)])
    more, each = rod.strain_energy.fields(rod, geometry, system.internal, point.q[None], coupled)
    own: dict[str, Field] = {name: (dims, values[0]) for name, (dims, values) in each.items()}
    labels = {"axis": rod.kinematics.axes, "dof": rod.kinematics.dofs} | more
    fields = own | {name: (dims, values(state)) for name, (dims, values) in FIELDS.items()}
    statistics: dict[str, int | float] = {
        "iterations": solver.iterations,
        "cutbacks": solver.cutbacks,
        "branch_switches": solver.branch_switches,
        "residual_N": point.residual,
        "tolerance_N": point.tolerance,
        "rounding_N": point.rounding,
    }

    def derive(names: Set[str] = frozenset()) -> Solution:
        parts = parts_of_energy(system, [point])
        found = outputs(of_equilibria(problem, geometry, system, [point], "", parts[-1]), names)
        stored = energies(system, [point], parts)
        more = {name: ((), values[0]) for name, values in stored.items()}
        return replace(found, fields={**found.fields, **more})

    return Solution(fields, statistics, labels, derive=derive)
