"""Static problems of the discrete planar rod, section 3.5."""

from __future__ import annotations

from typing import Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.errors import NotConvergedError, UnsupportedRodError
from cosserat.models.consistent import ConsistentRod
from cosserat.models.planar_rod import AXES, Geometry, edge_shear, free_motions, strains
from cosserat.models.resolution import coarse, refuse_crossing
from cosserat.models.rod import RodBody
from cosserat.models.rod_problem import RodProblem
from cosserat.outcome import Outcome
from cosserat.solvers.climb import Climb, Point
from cosserat.solvers.modes import Modes, modes
from cosserat.solvers.motion import System
from cosserat.solvers.newton import Equilibrium, NewtonSettings
from cosserat.solvers.path import lead

Array = NDArray[np.float64]
_MOTIONS = ("translation along E3", "translation along E2", "rotation")


class RodStatics(RodProblem):
    """Equilibrium of a rod under its weight and point forces."""

    kind: Literal["rod statics"] = "rod statics"
    newton: NewtonSettings = NewtonSettings()

    @model_validator(mode="after")
    def _nothing_swings(self) -> Self:
        if self.swings:
            raise PydanticCustomError(
                "static",
                "'moves' or 'turns' has a 'frequency', but a static problem has no time; leave it out",
            )
        return self

    def solve(self, name: str) -> Outcome:
        """Find the equilibrium; `name` is what errors call the case.

        Raises
        ------
        UnsupportedRodError : a rigid motion is left free.
        NotConvergedError : no equilibrium within the tolerance.
        CrossingError : neighbouring sections of the equilibrium cross.
        """
        geometry = self.rod.geometry()
        body, load = self.body(geometry), self.loads(geometry)
        state, warnings = self.led_to(geometry, body, load, name)
        fields = _fields(geometry, body, state, load)
        refuse_crossing(geometry, fields["x"], fields["d"], self.rod.below, name)
        return Outcome(fields, _statistics(state), warnings=(*warnings, *coarse(fields["d"])))

    def modes(self, count: int, name: str = "the rod") -> Modes:
        """The lowest natural frequencies and shapes of small motions about the equilibrium.

        Raises
        ------
        UnsupportedRodError, NotConvergedError : there is no equilibrium to move about.
        UnstableError : there is one, but small motions about it grow.
        """
        geometry = self.rod.geometry()
        body, load = self.body(geometry), self.loads(geometry)
        at_rest = self.led_to(geometry, body, load, name)[0].q
        system = System(
            body, self.mass(geometry), load.ravel(), self.held().ravel(), 0.0, np.empty((0, load.size))
        )
        return modes(system, at_rest, count, name, anchored=True)

    def led_to(
        self, geometry: Geometry, body: RodBody, load: Array, name: str
    ) -> tuple[Equilibrium, tuple[str, ...]]:
        """The equilibrium that the loads lead to as they grow together, and what is to be said of the way there."""
        reference = np.hstack([geometry.X, geometry.D])
        refuse_rigid_motion(reference, self.held(), name)
        climb = Climb(self.loaded(geometry), self.newton, name)
        try:
            found = lead(climb, np.zeros(reference.size))
            return _as_equilibrium(climb, found, reference.ravel()), tuple(climb.remarks())
        except NotConvergedError as error:
            if error.state is not None:
                last = climb.at(error.state, error.factor)
                assert last is not None  # it was one
                state = _as_equilibrium(climb, last, reference.ravel())
                error.reached = Outcome(
                    _fields(geometry, body, state, last.factor * load),
                    _statistics(state) | {"load_factor_reached": last.factor},
                )
            raise


def _as_equilibrium(climb: Climb, point: Point, reference: Array) -> Equilibrium:
    return Equilibrium(
        reference + point.q,
        point.energy,
        point.reaction,
        point.iterations,
        shortened=climb.halvings,
        shifted=climb.branchings,
        residual=point.residual,
        tolerance=point.tolerance,
        rounding=point.rounding,
    )


def refuse_rigid_motion(q: Array, held: NDArray[np.bool_], name: str) -> None:
    """Raise UnsupportedRodError if a rigid motion moves no held number; q, held : (N, 4)."""
    left = [motion for motion, share in zip(_MOTIONS, free_motions(q, held), strict=True) if share > 0.1]
    if left:
        raise UnsupportedRodError(
            f"{name}: the supports leave the rod free to move ({', '.join(left)}); "
            "hold more numbers in 'supports', such as at = 'first', hold = ['x3', 'x2', 'd3', 'd2']"
        )


def _fields(geometry: Geometry, body: RodBody, state: Equilibrium, load: Array) -> dict[str, Array]:
    q = state.q.reshape(load.shape)
    x, d = q[:, : len(AXES)], q[:, len(AXES) :]
    measured = strains(geometry, x, d)
    arc = geometry.arc_length
    if isinstance(body, ConsistentRod):
        own = {"shear": edge_shear(x + body.offset * d, d), "energy_parts": body.energy_terms(state.q)}
    else:
        own = {"theta": measured.theta, "energy": body.energy_terms(state.q)}
    return own | {
        "xi": arc,
        "xi_edge": (arc[1:] + arc[:-1]) / 2,
        "x_ref": geometry.X,
        "d_ref": geometry.D,
        "x": x,
        "d": d,
        "u": x - geometry.X,
        "delta": d - geometry.D,
        "mu_edge": measured.mu_edge,
        "mu": measured.mu,
        "lam": measured.lam,
        "phi": measured.phi,
        "kappa": measured.kappa,
        "applied_force": load,
        "support_force": state.reaction.reshape(load.shape),
    }


def _statistics(state: Equilibrium) -> dict[str, int | float]:
    return {
        "iterations": state.iterations,
        "shortened_steps": state.shortened,
        "shifted_hessians": state.shifted,
        "residual_N": state.residual,
        "tolerance_N": state.tolerance,
        "rounding_N": state.rounding,
    }
