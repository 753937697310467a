"""Chapter 1: stiffnesses by integrating elasticity over a section, gradients of the stretches, and its errata."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from cosserat.rods.directed_rod import (
    Inertia,
    Offset,
    Section,
    adjusted_stiffnesses,
    couple,
    energy_gradient,
    forces,
    integrated_stiffnesses,
    internal_forces,
    lame,
    measures,
    offset_energy,
    strain_energy,
    stretch_gradients,
    stretches,
    unbalanced_couple,
)

YOUNG, POISSON = 3.0, 0.3


def state(seed, size=0.3):
    """Directors (3, 3) and their derivatives (2, 3), not far from the reference."""
    rng = np.random.default_rng(seed)
    return np.eye(3) + size * rng.uniform(-1, 1, (3, 3)), size * rng.uniform(-1, 1, (2, 3))


def rectangle(width, height, centre=(0.0, 0.0), turn=0.0):
    """Places X (K, 2) and weights (K,) of Gauss's rule over a rectangle, width along X^1 before it is turned."""
    nodes, weights = np.polynomial.legendre.leggauss(3)
    x = np.array([[a * width / 2, b * height / 2] for a in nodes for b in nodes])
    c, s = np.cos(turn), np.sin(turn)
    area = np.outer(weights, weights).ravel() * width * height / 4
    return x @ np.array([[c, s], [-s, c]]) + centre, area


def three_dimensional_energy(delta, kappa, places, area):
    """Linear elasticity (1.1.71) over a section, eq. (1.2.92)."""
    first, shear = lame(YOUNG, POISSON)
    total = 0.0
    for x, da in zip(places, area, strict=True):
        strain = small_strain(delta, kappa, x)
        total += (first / 2 * np.trace(strain) ** 2 + shear * (strain**2).sum()) * da
    return total


def small_strain(delta, kappa, x):
    """The strains (1.2.24) at a point x of the section, from (1.2.22) and (1.2.23)."""
    gradient = delta.T.copy()  # u_i,j: column j is the displacement of director j
    gradient[:, 2] += x @ kappa
    return (gradient + gradient.T) / 2


def resultants(delta, kappa, places, area):
    """n, k^alpha and m^alpha by the integrals (1.2.66), (1.2.78) and (1.2.77) of the stress (1.1.72)."""
    first, shear = lame(YOUNG, POISSON)
    by_d, m = np.zeros((3, 3)), np.zeros((2, 3))
    for x, da in zip(places, area, strict=True):
        strain = small_strain(delta, kappa, x)
        stress = first * np.trace(strain) * np.eye(3) + 2 * shear * strain
        by_d += stress.T * da  # row i is the traction on the plane with the normal E_i
        m += np.outer(x, stress[:, 2]) * da
    return by_d[2], by_d[:2], m


@given(st.integers(0, 10_000))
def test_integrating_elasticity_over_the_section_gives_the_energy_1_2_94(seed):
    width, height = 0.7, 0.4
    section = Section(width * height, width * height**3 / 12, height * width**3 / 12, np.nan)
    rng = np.random.default_rng(seed)
    delta, kappa = rng.uniform(-1, 1, (3, 3)), rng.uniform(-1, 1, (2, 3))
    gamma = delta + delta.T  # (1.2.20)
    energy = strain_energy(integrated_stiffnesses(YOUNG, POISSON, section), gamma, kappa)
    assert energy == pytest.approx(
        three_dimensional_energy(delta, kappa, *rectangle(width, height)), rel=1e-12
    )


