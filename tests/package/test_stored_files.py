"""Stored files: damage and changes are found before anything is read, and one writer has a result at a time."""

import os
import subprocess
import sys
import time
import warnings
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr
from conftest import ROOT, save_own

import cosserat
from cosserat.data import netcdf, readable
from cosserat.data.checkpoints import Parts
from cosserat.data.content import stamped
from cosserat.data.digest import DamagedError, digest_of, seal
from cosserat.data.locks import only_writer
from cosserat.data.netcdf import load_case
from cosserat.errors import ChangedResultWarning, CosseratError, CosseratWarning, InputError

KINDS_OF_DAMAGE = {
    "one bit": lambda b, at: b[:at] + bytes([b[at] ^ 1]) + b[at + 1 :],
    "a block": lambda b, at: b[:at] + bytes(255 - x for x in b[at : at + 512]) + b[at + 512 :],
    "cut off": lambda b, at: b[:at],
    "a byte more": lambda b, at: b[:at] + b"x" + b[at:],
}


@pytest.fixture
def stored(tmp_path, solved):
    path = tmp_path / "necking.nc"
    cosserat.save(solved["necking"], path)
    return path


@pytest.mark.parametrize("damage", KINDS_OF_DAMAGE.values(), ids=KINDS_OF_DAMAGE)
def test_damage_anywhere_is_refused_by_name(stored, solved, damage):
    whole = stored.read_bytes()
    for at in np.linspace(9, len(whole) - 2, 12).astype(int):
        stored.write_bytes(damage(whole, at))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ChangedResultWarning)
            with pytest.raises(InputError, match=r"necking\.nc.*(damaged|has no digest)"):
                cosserat.load(stored, own=True)
    stored.write_bytes(whole)
    xr.testing.assert_identical(cosserat.load(stored), solved["necking"])


def test_a_digest_that_is_half_there_is_damage_and_none_is_another_program(stored):
    whole = stored.read_bytes()
    for cut in (1, 20, 70):
        stored.write_bytes(whole[:-cut])
        with pytest.raises(DamagedError):
            digest_of(stored)
    stored.write_bytes(whole[: whole.rindex(b"\ncosserat")])
    assert digest_of(stored) is None
    seal(stored)
    assert stored.read_bytes() == whole


def test_a_result_that_another_program_changed_opens_with_a_warning(stored):
    with netCDF4.Dataset(stored, "a") as file:
        file["mu"][0] = 2.0
    with pytest.warns(
        ChangedResultWarning, match=r"necking\.nc was written by another program or changed"
    ):
        assert cosserat.load(stored).mu[0] == 2.0
    with pytest.raises(InputError, match="has no digest"):
        load_case(stored.parent, "necking")


def test_a_result_of_another_case_is_refused(stored):
    stored.rename(stored.with_name("elastica.nc"))
    with pytest.raises(InputError, match=r"elastica\.nc holds the case 'necking'; run 'elastica' again"):
        load_case(stored.parent, "elastica")


def hanging(path, dataset):
    """A result whose strings keep HDF5 for ever: the sizes of the objects in their heap are zero."""
    netcdf.save(dataset.assign(names=("name", np.array(["one", "two"], dtype=object))), path)
    whole, heap = path.read_bytes(), b"GCOL"
    first = whole.index(heap) + 16
    path.write_bytes(whole[:first] + bytes(200) + whole[first + 200 :])


@pytest.mark.parametrize("made", [seal, lambda path: None], ids=["digest made anew", "no digest"])
def test_a_file_that_hangs_the_library_is_given_up_and_the_next_is_read(
    stored, tmp_path, solved, monkeypatch, made
):
    hanging(tmp_path / "x.nc", solved["necking"])
    made(tmp_path / "x.nc")
    monkeypatch.setattr(readable, "_TIME", 0.3)
    with pytest.raises(
        InputError, match=r"x\.nc is damaged, or .* very busy: reading it did not end in 0 s; try again"
    ):
        cosserat.load(tmp_path / "x.nc")
    xr.testing.assert_identical(cosserat.load(stored), solved["necking"])


