"""What every strain energy of a rod offers; `cosserat.rods.energies.ENERGIES` lists them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from cosserat.rods.kinematics import PLANAR, Kinematics
from cosserat.rods.reference import Geometry
from cosserat.solution import Field
from cosserat.solvers.potential import Potential

if TYPE_CHECKING:
    from cosserat.rods.rod import Rod

Array = NDArray[np.float64]


class Energy(ABC):
    """One strain energy: its options, its potential, its mass and its own output.

    kinematics : the layout of its DOFs; the first two vectors of a vertex are its position and its director.
    options : fields of `Rod` that only this energy reads.
    far : whether sections may rotate by more than a quarter turn, and a path be followed past limit points.
    """

    kinematics: ClassVar[Kinematics] = PLANAR
    options: ClassVar[tuple[str, ...]] = ()
    far: ClassVar[bool] = False

    @abstractmethod
    def check(self, rod: Rod) -> None:
        """Raise PydanticCustomError where the options of a rod do not fit together."""

    @abstractmethod
    def potential(self, rod: Rod, geometry: Geometry, *, displacements: bool = False) -> Potential:
        """The energy in a reference configuration, zero there.

        displacements : its DOFs are displacements from the reference; if not, they are positions and directors.
        """

    def reference(self, geometry: Geometry) -> Array:
        """The DOFs (n,) in the reference configuration."""
        return geometry.q

    @abstractmethod
    def mass(self, rod: Rod, geometry: Geometry) -> Array:
        """The mass matrix as a symmetric band, (n, w)."""

    def fields(
        self, rod: Rod, geometry: Geometry, potential: Potential, u: Array, couples: float
    ) -> tuple[dict[str, tuple[str, ...]], dict[str, Field]]:
        """Labels and fields that only this energy has, of a state.

        potential : of displacements.  u : (n,) displacements [m].  couples : energy of the couples [J].
        """
        return {}, {}

    def shaped(self, rod: Rod, geometry: Geometry, x: Array, d: Array) -> Array:
        """Directors (N, 2) [m] with which a motion from x, d can begin: these, unless they set off vibrations."""
        return d
