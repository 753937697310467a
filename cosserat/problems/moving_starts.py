"""Rods whose loads grow from an equilibrium, which moves with a parameter as well.

derived: where the loads begin, the rod is in equilibrium under loads that stay, and its supports hold it there.  So that
equilibrium moves first, by its own Hessian.  It moves the supports of the rod whose loads grow, as a prescribed
displacement does, and the rest follows as for loads that grow from rest.
"""

from __future__ import annotations

from typing import cast

from cosserat.errors import InputError
from cosserat.problems.grown import GrownProblem
from cosserat.problems.posed import PosedProblem
from cosserat.problems.tangents import Body, Made, Moved, Nearby, move
from cosserat.rods.reference import Geometry
from cosserat.solvers.system import MechanicalSystem


def moving_start(problem: GrownProblem, nearby: Nearby, name: str) -> Made | None:
    """The system of a problem after a step, its loads beginning in an equilibrium that moves to first order.

    None where the loads grow from rest.

    Raises
    ------
    InputError : that equilibrium has no derivative.
    """
    before = problem.before
    if before is None:
        return None
    base = Body.of(before)
    point, _ = before.equilibrium(base.geometry, base.system, f"{name}, the start")
    moved = Moved(lambda step: nearby(step).before, base, point)
    (why,) = move([moved])
    if why:
        raise InputError(f"where the loads begin, {why}")

    def begun(step: float, other: PosedProblem, geometry: Geometry) -> MechanicalSystem:
        held, state = moved.system(step), moved.state(step)
        own = cast("GrownProblem", other)
        return own.begun(geometry, own.system(geometry), held.unframed, state.unframed(held))

    return begun