def test_files_are_tried_in_a_process_that_is_replaced_after_it_died(stored, solved):
    cosserat.load(stored)
    readable._reader._process.kill()
    readable._reader._process.wait()
    xr.testing.assert_identical(cosserat.load(stored), solved["necking"])


def test_a_kill_of_the_trying_process_accuses_no_file(stored, solved, monkeypatch, tmp_path):
    """It is asked once more, of a new process."""
    (tmp_path / "probe.py").write_text(
        "from pathlib import Path\n"
        "killed = Path(__file__).with_name('killed')\n"
        "print('ready', flush=True); input()\n"
        "if killed.exists(): print('read', flush=True); input()\n"
        "killed.touch()\n"
    )
    monkeypatch.setattr(readable, "_reader", reader := readable._Reader())
    monkeypatch.setattr(readable, "_PROGRAM", tmp_path / "probe.py")
    xr.testing.assert_identical(cosserat.load(stored), solved["necking"])
    assert (tmp_path / "killed").exists()
    reader.end()


def test_a_file_that_the_trying_process_does_not_survive_is_refused(stored, monkeypatch, tmp_path):
    (tmp_path / "probe.py").write_text("print('ready', flush=True); input()")
    monkeypatch.setattr(readable, "_reader", reader := readable._Reader())
    monkeypatch.setattr(readable, "_PROGRAM", tmp_path / "probe.py")
    with pytest.raises(InputError, match=r"cannot read .*necking\.nc: it is no netCDF file, or damaged"):
        cosserat.load(stored)
    (tmp_path / "probe.py").write_text("")
    reader.end()
    with pytest.raises(
        InputError, match=r"cannot start the process that tries .*python.* ended at once"
    ):
        cosserat.load(stored)


def test_a_process_that_tries_files_ends_with_its_parent(stored):
    program = f"import cosserat; from cosserat.data import readable; cosserat.load({str(stored)!r}); "
    done = subprocess.run(
        [sys.executable, "-c", program + "print(readable._reader._process.pid); import os; os._exit(0)"],
        capture_output=True,
        text=True,
        check=True,
    )
    for _ in range(100):
        if not Path(f"/proc/{done.stdout.strip()}/exe").exists():
            return
        time.sleep(0.05)
    raise AssertionError("it still runs")


def test_a_later_format_and_another_version_are_named(stored, solved):
    later = solved["necking"].assign_attrs(
        Conventions="CF-1.11 cosserat-2", source="cosserat 0.3.0, code sha256:0"
    )
    save_own(later, stored)
    with pytest.raises(
        InputError, match=r"format 2, written by cosserat 0\.3\.0, .*up to 1; install a newer"
    ):
        cosserat.load(stored)
    older = solved["necking"].assign_attrs(parameters="{}", source="cosserat 0.0.1, code sha256:0")
    with pytest.raises(
        InputError, match=r"written by cosserat 0\.0\.1 and read by cosserat 0\.1\.0,: the parameters"
    ):
        cosserat.case_of(older)


def test_parts_that_are_swapped_changed_or_of_another_run_are_refused(tmp_path, solved):
    parts, data = Parts(tmp_path / "x.nc"), solved["necking"]
    for number in range(3):
        parts.save(number, stamped(data.assign_attrs(number=number)))
    assert [parts.load(number).attrs["number"] for number in range(3)] == [0, 1, 2]
    paths = [parts.folder / f"{number:05d}.nc" for number in range(3)]
    second, third = paths[1].read_bytes(), paths[2].read_bytes()
    paths[1].write_bytes(third)
    with pytest.raises(
        InputError, match=r"00001\.nc does not continue the part before it; remove .*00001\.nc"
    ):
        parts.load(1)
    paths[1].write_bytes(second)
    with netCDF4.Dataset(paths[2], "a") as file:
        file["mu"][0] = 2.0
    with pytest.raises(InputError, match=r"00002\.nc has no digest.*remove .*00002\.nc"):
        parts.load(2)
    paths[0].write_bytes(second[:1000])
    with pytest.raises(InputError, match=r"00000\.nc"):
        parts.load(0)


