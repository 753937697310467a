"""Motion by the implicit method of `solvers.energy_momentum`."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numba import njit as numba_njit
from numba import types as numba_types
from numpy.typing import NDArray

from cosserat.errors import InputError, NotConvergedError
from cosserat.solvers.banded import NO_BAND, Vector
from cosserat.solvers.damping import rest_dofs, rest_strains
from cosserat.solvers.energy_momentum import MAX_ITERATIONS, TOLERANCE, integrate_steps
from cosserat.solvers.integrate import IntegratorSettings, State, step_count
from cosserat.solvers.potential import KERNEL, NOTHING, Potential
from cosserat.solvers.step import CORRECTED, COUNTED, FORCED, Bodies, Room, Run
from cosserat.solvers.system import MechanicalSystem

Fields = NDArray[np.float64]
_POTENTIAL_SLOTS = 6  # of compiled steps; more potentials need another compilation
types: Any = numba_types  # which says nothing of its own types
njit: Any = numba_njit  # whose types leave out the option `_nrt`


@functools.cache
def _compiled_steps(count: int) -> Callable[..., int]:
    """`integrate_steps` for a number of potentials, compiled; loaded only where a motion needs it."""
    vector, matrix, mask = types.float64[::1], types.float64[:, ::1], types.boolean[::1]
    whole = types.int64[::1]
    each = (types.FunctionType(KERNEL), types.uint8[::1], vector, matrix, vector)
    several = [types.UniTuple(one, count) for one in each]
    bodies = types.NamedTuple((*several, whole, types.boolean, types.boolean, whole), Bodies)
    number = types.float64
    given = (
        *(matrix, vector, mask, matrix, number, number, types.int64, vector, whole, *(matrix,) * 5),
        *(whole, matrix, number, vector, matrix, matrix, vector),
    )
    run = types.NamedTuple(given, Run)
    room = types.NamedTuple((*(vector,) * 16, *(matrix,) * 5), Room)
    signature = types.int64(bodies, run, room, vector, vector, vector, vector)
    (compiled,) = njit(signature, cache=True, _nrt=False)(integrate_steps).overloads.values()
    # called directly: the types are known, and to find them anew takes half a millisecond a call
    steps: Callable[..., int] = compiled.entry_point
    return steps


def integrate_implicitly(
    system: MechanicalSystem, state: State, duration: float, settings: IntegratorSettings, name: str
) -> tuple[State, int]:
    """Move on by equal steps.

    Raises
    ------
    InputError : the DOFs are displacements where the method needs positions.
    NotConvergedError : a step found no solution.
    """
    _check_positions(system, state, name)
    count = step_count(duration, settings)
    h, n = duration / count, state.q.size
    met = [k for k, p in enumerate(system.potentials) if not p.linear or p.history.size]
    potentials = [system.potentials[k] for k in met]
    history = list(state.history)
    for k in met:
        history[k] = history[k].copy()
    bodies = _bodies(potentials, [history[k] for k in met])
    width = 1 + max(np.flatnonzero(system.inertia.any(axis=0)), default=0)
    mass = np.ascontiguousarray(system.inertia[:, :width])
    translations = _free_translations(system, state)
    dimension = translations.shape[0]
    rotations = np.zeros((dimension * (dimension - 1) // 2, n))
    run = Run(
        mass,
        system.dead_load,
        system.constrained,
        translations,
        h,
        system.damping_rate,
        system.space.dimension,
        system.space.rotation_weights(state.q),
        *_prescribed(system, state.time, h, count),
        *_varied(system, potentials, np.asarray(state.time + h * np.arange(count + 1))),
        system.frame.first,
        system.frame.axes,
        system.damping_time,
        rest_dofs(system),
        rest_strains(system, name) if system.damping_time else NO_BAND,
        system.damped_modes.shape,
        system.damped_modes.rate,
    )
    vectors = [np.zeros(n) for _ in range(15)] + [np.zeros(4)]
    factor = np.empty((n, max(width, system.half_bandwidth + 1)))
    pushing = np.empty_like(factor if bodies.forced else factor[:0])
    resisting = np.empty_like(factor if system.damping_time else factor[:0])
    room = Room._make([*vectors, rotations, factor, mass.copy(), pushing, resisting])
    q, v = state.q.copy(), state.v.copy()
    exchanged = np.array([state.dissipated, state.driven, state.load_work])
    turned = np.zeros(1)
    done = _compiled_steps(len(bodies.kernels))(bodies, run, room, q, v, exchanged, turned)
    if done < count:
        raise NotConvergedError(
            f"{name}: a time step of {h:.3g} s found no solution; take a shorter 'integrator.step'",
            iterations=MAX_ITERATIONS,
            tolerance=TOLERANCE,
        )
    dissipated, driven, load_work = exchanged.tolist()
    reached = (state.time + count * h, dissipated, driven, load_work, float(turned[0]))
    return State(q, v, tuple(history), *reached), count


class _EmptySlot:
    """Stands for a kernel that is never called.  Numba looks up the code of a real one at every call of the steps."""

    def __wrapper_address__(self) -> int:
        """No address."""
        return -1


_EMPTY_SLOT = _EmptySlot()


def _bodies(potentials: list[Potential], history: list[Vector]) -> Bodies:
    """The potentials for compiled code, padded to a compiled number of slots."""
    slots = _POTENTIAL_SLOTS
    while slots < len(potentials):
        slots *= 2
    empty, roles = slots - len(potentials), [_role(p) for p in potentials]
    none, without = (NOTHING,) * empty, (NO_BAND,) * empty
    return Bodies(
        (*(p.evaluate for p in potentials), *(_EMPTY_SLOT,) * empty),
        (*(p.data for p in potentials), *(potentials[0].data,) * empty),
        (*history, *none),
        (*(np.zeros(p.strains) for p in potentials), *without),
        (*(np.empty(len(p.terms)) for p in potentials), *none),
        np.array(roles + [COUNTED] * empty),
        CORRECTED in roles[1:],
        FORCED in roles,
        np.flatnonzero([p.history.size > 0 for p in potentials]),
    )


def _role(potential: Potential) -> int:
    """Role of a potential in a step."""
    if potential.linear:
        return COUNTED
    return CORRECTED if potential.symmetric and potential.level is None else FORCED


def _varied(
    system: MechanicalSystem, potentials: list[Potential], times: Vector
) -> tuple[Fields, Fields, Fields]:
    """Dead loads that depend on time, their factors, and the factors of the forced potentials, means over the steps."""
    loads, n, steps = system.varied_loads, system.constrained.size, times.size - 1
    varied = np.array([force for _, force in loads]).reshape(len(loads), n)
    factors = np.column_stack([np.empty((steps, 0)), *(level.means(times) for level, _ in loads)])
    levels = np.ones((steps, len(potentials)))
    for k, potential in enumerate(potentials):
        if potential.level is not None and not potential.linear:
            levels[:, k] = potential.level.means(times)
    return varied, np.ascontiguousarray(factors), levels


def _prescribed(
    system: MechanicalSystem, start: float, h: float, count: int
) -> tuple[NDArray[np.int64], Fields, Fields]:
    """Constrained DOFs that move, with their places and rates at the ends of all steps."""
    if not system.constraints.moving:
        return np.empty(0, dtype=np.int64), np.zeros((count + 1, 0)), np.zeros((count + 1, 0))
    moved = np.flatnonzero(system.constrained)
    path = np.zeros((2, count + 1, moved.size))
    for number in range(count + 1):
        place, rate, _ = system.constraints.at_time(start + number * h)
        path[:, number] = place[moved], rate[moved]
    return moved, path[0], path[1]


def _free_translations(system: MechanicalSystem, state: State) -> Fields:
    """The translations (d, n) of a free body; (0, n) where it is supported or attached."""
    if system.constrained.any() or system.attached:
        return np.empty((0, state.q.size))
    return np.ascontiguousarray(system.space.rigid_motions(state.q)[: system.space.dimension])


def _check_positions(system: MechanicalSystem, state: State, name: str) -> None:
    """Raise InputError where compiled steps would take displacements for positions."""
    displaced = any(potential.origin is not None for potential in system.potentials)
    if not displaced and not system.constrained.any():  # positions at the origin have no rotation
        rotations = system.space.rigid_motions(np.zeros_like(state.q))[system.space.dimension :]
        displaced = bool(rotations.any())
    if displaced:
        raise InputError(
            f"{name}: the method 'implicit' moves positions, and these degrees of freedom are displacements; "
            "take a configuration space whose degrees of freedom are positions"
        )
