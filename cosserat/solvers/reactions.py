"""Forces of the supports of a body in motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cosserat.solvers.banded import band_product, constrain, solve_positive
from cosserat.solvers.damping import momentum_damping, strain_damping
from cosserat.solvers.integrate import State
from cosserat.solvers.system import MechanicalSystem

Fields = NDArray[np.float64]


def reactions(system: MechanicalSystem, states: Sequence[State]) -> Fields:
    """The force of each constrained DOF at some states, zero for the others: (S, n) [N].

    derived: M a = R - gradient - D, where D is the damping, by mass and by modes of the free DOFs alone, and R the
    force of the constrained ones.  With the prescribed accelerations the rows of the free DOFs give theirs, then the
    others give R.  These are the forces of an instant: if a step does not resolve the fast modes of a body, their
    phases in it are arbitrary.
    """
    fixed = system.constrained
    forces, given = np.zeros((len(states), fixed.size)), np.zeros((len(states), fixed.size))
    if not fixed.any():
        return forces
    for number, state in enumerate(states):
        system.add_gradient(state.q, state.history, forces[number])
        forces[number] -= system.forces_at(state.q, state.history, state.time)
        forces[number] += strain_damping(system, state.q, state.v)
        given[number, fixed] = system.constraints.at_time(state.time)[-1][fixed]
    pull = np.array(
        [
            -gradient - band_product(system.inertia, momentum_damping(system, state.v) + acceleration)
            for state, gradient, acceleration in zip(states, forces, given, strict=True)
        ]
    )
    mass = system.inertia.copy()
    constrain(mass, fixed)
    free = solve_positive(mass, np.where(fixed, 0.0, pull).T)
    assert free is not None  # a mass is positive
    accelerations = np.where(fixed, given, free.T)
    inertial = np.array([band_product(system.inertia, row) for row in accelerations])
    held: Fields = np.where(fixed, inertial + forces, 0.0)
    return held
