"""Rods that are bent into a pose before they are held: a ring that is closed, a curl that is unrolled.

derived: let W be the energy, with its strains measured from the shape at rest, and let the supports hold the rod where
it is in the pose.  A rod that would be without stress in the pose is in equilibrium there.  From that one to the rod
itself, the strains without stress grow from zero to the difference of both references, as a load does
(`cosserat.rods.loads.strains`), together with all other loads.  So the answer does not depend on the way in which
Newton's method might come from a pose far off.  At the end the equilibrium is that of W itself.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Self

import numpy as np
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.errors import NotConvergedError
from cosserat.rods.energies.reissner import measured_from, stressed
from cosserat.rods.loads.strains import is_quadratic
from cosserat.rods.problem import RodProblem
from cosserat.rods.reference import Geometry
from cosserat.rods.shapes import AnyShape
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver
from cosserat.solvers.incremental import solve_full_load
from cosserat.solvers.potential import Potential
from cosserat.solvers.system import MechanicalSystem


class PosedProblem(RodProblem):
    """A rod problem that may begin in a pose."""

    pose: AnyShape | None = None
    """Shape into which the rod is bent before its supports hold it there; by default it begins at rest.

    Displacements count from the pose.
    """

    @model_validator(mode="after")
    def _can_be_posed(self) -> Self:
        if self.pose is None:
            return self
        if not is_quadratic(self.rod):
            raise PydanticCustomError(
                "energy",
                "'pose' needs rod.energy = 'consistent' without 'rod.barrier'; take that, or leave 'pose' out",
            )
        if self.imperfection is not None and self.imperfection.kind == "buckling mode":
            raise PydanticCustomError(
                "imperfection",
                "has a 'pose' and an 'imperfection' of kind 'buckling mode', which is that of a rod loaded from its "
                "shape at rest; take kind = 'mode' or 'bow', or leave 'pose' out",
            )
        self.rod.check_shape("pose", self.pose)
        return self

    @property
    def geometry(self) -> Geometry:
        """The configuration in which the supports hold the rod: its pose, or the one at rest."""
        rest = super().geometry
        if self.pose is None:
            return rest
        return self.rod.placed(self.pose, rest.arc_length, rest.director_length)

    def system(self, geometry: Geometry, *, displacements: bool = True) -> MechanicalSystem:
        """The rod with its loads, constraints and mass; its strains are measured from its shape at rest."""
        system = super().system(geometry, displacements=displacements)
        if self.pose is None:
            return system
        rest, plain = self._at_rest(), system.plain
        if plain is not None:
            plain = replace(plain, internal=measured_from(rest, plain.internal))
        return replace(system, internal=measured_from(rest, system.internal), plain=plain)

    def energy(self, geometry: Geometry) -> Potential:
        """The strain energy, a potential of displacements from the pose."""
        own = super().energy(geometry)
        return own if self.pose is None else measured_from(self._at_rest(), own)

    def _at_rest(self) -> Potential:
        return self.rod.strain_energy.potential(self.rod, super().geometry)

    def settled(
        self, geometry: Geometry, solver: EquilibriumSolver, *, stay: bool = False
    ) -> tuple[Equilibrium, EquilibriumSolver]:
        """The equilibrium at the full load from the pose, and the solver that found it.

        stay : on its path where symmetry would let it, also beyond its loss of stability.

        Raises
        ------
        NotConvergedError : no path leads there; the last point is its `state`.
        """
        if self.pose is None:
            return solve_full_load(solver, stay=stay), solver
        system, own = solver.system, super().system(geometry).internal
        rest = self._at_rest().constants
        edge = own.constants["edge"][:-1]
        axial, slide, turn = (
            (rest[name] - own.constants[name])[:-1] / edge for name in ("axial", "slide", "turn")
        )
        load = replace(stressed(own, axial, turn, np.zeros(edge.size + 1), slide), frame=own.frame)
        way = replace(system, internal=own, external=(*system.external, load))
        walk = EquilibriumSolver(way, solver.settings, solver.name)
        bent = solve_full_load(walk, stay=stay)
        for name in (
            "iterations",
            "cutbacks",
            "branch_switches",
            "undecided_factors",
            "passed_limit_load",
        ):
            setattr(solver, name, getattr(walk, name))
        point = solver.correct(bent.q, 1.0, bent.history[:-1])
        if point is None:
            raise NotConvergedError(
                f"{solver.name}: from 'pose' no equilibrium of the rod is found; take more 'rod.vertices'",
                iterations=solver.iterations,
                residual=solver.residual,
                tolerance=solver.tolerance,
            )
        return point, solver
