"""Equilibria under a growing load, for springs with known answers and for rods; and failures of the solver."""

import numpy as np
import pytest
from numba import njit
from scipy.linalg import solve

import cosserat
from cosserat.errors import InputError, NotConvergedError
from cosserat.solvers.banded import absolute_product, constrain, solve_positive, to_dense
from cosserat.solvers.equilibrium import EquilibriumSolver, NewtonSettings
from cosserat.solvers.flat import FixedDofs, FlatSpace
from cosserat.solvers.incremental import solve_full_load
from cosserat.solvers.potential import GRADIENT, HESSIAN, KERNEL, Potential
from cosserat.solvers.system import MechanicalSystem


@njit(KERNEL, cache=True)
def springs(q, after, data, history, strains, task, gradient, band, skew, terms):
    """Sum of a q^4 / 4 + b q^2 / 2 - c q; DOFs uncoupled."""
    rows = data.view(np.float64).reshape(q.size, 3)
    a, b, c = rows[:, 0], rows[:, 1], rows[:, 2]
    if task in (GRADIENT, HESSIAN):
        gradient += a * q**3 + b * q - c
    if task == HESSIAN:
        band[:, 0] += 3 * a * q**2 + b
    terms[0] = (a * q**4 / 4 + b * q**2 / 2 - c * q).sum()
    return terms[0]


def potential(kernel, *columns, half_bandwidth=0):
    """What a kernel makes of constants (n,), one column each."""
    constants = np.column_stack(columns).astype(float).ravel()
    return Potential(kernel, constants, ("energy",), half_bandwidth)


def cubic(dead, stiffness=0.0, softening=0.0, kernel=springs):
    """energy = sum of q^4 / 4 - softening factor q^2 / 2 + stiffness q^2 / 2, under dead loads: no rod at all."""
    ones = np.ones(len(dead))
    return MechanicalSystem(
        potential(kernel, ones, stiffness * ones, 0 * ones),
        (potential(springs, 0 * ones, -softening * ones, dead, half_bandwidth=0 if softening else -1),),
        FixedDofs(np.zeros(len(dead), dtype=bool)),
        FlatSpace(ones),
    )


def climbed(system, **settings):
    solver = EquilibriumSolver(system, NewtonSettings(**settings), "trial")
    return solve_full_load(solver), solver


def test_nonlinear_springs_reach_the_root_of_their_cubic():
    point, _ = climbed(cubic([8.0, 27.0], stiffness=1.0))
    for q, load in zip(point.q, (8.0, 27.0), strict=True):
        assert q**3 + q == pytest.approx(load, rel=1e-10)
    assert point.residual <= point.tolerance
    assert point.stable


