"""Chapter 3, equation by equation: those in which a fault changes no solved case."""

import itertools

import numpy as np
import pytest
from conftest import make_rod
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

import cosserat
from cosserat.exact.beams import Beam, first_beam_mode, first_frequency
from cosserat.rods.reference import Geometry, lengths, strains, to_vertices, vertex_tangents
from cosserat.solvers.banded import to_dense

SEEDS = st.integers(0, 10_000)


def polygon(seed, n=7):
    """Vertices (n, 2) of a line that turns to and fro, with edges of every length."""
    rng = np.random.default_rng(seed)
    angles = np.cumsum(rng.uniform(-1, 1, n - 1))
    steps = rng.uniform(0.5, 1.5, n - 1)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    return np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])


@given(SEEDS)
def test_voronoi_lengths_add_up_to_the_length_of_the_polygon_3_3_12(seed):
    edges = lengths(np.diff(polygon(seed), axis=0))
    parts = to_vertices(edges)
    assert parts.sum() == pytest.approx(edges.sum(), rel=1e-14)
    assert parts[0] == edges[0] / 2  # (3.3.11); with whole edges at the ends the sum would be too long
    assert parts[-1] == edges[-1] / 2


def angles_of(x):
    """phi by (3.3.15)-(3.3.18) as printed: arccos of unit tangents (3.3.5), (3.3.7)-(3.3.9), and a sign."""
    e = np.diff(x, axis=0)
    edge = e / lengths(e)[:, None]
    vertex = np.vstack([edge[:1], (x[2:] - x[:-2]) / lengths(e[:-1] + e[1:])[:, None], edge[-1:]])
    np.testing.assert_allclose(vertex, vertex_tangents(x), atol=1e-15)
    pairs = [(vertex[0], vertex[1]), *itertools.pairwise(edge), (vertex[-2], vertex[-1])]
    signs = [np.sign(a[0] * b[1] - a[1] * b[0]) for a, b in pairs]
    return np.array([s * np.arccos(a @ b) for s, (a, b) in zip(signs, pairs, strict=True)])


@given(SEEDS)
def test_turning_angles_are_those_of_the_page_also_at_the_ends(seed):
    """(3.3.16), (3.3.17): between the tangents of the vertices, not of the edges, which would be twice as large."""
    x = polygon(seed)
    found = strains(Geometry.straight(np.linspace(0.0, 6.0, x.shape[0]), 0.25), x, np.ones(x.shape))
    np.testing.assert_allclose(found.phi, angles_of(x), atol=1e-7)  # of the arccos
    parts = to_vertices(lengths(np.diff(x, axis=0)))
    np.testing.assert_allclose(found.kappa, 2 / parts * np.tan(angles_of(x) / 2), atol=1e-6)  # (3.3.23)


def test_the_ends_of_a_regular_polygon_turn_by_half_its_angle():
    """So that their curvature, over half the length, is that of the others to second order."""
    turn, n = 0.4, 9
    angles = turn * np.arange(n - 1)
    x = np.vstack([np.zeros(2), np.cumsum(np.column_stack([np.cos(angles), np.sin(angles)]), axis=0)])
    found = strains(Geometry.straight(np.linspace(0.0, 8.0, n), 0.25), x, np.ones(x.shape))
    np.testing.assert_allclose(found.phi, [turn / 2, *[turn] * (n - 2), turn / 2], rtol=1e-13)
    np.testing.assert_allclose(found.kappa[[0, -1]], 4 * np.tan(turn / 4), rtol=1e-13)


