"""The kernel of the published rod: derivatives, invariance, balance, and the meaning of its terms."""

import numpy as np
import pytest
from conftest import assembled, make_rod, random_state
from hypothesis import given
from hypothesis import strategies as st

from cosserat.rods.energies import hemingway
from cosserat.rods.kinematics import PLANAR
from cosserat.rods.reference import strains

SEEDS = st.integers(0, 2**32 - 1)
SIZES = st.sampled_from([3, 4, 5, 9])
STEP = 1e-3  # of a fourth-order central difference, as a share of the shortest length


def body_of(n, **changes):
    rod = make_rod(vertices=n, **changes)
    return rod, rod.strain_energy.potential(rod, rod.geometry())


def stiffness_of(rod):
    return rod.strain_energy.stiffness(rod, rod.geometry())


def fourth_order(function, q, direction, h):
    """Derivative of a function along a direction, to h^4."""

    def at(k):
        return function(q + k * h * direction)

    return (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h)


@given(seed=SEEDS, n=SIZES)
def test_gradient_is_that_of_the_energy(seed, n):
    rod, body = body_of(n)
    q = random_state(rod, seed)
    direction = np.random.default_rng(seed + 1).standard_normal(q.size)
    _, gradient, _ = assembled(body, q)
    measured = fourth_order(lambda p: assembled(body, p)[0], q, direction, STEP * rod.height / 2 / 4)
    scale = np.abs(gradient) @ np.abs(direction)
    assert abs(gradient @ direction - measured) <= 1e-7 * scale


@given(seed=SEEDS, n=SIZES)
def test_hessian_is_that_of_the_gradient(seed, n):
    rod, body = body_of(n)
    q = random_state(rod, seed)
    direction = np.random.default_rng(seed + 1).standard_normal(q.size)
    _, _, hessian = assembled(body, q)
    measured = fourth_order(lambda p: assembled(body, p)[1], q, direction, STEP * rod.height / 2 / 4)
    scale = (np.abs(hessian) @ np.abs(direction)).max()
    assert np.abs(hessian @ direction - measured).max() <= 1e-7 * scale


@given(seed=SEEDS)
def test_each_term_alone_has_its_own_derivatives(seed):
    rod = make_rod(vertices=6)
    full = stiffness_of(rod)
    q = random_state(rod, seed)
    direction = np.random.default_rng(seed + 1).standard_normal(q.size)
    for name in ("k1", "k2", "k3", "k4", "k5", "k6", "k7"):
        others = {
            k: np.zeros_like(getattr(full, k)) for k in full._fields if k.startswith("k") and k != name
        }
        body = hemingway.potential(full._replace(**others))
        _, gradient, hessian = assembled(body, q)
        slope = fourth_order(lambda p, b=body: assembled(b, p)[0], q, direction, 1e-4)
        curve = fourth_order(lambda p, b=body: assembled(b, p)[1], q, direction, 1e-4)
        assert abs(gradient @ direction - slope) <= 1e-7 * (np.abs(gradient) @ np.abs(direction)), name
        assert (
            np.abs(hessian @ direction - curve).max()
            <= 1e-7 * (np.abs(hessian) @ np.abs(direction)).max()
        ), name


@given(seed=SEEDS, n=SIZES, angle=st.floats(-np.pi, np.pi), shift=st.tuples(*[st.floats(-5, 5)] * 2))
def test_rigid_motion_leaves_energy_and_forces_unchanged(seed, n, angle, shift):
    rod, body = body_of(n)
    q = random_state(rod, seed, turn=0.0)
    c, s = np.cos(angle), np.sin(angle)
    R = np.array([[c, -s], [s, c]])
    moved = (q.reshape(n, 2, 2) @ R.T + np.array([shift, (0, 0)])).ravel()
    energy, gradient, _ = assembled(body, q)
    energy_moved, gradient_moved, _ = assembled(body, moved)
    turned = (gradient.reshape(n, 2, 2) @ R.T).ravel()
    assert abs(energy_moved - energy) <= 1e-12 * energy
    assert np.abs(gradient_moved - turned).max() <= 1e-12 * np.abs(gradient).max()


@given(seed=SEEDS, n=SIZES)
def test_forces_of_a_free_rod_have_no_resultant_and_no_moment(seed, n):
    rod, body = body_of(n)
    q = random_state(rod, seed)
    _, gradient, _ = assembled(body, q)
    scale = np.abs(gradient).max()
    for motion in PLANAR.rigid_motions(q):
        assert abs(gradient @ motion) <= 1e-12 * scale * np.abs(motion).sum()


def test_reference_configuration_has_no_energy_and_no_force():
    rod, body = body_of(20)
    geometry = rod.geometry()
    energy, gradient, hessian = assembled(body, geometry.q)
    assert abs(energy) < 1e-12
    assert np.abs(gradient).max() <= np.finfo(float).eps * np.abs(hessian).max() * rod.length
    values = np.linalg.eigvalsh(hessian)
    assert (np.abs(values[:3]) < 1e-8 * values[-1]).all()  # the three rigid motions, and no other
    assert values[3] > 1e-7 * values[-1]


