"""Sobol's indices and Morris's effects: closed forms, members without an answer, and what is refused."""

import sys

import numpy as np
import pytest
import xarray as xr
from scipy.stats import sobol_indices

import cosserat
from cosserat.errors import InputError
from cosserat.studies.designs import DESIGNS, number_of_points


def answer_of(design, count, function, keys=3, seed=1):
    """An answer with the values of a function of the unit cube at the points of a design."""
    points = DESIGNS[design](count, keys, seed)
    names = "abcdefg"[:keys]
    coords = {
        name: ("member", points.cube[:, k], {"key": f"rod.{name}"}) for k, name in enumerate(names)
    }
    coords |= {name: ("member", numbers) for name, numbers in points.about.items()}
    variables = {
        "y": ("member", function(points.cube), {"units": "m"}),
        "status": ("member", np.zeros(len(points.cube), dtype=np.int8)),
    }
    return xr.Dataset(variables, coords, {"study": "{}", "title": "made"})


def ishigami(cube):
    """Ishigami and Homma (1990), a = 7, b = 0.1."""
    x = np.pi * (2 * cube - 1)
    return np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


def ishigami_indices():
    """Their variances in closed form (Sobol and Levitan 1999): first and total shares."""
    a, b = 7.0, 0.1
    alone = np.array([(1 + b * np.pi**4 / 5) ** 2 / 2, a**2 / 8, 0.0])
    together = b**2 * np.pi**8 * 8 / 225
    with_others = alone + np.array([together, 0, together])
    return alone / (alone.sum() + together), with_others / (alone.sum() + together)


@pytest.mark.parametrize("design", ["saltelli", "morris", "sobol"])
def test_more_points_keep_the_first_ones(design):
    few, many = (DESIGNS[design](count, 3, 5) for count in (8, 16))
    assert (few.cube == many.cube[: number_of_points(design, 8, 3)]).all()
    for name, numbers in few.about.items():
        assert (numbers == many.about[name][: numbers.size]).all()


def test_indices_of_ishigamis_function_are_the_exact_ones():
    found = cosserat.indices(answer_of("saltelli", 1024, ishigami), of="y", resamples=200)
    for name, exact in zip(("first", "total"), ishigami_indices(), strict=True):
        assert (found[f"{name}_low"] <= exact).all()
        assert (exact <= found[f"{name}_high"]).all()
        assert (found[f"{name}_high"] - found[f"{name}_low"] < 0.2).all()
    assert found["first"].units == "1"
    assert int(found.left_out) == 0


def test_indices_are_those_of_scipy():
    data = answer_of("saltelli", 64, ishigami)
    found, rows = cosserat.indices(data, of="y", resamples=9), data.y.to_numpy().reshape(-1, 5).T
    other = sobol_indices(func={"f_A": rows[:1], "f_B": rows[1:2], "f_AB": rows[2:, None]}, n=64)
    assert np.allclose(found["first"], other.first_order, rtol=0, atol=1e-14)
    assert np.allclose(found["total"], other.total_order, rtol=0, atol=1e-14)


def test_a_base_point_with_a_failed_member_is_left_out_and_counted():
    data = answer_of("saltelli", 64, ishigami)
    data["status"][5 * 7 + 3] = 2
    found = cosserat.indices(data, of="y", resamples=9)
    whole = cosserat.indices(data.where(data.base != 7, drop=True), of="y", resamples=9)
    assert (int(found.used), int(found.left_out)) == (63, 1)
    assert "1 of 64 base points are left out" in found.attrs["warnings"]
    for name in ("first", "total", "first_low", "total_high"):
        assert np.isfinite(found[name]).all()
        assert (found[name] == whole[name]).all()


def test_members_in_another_order_have_the_same_indices():
    data = answer_of("saltelli", 16, ishigami)
    mixed = data.isel(member=np.random.default_rng(1).permutation(data.sizes["member"]))
    assert cosserat.indices(mixed, of="y").equals(cosserat.indices(data, of="y"))


