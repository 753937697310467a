"""Spectral elements and the banded Newton method on regions, for problems with known answers."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cosserat.errors import NotConvergedError
from cosserat.solvers.elements import Mesh, graded, rule
from cosserat.solvers.regions import RegionSettings, Remote, Source, solve


@pytest.mark.parametrize("degree", [2, 3, 5, 8])
def test_the_rule_is_exact_for_polynomials(degree):
    known = rule(degree)
    for power in range(2 * degree):
        exact = (1 - (-1) ** (power + 1)) / (power + 1)
        assert known.weights @ known.points**power == pytest.approx(exact, abs=1e-13)
    x = known.points**degree
    np.testing.assert_allclose(known.derivative @ x, degree * known.points ** (degree - 1), atol=1e-12)
    integral = (known.points ** (degree + 1) - (-1) ** (degree + 1)) / (degree + 1)
    np.testing.assert_allclose(known.integral @ x, integral, atol=1e-13)


@given(st.integers(0, 1000), st.floats(1e-4, 0.3))
def test_a_graded_mesh_covers_its_regions_and_is_fine_at_the_junctions(seed, layer):
    rng = np.random.default_rng(seed)
    edges = [0.0, *np.sort(rng.uniform(0.01, 0.99, rng.integers(0, 5))), 1.0]
    mesh = graded(edges, layer, 6, 4)
    assert mesh.ends[0] == 0
    assert mesh.ends[-1] == 1
    assert (mesh.sizes > 0).all()
    for junction in edges[1:-1]:
        at = int(np.abs(mesh.ends - junction).argmin())
        assert mesh.ends[at] == junction
        assert mesh.region[at] == mesh.region[at - 1] + 1
        assert max(mesh.sizes[at], mesh.sizes[at - 1]) <= layer * (1 + 1e-6)


@pytest.mark.parametrize("layer", [0.01, 0.1, 0.5])
def test_a_mirrored_body_has_the_mirrored_mesh(layer):
    edges = np.array([0, 0.2, 0.55, 1])
    one, other = graded(list(edges), layer, 5, 4), graded(list(1 - edges[::-1]), layer, 5, 4)
    np.testing.assert_allclose(one.ends, 1 - other.ends[::-1], atol=1e-14)


def test_fields_are_interpolated_and_integrated_to_rounding():
    mesh = graded([0, 0.3, 1], 0.01, 6, 8)
    field = np.cos(3 * mesh.places)
    at = np.concatenate([np.linspace(0, 1, 777), mesh.ends, mesh.places.ravel()])
    np.testing.assert_allclose(mesh.interpolate(field, at), np.cos(3 * at), atol=1e-9)
    np.testing.assert_allclose(mesh.cumulative(field), np.sin(3 * mesh.places) / 3, atol=1e-10)
    np.testing.assert_allclose(mesh.slope(field), -3 * np.sin(3 * mesh.places), atol=1e-6)


class Steps:
    """u'' = k^2 (u - a) with another a on either side: plateaus joined by exponential layers."""

    def __init__(self, mesh, k, a):
        self.k, self.a = k, np.array(a)[mesh.region][:, None, None]
        self.shape = (*mesh.places.shape, 1, 1)

    def source(self, u):
        return Source(self.k**2 * (u - self.a), np.full(self.shape, self.k**2))


def exact_steps(z, k, a, junction):
    """Two regions on [0, 1] with u' = 0 at the ends."""
    jump = a[1] - a[0]
    s, t = np.tanh(k * junction), np.tanh(k * (1 - junction))
    left = a[0] + jump * t / (s + t) * np.cosh(k * z) / np.cosh(k * junction)
    right = a[1] - jump * s / (s + t) * np.cosh(k * (1 - z)) / np.cosh(k * (1 - junction))
    return np.where(z < junction, left, right)


@pytest.mark.parametrize("degree", [2, 3, 4, 5])
def test_the_order_of_convergence_is_that_of_the_elements(degree):
    k, a, junction = 12.0, (1.0, 2.0), 0.4
    z = np.linspace(0, 1, 4001)
    errors, sizes = [], (4, 8, 16, 32)
    for count in sizes:
        ends = np.concatenate(
            [np.linspace(0, junction, count + 1), np.linspace(junction, 1, count + 1)[1:]]
        )
        mesh = Mesh(ends, np.repeat([0, 1], count), degree)
        solved = solve(mesh, Steps(mesh, k, a), np.ones((mesh.nodes, 1)), RegionSettings(), "test")
        found = mesh.interpolate(mesh.split(solved.u), z)[:, 0]
        errors.append(np.abs(found - exact_steps(z, k, a, junction)).max())
    orders = np.diff(np.log(errors)) / -np.log(2)
    assert orders[-2:] == pytest.approx(degree + 1, abs=0.35)
    assert orders[-1] > degree + 0.7


class Far:
    """u'' = k^2 (u - b u(c)^2 - 1) in the second region, u'' = k^2 (u - 2) in the first, c the junction."""

    def __init__(self, mesh, k, b):
        self.mesh, self.k, self.b = mesh, k, b
        self.node = int((mesh.region == 0).sum()) * mesh.degree
        self.second = (mesh.region == 1)[:, None, None]

    def source(self, u):
        there = u[self.mesh.region == 1][0, 0, 0]
        goal = np.where(self.second, self.b * there**2 + 1, 2.0)
        column = np.where(self.second, -(self.k**2), 0.0) * np.ones_like(u)
        remote = Remote(self.node, column, np.array([2 * self.b * there]))
        return Source(self.k**2 * (u - goal), np.full((*u.shape, 1), self.k**2), (remote,))


def test_junction_conditions_keep_newtons_method_quadratic():
    mesh = graded([0, 0.5, 1], 0.02, 6, 8)
    solved = solve(mesh, Far(mesh, 50.0, 0.1), np.ones((mesh.nodes, 1)), RegionSettings(), "test")
    at = solved.u[int((mesh.region == 0).sum()) * mesh.degree, 0]
    plateau = 0.1 * at**2 + 1
    assert at == pytest.approx((2 + plateau) / 2, abs=1e-8)  # symmetric layers meet half-way
    assert solved.u[-1, 0] == pytest.approx(plateau, abs=1e-8)
    assert solved.iterations <= 5


class Barrier:
    """u'' = 1 / u - force: no solution where the force is negative."""

    def __init__(self, force):
        self.force = force

    def source(self, u):
        if not (u > 0).all():
            return None
        return Source(self.force - 1 / u, (1 / u**2)[..., None])


def test_newtons_method_is_damped_and_refuses_problems_without_a_solution():
    mesh = graded([0, 1], 0.1, 6, 6)
    solved = solve(mesh, Barrier(0.2), np.full((mesh.nodes, 1), 30.0), RegionSettings(), "test")
    np.testing.assert_allclose(solved.u, 5.0, rtol=1e-10)
    for force in (-0.2, 0.0):
        with pytest.raises(
            NotConvergedError, match=r"test: no solution on the regions found: .*allowed 1e-11"
        ):
            solve(mesh, Barrier(force), np.ones((mesh.nodes, 1)), RegionSettings(), "test")
    with pytest.raises(NotConvergedError, match="the initial guess is not admissible"):
        solve(mesh, Barrier(0.2), -np.ones((mesh.nodes, 1)), RegionSettings(), "test")
    with pytest.raises(NotConvergedError, match="the iterations did not converge"):
        solve(mesh, Barrier(0.2), np.ones((mesh.nodes, 1)), RegionSettings(max_iterations=2), "test")
