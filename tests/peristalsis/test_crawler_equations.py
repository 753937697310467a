"""Chapter 2 with units: moduli of section 2.6, governing equations as printed, the shape on the ground."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import cosserat
from cosserat.peristalsis.crawler import Compressible, Crawler, Groups, Incompressible
from cosserat.peristalsis.instant import InstantProblem, Region
from cosserat.rods.constrained_rod import INCOMPRESSIBLE
from cosserat.rods.directed_rod import Section, integrated_stiffnesses, internal_forces, strain_energy
from cosserat.solvers.regions import RegionSettings

WORM, ROBOT = (cosserat.case(name).problem for name in ("worm", "soft_robot"))
YOUNG, POISSON, RADIUS = 1e4, 0.3, 0.02
BODY = Crawler(length=0.3, radius=RADIUS, mass=0, material=Compressible(young=YOUNG, poisson=POISSON))


def test_compliance_of_the_compressible_rod_is_2_6_2():
    """(2.6.1) with (2.6.2) inverts (2.3.2); so follow the moduli (2.6.4), (2.6.6), the strains (2.6.5), and (2.6.7)."""
    k_s, k_p, k_g = BODY.stiffnesses
    stiffness = np.diag([k_s - k_p] * 3 + [k_g] * 2)
    stiffness[:3, :3] += k_p
    k = (k_s - k_p) * (k_s + 2 * k_p)
    compliance = np.zeros((5, 5))
    compliance[:3, :3] = ((k_s + 2 * k_p) * np.eye(3) - k_p) / k
    compliance[3:, 3:] = np.eye(2) / k_g
    np.testing.assert_allclose(compliance @ stiffness, np.eye(5), atol=1e-15)
    assert k / (BODY.area * (k_p + k_s)) == pytest.approx(YOUNG)
    assert k_p / (k_p + k_s) == pytest.approx(POISSON)
    pulled = compliance @ np.array([0, 0, 0.1, 0, 0])
    assert pulled[0] / pulled[2] == pytest.approx(-POISSON)
    lame = YOUNG * BODY.area / ((1 + POISSON) * (1 - 2 * POISSON))
    assert (k_s, k_p) == pytest.approx(((1 - POISSON) * lame, POISSON * lame))


def test_stiffnesses_of_the_incompressible_rod_are_the_limit_of_the_compressible():
    """(2.6.17) and (2.6.22) from (2.6.20) as nu tends to 1/2."""
    almost = BODY.replace(material=Compressible(young=YOUNG, poisson=0.5 - 1e-7))
    k_s, k_p, k_g = almost.stiffnesses
    limit = BODY.replace(material=Incompressible(young=YOUNG)).incompressible_stiffnesses
    assert limit == pytest.approx((k_s - k_p, k_g), rel=1e-6)


def energy_2_6_18(mu, slope):
    """2 w of (2.6.18) as printed, of stretches (3,) and their slopes (2,)."""
    k_1 = YOUNG * np.pi * RADIUS**2 * (1 - POISSON) / (4 * (1 + POISSON) * (1 - 2 * POISSON))
    k_2 = YOUNG * np.pi * RADIUS**4 / (8 * (1 + POISSON))
    k_3 = POISSON / (1 - POISSON) * k_1
    g = mu**2 - 1
    pairs = g[0] * g[1] + g[0] * g[2] + g[1] * g[2]
    return k_1 * (g**2).sum() + k_2 * ((slope * mu[:2]) ** 2).sum() + 2 * k_3 * pairs


@given(st.integers(0, 10_000))
def test_the_energy_2_6_18_is_that_of_chapter_1_without_shear(seed):
    rng = np.random.default_rng(seed)
    mu, slope = rng.uniform(0.5, 1.5, 3), rng.uniform(-30, 30, 2)
    kappa = np.zeros((2, 3))
    kappa[[0, 1], [0, 1]] = mu[:2] * slope
    k = integrated_stiffnesses(YOUNG, POISSON, Section.circle(RADIUS))
    assert energy_2_6_18(mu, slope) == pytest.approx(
        2 * strain_energy(k, np.diag(mu**2 - 1), kappa), rel=1e-12
    )


@given(st.integers(0, 10_000))
def test_the_quadratic_part_of_2_6_18_has_the_stiffnesses_of_the_crawler(seed):
    """(2.6.19) is (2.3.1) with (2.6.20); the rest falls with the third power of the strains."""
    rng = np.random.default_rng(seed)
    e, slope = rng.uniform(-1, 1, 3), rng.uniform(-30, 30, 2)
    k_s, k_p, k_g = BODY.stiffnesses
    quadratic = k_s * (e**2).sum() + k_g * (slope**2).sum()
    quadratic += 2 * k_p * (e[0] * e[1] + e[0] * e[2] + e[1] * e[2])
    h = 1e-4
    both = energy_2_6_18(1 + h * e, h * slope) + energy_2_6_18(1 - h * e, -h * slope)
    assert both / (2 * h**2) == pytest.approx(quadratic, rel=1e-6)


def test_the_sum_of_the_strains_is_the_change_of_volume_to_first_order():
    """(2.6.10) against (2.6.11), (2.6.12): what is left is a product of two strains."""
    e = np.array([0.7, -0.4, 0.8])
    for h in (1e-2, 1e-3):
        left = np.prod(1 + h * e) - 1 - h * e.sum()
        assert left == pytest.approx(h**2 * (e[0] * e[1] + e[0] * e[2] + e[1] * e[2]), abs=h**3)


def test_loads_on_the_directors_are_integrals_round_and_over_the_section():
    """(1.2.79): a pressure on the surface, (2.2.8), pulls both directors in, (2.2.9); gravity, (2.2.18), neither.

    Gravity is a force by (1.2.67), (2.2.19): rho_0 g.
    """
    angles = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    x, pressure = RADIUS * np.column_stack([np.cos(angles), np.sin(angles)]), 50.0
    dU = np.full(64, RADIUS * 2 * np.pi / 64)
    loads = np.einsum("ka,kb,k->ab", x, -pressure * x / RADIUS, dU)  # of both directors, along E_1, E_2
    np.testing.assert_allclose(loads, -pressure * np.pi * RADIUS**2 * np.eye(2), atol=1e-16)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    rings, fraction = (nodes + 1) * RADIUS / 2, weights * RADIUS / 2
    body_force = np.array([1000.0 * -9.81, 0])
    dA = np.outer(rings * fraction, np.full(64, 2 * np.pi / 64)).ravel()
    inside = (rings[:, None, None] / RADIUS * x).reshape(-1, 2)
    np.testing.assert_allclose(np.einsum("ka,b,k->ab", inside, body_force, dA), 0, atol=1e-16)
    np.testing.assert_allclose(dA.sum() * body_force, [-9.81 * 1000 * BODY.area, 0], rtol=1e-12)


@given(st.integers(0, 10_000))
def test_sources_of_the_compressible_rod_are_the_equations_with_units(seed):
    """(2.3.3) under an anchoring load, (2.3.7) under an advancing one, n = 0 with erratum E2.1; contact as printed."""
    body, loads = ROBOT.crawler, ROBOT.loads.replace(contact="printed")
    k_s, k_p, k_g = body.stiffnesses
    mu = np.random.default_rng(seed).uniform(0.7, 1.3, 2)
    groups = Groups.of(body, loads)
    weight = body.radius * body.line_density * loads.gravity
    for force, pressure in ((-loads.anchoring, 0.0), (0.0, loads.advancing)):
        c = np.array([groups.c * (pressure > 0)])
        f, _, mu_3 = groups.compressible_source(mu[None], np.array([force / k_s]), c)
        along = mu_3[0]
        assert force == pytest.approx(k_s * along + k_p * mu.sum() - k_s - 2 * k_p, abs=1e-9 * k_s)
        for k in range(2):
            elastic = k_s * mu[k] + k_p * (mu[1 - k] + along) - k_s - 2 * k_p
            loaded = pressure * np.pi * body.radius**2 + (weight / along if k == 0 else 0)
            second = f[0, k] / body.length**2  # mu'' by xi
            assert k_g * second == pytest.approx(loaded + elastic, abs=1e-9 * k_s)


@given(st.integers(0, 10_000))
def test_sources_of_the_incompressible_rod_are_the_equations_with_units(seed):
    """(2.4.7), (2.4.8) under an anchoring load, (2.4.11) under an advancing one, contact as printed."""
    body, loads = WORM.crawler, WORM.loads.replace(contact="printed")
    k_i, k_g = body.incompressible_stiffnesses
    rng = np.random.default_rng(seed)
    mu, groups = rng.uniform(0.7, 1.3, 2), Groups.of(body, loads)
    weight = body.radius * body.line_density * loads.gravity
    own = -loads.anchoring / mu.prod()
    for multiplier, pressure in ((own, 0.0), (own * rng.uniform(0, 1), loads.advancing)):
        scaled = np.array([multiplier * body.length**2 / k_g])
        c = np.array([groups.c * (pressure > 0)])
        f, _, _ = groups.incompressible_source(mu[None], scaled, np.ones(1), c)
        for k in range(2):
            loaded = pressure * np.pi * body.radius**2 + (weight * mu.prod() if k == 0 else 0)
            inner = multiplier / mu[k] + k_i * (2 * mu[k] + mu[1 - k] - 3)
            assert k_g * f[0, k] / body.length**2 == pytest.approx(loaded + inner, abs=1e-9 * k_i)


def test_forces_of_the_incompressible_rod_are_gradients_and_a_reaction():
    """(2.1.2) with the quadratic energy under (2.4.3) and the reaction (2.2.15): the relations (2.4.4)."""
    k_i, k_g = WORM.crawler.incompressible_stiffnesses
    mu, slope, multiplier = np.array([0.9, 1.2]), np.array([3.0, -2.0]), 0.02
    d = np.diag([*mu, 1 / mu.prod()])
    by_mu = np.array([*(k_i * (2 * mu + mu[::-1] - 3)), 0])
    n, k, m = internal_forces(d, np.diag([*slope, 0])[:2], by_mu, k_g * slope)
    reaction = multiplier * INCOMPRESSIBLE.gradient(d)
    np.testing.assert_allclose(n + reaction[2], [0, 0, multiplier * mu.prod()], atol=1e-16)
    relations = np.diag([*(by_mu[:2] + multiplier / mu), 0])[:2]
    np.testing.assert_allclose(k + reaction[:2], relations, atol=1e-16)
    np.testing.assert_allclose(m, np.diag([*(k_g * slope), 0])[:2], atol=1e-16)


@pytest.mark.parametrize("problem", [WORM, ROBOT], ids=["worm", "robot"])
def test_the_lowest_line_stays_on_the_ground_and_the_centreline_is_as_long_as_it_is_stretched(problem):
    """(2.5.1)-(2.5.4) of a solved instant: x' = R mu_1', and x', z' together are mu_3 long."""
    regions = [Region(0, 0.3, "anchoring"), Region(0.3, 0.7, "advancing"), Region(0.7, 1, "anchoring")]
    fine = RegionSettings(elements=12, degree=10)
    profile, _ = InstantProblem(problem.crawler, problem.loads, regions, "test").solve(fine, None)
    body, z = problem.crawler, np.linspace(0, 1, 20_001)
    stored = problem.replace(sections=z.size).fields(
        [profile], [problem.length_along(profile)], [regions]
    )
    fields = {name: values for name, (_, values) in stored.items()}
    xi, x, along, mu_1 = (fields["xi_section"], *(fields[n][0] for n in ("height", "along", "mu_1")))
    np.testing.assert_allclose(x - body.radius * mu_1, -body.radius, atol=1e-16)
    inside = (np.abs(z[:-1] - 0.3) > 1e-3) & (
        np.abs(z[:-1] - 0.7) > 1e-3
    )  # mu_3 of the robot jumps there
    middle = ((fields["mu_3"][0, 1:] + fields["mu_3"][0, :-1]) / 2)[inside]
    steps = (np.hypot(np.diff(x), np.diff(along)) / np.diff(xi))[inside]
    np.testing.assert_allclose(steps, middle, rtol=3e-5)
    alone = (np.diff(along) / np.diff(xi))[inside]  # without x' the rod would be too short
    assert np.abs(alone / middle - 1).max() > 1e-3


def test_the_contact_force_is_continuous_at_both_junctions():
    """(2.4.14) at gamma, (2.4.15) at eta: lambda_c mu_1 mu_2 is -delta on either side of each."""
    regions = [Region(0, 0.3, "anchoring"), Region(0.3, 0.7, "advancing"), Region(0.7, 1, "anchoring")]
    problem = InstantProblem(WORM.crawler, WORM.loads, regions, "test")
    profile, _ = problem.solve(RegionSettings(), None)
    force = profile.multiplier * profile.mu.prod(axis=2)
    np.testing.assert_allclose(force, -problem.groups.force, rtol=1e-12)
    at = np.array([0.3 - 1e-9, 0.3 + 1e-9, 0.7 - 1e-9, 0.7 + 1e-9])
    mu, _, _, multiplier = profile.at(at)
    np.testing.assert_allclose(multiplier * mu.prod(axis=1), -problem.groups.force, rtol=1e-12)


def test_fronts_of_the_soft_robot_are_those_of_2_7():
    """gamma by (2.7.1) from the end of the pause on, eta by (2.7.2), both at the speed and with T of Fig. 2.8."""
    gait, length, speed, pause, fraction = ROBOT.gait, ROBOT.crawler.length, 0.0254, 5.0, 0.25
    crossing = length / speed
    later = pause + crossing * (1 - fraction)
    for phase in np.linspace(0.05, 3.95, 40):
        t = gait.time(phase)
        expected = []
        if pause < t < later + crossing:
            expected = [((length - speed * (t - later)) / length, "eta")] if t > later else []
            expected += (
                [((length - speed * (t - pause)) / length, "gamma")] if t < pause + crossing else []
            )
        found = gait.fronts(phase)
        assert [kind for _, kind in found] == [kind for _, kind in sorted(expected)]
        assert [at for at, _ in found] == pytest.approx([at for at, _ in sorted(expected)], abs=1e-12)
    assert gait.duration == pytest.approx(pause + crossing * (2 - fraction))