def test_other_factors_stay_dimensions():
    one = answer_of("saltelli", 16, ishigami)
    both = xr.concat(
        [one, one.assign(y=2 * one.y**2)], xr.Variable("height", [1.0, 2.0], {"units": "m"})
    )
    both = both.assign_coords({name: one[name] for name in ("a", "b", "c", "base", "matrix")})
    found = cosserat.indices(both, of="y", resamples=9)
    assert found["first"].dims == ("height", "key")
    assert (found.isel(height=0)["total"] == cosserat.indices(one, of="y", resamples=9)["total"]).all()


def linear(cube):
    return 3 * cube[:, 0] - 2 * cube[:, 1] + 5 * cube[:, 1] * cube[:, 2]


def test_effects_of_a_function_of_second_order_are_the_exact_ones():
    """The effect of a linear key is its coefficient, over the whole range; of a product, the other factor."""
    data = answer_of("morris", 200, linear)
    found = cosserat.indices(data, of="y").sel(key=["a", "b", "c"])
    assert np.allclose(found.mu[0], 3, rtol=1e-13)
    assert np.allclose(found.mu_star[0], 3, rtol=1e-13)
    assert np.allclose(found.sigma[0], 0, atol=1e-13)
    levels = (np.arange(4) + 0.5) / 4
    for k, effects in ((1, 5 * levels - 2), (2, 5 * levels)):
        error = 3 * effects.std() / np.sqrt(200)
        assert abs(found.mu[k] - effects.mean()) < error
        assert abs(found.sigma[k] - effects.std()) < error
        assert found.mu_star_low[k] < np.abs(effects).mean() < found.mu_star_high[k]
    assert found.mu.units == "m"


def test_effects_leave_out_a_trajectory_with_a_failed_member():
    data = answer_of("morris", 10, linear)
    data["status"][6] = 5
    found = cosserat.indices(data, of="y")
    assert (int(found.used), int(found.left_out)) == (9, 1)
    assert np.isfinite(found.to_array()).all()


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda d: (d, "z"), "has no read-out 'z'"),
        (lambda d: (d.assign(y=0 * d.y + 3.5), "y"), "is 3.5 in all members"),
        (lambda d: (d.drop_vars("base"), "y"), "has no points for indices"),
        (lambda d: (d.assign(status=d.status + 2), "y"), "in all members of 0 base points"),
        (lambda d: (d.drop_vars("status"), "y"), "is no answer of a study"),
        (lambda d: (d.drop_vars("c"), "y"), "has 2 keys along 'member'"),
        (lambda d: (d.assign(y=d.y.where(d.base > 3)), "y"), "calls solved"),
    ],
)
def test_what_has_no_indices_is_one_sentence(change, sentence):
    data, of = change(answer_of("saltelli", 8, ishigami))
    with pytest.raises(InputError, match=sentence):
        cosserat.indices(data, of=of)


@pytest.mark.parametrize(("name", "value"), [("confidence", 1.5), ("resamples", 1)])
def test_a_bootstrap_that_cannot_be_is_refused(name, value):
    with pytest.raises(InputError, match=f"{name} = {value}"):
        cosserat.indices(answer_of("saltelli", 8, ishigami), of="y", **{name: value})


def test_without_salib_morris_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "SALib.analyze", None)
    with pytest.raises(InputError, match="pip install cosserat\\[studies\\]"):
        cosserat.indices(answer_of("morris", 4, linear), of="y")


def test_a_study_with_saltelli_points_has_indices():
    """A tip's displacement is P L^3 / (3 E I): the force has a larger share than the modulus of a smaller range."""
    factor = {
        "saltelli": 4,
        "forces.0.force": {"log_uniform": [1e-3, 4e-3]},
        "rod.material.young": {"log_uniform": [1.0e9, 1.1e9]},
    }
    answer = cosserat.study("elastica", [factor], {"tip": "u.E2 at last"}, progress=lambda *_: None)
    found = cosserat.indices(answer, of="tip", resamples=9)
    assert list(found.key) == ["force", "young"]
    assert found["total"][0] > 10 * found["total"][1] > 0
