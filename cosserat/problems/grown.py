"""Rods whose loads grow from an equilibrium: that at rest, that of a pose, or a static answer whose loads stay."""

from __future__ import annotations

from dataclasses import replace
from typing import Self

import numpy as np
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.errors import InputError, NotConvergedError
from cosserat.problems.posed import PosedProblem
from cosserat.problems.static import RodStatics, check_supports
from cosserat.rods.constraints import MovedOn, PrescribedRotation
from cosserat.rods.reference import Geometry
from cosserat.solvers.equilibrium import Equilibrium, NewtonSettings
from cosserat.solvers.frames import framed
from cosserat.solvers.system import MechanicalSystem
from cosserat.solvers.tangent import Tangent

_STALLED = 16.0  # of the tolerance of an equilibrium, beyond which a force is not balanced
BODY = ("rod", "imperfection", "pose", "springs", "foundations")
"""Keys of what stays the same while loads grow."""


class GrownProblem(PosedProblem):
    """A rod problem whose loads grow from an equilibrium."""

    newton: NewtonSettings = NewtonSettings()
    start_from: RodStatics | None = None
    """Static problem of the same rod, in whose equilibrium the loads begin to grow.

    The loads of that problem stay as they are, and supports hold the rod where it is there.
    """

    @model_validator(mode="after")
    def _starts_from_the_same_body(self) -> Self:
        start = self.start_from
        if start is None:
            return self
        other = [key for key in BODY if getattr(start, key) != getattr(self, key)]
        if other:
            raise PydanticCustomError(
                "start",
                f"has a 'start_from' with another '{other[0]}'; give both the same, such as by 'like'",
            )
        if not np.array_equal(start.arc_length, self.arc_length):
            raise PydanticCustomError(
                "start",
                "has a 'start_from' with other vertices; give both supports, springs and masses at the same places",
            )
        return self

    @property
    def turned_before(self) -> tuple[PrescribedRotation, ...]:
        """Rotations of fixed sections where the loads begin to grow."""
        return () if self.start_from is None else self.start_from.prescribed_rotations

    @property
    def before(self) -> RodStatics | None:
        """The static problem from whose equilibrium the loads grow; None for the rod at rest."""
        if self.start_from is not None or self.pose is None:
            return self.start_from
        own = {name: getattr(self, name) for name in (*BODY, "supports", "masses", "newton")}
        return RodStatics(**own)

    def grown(self, geometry: Geometry, name: str) -> tuple[MechanicalSystem, tuple[str, ...]]:
        """The rod with its loads where they begin to grow, in displacements, and warnings of that equilibrium.

        Raises
        ------
        InputError : the supports let go of what they hold there.
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
        held, point = solver.system.unframed, point.unframed(solver.system)
        begun = self.begun(geometry, system, held, point)
        tangent = Tangent(begun)
        begun.assemble(begun.start, begun.history, 0.0, tangent)
        if np.abs(tangent.gradient[~begun.constrained]).max() > _STALLED * point.tolerance:
            raise InputError(
                f"{name}: a support holds the rod in the equilibrium of 'start_from' and not in this case; give both "
                "the same 'supports'"
            )
        return begun, tuple(f"{words} (of the start)" for words in solver.warnings())

    def begun(
        self, geometry: Geometry, system: MechanicalSystem, held: MechanicalSystem, point: Equilibrium
    ) -> MechanicalSystem:
        """The system with an equilibrium of another, whose loads stay, as its start.

        held, point : of the other, with DOFs along the axes of space.
        """
        plain, vectors = system.unframed, self.rod.vectors(geometry, point.q)
        moves = self.moves(Geometry(geometry.X, vectors[:, 1]))
        known = [
            replace(potential, history=history)
            for potential, history in zip(held.potentials, point.history, strict=True)
        ]
        loads = [replace(load, history=load.committed(point.q, load.history)) for load in plain.external]
        begun = replace(
            plain,
            internal=known[0],
            attached=tuple(known[1 : len(held.own)]),
            held=tuple(known[len(held.own) :]),
            external=tuple(loads),
            constraints=MovedOn(system.constrained, moves, system.frame.into(point.q)),
            began=point.q,
        )
        return framed(begun, system.frame)
