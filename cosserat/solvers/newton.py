"""Equilibrium of an elastic body under dead loads: Newton's method on the total potential, with a line search.

Nothing here knows what the unknowns mean or how many of them a vertex has; the body says how wide its band is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Protocol

import numpy as np

from cosserat.errors import NotConvergedError
from cosserat.parameters import Count, Parameters, Quantity
from cosserat.solvers.banded import Band, Mask, Vector, absolute_product, hold, solve_positive

_ARMIJO = 1e-4  # share of the predicted fall that a step must reach (Nocedal & Wright, section 3.1)
_SHORTEST = 2.0**-30  # the line search gives up below this share of the Newton step
_SHIFTS = tuple(4.0**k for k in range(-14, 3))  # shares of the largest diagonal entry, tried in turn
_ROUNDING = float(np.finfo(float).eps)  # of a position; forces come from differences of positions
_BLUR = 1e-3  # share of the loads beyond which forces of rounding make an answer worthless
_NOISE = 1e-8  # share of the energy below which a rise of it is not believed


class Elastic(Protocol):
    """A body with a strain energy."""

    @property
    def half_bandwidth(self) -> int:
        """Largest distance of two coupled unknowns."""

    def assemble(self, q: Vector, gradient: Vector, band: Band) -> float:
        """Energy at q; overwrites its gradient, shape (n,), and its Hessian, shape (n, half_bandwidth + 1)."""


class NewtonSettings(Parameters):
    """How hard Newton's method tries."""

    tolerance: Annotated[float, Quantity("1", above=0, below=1)] = 1e-10
    """Largest unbalanced force allowed, as a share of the largest load or reaction."""
    max_iterations: Annotated[int, Count(at_least=1)] = 50
    load_steps: Annotated[int, Count(at_least=1, at_most=100_000)] = 1
    """Equal steps in which the load is brought up."""


@dataclass(frozen=True)
class Equilibrium:
    """A converged state and what it took.

    q : (n,) the unknowns.  reaction : (n,) force that holds each held unknown, zero elsewhere [N].
    residual : largest unbalanced force [N]; tolerance : the one that was allowed [N].
    rounding : largest force that rounding the positions can cause [N]; no residual can be asked to be below it.
    """

    q: Vector
    energy: float
    reaction: Vector
    iterations: int
    shortened: int
    shifted: int
    residual: float
    tolerance: float
    rounding: float


def equilibrium(
    body: Elastic, start: Vector, load: Vector, held: Mask, settings: NewtonSettings, name: str
) -> Equilibrium:
    """Minimise energy(q) - load . q over the unknowns that are not held.

    start, load, held : (n,) first guess, dead load [N] and which unknowns keep their value.
    name : what an error calls the case.

    Raises
    ------
    NotConvergedError : no equilibrium within the tolerance; nothing half-converged is returned.
    """
    step = _Descent(body, held, settings, name)
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused, not warned of
        result = step.run(start, load / settings.load_steps)
        for number in range(2, settings.load_steps + 1):
            result = step.run(result.q, load * (number / settings.load_steps))
    return result


class _Descent:
    """One solve: the work arrays and the counters that the report needs."""

    def __init__(self, body: Elastic, held: Mask, settings: NewtonSettings, name: str) -> None:
        n = held.size
        self.body, self.held, self.settings, self.name = body, held, settings, name
        self.gradient = np.empty(n)
        self.band = np.empty((n, body.half_bandwidth + 1))
        self.iterations = self.shortened = self.shifted = 0
        self.largest = 0.0  # unbalanced force met so far: the scale of a problem without loads

    def run(self, q: Vector, load: Vector) -> Equilibrium:
        energy = self.body.assemble(q, self.gradient, self.band)
        if not np.isfinite(energy):
            raise self._failure("the energy is not finite at the starting configuration", np.inf, 0.0)
        for iteration in range(self.settings.max_iterations + 1):
            unbalanced = np.where(self.held, 0.0, load - self.gradient)
            residual = float(np.abs(unbalanced).max())
            rounding = _ROUNDING * float(absolute_product(self.band, q).max())
            self.largest = max(self.largest, residual)
            scale = max(
                self.largest,
                float(np.abs(load).max()),
                float(np.abs(self.gradient[self.held]).max(initial=0.0)),
            )
            tolerance = max(self.settings.tolerance * scale, rounding)
            if rounding > _BLUR * scale and load.any():
                raise self._failure(
                    f"rounding the positions makes forces up to {rounding:.2g} N", residual, scale
                )
            if residual <= tolerance:
                reaction = np.where(self.held, self.gradient - load, 0.0)
                return Equilibrium(
                    q,
                    energy,
                    reaction,
                    self.iterations,
                    self.shortened,
                    self.shifted,
                    residual,
                    tolerance,
                    rounding,
                )
            if iteration == self.settings.max_iterations:
                break
            hold(self.band, self.held)
            direction = self._direction(unbalanced)
            if direction is None:
                raise self._failure("the stiffness cannot be made positive", residual, tolerance)
            found = self._search(q, energy, load, direction, unbalanced)
            if found is None:
                raise self._failure("no shorter step lowers the potential", residual, tolerance)
            q, energy = found
            self.iterations += 1
        raise self._failure(
            f"{self.settings.max_iterations} iterations were not enough", residual, tolerance
        )

    def _direction(self, unbalanced: Vector) -> Vector | None:
        """Newton's step; where the Hessian is not positive definite, that of a shift which makes it so."""
        direction = solve_positive(self.band, unbalanced)
        self.shifted += direction is None
        largest = float(np.abs(self.band[:, 0]).max())
        for shift in _SHIFTS:
            if direction is not None:
                break
            self.band[:, 0] += shift * largest
            direction = solve_positive(self.band, unbalanced)
        return direction

    def _search(
        self, q: Vector, energy: float, load: Vector, direction: Vector, unbalanced: Vector
    ) -> tuple[Vector, float] | None:
        """Halve the step until the potential falls enough.

        Near the end the fall is lost in rounding; there its slope decides (Hager & Zhang 2005, approximate Wolfe).
        """
        slope = float(unbalanced @ direction)
        share = 1.0
        while share >= _SHORTEST:
            trial = q + share * direction
            trial_energy = self.body.assemble(trial, self.gradient, self.band)
            change = trial_energy - energy - share * float(load @ direction)
            if np.isfinite(change):
                trial_slope = float((load - self.gradient) @ direction)
                falls = change <= -_ARMIJO * share * slope
                flattens = (
                    change <= _NOISE * abs(energy) and abs(trial_slope) <= (1 - 2 * _ARMIJO) * slope
                )
                if falls or flattens:
                    return trial, trial_energy
            self.shortened += 1
            share *= 0.5
        return None

    def _failure(self, reason: str, residual: float, tolerance: float) -> NotConvergedError:
        return NotConvergedError(
            f"{self.name}: no equilibrium found: {reason} (iteration {self.iterations}, largest unbalanced force "
            f"{residual:.3g} N, allowed {tolerance:.3g} N); try a smaller load, more 'newton.load_steps', more "
            "'newton.max_iterations' or fewer vertices, and check that the body is stable under this load",
            iterations=self.iterations,
            residual=residual,
            tolerance=tolerance,
        )