@pytest.mark.parametrize("steps", [1, 3, 10])
@pytest.mark.parametrize("nudge", [1e-1, 1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("side", [1, -1])
def test_a_softening_spring_buckles_to_the_side_of_its_imperfection(nudge, side, steps):
    """Beyond factor 1/4.3 it has two minima, at the roots of q^3 - 3.3 q = nudge; the nudge decides from the first."""
    system = cubic([side * nudge], stiffness=1.0, softening=4.3)
    point, solver = climbed(system, load_increments=steps)
    assert point.q[0] == pytest.approx(side * np.roots([1, 0, -3.3, -nudge]).real.max(), rel=1e-8)
    assert not list(solver.warnings())


def test_a_symmetric_spring_warns_of_its_open_side():
    point, solver = climbed(cubic([0.0], stiffness=1.0, softening=4.3))
    assert abs(point.q[0]) == pytest.approx(np.sqrt(3.3), rel=1e-8)
    (remark,) = solver.warnings()
    assert remark.startswith("bifurcation: at 0.232")


def test_convergence_is_quadratic():
    """The unbalanced forces of one attempt fall with order two."""
    residuals = []
    for iterations in range(1, 7):
        solver = EquilibriumSolver(
            cubic([8.0], stiffness=1.0),
            NewtonSettings(max_iterations=iterations, tolerance=1e-15),
            "x",
        )
        solver.correct(np.array([2.5]), 1.0, solver.system.history)
        residuals.append(solver.residual)
    first, second, third = np.log([r for r in residuals if r > 1e-12][-3:])
    assert (third - second) / (second - first) == pytest.approx(2, abs=0.1)


def test_load_steps_reach_the_same_equilibrium():
    one, many = (
        cosserat.run(
            cosserat.case("clamped_free").vary("bent", gravity={"g": 500}, newton={"load_increments": n})
        )
        for n in (1, 5)
    )
    np.testing.assert_allclose(one.x, many.x, atol=1e-9)


def test_too_few_iterations_raise_with_name_residual_and_remedy():
    hard = cosserat.case("clamped_free").vary("hard", gravity={"g": 500}, newton={"max_iterations": 1})
    with pytest.raises(
        NotConvergedError, match=r"case 'hard': .* largest unbalanced force .* N, allowed .*; try"
    ) as caught:
        cosserat.run(hard)
    assert caught.value.residual > caught.value.tolerance


def test_a_load_without_equilibrium_raises():
    """A spring with a largest force of one newton under a load of two."""

    @njit(KERNEL, cache=True)
    def weak(q, after, data, history, strains, task, gradient, band, skew, terms):
        near = np.minimum(np.abs(q), 300)
        if task in (GRADIENT, HESSIAN):
            gradient += np.tanh(q)
        if task == HESSIAN:
            band[:, 0] += 1 / np.cosh(near) ** 2
        return np.log(np.cosh(near)).sum()

    with pytest.raises(NotConvergedError, match="no equilibrium found beyond 0") as caught:
        climbed(cubic([2.0], kernel=weak))
    assert 0.3 < caught.value.state.factor < 0.5 + 1e-6


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_stiffness_or_an_energy_that_is_not_finite_raises(value):
    @njit
    def broken(q, after, data, history, strains, task, gradient, band, skew, terms):
        if task in (GRADIENT, HESSIAN):
            gradient += 0.5
        if task == HESSIAN:
            band[:] = value
        return value if np.isinf(value) else 0.0

    with pytest.raises(NotConvergedError):
        climbed(cubic([1.0, 1.0], kernel=broken))


def test_a_rod_without_loads_takes_no_iteration():
    still = cosserat.run(cosserat.case("clamped_free").vary("still", gravity={"g": 0}))
    assert cosserat.data.dataset.statistics_of(still)["iterations"] == 0
    assert np.abs(still.u).max() == 0


@pytest.mark.parametrize(
    "hold_only", [[], ["x3"], ["x3", "x2"], ["d3", "d2"], ["x3", "d3"], ["x2", "d2"]]
)
def test_unsupported_rods_are_refused_before_solving(hold_only):
    free = cosserat.case("clamped_free").vary("free", supports=[{"at": "first", "fixed": hold_only}])
    with pytest.raises(cosserat.UnsupportedRodError, match="case 'free': .*free to move"):
        cosserat.run(free)


def test_two_hinges_are_support_enough():
    hinged = cosserat.case("clamped_free").vary(
        "hinged", supports=[{"at": "first", "fixed": ["x3", "x2"]}, {"at": 19, "fixed": ["x2"]}]
    )
    assert cosserat.run(hinged).u.sel(axis="E2").min() < 0


def test_banded_operations_agree_with_dense_algebra():
    rng = np.random.default_rng(5)
    n, width = 12, 4
    band = rng.uniform(-1, 1, (n, width))
    band[:, 0] += 8
    for j in range(n):
        band[j, n - j :] = 0
    full, x = to_dense(band), rng.uniform(-1, 1, n)
    np.testing.assert_allclose(solve_positive(band, x), solve(full, x), rtol=1e-12)
    np.testing.assert_allclose(absolute_product(band, x), np.abs(full) @ np.abs(x), rtol=1e-12)
    constrained = np.zeros(n, dtype=bool)
    constrained[[0, 5]] = True
    constrain(band, constrained)
    reduced = to_dense(band)
    assert np.count_nonzero(reduced[constrained]) == 2
    np.testing.assert_array_equal(
        reduced[np.ix_(~constrained, ~constrained)], full[np.ix_(~constrained, ~constrained)]
    )


def test_an_indefinite_band_has_no_cholesky_factor():
    assert solve_positive(np.array([[1.0, 2.0], [1.0, 0.0]]), np.ones(2)) is None


def test_settings_are_checked():
    with pytest.raises(InputError, match="'tolerance' is 2; it must be below 1"):
        NewtonSettings.read({"tolerance": 2}, "settings")
