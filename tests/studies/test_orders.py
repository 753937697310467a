"""Observed orders, limits and estimated errors: sequences of a known kind, closed forms, and what has no number."""

import json
import re

import numpy as np
import pytest
import xarray as xr
from conftest import base_of

import cosserat
from cosserat.cli import main
from cosserat.errors import InputError
from cosserat.exact import elastica
from cosserat.limits import Limits
from cosserat.problems.calibration import beam_of
from cosserat.studies.analysis.orders import sizes_of
from cosserat.studies.analysis.refinements import by_place, refinements
from cosserat.studies.analysis.sequences import STATES, convergence

H = 1 / np.array([10.0, 17.0, 23.0, 41.0])


def quiet(*_):
    pass


def state_of(h, values, **how):
    return STATES[convergence(np.asarray(h), np.asarray(values), **how).state]


@pytest.mark.parametrize("order", [0.5, 1, 1.5, 2, 4, 8])
@pytest.mark.parametrize("size", [3.0, -2e-7])
def test_a_power_of_the_mesh_has_its_order_and_its_limit(order, size):
    """On meshes of any ratios, in any order."""
    values = 5.0 + size * H**order
    found = convergence(H[::-1], values[::-1])
    if np.ptp(values[1:]) < 1e-11:
        assert STATES[found.state] in ("round_off", "not_monotone", "not_asymptotic")
        return
    assert STATES[found.state] == "confirmed"
    noise = 1e-14 / abs(np.diff(values)[-1])
    assert np.allclose(found.orders, order, atol=1e-9 + 20 * noise, rtol=0)
    assert abs(found.limit - 5) < 1e-12 + 20 * noise * np.ptp(values)
    assert found.error(values[0]) == pytest.approx(1.25 * abs(values[0] - found.limit))


def test_three_meshes_confirm_nothing():
    found = convergence(H[1:], 5 + H[1:] ** 2)
    assert STATES[found.state] == "unconfirmed"
    assert found.order == pytest.approx(2)
    assert found.error(5 + H[-1] ** 2) == pytest.approx(3 * H[-1] ** 2)


@pytest.mark.parametrize(
    ("values", "state"),
    [
        (5 + np.array([1.0, -0.5, 0.25, -0.125]), "not_monotone"),
        (5 + np.array([1.0, 0.5, 0.25, 0.25]), "not_monotone"),
        (1 / H, "not_asymptotic"),  # grows without bound
        (np.log(H), "not_asymptotic"),
        (5 + H**2 + 1e5 * H**6, "not_asymptotic"),  # another order rules the coarse meshes
        (np.full(4, 5.0), "round_off"),
        (5 + 1e-13 * np.array([1, -1, 1, -1]), "round_off"),
        (np.array([1.0, 0.3, 0.0, 0.0]), "not_monotone"),
        (np.zeros(4), "round_off"),
    ],
)
def test_what_has_no_order_has_a_state_and_no_number(values, state):
    found = convergence(H, values)
    assert STATES[found.state] == state
    assert found.order is None
    assert found.limit is None
    error = found.error(values[-1])
    assert error is None if state != "round_off" else 0 <= error < 1e-11


def test_round_off_is_what_the_variable_says():
    values = 5 + 1e-8 * np.array([1, -1, 1, -1])
    assert (state_of(H, values), state_of(H, values, floor=1e-7)) == ("not_monotone", "round_off")
    assert (
        state_of(H, 1e-6 * (5 + H**2), floor=1e-7) == "confirmed"
    )  # a floor as large as the values is none
    assert state_of(H[:2], values[:2]) == "too_few_meshes"


def exact_elastica(problem):
    """The tip's displacement along E2, and the bending moment at the clamp."""
    beam, force = beam_of(problem), problem.forces[0].force
    unit = beam.bending_stiffness / beam.length**2
    shape = elastica.shearable_shape(
        force / unit, beam.axial_stiffness / unit, beam.shear_stiffness / unit, np.array([0.0, 1.0])
    )
    return beam.length * shape[-1, 1], force * beam.length * shape[-1, 0]


@pytest.fixture(scope="module")
def answer():
    keep = {
        "tip": "u.E2 at last",
        "moment": "max |bending_moment|",
        "norm": "norm u",
        "place": "x_ref.E3 at last",
    }
    factors = [{"forces.0.force": [4.6875, 1e-3]}, {"rod.vertices": [11, 21, 41, 81]}]
    return cosserat.study("elastica", factors, keep, progress=quiet)


def test_the_elastica_has_orders_two_and_one(answer):
    """Displacements at a vertex have order 2; the moment nearest to the clamp is half an edge away from it."""
    found = cosserat.orders(answer)
    tip, moment = exact_elastica(cosserat.case("elastica").problem)
    for name, exact, order in (("tip", tip, 2), ("moment", moment, 1)):
        one = found.isel(force=0)
        assert one[f"{name}_order"] == pytest.approx(order, abs=0.03)
        assert abs(one[name] - exact) < one[f"{name}_error"] < 2 * abs(one[name] - exact)
        assert abs(one[f"{name}_limit"] - exact) < 0.05 * abs(one[name] - exact)
        assert STATES[int(one[f"{name}_state"])] == "confirmed"
    assert found.tip_orders.dims == ("force", "triple")
    assert found.tip_error.units == "m"


