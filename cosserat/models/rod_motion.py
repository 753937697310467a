"""Motion of the discrete planar rod, eqs. (3.3.43)-(3.3.50), from a given start, with frames at equal times."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray

from cosserat import analytic
from cosserat.errors import CosseratError, DivergedError, NotConvergedError
from cosserat.models.consistent import keeping_volume
from cosserat.models.planar_rod import AXES, UNKNOWNS, Geometry, counted_angles, rigid_motions
from cosserat.models.rod import Direction, RodBody, RodProblem, unit_vector
from cosserat.outcome import Outcome
from cosserat.parameters import Parameters, Quantity
from cosserat.solvers.banded import band_product
from cosserat.solvers.modes import Modes, first_elastic_frequency, modes
from cosserat.solvers.motion import (
    IntegratorSettings,
    State,
    System,
    advance,
    body_at,
    kinetic_energy,
    refuse_unstable_step,
)
from cosserat.solvers.stepping import counted_on

Array = NDArray[np.float64]

FRAMES_PER_PART = 50
"""Frames computed between two stored parts of a long run."""


class Start(Parameters):
    """Where a motion begins: a shape, and velocities of the whole rod."""

    shape: Literal["reference", "first beam mode"] = "reference"
    """"first beam mode" bends the rod as eq. (3.5.16) says and turns the directors with it."""
    amplitude: Annotated[float, Quantity("m", "A_1", "3.5.16")] = 0.0
    speed: Annotated[float, Quantity("m/s")] = 0.0
    along: Direction = "E3"
    spin: Annotated[float, Quantity("rad/s")] = 0.0
    """Rate of rotation about the first vertex, from E3 towards E2."""


class RodMotion(RodProblem):
    """A rod moving from a start, perhaps damped, under dead loads."""

    kind: Literal["rod motion"] = "rod motion"
    start: Start = Start()
    duration: Annotated[float, Quantity("s", above=0)]
    every: Annotated[float, Quantity("s", above=0)]
    """Time between two frames."""
    damping: Annotated[float, Quantity("1", r"\zeta", "section 3.5", at_least=0)] = 0.0
    """Share of the critical damping of the lowest mode that deforms the rod.

    ASSUME a force -2 zeta omega_1 M v: the page names none.
    """
    integrator: IntegratorSettings

    @property
    def frames(self) -> int:
        """Number of frames after the first."""
        return max(1, round(self.duration / self.every))

    @property
    def between_frames(self) -> float:
        """Time from one frame to the next [s]."""
        return self.duration / self.frames

    @property
    def parts(self) -> int:
        """Number of parts in which a run is stored."""
        return -(-self.frames // FRAMES_PER_PART)

    def system(self, geometry: Geometry) -> System:
        """What moves: body, mass, loads, supports and drag."""
        held = self.held().ravel()
        at_rest = System(
            self.body(geometry),
            self.mass(geometry),
            self.loads(geometry).ravel(),
            held,
            drag=0.0,
            translations=np.empty((0, held.size))
            if held.any()
            else _rigid_fields(reference(geometry))[:2],
            drive=self.drive if self.moves else None,
        )
        if not self.damping:
            return at_rest
        lowest = first_elastic_frequency(at_rest, reference(geometry))
        return replace(at_rest, drag=2 * self.damping * lowest)

    def modes(self, count: int, name: str = "the rod") -> Modes:
        """The lowest natural frequencies and shapes about the reference configuration.

        Raises
        ------
        UnstableError : small motions about it grow.
        """
        geometry = self.rod.geometry()
        return modes(self.system(geometry), reference(geometry), count, name)

    def begin(self, name: str) -> State:
        """The state at time zero.

        Raises
        ------
        InputError : the integrator's fixed step is beyond its stability limit there.
        """
        geometry = self.rod.geometry()
        X, D, xi = geometry.X.copy(), geometry.D.copy(), geometry.arc_length
        if self.start.shape == "first beam mode":
            shape, slope = analytic.first_beam_mode(self.rod.length, xi)
            turn = np.arctan(self.start.amplitude * slope)
            X[:, 1] += self.start.amplitude * shape
            D = geometry.director_length[:, None] * np.column_stack([-np.sin(turn), np.cos(turn)])
            if self.body(geometry).averaged >= 0:
                D = keeping_volume(geometry, X, D, self.rod.section)
        q = np.where(self.held(), np.hstack([geometry.X, geometry.D]), np.hstack([X, D]))
        v = np.zeros_like(q)
        v[:, : len(AXES)] = self.start.speed * unit_vector(self.start.along)
        v += self.start.spin * rigid_motions(q - np.hstack([q[0, :2], 0.0, 0.0]))[2]
        v[self.held()] = 0.0
        place, rate = self.drive(0.0)
        start = q.ravel() + place
        upright = counted_angles(geometry.D)[0]
        state = State(start, v.ravel() + rate, angle=counted_on(start[3], start[2], upright))
        refuse_unstable_step(self.system(geometry), state.q, self.between_frames, self.integrator, name)
        return state

    def part(self, number: int, state: State, name: str) -> tuple[Outcome, State, CosseratError | None]:
        """Frames of one part, from the state in which the part before it ended; the first part has the start too.

        Where the integrator cannot go on, the frames before that and its error come back.
        """
        geometry = self.rod.geometry()
        system = self.system(geometry)
        first = number * FRAMES_PER_PART
        states, steps, stopped = ([state] if number == 0 else []), 0, None
        begin = first + 1 - len(states)
        for _ in range(first, min(first + FRAMES_PER_PART, self.frames)):
            try:
                state, done = advance(system, state, self.between_frames, self.integrator, name)
            except (NotConvergedError, DivergedError) as error:
                stopped = error
                break
            states.append(state)
            steps += done
        numbers = begin + np.arange(len(states), dtype=np.float64)
        times = numbers * self.between_frames
        rod = self.rod.body(geometry)
        fields = _frames(geometry, system, rod, states, times) if states else {}
        return Outcome(fields, {"steps": steps}), state, stopped

    def resume(self, fields: dict[str, Array]) -> State:
        """The state in which a stored part ended, from its fields."""
        return State(
            np.hstack([fields["x"][-1], fields["d"][-1]]).ravel(),
            np.hstack([fields["x_rate"][-1], fields["d_rate"][-1]]).ravel(),
            float(fields["time"][-1]),
            float(fields["first_angle"][-1]),
        )


def reference(geometry: Geometry) -> Array:
    """The unknowns of the reference configuration, shape (4 N,)."""
    return np.hstack([geometry.X, geometry.D]).ravel()


def _rigid_fields(q: Array) -> Array:
    return rigid_motions(q.reshape(-1, len(UNKNOWNS))).reshape(3, -1)


def _frames(
    geometry: Geometry, system: System, rod: RodBody, states: list[State], times: Array
) -> dict[str, Array]:
    q = np.array([state.q for state in states]).reshape(len(states), -1, len(UNKNOWNS))
    v = np.array([state.v for state in states]).reshape(q.shape)
    start = reference(geometry)
    strain = np.array([rod.energy(state.q) for state in states])
    loaded = [body_at(system, s).energy(s.q) - system.load @ (s.q - start) for s in states]
    momenta = np.array([_rigid_fields(s.q) @ band_product(system.mass, s.v) for s in states])
    return {
        "time": times,
        "xi": geometry.arc_length,
        "x_ref": geometry.X,
        "d_ref": geometry.D,
        "x": q[..., :2],
        "d": q[..., 2:],
        "x_rate": v[..., :2],
        "d_rate": v[..., 2:],
        "first_angle": np.array([state.angle for state in states]),
        "kinetic_energy": np.array([kinetic_energy(system, state) for state in states]),
        "strain_energy": strain,
        "load_potential": np.array(loaded) - strain,
        "momentum": momenta[:, :2],
        "angular_momentum": momenta[:, 2],
    }