def test_a_file_in_the_place_of_the_parts_is_named_before_anything_is_computed(tmp_path):
    (tmp_path / "x.nc.parts").write_text("mine")
    with pytest.raises(InputError, match=r"x\.nc\.parts is a file"):
        cosserat.run("clamped_free", result=tmp_path / "x.nc")


@pytest.mark.parametrize(
    ("mounted", "kind"),
    [
        ("nfs rw,vers=3,local_lock=none", ""),
        ("nfs4 rw,local_lock=all", "nfs4"),
        ("nfs rw,nolock,hard", "nfs"),
        ("lustre rw,localflock", "lustre"),
        ("lustre rw,flock", ""),
        ("fuse.sshfs rw", "fuse.sshfs"),
        ("ext4 rw", ""),
    ],
)
def test_a_file_system_whose_locks_other_machines_do_not_see_is_named_once(
    tmp_path, monkeypatch, mounted, kind
):
    mounts, shared = tmp_path / "mounts", tmp_path / "my share"
    shared.mkdir()
    place = str(shared).replace(" ", "\\040")
    mounts.write_text(f"/dev/a / ext4 rw 0 0\nhost:/x {place} {mounted} 0 0\nb {place}er 9p rw 0 0\n")
    monkeypatch.setattr("cosserat.data.locks._MOUNTS", mounts)
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        with only_writer(shared / "x.nc"), only_writer(shared / "x.nc"):
            pass
    assert [str(one.message) for one in said] == [
        f"the file system of {shared} ({kind}) takes locks for this machine alone; see to it that no run on another "
        "one writes x.nc"
    ] * bool(kind)


HOLD = "import sys, pathlib; from cosserat.data.locks import only_writer\n"
HOLD += "with only_writer(pathlib.Path(sys.argv[1])): print('held', flush=True); sys.stdin.read()"


