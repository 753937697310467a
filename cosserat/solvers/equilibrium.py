"""Equilibria of a slender elastic body at given loads.

Slender bodies rotate a lot and hardly stretch.  Their energy is a curved, narrow valley, where a line search is slow.
Full Newton steps cross it if none of them rotates the body by more than a given angle.  The configuration space gives
the fraction of a step that is allowed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated

import numpy as np

from cosserat.errors import NotConvergedError
from cosserat.parameters import Count, Parameters, Quantity
from cosserat.solvers.banded import Vector, absolute_product
from cosserat.solvers.climb import MAX_ROUND_OFF_FRACTION, balance, largest_product, stalled
from cosserat.solvers.heartbeat import beat
from cosserat.solvers.indefinite import lowest_eigenvector
from cosserat.solvers.system import History, MechanicalSystem
from cosserat.solvers.tangent import Tangent

if TYPE_CHECKING:
    from cosserat.solvers.corrector import Corrector
    from cosserat.solvers.hidden import Watch

_EPS = float(np.finfo(float).eps)
SMALLEST = 2.0**-24  # fraction of the first arc below which halving stops
_MAX_POLISHING_STEPS = 6  # Newton steps beyond the tolerance
_DECISIVE_ROUND_OFF_RATIO = 5.0  # a force above this multiple of its round-off decides the side


class NewtonSettings(Parameters):
    """Tolerances and limits of Newton's method."""

    tolerance: Annotated[float, Quantity("1", at_least=1e-16, below=1)] = 1e-10
    """Largest unbalanced force allowed, as a fraction of the largest load or reaction."""
    max_iterations: Annotated[int, Count(at_least=1, at_most=100_000)] = 50
    """Most Newton iterations of an equilibrium."""
    load_increments: Annotated[int, Count(at_least=1, at_most=10_000)] = 1
    """Number of equal load increments."""


@dataclass(frozen=True)
class Equilibrium:
    """One equilibrium.

    factor : of the load.  history : the internal variables there.
    reaction : (n,) force that holds each constrained DOF [N].
    residual, tolerance : largest unbalanced force and the largest one allowed [N].
    rounding : largest force that round-off can cause, a lower bound of any residual [N].
    negative : how many eigenvalues of the Hessian are negative, as `Tangent` counts them.
    rate : (n,) of the free DOFs with the load factor, with the internal variables there; None if it is not known.
    log_determinant : logarithm of the size of the determinant of the Hessian of the free DOFs; None if it is not known.
    """

    q: Vector
    factor: float
    history: History
    reaction: Vector
    iterations: int
    residual: float
    tolerance: float
    rounding: float
    negative: int
    rate: Vector | None = None
    log_determinant: float | None = None

    @property
    def stable(self) -> bool:
        """Whether the potential has a minimum there, if there is one."""
        return self.negative == 0

    def unframed(self, system: MechanicalSystem) -> Equilibrium:
        """The same, its DOFs along the axes of space."""
        if not system.frame.oblique:
            return self
        out = system.frame.out
        return replace(self, q=out(self.q), reaction=out(self.reaction))


