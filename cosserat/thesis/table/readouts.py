"""Named read-outs: from a Dataset one measured number and, if there is a closed form, the expected number.

A row of `results/tolerances.csv` names its read-out here.  Relative deviations of a curve are the largest over the
vertices divided by the largest ordinate of the closed form.  Closed forms take their beam and loads from
`thesis.table.printed`, not from the solved case, unless another beam is given.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.errors import InputError
from cosserat.exact import beams, elastica
from cosserat.problems.calibration import beam_of
from cosserat.rods.problem import RodProblem
from cosserat.thesis.table import crawl_readouts, printed
from cosserat.thesis.table.reading import Measurement

Array = NDArray[np.float64]

SLENDERNESS = 0.005
"""Radius over length of our slender rods; their square sections have the bending stiffness of a circle."""


def weight_of(problem: RodProblem) -> float:
    """g of a problem under its own weight [m/s^2]."""
    assert problem.gravity is not None
    return problem.gravity.g


def tension_of(problem: RodProblem) -> float:
    """n of a bar pulled at its last vertex [N]."""
    return problem.forces[-1].force


def midspan(values: Array) -> float:
    """The value at mid-span: of the middle vertex, or the mean of the two nearest it if their number is even."""
    half = values.size // 2
    return float(values[half] if values.size % 2 else values[half - 1 : half + 1].mean())


def vertices_of(data: xr.Dataset, beam: beams.Beam) -> Array:
    """Arc lengths of the vertices of a uniform rod of the beam's length, shape (N,) [m]."""
    return np.linspace(0.0, beam.length, data.sizes["vertex"])


def half_height(beam: beams.Beam) -> float:
    """Distance of the lateral surface of a rectangle from its middle, H/2 = sqrt(3 I / A) [m]."""
    return float(np.sqrt(3 * beam.second_moment / beam.area))


def _under_weight(
    data: xr.Dataset, case: str, curve: beams.BeamCurve, beam: beams.Beam | None
) -> tuple[beams.Beam, Array]:
    """The printed beam, unless another is given, and its closed form under the printed g."""
    beam = beam or printed.beam(case)
    return beam, curve(beam, printed.number(case, "gravity.g"), vertices_of(data, beam))


def hanging_bar_curve(data: xr.Dataset, beam: beams.Beam | None = None) -> tuple[Array, Array]:
    """u . E3 at the vertices, computed and by eq. (3.5.2) [m]."""
    _, exact = _under_weight(data, "hanging_bar", beams.hanging_bar_displacement, beam)
    return data.u.sel(axis="E3").to_numpy(), exact


def clamped_free_curve(data: xr.Dataset, beam: beams.Beam | None = None) -> tuple[Array, Array]:
    """u . E2 at the vertices, computed and by eq. (3.5.3) [m]."""
    _, exact = _under_weight(data, "clamped_free", beams.clamped_free_displacement, beam)
    return data.u.sel(axis="E2").to_numpy(), exact


def clamped_free_directors(data: xr.Dataset, beam: beams.Beam | None = None) -> tuple[Array, Array]:
    """delta . E3 at the lateral surface, computed and by eqs. (3.5.1), (3.5.4) [m]."""
    beam, exact = _under_weight(data, "clamped_free", beams.clamped_free_director, beam)
    return data.delta.sel(axis="E3").to_numpy(), exact * half_height(beam)


def clamped_clamped_curve(data: xr.Dataset, beam: beams.Beam | None = None) -> tuple[Array, Array]:
    """u . E2 at the vertices, computed and by eq. (3.5.6) [m]."""
    _, exact = _under_weight(data, "clamped_clamped", beams.clamped_clamped_displacement, beam)
    return data.u.sel(axis="E2").to_numpy(), exact


def clamped_clamped_directors(data: xr.Dataset, beam: beams.Beam | None = None) -> tuple[Array, Array]:
    """delta . E3 at the lateral surface, computed and by eqs. (3.5.1), (3.5.7) [m]."""
    beam, exact = _under_weight(data, "clamped_clamped", beams.clamped_clamped_director, beam)
    return data.delta.sel(axis="E3").to_numpy(), exact * half_height(beam)


def necking_curve(
    data: xr.Dataset,
    theory: beams.NeckingTheory = "printed",
    beam: beams.Beam | None = None,
) -> tuple[Array, Array]:
    """lambda - 1 at the vertices, computed and by eq. (3.5.8) with beta of the named theory [1]."""
    beam = beam or printed.beam("necking")
    beta = beams.necking_decay(beam, theory)
    pull = printed.number("necking", "forces.1.force")
    exact = beams.necking_strain(beam, pull, beta, vertices_of(data, beam))
    return data.lam.to_numpy() - 1, exact


def at_tip(curves: tuple[Array, Array]) -> Measurement:
    """Both curves at the last vertex."""
    return Measurement(float(curves[0][-1]), float(curves[1][-1]))


def at_midspan(curves: tuple[Array, Array]) -> Measurement:
    """Both curves at mid-span."""
    return Measurement(midspan(curves[0]), midspan(curves[1]))


