"""Strains without stress: pre-strains, prescribed extensions and temperatures.

derived: the consistent energy W(e) is quadratic in its measures e: axial strain, turning, stretch of the sections, its
gradient, and volume.  If the rod is without stress at e0, its energy is W(e - e0) = W(e) - e0 . C e + constant, C the
stiffnesses.  So e0 is a load with the potential -e0 . C e: constant stresses on the measures of the rod, which follow
it, in proportion to the load factor.

A temperature that changes by T in the middle of the section, and by T' per height towards the director, strains every
fibre by alpha (T + T' y): the axial strain is alpha T, the curvature -alpha T', and the section stretches by alpha T.
Where the sections keep their width (plane strain), 1 + nu times as much: the stress alpha T (3 Lambda + 2 mu) of the
solid over 2 (Lambda + mu).  For an incompressible section nu = 1/2.  Layers of several coefficients also bend under T
alone; see `rods.sections.composite`.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import Annotated, ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Quantity
from cosserat.rods.energies.reissner import Reissner, stressed
from cosserat.rods.loads.load import LoadedRod, Stretch
from cosserat.rods.rod import Rod
from cosserat.rods.sections.section import FreeStrains, expanded
from cosserat.rods.variation import Scales, mean, overlap, vertex_cuts
from cosserat.solvers.potential import Potential

Array = NDArray[np.float64]


def is_quadratic(rod: Rod) -> bool:
    """Whether the energy of a rod is quadratic in its strain measures."""
    return isinstance(rod.strain_energy, Reissner) and not rod.barrier


class StressFreeStrain(Stretch):
    """Strains, over a stretch of the rod, at which it is without stress."""

    causes: ClassVar[tuple[str, ...]]
    """The keys of which one at least is given."""

    @model_validator(mode="after")
    def _has_a_cause(self) -> Self:
        if not self.model_fields_set & {*self.causes}:
            raise PydanticCustomError(
                "cause", f"has no strain; give {' or '.join(map(repr, self.causes))}"
            )
        return self

    @abstractmethod
    def strains(self, rod: Rod, cuts: Array) -> FreeStrains:
        """The strains without stress of the parts of a rod between cuts (n + 1,) [m], each (n,)."""

    def check(self, rod: Rod, key: str) -> None:
        """Require a stretch of the rod, and an energy that is quadratic in its measures."""
        super().check(rod, key)
        if not is_quadratic(rod):
            raise PydanticCustomError(
                "energy",
                f"'{key}' needs rod.energy = 'consistent' without 'rod.barrier', which is quadratic in its strains; "
                "take that, or leave it out",
            )

    @classmethod
    def potential(cls, loads: Sequence[Self], body: LoadedRod) -> Potential:
        """Minus the work of the stresses that these strains would need."""
        arc = body.geometry.arc_length
        extension, curvature, section = (
            np.zeros(arc.size - 1),
            np.zeros(arc.size - 1),
            np.zeros(arc.size),
        )
        parts = vertex_cuts(arc)
        for load in loads:
            on_edges = overlap(arc, *load.ends(body.rod)) / np.diff(arc)
            round_vertices = load.covered(body) / np.diff(parts)
            strains = load.strains(body.rod, arc)
            extension += on_edges * strains.axial
            curvature += on_edges * strains.curvature
            section += round_vertices * load.strains(body.rod, parts).section
        energy = body.rod.strain_energy.potential(
            body.rod, body.geometry, displacements=body.origin is not None
        )
        return stressed(energy, extension, curvature, section)


def _confined(rod: Rod, cuts: Array) -> Array:
    """Poisson's ratio between cuts if the sections keep their width, else zero, (cuts - 1,)."""
    if rod.lateral_constraint == "free":
        return np.zeros(cuts.size - 1)
    if rod.lateral_constraint == "incompressible":
        return np.full(cuts.size - 1, 0.5)
    return mean(rod.stations, lambda scale, _: rod.poisson * scale.poisson, cuts)


class PreStrain(StressFreeStrain):
    """A prescribed extension or curvature, over a stretch of the rod, that needs no stress."""

    causes: ClassVar[tuple[str, ...]] = ("extension", "curvature", "section")
    extension: Annotated[float, Quantity("1", above=-1)] = 0.0
    """Axial strain without stress."""
    curvature: Annotated[float, Quantity("m^-1")] = 0.0
    """Curvature without stress, positive from E3 towards E2, in addition to that of the shape at rest."""
    section: Annotated[float, Quantity("1", above=-1)] = 0.0
    """Strain of the sections along their directors without stress."""

    def strains(self, rod: Rod, cuts: Array) -> FreeStrains:
        """As given."""
        same = np.ones(cuts.size - 1)
        return FreeStrains(self.extension * same, self.curvature * same, self.section * same)


class Temperature(StressFreeStrain):
    """A change of temperature over a stretch of the rod; sections expand as well as lengths."""

    causes: ClassVar[tuple[str, ...]] = ("change", "gradient")
    change: Annotated[float, Quantity("K")] = 0.0
    """Change of the temperature at the elastic centres of the sections, which are the area centres of one material."""
    gradient: Annotated[float, Quantity("K/m")] = 0.0
    """Increase of that change per height of the section, from the lower to the upper surface."""
    expansion: Annotated[float, Quantity("K^-1", r"\alpha")] | None = None
    """Coefficient of linear thermal expansion, the same everywhere; those of the materials by default."""

    def check(self, rod: Rod, key: str) -> None:
        """Require a coefficient of expansion here or in the materials."""
        super().check(rod, key)
        if self.expansion is None:
            rod.section.check_expansion(rod.material, key)

    def strains(self, rod: Rod, cuts: Array) -> FreeStrains:
        """Those of an expansion in all directions; layers of several materials also bend."""

        def free(scale: Scales, _: Array) -> Array:
            if self.expansion is not None:
                return np.stack(expanded(self.expansion, self.change, self.gradient, scale.height))
            return np.stack(rod.section.expand(rod.material, self.change, self.gradient, scale.height))

        return FreeStrains(*((1 + _confined(rod, cuts)) * mean(rod.stations, free, cuts)))