@given(st.integers(0, 10_000))
def test_an_eccentric_rotated_section_has_the_energy_1_2_93(seed):
    """S^alpha couples stretching with bending, I^12 one bending with the other; without them something is missing."""
    rng = np.random.default_rng(seed)
    delta, kappa = rng.uniform(-1, 1, (3, 3)), rng.uniform(-1, 1, (2, 3))
    x, area = rectangle(0.7, 0.4, centre=rng.uniform(0.1, 0.5, 2), turn=rng.uniform(0.1, 1.4))
    second = np.einsum("ka,kb,k->ab", x, x, area)
    section = Section(area.sum(), second[1, 1], second[0, 0], np.nan)
    offset = Offset(area @ x, second[0, 1])
    assert np.abs(offset.first).min() > 0.01
    exact = three_dimensional_energy(delta, kappa, x, area)
    gamma = delta + delta.T
    assert offset_energy(YOUNG, POISSON, section, offset, gamma, kappa) == pytest.approx(
        exact, rel=1e-12
    )
    k = integrated_stiffnesses(YOUNG, POISSON, section)
    assert abs(strain_energy(k, gamma, kappa) - exact) > 1e-6
    alone = Offset(offset.first, 0.0)
    assert abs(offset_energy(YOUNG, POISSON, section, alone, gamma, kappa) - exact) > 1e-9


def an_energy_of_stretches(mu, slope):
    """w of mu_i, mu_alpha' that is nothing in particular, with its derivatives by both."""
    a, b = np.array([1.3, -0.7, 2.1]), np.array([0.9, 1.7])
    wave = np.sin(a @ mu + b @ slope)
    w = wave + mu.prod() * slope[0] + (slope**2).sum() * mu[2]
    change = np.cos(a @ mu + b @ slope)
    others = np.array([mu[1] * mu[2], mu[0] * mu[2], mu[0] * mu[1]])
    by_mu = change * a + slope[0] * others + np.array([0, 0, (slope**2).sum()])
    return w, by_mu, change * b + mu.prod() * np.array([1, 0]) + 2 * slope * mu[2]


@given(st.integers(0, 10_000))
def test_forces_are_the_gradient_of_an_energy_of_the_stretches_1_3_20(seed):
    d, d_prime = state(seed)
    _, by_mu, by_slope = an_energy_of_stretches(*stretches(d, d_prime))
    n, k, m = internal_forces(d, d_prime, by_mu, by_slope)
    h = 1e-6

    def energy(x):
        return an_energy_of_stretches(*stretches(x[:9].reshape(3, 3), x[9:].reshape(2, 3)))[0]

    at = np.concatenate([d.ravel(), d_prime.ravel()])
    found = np.array([energy(at + h * e) - energy(at - h * e) for e in np.eye(15)]) / (2 * h)
    np.testing.assert_allclose(found, np.concatenate([k.ravel(), n, m.ravel()]), atol=1e-7)
    along, _, across = stretch_gradients(d, d_prime)
    assert (
        np.abs(k - by_mu[:2, None] * along[:2]).max() > 1e-6
    )  # directors that turn: the second term is there
    np.testing.assert_allclose(np.cross(across, m), 0, atol=1e-12)


SHAPE = Section(0.28, 0.0037, 0.0114, 0.009)
ADJUSTED = adjusted_stiffnesses(YOUNG, POISSON, SHAPE, 5 / 6)


def forces_at(d, d_prime, k=ADJUSTED):
    """n, k^alpha, m^alpha of the energy (1.2.97)."""
    return forces(d, d_prime, *energy_gradient(k, *measures(d, d_prime)))


def differences(energy, x):
    """Gradient of a function that is a polynomial of fourth degree along every axis: exact but for rounding."""
    h = 0.25

    def slope(e):
        near, far = energy(x + h * e) - energy(x - h * e), energy(x + 2 * h * e) - energy(x - 2 * h * e)
        return (8 * near - far) / (12 * h)

    return np.array([slope(e) for e in np.eye(x.size)])


@given(st.integers(0, 10_000))
def test_forces_of_the_energy_1_2_97_are_its_gradient_1_3_18(seed):
    d, d_prime = state(seed, 0.8)

    def energy(x):
        return strain_energy(ADJUSTED, *measures(x[:9].reshape(3, 3), x[9:].reshape(2, 3)))

    n, k, m = forces_at(d, d_prime)
    found = differences(energy, np.concatenate([d.ravel(), d_prime.ravel()]))
    np.testing.assert_allclose(
        found, np.concatenate([k.ravel(), n, m.ravel()]), atol=1e-13 * np.abs(found).max()
    )


