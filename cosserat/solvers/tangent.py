"""Gradient and Hessian of a system, in total and of the loads alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cosserat.solvers.banded import (
    Mask,
    Vector,
    band_product,
    constrain,
    skew_product,
    solve_positive,
    uncouple,
)
from cosserat.solvers.indefinite import Factors, negative_eigenvalues

if TYPE_CHECKING:
    from cosserat.solvers.system import MechanicalSystem


class Tangent:
    """Gradient, (n,), and Hessian of a system, in total and of the loads alone.

    band, skew : the symmetric and the skew part of the Hessian; `skew` has no rows if it is zero.
    load_gradient, load_band, load_skew : those of the loads alone, at the load factor one.
    """

    def __init__(self, system: MechanicalSystem) -> None:
        n, width = system.constrained.size, system.half_bandwidth + 1
        own = 1 + max((load.half_bandwidth for load in system.external), default=-1)
        lopsided = 0 if system.symmetric else n
        self.gradient, self.load_gradient = np.empty(n), np.empty(n)
        self.band, self.load_band = np.empty((n, width)), np.empty((n, own))
        self.skew, self.load_skew = np.empty((lopsided, width)), np.empty((lopsided, own))

    def clear(self) -> None:
        """Set everything to zero but the gradient of the loads."""
        self.gradient.fill(0.0)
        self.band.fill(0.0)
        if self.skew.size:
            self.skew.fill(0.0)
        if self.load_band.size:
            self.load_band.fill(0.0)
            self.load_skew.fill(0.0)

    def add_load(self, factor: float) -> None:
        """Add the parts of the loads times a factor."""
        self.gradient += factor * self.load_gradient
        own = self.load_band.shape[1]
        if own:
            self.band[:, :own] += factor * self.load_band
            self.skew[:, :own] += factor * self.load_skew

    def constrain(self, constrained: Mask) -> None:
        """Uncouple the constrained DOFs."""
        constrain(self.band, constrained)
        if self.skew.size:
            uncouple(self.skew, constrained)

    def product(self, x: Vector) -> Vector:
        """The Hessian times x, (n,)."""
        y = band_product(self.band, x)
        return y + skew_product(self.skew, x) if self.skew.size else y

    def solve(self, right: Vector, *, positive: bool = False) -> Vector | None:
        """Solve with the Hessian for one or, as columns, several right-hand sides.

        None where it is singular or, with `positive`, where `negative` is not zero.
        """
        if positive and not self.skew.size:
            return solve_positive(self.band, right)
        factors = Factors(self.band, self.skew)
        return None if positive and factors.sign < 0 else factors.solve(right)

    def negative(self) -> int:
        """How many eigenvalues are negative; where there is a skew part, one if the determinant is.

        Under a load without a potential a body diverges where the determinant changes its sign.  It may flutter
        before, which only a motion shows.
        """
        if not self.skew.size:
            return negative_eigenvalues(self.band)
        return int(Factors(self.band, self.skew).sign < 0)
