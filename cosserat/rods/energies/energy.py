"""The interface of the strain energies of a rod; `cosserat.rods.energies.ENERGIES` lists them."""

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
    between : fields of the constants with the stiffnesses of an edge that couple its two directors, for the contact
        director forces; without them these are not stored.
    large_rotations : whether sections may rotate by more than a quarter turn and paths may pass limit points.
    true_normals : whether the directors at rest are normal to the curve itself, not to the vertex tangents (3.3.9).
    """

    kinematics: ClassVar[Kinematics] = PLANAR
    options: ClassVar[tuple[str, ...]] = ()
    between: ClassVar[tuple[str, ...]] = ()
    large_rotations: ClassVar[bool] = False
    true_normals: ClassVar[bool] = False

    @abstractmethod
    def check(self, rod: Rod) -> None:
        """Raise PydanticCustomError if the options of a rod contradict each other."""

    @abstractmethod
    def potential(self, rod: Rod, geometry: Geometry, *, displacements: bool = False) -> Potential:
        """The energy, zero in the reference configuration.

        displacements : its DOFs are displacements from the reference; if not, they are positions and directors.
        """

    def reference(self, geometry: Geometry) -> Array:
        """The DOFs (n,) in the reference configuration."""
        return geometry.q

    @abstractmethod
    def mass(self, rod: Rod, geometry: Geometry) -> Array:
        """The mass matrix as a symmetric band, (n, w)."""

    def fields(
        self, rod: Rod, geometry: Geometry, potential: Potential, u: Array, couples: Array
    ) -> tuple[dict[str, tuple[str, ...]], dict[str, Field]]:
        """Labels, and fields of states that only this energy has; their dimensions are those of one state.

        potential : of displacements.  u : (S, n) displacements [m].  couples : (S,) energy of the couples [J].
        """
        return {}, {}

    def start_directors(self, rod: Rod, geometry: Geometry, x: Array, d: Array) -> Array:
        """Directors (N, 2) [m] at the start of a motion from x, d: d itself, unless it would excite vibrations."""
        return d
