"""Newton's method on problems whose answers are known, and its failures."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.linalg import solve

import cosserat
from cosserat.errors import InputError, NotConvergedError
from cosserat.solvers.banded import absolute_product, hold, solve_positive, to_dense
from cosserat.solvers.newton import NewtonSettings, equilibrium


@dataclass
class Quartic:
    """energy = sum of q^4 / 4 - softening q^2 / 2, unknowns uncoupled: a body of one number a vertex."""

    softening: float = 0.0
    half_bandwidth: int = 0

    def assemble(self, q, gradient, band):
        gradient[:] = q**3 - self.softening * q
        band[:, 0] = 3 * q**2 - self.softening
        return float((q**4 / 4 - self.softening * q**2 / 2).sum())


def solved(body, start, load, **settings):
    held = np.zeros(start.size, dtype=bool)
    return equilibrium(body, start, load, held, NewtonSettings(**settings), "trial")


def test_quartic_spring_reaches_the_cube_root():
    answer = solved(Quartic(), np.array([1.0, 2.0]), np.array([8.0, 27.0]))
    np.testing.assert_allclose(answer.q, [2, 3], rtol=1e-10)
    assert answer.residual <= answer.tolerance


def test_convergence_is_quadratic():
    """The unbalanced forces of the last iterations above rounding fall with an order near two."""
    residuals = []
    for iterations in range(1, 20):
        settings = {"max_iterations": iterations, "tolerance": 1e-14}
        try:
            cosserat.run(
                cosserat.case("clamped_free").vary("bent", gravity={"g": 20_000}, newton=settings)
            )
            break
        except NotConvergedError as error:
            residuals.append(error.residual)
    first, second, third = np.log([r for r in residuals if r > 1e-4][-3:])
    assert (third - second) / (second - first) > 1.7


def test_a_start_where_the_hessian_is_negative_still_leads_to_a_minimum():
    answer = solved(Quartic(softening=1.0), np.array([0.1, -0.1]), np.zeros(2))
    np.testing.assert_allclose(answer.q, [1, -1], rtol=1e-9)
    assert answer.shifted > 0


def test_load_steps_reach_the_same_equilibrium(problem):
    one, many = (
        cosserat.run(
            cosserat.case("clamped_free").vary("bent", gravity={"g": 500}, newton={"load_steps": n})
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
    assert caught.value.iterations == 1


def test_a_load_without_equilibrium_raises():
    """A softening spring in a bowl that opens downwards has no rest under any load."""

    @dataclass
    class Falling(Quartic):
        def assemble(self, q, gradient, band):
            gradient[:] = 0.0
            band[:, 0] = 1.0
            return 0.0

    with pytest.raises(NotConvergedError, match="iterations were not enough"):
        solved(Falling(), np.zeros(2), np.ones(2))


def test_a_stiffness_that_is_not_a_number_raises():
    @dataclass
    class Broken(Quartic):
        def assemble(self, q, gradient, band):
            gradient[:], band[:] = 0.5, np.nan
            return 0.0

    with pytest.raises(NotConvergedError):
        solved(Broken(), np.zeros(2), np.ones(2))


def test_a_start_of_infinite_energy_raises():
    @dataclass
    class Collapsed(Quartic):
        def assemble(self, q, gradient, band):
            return np.inf

    with pytest.raises(NotConvergedError, match="starting configuration"):
        solved(Collapsed(), np.zeros(2), np.ones(2))


def test_nothing_to_do_takes_no_iteration():
    still = cosserat.run(cosserat.case("clamped_free").vary("still", gravity={"g": 0}))
    assert cosserat.data.dataset.statistics_of(still)["iterations"] == 0
    assert np.abs(still.u).max() == 0


@pytest.mark.parametrize(
    "hold_only", [[], ["x3"], ["x3", "x2"], ["d3", "d2"], ["x3", "d3"], ["x2", "d2"]]
)
def test_unsupported_rods_are_refused_before_solving(hold_only):
    free = cosserat.case("clamped_free").vary("free", supports=[{"at": "first", "hold": hold_only}])
    with pytest.raises(cosserat.UnsupportedRodError, match="case 'free': .*free to move"):
        cosserat.run(free)


def test_two_hinges_are_support_enough():
    hinged = cosserat.case("clamped_free").vary(
        "hinged", supports=[{"at": "first", "hold": ["x3", "x2"]}, {"at": 19, "hold": ["x2"]}]
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
    held = np.zeros(n, dtype=bool)
    held[[0, 5]] = True
    hold(band, held)
    reduced = to_dense(band)
    assert np.count_nonzero(reduced[held]) == 2
    np.testing.assert_array_equal(reduced[np.ix_(~held, ~held)], full[np.ix_(~held, ~held)])


def test_an_indefinite_band_has_no_cholesky_factor():
    assert solve_positive(np.array([[1.0, 2.0], [1.0, 0.0]]), np.ones(2)) is None


def test_settings_are_checked():
    with pytest.raises(InputError, match="'tolerance' is 2; it must be below 1"):
        NewtonSettings.read({"tolerance": 2}, "settings")
