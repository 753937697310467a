"""Datasets and files: every variable has units, files have no date, are reproducible and never incomplete."""

import hashlib
import json
import os
import platform
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from conftest import ROOT, examples

import cosserat
from cosserat.data import dataset as files
from cosserat.data.checkpoints import Parts
from cosserat.data.variables import LABELS, VARIABLES
from cosserat.errors import ChangedResultWarning, InputError
from cosserat.solution import Solution


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def test_every_variable_has_a_description(solved):
    for data in solved.values():
        for name, variable in data.variables.items():
            if name in LABELS:
                assert variable.attrs["long_name"]
                continue
            entry = VARIABLES[name]
            assert variable.dims in (entry.dims, ("time", *entry.dims), ("point", *entry.dims))
            for key in ("units", "long_name", "symbol", "equation"):
                assert variable.attrs[key] == getattr(entry, key)
            assert np.isfinite(variable).all()


def test_every_described_variable_is_written(solved):
    """Variables of a user's energy, load, point or varying crawler are in no published case and no example."""
    own = {"mode_u_imaginary", "mode_delta_imaginary", "internal_variables", "other_dofs", "other_rates"}
    own |= {"resting_radius", "muscle_force", "muscle_pressure"}
    own |= {"attached_force", "probe", "probe_displacement", "probe_rotation"}
    every = [solved[name] for name in (*solved, *examples())]
    written = {str(name) for data in every for name in data.variables}
    assert written | own == set(VARIABLES) | set(LABELS)
    assert not written & own


def test_units_of_variables_are_known_units():
    import pint

    registry = pint.UnitRegistry()
    for entry in VARIABLES.values():
        assert registry(re.sub(r"([a-z])(-?\d)", r"\1**\2", entry.units.replace(" ", "*"))) is not None


def test_attributes_hold_parameters_statistics_and_origin(solved):
    data = solved["necking"]
    assert json.loads(data.attrs["parameters"])["problem"]["rod"]["material"]["poisson"] == 0.3
    assert files.case_of(data) == cosserat.case("necking")
    assert files.statistics_of(data)["iterations"] >= 1
    assert "sha256:" in data.attrs["source"]
    assert set(json.loads(data.attrs["environment"])) == {"python", "numpy", "scipy", "numba"}
    assert data.attrs["history"] == "cosserat run necking"


CLOCK = re.compile(
    r"\b(?:19|20)\d\d-\d\d|\b\d{1,2}:\d\d\b"  # 2026-11-22, 17:05
    r"|\b(?:Jan|Feb|Mar|Apr|May|Jun|Jul|Aug|Sep|Oct|Nov|Dec)[a-z]*\.? \d|(?<![\d.])1[6-9]\d{8}\b"  # Nov 22, Unix
)


@pytest.mark.parametrize(
    "text", ["2026-11-22T17:05", "at 9:41", "Sun Nov 22 2026", "17:05:33", "1795367133.5"]
)
def test_dates_and_times_of_day_are_recognised(text):
    assert CLOCK.search(text)


def test_no_attribute_holds_a_date_or_a_time_of_day(solved):
    for name, data in solved.items():
        for attributes in (data.attrs, *(variable.attrs for variable in data.variables.values())):
            for key, value in attributes.items():
                assert not CLOCK.search(str(value)), f"{name}: {key}: {value}"
                assert not re.search("date|time_|created|modified", key), name


def test_the_same_case_at_another_time_gives_the_same_bytes(tmp_path):
    """This process and another one, more than a second apart by the machine's clock."""
    here, elsewhere = tmp_path / "here.nc", tmp_path / "elsewhere.nc"
    cosserat.save(cosserat.run("clamped_free"), here)
    command = (
        "import cosserat, time; found = cosserat.run('clamped_free'); "
        f"time.sleep(max(0, {time.time() + 1.1} - time.time())); cosserat.save(found, {str(elsewhere)!r})"
    )
    subprocess.run([sys.executable, "-c", command], check=True, cwd=ROOT)
    assert digest(here) == digest(elsewhere)


def test_a_file_is_read_as_it_was_written(tmp_path, solved):
    cosserat.save(solved["necking"], tmp_path / "a.nc")
    xr.testing.assert_identical(cosserat.load(tmp_path / "a.nc"), solved["necking"])


def test_times_open_anywhere_as_plain_seconds_and_along_no_dimension_of_dates(tmp_path, solved):
    """A dimension called `time` is one of dates to the tools of CF, which then ask for an epoch."""
    for name in ("vibration_c4_20", "worm"):
        data, path = solved[name], tmp_path / f"{name}.nc"
        cosserat.save(data, path)
        with xr.open_dataset(path) as plain:
            assert "time" not in plain.sizes
            assert plain.time.dims == ("frame",)
            assert plain.time.dtype == np.float64
            assert plain.time.attrs["units"] == "s"
            assert "time" in plain.coords
            np.testing.assert_array_equal(plain.time, data.time)
        xr.testing.assert_identical(cosserat.load(path), data)
        data.to_netcdf(path)  # as files had it before
        with pytest.warns(ChangedResultWarning, match="another program"):
            assert cosserat.load(path).sizes == data.sizes


