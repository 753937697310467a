"""Bodies without rotations: degrees of freedom (DOFs) that are plain numbers, some of them fixed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cosserat.solvers.banded import Mask, Vector
from cosserat.solvers.system import Fields


@dataclass(frozen=True)
class FixedDofs:
    """Constrained DOFs that keep their reference value."""

    mask: Mask
    moving: bool = False
    max_increment: float = np.inf

    def at_load(self, factor: float) -> tuple[Vector, Vector]:
        """Zero."""
        return np.zeros(self.mask.size), np.zeros(self.mask.size)

    def at_time(self, time: float) -> tuple[Vector, Vector, Vector]:
        """Zero."""
        return np.zeros(self.mask.size), np.zeros(self.mask.size), np.zeros(self.mask.size)


@dataclass(frozen=True)
class FlatSpace:
    """DOFs without rotations: each has a size (n,), its largest change in one step."""

    scale: Vector
    dimension: int = 1
    compiled: None = None

    @property
    def reference(self) -> Vector:
        """Zero."""
        return np.zeros_like(self.scale)

    def rigid_motions(self, q: Vector) -> Fields:
        """None is known."""
        return np.empty((0, q.size))

    def max_step_fraction(self, q: Vector, step: Vector) -> float:
        """Largest fraction of a step that changes no DOF by more than its size."""
        fastest = float((np.abs(step) / self.scale).max())
        return 1.0 / fastest if fastest > 0 else np.inf

    def rotation_weights(self, q: Vector) -> Vector:
        """Nothing rotates."""
        return np.zeros_like(q)

    def rates(self, q: Vector, change: Vector) -> Fields:
        """The change by the sizes, (n, 1)."""
        return (change / self.scale)[:, None]

    def predicted(
        self, q: Vector, moved: Fields, prescribe: Callable[[Vector], Vector], constrained: Mask
    ) -> Vector:
        """A straight line."""
        return prescribe(q + moved[:, 0] * self.scale)

    def carried(self, change: Vector, constrained: Mask) -> Vector:
        """Nothing."""
        return np.zeros_like(change)
