"""Errors of the consistent rod against exact answers at one mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.exact import beams, elastica
from cosserat.parameters import Count
from cosserat.problem import ALONE, Problem, Run
from cosserat.problems.calibration import beam_of
from cosserat.problems.needs import check_pulled, check_slender, check_weighed
from cosserat.problems.static import RodStatics
from cosserat.rods.loads.dead import PointForce
from cosserat.solution import Solution

Array = NDArray[np.float64]
Formula = Callable[[beams.Beam, float, Array], Array]

MEASURES = (
    "clamped-free displacement",
    "clamped-free directors",
    "clamped-clamped displacement",
    "necking section stretch",
    "elastica displacement, P = 1",
    "elastica displacement, P = 5",
    "elastica displacement, P = 10",
    "elastica directors, P = 10",
    "frequency 1",
    "frequency 2",
    "frequency 3",
    "frequency 4",
    "frequency 5",
)
"""Compared quantities, in the order of `errors`; clamped-clamped directors are exact at the vertices of every mesh."""

_WEIGHT_FRACTION = 1e-4  # fraction of the weights: exact answers are linear
_TIP_FORCES = (1.0, 5.0, 10.0)  # of the elastica, in EI / L^2


class DiscretizationErrors(Problem):
    """Problems with exact answers, compared with them at one number of vertices."""

    kind: Literal["discretization errors"] = "discretization errors"
    vertices: Annotated[int, Count("N", "3.3.1", at_least=5, at_most=10_001)]
    """Number of vertices; odd, so that a vertex is at mid-span."""
    clamped_free: RodStatics
    """A beam clamped at its first vertex, under its weight."""
    clamped_clamped: RodStatics
    """A beam clamped at both ends, under its weight."""
    necking: RodStatics
    """A bar pulled at both ends, its end sections fixed."""
    slender: RodStatics
    """Clamped slender rod for the elastica and the natural frequencies."""

    @model_validator(mode="after")
    def _odd(self) -> Self:
        if self.vertices % 2 == 0:
            raise PydanticCustomError(
                "odd",
                f"'vertices' is {self.vertices}; it must be odd, so that a vertex is at mid-span",
            )
        return self

    @model_validator(mode="after")
    def _have_closed_forms(self) -> Self:
        check_weighed("clamped_free", self.clamped_free, "-E2", both_ends=False)
        check_weighed("clamped_clamped", self.clamped_clamped, "-E2", both_ends=True)
        check_pulled("necking", self.necking)
        check_slender("slender", self.slender)
        return self

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """Every measure.

        Raises
        ------
        NotConvergedError : a solve on the way failed.
        """
        free, both = (
            self._meshed(p, _WEIGHT_FRACTION) for p in (self.clamped_free, self.clamped_clamped)
        )
        necking, slender = (self._meshed(p, 1.0) for p in (self.necking, self.slender))
        exact = elastica.timoshenko_frequencies(beam_of(slender), 5)
        displacement, director = beams.clamped_clamped_displacement, beams.clamped_clamped_director
        errors = [
            *_beam_errors(free, beams.clamped_free_displacement, beams.clamped_free_director, name),
            _beam_errors(both, displacement, director, name)[0],
            _necking_error(necking, name),
            *_large_deflection(slender, name),
            *np.abs(slender.modes(5).angular_frequency / exact - 1),
        ]
        return Solution({"errors": (("measure",), np.array(errors))}, {}, {"measure": MEASURES})

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """Number of measures."""
        return f"{sizes['measure']} errors"

    def _meshed(self, problem: RodStatics, fraction: float) -> RodStatics:
        """One of the problems on the mesh, with a fraction of its weight."""
        weight = problem.gravity
        if weight is not None:
            weight = weight.replace(g=fraction * weight.g)
        return problem.replace(rod=problem.rod.replace(vertices=self.vertices), gravity=weight)


def _beam_errors(
    problem: RodStatics, displacement: Formula, director: Formula, name: str
) -> list[float]:
    """Errors of displacement and directors of a beam under its weight."""
    assert problem.gravity is not None
    fields, beam, g = problem.solve(name), beam_of(problem), problem.gravity.g
    return [
        _relative_error(fields["u"][:, 1], displacement(beam, g, fields["xi"])),
        _relative_error(fields["delta"][:, 0], problem.rod.height / 2 * director(beam, g, fields["xi"])),
    ]


def _necking_error(problem: RodStatics, name: str) -> float:
    beam, fields = beam_of(problem), problem.solve(name)
    decay = beams.necking_decay(beam, "free section")
    strain = beams.necking_strain(beam, problem.forces[-1].force, decay, fields["xi"])
    return _relative_error(fields["lam"] - 1, strain)


def _large_deflection(problem: RodStatics, name: str) -> list[float]:
    """Errors of displacement under each tip force, and of the directors under the last."""
    beam = beam_of(problem)
    unit = beam.bending_stiffness / beam.length**2
    found = []
    for force in _TIP_FORCES:
        pulled = problem.replace(forces=(PointForce(at="last", along="E2", force=force * unit),))
        fields = pulled.solve(name)
        s = np.minimum(fields["xi"] / beam.length, 1.0)
        shape = elastica.shearable_shape(
            force, beam.axial_stiffness / unit, beam.shear_stiffness / unit, s
        )
        place = beam.length * shape[:, :2]
        found.append(_relative_error(fields["u"], place - fields["x_ref"]))
    upright = problem.rod.height / 2 * np.column_stack([-np.sin(shape[:, 2]), np.cos(shape[:, 2])])
    return [*found, _relative_error(fields["delta"], upright - fields["d_ref"])]


def _relative_error(computed: Array, exact: Array) -> float:
    """Largest deviation over the largest exact value."""
    return float(np.abs(computed - exact).max() / np.abs(exact).max())
