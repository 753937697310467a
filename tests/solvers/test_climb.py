"""The compiled loop for equilibria: its factorisation, the motions of a planar rod, and when it leaves a body."""

import numpy as np
import pytest
from scipy.linalg import solveh_banded

import cosserat
from cosserat.rods.kinematics import PLANAR, rotated, rotation_rates, stretch_rates
from cosserat.rods.space_kernel import planar
from cosserat.solvers.banded import constrain, to_dense
from cosserat.solvers.climb import decompose, factorise, resolve, substitute, substitute_both
from cosserat.solvers.equilibrium import EquilibriumSolver
from cosserat.solvers.incremental import solve_full_load
from cosserat.solvers.indefinite import Factors, negative_eigenvalues
from cosserat.solvers.many import climbed
from cosserat.solvers.members import FRACTION, PREDICTED, RATES


@pytest.mark.parametrize("width", [1, 5, 8, 14])
def test_the_factorisation_agrees_with_that_of_scipy(width):
    rng, n = np.random.default_rng(width), 40
    band = np.zeros((n + width, width))
    band[:n] = rng.normal(size=(n, width))
    band[:n, 0] += 4 * width
    for k in range(1, width):
        band[n - k : n, k] = 0.0
    held, right = rng.random(n) < 0.2, rng.normal(size=n)
    plain = band[:n].copy()
    constrain(plain, held)
    plain[held, 0] = 1.0
    expected = solveh_banded(plain.T, right, lower=True)
    assert factorise(band, held)
    found = right.copy()
    substitute(band, found, np.empty(n + width))
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    plain[7, 0], held[7] = -1.0, False
    assert np.linalg.eigvalsh(to_dense(plain)).min() < 0
    assert not factorise(np.concatenate([plain, np.zeros((width, width))]), held)


@pytest.mark.parametrize(("width", "skewed"), [(1, False), (5, True), (8, False), (8, True)])
def test_the_elimination_with_pivots_agrees_with_dense_matrices(width, skewed):
    rng, n = np.random.default_rng(width), 40
    band, skew = rng.normal(size=(2, n, width))
    band[5, 0] = float(width == 1)  # else nothing to divide by
    for k in range(1, width):
        band[n - k :, k] = skew[n - k :, k] = 0.0
    held, right = rng.random(n) < 0.2, rng.normal(size=n)
    held[5] = False
    whole = to_dense(band)
    if skewed:
        skew[:, 0] = 0.0
        whole += 2 * np.tril(to_dense(skew), -1) - to_dense(skew)
    whole[held], whole[:, held], whole[held, held] = 0.0, 0.0, 1.0
    lu, pivots = np.empty((n, 3 * width - 2)), np.empty(n, dtype=np.int64)
    sign = decompose(band, skew if skewed else np.empty((0, width)), held, lu, pivots)
    assert sign == np.linalg.slogdet(whole)[0]
    found = right.copy()
    resolve(lu, pivots, found)
    np.testing.assert_allclose(found, np.linalg.solve(whole, right), rtol=1e-9, atol=1e-9)
    if not skewed:
        plain = band.copy()
        constrain(plain, held)
        assert negative_eigenvalues(plain) == (np.linalg.eigvalsh(whole) < 0).sum()
        nearest, vector = Factors(plain).softest(np.where(held, 0.0, rng.normal(size=n)))
        free = whole[~held][:, ~held]
        values = np.linalg.eigvalsh(free)
        assert nearest == pytest.approx(values[np.abs(values).argmin()], rel=1e-9)
        np.testing.assert_allclose(free @ vector[~held], nearest * vector[~held], atol=1e-7)
    band[:] = 0.0
    assert decompose(band, np.empty((0, width)), np.zeros(n, dtype=bool), lu, pivots) == 0.0


