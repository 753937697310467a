"""Equilibria under a growing load, on springs whose answers are known and on rods; and its failures."""

import numpy as np
import pytest
from scipy.linalg import solve

import cosserat
from cosserat.errors import InputError, NotConvergedError
from cosserat.solvers.banded import absolute_product, constrain, solve_positive, to_dense
from cosserat.solvers.equilibrium import EquilibriumSolver, NewtonSettings
from cosserat.solvers.incremental import solve_full_load


class Springs:
    """energy = sum of q^4 / 4 - softening factor q^2 / 2 + stiffness q^2 / 2, unknowns uncoupled: no rod at all."""

    half_bandwidth = 0
    max_increment = np.inf

    def __init__(self, dead, stiffness=0.0, softening=0.0):
        self.dead = np.array(dead, dtype=float)
        self.constrained = np.zeros(self.dead.size, dtype=bool)
        self.dof_scale = np.ones(self.dead.size)
        self.stiffness, self.softening = stiffness, softening

    def prescribe(self, q, factor):
        return q

    def prescribed_rate(self, factor):
        return np.zeros_like(self.dead)

    def assemble(self, q, factor, gradient, band):
        k = self.stiffness - self.softening * factor
        gradient[:] = q**3 + k * q - factor * self.dead
        band[:, 0] = 3 * q**2 + k
        return float((q**4 / 4 + k * q**2 / 2).sum())

    def load(self, factor, *, signed=False):
        return factor * self.dead if signed else np.abs(factor * self.dead)

    def rate(self, q, factor, band):
        return -self.dead - self.softening * q

    def max_step_fraction(self, q, step):
        largest = np.abs(step).max()
        return 1 / largest if largest > 0 else np.inf

    def rates(self, q, change):
        return np.column_stack([change, np.zeros_like(change)])

    def predicted(self, q, moved, factor):
        return q + moved[:, 0]

    def carried(self, change):
        return np.zeros_like(change)


def climbed(springs, **settings):
    solver = EquilibriumSolver(springs, NewtonSettings(**settings), "trial")
    return solve_full_load(solver, np.zeros(springs.dead.size)), solver


def test_springs_reach_the_root_of_the_cubic():
    point, _ = climbed(Springs([8.0, 27.0], stiffness=1.0))
    for q, load in zip(point.q, (8.0, 27.0), strict=True):
        assert q**3 + q == pytest.approx(load, rel=1e-10)
    assert point.residual <= point.tolerance
    assert point.stable


@pytest.mark.parametrize("steps", [1, 3, 10])
@pytest.mark.parametrize("nudge", [1e-1, 1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("side", [1, -1])
def test_a_softening_spring_goes_to_the_side_of_any_nudge(nudge, side, steps):
    """Beyond factor 1/4.3 it has two minima, at the roots of q^3 - 3.3 q = nudge; the nudge decides from the first."""
    springs = Springs([side * nudge], stiffness=1.0, softening=4.3)
    point, solver = climbed(springs, load_increments=steps)
    assert point.q[0] == pytest.approx(side * np.roots([1, 0, -3.3, -nudge]).real.max(), rel=1e-8)
    assert not list(solver.warnings())


def test_a_symmetric_spring_says_that_its_side_is_open():
    point, solver = climbed(Springs([0.0], stiffness=1.0, softening=4.3))
    assert abs(point.q[0]) == pytest.approx(np.sqrt(3.3), rel=1e-8)
    (remark,) = solver.warnings()
    assert remark.startswith("bifurcation: at 0.232")


def test_convergence_is_quadratic():
    """The unbalanced forces of one attempt fall with order two."""
    residuals = []
    for iterations in range(1, 7):
        solver = EquilibriumSolver(
            Springs([8.0], stiffness=1.0),
            NewtonSettings(max_iterations=iterations, tolerance=1e-15),
            "x",
        )
        solver.correct(np.array([2.5]), 1.0)
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
    """A spring that pushes back with one newton at most, under two."""

    class Weak(Springs):
        def assemble(self, q, factor, gradient, band):
            gradient[:] = np.tanh(q) - factor * self.dead
            band[:, 0] = 1 / np.cosh(np.minimum(np.abs(q), 300)) ** 2
            return float(np.log(np.cosh(np.minimum(np.abs(q), 300))).sum())

    with pytest.raises(NotConvergedError, match="no equilibrium found beyond 0") as caught:
        climbed(Weak([2.0]))
    assert 0.3 < caught.value.factor < 0.5 + 1e-6


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_stiffness_or_an_energy_that_is_not_finite_raises(value):
    class Broken(Springs):
        def assemble(self, q, factor, gradient, band):
            gradient[:], band[:] = 0.5, value
            return value if np.isinf(value) else 0.0

    with pytest.raises(NotConvergedError):
        climbed(Broken([1.0, 1.0]))


def test_nothing_to_do_takes_no_iteration():
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


def test_banded_solve_product_and_hold_agree_with_dense_algebra():
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
