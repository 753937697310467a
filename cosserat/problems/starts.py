"""Starts of a motion: a shape, a natural mode about it, and velocities."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import InputError
from cosserat.exact import beams
from cosserat.parameters import Count, Parameters, Quantity
from cosserat.problems.posed import PosedProblem
from cosserat.problems.static import RodStatics, modes_about
from cosserat.rods.constraints import RodConstraints
from cosserat.rods.naming import Direction, unit_vector
from cosserat.rods.problem import LOADS, RodProblem
from cosserat.rods.reference import Geometry
from cosserat.solvers.banded import Mask
from cosserat.solvers.integrate import State
from cosserat.solvers.modes import Modes
from cosserat.solvers.system import MechanicalSystem
from cosserat.tables import Columns, Rows

if TYPE_CHECKING:
    from cosserat.problems.motion import RodMotion

Array = NDArray[np.float64]


class Start(Parameters):
    """Start of a motion: a shape, a natural mode that is added to it, and velocities."""

    shape: Literal["reference", "first beam mode", "equilibrium"] = "reference"
    """Shape: "first beam mode" bends the rod by eq. (3.5.16) and rotates the directors with it; "equilibrium" is that
    of `start_from`, or else under the loads of the motion as they are just before time zero.

    There a table has its first value; a ramp, a pulse or a sine that begins at zero is not yet there.
    """
    mode: Annotated[int, Count(at_least=1, at_most=100_000)] | None = None
    """Number of a natural mode about that shape, which is added to it; the lowest that deforms the rod is 1."""
    amplitude: Annotated[float, Quantity("m")] = 0.0
    """Displacement of the tip in the first beam mode, twice A_1 of eq. (3.5.16); of a natural mode, the largest."""
    mode_speed: Annotated[float, Quantity("m/s")] = 0.0
    """Largest speed of the natural mode."""
    speed: Annotated[float, Quantity("m/s")] = 0.0
    """Speed of the whole rod."""
    along: Direction = "E3"
    """Direction of that speed."""
    spin: Annotated[float, Quantity("rad/s")] = 0.0
    """Rate of rotation about the first vertex, from E3 towards E2."""
    velocities: (
        Annotated[
            Rows, Columns((("at", "m"), ("E3", "m/s"), ("E2", "m/s"), ("spin", "rad/s")), least_rows=1)
        ]
        | None
    ) = None
    """Velocities along the rod and rates of rotation of its sections, by arc length; straight lines between the rows,
    and beyond the first and the last row their values, so end a blow with rows of zero.

    They add to `speed` and `spin`."""

    def fault(self, *, straight: bool, static: bool, posed: bool) -> str:
        """What contradicts, in a sentence; empty if nothing does.

        straight : the rod is straight at rest.  static : it has a static problem to start from.  posed : it has a pose.
        """
        if posed and (self.shape == "first beam mode" or (self.mode and self.shape == "reference")):
            own = "start.mode" if self.mode else f"start.shape = '{self.shape}'"
            return f"has 'pose' and {own}; leave one of them out, or write start.shape = 'equilibrium'"
        if self.shape == "first beam mode" and not straight:
            return (
                f"has start.shape = '{self.shape}', which is that of a straight rod, but 'rod.rest' is not straight "
                "along E3; begin from the 'reference' or take a straight rod"
            )
        if static and self.shape != "equilibrium":
            return (
                f"has 'start_from' and start.shape = '{self.shape}'; write start.shape = 'equilibrium', or leave "
                "'start_from' out"
            )
        if self.mode is not None and self.shape == "first beam mode":
            return "has start.mode and start.shape = 'first beam mode'; leave one of them out"
        if self.mode is None and self.mode_speed:
            return "has start.mode_speed without start.mode; give the number of the mode"
        if self.mode is None and self.amplitude and self.shape == "equilibrium":
            return "has start.amplitude without start.mode; give the number of the mode"
        return ""


def begin(problem: RodMotion) -> State:
    """The state at time zero.

    Raises
    ------
    InputError : the static problem to start from has other vertices.
    UnsupportedRodError, NotConvergedError : there is no equilibrium.
    UnstableError : a mode is asked for, and small motions about the shape grow.
    """
    start, geometry, kinematics = problem.start, problem.geometry, problem.rod.kinematics
    system = RodProblem.system(problem, geometry, displacements=False)
    frame, free = system.frame, ~system.constrained
    q, lowest = _shape(problem, system)
    v = np.zeros_like(q)
    if start.mode is not None:
        mode = frame.out(np.where(free, frame.into(lowest(start.mode)), 0.0))
        mode = _scaled(kinematics.split(mode))
        q, v = q + start.amplitude * mode, v + start.mode_speed * mode
    pivot = np.zeros_like(kinematics.split(q))
    pivot[:, 0] = q[: kinematics.dimension]
    rotation = kinematics.rigid_motions(q - pivot.ravel())[kinematics.dimension]
    moved = np.zeros_like(pivot)
    moved[:, 0] = start.speed * unit_vector(start.along)
    if start.velocities is not None:
        moved += _along_the_rod(start.velocities, geometry.arc_length, kinematics.split(q))
    rate = np.where(free, frame.into(v + moved.ravel() + start.spin * rotation), 0.0)
    place, given, _ = system.constraints.at_time(0.0)
    q = np.where(_moved(system, problem, geometry), system.space.reference + place, frame.into(q))
    return State(q, rate + given, system.committed(q, system.history))


def _moved(system: MechanicalSystem, problem: RodMotion, geometry: Geometry) -> Mask:
    """Which DOFs (n,) the motion itself moves, from their reference values."""
    moved = np.zeros_like(system.constrained)
    for part in problem.moves(geometry):
        size = part.place(0.0)[0].size
        moved[part.index : part.index + size] = True
    return moved


def warnings(problem: RodMotion) -> tuple[str, ...]:
    """Warnings of the equilibrium from which a motion starts."""
    return _equilibrium(problem).warnings if problem.start.shape == "equilibrium" else ()


def _shape(problem: RodMotion, system: MechanicalSystem) -> tuple[Array, Callable[[int], Array]]:
    """The DOFs (n,) of the shape, and a function that gives the shape (n,) of a mode about it by its number.

    Both are along the axes of space.
    """
    geometry, kinematics, shape = problem.geometry, problem.rod.kinematics, problem.start.shape
    rest = system.unframed.space.reference
    if shape == "equilibrium":
        start = _equilibrium(problem)
        if not np.array_equal(start.arc, problem.arc_length):
            raise InputError(
                "'start_from' has other vertices than the motion; give both the same rod, and supports at the same "
                "places"
            )
        return start.q, lambda number: start.modes(number)[-1]

    def lowest(number: int) -> Array:
        found: Modes = problem.vibrations().lowest(number)
        if found.shape.shape[0] < number:
            raise InputError(
                f"'start.mode' is {number}, but the rod has {found.shape.shape[0]} modes; take a lower one"
            )
        return system.frame.out(found.shape[-1])

    if shape == "reference":
        return rest.copy(), lowest
    bent, slope = beams.first_beam_mode(problem.rod.length, geometry.arc_length)
    turn = np.arctan(problem.start.amplitude * slope)
    X = geometry.X.copy()
    X[:, 1] += problem.start.amplitude * bent
    D = geometry.director_length[:, None] * np.column_stack([-np.sin(turn), np.cos(turn)])
    vectors = kinematics.split(rest.copy())
    vectors[:, 0] = X
    vectors[:, 1] = problem.rod.strain_energy.start_directors(problem.rod, geometry, X, D)
    free, frame = ~system.constrained, system.frame
    return frame.out(np.where(free, frame.into(vectors.ravel()), system.space.reference)), lowest


def _static(problem: RodMotion) -> tuple[RodStatics, MechanicalSystem]:
    """The static problem whose equilibrium is the start, and its system."""
    if problem.start_from is not None:
        static = problem.start_from
        return static, static.system(static.geometry)
    fields = {name: getattr(problem, name) for name in RodStatics.model_fields if hasattr(problem, name)}
    for key in LOADS:
        if key in fields and isinstance(fields[key], tuple):
            fields[key] = tuple(load for load in fields[key] if load.level is None)
        elif key in fields and fields[key] is not None and fields[key].level is not None:
            fields[key] = None
    moved = {"prescribed_displacements": (), "prescribed_rotations": (), "kind": "rod statics"}
    static = RodStatics.read({**fields, **moved}, "start", units_required=False)
    geometry = problem.geometry
    parts = [
        part.times(part.time_function.before_zero)
        for part in problem.moves(geometry)
        if part.time_function is not None and part.time_function.before_zero
    ]
    loaded = PosedProblem.system(problem, geometry)
    return static, _before_zero(loaded, RodConstraints(loaded.constrained, tuple(parts)))


def _before_zero(system: MechanicalSystem, constraints: RodConstraints) -> MechanicalSystem:
    """A system of a motion with its loads as they are just before time zero."""
    loads = [
        load if load.level is None else load.times(load.level.before_zero)
        for load in system.external
        if not load.idle and (load.level is None or load.level.before_zero)
    ]
    plain = None if system.plain is None else _before_zero(system.plain, constraints)
    return replace(system, external=tuple(loads), constraints=constraints, plain=plain)


class _Equilibrium(NamedTuple):
    """The static answer from which a motion starts.

    q : (n,) DOFs, positions and directors.  modes : a number of them about it.
    """

    arc: Array
    q: Array
    warnings: tuple[str, ...]
    modes: Callable[[int], Array]


@functools.lru_cache(maxsize=4)
def _equilibrium(problem: RodMotion) -> _Equilibrium:
    """The equilibrium in which a motion starts."""
    static, system = _static(problem)
    geometry = static.geometry
    point, solver = static.equilibrium(geometry, system, "the start")
    placed: Array = static.rod.strain_energy.reference(geometry) + point.unframed(system).q
    words = tuple(f"{words} (of the start)" for words in solver.warnings())
    return _Equilibrium(
        geometry.arc_length,
        placed,
        words,
        lambda number: modes_about(system, point, number, "the start").shape,
    )


def _scaled(mode: Array) -> Array:
    """A mode (N, m, 2) with a largest displacement of one along its greater component, (n,)."""
    displaced = mode[:, 0]
    farthest = displaced[np.linalg.norm(displaced, axis=1).argmax()]
    sign = np.sign(farthest[np.abs(farthest).argmax()])
    scaled: Array = sign * mode.ravel() / np.linalg.norm(farthest)
    return scaled


def _along_the_rod(rows: Rows, arc: Array, vectors: Array) -> Array:
    """Velocities (N, m, 2) of positions and of directors that turn with their sections."""
    at, *columns = np.array(rows).T
    e3, e2, spin = (np.interp(arc, at, column) for column in columns)
    moved = np.zeros_like(vectors)
    moved[:, 0] = np.column_stack([e3, e2])
    moved[:, 1:, 0] = -spin[:, None] * vectors[:, 1:, 1]
    moved[:, 1:, 1] = spin[:, None] * vectors[:, 1:, 0]
    return moved
