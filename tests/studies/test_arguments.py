"""Arguments of another kind than the analyses take: each is one sentence, and arrays are lists."""

import numpy as np
import pandas as pd
import pytest

import cosserat
from cosserat.errors import InputError

OF = {"end": "u.E3 at last"}
DATA = {"forces.0.force": [1.0, 2.0, 3.0], "end": [1e-5, 2e-5, 3.1e-5]}
YOUNG = {"rod.material.young": ("0.1 GPa", "9 GPa")}


def bar():
    """A bar pulled by 1 N: u = F a / (E A), with E A = 1e5 N."""
    rod = {"vertices": 5, "length": 1.0, "section": {"height": 0.01, "width": 0.01}}
    pull = [{"at": "last", "along": "E3", "force": 1.0}]
    return cosserat.case("elastica").vary("bar", rod=rod, forces=pull)


@pytest.fixture(scope="module")
def sample():
    """A study of Saltelli's points, with a read-out and a whole variable."""
    factor = {"saltelli": 2, "rod.length": {"uniform": [0.9, 1.1]}}
    factor["rod.material.young"] = {"uniform": [0.9e9, 1.1e9]}
    return cosserat.study(bar(), [factor], OF, keep_whole=["u"])


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"data": {"end": 0.3, "forces.0.force": 1}}, "data = .*columns by name, each a list"),
        ({"data": {"end": np.array(0.3)}}, "data = .*columns by name"),
        ({"free": None}, "free = None; give the keys"),
        ({"free": 5}, "free = 5; give the keys"),
        ({"free": {1: (1, 2)}}, "free = .*; give the keys"),
        ({"deviations": 5}, "deviations = 5; give a table"),
        ({"deviations": np.float64(0.1)}, "deviations = .*; give a table"),
    ],
)
def test_arguments_of_a_fit(given, said):
    with pytest.raises(InputError, match=f"fit has {said}"):
        cosserat.fit(bar(), **({"data": DATA, "free": YOUNG, "of": OF} | given))


@pytest.mark.parametrize("free", [None, 5, {1: (1, 2)}])
def test_free_keys_of_a_design(free):
    with pytest.raises(InputError, match="design has free = .*; give the keys"):
        cosserat.design(bar(), free, "total_mass.E3")


def test_the_constraints_of_a_design():
    """An array is a range like a list; an empty text was taken for no constraints."""
    free = {"rod.length": np.array([0.5, 2.0])}
    found = cosserat.design(bar(), free, "u.E3 at last", subject_to={"max u.E3": np.array([8e-6, 2e-5])})
    assert found["length"].item() == pytest.approx(0.8, rel=1e-4)
    with pytest.raises(InputError, match="give each read-out a range"):
        cosserat.design(bar(), free, "u.E3 at last", subject_to="")


@pytest.mark.parametrize(
    "given",
    [
        {"of": ["end"]},
        {"quantiles": None},
        {"quantiles": {0.5: 1}},
        {"quantiles": ["a"]},
        {"over": 5},
    ],
)
def test_arguments_of_bands(sample, given):
    name = next(iter(given))
    with pytest.raises(InputError, match=f"bands has {name} = .*; give a "):
        cosserat.bands(sample, **({"of": "u"} | given))


@pytest.mark.parametrize(
    "given",
    [
        {"of": np.array(["end"])},
        *({name: bad} for name in ("confidence", "resamples") for bad in (None, "a", [1])),
        *({"seed": bad} for bad in (-1, 1.5, "a", np.nan, None, True)),
    ],
)
def test_arguments_of_indices(sample, given):
    """A seed of None gave intervals that nobody could repeat."""
    name = next(iter(given))
    with pytest.raises(InputError, match=f"indices has {name} = .*; give a "):
        cosserat.indices(sample, **({"of": "end"} | given))


def test_arguments_of_orders():
    answer = cosserat.study(bar(), {"rod.vertices": [5, 9, 17]}, OF)
    with pytest.raises(InputError, match="orders has along = .*; give a text"):
        cosserat.orders(answer, np.array(["vertices"]))
    assert "end_order" in cosserat.orders(answer, of=np.array(["end"]))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda d: d.assign(u=d.u * np.nan), "has no number in a member with an answer"),
        (lambda d: d.isel(vertex=[]), "is empty along vertex, axis"),
        (lambda d: d.assign_coords(xi=d.status * 1.0 + d.length), "has members with different places"),
    ],
)
def test_bands_of_values_that_are_not_there(sample, change, said):
    with pytest.raises(InputError, match=f"'u' of this Dataset {said}"):
        cosserat.bands(change(sample), "u")