def test_one_writer_at_a_time_and_a_killed_one_holds_nobody(tmp_path):
    path = tmp_path / "x.nc"
    other = subprocess.Popen(
        [sys.executable, "-c", HOLD, path],
        cwd=ROOT,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert other.stdout.readline() == "held\n"
    with pytest.raises(InputError, match=r"another run is writing .*x\.nc; wait"), only_writer(path):
        pass
    other.kill()
    other.communicate()
    with only_writer(path), only_writer(path):
        assert (tmp_path / ".x.nc.lock").exists()
    assert not list(tmp_path.iterdir())


def test_a_folder_without_locks_says_so(tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr("filelock.FileLock.acquire", refuse)
    with (
        pytest.warns(CosseratWarning, match="takes no locks .*no other run writes x"),
        only_writer(tmp_path / "x.nc"),
    ):
        pass


def test_a_changed_result_that_lacks_something_is_one_sentence_and_our_own_fault_is_not_hidden(
    stored, solved, capsys, monkeypatch
):
    from cosserat.cli import main

    data = solved["necking"]
    for changed, word in (
        (data.drop_vars("x_ref"), "x_ref"),
        (data.isel(vertex=slice(1)), "index"),
        (data.assign(note=((), "a text")), ""),
    ):
        changed.to_netcdf(stored)
        for command in ("plot", "show", "export"):
            code = main([command, str(stored), *(["--to", "csv"] if command == "export" else [])])
            err = capsys.readouterr().err
            warning, *error = err.splitlines()
            assert warning.startswith("warning: ")
            assert (code, len(error)) in ((0, 0), (2, 1)), (command, word, err)
            assert command != "plot" or not word or word in error[0], err
    cosserat.save(data, stored)
    monkeypatch.setattr("cosserat.figures.rod.picture", lambda _: 1 / 0)
    with pytest.raises(CosseratError, match="ZeroDivisionError.*a fault of cosserat") as raised:
        cosserat.plot(stored)
    assert not isinstance(raised.value, InputError)
    assert isinstance(raised.value.__cause__, ZeroDivisionError)


def test_an_output_that_is_an_input_is_refused(stored, tmp_path, capsys):
    from cosserat.cli import main

    picture = tmp_path / "a.svg"
    stored.rename(picture)
    (tmp_path / "b.svg").symlink_to(picture)
    whole = picture.read_bytes()
    for words in (["plot", picture], ["plot", picture, "-o", tmp_path / "b.svg"]):
        assert main(list(map(str, words))) == 2
        assert "is also read, and would be replaced" in capsys.readouterr().err
    for draw in (cosserat.plot, cosserat.animate):
        with pytest.raises(InputError, match="is also read, and would be replaced"):
            draw(str(picture), picture)
    assert picture.read_bytes() == whole


def test_a_result_in_a_folder_that_is_not_there_is_refused_before_anything_is_computed(tmp_path):
    with pytest.raises(InputError, match=r"the folder .*none does not exist"):
        cosserat.run("clamped_free", result=tmp_path / "none" / "x.nc")


def test_a_run_replaces_a_result_but_no_file_of_others(stored, tmp_path, capsys):
    from cosserat.cli import main

    for content in (b"mine", b"", stored.read_bytes().rpartition(b"\ncosserat")[0]):
        (tmp_path / "a.nc").write_bytes(content)
        assert main(["run", "necking", "-o", str(tmp_path / "a.nc")]) == 2
        assert "a.nc was written by another program or changed" in capsys.readouterr().err
        assert (tmp_path / "a.nc").read_bytes() == content
    (tmp_path / "a.nc").write_bytes(stored.read_bytes()[:-1])
    assert main(["run", "necking", "-o", str(tmp_path / "a.nc")]) == 0


def test_a_link_as_output_is_followed(stored, solved, tmp_path):
    (tmp_path / "link.nc").symlink_to(tmp_path / "target.nc")
    cosserat.save(solved["necking"], tmp_path / "link.nc")
    assert (tmp_path / "link.nc").is_symlink()
    assert (tmp_path / "target.nc").read_bytes() == stored.read_bytes()


def test_a_dataset_that_its_user_changed_is_stored_without_a_digest(solved, tmp_path):
    data = solved["necking"]
    for changed in (
        data.assign(mu=2 * data.mu),
        data.isel(vertex=slice(5)),
        data.assign_attrs(solver="{}"),
        data.drop_vars("u"),
    ):
        cosserat.save(changed, tmp_path / "a.nc")
        with pytest.warns(ChangedResultWarning):
            assert cosserat.load(tmp_path / "a.nc").sizes == changed.sizes
    cosserat.save(data.copy(deep=True), tmp_path / "a.nc")
    cosserat.save(cosserat.load(tmp_path / "a.nc"), tmp_path / "b.nc")
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()
    assert cosserat.load(tmp_path / "b.nc").identical(data)


def test_a_file_that_is_replaced_while_it_is_read_is_read_again(stored, solved, monkeypatch):
    """Its digest would be that of another file than its values."""
    checks = []
    edited = stored.with_name("edited.nc")
    cosserat.save(solved["necking"].assign(x=2 * solved["necking"].x), edited)

    def replaced(path):
        checks.append(path)
        if len(checks) == 1:
            edited.replace(path)

    monkeypatch.setattr(netcdf, "check_readable", replaced)
    with pytest.warns(ChangedResultWarning):
        assert not cosserat.load(stored).encoding["intact"]
    assert len(checks) == 2

    def always(path):
        checks.append(path)
        os.utime(path, ns=(0, len(checks)))

    monkeypatch.setattr(netcdf, "check_readable", always)
    with pytest.raises(InputError, match=r"necking\.nc is replaced again and again while it is read"):
        cosserat.load(stored)
    monkeypatch.setattr(netcdf, "check_readable", lambda path: path.unlink())
    with pytest.raises(InputError, match=r"cannot read .*necking\.nc"):
        cosserat.load(stored)


def test_the_file_of_a_name_is_that_of_the_library(solved, tmp_path, monkeypatch):
    """To netCDF a backslash is a slash, and to xarray a first "~" is the home."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    for folder in ("home", "~", "a"):
        (tmp_path / folder).mkdir()
    cosserat.save(solved["necking"], "~/x.nc")
    assert [path.name for path in (tmp_path / "~").iterdir()] == ["x.nc"]
    assert not list((tmp_path / "home").iterdir())
    assert cosserat.load("~/x.nc").identical(solved["necking"])
    (tmp_path / "~/x.nc").rename(tmp_path / "a/b.nc")
    (tmp_path / "a\\b.nc").touch()
    for call in (cosserat.load, lambda path: cosserat.save(solved["necking"], path)):
        with pytest.raises(InputError, match="has a backslash, which netCDF takes for a slash"):
            call("a\\b.nc")


def test_a_program_that_extends_its_path_finds_netcdf_also_in_the_process_that_tries_files(
    stored, tmp_path
):
    """As one that brings its packages along."""
    folders = [str(ROOT), *(folder for folder in sys.path if folder.endswith("-packages"))]
    program = f"import sys; sys.path[:0] = {folders}; import cosserat; "
    program += f"print(cosserat.load({str(stored)!r}).attrs['case'])"
    command = [sys._base_executable, "-I", "-S", "-c", program]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path)
    assert done.stdout == "necking\n"


CLOSES_ALL = """
import os, sys
import cosserat

stored, folder = sys.argv[1:]
cosserat.load(stored)
os.closerange(3, 256)
own = [open(f"{folder}/{number}.txt", "w") for number in range(8)]
cosserat.load(stored)
for file in own:
    file.write("own")
    file.close()
"""


def test_a_program_that_closed_all_descriptors_keeps_its_own_files(stored, tmp_path):
    """They get the numbers of the pipes to the process that tries files, as in a daemon."""
    command = [sys.executable, "-c", CLOSES_ALL, str(stored), str(tmp_path)]
    subprocess.run(command, check=True, timeout=60)
    assert [path.read_text() for path in tmp_path.glob("*.txt")] == ["own"] * 8


@pytest.mark.parametrize(
    "attribute", [{"scale_factor": 2.0}, {"add_offset": 5.0}, {"missing_value": 0.0}, {"dtype": "bool"}]
)
def test_an_attribute_that_changes_values_on_reading_is_not_written(solved, tmp_path, attribute):
    changed = solved["necking"].copy()
    changed["x"] = changed.x.assign_attrs(attribute)
    with pytest.raises(InputError, match=f"'{next(iter(attribute))}' of 'x' would change its values"):
        cosserat.save(changed, tmp_path / "x.nc")
    assert not list(tmp_path.iterdir())


def test_the_trying_process_depends_on_no_setting_of_the_environment(stored, tmp_path):
    (tmp_path / "netCDF4.py").write_text("raise SystemExit('not of this path')")
    program = f"import cosserat; print(cosserat.load({str(stored)!r}).attrs['case'])"
    for options, settings in (
        (["-I"], {"PYTHONPATH": str(tmp_path)}),
        ([], {"PYTHONIOENCODING": "utf-16-le"}),
    ):
        command = [sys.executable, *options, "-c", program]
        environment = {**os.environ, **settings}
        done = subprocess.run(command, capture_output=True, env=environment, timeout=30, check=True)
        assert done.stdout.replace(b"\0", b"") == b"necking\n"
