"""Rods whose loads grow from an equilibrium: that at rest, or that of a pose."""

from __future__ import annotations

from dataclasses import replace

from cosserat.errors import NotConvergedError
from cosserat.problems.posed import PosedProblem
from cosserat.problems.static import RodStatics, check_supports
from cosserat.rods.constraints import MovedOn
from cosserat.rods.problem import RodProblem
from cosserat.rods.reference import Geometry
from cosserat.solvers.banded import Vector
from cosserat.solvers.equilibrium import NewtonSettings
from cosserat.solvers.frames import framed
from cosserat.solvers.system import History, MechanicalSystem

BODY = ("rod", "imperfection", "pose", "springs", "foundations")
"""Keys of what stays the same while loads grow."""


class GrownProblem(PosedProblem):
    """A rod problem whose loads grow from an equilibrium."""

    newton: NewtonSettings = NewtonSettings()

    @property
    def before(self) -> RodStatics | None:
        """The static problem from whose equilibrium the loads grow; None for the rod at rest."""
        if self.pose is None:
            return None
        own = {name: getattr(self, name) for name in (*BODY, "supports", "masses", "newton")}
        return RodStatics(**own)

    def grown(self, geometry: Geometry, name: str) -> tuple[MechanicalSystem, tuple[str, ...]]:
        """The rod with its loads where they begin to grow, in displacements, and warnings of that equilibrium.

        Raises
        ------
        UnsupportedRodError : a rigid motion is left free.
        NotConvergedError : there is no such equilibrium.
        """
        system, before = self.system(geometry), self.before
        check_supports(system, name)
        if before is None:
            return system, ()
        start = f"{name}, the start"
        try:
            point, solver = before.equilibrium(geometry, before.system(geometry), start)
        except NotConvergedError as error:
            error.reached = None  # a result of another kind
            raise
        point, warnings = point.unframed(solver.system), solver.warnings()
        begun = self._begun(geometry, system, point.q, point.history)
        return begun, tuple(f"{words} (of the start)" for words in warnings)

    def _begun(
        self, geometry: Geometry, system: MechanicalSystem, q: Vector, history: History
    ) -> MechanicalSystem:
        """The system with an equilibrium, its DOFs along the axes of space and its internal variables, as the start."""
        plain, vectors = system.unframed, self.rod.vectors(geometry, q)
        moves = RodProblem.moves(self, Geometry(geometry.X, vectors[:, 1]))
        constraints = MovedOn(system.constrained, moves, system.frame.into(q))
        own = [
            replace(potential, history=known)
            for potential, known in zip(plain.own, history, strict=False)
        ]
        loads = [replace(load, history=load.committed(q, load.history)) for load in plain.external]
        begun = replace(
            plain,
            internal=own[0],
            attached=tuple(own[1:]),
            external=tuple(loads),
            constraints=constraints,
            began=q,
        )
        return framed(begun, system.frame)
