"""The twelve deformations of a section: each has its own strain alone, and they span all."""

import numpy as np
import pytest

from cosserat.figures.deformations import DEFORMATIONS
from cosserat.rods import directed_rod

BOX = directed_rod.Section(2e-4, 1e-9, 3e-9, 2.5e-9)
K = directed_rod.adjusted_stiffnesses(1e6, 0.3, BOX, 5 / 6)


@pytest.fixture(params=DEFORMATIONS, ids=str)
def body(request):
    return DEFORMATIONS[request.param]


def test_only_its_own_strain_is_not_zero_and_is_its_amount(body):
    for amount in (0.2, -0.1):
        _, d, d_prime = body.directors(amount, np.zeros(1))
        gamma, kappa = directed_rod.measures(d[0], d_prime[0])
        for i, j in body.gamma:
            assert gamma[i, j] == pytest.approx(amount)
            gamma[i, j] = gamma[j, i] = 0
        for place, sign in (body.kappa or {}).items():
            assert kappa[place] == pytest.approx(sign * amount)
            kappa[place] = 0
        assert abs(gamma).max() < 1e-15
        assert abs(kappa).max() < 1e-15


def test_the_energy_of_a_body_is_the_stiffness_that_it_names(body):
    _, d, d_prime = body.directors(1e-2, np.zeros(1))
    energy = directed_rod.strain_energy(K, *directed_rod.measures(d[0], d_prime[0]))
    assert 2 * energy / 1e-4 == pytest.approx(body.stiffness_of(K), rel=1e-10)
    named = {int(word.strip("k_{}")) for word in body.pays.split() if word.startswith("k")}
    assert named == set(body.stiffness)


def test_directors_fit_their_centreline_and_their_derivatives(body):
    at, step = 0.7, 1e-5
    r, d, d_prime = body.directors(0.3, np.array([at - step, at, at + step]))
    np.testing.assert_allclose((r[2] - r[0]) / (2 * step), d[1, 2], atol=1e-9)
    np.testing.assert_allclose((d[2, :2] - d[0, :2]) / (2 * step), d_prime[1], atol=1e-9)


def test_at_rest_every_body_is_straight(body):
    r, d, d_prime = body.directors(0.0, np.array([-1.0, 2.0]))
    np.testing.assert_array_equal(r, [[0, 0, -1], [0, 0, 2]])
    np.testing.assert_array_equal(d, [np.eye(3)] * 2)
    assert not d_prime.any()


def test_they_span_all_strains():
    columns = []
    for body in DEFORMATIONS.values():
        _, d, d_prime = body.directors(0.1, np.zeros(1))
        gamma, kappa = directed_rod.measures(d[0], d_prime[0])
        columns.append([*gamma[np.triu_indices(3)], *kappa.ravel()])
    assert np.linalg.matrix_rank(np.array(columns)) == len(columns) == 12
