"""Frames of their own for some vectors, so that a constraint may hold one oblique component.

Solvers constrain components.  A vector that is held in one oblique direction has its components in a frame with an axis
along this direction.  `framed` gives the same body in such components: its potentials, mass and configuration space are
called with components along the axes of space, and what they give is rotated into the frames.  Without frames nothing
is rotated.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import NDArray

from cosserat.solvers.banded import Band, Mask, Vector
from cosserat.solvers.energy_momentum import rotate, rotate_band

if TYPE_CHECKING:
    from cosserat.solvers.system import ConfigurationSpace, MechanicalSystem

Fields = NDArray[np.float64]
T = TypeVar("T", np.float64, np.complex128)


@dataclass(frozen=True)
class Frame:
    """Pairs of components in frames of their own.

    first : (k,) the first DOF of each pair.  axes : (2, k) cosine and sine of the first axis of its frame.
    """

    first: NDArray[np.int64]
    axes: Fields

    @classmethod
    def of(cls, axes: Mapping[int, Vector]) -> Frame:
        """Frames by the first DOF of their pairs: the first axis, a unit vector (2,)."""
        first = sorted(axes)
        components = [[float(axes[number][part]) for number in first] for part in (0, 1)]
        return cls(np.array(first, dtype=np.int64), np.array(components))

    @property
    def oblique(self) -> bool:
        """Whether there is any pair."""
        return bool(self.first.size)

    def into(self, plain: NDArray[T]) -> NDArray[T]:
        """Components in the frames from those along the axes of space, (..., n)."""
        return self._rotated(plain, 1.0)

    def out(self, own: NDArray[T]) -> NDArray[T]:
        """Components along the axes of space from those in the frames, (..., n)."""
        return self._rotated(own, -1.0)

    def _rotated(self, values: NDArray[T], sense: float) -> NDArray[T]:
        if np.iscomplexobj(values):
            real, imaginary = (self._rotated(part, sense) for part in (values.real, values.imag))
            return np.asarray(real + 1j * imaginary, dtype=values.dtype)
        found: Fields = np.array(values, dtype=np.float64)
        for row in found.reshape(-1, found.shape[-1]):
            rotate(row, self.first, self.axes, sense)
        return found.astype(values.dtype, copy=False)

    def rotate(self, gradient: Vector, band: Band, skew: Band, sense: float) -> None:
        """Rotate a gradient and a Hessian, each if it has entries, in place: into the frames for 1, out for -1."""
        if gradient.size:
            rotate(gradient, self.first, self.axes, sense)
        for part, symmetric in ((band, True), (skew, False)):
            if part.size:
                rotate_band(part, self.first, self.axes, sense, symmetric)

    def band(self, plain: Band) -> Band:
        """A symmetric band in the frames from one along the axes of space."""
        found = plain.copy()
        rotate_band(found, self.first, self.axes, 1.0, True)
        return found

    def both(self, mask: Mask) -> Mask:
        """A mask with both components of a pair where it has one of them."""
        found = mask.copy()
        found[self.first] = found[self.first + 1] = mask[self.first] | mask[self.first + 1]
        return found


NO_FRAME = Frame.of({})
"""Every component along an axis of space."""


@dataclass(frozen=True)
class FramedSpace:
    """A configuration space in frames."""

    plain: ConfigurationSpace
    frame: Frame
    compiled: None = None

    @property
    def dimension(self) -> int:
        """The same."""
        return self.plain.dimension

    @cached_property
    def reference(self) -> Vector:
        """The reference configuration."""
        return self.frame.into(self.plain.reference)

    @cached_property
    def scale(self) -> Vector:
        """The larger size of both components of a pair."""
        scale, first = self.plain.scale.copy(), self.frame.first
        scale[first] = scale[first + 1] = np.maximum(scale[first], scale[first + 1])
        return scale

    def rigid_motions(self, q: Vector) -> Fields:
        """Velocities that deform nothing."""
        return self.frame.into(self.plain.rigid_motions(self.frame.out(q)))

    def max_step_fraction(self, q: Vector, step: Vector) -> float:
        """The same."""
        return self.plain.max_step_fraction(self.frame.out(q), self.frame.out(step))

    def rotation_weights(self, q: Vector) -> Vector:
        """The same, for both components of a pair."""
        return self.plain.rotation_weights(self.frame.out(q))

    def rates(self, q: Vector, change: Vector) -> Fields:
        """The same."""
        return self.plain.rates(self.frame.out(q), self.frame.out(change))

    def predicted(
        self, q: Vector, moved: Fields, prescribe: Callable[[Vector], Vector], constrained: Mask
    ) -> Vector:
        """The DOFs after given rotations and stretches of the parts."""
        found = self.plain.predicted(
            self.frame.out(q),
            moved,
            lambda plain: self.frame.out(prescribe(self.frame.into(plain))),
            self.frame.both(constrained),
        )
        return self.frame.into(found)

    def carried(self, change: Vector, constrained: Mask) -> Vector:
        """The part of a change that follows the supports without strain."""
        found = self.plain.carried(self.frame.out(change), self.frame.both(constrained))
        return self.frame.into(found)


def framed(system: MechanicalSystem, frame: Frame) -> MechanicalSystem:
    """The same body with its DOFs in frames; its constraints are already."""
    if not frame.oblique:
        return system
    return replace(
        system,
        internal=replace(system.internal, frame=frame),
        external=tuple(replace(load, frame=frame) for load in system.external),
        attached=tuple(replace(potential, frame=frame) for potential in system.attached),
        held=tuple(replace(load, frame=frame) for load in system.held),
        space=FramedSpace(system.space, frame),
        mass=None if system.mass is None else lambda: frame.band(system.inertia),
        frame=frame,
        plain=system,
        began=None if system.began is None else frame.into(system.began),
    )