def test_bands_over_members_of_different_meshes_are_refused():
    """Vertex 4 of one is the tip and of the other the middle; two vertices of one mesh were averaged with none."""
    factor = {"rod.vertices": [5, 9, 5], "forces.0.force": [1.0, 2.0, 2.0], "name": "p"}
    answer = cosserat.study(bar(), [factor], keep_whole=["u"])
    with pytest.raises(InputError, match="members with different places along vertex, axis"):
        cosserat.bands(answer, "u", over="p")
    found = cosserat.bands(answer.isel(p=[0, 2]), "u", (0.0, 1.0), over="p")
    assert found["u"].sel(axis="E3")[:, 4].to_numpy() == pytest.approx([1e-5, 2e-5], rel=1e-4)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda d: d.assign(u=d.u * np.nan), "'u' of this Dataset is not finite"),
        (lambda d: d.isel(axis=0), r"'x_ref' of this Dataset is along \('vertex',\), not"),
        (lambda d: d.isel(dof=0), "is along"),
        (lambda d: d.assign_attrs(bands="u"), "holds quantiles of a study"),
        (lambda d: 5, "estimate_error has result = 5"),
    ],
)
def test_results_of_which_no_errors_can_be_estimated(result, change, said):
    with pytest.raises(InputError, match=said):
        cosserat.estimate_error(bar(), {"end": "u.E3 at last"}, result=change(result))


@pytest.fixture(scope="module")
def result():
    """The bar's own result."""
    return cosserat.run(bar())


@pytest.mark.filterwarnings("error")
def test_pictures_of_points_leave_out_coordinates_that_are_no_numbers(sample):
    """The mean of an empty interval was taken."""
    lengths = sample["length"].where(sample["length"] > sample["length"].min())
    cosserat.plot(sample.assign_coords(length=lengths))
    cosserat.plot(sample.assign_coords(length=lengths * np.nan))


def test_a_status_of_texts_is_refused(sample):
    changed = sample.assign(status=sample["status"].astype(str))
    for given in (lambda: cosserat.bands(changed, "u"), lambda: cosserat.indices(changed, "end")):
        with pytest.raises(InputError, match="has a 'status' of type .*, which is a number"):
            given()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"limits": 5}, r"limits = 5; give cosserat.Limits\("),
        ({"progress": 5}, "progress = 5; give a function"),
    ],
)
def test_arguments_of_an_estimate(given, said):
    """They were AttributeErrors and TypeErrors, after the case was solved."""
    with pytest.raises(InputError, match=f"estimate_error has {said}"):
        cosserat.estimate_error(bar(), OF, **given)


def test_a_place_of_a_table_is_a_text(sample):
    with pytest.raises(InputError, match="to_dataframe has place = 5; give a text"):
        cosserat.to_dataframe(sample, 5)


def test_bands_take_one_probability_and_count_a_dimension_once(sample):
    one = cosserat.bands(sample, "u", 0.5)
    assert one["u"].equals(cosserat.bands(sample, "u", [0.5], over=["member", "member"])["u"])


def test_a_part_of_all_places_does_not_hide_that_meshes_differ():
    """The first vertices of two meshes are all there, and are other places."""
    factor = {"rod.vertices": [5, 9], "forces.0.force": [1.0, 2.0], "name": "p"}
    answer = cosserat.study(bar(), [factor], OF, keep_whole=["u"]).isel(vertex=slice(0, 3))
    with pytest.raises(InputError, match="different places along vertex, axis by 'vertices'"):
        cosserat.bands(answer, "u", over="p")
    assert cosserat.bands(answer, "end", over="p")["used"].item() == 2


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: cosserat.run(bar(), limits=5), r"run has limits = 5; give cosserat\.Limits\("),
        (lambda: cosserat.run(bar(), progress=5), "run has progress = 5; give a function"),
        (lambda: cosserat.run(5), "run takes a case or the name of a published one, not 5"),
        (lambda: cosserat.study(bar(), {"rod.length": [1]}, OF, progress=5), "study has progress = 5"),
        (lambda: cosserat.sensitivity(bar(), 5, OF), "sensitivity has keys = 5; give a text, or a list"),
        (
            lambda: cosserat.sensitivity(bar(), "rod.length", "end"),
            "read-outs are 'end'; give each a name",
        ),
        (lambda: cosserat.animate(bar(), frames="5"), "animate has frames = '5'; give a whole number"),
    ],
)
def test_arguments_of_runs_and_pictures(call, said):
    with pytest.raises(InputError, match=said):
        call()


def test_series_and_tables_of_pandas_are_lists():
    by_list = cosserat.study(bar(), {"rod.length": [0.5, 1.0]}, OF)
    by_series = cosserat.study(bar(), {"rod.length": pd.Series([0.5, 1.0], index=[7, 9])}, OF)
    assert by_series.identical(by_list)
    assert cosserat.fit(bar(), pd.DataFrame(DATA), YOUNG, OF).identical(
        cosserat.fit(bar(), DATA, YOUNG, OF)
    )
