"""Arguments of the compiled time steps of `solvers.energy_momentum`: potentials, constants and work space."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cosserat.solvers.banded import Band, Mask, Vector

Fields = NDArray[np.float64]


CORRECTED, FORCED, COUNTED = range(3)
"""Roles of a potential: the work of its forces must equal its change of energy; it is a force that depends on time or
has no potential; or it is linear, a part of the dead load, and only its internal variables count."""


class Bodies(NamedTuple):
    """The potentials of a step for compiled code, one entry of each tuple per potential.

    kernels, constants, history, strains, terms : arguments of `solvers.potential.KERNEL`.
    role : (k,) one of the roles above.  loaded, forced : whether some are corrected beside the body, or forced.
    counted : which of them have internal variables.
    """

    kernels: Any
    constants: Any
    history: Any
    strains: Any
    terms: Any
    role: NDArray[np.int64]
    loaded: bool
    forced: bool
    counted: NDArray[np.int64]


class Run(NamedTuple):
    """Constants of all steps.

    mass : band (n, w).  load : (n,) constant dead load.  constrained : (n,).  translations : (d, n), or (0, n) where a
    DOF is constrained.  h : the time step.  damping_rate : c.  damping_time : T of the stiffness-proportional damping.
    reference, rest_strains : DOFs (n,) of the reference along the axes of space, and the strains of the body there.
    damped_modes : (m, n) shapes, of unit modal mass; modal_rates : (m,) rates at which they lose energy.
    dimension : number of components of a vector.
    weights : (n,) one over the lengths of vectors whose change is a rotation, zero for other DOFs.
    moved : (m,) constrained DOFs that move; places, rates : (steps + 1, m) their displacements and rates.
    varied : (l, n) dead loads that depend on time; factors : (steps, l) theirs, means over the steps.
    levels : (steps, k) factors of the potentials that are forced.
    framed, axes : (p,) first DOF of each pair with a frame of its own, (2, p) cosine and sine of its first axis.
    """

    mass: Band
    load: Vector
    constrained: Mask
    translations: Fields
    h: float
    damping_rate: float
    dimension: int
    weights: Vector
    moved: NDArray[np.int64]
    places: Fields
    rates: Fields
    varied: Fields
    factors: Fields
    levels: Fields
    framed: NDArray[np.int64]
    axes: Fields
    damping_time: float
    reference: Vector
    rest_strains: Fields
    damped_modes: Fields
    modal_rates: Vector


class Room(NamedTuple):
    """Work space; all (n,) except `memory`, `rotations` and the bands `factor`, `mass_factor`, `pushing`, `resisting`.

    change, first : of the DOFs in the step, and its first guess.  earlier, earliest : changes of the last two steps.
    middle, end : DOFs along the axes of space, as potentials take them.  gradient : of energy and loads.
    pull : force of the momentum at the start and the dead load.
    gained : change of the DOFs at the prescribed velocity.  product : M gained.
    force : unbalanced force.  z : direction of the force that corrects the energy.
    load : the dead load of the step.  pushed, pushing : gradient and Hessian of the forced loads.
    resisted, resisting : minus the force of the stiffness-proportional damping, and the stiffness of the material.
    memory : (4,) what a step tells the next one about its matrix.
    """

    change: Vector
    first: Vector
    earlier: Vector
    earliest: Vector
    middle: Vector
    end: Vector
    gradient: Vector
    pull: Vector
    gained: Vector
    product: Vector
    force: Vector
    z: Vector
    load: Vector
    pushed: Vector
    resisted: Vector
    memory: Vector
    rotations: Fields
    factor: Band
    mass_factor: Band
    pushing: Band
    resisting: Band
