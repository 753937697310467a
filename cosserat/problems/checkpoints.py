"""A motion split into checkpoints of one or two seconds, so that an interrupted run can resume."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import CosseratError, CrossingError, DivergedError, NotConvergedError
from cosserat.problem import Forecast
from cosserat.problems.damping import Vibrations, stated
from cosserat.rods.kinematics import lengths
from cosserat.rods.loads.couples import TERMS
from cosserat.rods.reference import Geometry
from cosserat.rods.resolution import (
    FAST,
    UNBALANCED,
    UNRESOLVED,
    check_crossing,
    coarse,
    unresolved_energy,
)
from cosserat.rods.rod import Rod
from cosserat.solution import Field, Solution
from cosserat.solvers.banded import band_product
from cosserat.solvers.damping import DAMPED, followed_fraction
from cosserat.solvers.integrate import (
    IntegratorSettings,
    State,
    check_stable_step,
    highest_frequency,
    integrate,
    kinetic_energy,
    stable_step,
    step_count,
)
from cosserat.solvers.system import MechanicalSystem
from cosserat.solvers.tangent import Tangent

if TYPE_CHECKING:
    from cosserat.problems.motion import RodMotion

Array = NDArray[np.float64]

FRAMES_PER_PART = 50
"""Most frames in one stored part of a run."""
ROTATION = "largest_step_rotation_rad"
"""Statistic: largest rotation of a section in one step; of a method that chooses its steps, zero."""
JUDGED = 100
"""Most states of a motion that are checked for unresolved modes."""
UNFOLLOWED = 0.05
"""Largest fraction of a stated stiffness-proportional damping that steps may miss without a warning."""
TURNED = 0.3
"""Largest rotation at which damping of modes about the reference has no warning [rad]; its cosine is 0.955."""
WORK_PER_PART = 5e5
"""Work limit of one part, in vertex-steps: about 1 s at 2 us each (`cosserat speed`)."""

_COST = {"implicit": (0.0, 1.0), "rk4": (30.0, 0.5), "rk45": (300.0, 2.0)}
"""(a, b): a step costs as much as an implicit one of a + b N vertices; for "rk45", the longest stable step."""
_SECONDS = 2e-6
"""Time of one vertex-step of the implicit method (`cosserat speed`)."""
_STORED = 20
"""About so many numbers of each vertex, and of the whole rod, are stored of an instant."""


@dataclass(frozen=True)
class CheckpointedRun:
    """A motion with stops at equal times; every `substeps_per_frame`-th stop is a frame.

    geometry, system : of the problem, made once.  stops_per_part : stops from one stored part to the next.
    """

    problem: RodMotion
    name: str
    geometry: Geometry
    system: MechanicalSystem
    substeps_per_frame: int
    stops_per_part: int

    @classmethod
    def of(cls, problem: RodMotion, name: str) -> CheckpointedRun:
        """Plan the parts of a motion; `name` : name of the case in errors.

        Raises
        ------
        InputError : the integrator's fixed step is beyond its stability limit at the start.
        """
        geometry = problem.geometry
        system = problem.system(geometry)
        work = _work_of_a_frame(problem, system)
        substeps_per_frame = max(1, math.ceil(work / WORK_PER_PART))
        stops = 1 if substeps_per_frame > 1 else max(1, min(FRAMES_PER_PART, int(WORK_PER_PART / work)))
        substep = problem.between_frames / substeps_per_frame
        check_stable_step(system, problem.begin().q, substep, problem.integrator, name)
        return cls(problem, name, geometry, system, substeps_per_frame, stops)

    @property
    def parts(self) -> int:
        """Number of stored parts."""
        return -(-self.problem.frames * self.substeps_per_frame // self.stops_per_part)

    def part(self, number: int, state: State) -> tuple[Solution, State, CosseratError | None]:
        """States at the stops of one part, from the end of the part before; the first part includes the start.

        If the integrator fails, the states before that are returned with its error.
        """
        first = number * self.stops_per_part
        last = min(first + self.stops_per_part, self.problem.frames * self.substeps_per_frame)
        states, steps, fastest, stopped = ([state] if number == 0 else []), 0, 0.0, None
        substep = self.problem.between_frames / self.substeps_per_frame
        for stop in range(first + 1, last + 1):
            try:
                state, done = integrate(self.system, state, substep, self.problem.integrator, self.name)
                vectors = self.problem.rod.kinematics.split(self.system.frame.out(state.q))
                check_crossing(
                    self.geometry,
                    vectors[:, 0],
                    vectors[:, 1],
                    self.problem.rod.below,
                    f"{self.name}, {state.time:.4g} s",
                )
            except (NotConvergedError, DivergedError, CrossingError) as error:
                stopped = error
                break
            fastest = max(fastest, 2 * math.asin(min(1.0, state.largest_change / 2)))
            # the stored time: a resumed run must not differ by round-off
            state = replace(state, time=stop / self.substeps_per_frame * self.problem.between_frames)
            states.append(state)
            steps += done
        fields = _fields(self.problem.rod, self.geometry, self.system, states) if states else {}
        statistics = {"steps": steps, **self._judged(states), ROTATION: fastest}
        return Solution(fields, statistics, {"axis": self.problem.rod.kinematics.axes}), state, stopped

    @property
    def step(self) -> float:
        """The time step of a method with equal steps; zero for an adaptive one [s]."""
        if self.problem.integrator.method == "rk45":
            return 0.0
        substep = self.problem.between_frames / self.substeps_per_frame
        return substep / step_count(substep, self.problem.integrator)

    def _judged(self, states: list[State]) -> dict[str, float]:
        """Kinetic energy of some states, and its part in unresolved modes [J]."""
        system, kinetic, unresolved = self.system, 0.0, 0.0
        interval = -(-self.problem.frames * self.substeps_per_frame // JUDGED)
        tangent = Tangent(system)
        for state in states:
            stop = round(state.time / self.problem.between_frames * self.substeps_per_frame)
            if not self.step or stop % interval:
                continue
            system.assemble(state.q, state.history, 1.0, tangent)
            kinetic += kinetic_energy(system, state)
            unresolved += unresolved_energy(
                tangent.band, system.inertia, system.constrained, state.v, self.step
            )
        return {"judged_kinetic_J": kinetic, "unresolved_kinetic_J": unresolved}

    def warnings(self, whole: Solution) -> tuple[str, ...]:
        """Warnings about the resolution of a whole motion."""
        return (
            *self._unbalanced(whole),
            *self._unresolved(whole.statistics),
            *self._too_fast(whole.statistics),
            *self._driven_too_fast(),
            *coarse(whole["d"]),
            *self._damped_beyond(),
            *self._strained_beyond(),
            *self._turned_beyond(whole),
        )

    def _unbalanced(self, whole: Solution) -> Iterator[str]:
        energy = whole["kinetic_energy"] + whole["strain_energy"]
        given = whole["support_work"] + whole["load_work"] - whole["dissipated_energy"]
        given = given - whole["load_potential"] - whole["attached_energy"]
        missing = np.abs(energy - given - (energy - given)[0])
        size = max(float(np.abs(energy).max()), float(np.abs(given - given[0]).max()))
        if missing.max() > UNBALANCED * size:
            worst = int(missing.argmax())
            yield (
                f"energy balance: at {whole['time'][worst]:.4g} s, {100 * missing[worst] / size:.2g} % of the energy "
                "is not accounted for; take a shorter 'integrator.step'"
            )

    def _unresolved(self, statistics: Mapping[str, float]) -> Iterator[str]:
        kinetic, unresolved = statistics["judged_kinetic_J"], statistics["unresolved_kinetic_J"]
        if unresolved > UNRESOLVED * kinetic:
            yield (
                f"unresolved modes: {100 * unresolved / kinetic:.2g} % of the kinetic energy is in modes too fast "
                f"for the step of {self.step:.3g} s (omega h > 1), which keep their energy but not their phase; take a "
                "shorter 'integrator.step' if they matter, or a start that does not set them off"
            )

    def _too_fast(self, statistics: Mapping[str, float]) -> Iterator[str]:
        fastest = statistics[ROTATION]
        if fastest > FAST:
            yield (
                f"fast rotation: a section rotates by up to {fastest:.2g} rad in a step of {self.step:.3g} s; "
                "take a shorter 'integrator.step'"
            )

    def _driven_too_fast(self) -> Iterator[str]:
        for key in dict.fromkeys(key for key, _ in self.problem.time_functions):
            fastest = max(
                function.fastest for own, function in self.problem.time_functions if own == key
            )
            if fastest * self.step > FAST:
                yield (
                    f"fast drive: a time function of '{key}' changes at up to {fastest / (2 * np.pi):.4g} Hz, which "
                    f"steps of {self.step:.3g} s do not resolve (omega h > 1); take a shorter 'integrator.step'"
                )

    def _damped_beyond(self) -> Iterator[str]:
        c, h = self.system.damping_rate, self.step
        if self.problem.integrator.method != "implicit" or not c:
            return
        highest = highest_frequency(self.system, self.system.space.reference)
        if c * highest * h**2 > DAMPED:
            yield (
                f"damping: modes faster than {DAMPED / (c * h**2):.3g} rad/s (the fastest has {highest:.3g}) lose "
                f"energy at another rate than the damping rate of {c:.3g} 1/s; take a shorter 'integrator.step'"
            )

    def damping(self) -> dict[str, float]:
        """Statistics: sizes of the damping, frequencies and ratios of the lowest modes; empty without damping."""
        return stated(self.system, self._vibrations) if self._damped else {}

    @property
    def _damped(self) -> bool:
        system = self.system
        return bool(system.damping_rate or system.damping_time or system.damped_modes.rate.size)

    @cached_property
    def _vibrations(self) -> Vibrations:
        return self.problem.vibrations()

    def _strained_beyond(self) -> Iterator[str]:
        """Stiffness-proportional damping whose steps are too long for the modes that it states."""
        time, damping = self.system.damping_time, self.problem.damping
        if not time or damping is None:
            return
        fastest = max(damping.followed(self._vibrations))
        followed = followed_fraction(fastest, time, self.step)
        if abs(followed - 1) > UNFOLLOWED:
            yield (
                f"damping: at {fastest / (2 * np.pi):.4g} Hz, motions in steps of {self.step:.3g} s fade at "
                f"{followed:.3g} of the rate of the stiffness-proportional damping; take a shorter 'integrator.step'"
            )

    def _turned_beyond(self, whole: Solution) -> Iterator[str]:
        """Damping of modes about the reference in a rod that leaves it far."""
        if not self.system.damped_modes.rate.size:
            return
        d, D = whole["d"], whole["d_ref"]
        cosine = (d * D).sum(axis=2) / (lengths(d) * lengths(D))
        turned = float(np.arccos(np.clip(cosine.min(), -1, 1)))
        if turned > TURNED:
            yield (
                f"damping: sections turn by up to {turned:.2g} rad from the reference, about which the damped modes "
                f"are; beyond {TURNED} rad their ratios do not hold, so take a damping of kind 'stiffness' or 'mass'"
            )


def state_of(part: Solution, system: MechanicalSystem, stop: int = -1) -> State:
    """The state at one of the stops of a part, by default its end."""
    history, used = list(system.history), 0
    for number, own in enumerate(history):
        if number == _winding(system):
            history[number] = part["first_angle"][stop : stop + 1 or None]
        elif own.size:
            history[number] = part["internal_variables"][stop, used : used + own.size]
            used += own.size
    others = part["other_dofs"][stop] if "other_dofs" in part else np.empty((part["x"].shape[1], 0))
    rates = part["other_rates"][stop] if "other_dofs" in part else others
    into = system.frame.into
    return State(
        into(np.hstack([part["x"][stop], part["d"][stop], others]).ravel()),
        into(np.hstack([part["x_rate"][stop], part["d_rate"][stop], rates]).ravel()),
        tuple(history),
        float(part["time"][stop]),
        float(part["dissipated_energy"][stop]),
        float(part["support_work"][stop]),
        float(part["load_work"][stop]),
    )


def _winding(system: MechanicalSystem) -> int:
    """Index of the potential whose internal variable is the winding angle of the first director."""
    return next(k for k, potential in enumerate(system.potentials) if potential.terms == TERMS)


def joined(parts: list[Solution], substeps_per_frame: int) -> Solution:
    """One solution of all parts: fields joined along the time, one instant per frame; statistics summed."""
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
    statistics = {
        key: (max if key == ROTATION else sum)(part.statistics[key] for part in parts)
        for key in first.statistics
    }
    return Solution(fields, statistics, first.labels)


def forecast(problem: RodMotion) -> Forecast:
    """Time and space of a motion; of a method that chooses its steps, as if they were as long as it starts with."""
    frames, settings = problem.frames, problem.integrator
    steps = frames * step_count(problem.between_frames, settings)
    numbers = _STORED * (problem.rod.vertices + 1) * (frames + 1)
    return Forecast(
        seconds=_SECONDS * frames * _work(problem, settings),
        size=8.0 * numbers,
        work=f"{steps:.3g} steps of {settings.step:g} s",
        less_work="take a longer 'integrator.step' or a shorter 'duration'",
        stored=f"{frames + 1:.3g} frames of {problem.rod.vertices} vertices",
        less_stored="take a longer 'every'",
    )


def _work_of_a_frame(problem: RodMotion, system: MechanicalSystem) -> float:
    """Cost of one frame, in vertex-steps of the implicit method."""
    settings = problem.integrator
    if settings.method == "rk45":
        stable = stable_step(system, system.space.reference)
        settings = settings.replace(step=min(settings.step, stable))
    return _work(problem, settings)


def _work(problem: RodMotion, settings: IntegratorSettings) -> float:
    alone, each = _COST[settings.method]
    return step_count(problem.between_frames, settings) * (alone + each * problem.rod.vertices)


def _fields(
    rod: Rod, geometry: Geometry, system: MechanicalSystem, states: list[State]
) -> dict[str, Field]:
    out = system.frame.out
    states = [replace(state, q=out(state.q), v=out(state.v)) for state in states]
    system = system.unframed
    vectors = rod.kinematics.split(np.array([state.q for state in states]))
    rates = rod.kinematics.split(np.array([state.v for state in states]))
    loads = [
        system.nonlinear_load_energy(s.q, s.history) - system.dead_load @ (s.q - system.space.reference)
        for s in states
    ]
    momenta = np.array(
        [system.space.rigid_motions(s.q) @ band_product(system.inertia, s.v) for s in states]
    )
    moving, vector, winding = ("time", "vertex", "axis"), ("vertex", "axis"), _winding(system)
    at_times = {
        "time": np.array([state.time for state in states]),
        "first_angle": np.array([state.history[winding][0] for state in states]),
        "kinetic_energy": np.array([kinetic_energy(system, state) for state in states]),
        "strain_energy": np.array([system.internal.energy(state.q) for state in states]),
        "load_potential": np.array(loads),
        "dissipated_energy": np.array([state.dissipated for state in states]),
        "support_work": np.array([state.driven for state in states]),
        "load_work": np.array([state.load_work for state in states]),
        "attached_energy": np.array([system.attached_energy(s.q, s.history) for s in states]),
        "angular_momentum": momenta[:, 2],
    }
    fields: dict[str, Field] = {name: (("time",), values) for name, values in at_times.items()}
    internal = np.array(
        [np.concatenate([*s.history[:winding], *s.history[winding + 1 :]]) for s in states]
    )
    if internal.size:
        fields["internal_variables"] = (("time", "internal"), internal)
    if vectors.shape[2] > 2:
        others = ("time", "vertex", "other_dof")
        fields["other_dofs"] = (others, vectors[:, :, 2:].reshape(*vectors.shape[:2], -1))
        fields["other_rates"] = (others, rates[:, :, 2:].reshape(*vectors.shape[:2], -1))
    return fields | {
        "xi": (("vertex",), geometry.arc_length),
        "x_ref": (vector, geometry.X),
        "d_ref": (vector, geometry.D),
        "x": (moving, vectors[:, :, 0]),
        "d": (moving, vectors[:, :, 1]),
        "x_rate": (moving, rates[:, :, 0]),
        "d_rate": (moving, rates[:, :, 1]),
        "momentum": (("time", "axis"), momenta[:, :2]),
    }