@pytest.mark.parametrize("width", [5, 8])
def test_two_right_hand_sides_at_once_are_solved_as_each(width):
    rng, n = np.random.default_rng(width), 40
    band = np.zeros((n + width, width))
    band[:n] = rng.normal(size=(n, width))
    band[:n, 0] += 4 * width
    for k in range(1, width):
        band[n - k : n, k] = 0.0
    assert factorise(band, np.zeros(n, dtype=bool))
    given = rng.normal(size=(2, n))
    both, each = given.copy(), given.copy()
    substitute_both(band, *both, np.empty((2, n + width)))
    for row in each:
        substitute(band, row, np.empty(n + width))
    np.testing.assert_allclose(both, each, rtol=1e-13)


def test_the_compiled_motions_of_a_planar_rod_are_those_of_the_kinematics():
    """Rates against the general formulas, and a prediction that turns every part by what it is told to."""
    rng, n = np.random.default_rng(1), 24
    placed = np.column_stack([np.arange(6.0), np.zeros(6), np.zeros(6), np.ones(6)]).ravel()
    q, change = 0.2 * rng.normal(size=(2, n))
    nothing, rates = np.zeros(n, dtype=bool), np.empty((11, 2))
    planar(RATES, placed, q, change, nothing, rates)
    parts, moving = PLANAR.parts(placed + q), PLANAR.parts(change)
    expected = np.column_stack([rotation_rates(parts, moving), stretch_rates(parts, moving)])
    np.testing.assert_allclose(rates, expected, rtol=1e-12)
    new = q.copy()
    planar(PREDICTED, placed, q, new, nothing, rates)
    turned = rotated((1 + rates[:, 1:]) * parts, rates[:, :1])
    np.testing.assert_allclose(PLANAR.parts(placed + new), turned, rtol=1e-12, atol=1e-12)
    held = nothing.copy()
    held[[0, 1, 20, 21]] = True
    goal = q + 0.1
    planar(PREDICTED, placed, q, goal, held, rates)
    assert (goal[held] == (q + 0.1)[held]).all()
    d, step = (PLANAR.split(values)[:, 1] for values in (placed + q, change))
    fastest = (np.linalg.norm(step, axis=-1) / np.linalg.norm(d, axis=-1)).max()
    assert planar(FRACTION, placed, q, change, nothing, rates) == pytest.approx(1 / fastest)


def solver_of(name, **changes):
    problem = cosserat.case(name).vary("trial", **changes).problem
    return EquilibriumSolver(problem.system(problem.geometry), problem.newton, "trial")


@pytest.mark.parametrize("name", ["elastica", "clamped_free", "clamped_clamped_consistent", "necking"])
def test_the_compiled_loop_finds_what_the_long_way_finds(name, monkeypatch):
    point = climbed(solver_of(name))
    monkeypatch.setattr("cosserat.solvers.incremental.climbed", lambda solver: None)
    slow = solve_full_load(solver_of(name))
    size = np.abs(slow.q).max()
    np.testing.assert_allclose(point.q, slow.q, rtol=0, atol=1e-12 * size)
    np.testing.assert_allclose(
        point.reaction, slow.reaction, rtol=0, atol=1e-9 * np.abs(slow.reaction).max()
    )
    assert point.residual <= point.tolerance


FORCES = {
    "buckles": [("-E3", 2.3), ("E2", 1e-4)],
    "is symmetric": [("-E3", 2.3)],
    "has no load": [("E2", 0.0)],
}


@pytest.mark.parametrize("forces", FORCES.values(), ids=FORCES)
def test_the_compiled_loop_leaves_a_column(forces):
    """One that buckles, one that may do so to either side, and one without load: the long way finds them all."""
    forces = [{"at": "last", "along": along, "force": force} for along, force in forces]
    solver = solver_of("elastica", rod={"vertices": 12}, forces=forces)
    assert climbed(solver) is None
    assert solve_full_load(solver).stable


def test_the_compiled_loop_leaves_what_it_cannot_take():
    assert climbed(solver_of("roll_up")) is None  # a couple
    assert climbed(solver_of("elastica", springs=[{"at": "last", "rotational_stiffness": 1.0}])) is None


def test_too_few_iterations_are_left():
    assert climbed(solver_of("elastica", newton={"max_iterations": 1})) is None
