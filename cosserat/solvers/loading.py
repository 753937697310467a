"""Forces and energies of the loads of an equilibrium: those that grow, at their load factor, and held ones."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cosserat.solvers.banded import Vector
from cosserat.solvers.equilibrium import Equilibrium
from cosserat.solvers.potential import Potential
from cosserat.solvers.system import MechanicalSystem


def load_gradient(system: MechanicalSystem, point: Equilibrium) -> Vector:
    """The gradient of the loads, (n,) [N]: minus their force."""
    gradient, held = -system.dead_load, np.zeros_like(point.q)
    grown = zip(system.external, point.history[len(system.own) :], strict=True)
    for load, own in grown:
        if not load.linear and load.level is None:
            load.add_gradient(point.q, own, gradient)
    for load, own in _held(system, point):
        load.add_gradient(point.q, own, held)
    return point.factor * gradient + held


def coupled_energy(system: MechanicalSystem, point: Equilibrium) -> float:
    """The energy of the loads that are not dead [J]."""
    grown = point.factor * system.nonlinear_load_energy(point.q, point.history)
    if not system.held:
        return grown
    return grown + sum(
        load.energy(point.q, own) for load, own in _held(system, point) if not load.linear
    )


def load_energy(system: MechanicalSystem, point: Equilibrium, coupled: float) -> float:
    """The energy of the loads, where that of those that are not dead is known [J]."""
    dead = point.factor * system.dead_load @ (point.q - system.space.reference)
    held = sum(load.energy(point.q, own) for load, own in _held(system, point) if load.linear)
    return coupled - float(dead) + held


def _held(system: MechanicalSystem, point: Equilibrium) -> Iterator[tuple[Potential, Vector]]:
    """The loads that are held, with their internal variables."""
    first = 1 + len(system.attached)
    return zip(system.held, point.history[first : len(system.own)], strict=True)
