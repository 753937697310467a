"""Rates of equilibria for columns of values: against differenced equilibria, one member by one, and at their ends."""

import numpy as np
import pytest

import cosserat
from cosserat.problems.many import solve_many
from cosserat.problems.rates import has_rates
from cosserat.problems.static import FIELDS

from .test_many import FAMILIES, family

STEPS = 2.0 ** -np.arange(6, 9)
MOVING = [name for name in FAMILIES if name not in ("centreline", "density")]


def sharp(problem):
    return problem.replace(newton=problem.newton.replace(tolerance=1e-14))


def differenced(problem, columns, key):
    """Derivatives of all fields by the relative step of a key, from equilibria on both sides of the first member."""
    steps = np.concatenate([STEPS, -STEPS])
    near = {name: np.full(steps.size, values[0]) for name, values in columns.items()}
    near[key] = near[key] * (1 + steps)
    found = solve_many(problem, near)
    assert found.solved.all()
    slopes = {}
    for name, (_, values) in found.fields.items():
        rough = (values[:3] - values[3:]) / (2 * STEPS.reshape(-1, *(1,) * (values.ndim - 1)))
        better = rough[1:] + (rough[1:] - rough[:-1]) / 3
        slopes[name] = better[1] + (better[1] - better[0]) / 15
    return slopes


@pytest.mark.parametrize("name", MOVING)
def test_fields_move_as_differenced_equilibria_do(name):
    problem, columns = family(name)
    problem, keys = sharp(problem), list(columns)
    rates = solve_many(problem, columns, tuple(FIELDS), keys).rates
    expected = [differenced(problem, columns, key) for key in keys]
    assert rates.known.all()
    for field in FIELDS:
        own = rates.change[field][1][: len(keys)]
        right = np.array([slopes[field] for slopes in expected])
        np.testing.assert_allclose(
            own, right, rtol=0, atol=1e-8 * np.abs(right).max() + 1e-11, err_msg=field
        )


def test_rates_do_not_depend_on_other_members():
    problem, columns = family("length", 5)
    keys = list(columns)
    many = solve_many(problem, columns, ["u", "kappa"], keys).rates
    for member in range(5):
        own = {key: values[member : member + 1] for key, values in columns.items()}
        one = solve_many(problem, own, ["u", "kappa"], keys).rates
        for field in ("u", "kappa"):
            rows = many.change[field][1][len(keys) * member : len(keys) * (member + 1)]
            assert np.array_equal(rows, one.change[field][1])


def test_members_at_the_end_of_a_range_or_at_a_critical_load_are_left():
    solid = {"rod": {"material": {"poisson": 0.3}}}
    problem = cosserat.case("elastica").vary("solid", **solid).problem
    ratios = np.array([0.3, 0.4999, 0.49999])
    found = solve_many(problem, {"rod.material.poisson": ratios}, ["u"], ["rod.material.poisson"])
    assert found.solved.tolist() == [True, False, False]
    assert found.rates.known[:, 0].tolist() == [True, False, False]


def test_a_rod_off_its_area_centres_keeps_its_strains_with_moduli_alone():
    problem, columns = family("centreline")
    assert not has_rates(problem, "rod.section.height", columns["rod.section.height"])
    assert has_rates(problem, "forces.0.force", np.ones(1))
