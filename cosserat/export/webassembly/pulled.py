"""A planar rod, supported as its case says, whose last vertex is pulled: one array and one compiled function.

The array is all that the function reads and writes, so that a page can keep it in the memory of a module of WebAssembly
(`cosserat.export.webassembly`).  The same function and the same array serve Python.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.export.webassembly.pull import pull
from cosserat.rods.energies.reissner_kernel import TERMS, VERTEX, assemble
from cosserat.rods.problem import RodProblem
from cosserat.rods.space_kernel import planar
from cosserat.solvers.banded import Band, Vector
from cosserat.solvers.climb import assembled
from cosserat.solvers.equilibrium import NewtonSettings
from cosserat.solvers.members import Body, Limits
from cosserat.solvers.potential import GRADIENT

OUTCOME, DONE, ITERATIONS, REFUSED, FALLS, ENERGY, FORCE_3, FORCE_2, RESIDUAL, TOLERANCE = range(10)
"""First numbers of the array: what came of the last pull, the fraction of it and counts (see
`cosserat.export.webassembly.pull`), the energy [J], the force on the last vertex along E3 and E2 [N],
the largest unbalanced force and the one allowed [N]."""
HEAD = 16
"""After them come DOFs, their reference, their scale and whether they are held, (n,) each, the constants of the energy,
and its gradient (n,) and Hessian (n, 8) if they are asked for."""
_WIDTH, _TERMS, _VERTEX = 8, len(TERMS), VERTEX.itemsize // 8
_TOLERANCE, _MOST = NewtonSettings().tolerance, NewtonSettings().max_iterations


def room_of(problem: RodProblem) -> Vector:
    """The array of a rod at rest whose last vertex is held.

    problem : with the consistent energy, supports along the axes and no loads.
    """
    system = problem.system(problem.geometry)
    space, own = system.space, system.internal
    assert own.evaluate is assemble
    assert space.compiled is not None
    assert not system.frame.oblique
    n = system.constrained.size
    return np.concatenate(
        [
            np.zeros(HEAD),
            system.start,
            space.compiled.placed,
            space.scale,
            system.constrained.astype(np.float64),
            own.data.view(np.float64),
            np.zeros(n * (1 + _WIDTH)),
        ]
    )


def derivatives(room: Vector, vertices: int) -> tuple[Vector, Band]:
    """Gradient (n,) [N] and Hessian, a band (n, 8), that `evaluate_rod` has left, views."""
    n, first = 4 * vertices, HEAD + vertices * (16 + _VERTEX)
    return room[first : first + n], room[first + n : first + n * (1 + _WIDTH)].reshape(n, _WIDTH)


def dofs(room: Vector, vertices: int) -> Vector:
    """The displacements in an array, a view (vertices, 4) [m]: of positions, then of directors."""
    return room[HEAD : HEAD + 4 * vertices].reshape(vertices, 4)


@njit(error_model="numpy")
def evaluate_rod(room: NDArray[np.float64], vertices: int, task: int) -> float:
    """The energy [J]; gradient and Hessian are overwritten as by a task of `solvers.potential.KERNEL`."""
    n = 4 * vertices
    first = HEAD + 4 * n
    end = first + vertices * _VERTEX
    gradient, band = room[end : end + n], np.zeros((n, _WIDTH))
    gradient[:] = 0.0
    none, skew, terms = np.zeros(0), np.zeros((0, 1)), np.zeros(_TERMS)
    q, data = room[HEAD : HEAD + n], room[first:end].view(np.uint8)
    energy = assemble(q, none, data, none, skew, task, gradient, band, skew, terms)
    for i in range(n):
        for k in range(_WIDTH):
            room[end + n + _WIDTH * i + k] = band[i, k]
    return energy


@njit(error_model="numpy")
def pull_rod(room: NDArray[np.float64], vertices: int, by_3: float, by_2: float) -> int:
    """Move the last vertex of a rod by a displacement along E3 and E2 [m]; the outcome; the room is overwritten."""
    n = 4 * vertices
    head, q, placed = room[:HEAD], room[HEAD : HEAD + n], room[HEAD + n : HEAD + 2 * n]
    scale, marks = room[HEAD + 2 * n : HEAD + 3 * n], room[HEAD + 3 * n : HEAD + 4 * n]
    first = HEAD + 4 * n
    data = room[first : first + vertices * _VERTEX].view(np.uint8)
    none, zero, skew = np.zeros(0), np.zeros(n), np.zeros((0, 1))
    body = Body(
        assemble,
        planar,
        data,
        zero,
        placed,
        scale,
        zero,
        marks > 0.0,
        0.0,
        np.inf,
        np.zeros(n),
        np.zeros(n),
        np.zeros(n + _WIDTH),
        np.zeros((n + _WIDTH, _WIDTH)),
        skew,
        np.zeros(_TERMS),
        none,
    )
    limits = Limits(_TOLERANCE, _MOST, 1.0, _TERMS, 2 * vertices - 1, _WIDTH)
    travel, forces = np.zeros(n), np.zeros(3)
    travel[n - 4], travel[n - 3] = by_3, by_2
    outcome = pull(body, limits, q, travel, (np.zeros(n), forces), head[DONE : FALLS + 1])
    head[OUTCOME] = outcome
    head[ENERGY] = assembled(body, q, 1.0, GRADIENT)
    head[FORCE_3], head[FORCE_2] = body.gradient[n - 4], body.gradient[n - 3]
    head[RESIDUAL] = 0.0
    for i in range(n):
        if not body.held[i]:
            head[RESIDUAL] = max(head[RESIDUAL], abs(body.gradient[i]))
    head[TOLERANCE] = forces[1]
    return outcome
