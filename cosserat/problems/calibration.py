"""The calibration of section 3.5 as a procedure: coefficients by least squares, and their sensitivities.

Each static problem is compared with its closed form along the whole rod; a misfit is a difference over the largest
ordinate.  The logarithms of the coefficients are fitted, which keeps them positive.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from cosserat.exact import beams
from cosserat.parameters import Count
from cosserat.problem import ALONE, Problem, Run
from cosserat.problems.needs import check_coefficients, check_pulled, check_weighed
from cosserat.problems.static import RodStatics
from cosserat.rods.problem import RodProblem
from cosserat.solution import Field, Solution

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

Array = NDArray[np.float64]

_LOG_RANGE = float(np.log(30.0))  # largest change of a fitted logarithm: some are hardly determined

_LOG_STEP = 1e-3  # of the logarithms, in a difference quotient

_RESOLVED = 1e-12  # least singular value over the largest that a difference quotient over that step can tell from zero

_UNDETERMINED = 1e6  # condition number from which on a fit says that a direction is not determined

Misfit = Callable[[Array], Array]
Curves = Callable[[str, RodStatics, str], tuple[Array, Array]]

ASSIGNED = {
    "hanging_bar": ("c1",),
    "clamped_free": ("c3", "c4", "c5"),
    "clamped_clamped": ("c3", "c4", "c5"),
    "necking": ("c2", "c6", "c7"),
}
"""Coefficients by the problem from which the thesis finds them."""

_GROUP = {
    "hanging_bar": "stretching",
    "clamped_free": "beam",
    "clamped_clamped": "beam",
    "necking": "section",
}
"""Name of the group of coefficients of a problem."""


class Calibration(Problem):
    """The four problems of section 3.5, fitted at one number of vertices."""

    kind: Literal["calibration"] = "calibration"
    vertices: Annotated[int, Count("N", "3.3.1", at_least=5, at_most=10_001)]
    """Number of vertices at which to calibrate."""
    hanging_bar: RodStatics
    """The bar that hangs under its weight, Fig. 3.8(a)."""
    clamped_free: RodStatics
    """The beam clamped at its first vertex, Fig. 3.8(b)."""
    clamped_clamped: RodStatics
    """The beam clamped at both ends, Fig. 3.8(c)."""
    necking: RodStatics
    """The bar pulled at both ends, Fig. 3.8(d)."""

    @model_validator(mode="after")
    def _have_closed_forms(self) -> Self:
        check_weighed("hanging_bar", self.hanging_bar, "E3", both_ends=False)
        check_weighed("clamped_free", self.clamped_free, "-E2", both_ends=False)
        check_weighed("clamped_clamped", self.clamped_clamped, "-E2", both_ends=True)
        check_pulled("necking", self.necking)
        for key, names in ASSIGNED.items():
            check_coefficients(key, getattr(self, key), names)
        return self

    def solve(self, name: str, run: Run = ALONE) -> Solution:
        """Fit every problem, and measure the published coefficients.

        Raises
        ------
        NotConvergedError : a solve on the way failed.
        """
        fields: dict[str, Field] = {}
        conditions: dict[str, float] = {}
        iterations = 0
        for number, problem in enumerate(ASSIGNED):
            fit = self.fit(problem, name)
            sizes, directions = sensitivities(self.misfit(problem, name), fit.x)
            direction = f"{_GROUP[problem]}_direction"
            fields |= _fitted(problem, _GROUP[problem], fit, sizes)
            fields[f"{problem}_directions"] = (
                (direction, f"{_GROUP[problem]}_coefficient"),
                directions,
            )
            fields[f"{problem}_published"] = ((), np.array(self._at_published(problem, name)))
            conditions[problem] = condition_number(sizes)
            iterations += int(fit.nfev)
            run.progress((number + 1) / (len(ASSIGNED) + 1), problem.replace("_", " "))
        both = self.fit_both_beams(name)
        run.progress(1.0, "both beams")
        fields |= _fitted("beams", "beam", both, np.linalg.svd(both.jac, compute_uv=False))
        conditions["beams"] = condition_of(both)
        labels = {f"{_GROUP[problem]}_coefficient": names for problem, names in ASSIGNED.items()}
        statistics = {
            "iterations": iterations + int(both.nfev),
            **{f"{fit}_condition_number": value for fit, value in conditions.items()},
        }
        return Solution(fields, statistics, labels, _undetermined(conditions))

    @classmethod
    def summary(cls, statistics: Mapping[str, int | float], sizes: Mapping[str, int]) -> str:
        """Number of iterations."""
        return f"{statistics['iterations']} iterations of the fits"

    def fit(self, problem: str, name: str) -> OptimizeResult:
        """Least squares over the coefficients of one problem, from the published ones."""
        return self.least_misfit(problem, self.misfit(problem, name))

    def fit_both_beams(self, name: str) -> OptimizeResult:
        """c3, c4, c5 from both beams at once, displacements and directors: "simultaneously", as in section 3.5."""
        parts = [
            self.misfit(problem, name, curves)
            for problem in ("clamped_free", "clamped_clamped")
            for curves in (_curves, _director_curves)
        ]

        def misfit(logarithms: Array) -> Array:
            every: Array = np.concatenate([part(logarithms) for part in parts])
            return every / float(np.sqrt(len(parts)))

        return self.least_misfit("clamped_free", misfit)

    def least_misfit(self, problem: str, misfit: Misfit) -> OptimizeResult:
        """Least squares of a misfit over the coefficients of a problem, from the published ones."""
        from scipy.optimize import least_squares

        published = getattr(self, problem).rod.calibration
        start = np.log([getattr(published, c) for c in ASSIGNED[problem]])
        return least_squares(
            misfit, start, bounds=(start - _LOG_RANGE, start + _LOG_RANGE), xtol=1e-10, ftol=1e-10
        )

    def misfit(self, problem: str, name: str, curves: Curves | None = None) -> Misfit:
        """Differences of one problem from its closed form, by the logarithms of its coefficients."""
        coefficients = ASSIGNED[problem]

        def misfit(logarithms: Array) -> Array:
            values = dict(zip(coefficients, np.exp(logarithms), strict=True))
            computed, exact = (curves or _curves)(problem, self._meshed(problem, values), name)
            difference: Array = computed - exact
            relative: Array = difference / (np.abs(exact).max() * np.sqrt(exact.size))
            return relative

        return misfit

    def _meshed(self, problem: str, values: Mapping[str, float]) -> RodStatics:
        """One of the problems on the mesh, with other values of its coefficients."""
        case: RodStatics = getattr(self, problem)
        assert case.rod.calibration is not None
        calibration = case.rod.calibration.replace(**values)
        return case.replace(rod=case.rod.replace(vertices=self.vertices, calibration=calibration))

    def _at_published(self, problem: str, name: str) -> float:
        """Computed over exact at the tip or at mid-span, with the published coefficients."""
        computed, exact = _curves(problem, self._meshed(problem, {}), name)
        place = -1 if problem in ("hanging_bar", "clamped_free") else (exact.size - 1) // 2
        return float(computed[place] / exact[place])


def _fitted(of: str, group: str, fit: OptimizeResult, sizes: Array) -> dict[str, Field]:
    """Coefficients, misfit and singular values of a fit."""
    return {
        f"{of}_coefficients": ((f"{group}_coefficient",), np.exp(fit.x)),
        f"{of}_misfit": ((), np.array(np.sqrt(2 * fit.cost))),
        f"{of}_singular_values": ((f"{group}_direction",), sizes),
    }


def sensitivities(misfit: Misfit, logarithms: Array) -> tuple[Array, Array]:
    """Sensitivity of a misfit along orthogonal directions in log c, (k,), largest first; these as rows, (k, k).

    By central differences over a thousandth, where the round-off of a solve does not matter.  The largest entry of
    each direction is positive.
    """
    steps = _LOG_STEP * np.eye(logarithms.size)
    slopes = [
        (misfit(logarithms + step) - misfit(logarithms - step)) / (2 * _LOG_STEP) for step in steps
    ]
    _, size, directions = np.linalg.svd(np.column_stack(slopes), full_matrices=False)
    largest = np.take_along_axis(directions, np.abs(directions).argmax(axis=1)[:, None], axis=1)
    return size, directions * np.sign(largest)


def condition_number(sizes: Array) -> float:
    """Largest over least singular value of a fit, the largest first; 1e12 if the least cannot be told from zero.

    A round-off in the misfit moves the fitted logarithms by up to as many times as much.  Three digits.
    """
    return float(f"{sizes[0] / max(sizes[-1], _RESOLVED * sizes[0]):.3g}")


def condition_of(fit: OptimizeResult) -> float:
    """Condition number of a fit by its own derivative of the misfit."""
    return condition_number(np.linalg.svd(fit.jac, compute_uv=False))


def _undetermined(conditions: Mapping[str, float]) -> tuple[str, ...]:
    """The warning about fits that leave a direction to round-off, by the condition number of each fit."""
    loose = [
        f"{fit.replace('_', ' ')} {value:.0e}"
        for fit, value in conditions.items()
        if value >= _UNDETERMINED
    ]
    if not loose:
        return ()
    return (
        f"coefficients: a direction of log c is not determined by the fits with these condition numbers: "
        f"{', '.join(loose)}; along it a coefficient follows the start and the round-off, "
        "so use what the others determine, or compare misfits",
    )


def _curves(problem: str, case: RodStatics, name: str) -> tuple[Array, Array]:
    fields = case.solve(name)
    beam, xi = beam_of(case), fields["xi"]
    if problem == "necking":
        beta = beams.necking_decay(beam, "printed")
        return fields["lam"] - 1, beams.necking_strain(beam, case.forces[-1].force, beta, xi)
    axis, exact = _FORMULAS[problem]
    assert case.gravity is not None
    return fields["u"][:, axis], exact(beam, case.gravity.g, xi)


def _director_curves(problem: str, case: RodStatics, name: str) -> tuple[Array, Array]:
    """delta . E3 at the lateral surface of a beam, computed and by eqs. (3.5.4), (3.5.7) [m]."""
    fields, exact = case.solve(name), _DIRECTORS[problem]
    assert case.gravity is not None
    directors = exact(beam_of(case), case.gravity.g, fields["xi"])
    return fields["delta"][:, 0], case.rod.height / 2 * directors


_DIRECTORS: dict[str, beams.BeamCurve] = {
    "clamped_free": beams.clamped_free_director,
    "clamped_clamped": beams.clamped_clamped_director,
}

_FORMULAS: dict[str, tuple[int, Callable[[beams.Beam, float, Array], Array]]] = {
    "hanging_bar": (0, beams.hanging_bar_displacement),
    "clamped_free": (1, beams.clamped_free_displacement),
    "clamped_clamped": (1, beams.clamped_clamped_displacement),
}


def beam_of(problem: RodProblem) -> beams.Beam:
    """The beam for the closed forms: A and I of the section itself, not the averages of the rod."""
    rod, section = problem.rod, problem.rod.homogeneous[0]
    return beams.Beam(
        length=rod.length,
        area=section.area,
        second_moment=section.second_moment,
        young=rod.young,
        poisson=rod.poisson,
        line_density=rod.line_density,
        shear_correction=rod.shear_correction,
    )
