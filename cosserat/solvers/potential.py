"""Potentials: energies and loads, in the one form that every solver uses.

A potential is a compiled function of the degrees of freedom (DOFs) with a gradient and a banded Hessian.  Its other
inputs are explicit: constants, internal variables that change only at accepted states, and strains that a time step
replaces by the means of its two ends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numba import types
from numpy.typing import NDArray

from cosserat.solvers.banded import NO_BAND, Band, Vector

if TYPE_CHECKING:
    from cosserat.solvers.frames import Frame

Bytes = NDArray[np.uint8]

ENERGY, GRADIENT, HESSIAN, STRAINS, COMMIT = range(5)
"""Tasks of a kernel."""

KERNEL = types.float64(
    types.float64[::1],
    types.float64[::1],
    types.uint8[::1],
    types.float64[::1],
    types.float64[:, ::1],
    types.int64,
    types.float64[::1],
    types.float64[:, ::1],
    types.float64[:, ::1],
    types.float64[::1],
)
"""A compiled potential:
(q, after, constants, history, strains, task, gradient, band, skew, terms) -> energy.

q : (n,) the DOFs.  constants : the bytes of a structured array.  history : the internal variables.
terms : is overwritten by the parts of the energy, except by COMMIT.

ENERGY : nothing else.  GRADIENT : adds the gradient.  HESSIAN : adds the gradient and the Hessian: its symmetric part
to `band`, and its skew part, the entries H[i, j] below the diagonal, to `skew` if that has rows.
STRAINS : overwrites `strains` by those at q.  COMMIT : overwrites `history` by the internal variables at q, an accepted
state.  The energy is infinite where the potential is not defined, as in a rod that has collapsed.

Where `after` has entries, q is the midpoint of a time step that ends at `after`, and `strains` are those of its start.
The energy is that of `after`.  The gradient is taken at the midpoint, with the stresses of the mean of the strains at
both ends.  The Hessian is that of the midpoint with these stresses, but with at least the tension and with the
pressures of the start: a transient stress in an iteration must not make it indefinite.
"""

NOTHING = np.empty(0)
_NO_STRAINS = np.empty((0, 0))


class Level(Protocol):
    """How a load depends on time: a factor."""

    @property
    def before_zero(self) -> float:
        """The factor just before time zero."""

    def value(self, t: Vector) -> Vector:
        """The factor at times (n,) [s]."""

    def means(self, times: Vector) -> Vector:
        """Means of the factor between neighbouring times, (n,) [s] -> (n - 1,)."""


@dataclass(frozen=True)
class Potential:
    """A potential of n DOFs.

    evaluate : the kernel, a function compiled by Numba that is called as `KERNEL` says.
    constants : a structured array for the kernel; its dtype names the fields.
    terms : names of the parts of the energy.
    half_bandwidth : largest distance of two DOFs that the Hessian couples; -1 where the potential is linear.
    history : (k,) the internal variables at the start.
    strains : shape of the strains that a time step replaces by their means.
    symmetric : whether there is an energy; if not, the kernel returns zero, and its gradient is minus a force.
    origin : (n,) added to q; None for zero.
    level : the factor of a load that depends on time; None for a constant load.
    frame : frames of their own of some pairs of DOFs, which the kernel does not know; None for none.
    sizes : names of the constants to which it is proportional, of a load.
    """

    evaluate: Callable[..., float]
    constants: NDArray[np.void]
    terms: tuple[str, ...]
    half_bandwidth: int
    history: Vector = field(default_factory=lambda: NOTHING)
    strains: tuple[int, int] = (0, 0)
    symmetric: bool = True
    origin: Vector | None = None
    level: Level | None = None
    frame: Frame | None = None
    sizes: tuple[str, ...] = ()

    def times(self, factor: float) -> Potential:
        """The potential times a factor, which does not depend on time."""
        assert self.sizes  # every load names them
        constants = self.constants.copy()
        for name in self.sizes:
            constants[name] *= factor
        return replace(self, constants=constants, level=None)

    @property
    def idle(self) -> bool:
        """Whether it is a load of no size."""
        return bool(self.sizes) and not any(self.constants[name].any() for name in self.sizes)

    @property
    def linear(self) -> bool:
        """Whether its gradient is the same everywhere."""
        return self.half_bandwidth < 0

    @cached_property
    def data(self) -> Bytes:
        """The constants as bytes."""
        return self.constants.view(np.uint8)

    def add(
        self, q: Vector, history: Vector, gradient: Vector, band: Band, skew: Band = NO_BAND
    ) -> float:
        """The energy [J] at q; adds the gradient (n,) [N] and the Hessian, its skew part if `skew` has rows."""
        return self._called(q, history, HESSIAN, gradient, band, skew)

    def add_stressed(
        self, q: Vector, elsewhere: Vector, history: Vector, gradient: Vector, band: Band, skew: Band
    ) -> float:
        """As `add` at q, but with the stresses of elsewhere; a potential without strains is taken elsewhere whole."""
        if not self.strains[0]:
            return self.add(elsewhere, history, gradient, band, skew)
        strains = np.zeros(self.strains)
        self._called(elsewhere, history, STRAINS, NOTHING, NO_BAND, NO_BAND, strains=strains)
        return self._called(q, history, HESSIAN, gradient, band, skew, after=elsewhere, strains=strains)

    def add_gradient(self, q: Vector, history: Vector, gradient: Vector) -> float:
        """The energy [J] at q; adds the gradient (n,) [N]."""
        return self._called(q, history, GRADIENT, gradient, NO_BAND, NO_BAND)

    def assemble(self, q: Vector, gradient: Vector, band: Band) -> float:
        """The energy [J] at q with the internal variables of the start; overwrites gradient and Hessian."""
        gradient[:], band[:, :] = 0.0, 0.0
        return self.add(q, self.history, gradient, band)

    def energy(self, q: Vector, history: Vector | None = None) -> float:
        """The energy [J] at q; history : the internal variables, those of the start by default."""
        history = self.history if history is None else history
        return self._called(q, history, ENERGY, NOTHING, NO_BAND, NO_BAND)

    def energy_terms(self, q: Vector) -> Vector:
        """The parts of the energy at q [J], in the order of `terms`."""
        terms = np.zeros(len(self.terms))
        self._called(q, self.history, ENERGY, NOTHING, NO_BAND, NO_BAND, terms)
        return terms

    def committed(self, q: Vector, history: Vector) -> Vector:
        """The internal variables (k,) at q, an accepted state, from those of the state before."""
        if not history.size:
            return history
        after = history.copy()
        self._called(q, after, COMMIT, NOTHING, NO_BAND, NO_BAND)
        return after

    def _called(
        self,
        q: Vector,
        history: Vector,
        task: int,
        gradient: Vector,
        band: Band,
        skew: Band,
        terms: Vector | None = None,
        after: Vector = NOTHING,
        strains: NDArray[np.float64] = _NO_STRAINS,
    ) -> float:
        if self.frame is not None:
            q, after = self.frame.out(q), self.frame.out(after) if after.size else after
            self.frame.rotate(gradient, band, skew, -1.0)
        if self.origin is not None:
            q, after = q + self.origin, after + self.origin if after.size else after
        terms = np.empty(len(self.terms)) if terms is None else terms
        energy = float(
            self.evaluate(q, after, self.data, history, strains, task, gradient, band, skew, terms)
        )
        if self.frame is not None:
            self.frame.rotate(gradient, band, skew, 1.0)
        return energy
