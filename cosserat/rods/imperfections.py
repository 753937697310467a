"""Imperfections: a bow or a mode times an amplitude, added to the shape of the rod at rest, without stress.

derived: where a displacement U is added to the perfect centreline, an edge E rotates by the angle whose sine is
E x (difference of U) / |E|^2.  Edges keep their lengths, so a bow w along the normal of a curved rod has a displacement
u along its tangent too, with u' = K w.  The stiffnesses are those of the perfect rod.
"""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Annotated, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from cosserat.errors import InputError
from cosserat.parameters import Count, Parameters, Quantity
from cosserat.rods.holding import free_motions
from cosserat.rods.kinematics import rotated
from cosserat.rods.reference import Geometry, normals, signed_angle, vertex_tangents
from cosserat.solvers.critical import linear_criterion
from cosserat.solvers.equilibrium import EquilibriumSolver, NewtonSettings
from cosserat.solvers.modes import modes

if TYPE_CHECKING:
    from cosserat.rods.problem import RodProblem

Array = NDArray[np.float64]
_EQUAL = 1e-6  # relative difference of two displacements below which they are equal
_BOWS = {
    "half sine": lambda t: np.sin(np.pi * t),
    "full cosine": lambda t: (1 - np.cos(2 * np.pi * t)) / 2,
    "quarter cosine": lambda t: 1 - np.cos(np.pi * t / 2),
}
"""Shapes of bows by the fraction of the length; each has the largest value one."""
LoadKey = Literal[
    "gravity",
    "line_loads",
    "forces",
    "couples",
    "line_couples",
    "follower_forces",
    "follower_line_loads",
    "pressures",
    "prestrains",
    "temperatures",
    "prescribed_displacements",
    "prescribed_rotations",
]
"""Keys of what may make a rod buckle."""


class Imperfection(Parameters):
    """A shape, with its amplitude, that the unloaded rod has in addition to its shape at rest."""

    amplitude: Annotated[float, Quantity("m")]
    """Largest displacement along the normal of the perfect centreline; a negative one is to the other side."""

    @abstractmethod
    def shape(self, problem: RodProblem, perfect: Geometry) -> Array:
        """Displacement of the vertices over the amplitude, (N, 2) [1]."""

    def applied(self, problem: RodProblem, perfect: Geometry) -> Geometry:
        """The imperfect reference configuration.

        Raises
        ------
        InputError : it is too steep, or the rod has no such mode.
        """
        added = self.amplitude * self.shape(problem, perfect)
        edges, change = np.diff(perfect.X, axis=0), np.diff(added, axis=0)
        sines = (edges[:, 0] * change[:, 1] - edges[:, 1] * change[:, 0]) / perfect.edge_length**2
        if np.abs(sines).max() >= 1:
            raise InputError(
                f"'imperfection' has 'amplitude' = {self.amplitude:g} m, with which it is steeper than the "
                "normal of the rod; take a smaller one"
            )
        edges = rotated(edges, np.arcsin(sines)[:, None])
        X = perfect.X[0] + added[0] + np.vstack([np.zeros(2), np.cumsum(edges, axis=0)])
        return Geometry(X, perfect.director_length[:, None] * normals(X))


class Bow(Imperfection):
    """A bow between both ends."""

    kind: Literal["bow"] = "bow"
    bow: Literal["half sine", "full cosine", "quarter cosine"] = "half sine"
    """Between two hinges, between two clamps, or from a clamp to a free end."""

    def shape(self, problem: RodProblem, perfect: Geometry) -> Array:
        """Along the normal by the arc length, and along the tangent without stretch."""
        arc, tangents = perfect.arc_length, vertex_tangents(perfect.X)
        along = _BOWS[self.bow](arc / arc[-1])
        stretch = signed_angle(tangents[:-1], tangents[1:]) * (along[1:] + along[:-1]) / 2
        back = np.insert(np.cumsum(stretch), 0, 0.0)
        shape: Array = along[:, None] * normals(perfect.X) + back[:, None] * tangents
        return shape


class Mode(Imperfection):
    """A natural mode of the supported rod without loads."""

    kind: Literal["mode"] = "mode"
    mode: Annotated[int, Count(at_least=1, at_most=100_000)] = 1
    """Number of the mode, from 1 for the lowest that deforms the rod."""

    def shape(self, problem: RodProblem, perfect: Geometry) -> Array:
        """The displacement of the mode; its largest value along the normal is one."""
        body, kinematics = problem.unloaded_rod(perfect), problem.rod.kinematics
        at_rest = problem.rod.strain_energy.reference(perfect)
        free = int((free_motions(body) > 0).sum())
        count = free + self.mode
        if count > (~body.constrained).sum():
            raise InputError(
                f"'imperfection' has 'mode' = {self.mode}, but the rod has fewer; take a lower one"
            )
        found = modes(body, np.zeros_like(at_rest), count, "'imperfection'", supported=not free)
        moved = kinematics.split(body.frame.out(found.shape[-1]))[:, 0]
        return _scaled(moved, perfect, self.mode)


class BucklingMode(Imperfection):
    """A buckling mode of the supported rod by the linear criterion, under its own loads that do not depend on time."""

    kind: Literal["buckling mode"] = "buckling mode"
    mode: Annotated[int, Count(at_least=1)] = 1
    """Number of the mode, from 1 for that of the lowest critical load."""
    loads: tuple[LoadKey, ...] = ()
    """Keys of the loads and moved supports that grow until the rod buckles, such as "forces"; by default all of them.

    Those of a static answer in which the loads begin to grow are not among them."""

    def shape(self, problem: RodProblem, perfect: Geometry) -> Array:
        """The displacement of the mode; its largest value along the normal is one."""
        kinematics, keys = problem.rod.kinematics, self.loads or get_args(LoadKey)
        body = problem.loaded_rod(perfect, keys)
        given = [key for key in keys if getattr(problem, key)]
        if not given:
            raise InputError(
                "'imperfection' is a buckling mode, but the case has none of the loads that should make it buckle; "
                "give some, or take kind = 'mode'"
            )
        if free_motions(body).any():
            raise InputError(
                "'imperfection' is a buckling mode, but the supports leave the rod free to move; add one, or take "
                "kind = 'mode'"
            )
        solver = EquilibriumSolver(body, NewtonSettings(), "'imperfection'")
        found = linear_criterion(solver, self.mode).mode
        if found.shape[0] < self.mode:
            raise InputError(
                f"'imperfection' has 'mode' = {self.mode}, but under {' and '.join(map(repr, given))} the rod has "
                f"{found.shape[0] or 'no'} buckling modes; take a lower one, or other loads"
            )
        return _scaled(kinematics.split(body.frame.out(found[-1]))[:, 0], perfect, self.mode)


def _scaled(moved: Array, perfect: Geometry, number: int) -> Array:
    """Displacements (N, 2) of a mode over the largest along the normal; of equal ones, over the first."""
    along = (moved * normals(perfect.X)).sum(axis=1)
    largest = np.abs(along).max()
    if largest < 1e-6 * np.abs(moved).max():
        raise InputError(
            f"'imperfection' has 'mode' = {number}, which does not move the rod along its normal; take a bending mode"
        )
    shape: Array = moved / along[np.flatnonzero(np.abs(along) > (1 - _EQUAL) * largest)[0]]
    return shape


AnyImperfection = Annotated[Bow | Mode | BucklingMode, Field(discriminator="kind")]
"""An imperfection of any kind."""