@given(st.integers(0, 10_000))
def test_forces_at_small_strains_are_resultants_of_the_stress(seed):
    """Half the difference of the forces at two opposite small states, against the integrals over a rectangle."""
    width, height = 0.7, 0.4
    section = Section(width * height, width * height**3 / 12, height * width**3 / 12, np.nan)
    k = integrated_stiffnesses(YOUNG, POISSON, section)
    rng = np.random.default_rng(seed)
    delta, kappa = rng.uniform(-1, 1, (3, 3)), rng.uniform(-1, 1, (2, 3))
    h = 1e-5
    ahead, behind = (forces_at(np.eye(3) + s * delta, s * kappa, k) for s in (h, -h))
    for one, other, exact in zip(
        ahead, behind, resultants(delta, kappa, *rectangle(width, height)), strict=True
    ):
        np.testing.assert_allclose((one - other) / (2 * h), exact, atol=1e-8)


@given(st.integers(0, 10_000))
def test_angular_momentum_is_balanced_1_2_91(seed):
    """Of both energies, to rounding at any state; not of forces that lack their part from the bending measures."""
    d, d_prime = state(seed, 0.8)
    _, by_mu, by_slope = an_energy_of_stretches(*stretches(d, d_prime))
    of_stretches = internal_forces(d, d_prime, by_mu, by_slope)
    of_measures = forces_at(d, d_prime)
    for n, k, m in (of_stretches, of_measures):
        scale = max(np.abs(n).max(), np.abs(k).max(), np.abs(m).max())
        assert np.abs(unbalanced_couple(d, d_prime, n, k, m)).max() < 1e-14 * scale
    by_gamma, _ = energy_gradient(ADJUSTED, *measures(d, d_prime))
    n, k = 2 * by_gamma[2] @ d, 2 * by_gamma[:2] @ d
    assert np.abs(unbalanced_couple(d, d_prime, n, k, of_measures[2])).max() > 1e-7


@given(st.integers(0, 10_000))
def test_forces_rotate_with_the_rod_and_its_energy_does_not_change(seed):
    d, d_prime = state(seed, 0.8)
    turn = Rotation.random(random_state=seed).as_matrix()
    energies = [
        strain_energy(ADJUSTED, *measures(*turned))
        for turned in ((d, d_prime), (d @ turn, d_prime @ turn))
    ]
    assert energies[1] == pytest.approx(energies[0], rel=1e-13)
    for here, there in zip(forces_at(d, d_prime), forces_at(d @ turn, d_prime @ turn), strict=True):
        np.testing.assert_allclose(here @ turn, there, atol=1e-13 * max(1, np.abs(here).max()))


@given(st.integers(0, 10_000))
def test_the_energy_grows_by_the_power_of_the_forces(seed):
    """(1.3.11) along a random motion."""
    d, d_prime = state(seed)
    rate, rate_prime = np.random.default_rng(seed + 1).uniform(-1, 1, (2, 3, 3))

    def energy(t):
        return strain_energy(ADJUSTED, *measures(d + t[0] * rate, d_prime + t[0] * rate_prime[:2]))

    n, k, m = forces_at(d, d_prime)
    power = n @ rate[2] + (k * rate[:2]).sum() + (m * rate_prime[:2]).sum()
    assert power == pytest.approx(differences(energy, np.zeros(1))[0], abs=1e-12)


def test_a_twisted_circle_carries_the_couple_of_torsion_theory():
    """The couple (1.2.89) on a section; with the printed sign of D in (1.2.98), E1.1, there would be none."""
    circle = Section.circle(0.3)
    _, shear = lame(YOUNG, POISSON)
    twist = 1e-3
    d_prime = twist * np.array([[0, 1.0, 0], [-1.0, 0, 0]])
    _, _, m = forces_at(np.eye(3), d_prime, adjusted_stiffnesses(YOUNG, POISSON, circle, 5 / 6))
    np.testing.assert_allclose(
        couple(np.eye(3), m), [0, 0, twist * shear * circle.torsion_constant], atol=1e-15
    )


