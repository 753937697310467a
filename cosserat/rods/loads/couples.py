"""Couples: moments that rotate with their sections, with a potential.

derived: a couple M on a director at the angle alpha has the potential -M alpha.  Minus its gradient is the director
force M n / |d|, n across the director: eq. (3.3.41) with |d| in place of lambda H, which for a director that reaches
the surface at half the height is twice the printed force (E3.10).  With t = d / |d|, grad grad alpha is
-(t n + n t) / |d|^2.  Angles are unwrapped from vertex to vertex.  The winding angle of the first director is an
internal variable, so whole turns count.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Self

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.parameters import Quantity
from cosserat.rods.kinematics import PLANAR
from cosserat.rods.loads.load import Load, LoadedRod, Stretch
from cosserat.rods.places import Place
from cosserat.rods.reference import unwrapped_angles
from cosserat.solvers.banded import Band, Vector
from cosserat.solvers.potential import COMMIT, GRADIENT, HESSIAN, Potential

Array = NDArray[np.float64]
TERMS = ("couples",)
"""Names of the parts of the potential."""
_VERTEX = np.dtype(
    [
        ("moment", "f8"),  # [N m]
        ("angle", "f8"),  # of the director in the reference [rad]
        ("dof", "i8"),  # the first of its director
    ]
)


class Couple(Load):
    """A moment on one section, positive from E3 towards E2, that rotates with it and does the work of a couple.

    Between two vertices, the sections of both carry it.
    """

    at: Place
    """The place of the loaded section."""
    moment: Annotated[float, Quantity("N*m", r"\mathbf{M}", "3.3.41")]
    """Moment, positive from E3 towards E2."""

    @property
    def places(self) -> tuple[str | int, ...]:
        """The place where it acts."""
        return (self.at,)

    @classmethod
    def potential(cls, loads: Sequence[Self], body: LoadedRod) -> Potential:
        """Minus the work of the couples; its internal variable is the winding angle of the first director [rad]."""
        moments = np.zeros(body.rod.vertices)
        for load in loads:
            for vertex, weight in body.shared(load.at):
                moments[vertex] += weight * load.moment
        angles = unwrapped_angles(body.geometry.D)
        return couples(moments, angles, body.rod.kinematics.per_vertex, body.origin)


class LineCouple(Stretch):
    """A moment per length of the reference centreline over a stretch of the rod, which rotates with the sections."""

    density: Annotated[float, Quantity("N")]
    """Moment per length, N m / m, positive from E3 towards E2."""

    @classmethod
    def potential(cls, loads: Sequence[Self], body: LoadedRod) -> Potential:
        """Minus the work of the couples on the sections of the vertices whose parts they cover."""
        moments = np.zeros(body.rod.vertices)
        for load in loads:
            moments += load.density * load.covered(body)
        angles = unwrapped_angles(body.geometry.D)
        return couples(moments, angles, body.rod.kinematics.per_vertex, body.origin)


def couples(
    moments: Array, angles: Array, per_vertex: int = PLANAR.per_vertex, origin: Vector | None = None
) -> Potential:
    """The potential of couples (N,) [N m] on directors whose reference angles are (N,) [rad].

    per_vertex : number of DOFs of a vertex; the director is the second pair.
    """
    constants = np.empty(moments.size, _VERTEX)
    constants["moment"], constants["angle"] = moments, angles
    constants["dof"] = per_vertex * np.arange(moments.size) + 2
    half_bandwidth = 1 if moments.any() else -1
    return Potential(
        _work,
        constants,
        TERMS,
        half_bandwidth=half_bandwidth,
        history=angles[:1].copy(),
        origin=origin,
        sizes=("moment",),
    )


@njit(cache=True)
def unwrap(y: float, x: float, near: float) -> float:
    """Polar angle of (x, y), within half a turn of another angle."""
    angle = np.arctan2(y, x)
    return float(angle - 2 * np.pi * np.round((angle - near) / (2 * np.pi)))


@njit(cache=True, error_model="numpy")
def _work(
    q: Vector,
    after: Vector,
    data: NDArray[np.uint8],
    history: Vector,
    strains: Array,
    task: int,
    gradient: Vector,
    band: Band,
    skew: Band,
    terms: Array,
) -> float:
    """Minus the work of the couples; arguments as in `solvers.potential.KERNEL`."""
    vertices = data.view(_VERTEX)
    ends, first = after if after.size > 0 else q, vertices[0].dof
    if task == COMMIT:
        history[0] = unwrap(ends[first + 1], ends[first], history[0])
        return 0.0
    terms[0] = 0.0
    angle = unwrap(ends[first + 1], ends[first], history[0])
    for K in range(vertices.size):
        p, M = vertices[K].dof, vertices[K].moment
        if K > 0:
            r = vertices[K - 1].dof
            a0, a1, b0, b1 = ends[r], ends[r + 1], ends[p], ends[p + 1]
            angle += np.arctan2(a0 * b1 - a1 * b0, a0 * b0 + a1 * b1)
        if M == 0.0:
            continue
        terms[0] -= M * (angle - vertices[K].angle)
        if task in (GRADIENT, HESSIAN):
            d0, d1 = q[p], q[p + 1]
            square = d0 * d0 + d1 * d1
            gradient[p] += M * d1 / square
            gradient[p + 1] -= M * d0 / square
            if task == HESSIAN:
                turn = M / (square * square)
                band[p, 0] -= 2 * turn * d0 * d1
                band[p, 1] += turn * (d0 * d0 - d1 * d1)
                band[p + 1, 0] += 2 * turn * d0 * d1
    energy: float = terms[0]
    return energy
