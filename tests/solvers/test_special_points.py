"""Special points of paths and small motions of little bodies, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from bodies import body, circulating, dead, springs, wells

from cosserat.solvers.continuation import ArcLengthSettings, trace_path
from cosserat.solvers.critical import ScaledSystem, first_special_point, linear_criterion
from cosserat.solvers.equilibrium import EquilibriumSolver, NewtonSettings
from cosserat.solvers.incremental import unloaded
from cosserat.solvers.modes import small_motions
from cosserat.solvers.special import special_points

LIMIT = 2 / (3 * np.sqrt(3))
"""The load at which x^3 - x turns back, at x = -1 / sqrt(3)."""


def arcs(longest, until=1.0):
    return ArcLengthSettings(
        first=min(0.05, longest), longest=longest, count=1000, until=until, limit=9.0, branches=0
    )


def solver_of(system):
    return EquilibriumSolver(system, NewtonSettings(), "the body")


def snapping(load):
    """One number in two wells, pushed from the left one to the right: x^3 - x = load, x = q - 1."""
    return body(wells((1.0, -1.0, 1.0)), dead([load]))


@pytest.mark.parametrize("longest", [0.01, 0.3])
def test_both_limit_points_of_one_number_are_found_to_round_off_whatever_the_arcs(longest):
    solver = solver_of(snapping(1.0))
    list(trace_path(solver, unloaded(solver), arcs(longest)))
    found = [
        point for pair in solver.crossings for point in special_points(solver.system, "the body", *pair)
    ]
    assert [(point.label, point.first) for point in found] == [
        ("limit point", True),
        ("limit point", False),
    ]
    np.testing.assert_allclose([point.point.factor for point in found], [LIMIT, -LIMIT], rtol=1e-14)
    x = [point.point.q[0] - 1 for point in found]
    np.testing.assert_allclose(x, [-1 / np.sqrt(3), 1 / np.sqrt(3)], rtol=1e-7)


def test_the_unit_of_the_load_changes_no_critical_load():
    system = snapping(1e-3)
    own, reached = first_special_point(solver_of(system), arcs(0.3, until=3.0), 400.0)
    assert own.point.factor == pytest.approx(1e3 * LIMIT, rel=1e-13)
    assert reached >= own.point.factor
    none, reached = first_special_point(solver_of(system), arcs(0.3, until=0.9), 400.0)
    assert none is None
    assert reached == pytest.approx(360.0)
    scaled = ScaledSystem.of(system, 400.0)
    assert scaled.load_sizes == pytest.approx((0.4, 0.4))


def test_the_linear_criterion_of_one_number_is_that_of_its_slope():
    """K = 3 x^2 - 1 at x = -1 is 2, its rate -6 x' = -6 load / 2: it vanishes at 2 / (3 load) by the linear law."""
    found = linear_criterion(solver_of(snapping(0.01)), 3)
    np.testing.assert_allclose(found.factor, [2 / 0.03], rtol=1e-12)
    assert linear_criterion(solver_of(snapping(-0.01)), 3).factor.size == 0


@pytest.mark.parametrize(
    ("across", "growth", "frequency"),
    [
        (0.0, (0, 0), (1, 2)),
        (1.2, (0, 0), (np.sqrt(2.5 - 0.9), np.sqrt(2.5 + 0.9))),
        (2.0, None, None),
    ],
)
def test_a_force_across_two_springs_makes_them_flutter(across, growth, frequency):
    """k = 5/2 +- sqrt(9/4 - p^2) of unit masses on springs of 1 and 4: complex from p = 3/2 on."""
    system = body(wells((0, 1, 0), (0, 4, 0)), circulating(across), mass=1.0)
    found = small_motions(system, np.zeros(2), 2, supported=True)
    if growth is None:
        root = np.sqrt(-(2.5 - 1j * np.sqrt(across**2 - 2.25)))
        growth, frequency = (root.real, -root.real), (root.imag, root.imag)
        assert root.real > 0
    np.testing.assert_allclose(found.growth, growth, atol=1e-13)
    np.testing.assert_allclose(found.angular_frequency, frequency, rtol=1e-13)
    for s, shape in zip(found.growth + 1j * found.angular_frequency, found.shape, strict=True):
        K = np.array([[1, across], [-across, 4]])
        np.testing.assert_allclose(K @ shape, -(s**2) * shape, atol=1e-13)
        assert np.vdot(shape, shape).real == pytest.approx(1)


def test_an_unstable_body_diverges_at_the_root_of_its_curvature():
    system = body(wells((0, -2, 0), (0, 3, 0)), mass=0.5)
    found = small_motions(system, np.zeros(2), 2, supported=True)
    np.testing.assert_allclose(found.growth, [2, 0], rtol=1e-14)
    np.testing.assert_allclose(found.angular_frequency, [0, np.sqrt(6)], rtol=1e-14)


def test_the_linear_criterion_of_two_bars_is_the_third_derivative_of_their_energy():
    """Of E = k (L - l)^2, L^2 = b^2 + y^2: E'' = 2 k h^2 / l^2 and E''' = 6 k h b^2 / l^4 at rest, where y = h.

    The apex moves by -P / E'', so that the stiffness vanishes at E''^2 / (E''' P) = 2 k h^3 / (3 b^2 P).
    """
    k, b, h, load = 7.0, 1.0, 0.3, 0.02
    at = np.array([[-b, 0, 0], [0, h, 0], [b, 0, 0]])
    bars = springs([(0, 1, k, np.hypot(b, h)), (1, 2, k, np.hypot(b, h))])
    push = np.zeros(9)
    push[4] = -load
    system = body(replace(bars, origin=at.ravel()), dead(push), held=(0, 1, 2, 5, 6, 7, 8), n=9)
    found = linear_criterion(solver_of(system), 3)
    np.testing.assert_allclose(found.factor, [2 * k * h**3 / (3 * b**2 * load)], rtol=1e-10)
    np.testing.assert_allclose(found.mode[0], np.eye(9)[4], atol=1e-12)
