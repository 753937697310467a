"""Equilibria of a slender elastic body at given loads.

Slender bodies turn far while they hardly stretch: their energy is a curved, narrow valley, along which a line search
creeps.  Full Newton steps cross it, if none of them turns the body by more than a given angle; the body says how
much of a step that is.  Nothing here knows what the DOFs mean.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Protocol

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import NotConvergedError
from cosserat.parameters import Count, Parameters, Quantity
from cosserat.solvers.banded import (
    Band,
    Mask,
    Vector,
    absolute_product,
    band_product,
    constrain,
    negative_eigenvalues,
    solve_positive,
)
from cosserat.solvers.indefinite import lowest_eigenvector, solve_any

Fields = NDArray[np.float64]

_EPS = float(np.finfo(float).eps)
SMALLEST = 2.0**-24  # share of the first arc below which halving gives up
_BLUR = 1e-3  # share of the loads beyond which forces of rounding make an answer worthless
_ROUGH = 16.0  # multiple of the estimate below which a residual that no longer falls is rounding
_POLISH = 6  # Newton steps beyond the tolerance
_SURE = 5.0  # multiple of its rounding from which on a force decides to which side a body buckles


class NewtonSettings(Parameters):
    """Tolerances and limits of Newton's method."""

    tolerance: Annotated[float, Quantity("1", above=0, below=1)] = 1e-10
    """Largest unbalanced force allowed, as a share of the largest load or reaction."""
    max_iterations: Annotated[int, Count(at_least=1)] = 50
    """Most Newton iterations of an equilibrium."""
    load_increments: Annotated[int, Count(at_least=1, at_most=100_000)] = 1
    """Equal steps in which the load is brought up."""


class Loaded(Protocol):
    """A body under a load that grows with a factor."""

    @property
    def half_bandwidth(self) -> int:
        """Largest distance of two coupled DOFs."""

    @property
    def constrained(self) -> Mask:
        """Which DOFs keep their value, or the one that the factor gives them, shape (n,)."""

    @property
    def dof_scale(self) -> Vector:
        """Sizes (n,) that are rounded where the energy is computed, however small the DOFs are."""

    def prescribe(self, q: Vector, factor: float) -> Vector:
        """q with its constrained DOFs where the factor puts them."""

    @property
    def max_increment(self) -> float:
        """Largest change of the factor by which supports may move at once."""

    def prescribed_rate(self, factor: float) -> Vector:
        """Change of the constrained DOFs with the factor, zero elsewhere, shape (n,)."""

    def assemble(self, q: Vector, factor: float, gradient: Vector, band: Band) -> float:
        """Elastic energy at q; overwrites the gradient of the potential, loads included, and the Hessian."""

    def load(self, factor: float, *, signed: bool = False) -> Vector:
        """Dead load, shape (n,), and unsigned also what couples amount to: the scale of what counts as balanced."""

    def rate(self, q: Vector, factor: float, band: Band) -> Vector:
        """Change of that gradient with the factor, shape (n,); `band` is the Hessian at q."""

    def max_step_fraction(self, q: Vector, step: Vector) -> float:
        """Largest share of a step that turns no part by more than is safe."""

    def rates(self, q: Vector, change: Vector) -> Fields:
        """How fast the parts of the body turn [rad] and stretch as the DOFs change, (parts, 2)."""

    def predicted(self, q: Vector, moved: Fields, factor: float) -> Vector:
        """The DOFs at a factor after the parts have turned and stretched by so much."""

    def carried(self, change: Vector) -> Vector:
        """What of a change of the DOFs only follows supports that move or slide, and strains nothing."""


@dataclass(frozen=True)
class Equilibrium:
    """One equilibrium.

    factor : of the load.  reaction : (n,) force that holds each held unknown [N].  residual, tolerance : largest
    unbalanced force and the one that was allowed [N].  rounding : largest force that rounding can cause; no
    residual can be asked to be below it [N].  negative : how many eigenvalues of the Hessian are negative.
    """

    q: Vector
    factor: float
    energy: float
    reaction: Vector
    iterations: int
    residual: float
    tolerance: float
    rounding: float
    negative: int

    @property
    def stable(self) -> bool:
        """Whether the potential has a minimum there."""
        return self.negative == 0


