"""Rods whose loads grow from an equilibrium: their systems after a step of a parameter.

derived: no key moves what the supports of such a rod hold where its loads begin.  With a pose they hold it from the
beginning, and the static problem to start from is the same for all values of the keys.  So equilibria under the
loads move as those of loads that grow from rest do.  The place where the loads begin is only near: its strains are
kept, but what is held stays where it is held; those who begin there correct it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import cast

from cosserat.problems.grown import GrownProblem
from cosserat.problems.posed import PosedProblem
from cosserat.problems.tangents import Body, Made, Moved, Nearby
from cosserat.rods.reference import Geometry
from cosserat.solvers.system import MechanicalSystem


def begun_after(problem: GrownProblem, nearby: Nearby, name: str) -> Made | None:
    """The system of a problem after a step, with the place where its loads begin; None where they grow from rest."""
    before = problem.before
    if before is None:
        return None
    base = Body.of(before)
    point, _ = before.equilibrium(base.geometry, base.system, f"{name}, the start")
    carried = Moved(lambda step: nearby(step).before, base, point)

    def begun(step: float, other: PosedProblem, geometry: Geometry) -> MechanicalSystem:
        own, held, start = cast("GrownProblem", other), carried.system(step), carried.state(step)
        start = replace(start, q=held.prescribe(start.q, start.factor))
        return own.begun(geometry, own.system(geometry), held.unframed, start.unframed(held))

    return begun
