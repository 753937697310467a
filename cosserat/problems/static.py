"""Static problems of the discrete planar rod, section 3.5."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.errors import NotConvergedError, UnsupportedRodError
from cosserat.problem import ALONE, Run
from cosserat.rods.energies.hemingway_kernel import TERMS
from cosserat.rods.energies.reissner import TERMS as PARTS
from cosserat.rods.energies.reissner import ConsistentRod
from cosserat.rods.kinematics import AXES, DOFS, Geometry, edge_shear, free_motions, strains
from cosserat.rods.loaded_rod import LoadedRod
from cosserat.rods.problem import RodProblem
from cosserat.rods.resolution import check_crossing, coarse
from cosserat.solution import Field, Solution
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver, NewtonSettings
from cosserat.solvers.incremental import solve_full_load
from cosserat.solvers.integrate import System
from cosserat.solvers.modes import Modes, modes

Array = NDArray[np.float64]
_MOTIONS = ("translation along E3", "translation along E2", "rotation")


class RodStatics(RodProblem):
    """Equilibrium of a rod under its weight and point forces."""

    kind: Literal["rod statics"] = "rod statics"
    newton: NewtonSettings = NewtonSettings()

    @model_validator(mode="after")
    def _nothing_swings(self) -> Self:
        if self.swings:
            raise PydanticCustomError(
                "static",
                "'prescribed_displacements' or 'prescribed_rotations' has a 'frequency', but a "
                "static problem has no time; leave it out",
            )
        return self

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """Find the equilibrium; `name` is what errors call the case.

        Raises
        ------
        UnsupportedRodError : a rigid motion is left free.
        NotConvergedError : no equilibrium within the tolerance.
        CrossingError : neighbouring sections of the equilibrium cross.
        """
        geometry = self.rod.geometry()
        loaded = self.loaded(geometry)
        point, solver = self.led_to(geometry, loaded, name)
        found = _solution(geometry, loaded, point, solver)
        check_crossing(geometry, found["x"], found["d"], self.rod.below, name)
        return replace(found, warnings=(*solver.warnings(), *coarse(found["d"])))

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """Iterations and the unbalanced force that is left."""
        return (
            f"{statistics['iterations']} Newton iterations, largest unbalanced force "
            f"{statistics['residual_N']:.2g} N (allowed {statistics['tolerance_N']:.2g} N)"
        )

    def modes(self, count: int, name: str = "the rod") -> Modes:
        """The lowest natural frequencies and shapes of small motions about the equilibrium.

        Raises
        ------
        UnsupportedRodError, NotConvergedError : there is no equilibrium to move about.
        UnstableError : there is one, but small motions about it grow.
        """
        geometry = self.rod.geometry()
        loaded = self.loaded(geometry)
        point, _ = self.led_to(geometry, loaded, name)
        at_rest = point.q + loaded.reference.ravel()
        return modes(self.system(geometry), at_rest, count, name, anchored=True)

    def system(self, geometry: Geometry) -> System:
        """The rod under its loads as something that may move."""
        load, constrained = self.loads(geometry).ravel(), self.constrained().ravel()
        return System(
            self.body(geometry),
            self.mass(geometry),
            load,
            constrained,
            0.0,
            np.empty((0, constrained.size)),
        )

    def led_to(
        self, geometry: Geometry, loaded: LoadedRod, name: str
    ) -> tuple[Equilibrium, EquilibriumSolver]:
        """The equilibrium that the loads lead to as they grow together, as displacements, and how it was found."""
        check_supports(loaded.reference, self.constrained(), name)
        solver = EquilibriumSolver(loaded, self.newton, name)
        try:
            return solve_full_load(solver, np.zeros_like(loaded.dead)), solver
        except NotConvergedError as error:
            if error.state is not None:
                last = solver.correct(error.state, error.factor)
                assert last is not None  # it was one
                found = _solution(geometry, loaded, last, solver)
                reached = {"load_factor_reached": last.factor}
                error.reached = replace(found, statistics=dict(found.statistics) | reached)
            raise


def check_supports(q: Array, constrained: NDArray[np.bool_], name: str) -> None:
    """Raise UnsupportedRodError if a rigid motion moves no held number; q, held : (N, 4)."""
    left = [
        motion
        for motion, share in zip(_MOTIONS, free_motions(q, constrained), strict=True)
        if share > 0.1
    ]
    if left:
        raise UnsupportedRodError(
            f"{name}: the supports leave the rod free to move ({', '.join(left)}); "
            "hold more numbers in 'supports', such as at = 'first', fixed = ['x3', 'x2', 'd3', 'd2']"
        )


def _solution(
    geometry: Geometry, loaded: LoadedRod, point: Equilibrium, solver: EquilibriumSolver
) -> Solution:
    load = point.factor * loaded.dead.reshape(loaded.reference.shape)
    u = point.q.reshape(load.shape)
    x, d = np.split(u + loaded.reference, [len(AXES)], axis=1)
    measured = strains(geometry, x, d)
    arc = geometry.arc_length
    body = loaded.coupled(point.factor)
    terms = body.energy_terms(point.q + loaded.base)
    labels = {"axis": AXES, "dof": DOFS}
    own: dict[str, Field]
    if isinstance(body, ConsistentRod):
        labels["part"] = PARTS
        own = {
            "shear": (("edge",), edge_shear(body.centre_edges(x, d), d)),
            "energy_parts": (("part",), terms),
        }
    else:
        labels["term"] = TERMS
        own = {"theta": (("vertex",), measured.theta), "energy": (("term",), terms)}
    vector, force = ("vertex", "axis"), ("vertex", "dof")
    fields: dict[str, Field] = own | {
        "xi": (("vertex",), arc),
        "xi_edge": (("edge",), (arc[1:] + arc[:-1]) / 2),
        "x_ref": (vector, geometry.X),
        "d_ref": (vector, geometry.D),
        "x": (vector, x),
        "d": (vector, d),
        "u": (vector, u[:, : len(AXES)]),
        "delta": (vector, u[:, len(AXES) :]),
        "mu_edge": (("edge",), measured.mu_edge),
        "mu": (("vertex",), measured.mu),
        "lam": (("vertex",), measured.lam),
        "phi": (("vertex",), measured.phi),
        "kappa": (("vertex",), measured.kappa),
        "applied_force": (force, load),
        "support_force": (force, point.reaction.reshape(load.shape)),
    }
    statistics: dict[str, int | float] = {
        "iterations": solver.iterations,
        "cutbacks": solver.cutbacks,
        "branch_switches": solver.branch_switches,
        "residual_N": point.residual,
        "tolerance_N": point.tolerance,
        "rounding_N": point.rounding,
    }
    return Solution(fields, statistics, labels)