def test_a_failed_write_keeps_the_old_file_and_leaves_no_temporary_file(tmp_path, solved, monkeypatch):
    path = tmp_path / "a.nc"
    path.write_text("old")

    def fail(self, target, **_):
        Path(target).write_text("half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(xr.Dataset, "to_netcdf", fail)
    with pytest.raises(InputError, match="No space left"):
        cosserat.save(solved["necking"], path)
    assert path.read_text() == "old"
    assert [file.name for file in tmp_path.iterdir()] == ["a.nc"]


def test_temporary_files_of_killed_processes_are_removed(tmp_path, solved):
    finished = subprocess.Popen([sys.executable, "-c", ""])
    finished.wait()
    dead, other, alive, foreign = (
        tmp_path / name
        for name in (
            f".a.nc.{platform.node()}.{finished.pid}.part",
            f".b.nc.{platform.node()}.{finished.pid}.part",
            f".a.nc.{platform.node()}.{os.getppid()}.part",
            f".a.nc.another-machine.{finished.pid}.part",
        )
    )
    for file in (dead, other, alive, foreign):
        file.write_text("half")
    cosserat.save(solved["necking"], tmp_path / "a.nc")
    assert sorted(tmp_path.iterdir()) == sorted([tmp_path / "a.nc", other, alive, foreign])


def test_ctrl_c_waits_until_a_file_is_written(tmp_path, solved, monkeypatch):
    """An interrupt while xarray writes would leave a lock, and the run would hang."""
    write, written = xr.Dataset.to_netcdf, []
    before = signal.signal(
        signal.SIGINT, signal.default_int_handler
    )  # a job in the background ignores it

    def interrupted(self, *arguments, **options):
        signal.raise_signal(signal.SIGINT)
        write(self, *arguments, **options)
        written.append(signal.getsignal(signal.SIGINT))

    with monkeypatch.context() as patch:
        patch.setattr(xr.Dataset, "to_netcdf", interrupted)
        with pytest.raises(KeyboardInterrupt):
            cosserat.save(solved["necking"], tmp_path / "a.nc")
    assert len(written) == 1
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    signal.signal(signal.SIGINT, before)
    assert not list(tmp_path.iterdir())
    cosserat.save(solved["necking"], tmp_path / "a.nc")


def test_bad_destinations_and_files_are_refused(tmp_path, solved):
    with pytest.raises(InputError, match=r"folder .*none does not exist"):
        cosserat.save(solved["necking"], tmp_path / "none" / "a.nc")
    with pytest.raises(InputError, match="is a folder"):
        cosserat.save(solved["necking"], tmp_path)
    with pytest.raises(InputError, match="there is no file"):
        cosserat.load(tmp_path / "none.nc")
    (tmp_path / "bad.nc").write_bytes(b"not netCDF at all")
    with pytest.raises(InputError, match=r"cannot read .*bad\.nc: it is no netCDF"):
        cosserat.load(tmp_path / "bad.nc")
    with pytest.raises(InputError, match="no attribute 'parameters'"):
        files.case_of(xr.Dataset())
    with pytest.raises(InputError, match="of this version"):
        files.case_of(xr.Dataset(attrs={"parameters": '{"name": "x"}'}))


def test_values_that_are_not_finite_are_refused():
    case = cosserat.case("clamped_free")
    with pytest.raises(ValueError, match="variable 'mu' is not finite"):
        files.to_dataset(case, Solution({"mu": (("vertex",), np.array([1.0, np.nan]))}, {}))


@pytest.mark.parametrize(
    ("name", "dims", "shape"),
    [
        ("mu", ("vertex",), (3, 2)),
        ("mu", ("edge",), (3,)),
        ("x", ("vertex", "axis", "time"), (3, 2, 4)),
        ("x", ("section", "vertex", "axis"), (3, 2, 4)),
    ],
)
def test_fields_of_other_dimensions_are_refused(name, dims, shape):
    with pytest.raises(ValueError, match=f"variable '{name}' has dimensions"):
        files.to_dataset(cosserat.case("clamped_free"), Solution({name: (dims, np.zeros(shape))}, {}))


def test_unknown_fields_are_refused():
    with pytest.raises(ValueError, match="no such variables: mew"):
        files.to_dataset(cosserat.case("clamped_free"), Solution({"mew": (("vertex",), np.ones(3))}, {}))


def test_parts_are_removed_with_their_folder_and_other_files_stay(tmp_path):
    parts = Parts(tmp_path / "x.nc")
    parts.folder.mkdir()
    for name in ("00000.nc", "00001.nc", "stopped.nc", ".00002.nc.machine.12.part", "notes.txt"):
        (parts.folder / name).touch()
    parts.remove()
    assert [file.name for file in parts.folder.iterdir()] == ["notes.txt"]
    (parts.folder / "notes.txt").unlink()
    parts.remove()
    assert not parts.folder.exists()
    parts.remove()
