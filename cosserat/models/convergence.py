"""How the consistent rod approaches exact answers as its meshes are refined."""

from __future__ import annotations

from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat import analytic, elastica
from cosserat.models.calibration import beam_of
from cosserat.models.rod import PointForce
from cosserat.models.rod_statics import RodStatics
from cosserat.outcome import Outcome
from cosserat.parameters import Count, Parameters

Array = NDArray[np.float64]

MEASURES = (
    "clamped-free displacement",
    "clamped-free directors",
    "clamped-clamped mid-span",
    "necking section stretch",
    "elastica tip",
    "frequency 1",
    "frequency 2",
    "frequency 3",
    "frequency 4",
    "frequency 5",
)
"""What is compared, in the order of `errors`."""

_SMALL = 1e-4  # share of the weights taken: exact answers are linear
_TIP_FORCE = 10.0  # of the elastica, in EI / L^2


class Convergence(Parameters):
    """Problems with exact answers, and the numbers of vertices at which to solve them."""

    kind: Literal["convergence"] = "convergence"
    meshes: tuple[Annotated[int, Count("N", "3.3.1", at_least=5)], ...]
    clamped_free: RodStatics
    clamped_clamped: RodStatics
    necking: RodStatics
    slender: RodStatics
    """A clamped rod, of which the elastica and the frequencies are asked."""

    @model_validator(mode="after")
    def _odd(self) -> Self:
        if any(n % 2 == 0 for n in self.meshes):
            raise PydanticCustomError("odd", "'meshes' must be odd, so that a vertex stands at mid-span")
        return self

    def solve(self, name: str) -> Outcome:
        """Every measure at every mesh.

        Raises
        ------
        NotConvergedError : a solve on the way failed.
        """
        errors = np.array([self.errors(n, name) for n in self.meshes]).T
        fields = {"vertices": np.array(self.meshes, dtype=np.float64), "errors": errors}
        return Outcome(fields, {"meshes": len(self.meshes)})

    def errors(self, vertices: int, name: str) -> list[float]:
        """The measures at one mesh, in the order of `MEASURES`."""
        free, both = (_at(p, vertices, _SMALL) for p in (self.clamped_free, self.clamped_clamped))
        necking, slender = _at(self.necking, vertices, 1.0), _at(self.slender, vertices, 1.0)
        assert free.gravity is not None
        assert both.gravity is not None
        fields, beam, g = free.solve(name).fields, beam_of(free), free.gravity.g
        xi = fields["xi"]
        surface = free.rod.height / 2
        found = [
            _share(fields["u"][:, 1], analytic.clamped_free_displacement(beam, g, xi)),
            _share(fields["delta"][:, 0], surface * analytic.clamped_free_director(beam, g, xi)),
        ]
        middle = vertices // 2
        exact = analytic.clamped_clamped_displacement(beam_of(both), both.gravity.g, xi)[middle]
        found.append(abs(float(both.solve(name).fields["u"][middle, 1] / exact) - 1))
        beam, fields = beam_of(necking), necking.solve(name).fields
        strain = analytic.necking_strain(
            beam, necking.forces[-1].force, analytic.necking_decay(beam, "free section"), fields["xi"]
        )
        found.append(_share(fields["lam"] - 1, strain))
        beam = beam_of(slender)
        unit = beam.bending_stiffness / beam.length**2
        pulled = slender.replace(forces=(PointForce(at="last", along="E2", force=_TIP_FORCE * unit),))
        sideways, _ = elastica.shearable_tip(
            _TIP_FORCE, beam.axial_stiffness / unit, beam.shear_stiffness / unit
        )
        tip = float(pulled.solve(name).fields["u"][-1, 1]) / beam.length
        found.append(abs(tip / sideways - 1))
        computed = slender.modes(5).angular_frequency
        found.extend(np.abs(computed / elastica.timoshenko_frequencies(beam, 5) - 1).tolist())
        return found


def _at(posed: RodStatics, vertices: int, share: float) -> RodStatics:
    weight = posed.gravity
    if weight is not None:
        weight = weight.replace(g=share * weight.g)
    return posed.replace(rod=posed.rod.replace(vertices=vertices), gravity=weight)


def _share(computed: Array, exact: Array) -> float:
    """Largest deviation over the largest exact value."""
    return float(np.abs(computed - exact).max() / np.abs(exact).max())