def largest_deviation(curves: tuple[Array, Array]) -> Measurement:
    """Largest deviation of two curves over the largest ordinate of the second."""
    computed, exact = curves
    return Measurement(float(np.abs(computed - exact).max() / np.abs(exact).max()), 0.0)


def period(times: Array, values: Array) -> float:
    """Period of the sinusoid that fits a record best, in least squares, near its strongest line [s]."""
    from scipy.optimize import minimize_scalar  # takes 0.3 s: only here

    line = np.abs(np.fft.rfft(values - values.mean()))
    step = times[1] - times[0]
    strongest = 2 * np.pi * (1 + int(line[1:].argmax())) / (step * times.size)
    width = 2 * np.pi / (step * times.size)

    def misfit(omega: float) -> float:
        columns = np.column_stack([np.ones_like(times), np.cos(omega * times), np.sin(omega * times)])
        return float(((values - columns @ np.linalg.lstsq(columns, values, rcond=None)[0]) ** 2).sum())

    best = minimize_scalar(
        misfit,
        bounds=(strongest - width, strongest + width),
        method="bounded",
        options={"xatol": 1e-9 * strongest},
    )
    return float(2 * np.pi / best.x)


def _kinetic_energy_period(data: xr.Dataset) -> Measurement:
    return Measurement(period(data.time.to_numpy(), data.kinetic_energy.to_numpy()))


def _displacement_period(data: xr.Dataset) -> Measurement:
    tip = data.x.sel(axis="E2").isel(vertex=-1).to_numpy()
    return Measurement(period(data.time.to_numpy(), tip))


def _recovered(problem: str, coefficient: str) -> Callable[[xr.Dataset], Measurement]:
    """A coefficient by the calibration at the published number of vertices."""

    def read(data: xr.Dataset) -> Measurement:
        published = printed.number("clamped_free", "rod.vertices")
        if published not in data.vertices:
            raise InputError(
                f"the calibration has meshes of {data.vertices.to_numpy().tolist()} vertices; "
                f"add the published {published:g}"
            )
        fitted = data[f"{problem}_coefficients"].sel(vertices=published)
        (dim,) = fitted.dims
        return Measurement(float(fitted.sel({dim: coefficient})))

    return read


def _elongation(data: xr.Dataset) -> Measurement:
    """Elongation of the necked bar, and n L / EA of a bar without fixed sections [m]."""
    beam = printed.beam("necking")
    along = data.u.sel(axis="E3").to_numpy()
    pull = printed.number("necking", "forces.1.force")
    return Measurement(float(along[-1] - along[0]), pull * beam.length / beam.axial_stiffness)


def _uniform(stretch: float) -> float:
    """Derivative of the characteristic s^2 - s + 1/s of eq. (3.4.11), Fig. 3.7(a)."""
    return 2 * stretch - 1 - 1 / stretch**2


def _stretched(data: xr.Dataset) -> Measurement:
    """Largest deviation of the two edges from stretches of 2 and 1/2.

    derived: n = k1/2 (2 mu - 1 - mu^-2) with k1 = c1 EA, c1 = 1/2: 11/16 EA at the first and -EA at the other.
    """
    return Measurement(float(np.abs(data.mu_edge.to_numpy() - [2.0, 0.5]).max()), 0.0)


def _thinned(data: xr.Dataset) -> Measurement:
    """Force along a director in the middle of a rod whose sections are all fixed at half their height [N].

    derived: k2/2 (2 lambda - 1 - lambda^-2) L / |D| with k2 = c2 EA and |D| = H/2.
    """
    beam = printed.beam("clamped_free")
    part = beam.length / (data.sizes["vertex"] - 1)
    k2 = printed.number("clamped_free", "rod.calibration.c2") * beam.axial_stiffness
    force = float(data.support_force.sel(dof="d2").isel(vertex=1))
    return Measurement(force, k2 / 2 * _uniform(0.5) * part / half_height(beam))


def _sheared(data: xr.Dataset) -> Measurement:
    """Force across the tip of a rod sheared by 45 degrees [N].

    derived: with tan(theta) = g and mu^2 = 1 + g^2, minus the derivative of k1/2 (mu^2 - mu + 1/mu) + k4/2 g^2 by g.
    """
    beam, stretch = printed.beam("clamped_free"), np.sqrt(2.0)
    c1, c4 = (printed.number("clamped_free", f"rod.calibration.{c}") for c in ("c1", "c4"))
    expected = c4 * beam.shear_stiffness + c1 * beam.axial_stiffness / 2 * _uniform(stretch) / stretch
    return Measurement(float(data.support_force.sel(dof="x2")[-1]), float(expected))


def _inflated(data: xr.Dataset) -> Measurement:
    """Moment at the middle vertex of two edges with a turning angle of arctan(4/3), for any stretch [N m].

    derived: the derivative by phi of 2 k3/L tan^2(phi/2), which is k3/2 (mu kappa)^2 L by eqs. (3.3.20), (3.3.23);
    here tan(phi/2) = 1/2.
    """
    beam = printed.beam("clamped_free")
    k3 = printed.number("clamped_free", "rod.calibration.c3") * beam.bending_stiffness
    part = beam.length / (data.sizes["vertex"] - 1)
    edge = np.diff(data.x.to_numpy(), axis=0)[-1]
    force = data.support_force.sel(dof=["x3", "x2"])[-1].to_numpy()
    moment = edge[0] * force[1] - edge[1] * force[0]
    return Measurement(float(moment), 2 * k3 / part * 0.5 * (1 + 0.5**2))


