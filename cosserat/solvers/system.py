"""A body under loads: the one object that statics, continuation, motion and modes take.

The solvers do not depend on the meaning of the degrees of freedom (DOFs), except through a `ConfigurationSpace`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np
from numba.core.dispatcher import Dispatcher
from numpy.typing import NDArray

from cosserat.solvers.banded import Band, Mask, Vector
from cosserat.solvers.damping import NO_MODES, DampedModes, damped_like
from cosserat.solvers.frames import NO_FRAME, Frame
from cosserat.solvers.members import Members
from cosserat.solvers.potential import Level, Potential

if TYPE_CHECKING:
    from cosserat.solvers.tangent import Tangent

Fields = NDArray[np.float64]
History = tuple[Vector, ...]
"""The internal variables of every potential of a system."""


class Constraints(Protocol):
    """Constrained DOFs and their prescribed displacements."""

    @property
    def mask(self) -> Mask:
        """Which DOFs are constrained, shape (n,)."""

    @property
    def moving(self) -> bool:
        """Whether some constrained DOFs move."""

    @property
    def max_increment(self) -> float:
        """Largest change of the load factor in one increment."""

    def at_load(self, factor: float) -> tuple[Vector, Vector]:
        """Displacement of the constrained DOFs at a load factor, and its derivative, each (n,)."""

    def at_time(self, time: float) -> tuple[Vector, Vector, Vector]:
        """Displacement, velocity and acceleration of the constrained DOFs at a time [s], each (n,)."""


class CompiledSpace(NamedTuple):
    """A configuration space for compiled code.

    kernel : `solvers.members.SPACE_KERNEL`.  placed : (n,) its second argument.  parts : number of parts that turn.
    """

    kernel: Callable[..., float]
    placed: Vector
    parts: int


class ConfigurationSpace(Protocol):
    """Properties of the DOFs that solvers need."""

    @property
    def dimension(self) -> int:
        """The DOFs are components of vectors of a space of this dimension, one vector after the other."""

    @property
    def compiled(self) -> CompiledSpace | None:
        """It for compiled code; None if there is no such code."""

    @property
    def reference(self) -> Vector:
        """The DOFs (n,) of the reference configuration."""

    @property
    def scale(self) -> Vector:
        """Sizes (n,) that set the round-off of the energy, however small the DOFs are."""

    def rigid_motions(self, q: Vector) -> Fields:
        """Velocities that deform nothing, shape (k, n), the translations first."""

    def max_step_fraction(self, q: Vector, step: Vector) -> float:
        """Largest fraction of a step that rotates no part by more than a radian."""

    def rotation_weights(self, q: Vector) -> Vector:
        """One over the lengths of the vectors whose change is a rotation, zero for other DOFs, (n,)."""

    def rates(self, q: Vector, change: Vector) -> Fields:
        """Rates of rotation [rad] and stretch of the parts of the body as the DOFs change, (parts, k)."""

    def predicted(
        self, q: Vector, moved: Fields, prescribe: Callable[[Vector], Vector], constrained: Mask
    ) -> Vector:
        """The DOFs after given rotations and stretches of the parts, with prescribed DOFs in place."""

    def carried(self, change: Vector, constrained: Mask) -> Vector:
        """The part of a change of the DOFs that follows the supports without strain."""


@dataclass(frozen=True)
class MechanicalSystem:
    """A body, its loads, its constraints and its mass.

    internal : the energy of the body.  external : its loads; a load factor multiplies all of them.
    damping_rate, damping_time : c [1/s] and T [s] of the force -c M v - T K v, K the stiffness of the material alone.
    damped_modes : modes that are damped on their own.
    mass : gives the symmetric band (n, w + 1) when it is asked for; None for statics.
    attached : energies of what the body is attached to, such as springs; no load factor multiplies them.
    frame : frames of some pairs of DOFs.  plain : the same body without them, if there are some.
    began : (n,) the equilibrium from which its loads grow; None for the reference.
    held : loads of that equilibrium, which no load factor multiplies.
    """

    internal: Potential
    external: tuple[Potential, ...]
    constraints: Constraints
    space: ConfigurationSpace
    mass: Callable[[], Band] | None = None
    damping_rate: float = 0.0
    attached: tuple[Potential, ...] = ()
    frame: Frame = NO_FRAME
    plain: MechanicalSystem | None = None
    damping_time: float = 0.0
    damped_modes: DampedModes = NO_MODES
    began: Vector | None = None
    held: tuple[Potential, ...] = ()

    @property
    def start(self) -> Vector:
        """The DOFs (n,) from which its loads grow."""
        return self.space.reference if self.began is None else self.began

    @property
    def unframed(self) -> MechanicalSystem:
        """The same body with its DOFs along the axes of space, for what is said of a state."""
        return self if self.plain is None else damped_like(self, self.plain)

    @cached_property
    def own(self) -> tuple[Potential, ...]:
        """The energies that no load factor multiplies."""
        return (self.internal, *self.attached, *self.held)

    @cached_property
    def potentials(self) -> tuple[Potential, ...]:
        """The energy of the body, of what it is attached to, of loads that are held, and of its loads."""
        return (*self.own, *self.external)

    @property
    def constrained(self) -> Mask:
        """Which DOFs are constrained, shape (n,)."""
        return self.constraints.mask

    @property
    def history(self) -> History:
        """The internal variables at the start."""
        return tuple(potential.history for potential in self.potentials)

    @cached_property
    def _remembers(self) -> bool:
        """Whether some potential has internal variables."""
        return any(potential.history.size for potential in self.potentials)

    @property
    def half_bandwidth(self) -> int:
        """Largest distance of two DOFs that are coupled."""
        return max(potential.half_bandwidth for potential in self.potentials)

    @property
    def symmetric(self) -> bool:
        """Whether all its forces have a potential."""
        return all(potential.symmetric for potential in self.potentials)

    @cached_property
    def simple(self) -> bool:
        """Whether it is one compiled potential under dead loads, and its constrained DOFs stay where they are."""
        own, compiled = self.internal, self.space.compiled is not None
        compiled &= isinstance(own.evaluate, Dispatcher)  # else it is plain Python
        plain = not (self.attached or self.held or self.frame.oblique or self.constraints.moving)
        elastic = own.symmetric and not own.history.size and own.level is None
        return (
            compiled
            and plain
            and elastic
            and self.began is None
            and not self.damping_rate
            and all(p.linear and p.level is None and not p.history.size for p in self.external)
        )

    @cached_property
    def member(self) -> Members:
        """A simple one as an array of one for `solvers.climb`."""
        own, space = self.internal, self.space
        assert space.compiled is not None
        origin = np.zeros(self.constrained.size) if own.origin is None else own.origin
        return Members(
            own.data[None],
            origin[None],
            space.compiled.placed[None],
            space.scale[None],
            self.start[None],
            self.dead_load[None],
            np.array([self.load_sizes]),
        )

    @cached_property
    def inertia(self) -> Band:
        """The mass of a body that moves."""
        assert self.mass is not None  # problems in motion and of vibration give one
        return self.mass()

    @cached_property
    def _reference_loads(self) -> tuple[Vector, Vector]:
        """At the reference: the force of the linear loads, and the sizes of all loads, each (n,) [N]."""
        dead, size = np.zeros(self.constrained.size), np.zeros(self.constrained.size)
        for load in self.external:
            force = self._force_at_reference(load)
            size += np.abs(force)
            if load.linear and load.level is None:
                dead += force
        return dead, size

    def _force_at_reference(self, load: Potential) -> Vector:
        gradient = np.zeros(self.constrained.size)
        load.add_gradient(self.space.reference, load.history, gradient)
        return -gradient

    @property
    def dead_load(self) -> Vector:
        """The force of the linear loads that do not depend on time, the same everywhere and always, (n,) [N]."""
        return self._reference_loads[0]

    @cached_property
    def varied_loads(self) -> tuple[tuple[Level, Vector], ...]:
        """Linear loads that depend on time: their factors and forces (n,) [N]."""
        return tuple(
            (load.level, self._force_at_reference(load))
            for load in self.external
            if load.linear and load.level is not None
        )

    def forces_at(self, q: Vector, history: History, time: float) -> Vector:
        """The force (n,) [N] of the loads that depend on time or have no potential."""
        force, when = np.zeros(self.constrained.size), np.array([time])
        for level, given in self.varied_loads:
            force += float(level.value(when)[0]) * given
        for number, load in self._nonlinear_loads:
            if load.level is not None or not load.symmetric:
                gradient = np.zeros_like(force)
                load.add_gradient(q, history[number], gradient)
                force -= gradient if load.level is None else float(load.level.value(when)[0]) * gradient
        return force

    @cached_property
    def _nonlinear_loads(self) -> tuple[tuple[int, Potential], ...]:
        """The loads that are not linear, with their numbers among the potentials."""
        return tuple((k, load) for k, load in enumerate(self.external, len(self.own)) if not load.linear)

    @cached_property
    def load_sizes(self) -> tuple[float, float]:
        """The largest force and the sum of all forces of the loads at the reference [N]."""
        size = self._reference_loads[1]
        return float(size.max()), float(size.sum())

    def prepared(self) -> MechanicalSystem:
        """The same, with what every solver asks for computed: sizes of loads and of DOFs, and it for compiled code."""
        for known in (self.load_sizes, self.potentials, self.space.scale, self.simple and self.member):
            assert known is not None
        return self

    def unloaded(self) -> MechanicalSystem:
        """The same body without loads, as it is attached."""
        plain = None if self.plain is None else self.plain.unloaded()
        return replace(self, external=(), plain=plain)

    def nonlinear_load_energy(self, q: Vector, history: History) -> float:
        """The energy of the loads that are neither linear nor depend on time [J]."""
        constant = [(number, load) for number, load in self._nonlinear_loads if load.level is None]
        return float(sum(load.energy(q, history[number]) for number, load in constant))

    def attached_energy(self, q: Vector, history: History) -> float:
        """The energy of what the body is attached to [J]."""
        attached = zip(self.attached, history[1 : 1 + len(self.attached)], strict=True)
        return float(sum(potential.energy(q, own) for potential, own in attached))

    def attached_force(self, q: Vector, history: History) -> Vector:
        """The force of what the body is attached to, (n,) [N]."""
        gradient = np.zeros(self.constrained.size)
        for potential, own in zip(self.attached, history[1:], strict=False):
            potential.add_gradient(q, own, gradient)
        return -gradient

    def add_gradient(self, q: Vector, history: History, gradient: Vector) -> None:
        """Add the gradient (n,) [N] of all that has a potential which does not depend on time."""
        gradient -= self.dead_load
        for potential, own in zip(self.potentials, history, strict=True):
            if not potential.linear and potential.level is None and potential.symmetric:
                potential.add_gradient(q, own, gradient)

    def assemble(
        self,
        q: Vector,
        history: History,
        factor: float,
        tangent: Tangent,
        *,
        about: Vector | None = None,
    ) -> bool:
        """Overwrite the tangent at q and a load factor, without loads that depend on time.

        about : (n,) the place where the body has its stiffness, under its stresses at q; q by default.
        False if a potential is not defined there.
        """
        tangent.clear()
        matrices = tangent.gradient, tangent.band, tangent.skew
        if about is None:
            energy = self.internal.add(q, history[0], *matrices)
        else:
            energy = self.internal.add_stressed(about, q, history[0], *matrices)
        if len(self.own) > 1:
            for potential, known in zip(self.own[1:], history[1:], strict=False):
                energy += potential.add(q, known, tangent.gradient, tangent.band, tangent.skew)
        np.negative(self.dead_load, out=tangent.load_gradient)
        for number, load in self._nonlinear_loads:
            if load.level is None:
                own = history[number]
                energy += load.add(q, own, tangent.load_gradient, tangent.load_band, tangent.load_skew)
        tangent.add_load(factor)
        return isfinite(energy)

    def committed(self, q: Vector, history: History) -> History:
        """The internal variables at q, an accepted state, from those of the state before."""
        if not self._remembers:
            return history
        return tuple(p.committed(q, own) for p, own in zip(self.potentials, history, strict=True))

    def prescribe(self, q: Vector, factor: float) -> Vector:
        """q with its constrained DOFs as prescribed at a load factor."""
        return np.where(self.constrained, self.space.reference + self.constraints.at_load(factor)[0], q)

    def predicted(self, q: Vector, moved: Fields, factor: float) -> Vector:
        """The DOFs at a load factor after given rotations and stretches of the parts."""
        return self.space.predicted(q, moved, lambda u: self.prescribe(u, factor), self.constrained)

    def prescribed_rate(self, factor: float) -> Vector:
        """Change of the constrained DOFs with the load factor, zero elsewhere, (n,)."""
        return self.constraints.at_load(factor)[1]

    def rate(self, factor: float, tangent: Tangent) -> Vector:
        """Derivative of the gradient by the load factor, (n,), at the last assembled tangent."""
        if not self.constraints.moving:
            return tangent.load_gradient.copy()
        return tangent.load_gradient + tangent.product(self.prescribed_rate(factor))
