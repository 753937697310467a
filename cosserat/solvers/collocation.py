"""First-order systems on consecutive regions, mapped to a common domain and solved by `scipy.integrate.solve_bvp`."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import NotConvergedError
from cosserat.solvers.heartbeat import beat

Array = NDArray[np.float64]
_MOST_NODES = 20_000


@dataclass(frozen=True)
class RegionSystem:
    """y' = rate(y) on [left, right], y of shape (size, K); guess(z) is a first guess, shape (size, K)."""

    left: float
    right: float
    size: int
    rate: Callable[[Array], Array]
    guess: Callable[[Array], Array]


Conditions = Callable[[list[Array], list[Array]], Array]
"""Residuals of the end and junction conditions, from y at the left and at the right ends of the regions."""


@dataclass(frozen=True)
class Collocated:
    """solution(number, z) : y of a region at z, shape (size, len(z)).  nodes : of the final mesh."""

    solution: Callable[[int, Array], Array]
    nodes: int
    iterations: int


def collocate(
    systems: Sequence[RegionSystem], conditions: Conditions, start: Array, tolerance: float, name: str
) -> Collocated:
    """Solve on the common domain [0, 1], each region shifted and scaled to it, eq. (2.3.16).

    start : (K,) first mesh on [0, 1].  tolerance : of the relative residuals, as SciPy defines it.

    Raises
    ------
    NotConvergedError : SciPy reports no success, with its reason.
    """
    from scipy.integrate import solve_bvp

    cuts = np.cumsum([0, *(system.size for system in systems)])
    spans = [system.right - system.left for system in systems]

    def parts(y: Array) -> list[Array]:
        return [y[a:b] for a, b in itertools.pairwise(cuts)]

    def rate(_: Array, y: Array) -> Array:
        beat(0.0, 0)
        scaled = [s.rate(part) * span for s, part, span in zip(systems, parts(y), spans, strict=True)]
        return np.concatenate(scaled)

    def residual(at_left: Array, at_right: Array) -> Array:
        return conditions(parts(at_left), parts(at_right))

    guess = np.concatenate(
        [s.guess(s.left + span * start) for s, span in zip(systems, spans, strict=True)]
    )
    with np.errstate(all="ignore"):  # a failure is reported below, with SciPy's reason
        found = solve_bvp(
            rate, residual, start, guess, tol=tolerance, bc_tol=tolerance, max_nodes=_MOST_NODES
        )
    if found.status != 0:
        raise NotConvergedError(
            f"{name}: solve_bvp found no solution ({found.message.strip().rstrip('.')}); "
            "try weaker loads, regions that are not so short, or a larger 'collocation_tolerance'",
            iterations=int(found.niter),
            residual=float(np.max(found.rms_residuals)),
            tolerance=tolerance,
        )

    def solution(number: int, z: Array) -> Array:
        local = (z - systems[number].left) / spans[number]
        result: Array = found.sol(np.clip(local, 0, 1))[cuts[number] : cuts[number + 1]]
        return result

    return Collocated(solution, int(found.x.size), int(found.niter))
