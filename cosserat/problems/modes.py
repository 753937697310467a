"""Natural modes of a rod: small motions about its equilibrium, with their frequencies, shapes and effective masses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Count
from cosserat.problem import ALONE, Forecast, Run
from cosserat.problems.forecasts import of_modes
from cosserat.problems.grown import GrownProblem
from cosserat.problems.special import leading
from cosserat.problems.static import check_supports, equilibrium_solution
from cosserat.rods.holding import free_motions
from cosserat.rods.problem import LOADS, RodProblem
from cosserat.rods.reference import Geometry
from cosserat.rods.resolution import check_crossing, coarse
from cosserat.solution import Field, Solution
from cosserat.solvers.banded import Vector, band_product
from cosserat.solvers.equilibrium import Equilibrium, EquilibriumSolver
from cosserat.solvers.incremental import solve_full_load, without_load
from cosserat.solvers.modes import SmallMotions, small_motions
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]
_MOVED = ("prescribed_displacements", "prescribed_rotations")  # keys of constraints that move supports
_GROWS = 1e-7  # growth per radian of oscillation below which it is round-off


class RodModes(GrownProblem):
    """Natural modes of a rod: small undamped motions about its equilibrium.

    Shapes have a modal mass of one, v . M v = 1, and their largest displacement is positive.  The effective mass of a
    mode is (v . M r)^2, r a unit translation of the whole rod; that of rotation has r about the first vertex.  Over all
    modes they sum to the total mass less what rests on the supports.  Without supports and loads the first modes are
    the rigid motions, of zero frequency.  An unstable equilibrium has modes that grow, which a warning names.
    """

    kind: Literal["modes"] = "modes"
    count: Annotated[int, Count(at_least=1, at_most=100_000)] = 6
    """Number of modes, from the lowest."""
    about: Literal["equilibrium", "reference"] = "equilibrium"
    """Whether the rod moves about its equilibrium under all loads, or without any load about its reference."""
    branch: Literal["leave", "stay"] = "leave"
    """At a bifurcation of the growing load, whether to leave to a stable equilibrium or to stay on the path."""

    @model_validator(mode="after")
    def _is_about_an_equilibrium(self) -> Self:
        if self.pose is not None and self.about == "reference":
            raise PydanticCustomError(
                "pose",
                "has 'pose' and about = 'reference', but a rod that is bent into a pose is not at rest there; "
                "leave one of them out",
            )
        if self.start_from is not None and self.about == "reference":
            raise PydanticCustomError(
                "start",
                "has 'start_from' and about = 'reference', but the loads of 'start_from' stay; leave one of them out",
            )
        return self

    @classmethod
    def of(cls, problem: RodProblem, count: int) -> Self:
        """The modes of the rod of another problem: about its equilibrium; of a motion, without its loads."""
        left = {*LOADS, *_MOVED} if problem.in_time else set()
        if problem.in_time:  # a motion has its own start
            left.add("start_from")
        own = {*GrownProblem.model_fields} - left
        given = {name: getattr(problem, name) for name in own if hasattr(problem, name)}
        about = "reference" if problem.in_time and given.get("pose") is None else "equilibrium"
        return cls(**given, count=count, about=about)

    @property
    def forecast(self) -> Forecast:
        """The modes; the equilibrium takes little beside them."""
        return of_modes(self, self.count)

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """The lowest modes; `name` : name of the case in errors.

        Raises
        ------
        UnsupportedRodError : a loaded rod is free to move.
        NotConvergedError : the loads lead to no equilibrium.
        CrossingError : neighbouring sections of the equilibrium cross.
        """
        geometry = self.geometry
        point, solver, said = self.settled_rod(geometry, name)
        rest = equilibrium_solution(self, geometry, point, solver)
        check_crossing(geometry, rest["x"], rest["d"], self.rod.below, name)
        system, held = solver.system, not free_motions(solver.system).any()
        found = small_motions(system, point.q, self.count, supported=held, history=point.history)
        fields = {**rest.fields, **self.mode_fields(geometry, system, point.q, found)}
        speed = np.hypot(found.growth, found.angular_frequency)
        statistics = dict(rest.statistics) | {
            "mode_count": found.growth.size,
            "rigid_modes": int((speed == 0).sum()),
            "growing_modes": int((found.growth > _GROWS * speed).sum()),
            "lowest_Hz": float(found.angular_frequency[0] / (2 * np.pi)),
            "highest_Hz": float(found.angular_frequency[-1] / (2 * np.pi)),
        }
        warnings = (*said, *solver.warnings(), *coarse(rest["d"]), *_growing(found), *self._fewer(found))
        return replace(rest, fields=fields, statistics=statistics, warnings=warnings)

    def mode_fields(
        self, geometry: Geometry, system: MechanicalSystem, q: Vector, found: SmallMotions
    ) -> dict[str, Field]:
        """Frequencies, shapes and masses of small motions about the DOFs q (n,), in the frames of the system."""
        plain = replace(found, shape=system.frame.out(found.shape))
        placed = self.rod.strain_energy.reference(geometry) + system.frame.out(q)
        return {**self._shapes(plain), **self._masses(system.unframed, placed, plain)}

    def _fewer(self, found: SmallMotions) -> list[str]:
        number = found.growth.size
        return [
            f"fewer modes: a rod of {self.rod.vertices} vertices on these supports has {number}, and 'count' asks for "
            f"{self.count}; raise 'rod.vertices'"
        ] * (number < self.count)

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """The number of modes and the range of their frequencies."""
        rigid, growing = statistics["rigid_modes"], statistics["growing_modes"]
        said = [f"{rigid} of them rigid"] * (rigid > 0) + [f"{growing} of them growing"] * (growing > 0)
        return ", ".join(
            [
                f"{statistics['mode_count']} modes",
                *said,
                f"from {statistics['lowest_Hz']:.6g} to {statistics['highest_Hz']:.6g} Hz",
            ]
        )

    def settled_rod(
        self, geometry: Geometry, name: str
    ) -> tuple[Equilibrium, EquilibriumSolver, tuple[str, ...]]:
        """What the rod moves about, in displacements, with its solver, and warnings of where its loads begin."""
        stay = self.branch == "stay"
        if self.start_from is not None:
            grown, said = self.grown(geometry, name)
            solver = EquilibriumSolver(grown, self.newton, name)
            return solve_full_load(solver, stay=stay), solver, said
        system = self.system(geometry)
        loaded = any(self.loads_of(key) for key in LOADS) or system.constraints.moving
        bent = loaded or self.pose is not None
        if self.about == "equilibrium" and (bent or not free_motions(system).any()):
            check_supports(system, name)
            solver = EquilibriumSolver(system, self.newton, name)
            return (*self.settled(geometry, solver, stay=stay), ())
        bare = system.unloaded()
        return without_load(bare), EquilibriumSolver(bare, self.newton, name), ()

    def _shapes(self, found: SmallMotions) -> dict[str, Field]:
        """Frequencies, rates of growth and shapes; imaginary parts where there are any."""
        kinematics = self.rod.kinematics
        turned = np.array([shape * _phase(leading(kinematics, shape)) for shape in found.shape])
        vectors, along = kinematics.split(turned), ("mode", "vertex", "axis")
        fields: dict[str, Field] = {
            "natural_frequency": (("mode",), found.angular_frequency / (2 * np.pi)),
            "growth_rate": (("mode",), found.growth),
            "mode_u": (along, vectors[:, :, 0].real),
            "mode_delta": (along, vectors[:, :, 1].real),
        }
        if vectors.imag.any():
            fields |= {
                "mode_u_imaginary": (along, vectors[:, :, 0].imag),
                "mode_delta_imaginary": (along, vectors[:, :, 1].imag),
            }
        return fields

    def _masses(self, system: MechanicalSystem, placed: Vector, found: SmallMotions) -> dict[str, Field]:
        """Total and effective masses and moments of inertia; loads without a potential leave no modes for them."""
        kinematics = self.rod.kinematics
        first = np.zeros_like(kinematics.split(placed))
        first[:, 0] = kinematics.split(placed)[0, 0]
        rigid = kinematics.rigid_motions(placed - first.ravel())
        momenta = np.array([band_product(system.inertia, motion) for motion in rigid])
        total = np.einsum("ij,ij->i", rigid, momenta)
        fields: dict[str, Field] = {
            "total_mass": (("axis",), total[: kinematics.dimension]),
            "total_inertia": ((), total[kinematics.dimension]),
        }
        if system.symmetric:
            shared = (found.shape.real @ momenta.T) ** 2
            fields |= {
                "effective_mass": (("mode", "axis"), shared[:, : kinematics.dimension]),
                "effective_inertia": (("mode",), shared[:, kinematics.dimension]),
            }
        return fields


def _phase(value: complex) -> complex:
    """The factor of unit size that makes a number positive."""
    return abs(value) / value


def _growing(found: SmallMotions) -> Iterator[str]:
    """Warnings of divergence and flutter."""
    speed = np.hypot(found.growth, found.angular_frequency)
    grows = found.growth > _GROWS * speed
    for word, chosen in (
        ("divergence", grows & (found.angular_frequency <= _GROWS * speed)),
        ("flutter", grows & (found.angular_frequency > _GROWS * speed)),
    ):
        if chosen.any():
            fastest = np.where(chosen, found.growth, 0.0).argmax()
            hertz = found.angular_frequency[fastest] / (2 * np.pi)
            how = (
                "without oscillating" if word == "divergence" else f"while oscillating at {hertz:.4g} Hz"
            )
            yield (
                f"{word}: the equilibrium is unstable; {chosen.sum()} of the modes listed grow, the fastest by "
                f"{found.growth[fastest]:.4g} 1/s {how}, so a body does not stay there"
            )