def test_what_grows_with_the_mesh_has_no_limit(answer):
    """A norm over all vertices is a sum over ever more of them."""
    found = cosserat.orders(answer, of="norm").isel(force=0)
    assert STATES[int(found.norm_state)] == "not_asymptotic"
    assert np.isnan(found.norm_limit)
    assert np.isnan(found.norm_error)
    assert STATES[int(cosserat.orders(answer, of="place").place_state[0])] == "round_off"


def test_a_failed_member_is_no_mesh(answer):
    data = answer.copy(deep=True)
    data["status"][0, 1] = 2
    data["tip"][0, 1] = np.nan
    found = cosserat.orders(data, of="tip")
    assert [STATES[k] for k in found.tip_state.to_numpy()] == ["unconfirmed", "confirmed"]
    assert found.tip_order[0] == pytest.approx(2, abs=0.05)


def test_a_motion_takes_equal_steps_between_frames():
    """The steps that are taken, not those that are asked for: frames of this motion are 2.5 ms apart."""
    case = cosserat.case("tumbling")
    steps = ("step", [1.3e-3, 1e-3, 1.25e-3], {"key": "integrator.step"})
    study = {
        "kind": "study",
        "of": "tumbling",
        "vary": [{"integrator.step": [1e-3]}],
        "keep": {"end": "x.E3 at last"},
    }
    attrs = {"study": json.dumps({"case": case.model_dump(mode="json"), "study": study})}
    assert np.allclose(
        sizes_of(xr.Dataset(coords={"step": steps}, attrs=attrs), "step"), [1.25e-3, 2.5e-3 / 3, 1.25e-3]
    )


@pytest.mark.parametrize(
    ("how", "sentence"),
    [
        ({"along": "height"}, "has no numbers 'height' of a key; it has force, vertices"),
        ({"of": "top"}, "has no read-out 'top'"),
    ],
)
def test_orders_of_what_is_not_there(answer, how, sentence):
    with pytest.raises(InputError, match=sentence):
        cosserat.orders(answer, **how)
    with pytest.raises(InputError, match="no key of meshes"):
        cosserat.orders(answer.isel(vertices=0), of="tip")


def test_the_estimated_error_holds_the_exact_one():
    case = cosserat.case("elastica")
    keep = {"tip": "u.E2 at last", "moment": "max |bending_moment|"}
    found = cosserat.estimate_error(case, keep, progress=quiet)
    for name, exact in zip(keep, exact_elastica(case.problem), strict=True):
        assert abs(found[name] - exact) < found[f"{name}_error"] < 2 * abs(found[name] - exact)
    assert found.attrs["meshes"] == "rod.vertices: 11, 21, 41, 81"
    assert "warnings" not in found.attrs


def test_the_published_energy_converges_with_order_one():
    """Its calibrated coefficients leave a shear energy of the ends that shrinks with the edges."""
    found = cosserat.estimate_error("clamped_free", {"tip": "u.E2 at last"}, progress=quiet)
    assert found.tip_order.item() == pytest.approx(1.1, abs=0.1)
    assert STATES[found.tip_state.item()] == "confirmed"


def test_places_by_number_stay_where_they_are():
    """A force on vertex 20 of 41 is at half the length on every mesh."""
    table = by_place(cosserat.case("arch_path").problem)
    assert table["forces"][0]["at"] == "0.5 m"
    with pytest.raises(InputError, match="'u.E2 at 20' names a place by its number"):
        cosserat.estimate_error("arch_path", {"middle": "u.E2 at 20"})


def test_each_kind_is_refined_by_its_meshes():
    found = {
        name: [way.paths[0] for way in refinements(cosserat.case(name).problem)]
        for name in ("elastica", "arch_path", "tumbling", "soft_robot", "worm_at_rest")
    }
    assert found == {
        "elastica": ["rod.vertices"],
        "arch_path": ["rod.vertices"],
        "tumbling": ["rod.vertices", "integrator.step"],
        "soft_robot": ["mesh.elements", "step"],
        "worm_at_rest": ["mesh.elements"],
    }
    with pytest.raises(InputError, match="'calibration', which has no mesh to refine"):
        cosserat.estimate_error(base_of("calibration"))


def test_the_time_that_is_left_bounds_the_meshes():
    own = cosserat.run("elastica")
    found = cosserat.estimate_error(
        "elastica", {"tip": "u.E2 at last"}, result=own, limits=Limits(hours=1e-9), progress=quiet
    )
    assert "would take longer than the limit --hours leaves" in found.attrs["warnings"]
    assert STATES[found.tip_state.item()] == "too_few_meshes"
    assert np.isnan(found.tip_error)


def test_the_command_prints_value_error_and_order(tmp_path, capsys):
    file = tmp_path / "a.nc"
    assert main(["run", "elastica", "-o", str(file), "--estimate-error", "u.E2 at last", "norm u"]) == 0
    out = capsys.readouterr().out
    assert re.search(r"^u.E2 at last = 0.8106556\d+ m, estimated error 4.2e-05 m$", out, re.MULTILINE)
    assert re.search(
        r"^  rod.vertices: error 4.2e-05, order 2.00, limit 0.81068\d+; order and", out, re.MULTILINE
    )
    assert re.search(
        r"^norm u = \S+ m, no estimate of its error\n  rod.vertices: the changes", out, re.MULTILINE
    )
    assert "rod.vertices: 11, 21, 41, 81" in out
    assert cosserat.load(file).attrs["case"] == "elastica"


def test_the_command_solves_nothing_where_an_error_cannot_be_estimated(tmp_path, capsys):
    assert main(["run", "elastica", "-o", str(tmp_path / "a.nc"), "--estimate-error", "uu"]) == 2
    assert "reads 'uu', which no result has" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
