"""The consistent rod where its height varies and its centreline is not in the middle: gradients, invariance, shear."""

from itertools import pairwise

import numpy as np
import pytest
from conftest import assembled, jacobian, random_state
from hypothesis import given
from hypothesis import strategies as st

import cosserat
from cosserat.rods.energies.reissner import centre_edges
from cosserat.rods.kinematics import PLANAR
from cosserat.rods.reference import edge_shear
from cosserat.solvers.potential import GRADIENT, HESSIAN, STRAINS

TAPERED = [
    {"at": 0.3},
    {"at": 2.0, "height": 0.6},
    {"at": 2.0, "height": 1.2, "young": 0.4},
    {"at": 4.1, "height": 0.5, "width": 2.0},
]
"""A step on a vertex and kinks inside edges, of a rod of 5 m with six vertices."""
SECTIONS = {
    "free": {},
    "barrier": {"barrier": True},
    "incompressible": {"lateral_constraint": "incompressible", "material": {"poisson": 0.4999}},
    "curved": {"rest": {"kind": "arc", "curvature": 0.1}},
}
everywhere = pytest.mark.parametrize("centreline", [0.2, 0.7])
sections = pytest.mark.parametrize("section", SECTIONS.values(), ids=SECTIONS)


def tapered(centreline, section, **changes):
    rod = {
        "vertices": 6,
        "length": 5.0,
        "section": {"height": 0.5},
        "stations": TAPERED,
        "centreline": centreline,
    }
    case = cosserat.case("clamped_free_consistent").vary("tapered", rod=rod | section | changes)
    return case.problem.rod


def body_of(rod, **options):
    return rod.strain_energy.potential(rod, rod.geometry(), **options)


def force(body, q):
    gradient = np.zeros(q.size)
    body.add_gradient(q, body.history, gradient)
    return gradient


def step(body, start, q, after, task=HESSIAN):
    """Gradient of a step from `start`, taken at q with what is reached `after`."""
    strains, gradient, band = np.zeros(body.strains), np.zeros(q.size), np.zeros((q.size, 8))
    nothing, terms = np.empty(0), np.empty(len(body.terms))
    none = band[:0]
    body.evaluate(start, nothing, body.data, nothing, strains, STRAINS, gradient, none, none, terms)
    body.evaluate(q, after, body.data, nothing, strains, task, gradient, band, none, terms)
    return gradient


@everywhere
@sections
@given(st.integers(0, 1000))
def test_forces_are_the_gradient_and_the_hessian_is_its_derivative(centreline, section, seed):
    rod = tapered(centreline, section)
    body, q = body_of(rod), random_state(rod, seed, size=0.1)
    _, gradient, hessian = assembled(body, q)
    numeric = jacobian(body.energy, q, 1e-6)
    columns = jacobian(lambda p: force(body, p), q, 1e-6)
    np.testing.assert_allclose(gradient, numeric, atol=1e-6 * np.abs(gradient).max())
    np.testing.assert_allclose(hessian, columns, atol=1e-6 * np.abs(hessian).max())


@everywhere
@sections
@given(st.integers(0, 1000))
def test_the_hessian_of_a_step_of_no_length_is_the_derivative_of_its_force(centreline, section, seed):
    """Forces act at the middle q + s of a step, stresses are those of the mean of q and q + 2 s."""
    rod = tapered(centreline, section)
    body, q = body_of(rod), random_state(rod, seed, size=0.05)
    _, plain, hessian = assembled(body, q)
    gradient = step(body, q, q, q)
    np.testing.assert_allclose(gradient, plain, atol=1e-12 * np.abs(plain).max())
    columns = jacobian(lambda p: step(body, q, p, 2 * p - q, GRADIENT), q, 1e-6)
    np.testing.assert_allclose(hessian, columns, atol=1e-6 * np.abs(hessian).max())


@everywhere
@sections
@given(st.integers(0, 1000), st.floats(-3, 3))
def test_rigid_motions_give_no_strain_and_forces_balance(centreline, section, seed, turn):
    """Also where the rod is turned from its reference, and in a step from one state to another."""
    rod = tapered(centreline, section)
    geometry = rod.geometry()
    body = body_of(rod)
    c, s = np.cos(turn), np.sin(turn)
    turned = (geometry.q.reshape(-1, 2) @ np.array([[c, s], [-s, c]])).reshape(-1, 4)
    turned[:, :2] += [3.0, -1.0]
    scale = np.abs(assembled(body, random_state(rod, seed))[1]).max()
    assert np.abs(force(body, turned.ravel())).max() < 1e-9 * scale
    q, after = random_state(rod, seed, turn=0.1), random_state(rod, seed + 1, turn=0.2)
    in_step = step(body, q, (q + after) / 2, after, GRADIENT)
    for motions, forces in ((q, assembled(body, q)[1]), ((q + after) / 2, in_step)):
        assert np.abs(PLANAR.rigid_motions(motions) @ forces).max() < 1e-10 * np.abs(forces).max()