class EquilibriumSolver:
    """Equilibria at given factors, and what finding them took.

    branchings : how often a path was left where another crosses it.  undecided : factors at which the body was so
    symmetric that nothing decides the side to which it goes.  turned_back : the load had to fall before it could grow.
    """

    def __init__(self, body: Loaded, settings: NewtonSettings, name: str) -> None:
        n = body.constrained.size
        self.body, self.settings, self.name = body, settings, name
        self.gradient, self.band = np.empty(n), np.empty((n, body.half_bandwidth + 1))
        self.iterations = self.cutbacks = self.branch_switches = 0
        self.undecided_factors: list[float] = []
        self.passed_limit_load = False
        self.residual = self.tolerance = np.inf  # of the last attempt
        self.remedy = (
            "try a smaller load or more 'newton.max_iterations', see where the path goes with kind = 'rod path', and "
            "check supports and loads"
        )

    def warnings(self) -> Iterator[str]:
        """What is to be said of an answer: where its side was open, and whether it lies beyond a limit load."""
        for factor in self.undecided_factors:
            yield (
                f"bifurcation: at {factor:.4g} of the load the body is so symmetric that it may buckle to either side; "
                "this is one of two answers, and a small load or an imperfection decides between them"
            )
        if self.passed_limit_load:
            yield (
                "limit load: no stable path leads to the full load; a body under it jumps, and this is where the path "
                "arrives beyond its unstable part: see it with kind = 'rod path'"
            )

    def correct(self, q: Vector, factor: float, *, share: float | None = None) -> Equilibrium | None:
        """An equilibrium at the factor by full Newton steps from q; None where they do not lead to one.

        share : of the loads that may be left unbalanced, in place of the tolerance of the settings.
        """
        allowed = self.settings.tolerance if share is None else share
        body, constrained = self.body, self.body.constrained
        q = body.prescribe(q, factor)
        load = float(np.abs(body.load(factor)).max())
        largest, last = 0.0, np.inf
        for iteration in range(self.settings.max_iterations + 1):
            energy = body.assemble(q, factor, self.gradient, self.band)
            if not np.isfinite(energy):
                return None
            unbalanced = np.where(constrained, 0.0, -self.gradient)
            residual = float(np.abs(unbalanced).max())
            largest = max(largest, residual)
            rounding = self.rounding(q)
            scale = max(
                load, float(np.abs(self.gradient[constrained]).max(initial=0.0)), largest * (load == 0)
            )
            tolerance = max(allowed * scale, rounding)
            self.residual, self.tolerance = residual, tolerance
            if load > 0 and rounding > _BLUR * max(scale, float(np.abs(body.load(factor)).sum())):
                if iteration > 0:
                    return None  # a step went astray, to where everything is stiff
                raise self._drowned_in_round_off(rounding)
            constrain(self.band, constrained)
            step = solve_positive(self.band, unbalanced)
            if residual <= tolerance or stalled(residual, last, rounding):
                negative = 0 if step is not None else negative_eigenvalues(self.band)
                reaction = np.where(constrained, self.gradient, 0.0)
                if step is not None and share is None:  # the last correction costs one more energy
                    ahead = body.assemble(q + step, factor, self.gradient, self.band)
                    nearer = float(np.abs(np.where(constrained, 0.0, self.gradient)).max())
                    if nearer <= max(
                        residual, rounding
                    ):  # where forces drown in rounding, soft motions do not
                        q, energy, residual = q + step, ahead, nearer
                        reaction = np.where(constrained, self.gradient, 0.0)
                return Equilibrium(
                    q, factor, energy, reaction, self.iterations, residual, tolerance, rounding, negative
                )
            last = residual
            if step is None:
                step = solve_any(self.band, unbalanced)
            if step is None or not np.isfinite(step).all():
                return None
            q = q + min(1.0, body.max_step_fraction(q, step)) * step
            self.iterations += 1
        return None

    def check_round_off(self, point: Equilibrium) -> None:
        """Raise NotConvergedError if no support moves and rounding makes forces that drown the full load."""
        load = self.body.load(1.0)
        if point.rounding > _BLUR * float(load.sum()) > 0 and not self.body.prescribed_rate(1.0).any():
            raise self._drowned_in_round_off(point.rounding)

    def _drowned_in_round_off(self, rounding: float) -> NotConvergedError:
        return NotConvergedError(
            f"{self.name}: rounding the degrees of freedom makes forces up to {rounding:.2g} N, too much beside "
            "the loads; use fewer vertices, or loads that strain the body less",
            iterations=self.iterations,
            residual=self.residual,
            tolerance=self.tolerance,
        )

    def rounding(self, q: Vector) -> float:
        """Largest force that rounding can cause, by the Hessian assembled last [N]."""
        size = np.maximum(np.abs(q), self.body.dof_scale)
        return _EPS * float(absolute_product(self.band, size).max())

    def buckling_direction(self, before: Equilibrium, after: Equilibrium) -> tuple[Vector, bool]:
        """The softest motion of a stable body that is about to buckle, one reach long, and whether its side is decided.

        before, after : on both sides of the load at which it loses its stability.

        The growing load pulls along the motion with -motion . rate.  A body that its supports carry along moves without
        being pulled.  What is left of the pull without that and the softening is an imperfection; where it drowns in
        rounding the body is symmetric and both sides are alike: the one of the positive largest entry is taken.
        """
        body = self.body
        q = self._polished(before)
        body.assemble(q, before.factor, self.gradient, self.band)
        rate = body.rate(q, before.factor, self.band)
        constrain(self.band, body.constrained)
        motion = lowest_eigenvector(self.band, body.constrained)
        motion *= np.sign(motion[np.abs(motion).argmax()])
        stiff = float(motion @ band_product(self.band, motion))
        change = solve_positive(self.band, np.where(body.constrained, 0.0, -rate))
        carried = 0.0
        if change is not None:
            moved = np.where(body.constrained, body.prescribed_rate(before.factor), change)
            carried = float(motion @ body.carried(moved)) / float(motion @ motion)
        pull = -float(motion @ rate) - stiff * carried
        size = np.maximum(np.abs(q), body.dof_scale)
        noise = _EPS * float(np.linalg.norm(motion * absolute_product(self.band, size)))
        body.assemble(after.q, after.factor, self.gradient, self.band)
        constrain(self.band, body.constrained)
        softening = (stiff - float(motion @ band_product(self.band, motion))) / max(
            abs(after.factor - before.factor), _EPS
        )
        magnified = 1 + abs(before.factor * softening / max(stiff, _EPS * abs(softening)))
        decided = abs(pull * before.factor) > _SURE * magnified * noise
        if decided and pull < 0:
            motion = -motion
        return body.max_step_fraction(q, motion) * motion, decided

    def _polished(self, point: Equilibrium) -> Vector:
        """The DOFs of a stable point after Newton steps beyond the tolerance, down to rounding."""
        body, q, last = self.body, point.q, np.inf
        for _ in range(_POLISH):
            body.assemble(q, point.factor, self.gradient, self.band)
            unbalanced = np.where(body.constrained, 0.0, -self.gradient)
            residual = float(np.abs(unbalanced).max())
            constrain(self.band, body.constrained)
            step = solve_positive(self.band, unbalanced)
            if step is None or residual >= last:
                break
            q, last = q + step, residual
        return q

    def failure(self, done: float, goal: float, last: Equilibrium | None) -> NotConvergedError:
        """An error that says how far the load came and what was tried next."""
        return self.stopped(
            f"no equilibrium found beyond {done:.4g} of the load (tried {goal:.6g}, largest unbalanced force "
            f"{self.residual:.3g} N, allowed {self.tolerance:.3g} N); {self.remedy}",
            last,
        )

    def stopped(self, reason: str, last: Equilibrium | None) -> NotConvergedError:
        """An error that holds the last equilibrium, its DOFs as the body counts them."""
        error = NotConvergedError(
            f"{self.name}: {reason}",
            iterations=self.iterations,
            residual=self.residual,
            tolerance=self.tolerance,
        )
        error.state = None if last is None else last.q
        error.factor = 0.0 if last is None else last.factor
        return error


def stalled(residual: float, last: float, rounding: float) -> bool:
    """Whether what is left no longer falls and is of the size of rounding, whose bound is an estimate."""
    return residual > last / 2 and residual <= _ROUGH * rounding
