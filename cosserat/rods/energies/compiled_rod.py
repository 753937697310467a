"""What solvers ask of a rod whose energy is a compiled kernel, whichever energy that is."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from cosserat.solvers.banded import Band, Vector

Array = NDArray[np.float64]
_NO_MEASURES = np.empty((0, 4))
_ROOM = 8  # terms of a kernel, those of its couples included


class CompiledRod(ABC):
    """An energy with its gradient and banded Hessian, of directed rods with four numbers a vertex."""

    @property
    @abstractmethod
    def half_bandwidth(self) -> int:
        """Largest distance of two coupled DOFs."""

    @property
    @abstractmethod
    def kernel(self) -> object:
        """The compiled energy, for compiled solvers; `stepping.KERNEL` says what it takes."""

    @property
    @abstractmethod
    def parameters(self) -> Array:
        """What the kernel takes besides the DOFs."""

    @abstractmethod
    def evaluate(
        self, q: Vector, order: int, measures: Array, gradient: Vector, band: Band, terms: Array
    ) -> float:
        """The kernel at q, not in a step."""

    def assemble(self, q: Vector, gradient: Vector, band: Band) -> float:
        """Strain energy less the work of the couples [J] at q, shape (4 N,), from the reference on.

        Overwrites gradient and band.  The energy is infinite where the rod has collapsed; the kernel says when.
        """
        return self.evaluate(q, 2, _NO_MEASURES, gradient, band, np.empty(_ROOM))

    def differentiate(self, q: Vector, gradient: Vector) -> float:
        """The same energy [J]; overwrites its gradient, shape (4 N,) [N]."""
        return self.evaluate(q, 1, _NO_MEASURES, gradient, self._no_band, np.empty(_ROOM))

    def energy(self, q: Vector) -> float:
        """The same energy [J]."""
        return self.evaluate(q, 0, _NO_MEASURES, np.empty(0), self._no_band, np.empty(_ROOM))

    def energy_terms(self, q: Vector) -> Array:
        """The parts of the energy at q, in the order of the rod's `TERMS`, shape (7,) [J]."""
        terms = np.empty(_ROOM)
        self.evaluate(q, 0, _NO_MEASURES, np.empty(0), self._no_band, terms)
        return terms[:7]

    @property
    def _no_band(self) -> Band:
        return np.empty((0, self.half_bandwidth + 1))