@everywhere
@sections
def test_displacements_from_the_reference_give_the_same_energy_and_forces(centreline, section):
    rod = tapered(centreline, section)
    geometry = rod.geometry()
    body, q = body_of(rod), random_state(rod, 1, turn=0.3)
    counted = assembled(body_of(rod, displacements=True), q - geometry.q)
    for one, other in zip(assembled(body, q), counted, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9 * np.abs(one).max())


@everywhere
def test_a_tapered_body_at_rest_is_not_sheared(centreline):
    """Edges between area centres are parallel to the centreline, whatever the height does within them."""
    rod = tapered(centreline, {})
    geometry = rod.geometry()
    edges = centre_edges(body_of(rod).constants, geometry.X, geometry.D)
    assert np.abs(edge_shear(edges, geometry.D)).max() < 1e-15
    heights = np.array(
        [1.0, 1.0, 1.2, 1.2 - 0.7 / 2.1, 1.2 - 0.7 * 2 / 2.1]
    )  # after a step: at 0, 1, ... 4 m
    assert geometry.D[:5, 1] == pytest.approx(
        0.5 * (1 - centreline) * (heights - [0, 0.4 * 0.7 / 1.7, 0, 0, 0])
    )


@everywhere
def test_tension_along_the_axis_of_an_edge_causes_no_bending(centreline):
    """Half of it with an eighth of the EI: at 8/9 of the offset of this half and 1/9 of that of the other."""
    stations = [{"at": 2.5}, {"at": 2.5, "height": 0.5}]
    rod = tapered(centreline, {}, stations=stations)
    geometry = rod.geometry()
    body = body_of(rod)
    offset = (0.5 - centreline) * 0.5
    edges = centre_edges(body.constants, 0 * geometry.X, geometry.D)[:, 1]
    low = body.constants["low"][2] * geometry.director_length[2]
    high = body.constants["high"][2] * geometry.director_length[3]
    assert (low, high) == pytest.approx([offset * (1 / 9 + 0.5 * 8 / 9)] * 2)
    np.testing.assert_allclose(edges, 0, atol=1e-15)


@everywhere
@pytest.mark.parametrize("curvature", [0.0, 0.1, -0.1])
def test_contraction_has_the_energy_of_the_material_of_all_pieces(centreline, curvature):
    """Without tension (2 mu A + Lambda A - (Lambda A)^2 / (2 mu A + Lambda A)) w^2 / 2 along the area centres."""
    heights, ratios, places = (1.0, 0.6, 1.2), (0.0, 0.3, 0.45), (0.0, 1.3, 2.0, 5.0)
    stations = [
        {"at": place, "height": height, "poisson": ratio / 0.3}
        for height, ratio, ends in zip(heights, ratios, pairwise(places), strict=True)
        for place in ends
    ]
    arc = {"kind": "arc", "curvature": curvature}
    rod = tapered(centreline, {}, stations=stations, rest=arc, material={"poisson": 0.3})
    geometry, w = rod.geometry(), 1e-2
    body, q = body_of(rod), np.hstack([geometry.X, (1 + w) * geometry.D]).ravel()
    free = np.arange(q.size).reshape(-1, 4)[1:, :2].ravel()
    for _ in range(3):
        _, gradient, hessian = assembled(body, q)
        q[free] -= np.linalg.solve(hessian[np.ix_(free, free)], gradient[free])
    right = 0.0
    for height, nu, (begin, end) in zip(heights, ratios, pairwise(places), strict=True):
        area, e = 0.25 * height, (0.5 - centreline) * 0.5 * height
        plain, volume = rod.young * area / (1 + nu), rod.young * nu / (1 - nu**2) * area
        cost = plain + volume - volume**2 / (plain + volume)
        right += (end - begin) * (1 - curvature * e) * cost * w**2 / 2
    assert body.energy(q) == pytest.approx(right, rel=1e-9)