class EquilibriumSolver:
    """Equilibria at given load factors, with counts of the work done.

    branch_switches : how often the solver moved to another path at a bifurcation.
    undecided_factors : load factors at which symmetry leaves the side of buckling open.
    passed_limit_load : whether the load had to fall before it could grow.
    crossings : equilibria on both sides of each limit point and each bifurcation of a traced path, in its order.
    """

    def __init__(self, system: MechanicalSystem, settings: NewtonSettings, name: str) -> None:
        self.system, self.settings, self.name = system, settings, name
        self.corrector: Corrector | None = None  # once there are arcs
        self.watch: Watch | None = None  # the same
        self.iterations = self.cutbacks = self.branch_switches = 0
        self.undecided_factors: list[float] = []
        self.passed_limit_load = False
        self.crossings: list[tuple[Equilibrium, Equilibrium]] = []
        self.residual = self.tolerance = np.inf  # of the last attempt
        self.limit_remedy = (
            "the body jumps to a state that no path reaches; reduce the load, or use kind = 'rod path'"
        )
        self.remedy = (
            "try a smaller load or more 'newton.max_iterations', follow the path with kind = 'rod path', and "
            "check supports and loads"
        )

    @cached_property
    def tangent(self) -> Tangent:
        """Gradient and Hessian assembled last."""
        return Tangent(self.system)

    def warnings(self) -> Iterator[str]:
        """Warnings of an answer: open sides of buckling, and whether it lies beyond a limit load."""
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

    def correct(
        self, q: Vector, factor: float, history: History, *, fraction: float | None = None
    ) -> Equilibrium | None:
        """An equilibrium at the load factor by full Newton steps from q; None if they do not converge.

        history : the internal variables of the last accepted state.
        fraction : of the loads that may be left unbalanced, in place of the tolerance of the settings.
        """
        allowed = self.settings.tolerance if fraction is None else fraction
        system, tangent = self.system, self.tangent
        q = system.prescribe(q, factor)
        largest_load, total = system.load_sizes
        load = abs(factor) * largest_load
        largest, last = 0.0, np.inf
        for iteration in range(self.settings.max_iterations + 1):
            if not system.assemble(q, history, factor, tangent):
                return None
            unbalanced, residual, reaction = self.unbalanced()
            largest = max(largest, residual)
            rounding = self.rounding(q)
            scale = max(load, reaction, largest * (load == 0))
            tolerance = max(allowed * scale, rounding)
            self.residual, self.tolerance = residual, tolerance
            if load > 0 and rounding > MAX_ROUND_OFF_FRACTION * max(scale, total):
                if iteration > 0:
                    return None  # a step diverged into a stiff state
                raise self._round_off_error(rounding)
            tangent.constrain(system.constrained)
            step = tangent.solve(unbalanced, positive=True)
            if residual <= tolerance or stalled(residual, last, rounding):
                if step is not None and fraction is None:
                    return self._polished_once(q, step, factor, history, rounding)
                negative = 0 if step is not None else tangent.negative()
                return self.accepted(q, factor, history, rounding, negative=negative)
            last = residual
            if step is None:
                step = tangent.solve(unbalanced)
            if step is None or not np.isfinite(step).all():
                return None
            q = q + min(1.0, system.space.max_step_fraction(q, step)) * step
            self.iterations += 1
            beat(factor, self.iterations)
        return None

    def unbalanced(self) -> tuple[Vector, float, float]:
        """Unbalanced forces (n,) by the tangent assembled last, the largest, and the largest reaction [N]."""
        forces = np.empty_like(self.tangent.gradient)
        return forces, *balance(self.tangent.gradient, self.system.constrained, forces)

    def accepted(
        self, q: Vector, factor: float, history: History, rounding: float, *, negative: int
    ) -> Equilibrium:
        """The equilibrium at q, where the last tangent was assembled, and so many eigenvalues are negative."""
        return Equilibrium(
            q,
            factor,
            self.system.committed(q, history),
            np.where(self.system.constrained, self.tangent.gradient, 0.0),
            self.iterations,
            self.residual,
            self.tolerance,
            rounding,
            negative,
        )

    def _polished_once(
        self, q: Vector, step: Vector, factor: float, history: History, rounding: float
    ) -> Equilibrium:
        """The stable equilibrium after one more correction, if its residual is smaller or is round-off.

        Soft motions are still resolved where round-off exceeds the forces.
        """
        point = self.accepted(q, factor, history, rounding, negative=0)
        self.system.assemble(q + step, history, factor, self.tangent)
        _, nearer, _ = self.unbalanced()
        if not nearer <= max(point.residual, rounding):
            return point
        return replace(
            point,
            q=q + step,
            history=self.system.committed(q + step, history),
            reaction=np.where(self.system.constrained, self.tangent.gradient, 0.0),
            residual=nearer,
        )

    def check_round_off(self, point: Equilibrium) -> None:
        """Raise NotConvergedError if no support moves and round-off forces exceed a fraction of the full load."""
        _, load = self.system.load_sizes
        if (
            point.rounding > MAX_ROUND_OFF_FRACTION * load > 0
            and not self.system.prescribed_rate(1.0).any()
        ):
            raise self._round_off_error(point.rounding)

    def _round_off_error(self, rounding: float) -> NotConvergedError:
        return NotConvergedError(
            f"{self.name}: rounding the degrees of freedom makes forces up to {rounding:.2g} N, too large for "
            "the loads; use fewer vertices, or loads that give smaller strains",
            iterations=self.iterations,
            residual=self.residual,
            tolerance=self.tolerance,
        )

    def rounding(self, q: Vector) -> float:
        """Largest force that rounding can cause, by the Hessian assembled last [N]."""
        band, scale = self.tangent.band, self.system.space.scale
        return _EPS * float(largest_product(band, q, scale, np.empty_like(q)))

    def buckling_direction(self, before: Equilibrium, after: Equilibrium) -> tuple[Vector, bool]:
        """The softest motion of a stable body that is about to buckle, and whether its side is decided.

        The motion has the length of the step limit.

        before, after : equilibria on both sides of the load at which the body loses its stability.

        The growing load pulls along the motion with -motion . rate.  Supports that move carry
        the body along without a pull.  The pull that remains, less the softening, is an imperfection.  If round-off
        exceeds it, the body is symmetric and both sides are equal; the largest entry is then made positive.
        """
        system, tangent, space = self.system, self.tangent, self.system.space
        q = self._polished(before)
        system.assemble(q, before.history, before.factor, tangent)
        rate = system.rate(before.factor, tangent)
        tangent.constrain(system.constrained)
        motion = lowest_eigenvector(tangent.band, system.constrained)
        motion *= np.sign(motion[np.abs(motion).argmax()])
        stiff = float(motion @ tangent.product(motion))
        change = tangent.solve(np.where(system.constrained, 0.0, -rate), positive=True)
        carried = 0.0
        if change is not None:
            moved = np.where(system.constrained, system.prescribed_rate(before.factor), change)
            along = float(motion @ space.carried(moved, system.constrained))
            carried = along / float(motion @ motion)
        pull = -float(motion @ rate) - stiff * carried
        size = np.maximum(np.abs(q), space.scale)
        noise = _EPS * float(np.linalg.norm(motion * absolute_product(tangent.band, size)))
        system.assemble(after.q, after.history, after.factor, tangent)
        tangent.constrain(system.constrained)
        softening = (stiff - float(motion @ tangent.product(motion))) / max(
            abs(after.factor - before.factor), _EPS
        )
        magnified = 1 + abs(before.factor * softening / max(stiff, _EPS * abs(softening)))
        decided = abs(pull * before.factor) > _DECISIVE_ROUND_OFF_RATIO * magnified * noise
        if decided and pull < 0:
            motion = -motion
        return space.max_step_fraction(q, motion) * motion, decided

    def note_crossing(
        self, point: Equilibrium, found: Equilibrium, *, turned: bool | None = False
    ) -> None:
        """Keep two neighbours of a path if a limit point or a bifurcation lies between them.

        turned : whether the load turns back between them; None where the second is on another path.
        """
        if turned or (turned is not None and found.negative != point.negative):
            self.crossings.append((point, found))

    def _polished(self, point: Equilibrium) -> Vector:
        """The DOFs of a stable point after Newton steps beyond the tolerance, down to round-off."""
        q, last = point.q, np.inf
        for _ in range(_MAX_POLISHING_STEPS):
            self.system.assemble(q, point.history, point.factor, self.tangent)
            unbalanced, residual, _ = self.unbalanced()
            self.tangent.constrain(self.system.constrained)
            step = self.tangent.solve(unbalanced, positive=True)
            if step is None or residual >= last:
                break
            q, last = q + step, residual
        return q

    def failure(self, done: float, goal: float, last: Equilibrium | None) -> NotConvergedError:
        """An error with the load reached and the load tried next."""
        return self.stopped(
            f"no equilibrium found beyond {done:.4g} of the load (tried {goal:.6g}, largest unbalanced force "
            f"{self.residual:.3g} N, allowed {self.tolerance:.3g} N); {self.remedy}",
            last,
        )

    def stopped(self, reason: str, last: Equilibrium | None) -> NotConvergedError:
        """An error that holds the last equilibrium."""
        error = NotConvergedError(
            f"{self.name}: {reason}",
            iterations=self.iterations,
            residual=self.residual,
            tolerance=self.tolerance,
        )
        error.state = last
        return error