@given(SEEDS)
def test_kinetic_energy_and_momenta_are_those_of_the_points_of_the_sections(seed):
    """(3.3.27) by quadrature over r* = x + X d of (3.2.2), against (3.3.29)-(3.3.33) and the mass matrix (3.3.43).

    M q' is the array of the momenta of the parts, whose masses are constant: (3.3.36)_4 and (3.3.36)_5 are (3.3.46).
    """
    case = cosserat.case("vibration_c4_20").vary("offset", rod={"centreline": 0.3, "vertices": 5})
    problem = case.problem
    rod, geometry = problem.rod, problem.geometry
    rng = np.random.default_rng(seed)
    x, d, v, w = rng.uniform(-1, 1, (4, rod.vertices, 2))
    nodes, weights = np.polynomial.legendre.leggauss(3)
    place = (nodes / 2 + 0.5 - rod.centreline) * rod.height / geometry.director_length[0]  # X
    mass = rod.line_density * geometry.voronoi_length[:, None] * weights / 2  # of each part and node
    at = x[:, None] + place[:, None] * d[:, None]
    velocity = v[:, None] + place[:, None] * w[:, None]
    matrix, rate = to_dense(problem.rod.mass(geometry)), np.hstack([v, w]).ravel()
    momenta = (matrix @ rate).reshape(-1, 4)
    np.testing.assert_allclose(momenta[:, :2], np.einsum("kp,kpa->ka", mass, velocity), atol=1e-12)
    np.testing.assert_allclose(
        momenta[:, 2:], np.einsum("kp,p,kpa->ka", mass, place, velocity), atol=1e-12
    )
    twice = (mass * (velocity**2).sum(axis=2)).sum()
    assert rate @ matrix @ rate == pytest.approx(twice, rel=1e-12)

    def turning(a, b):
        return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]

    own = turning(x, momenta[:, :2]) + turning(d, momenta[:, 2:])  # (3.3.32)
    assert own.sum() == pytest.approx((mass * turning(at, velocity)).sum(), rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("centreline", [0.3, 0.5, 0.8])
def test_the_consistent_mass_is_that_of_straight_edges_and_of_their_ends_in_the_mean(centreline):
    """By quadrature over edges and sections, with a density that varies and steps inside an edge."""
    stations = [{"at": 0.1}, {"at": 0.37, "density": 2.0}, {"at": 0.37, "density": 0.5, "width": 1.4}]
    case = cosserat.case("vibration_consistent").vary(
        "x", rod={"centreline": centreline, "vertices": 6, "stations": stations}
    )
    problem = case.problem
    rod, geometry = problem.rod, problem.geometry
    rng = np.random.default_rng(4)
    v, w = rng.uniform(-1, 1, (2, rod.vertices, 2))
    nodes, weights = np.polynomial.legendre.leggauss(6)
    place = (nodes / 2 + 0.5 - centreline) * rod.height / geometry.director_length[0]

    def section(v, w):
        """Twice the kinetic energy of a section per mass."""
        return weights / 2 @ ((v + place[:, None] * w) ** 2).sum(axis=1)

    straight = ends = 0.0
    xi = geometry.arc_length
    for K, (a, b) in enumerate(itertools.pairwise(xi)):
        cuts = [a, *(p for p in (0.1, 0.37) if a < p < b), b]
        for low, high in itertools.pairwise(cuts):
            for s, fraction in zip((low + high + (high - low) * nodes) / 2, weights / 2, strict=True):
                density = np.interp(s, [0.1, 0.37], [1.0, 2.0]) if s < 0.37 else 0.5 * 1.4
                mass, t = rod.line_density * density * fraction * (high - low), (s - a) / (b - a)
                straight += mass * section((1 - t) * v[K] + t * v[K + 1], (1 - t) * w[K] + t * w[K + 1])
                ends += mass * ((1 - t) * section(v[K], w[K]) + t * section(v[K + 1], w[K + 1]))
    rate = np.hstack([v, w]).ravel()
    found = rate @ to_dense(problem.rod.mass(geometry)) @ rate
    assert found == pytest.approx((straight + ends) / 2, rel=1e-12)


def test_stiffnesses_are_made_of_the_means_of_table_3_1():
    """k1 ... k7 of (3.4.13), where height, width, E and nu vary and step: means (3.4.8), (3.4.9) by quadrature.

    Of a uniform rod the means over the parts of the vertices and over the edges are the same; of this one they are not.
    """
    at, low = [1.0, 3.1, 3.1, 4.0], 0.3
    fractions = {
        "height": [1.0, 0.6, 0.8, 0.5],
        "width": [1.0, 1.7, 0.9, 1.2],
        "young": [1.0, 2.0, 0.4, 0.7],
        "poisson": [1.0, 0.5, 1.2, 0.9],
    }
    stations = [
        {"at": a, **{name: values[k] for name, values in fractions.items()}} for k, a in enumerate(at)
    ]
    rod = cosserat.case("necking").vary("x", rod={"stations": stations, "centreline": low}).problem.rod
    rod = rod.replace(vertices=7)
    geometry = rod.geometry()
    found, c = rod.strain_energy.stiffness(rod, geometry), rod.calibration

    def local(xi):
        side = [0, 1] if xi < 3.1 else [2, 3]
        H, W, E, nu = (np.interp(xi, np.array(at)[side], np.array(v)[side]) for v in fractions.values())
        H, W, E, nu = 0.5 * H, 0.5 * W, 1e9 * E, 0.3 * nu
        return W * H, W * H**3 / 12 + W * H * ((0.5 - low) * H) ** 2, E, E / (2 * (1 + nu)), nu

    def means(a, b):
        cuts = [p for p in (1.0, 3.1, 4.0) if a < p < b]
        return [
            quad(lambda s, i=i: local(s)[i], a, b, points=cuts or None)[0] / (b - a) for i in range(5)
        ]

    xi = geometry.arc_length
    edges = np.array([means(a, b) for a, b in itertools.pairwise(xi)])
    inner = np.array([means(a, b) for a, b in itertools.pairwise((xi[1:] + xi[:-1]) / 2)])
    A, second, E, G, nu = np.vstack([edges[:1], inner, edges[-1:]]).T  # (3.4.10) without its half, E3.9
    eA, eI, eE, _, eNu = edges.T
    expected = {
        "k1": c.c1 * eE * eA * (1 - eNu) / ((1 + eNu) * (1 - 2 * eNu)),
        "k2": c.c2 * E * A * (1 - nu) / ((1 + nu) * (1 - 2 * nu)),
        "k3": c.c3 * E * second,
        "k4": c.c4 * 5 / 6 * G * A,
        "k5": c.c5 * eE * eI,
        "k6": c.c6 * eE * eI / (1 + eNu),
        "k7": c.c7 / 2 * E * A * nu / ((1 + nu) * (1 - 2 * nu)),  # half the coupling, E3.2
    }
    for name, value in expected.items():
        np.testing.assert_allclose(getattr(found, name), value, rtol=1e-9, err_msg=name)


def test_bending_energy_of_a_curved_rod_is_that_of_eulers_elastica():
    """EI (kappa - kappa_0)^2 / 2, eq. (3.2.3), on the inner parts, for arcs with the curvatures of (3.3.23)."""
    rod = make_rod(vertices=9, rest={"kind": "arc", "curvature": 0.1})
    geometry = rod.geometry()
    potential = rod.strain_energy.potential(rod, geometry)
    edge = geometry.edge_length[0]
    bent = Geometry.arc(np.linspace(0.0, rod.length, 9), geometry.director_length, 0.25)

    def curvature(arc):
        return 2 / edge * np.tan(np.arcsin(arc * edge / 2))

    energy = (
        rod.strain_energy.stiffness(rod, geometry).k3[1:-1]
        * edge
        * (curvature(0.25) - curvature(0.1)) ** 2
        / 2
    )
    found = potential.energy_terms(bent.q)
    assert found[2] == pytest.approx(energy.sum(), rel=1e-12)
    assert np.abs(found[[0, 1, 3]]).max() < 1e-9 * found[2]  # neither stretched nor sheared


@given(SEEDS)
def test_gradients_of_unit_vectors_3_4_15(seed):
    """(3.4.15) by differences, with the projection (3.4.16): the force lists (3.4.17)-(3.4.19) are made of them."""
    a, b, c = np.random.default_rng(seed).uniform(-1, 1, (3, 2))
    b, c = b + np.array([3, 0]), c - np.array([0, 3])  # apart from each other

    def across(unit, vector):
        return vector - (vector @ unit) * unit

    def unit(vector):
        return vector / np.linalg.norm(vector)

    def slope(function):
        h = 1e-4
        return [(function(a + h * e) - function(a - h * e)) / (2 * h) for e in np.eye(2)]

    one, two = np.linalg.norm(a - b), np.linalg.norm(c - a)
    first = across(unit(a - b), c) / one
    np.testing.assert_allclose(slope(lambda p: c @ unit(p - b)), first, atol=1e-8)
    second = across(unit(a - b), c - a) / (two * one) - across(unit(c - a), a - b) / (one * two)
    np.testing.assert_allclose(slope(lambda p: unit(p - b) @ unit(c - p)), second, atol=1e-8)


def test_the_first_mode_solves_the_equation_of_the_beam():
    """w = W cos(omega t) of (3.5.11) in (3.5.10), by differences; clamped at one end, free at the other."""
    beam = Beam(
        length=2.0,
        area=0.5,
        second_moment=0.3,
        young=10.0,
        poisson=0.3,
        line_density=0.7,
        shear_correction=5 / 6,
    )
    omega, h = first_frequency(beam), 0.02

    def shape(xi):
        return first_beam_mode(beam.length, np.asarray(xi))[0]

    xi = np.linspace(0.2, 1.8, 9)
    weights = {0: 28 / 3, 1: -6.5, 2: 2.0, 3: -1 / 6}  # of a fourth derivative, to fourth order
    fourth = weights[0] * shape(xi)
    for k in (1, 2, 3):
        fourth += weights[k] * (shape(xi + k * h) + shape(xi - k * h))
    residual = beam.bending_stiffness * fourth / h**4 - beam.line_density * omega**2 * shape(xi)
    assert np.abs(residual).max() < 1e-5 * beam.line_density * omega**2
    value, slope = first_beam_mode(beam.length, np.array([0.0, beam.length]))
    assert value == pytest.approx([0, 1], abs=1e-14)
    assert slope[0] == pytest.approx(0, abs=1e-14)
    inside = beam.length - h * np.arange(5)
    bending = np.array([35, -104, 114, -56, 11]) / 12 @ shape(inside)
    assert abs(bending / h**2) < 1e-3