def buckling_ratio(data: xr.Dataset) -> Array:
    """Axial load of a clamped-free column over Euler's, pi^2 EI / (4 L^2), at every point of its path."""
    problem = problem_of(data, RodProblem)
    beam = beam_of(problem)
    euler = np.pi**2 / 4 * beam.bending_stiffness / beam.length**2
    fraction: Array = data.load_factor.to_numpy() * problem.forces[0].force / euler
    return fraction


def _elastica_tip(data: xr.Dataset) -> Measurement:
    """Lateral displacement of the tip of a rod of one metre, and that of Reissner's with P L^2 / EI = 10."""
    axial = 4 / SLENDERNESS**2  # EA L^2 / EI
    exact, _ = elastica.shearable_tip(10.0, axial, 5 / 6 / 2 * axial)
    return Measurement(float(data.u.sel(axis="E2")[-1]), exact)


def _column_tip(data: xr.Dataset) -> Measurement:
    """Tip of a column of one metre, and that of the exact elastica at twice Euler's load, pi^2 EI / (4 L^2)."""
    exact = elastica.column_tip(2 * np.pi**2 / 4)[0]
    return Measurement(abs(float(data.x.sel(axis="E2")[-1, -1])), exact)


def _timoshenko_period(data: xr.Dataset) -> Measurement:
    exact = 2 * np.pi / elastica.timoshenko_frequencies(printed.beam("vibration_c4_20"), 1)[0]
    return Measurement(_displacement_period(data).measured, float(exact))


def _roll_up(data: xr.Dataset) -> Measurement:
    """Distance of the end from the start of a rod of one metre."""
    return Measurement(float(np.hypot(*data.x[-1].to_numpy())), 0.0)


Curve = Callable[[xr.Dataset, beams.Beam | None], tuple[Array, Array]]
_CURVES: dict[str, Curve] = {
    "clamped_free": clamped_free_curve,
    "clamped_free_directors": clamped_free_directors,
    "clamped_clamped": clamped_clamped_curve,
    "clamped_clamped_directors": clamped_clamped_directors,
}


def _of_a_beam(curve: Curve, case: str) -> Callable[[xr.Dataset], Measurement]:
    """Largest deviation of a curve from that of the beam of another case."""
    return lambda data: largest_deviation(curve(data, printed.beam(case)))


READOUTS: dict[str, Callable[[xr.Dataset], Measurement]] = {
    "hanging_bar_tip": lambda data: at_tip(hanging_bar_curve(data)),
    "hanging_bar_profile": lambda data: largest_deviation(hanging_bar_curve(data)),
    "largest_director_displacement": lambda data: Measurement(float(np.abs(data.delta).max()), 0.0),
    "clamped_free_tip": lambda data: at_tip(clamped_free_curve(data)),
    "clamped_free_profile": lambda data: largest_deviation(clamped_free_curve(data)),
    "clamped_free_directors": lambda data: largest_deviation(clamped_free_directors(data)),
    "clamped_clamped_midspan": lambda data: at_midspan(clamped_clamped_curve(data)),
    "clamped_clamped_profile": lambda data: largest_deviation(clamped_clamped_curve(data)),
    "clamped_clamped_directors": lambda data: largest_deviation(clamped_clamped_directors(data)),
    **{
        f"{name}_k_1": _of_a_beam(curve, f"{beam}_k_1")
        for beam in ("clamped_free", "clamped_clamped")
        for name, curve in (
            (f"{beam}_profile", _CURVES[beam]),
            (f"{beam}_directors", _CURVES[f"{beam}_directors"]),
        )
    },
    **{f"recovered_{c}": _recovered("necking", c) for c in ("c2", "c6", "c7")},
    **{
        f"recovered_{c}{way}": _recovered(problem, c)
        for c in ("c3", "c4", "c5")
        for problem, way in (
            ("clamped_free", ""),
            ("clamped_clamped", "_clamped_clamped"),
            ("beams", "_both_beams"),
        )
    },
    "kinetic_energy_period": _kinetic_energy_period,
    "displacement_period": _displacement_period,
    "necking_midspan": lambda data: at_midspan(necking_curve(data)),
    "necking_profile": lambda data: largest_deviation(necking_curve(data)),
    "necking_elongation": _elongation,
    "stretched": _stretched,
    "thinned": _thinned,
    "sheared": _sheared,
    "inflated": _inflated,
    "elastica_tip": _elastica_tip,
    "column_tip": _column_tip,
    "timoshenko_period": _timoshenko_period,
    "roll_up": _roll_up,
    "necking_free_section": lambda data: largest_deviation(necking_curve(data, "free section")),
    **crawl_readouts.READOUTS,
}
"""Read-outs by their names in the table."""
