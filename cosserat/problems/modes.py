"""Natural modes of a rod: small motions about its equilibrium, with their frequencies, shapes and effective masses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray

from cosserat.parameters import Count
from cosserat.problem import ALONE, Run
from cosserat.problems.special import leading
from cosserat.problems.static import check_supports
from cosserat.rods.problem import LOADS, RodProblem
from cosserat.rods.reference import Geometry
from cosserat.rods.resolution import check_crossing, coarse
from cosserat.solution import Field, Solution
from cosserat.solvers.banded import Vector, band_product
from cosserat.solvers.equilibrium import EquilibriumSolver, NewtonSettings
from cosserat.solvers.incremental import solve_full_load
from cosserat.solvers.modes import SmallMotions, small_motions
from cosserat.solvers.system import History, MechanicalSystem

Array = NDArray[np.float64]
_MOVED = ("prescribed_displacements", "prescribed_rotations")  # keys of constraints that move supports
_GROWS = 1e-7  # growth per radian of oscillation below which it is round-off


@dataclass(frozen=True)
class _Rest:
    """What a rod moves about: DOFs q, internal variables, positions and directors (n,), fields and warnings."""

    system: MechanicalSystem
    q: Vector
    history: History
    placed: Vector
    fields: Mapping[str, Field]
    warnings: tuple[str, ...]


class RodModes(RodProblem):
    """Natural modes of a rod: small undamped motions about its equilibrium.

    Shapes have a modal mass of one, v . M v = 1, and their largest displacement is positive.  The effective mass of a
    mode is (v . M r)^2, r a unit translation of the whole rod; that of rotation has r about the first vertex.  Over all
    modes they sum to the total mass less what rests on the supports.  Without supports and loads the first modes are
    the rigid motions, of zero frequency.  An unstable equilibrium has modes that grow, which a warning names.
    """

    kind: Literal["modes"] = "modes"
    newton: NewtonSettings = NewtonSettings()
    count: Annotated[int, Count(at_least=1, at_most=100_000)] = 6
    """Number of modes, from the lowest."""
    about: Literal["equilibrium", "reference"] = "equilibrium"
    """Whether the rod moves about its equilibrium under all loads, or without any load about its reference."""
    branch: Literal["leave", "stay"] = "leave"
    """At a bifurcation of the growing load, whether to leave to a stable equilibrium or to stay on the path."""

    @classmethod
    def of(cls, problem: RodProblem, count: int) -> Self:
        """The modes of the rod of another problem: about its equilibrium, or about the reference if it is a motion."""
        left = {*LOADS, *_MOVED} if problem.in_time else set()
        given = {name: getattr(problem, name) for name in RodProblem.model_fields if name not in left}
        newton = getattr(problem, "newton", NewtonSettings())
        return cls(
            **given, newton=newton, count=count, about="reference" if problem.in_time else "equilibrium"
        )

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """The lowest modes; `name` : name of the case in errors.

        Raises
        ------
        UnsupportedRodError : a loaded rod is free to move.
        NotConvergedError : the loads lead to no equilibrium.
        CrossingError : neighbouring sections of the equilibrium cross.
        """
        geometry = self.geometry
        rest = self._rest(geometry, name)
        check_crossing(geometry, rest.fields["x"][1], rest.fields["d"][1], self.rod.below, name)
        found = small_motions(
            rest.system, rest.q, self.count, supported=self._held(geometry), history=rest.history
        )
        fields = {**rest.fields, **self._shapes(found), **self._masses(rest, found)}
        speed = np.hypot(found.growth, found.angular_frequency)
        statistics = {
            "mode_count": found.growth.size,
            "rigid_modes": int((speed == 0).sum()),
            "growing_modes": int((found.growth > _GROWS * speed).sum()),
            "lowest_Hz": float(found.angular_frequency[0] / (2 * np.pi)),
            "highest_Hz": float(found.angular_frequency[-1] / (2 * np.pi)),
        }
        labels = {"axis": self.rod.kinematics.axes, "dof": self.rod.kinematics.dofs}
        return Solution(fields, statistics, labels, (*rest.warnings, *_growing(found)))

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

    def _held(self, geometry: Geometry) -> bool:
        """Whether no rigid motion is free."""
        at_rest = self.rod.strain_energy.reference(geometry)
        return not self.rod.kinematics.free_motions(at_rest, self.constrained()).any()

    def _rest(self, geometry: Geometry, name: str) -> _Rest:
        """What the rod moves about."""
        system = self.system(geometry)
        loaded = any(self.loads_of(key) for key in LOADS) or system.constraints.moving
        warnings: tuple[str, ...] = ()
        if self.about == "reference" or not (loaded or self._held(geometry)):
            system = system.unloaded()
            q, history = system.space.reference, system.history
            reaction, factor = np.zeros_like(q), 0.0
        else:
            check_supports(self.rod, geometry, system.constrained, name)
            solver = EquilibriumSolver(system, self.newton, name)
            point = solve_full_load(solver, stay=self.branch == "stay")
            q, history, reaction, factor = point.q, point.history, point.reaction, point.factor
            turned = self.rod.vectors(geometry, q)[:, 1]
            warnings = (*solver.warnings(), *coarse(turned))
        placed = self.rod.strain_energy.reference(geometry) + q
        vectors, shape = self.rod.kinematics.split(placed), (self.rod.vertices, -1)
        vector, force = ("vertex", "axis"), ("vertex", "dof")
        fields: dict[str, Field] = {
            "xi": (("vertex",), geometry.arc_length),
            "x_ref": (vector, geometry.X),
            "d_ref": (vector, geometry.D),
            "x": (vector, vectors[:, 0]),
            "d": (vector, vectors[:, 1]),
            "applied_force": (force, (factor * system.dead_load).reshape(shape)),
            "support_force": (force, reaction.reshape(shape)),
        }
        return _Rest(system, q, history, placed, fields, warnings)

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

    def _masses(self, rest: _Rest, found: SmallMotions) -> dict[str, Field]:
        """Total and effective masses and moments of inertia; loads without a potential leave no modes for them."""
        kinematics = self.rod.kinematics
        first = np.zeros_like(kinematics.split(rest.placed))
        first[:, 0] = kinematics.split(rest.placed)[0, 0]
        rigid = kinematics.rigid_motions(rest.placed - first.ravel())
        momenta = np.array([band_product(rest.system.inertia, motion) for motion in rigid])
        total = np.einsum("ij,ij->i", rigid, momenta)
        fields: dict[str, Field] = {
            "total_mass": (("axis",), total[: kinematics.dimension]),
            "total_inertia": ((), total[kinematics.dimension]),
        }
        if rest.system.symmetric:
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
