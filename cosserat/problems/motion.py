"""Motion of the discrete planar rod, eqs. (3.3.43)-(3.3.50), from a given start, with frames at equal times."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.exact import beams
from cosserat.parameters import Parameters, Quantity
from cosserat.problem import ALONE, Run
from cosserat.problems.checkpoints import CheckpointedRun, joined, state_of
from cosserat.problems.outputs import of_instants, outputs
from cosserat.problems.posed import PosedProblem
from cosserat.rods.holding import free_motions
from cosserat.rods.naming import Direction, unit_vector
from cosserat.rods.problem import RodProblem
from cosserat.rods.reference import Geometry
from cosserat.solution import Solution
from cosserat.solvers.integrate import IntegratorSettings, State
from cosserat.solvers.modes import Modes, first_elastic_frequency, modes
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]


class Start(Parameters):
    """Start of a motion: a shape, and velocities of the whole rod."""

    shape: Literal["reference", "first beam mode"] = "reference"
    """"first beam mode" bends the rod by eq. (3.5.16) and rotates the directors with it."""
    amplitude: Annotated[float, Quantity("m")] = 0.0
    """Displacement of the tip in the first beam mode, twice A_1 of eq. (3.5.16)."""
    speed: Annotated[float, Quantity("m/s")] = 0.0
    """Speed of the whole rod."""
    along: Direction = "E3"
    """Direction of that speed."""
    spin: Annotated[float, Quantity("rad/s")] = 0.0
    """Rate of rotation about the first vertex, from E3 towards E2."""


class RodMotion(PosedProblem):
    """Motion of a rod from a start, perhaps damped, under dead loads."""

    kind: Literal["rod motion"] = "rod motion"
    in_time: ClassVar[bool] = True
    always: ClassVar[tuple[str, ...]] = ("couples",)
    thinned: ClassVar[Mapping[str, int]] = {"time": 40}
    start: Start = Start()
    duration: Annotated[float, Quantity("s", above=0)]
    """Time from the start to the end."""
    every: Annotated[float, Quantity("s", above=0)]
    """Time between two frames."""
    damping: Annotated[float, Quantity("1", r"\zeta", "section 3.5", at_least=0)] = 0.0
    """Mass-proportional damping, as a fraction of the critical damping of the lowest mode that deforms the rod.

    ASSUME a force -2 zeta omega_1 M v: the page names none.
    """
    integrator: IntegratorSettings

    @model_validator(mode="after")
    def _starts_as_it_can(self) -> Self:
        if self.start.shape != "reference" and self.pose is not None:
            raise PydanticCustomError(
                "start",
                f"has 'pose' and start.shape = '{self.start.shape}'; leave one of them out",
            )
        if self.start.shape != "reference" and not self.rod.rest.straight:
            raise PydanticCustomError(
                "start",
                f"has start.shape = '{self.start.shape}', which is that of a straight rod, but 'rod.rest' is not "
                "straight along E3; begin from the 'reference' or take a straight rod",
            )
        return self

    @property
    def frames(self) -> int:
        """Number of frames after the first."""
        return max(1, round(self.duration / self.every))

    @property
    def between_frames(self) -> float:
        """Time from one frame to the next [s]."""
        return self.duration / self.frames

    def system(self, geometry: Geometry, *, displacements: bool = False) -> MechanicalSystem:
        """The rod with its loads, constraints, mass and damping."""
        system = super().system(geometry, displacements=displacements)
        if not self.damping:
            return system
        body = self._unloaded(displacements=displacements)
        held = not free_motions(body).any()
        lowest = first_elastic_frequency(body, body.space.reference, supported=held)
        return replace(system, damping_rate=2 * self.damping * lowest)

    def modes(self, count: int, name: str = "the rod") -> Modes:
        """The lowest natural frequencies and shapes of the unloaded rod about its reference configuration.

        Raises
        ------
        UnstableError : small motions about it grow.
        """
        body = self._unloaded(displacements=False)
        held = not free_motions(body).any()
        found = modes(body, body.space.reference, count, name, supported=held)
        return replace(found, shape=body.frame.out(found.shape))

    def _unloaded(self, *, displacements: bool) -> MechanicalSystem:
        """The supported rod at rest, without pose, loads and damping."""
        rest = self.model_copy(update={"pose": None})
        return RodProblem.system(rest, rest.geometry, displacements=displacements).unloaded()

    def begin(self) -> State:
        """The state at time zero, in the DOFs of the system."""
        geometry = self.geometry
        X, D, xi = geometry.X.copy(), geometry.D.copy(), geometry.arc_length
        if self.start.shape == "first beam mode":
            shape, slope = beams.first_beam_mode(self.rod.length, xi)
            turn = np.arctan(self.start.amplitude * slope)
            X[:, 1] += self.start.amplitude * shape
            D = geometry.director_length[:, None] * np.column_stack([-np.sin(turn), np.cos(turn)])
            D = self.rod.strain_energy.start_directors(self.rod, geometry, X, D)
        system, kinematics = super().system(geometry, displacements=False), self.rod.kinematics
        start = kinematics.split(system.unframed.space.reference.copy())
        start[:, 0], start[:, 1] = X, D
        frame = system.frame
        q = np.where(system.constrained, system.space.reference, frame.into(start.ravel()))
        placed, pivot, v = frame.out(q), np.zeros_like(start), np.zeros_like(start)
        pivot[:, 0] = placed[: kinematics.dimension]
        v[:, 0] = self.start.speed * unit_vector(self.start.along)
        rotation = kinematics.rigid_motions(placed - pivot.ravel())[kinematics.dimension]
        moving = frame.into(v.ravel() + self.start.spin * rotation)
        rate = np.where(system.constrained, 0.0, moving)
        place, given, _ = system.constraints.at_time(0.0)
        return State(q + place, rate + given, system.committed(q + place, system.history))

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """The motion at its frames; with a store of parts it resumes where an earlier run was interrupted.

        Raises
        ------
        InputError : the integrator's fixed step is beyond its stability limit, or stored parts are of another run.
        NotConvergedError, DivergedError, CrossingError : a step has no solution; the parts before it are stored.
        """
        checkpointed, state = CheckpointedRun.of(self, name), self.begin()
        done: list[Solution] = []
        for number in range(checkpointed.parts):
            part = run.checkpoints.load(number) if run.checkpoints else None
            if part is not None:
                state = state_of(part, checkpointed.system)
            else:
                part, state, stopped = checkpointed.part(number, state)
                if run.checkpoints and part.fields:
                    run.checkpoints.save(number, part, whole=stopped is None)
                if stopped:
                    raise stopped
                state = state_of(part, checkpointed.system)  # as after an interruption, to the last bit
            done.append(part)
            reached = part["time"][-1]
            run.progress((number + 1) / checkpointed.parts, f"{reached:.4g} of {self.duration:g} s")
        whole = joined(done, checkpointed.substeps_per_frame)

        def derive() -> Solution:
            system, count = checkpointed.system, whole["time"].size
            instants = [state_of(whole, system, number) for number in range(count)]
            states = of_instants(self, checkpointed.geometry, system, instants, whole["first_angle"])
            found, potential = outputs(states), whole["load_potential"]
            work = whole["load_work"] + potential[0] - potential
            return replace(found, fields={**found.fields, "total_load_work": (("time",), work)})

        return replace(whole, warnings=checkpointed.warnings(whole), derive=derive)

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """Frames and steps."""
        return f"{sizes['time'] - 1} frames in {statistics['steps']} steps"