def test_half_bandwidth_is_reached_and_not_exceeded():
    rod, body = body_of(8)
    q = random_state(rod, 1)
    wide = np.empty((q.size, body.half_bandwidth + 1))
    body.assemble(q, np.empty(q.size), wide)
    assert np.abs(wide[:, -1]).max() > 0
    direction = np.zeros(q.size)
    direction[0] = 1.0
    column = fourth_order(lambda p: assembled(body, p)[1], q, direction, 1e-4)
    assert np.abs(column[body.half_bandwidth + 1 :]).max() == 0.0


def test_energy_terms_are_those_of_3_4_11_written_out():
    """Eq. (3.4.11), corrected by E3.1 and E3.2, from the strains as `strains` measures them: that is (3.4.12)."""
    rod = make_rod(vertices=7)
    geometry = rod.geometry()
    body = rod.strain_energy.potential(rod, geometry)
    k, q = stiffness_of(rod), random_state(rod, 3)
    x, d = np.hsplit(q.reshape(-1, 4), 2)
    s = strains(geometry, x, d)
    E, L, inner = geometry.edge_length, geometry.voronoi_length, slice(1, -1)
    expected = [
        (k.k1 * (s.mu_edge**2 - s.mu_edge + 1 / s.mu_edge - 1) * E).sum() / 2,
        (k.k2 * (s.lam**2 - s.lam + 1 / s.lam - 1) * L).sum() / 2,
        (k.k3 * (s.mu * s.kappa) ** 2 * L)[inner].sum() / 2,
        (k.k4 * np.tan(s.theta) ** 2 * L).sum() / 2,
        (k.k5 * (np.diff(s.theta) / E) ** 2 * E).sum() / 2,
        (k.k6 * (np.diff(s.lam) / E) ** 2 * E).sum() / 2,
        (k.k7 * (s.lam - 1) * (s.mu - 1) * L)[inner].sum(),
    ]
    np.testing.assert_allclose(body.energy_terms(q), expected, rtol=1e-12)


def test_angles_have_the_signs_of_the_page():
    """Upward curving is positive, eq. (3.3.18); an acute angle of director and tangent is negative, eq. (3.3.26)."""
    rod = make_rod(vertices=3)
    geometry = rod.geometry()
    x = geometry.X + np.array([[0, 0.1], [0, 0], [0, 0.1]])
    s = strains(geometry, x, geometry.D)
    assert s.phi[1] > 0
    leaning = geometry.D + np.array([0.1, 0.0])
    assert (strains(geometry, geometry.X, leaning).theta < 0).all()


def test_curvature_of_a_regular_polygon_is_that_of_its_inscribed_circle():
    """Eq. (3.3.22): the osculating circle touches the edges at half a Voronoi length from the vertex."""
    n, radius = 12, 2.0
    angles = np.linspace(0, np.pi / 2, n)
    x = radius * np.column_stack([np.sin(angles), 1 - np.cos(angles)])
    rod = make_rod(vertices=n)
    s = strains(rod.geometry(), x, rod.geometry().D)
    np.testing.assert_allclose(s.kappa[1:-1], 1 / (radius * np.cos(angles[1] / 2)), rtol=1e-12)


@pytest.mark.parametrize("shear", [1.6, np.pi, -1.6])
def test_the_energy_is_infinite_at_the_barriers(shear):
    """Sections sheared to a right angle or beyond, and sections of no length, have infinite energy (Fig. 3.7)."""
    rod, body = body_of(5)
    geometry = rod.geometry()
    turned = geometry.D @ np.array([[np.cos(shear), np.sin(shear)], [-np.sin(shear), np.cos(shear)]])
    assert assembled(body, np.hstack([geometry.X, turned]).ravel())[0] == np.inf
    assert assembled(body, np.hstack([geometry.X, 0 * geometry.D]).ravel())[0] == np.inf
    assert assembled(body, np.hstack([0 * geometry.X, geometry.D]).ravel())[0] == np.inf


def test_the_energy_tends_to_infinity_at_the_barriers():
    rod, body = body_of(5)
    geometry = rod.geometry()
    for squeeze in (1e-2, 1e-4):
        thin = np.hstack([geometry.X, squeeze * geometry.D]).ravel()
        short = np.hstack([squeeze * geometry.X, geometry.D]).ravel()
        for q in (thin, short):
            assert assembled(body, q)[0] * squeeze > 1e7


def test_end_sections_halved_touches_the_boundary_vertices_only():
    full, halved = (
        stiffness_of(make_rod(vertices=6, end_sections=reading)) for reading in ("full", "halved")
    )
    for name in ("k2", "k4", "k7"):
        np.testing.assert_array_equal(getattr(halved, name)[1:-1], getattr(full, name)[1:-1])
        np.testing.assert_array_equal(getattr(halved, name)[[0, -1]], getattr(full, name)[[0, -1]] / 2)
