"""Datasets that a user changed: parts of answers stay tables and pictures, and what no file holds is named."""

import numpy as np
import pytest
import xarray as xr

import cosserat
from cosserat.data.dataset import holding_what_is_needed
from cosserat.errors import CosseratError, InputError


@pytest.fixture(scope="module")
def answer():
    """A study of six members along two factors, with read-outs and a whole variable."""
    vary = {"forces.0.force": [1.0, 2.0, 3.0], "rod.section.height": [0.008, 0.01]}
    case = cosserat.case("elastica").vary("short", rod={"vertices": 5})
    return cosserat.study(case, vary, {"tip": "u.E2 at last", "mx": "max |u.E2|"}, keep_whole=["u"])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda d: d.assign_attrs(by=None), "attribute 'by' of the Dataset is None"),
        (lambda d: d.assign_attrs(by={"a": 1}), "attribute 'by' of the Dataset is {'a': 1}"),
        (lambda d: d.assign_attrs(by="\ud800"), "attribute 'by' of the Dataset is"),
        (lambda d: d.assign_attrs(by=True), "attribute 'by' of the Dataset is True"),
        (lambda d: d.assign_attrs({3: "x"}), "attribute of the Dataset is called 3"),
        (lambda d: d.assign_attrs({"a/b": "x"}), "attribute of the Dataset is called 'a/b'"),
        (
            lambda d: d.assign(tip=d.tip.assign_attrs(by=[1, "x"])),
            r"attribute 'by' of 'tip' is \[1, 'x'\]",
        ),
        (lambda d: d.assign({"a/b": d.tip}), "is called 'a/b'"),
        (lambda d: d.assign({5: d.tip}), "is called 5"),
        (lambda d: d.assign(z=d.tip.astype("f2")), "'z' has values of type float16"),
        (lambda d: d.assign({"end ": d.tip}), "is called 'end ', .* without a space at its end"),
        (lambda d: d.assign(z=d.tip * 1j), "'z' has values of type complex128"),
        (lambda d: d.assign(z=("k", np.array([{}, None]))), "'z' holds {}"),
    ],
)
def test_what_no_file_holds_is_named(answer, tmp_path, change, said):
    """Each of these was an error of the netCDF library."""
    with pytest.raises(InputError, match=said):
        cosserat.save(change(answer), tmp_path / "changed.nc")
    assert not list(tmp_path.iterdir())


@pytest.mark.filterwarnings("error")
def test_encodings_that_do_not_fit_are_left_out(answer, tmp_path):
    """They gave a warning of a dimension that is not there, and a ValueError."""
    changed = answer.assign_attrs(content=np.array([1.0, 2.0]))
    changed.encoding["unlimited_dims"] = ["nope"]
    changed["status"].encoding = {"dtype": "int8", "scale_factor": 0.1}
    changed["tip"].encoding = {"dtype": "int8", "scale_factor": 1e-9}
    cosserat.save(changed, tmp_path / "changed.nc")
    with xr.open_dataset(tmp_path / "changed.nc") as stored:
        assert (stored["tip"] == answer["tip"]).all()
        assert (stored["status"] == answer["status"]).all()


def test_members_that_were_masked_are_written(answer, tmp_path):
    """`where` leaves texts beside values that are missing."""
    cosserat.save(answer.where(answer.force > 1.5), tmp_path / "masked.nc")


@pytest.mark.parametrize(
    ("part", "rows", "words"),
    [
        (lambda d: d.where(d.force > 1.5, drop=True), 4, {"solved"}),
        (lambda d: d.where(d.force > 1.5), 6, {"solved", ""}),
        (lambda d: d.mean("height"), 3, {"solved"}),
        (lambda d: d[["tip", "mx"]], 6, {""}),
        (lambda d: d.assign(status=d.status + 0.5), 6, {""}),
        (lambda d: d.isel(force=[]), 0, set()),
    ],
)
def test_parts_of_an_answer_have_a_row_for_each_member(answer, part, rows, words):
    """These were an IndexError, or the rows of a table of places."""
    table = cosserat.to_dataframe(part(answer))
    assert len(table) == rows
    assert set(table["status"]) == words
    assert set(table["reason"]) <= {""}
    force = table["force [N]"] if "force [N]" in table else table.iloc[:, 0]
    first = table[(force == 2.0)] if rows else table
    if rows and "height [m]" in table and "tip [m]" in table:
        tip = answer["tip"].sel(force=2.0, height=0.01).item()
        assert first[first["height [m]"] == 0.01]["tip [m]"].tolist() == [tip]


def test_the_picture_of_read_outs_without_their_status(answer, tmp_path):
    """It was called a fault of cosserat; how many members are solved is not known, and not said."""
    cosserat.save(answer, tmp_path / "answer.nc")
    stored = cosserat.load(tmp_path / "answer.nc")
    assert cosserat.plot(stored[["tip", "mx"]]).get_suptitle().endswith(": 6 members")
    assert cosserat.plot(stored.where(stored.force > 1.5, drop=True)).axes
    for given, said in (
        (stored[["tip"]], "use it as cosserat made it"),
        (stored, "a fault of cosserat"),
    ):
        with pytest.raises(CosseratError, match=said), holding_what_is_needed(given, "its picture"):
            raise KeyError


def test_what_is_no_table(answer):
    with pytest.raises(InputError, match="no numbers for a table"):
        cosserat.to_dataframe(xr.Dataset())
    with pytest.raises(InputError, match="has a 'status' of type"):
        cosserat.to_dataframe(answer.assign(status=answer.status.astype(str)))
    with pytest.raises(InputError, match="neither 'status' nor varied keys"):
        cosserat.to_dataframe(answer[["tip"]].drop_vars(["force", "height"]))
