"""Motion of the discrete planar rod, eqs. (3.3.43)-(3.3.50), from a given start, with frames at equal times."""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Quantity
from cosserat.problem import ALONE, Forecast, Run
from cosserat.problems.checkpoints import CheckpointedRun, forecast, joined, state_of
from cosserat.problems.damping import AnyDamping, Vibrations
from cosserat.problems.outputs import of_instants, outputs
from cosserat.problems.posed import PosedProblem
from cosserat.problems.starts import Start, begin, warnings
from cosserat.problems.static import RodStatics
from cosserat.rods.holding import free_motions
from cosserat.rods.loads.base import BaseMotion
from cosserat.rods.problem import RodProblem
from cosserat.rods.reference import Geometry
from cosserat.solution import Solution
from cosserat.solvers.integrate import IntegratorSettings, State
from cosserat.solvers.modes import Modes, modes
from cosserat.solvers.system import MechanicalSystem
from cosserat.tables import ShortForm

Array = NDArray[np.float64]


_SHORT = ShortForm(Quantity("1", at_least=0), "ratio", (("kind", "mass"),))


class RodMotion(PosedProblem):
    """Motion of a rod from a start, perhaps damped, under dead loads."""

    kind: Literal["rod motion"] = "rod motion"
    in_time: ClassVar[bool] = True
    always: ClassVar[tuple[str, ...]] = ("couples",)
    thinned: ClassVar[Mapping[str, int]] = {"time": 40}
    start: Start = Start()
    start_from: RodStatics | None = None
    """Static problem whose equilibrium is the start; its loads may be others, or more."""
    duration: Annotated[float, Quantity("s", above=0)]
    """Time from the start to the end."""
    every: Annotated[float, Quantity("s", above=0)]
    """Time between two frames."""
    base_motion: BaseMotion | None = None
    """Acceleration of the base that carries the supports; displacements and velocities are then relative to it."""
    damping: Annotated[AnyDamping | None, _SHORT] = None
    """Damping; a number alone is the ratio of kind "mass"."""
    integrator: IntegratorSettings

    @model_validator(mode="after")
    def _starts_as_it_can(self) -> Self:
        fault = self.start.fault(
            straight=self.rod.rest.straight,
            static=self.start_from is not None,
            posed=self.pose is not None,
        )
        if fault:
            raise PydanticCustomError("start", fault)
        return self

    @model_validator(mode="after")
    def _can_be_damped(self) -> Self:
        method, damping = self.integrator.method, self.damping
        if method != "implicit" and damping is not None and damping.kind != "mass":
            raise PydanticCustomError(
                "damping",
                f"has integrator.method = '{method}', which has no damping of kind '{damping.kind}'; take "
                "'implicit', or a damping of kind 'mass'",
            )
        if self.pose is not None and damping is not None and damping.kind != "mass":
            raise PydanticCustomError(
                "damping",
                f"has a 'pose' and a damping of kind '{damping.kind}', which is about the shape at rest; take one of "
                "kind 'mass'",
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
        if self.damping is None:
            return system
        return self.damping.damped(system, self.vibrations(displacements=displacements))

    def vibrations(self, *, displacements: bool = False) -> Vibrations:
        """Small motions of the unloaded rod about its reference configuration."""
        body = self._unloaded(displacements=displacements)
        return Vibrations(body, not free_motions(body).any())

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

    @property
    def forecast(self) -> Forecast:
        """Steps and frames."""
        return forecast(self)

    def begin(self) -> State:
        """The state at time zero, in the DOFs of the system."""
        return begin(self)

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
        whole = replace(whole, statistics=dict(whole.statistics) | checkpointed.damping())

        def derive(names: Set[str] = frozenset()) -> Solution:
            system, count = checkpointed.system, whole["time"].size
            instants = [state_of(whole, system, number) for number in range(count)]
            states = of_instants(self, checkpointed.geometry, system, instants, whole["first_angle"])
            found, potential = outputs(states, names), whole["load_potential"]
            work = whole["load_work"] + potential[0] - potential
            return replace(found, fields={**found.fields, "total_load_work": (("time",), work)})

        return replace(whole, warnings=(*warnings(self), *checkpointed.warnings(whole)), derive=derive)

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """Frames and steps."""
        return f"{sizes['time'] - 1} frames in {statistics['steps']} steps"
