"""Datasets that a user changed: what no netCDF file can hold is one sentence, which names it."""

import numpy as np
import pytest
import xarray as xr

import cosserat
from cosserat.errors import InputError


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