# ---------------------------------------------------------------- inertia


def moving(seed):
    """A section off its centre and out of its axes: its places, their masses, its inertia, and a motion of it."""
    rng = np.random.default_rng(seed)
    x, area = rectangle(0.7, 0.4, centre=rng.uniform(0.1, 0.5, 2), turn=rng.uniform(0.1, 1.4))
    second = np.einsum("ka,kb,k->ab", x, x, area)
    section = Section(area.sum(), second[1, 1], second[0, 0], np.nan)
    inertia = Inertia.homogeneous(2.5, section, Offset(area @ x, second[0, 1]))
    return x, 2.5 * area, inertia, rng.uniform(-1, 1, 3), rng.uniform(-1, 1, (2, 3))


@given(st.integers(0, 10_000))
def test_momenta_and_kinetic_energy_are_sums_over_the_section(seed):
    """(1.2.39), (1.2.41), (1.2.43) and (1.2.45) against the points of the section with their velocities (1.2.11)."""
    x, mass, inertia, v, w = moving(seed)
    r, d = np.array([0.3, -0.2, 1.1]), state(seed)[0]
    velocity, place = v + x @ w, r + x @ d[:2]
    linear, director = inertia.momenta(v, w)
    np.testing.assert_allclose(linear, mass @ velocity, atol=1e-13)
    np.testing.assert_allclose(director, (mass[:, None] * x).T @ velocity, atol=1e-13)
    assert inertia.kinetic_energy(v, w) == pytest.approx((mass @ velocity**2).sum() / 2, rel=1e-13)
    np.testing.assert_allclose(
        inertia.angular_momentum(r, d, v, w), mass @ np.cross(place, velocity), atol=1e-13
    )


@given(st.integers(0, 10_000))
def test_a_section_that_turns_rigidly_has_the_moment_of_inertia_1_2_34(seed):
    _, _, inertia, omega, _ = moving(seed)
    w = np.cross(omega, np.eye(3)[:2])
    turning = inertia.angular_momentum(np.zeros(3), np.eye(3), np.zeros(3), w)
    np.testing.assert_allclose(turning, inertia.tensor @ omega, atol=1e-14)
    assert inertia.kinetic_energy(np.zeros(3), w) == pytest.approx(omega @ inertia.tensor @ omega / 2)


@given(st.integers(0, 10_000))
def test_gradients_of_the_stretches_1_3_19(seed):
    d, d_prime = state(seed)
    by_d, turned, by_slope = stretch_gradients(d, d_prime)
    h = 1e-6
    for i in range(3):
        for j in range(3):
            shift = np.zeros((3, 3))
            shift[i, j] = h
            change = [
                (a - b) / (2 * h)
                for a, b in zip(
                    stretches(d + shift, d_prime), stretches(d - shift, d_prime), strict=True
                )
            ]
            expected = np.zeros(3)
            expected[i] = by_d[i, j]
            np.testing.assert_allclose(change[0], expected, atol=1e-8)
            expected = np.zeros(2)
            if i < 2:
                expected[i] = turned[i, j]
            np.testing.assert_allclose(change[1], expected, atol=1e-8)
            if i < 2:
                slope = (stretches(d, d_prime + shift[:2])[1] - stretches(d, d_prime - shift[:2])[1]) / (
                    2 * h
                )
                assert slope[i] == pytest.approx(by_slope[i, j], abs=1e-8)
                assert slope[1 - i] == 0


def test_the_measures_vanish_in_the_reference_and_under_rotation():
    for rotation in (np.eye(3), Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix()):
        gamma, kappa = measures(rotation, np.zeros((2, 3)))
        assert np.abs(gamma).max() < 1e-15
        assert not kappa.any()


