"""Internal constraints in both forms, and the ground as an external one, section 1.3."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

import cosserat
from cosserat.errors import InputError, NotConvergedError, OutOfReachError
from cosserat.peristalsis.crawler import Groups
from cosserat.rods import constrained_rod
from cosserat.rods.constrained_rod import INCOMPRESSIBLE, INEXTENSIBLE, constrained_forces, uniform_state
from cosserat.rods.directed_rod import (
    Section,
    adjusted_stiffnesses,
    couple,
    energy_gradient,
    forces,
    measures,
    strain_energy,
    unbalanced_couple,
)

CONSTRAINTS = {"incompressible": INCOMPRESSIBLE, "inextensible": INEXTENSIBLE}
CIRCLE = Section.circle(0.01)
YOUNG = 1e6
K = adjusted_stiffnesses(YOUNG, 0.3, CIRCLE, 0.9)
STIFF = YOUNG * CIRCLE.area
TWIST, BEND, OBLIQUE = np.array([0, 0, 30.0]), np.array([0, 30.0, 0]), np.array([0, 20.0, 20.0])
LOADS = {"twisted and pulled": (TWIST, 0.2 * STIFF), "twisted and pushed": (TWIST, -0.05 * STIFF)}
LOADS |= {"bent": (BEND, 0.0), "twisted about a slanted axis": (OBLIQUE, 0.03 * STIFF)}


def on_the_surface(name, seed):
    """A state that keeps the constraint, with derivatives of its directors."""
    rng = np.random.default_rng(seed)
    d = np.eye(3) + 0.3 * rng.uniform(-1, 1, (3, 3))
    d[2] /= np.linalg.det(d) if name == "incompressible" else np.linalg.norm(d[2])
    return d, 30 * rng.uniform(-1, 1, (2, 3))


# ---------------------------------------------------------------- internal constraints


@pytest.mark.parametrize("loads", LOADS)
@pytest.mark.parametrize("name", CONSTRAINTS)
def test_both_forms_give_the_same_state(name, loads):
    """(1.3.26) and (1.3.28): equal directors and forces; the multipliers differ by what the energy puts into one."""
    constraint, (turn, pull) = CONSTRAINTS[name], LOADS[loads]
    (d, after), (d_c, before) = (
        uniform_state(K, constraint, form, turn, pull) for form in ("after", "before")
    )
    np.testing.assert_allclose(d_c, d, atol=1e-12)
    assert abs(constraint.value(d)) < 1e-14
    assert np.abs(np.linalg.norm(d, axis=1) - 1).max() > 1e-3  # a deformation worth the name
    d_prime = np.cross(turn, d[:2])
    both = [
        constrained_forces(K, constraint, form, d, d_prime, multiplier)
        for form, multiplier in (("after", after), ("before", before))
    ]
    for one, other in zip(*both, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-11 * STIFF)
    assert np.abs(unbalanced_couple(d, d_prime, *both[0])).max() < 1e-12 * STIFF
    by_gamma, _ = energy_gradient(K, *measures(d, d_prime))
    # derived: the change of gamma_33 over that of phi
    fraction = 2 / np.linalg.det((d @ d.T)[:2, :2]) if name == "incompressible" else 2
    assert before - after == pytest.approx(by_gamma[2, 2] * fraction, rel=1e-9)
    assert abs(before - after) > 1e-3 * STIFF


@pytest.mark.parametrize("name", CONSTRAINTS)
@given(seed=st.integers(0, 10_000))
def test_the_second_form_is_the_gradient_of_the_energy_on_the_surface_1_3_27(name, seed):
    """Differences of w with gamma_33 put in from the constraint, here by its own formula."""
    d, d_prime = on_the_surface(name, seed)

    def energy(x):
        gamma, kappa = measures(x[:9].reshape(3, 3), x[9:].reshape(2, 3))
        a, b, c = gamma[0, 1], gamma[0, 2], gamma[1, 2]
        one, two = 1 + gamma[0, 0], 1 + gamma[1, 1]
        gamma[2, 2] = 0.0
        if name == "incompressible":
            gamma[2, 2] = (1 - 2 * a * b * c + one * c * c + two * b * b) / (one * two - a * a) - 1
        return strain_energy(K, gamma, kappa)

    at, h = np.concatenate([d.ravel(), d_prime.ravel()]), 1e-3
    steps = h * np.diag([*[1.0] * 9, *[30.0] * 6])
    found = [
        (8 * (energy(at + e) - energy(at - e)) - energy(at + 2 * e) + energy(at - 2 * e))
        / (12 * e.sum())
        for e in steps
    ]
    n, k, m = constrained_forces(K, CONSTRAINTS[name], "before", d, d_prime, 0.0)
    expected = np.concatenate([k.ravel(), n, m.ravel()])
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize("name", CONSTRAINTS)
@given(seed=st.integers(0, 10_000))
def test_reactions_are_normal_to_the_surface_and_do_no_work(name, seed):
    """(1.3.23)-(1.3.25): the gradient of phi, and no power in motions that keep phi."""
    d, d_prime = on_the_surface(name, seed)
    constraint, rng = CONSTRAINTS[name], np.random.default_rng(seed + 1)
    normal = constraint.gradient(d)
    h = 1e-5
    slope = [
        (constraint.value(d + h * e) - constraint.value(d - h * e)) / (2 * h)
        for e in np.eye(9).reshape(9, 3, 3)
    ]
    np.testing.assert_allclose(np.reshape(slope, (3, 3)), normal, atol=1e-9)
    with_reaction = constrained_forces(K, constraint, "after", d, d_prime, 7.0)
    without = forces(d, d_prime, *energy_gradient(K, *measures(d, d_prime)))
    reaction = [a - b for a, b in zip(with_reaction, without, strict=True)]
    rate = rng.uniform(-1, 1, (3, 3))
    rate -= (rate * normal).sum() / (normal * normal).sum() * normal
    power = reaction[0] @ rate[2] + (reaction[1] * rate[:2]).sum()
    assert abs(power) < 1e-11
    assert not reaction[2].any()


def test_reactions_of_constant_volume_are_those_of_2_2_15():
    """Where the directors are stretched but not sheared: lambda mu_1 mu_2 mu_3 d_i / mu_i^2."""
    mu = np.array([0.9, 1.2, 1 / (0.9 * 1.2)])
    np.testing.assert_allclose(INCOMPRESSIBLE.gradient(np.diag(mu)), np.diag(mu.prod() / mu), atol=1e-15)


@pytest.mark.parametrize(
    "wrong", ["no reaction on the directors", "gamma_33 put in, its change left out"]
)
def test_the_wrong_form_of_the_constraint_gives_another_state(wrong, monkeypatch):
    loads = LOADS["twisted and pulled"]
    right, _ = uniform_state(K, INCOMPRESSIBLE, "before", *loads)

    def faulty(k, constraint, form, d, d_prime, multiplier):
        n, intrinsic, m = constrained_forces(k, constraint, form, d, d_prime, multiplier)
        if wrong == "no reaction on the directors":
            return n, intrinsic - multiplier * constraint.gradient(d)[:2], m
        gamma, kappa = measures(d, d_prime)
        by_gamma, by_kappa = energy_gradient(k, constraint.eliminate(gamma)[0], kappa)
        by_gamma[2, 2] = 0
        n, intrinsic, m = forces(d, d_prime, by_gamma, by_kappa)
        reaction = multiplier * constraint.gradient(d)
        return n + reaction[2], intrinsic + reaction[:2], m

    monkeypatch.setattr(constrained_rod, "constrained_forces", faulty)
    if wrong == "no reaction on the directors":
        found, _ = uniform_state(K, INCOMPRESSIBLE, "before", *loads)
        assert np.abs(found - right).max() > 0.1
    else:  # the only equilibrium these forces have here is of a rod turned over, out of reach from E_i
        with pytest.raises(NotConvergedError):
            uniform_state(K, INCOMPRESSIBLE, "before", *loads)


def test_a_bar_of_constant_volume_that_is_twisted_and_pulled_has_least_energy():
    """One number is left, mu_3, of which the potential per length is a function: its minimum, found without forces."""
    turn, pull = LOADS["twisted and pulled"]
    stretch, shear = YOUNG * 0.7 / (1.3 * 0.4), YOUNG / 2.6
    first = YOUNG * 0.3 / (1.3 * 0.4)
    area, moment = CIRCLE.area, CIRCLE.second_moment_1

    def potential(mu_3):
        across, along = 1 / mu_3 - 1, mu_3**2 - 1  # gamma_11 = gamma_22, gamma_33
        energy = stretch * area / 8 * (2 * across**2 + along**2)
        energy += first * area / 4 * (across**2 + 2 * across * along)
        twist = turn[2] / mu_3  # kappa_12 = -kappa_21: both together cost the torsional rigidity
        return energy + shear * 2 * moment * twist**2 / 2 - pull * (mu_3 - 1)

    least = minimize_scalar(potential, bracket=(0.9, 1.1, 1.4), tol=1e-12).x
    d, _ = uniform_state(K, INCOMPRESSIBLE, "after", turn, pull)
    np.testing.assert_allclose(d, np.diag([least**-0.5, least**-0.5, least]), atol=1e-7)
    _, _, m = constrained_forces(K, INCOMPRESSIBLE, "after", d, np.cross(turn, d[:2]), 0.0)
    exact = shear * 2 * moment * turn[2] / least**2  # by turn, at constant mu_3
    np.testing.assert_allclose(couple(d, m), [0, 0, exact], rtol=1e-6, atol=1e-15)


def test_an_inextensible_bar_that_is_bent_narrows_towards_the_middle_of_the_circle():
    """With mu_3 = 1 the energy is quadratic in gamma_11 and gamma_22 but for the bending: minimised by hand."""
    d, _ = uniform_state(K, INEXTENSIBLE, "before", BEND, 0.0)
    k = K
    # w = (k1 g1^2 + k2 g2^2 + k7 g1 g2 + k14 (1 + g1) omega^2)/2, as kappa_13 = -omega mu_1
    matrix = np.array([[k[1], k[7] / 2], [k[7] / 2, k[2]]])
    across = np.linalg.solve(matrix, [-k[14] * BEND[1] ** 2 / 2, 0])
    np.testing.assert_allclose(d, np.diag([*np.sqrt(1 + across), 1]), atol=1e-12)


def test_relation_of_the_multipliers_of_chapter_2():
    """(2.4.6) with (2.4.5): to first order in the stretches, lambda_c less lambda is k_I (2 - mu_1 - mu_2)."""
    k_s, k_p = 5.0, 2.0
    for size in (1e-3, 1e-4):
        mu = 1 + size * np.array([0.7, -0.4])
        mu_3 = 1 / mu.prod()
        active = mu_3 * (k_s * (mu_3 - 1) + k_p * (mu.sum() - 2))  # mu_3 dw/dmu_3 of (2.3.1)
        assert active == pytest.approx((k_s - k_p) * (2 - mu.sum()), abs=10 * size**2)


def test_uniform_states_without_a_turn_or_a_solution_are_refused():
    for turn, pull in ((np.zeros(3), 1.0), (TWIST, np.nan), (np.full(3, np.inf), 0.0)):
        with pytest.raises(InputError, match="give finite numbers and a turn that is not zero"):
            uniform_state(K, INCOMPRESSIBLE, "after", turn, pull)
    with pytest.raises(NotConvergedError, match="reduce the rotation or the tension"):
        uniform_state(K, INEXTENSIBLE, "after", TWIST, 1e6 * STIFF)
    with pytest.raises(OutOfReachError, match="its sections collapse"):
        uniform_state(K, INEXTENSIBLE, "after", 100 * BEND, 0.0)


# ---------------------------------------------------------------- the ground


def test_the_ground_pushes_on_the_centreline_and_on_one_director():
    """(2.2.16) by (1.3.33) and (1.3.35): the forces (2.2.17), by differences of the constraint."""
    radius, h = 0.3, 1e-6

    def above(x):
        r, d_1 = x[:3], x[3:]
        return (r - radius * d_1)[0] + radius  # r* (-R, 0, xi) . E_1 + R

    slope = [(above(h * e) - above(-h * e)) / (2 * h) for e in np.eye(6)]
    np.testing.assert_allclose(slope, [1, 0, 0, -radius, 0, 0], atol=1e-9)


@pytest.mark.parametrize("name", ["worm", "soft_robot"])
def test_the_weight_reaches_the_first_director_through_the_ground(name):
    """(1.2.82) with (2.2.17): k_G mu_1'' = k^1 . E_1 + R lambda^E; gravity itself loads no director, (2.2.19)."""
    problem = cosserat.case(name).problem
    body, loads = problem.crawler, problem.loads
    mu, one = np.array([[0.95, 1.04]]), np.ones(1)

    def source(gravity):
        groups = Groups.of(body, loads.replace(gravity=gravity))
        if groups.incompressible:
            return groups.incompressible_source(mu, 0 * one, one, 0 * one)[0][0]
        return groups.compressible_source(mu, 0 * one, 0 * one)[0][0]

    k_g = (body.incompressible_stiffnesses if name == "worm" else body.stiffnesses)[-1]
    fraction = body.radius * body.line_density * 9.81 * body.length**2 / k_g
    np.testing.assert_allclose(source(9.81) - source(0.0), [fraction, 0], rtol=1e-9, atol=1e-12)
