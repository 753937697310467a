"""The course of a motion: in parts that take a second or two each, so that a long run can be cut and goes on."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import CosseratError, CrossingError, DivergedError, NotConvergedError
from cosserat.rods.kinematics import AXES, DOFS, Geometry, reference, rigid_fields
from cosserat.rods.resolution import (
    FAST,
    UNBALANCED,
    UNRESOLVED,
    check_crossing,
    coarse,
    unresolved_energy,
)
from cosserat.rods.rod import RodBody
from cosserat.solution import Field, Solution
from cosserat.solvers.banded import band_product
from cosserat.solvers.integrate import (
    DAMPED,
    State,
    System,
    body_at,
    check_stable_step,
    highest_frequency,
    integrate,
    kinetic_energy,
    stable_step,
    step_count,
)

if TYPE_CHECKING:
    from cosserat.problems.motion import RodMotion

Array = NDArray[np.float64]

FRAMES_PER_PART = 50
"""Most frames in one stored part of a run."""
JUDGED = 100
"""Most states of a motion that are asked for modes its step does not follow."""
WORK_PER_PART = 5e5
"""Most vertices times implicit steps in one part: a second, at some two microseconds each (`cosserat speed`)."""

_COST = {"implicit": (0.0, 1.0), "rk4": (30.0, 0.5), "rk45": (300.0, 2.0)}
"""A step costs as an implicit one of a + b N vertices; of "rk45", one that is as long as is stable."""


@dataclass(frozen=True)
class CheckpointedRun:
    """A motion on its way through stops at equal times, of which every `legs`-th is a frame.

    geometry, system : of the problem, made once.  stops_per_part : stops from one stored part to the next.
    """

    problem: RodMotion
    name: str
    geometry: Geometry
    system: System
    substeps_per_frame: int
    stops_per_part: int

    @classmethod
    def of(cls, problem: RodMotion, name: str) -> CheckpointedRun:
        """Lay a motion out; `name` is what errors call the case.

        Raises
        ------
        InputError : the integrator's fixed step is beyond its stability limit at the start.
        """
        geometry = problem.rod.geometry()
        system = problem.system(geometry)
        work = _work_of_a_frame(problem, system, geometry)
        substeps_per_frame = max(1, math.ceil(work / WORK_PER_PART))
        stops = 1 if substeps_per_frame > 1 else max(1, min(FRAMES_PER_PART, int(WORK_PER_PART / work)))
        substep = problem.between_frames / substeps_per_frame
        check_stable_step(system, problem.begin().q, substep, problem.integrator, name)
        return cls(problem, name, geometry, system, substeps_per_frame, stops)

    @property
    def parts(self) -> int:
        """Number of parts in which the run is stored."""
        return -(-self.problem.frames * self.substeps_per_frame // self.stops_per_part)

    def part(self, number: int, state: State) -> tuple[Solution, State, CosseratError | None]:
        """States at the stops of one part, from that in which the part before it ended; the first has the start too.

        Where the integrator cannot go on, the states before that and its error come back.
        """
        first = number * self.stops_per_part
        last = min(first + self.stops_per_part, self.problem.frames * self.substeps_per_frame)
        states, steps, stopped = ([state] if number == 0 else []), 0, None
        substep = self.problem.between_frames / self.substeps_per_frame
        for stop in range(first + 1, last + 1):
            try:
                state, done = integrate(self.system, state, substep, self.problem.integrator, self.name)
                q = state.q.reshape(-1, len(DOFS))
                check_crossing(
                    self.geometry,
                    q[:, :2],
                    q[:, 2:],
                    self.problem.rod.below,
                    f"{self.name}, {state.time:.4g} s",
                )
            except (NotConvergedError, DivergedError, CrossingError) as error:
                stopped = error
                break
            # the time that is stored: a run that goes on from it must not differ by rounding
            state = replace(state, time=stop / self.substeps_per_frame * self.problem.between_frames)
            states.append(state)
            steps += done
        rod = self.problem.rod.body(self.geometry)
        fields = _fields(self.geometry, self.system, rod, states) if states else {}
        statistics = {"steps": steps, **self._judged(states)}
        return Solution(fields, statistics, {"axis": AXES}), state, stopped

    @property
    def step(self) -> float:
        """The time step of a method that takes equal ones; zero if it chooses them [s]."""
        if self.problem.integrator.method == "rk45":
            return 0.0
        substep = self.problem.between_frames / self.substeps_per_frame
        return substep / step_count(substep, self.problem.integrator)

    def _judged(self, states: list[State]) -> dict[str, float]:
        """Kinetic energy of some states, and what of it is in modes that the step does not follow [J]."""
        system, kinetic, unresolved = self.system, 0.0, 0.0
        apart = -(-self.problem.frames * self.substeps_per_frame // JUDGED)
        n = system.constrained.size
        gradient, band = np.empty(n), np.empty((n, system.body.half_bandwidth + 1))
        for state in states:
            stop = round(state.time / self.problem.between_frames * self.substeps_per_frame)
            if not self.step or stop % apart:
                continue
            body_at(system, state).assemble(state.q, gradient, band)
            kinetic += kinetic_energy(system, state)
            unresolved += unresolved_energy(band, system.mass, system.constrained, state.v, self.step)
        return {"judged_kinetic_J": kinetic, "unresolved_kinetic_J": unresolved}

    def warnings(self, whole: Solution) -> tuple[str, ...]:
        """What a whole motion does not resolve."""
        return (
            *self._unbalanced(whole),
            *self._unresolved(whole.statistics),
            *self._too_fast(whole),
            *self._driven_too_fast(),
            *coarse(whole["d"]),
            *self._damped_beyond(),
        )

    def _unbalanced(self, whole: Solution) -> Iterator[str]:
        energy = whole["kinetic_energy"] + whole["strain_energy"]
        given = whole["support_work"] - whole["dissipated_energy"] - whole["load_potential"]
        missing = np.abs(energy - given - (energy - given)[0])
        size = max(float(np.abs(energy).max()), float(np.abs(given - given[0]).max()))
        if missing.max() > UNBALANCED * size:
            worst = int(missing.argmax())
            yield (
                f"energy balance: at {whole['time'][worst]:.4g} s, {100 * missing[worst] / size:.2g} % of the energy "
                "is not accounted for; take a shorter 'integrator.step'"
            )

    def _unresolved(self, statistics: Mapping[str, float]) -> Iterator[str]:
        kinetic, share = statistics["judged_kinetic_J"], statistics["unresolved_kinetic_J"]
        if share > UNRESOLVED * kinetic:
            yield (
                f"unresolved modes: {100 * share / kinetic:.2g} % of the kinetic energy is in modes too fast for the "
                f"step of {self.step:.3g} s (omega h > 1), which keep their energy but not their phase; take a shorter "
                "'integrator.step' if they matter, or a start that does not set them off"
            )

    def _too_fast(self, whole: Solution) -> Iterator[str]:
        d, rate = whole["d"], whole["d_rate"]
        turning = (d[..., 0] * rate[..., 1] - d[..., 1] * rate[..., 0]) / (d**2).sum(axis=-1)
        fastest = float(np.abs(turning).max()) * self.step
        if fastest > FAST:
            yield (
                f"fast turning: a section turns by up to {fastest:.2g} rad in a step of {self.step:.3g} s; "
                "take a shorter 'integrator.step'"
            )

    def _driven_too_fast(self) -> Iterator[str]:
        moves, turns = self.problem.prescribed_displacements, self.problem.prescribed_rotations
        frequency = max([0.0, *(move.frequency for move in moves), *(turn.frequency for turn in turns)])
        if 2 * np.pi * frequency * self.step > FAST:
            yield (
                f"fast drive: a support moves to and fro at {frequency:.4g} Hz, which steps of {self.step:.3g} s do "
                "not follow (omega h > 1); take a shorter 'integrator.step'"
            )

    def _damped_beyond(self) -> Iterator[str]:
        c, h = self.system.damping_rate, self.step
        if self.problem.integrator.method != "implicit" or not c:
            return
        highest = highest_frequency(self.system, reference(self.geometry))
        if c * highest * h**2 > DAMPED:
            yield (
                f"damping: modes faster than {DAMPED / (c * h**2):.3g} rad/s (the fastest has {highest:.3g}) lose "
                f"energy at another rate than the drag of {c:.3g} 1/s says; take a shorter 'integrator.step'"
            )


def resumed(part: Solution) -> State:
    """The state in which a stored part ended."""
    return State(
        np.hstack([part["x"][-1], part["d"][-1]]).ravel(),
        np.hstack([part["x_rate"][-1], part["d_rate"][-1]]).ravel(),
        float(part["time"][-1]),
        float(part["first_angle"][-1]),
        float(part["dissipated_energy"][-1]),
        float(part["support_work"][-1]),
    )


def joined(parts: list[Solution], substeps_per_frame: int) -> Solution:
    """One solution: fields along the time are joined, every `legs`-th instant a frame; statistics are summed."""
    first = parts[0]
    fields = {
        name: (
            dims,
            np.concatenate([part[name] for part in parts])[::substeps_per_frame]
            if "time" in dims
            else values,
        )
        for name, (dims, values) in first.fields.items()
    }
    statistics = {key: sum(part.statistics[key] for part in parts) for key in first.statistics}
    return Solution(fields, statistics, first.labels)


def _work_of_a_frame(problem: RodMotion, system: System, geometry: Geometry) -> float:
    """Vertices times implicit steps that cost as much as going from one frame to the next."""
    settings = problem.integrator
    if settings.method == "rk45":
        stable = stable_step(system, reference(geometry))
        settings = settings.replace(step=min(settings.step, stable))
    alone, each = _COST[settings.method]
    return step_count(problem.between_frames, settings) * (alone + each * problem.rod.vertices)


def _fields(geometry: Geometry, system: System, rod: RodBody, states: list[State]) -> dict[str, Field]:
    q = np.array([state.q for state in states]).reshape(len(states), -1, len(DOFS))
    v = np.array([state.v for state in states]).reshape(q.shape)
    start = reference(geometry)
    strain = np.array([rod.energy(state.q) for state in states])
    loaded = [body_at(system, s).energy(s.q) - system.load @ (s.q - start) for s in states]
    momenta = np.array([rigid_fields(s.q) @ band_product(system.mass, s.v) for s in states])
    moving, vector = ("time", "vertex", "axis"), ("vertex", "axis")
    at_times = {
        "time": np.array([state.time for state in states]),
        "first_angle": np.array([state.angle for state in states]),
        "kinetic_energy": np.array([kinetic_energy(system, state) for state in states]),
        "strain_energy": strain,
        "load_potential": np.array(loaded) - strain,
        "dissipated_energy": np.array([state.dissipated for state in states]),
        "support_work": np.array([state.driven for state in states]),
        "angular_momentum": momenta[:, 2],
    }
    fields: dict[str, Field] = {name: (("time",), values) for name, values in at_times.items()}
    return fields | {
        "xi": (("vertex",), geometry.arc_length),
        "x_ref": (vector, geometry.X),
        "d_ref": (vector, geometry.D),
        "x": (moving, q[..., :2]),
        "d": (moving, q[..., 2:]),
        "x_rate": (moving, v[..., :2]),
        "d_rate": (moving, v[..., 2:]),
        "momentum": (("time", "axis"), momenta[:, :2]),
    }