@pytest.mark.parametrize("shape", [Section.circle(0.3), Section(0.28, 0.0037, 0.0114, 0.009)])
def test_adjusted_stiffnesses_give_known_bending_torsion_and_tension(shape):
    k = adjusted_stiffnesses(YOUNG, POISSON, shape, 5 / 6)
    _, shear = lame(YOUNG, POISSON)
    none = np.zeros((3, 3))
    twist, bend = np.zeros((2, 3)), np.zeros((2, 3))
    twist[0, 1], twist[1, 0] = 1.0, -1.0
    bend[1, 2] = 1.0
    assert 2 * strain_energy(k, none, twist) == pytest.approx(shear * shape.torsion_constant)
    assert 2 * strain_energy(k, none, bend) == pytest.approx(YOUNG * shape.second_moment_1)
    # free to contract, a stretched section answers with E A: minimise over gamma_11 and gamma_22
    matrix = np.array([[2 * k[1], k[7], k[8]], [k[7], 2 * k[2], k[9]], [k[8], k[9], 2 * k[3]]]) / 2
    reduced = matrix[2, 2] - matrix[2, :2] @ np.linalg.solve(matrix[:2, :2], matrix[:2, 2])
    assert 4 * reduced == pytest.approx(YOUNG * shape.area)


def test_E1_1_with_the_printed_sign_a_twisted_rod_stores_nothing():
    circle = Section.circle(0.3)
    k = adjusted_stiffnesses(YOUNG, POISSON, circle, 5 / 6)
    _, shear = lame(YOUNG, POISSON)
    polar, torsion = shear * 2 * circle.second_moment_1, shear * circle.torsion_constant
    printed = {**k, 12: (polar - torsion) / 4, 13: (polar - torsion) / 4}
    twist = np.array([[0, 1.0, 0], [-1.0, 0, 0]])
    assert 2 * strain_energy(printed, np.zeros((3, 3)), twist) == pytest.approx(0, abs=1e-15)
    assert 2 * strain_energy(k, np.zeros((3, 3)), twist) == pytest.approx(torsion)


def test_E1_2_k11_takes_the_moment_about_the_first_axis():
    width, height = 0.7, 0.4
    section = Section(width * height, width * height**3 / 12, height * width**3 / 12, np.nan)
    kappa = np.zeros((2, 3))
    kappa[1, 1] = 1.0
    exact = three_dimensional_energy(np.zeros((3, 3)), kappa, *rectangle(width, height))
    k = adjusted_stiffnesses(YOUNG, POISSON, section, 1.0)
    assert strain_energy({11: k[11]}, np.zeros((3, 3)), kappa) == pytest.approx(exact)
    assert (
        strain_energy({11: k[10]}, np.zeros((3, 3)), kappa) > 2 * exact
    )  # I_2 in its place, as printed


def test_E1_3_current_inertias_need_the_density():
    """A circle of density 1000 kg/m^3 under a homogeneous stretch: rho_0 y_0 = mu_3 rho y with rho in both."""
    d, _ = state(3)
    radius, density_0 = 0.3, 1000.0
    nodes, weights = np.polynomial.legendre.leggauss(8)
    r, w = (nodes + 1) * radius / 2, weights * radius / 2
    angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    x_1 = r[:, None] * np.cos(angle)
    dA = np.outer(w * r, np.full(16, np.pi / 8))
    rho_0 = density_0 * dA.sum()  # (1.2.30)
    y_0 = (x_1**2 * density_0 * dA).sum() / rho_0  # (1.2.32)
    mu = np.linalg.norm(d, axis=1)
    e = d / mu[:, None]
    jacobian = np.linalg.det(d)
    density = density_0 / jacobian  # (1.1.35)
    triple, da = np.linalg.det(e), mu[0] * mu[1] * dA
    rho = triple * (density * da).sum()  # (1.2.48)
    integral = triple * (x_1**2 * density * da).sum()  # the right side of (1.2.61)
    assert mu[2] * rho == pytest.approx(rho_0)  # (1.2.52)
    assert mu[2] * integral == pytest.approx(
        rho_0 * y_0
    )  # so the left side of (1.2.61) is rho y, and y = y_0
    assert mu[2] * integral != pytest.approx(y_0, rel=0.5)  # (1.2.61) with (1.2.62) as printed
