"""What eigenvalue problems and paths take at least: time, working memory and space, from measured costs.

Costs are those of one thread of a processor of 2020 and grow with the degrees of freedom n: dense methods with n^3 in
time and n^2 in memory, sparse ones with n and with the square of the number of modes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from cosserat.problem import Forecast
from cosserat.rods.problem import RodProblem
from cosserat.solvers.modes import FEW, MOST_DENSE

_STORED = 6  # numbers that are stored of each vertex for a mode, or for a point of a path
_POINT = (5e-6, 350.0)  # seconds and bytes of each vertex at a point of a path
_SPARSE = (4e-7, 6e-9, 60.0)  # of each DOF: seconds for a mode, for its square, and bytes for a mode


@dataclass(frozen=True)
class Dense:
    """Costs of a dense method: seconds over n^3 and bytes over n^2."""

    seconds: float
    memory: float


SYMMETRIC = Dense(2.5e-10, 36.0)
GENERAL = Dense(1e-9, 65.0)
_SIGNS = 7e-11  # seconds over n^4 to tell which roots of an unsymmetric problem are single


def of_modes(problem: RodProblem, count: int, *, always_dense: bool = False) -> Forecast:
    """The forecast for so many modes of the rod of a problem.

    always_dense : whether unsymmetric problems are solved by dense methods, however large they are.
    """
    vertices = problem.rod.vertices
    size = len(problem.rod.kinematics.dofs) * vertices
    general = bool(problem.loads_of("follower_forces") or problem.loads_of("follower_line_loads"))
    if size <= max(MOST_DENSE, FEW * count) or (general and always_dense):
        cost = GENERAL if general else SYMMETRIC
        seconds, memory = cost.seconds * size**3, cost.memory * size**2
        seconds += _SIGNS * size**4 if general and always_dense else 0.0
    else:
        each, squared, memory = _SPARSE
        seconds, memory = size * count * (each + squared * count), memory * size * count
    return Forecast(
        seconds=seconds,
        size=8.0 * _STORED * vertices * min(count, size),
        memory=memory,
        work=f"{count} modes of {vertices} vertices",
        less_work="take a smaller 'count' or fewer 'rod.vertices'",
        stored=f"{count} modes of {vertices} vertices",
        less_stored="take a smaller 'count' or fewer 'rod.vertices'",
    )


def of_path(problem: RodProblem, count: int, longest: float) -> Forecast:
    """The forecast for a path that reaches the full load: it needs at least as many arcs as the longest one says."""
    vertices, points = problem.rod.vertices, min(count, math.ceil(1 / longest))
    seconds, memory = (cost * points * vertices for cost in _POINT)
    words, remedy = (
        f"{points} points of {vertices} vertices",
        "take a longer 'arc.longest' or fewer 'rod.vertices'",
    )
    return Forecast(
        seconds, 8.0 * _STORED * points * vertices, words, remedy, words, remedy, memory=memory
    )
