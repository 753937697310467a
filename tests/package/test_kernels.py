"""The folder of compiled kernels if the package, the home or both are read-only."""

import os
import shutil
import subprocess
import sys
import tempfile

import pytest
from conftest import ROOT

from cosserat.solvers import kernels
from cosserat.solvers.kernels import FOLDERS

# Small kernels of every kind that is decorated: a function with a cache, and one that is called from C.
USE = """
import cosserat.solvers, sys
from numba import cfunc, njit
from pathlib import Path
print(sys.modules["numba"].config.CACHE_DIR)
import cosserat.solvers.banded
banded = cosserat.solvers.banded
@cfunc("float64(float64)", cache=True)
def same(x):
    return x
print(type(banded.constrain._cache).__name__, same.ctypes(2.0))
"""


@pytest.fixture(scope="module")
def closed(tmp_path_factory):
    """A copy of the package in which no cache can be written, for the superuser neither: files stand in its place."""
    folder = tmp_path_factory.mktemp("closed")
    shutil.copytree(ROOT / "cosserat", folder / "cosserat", ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "use.py").write_text(USE)
    for place in FOLDERS:
        (folder / "cosserat" / place / "__pycache__").touch()
    return folder


def python(closed, *arguments, **environment):
    kept = {"PATH": os.environ["PATH"], "PYTHONPATH": str(closed)}
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=closed,
        env={**kept, **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    return done.returncode, done.stdout, done.stderr


def test_beside_writable_sources_the_default_cache_is_used(monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    kernels.choose_cache()
    assert "NUMBA_CACHE_DIR" not in os.environ


def test_the_cache_of_the_user_is_the_second_choice_and_is_reported_once(closed, tmp_path):
    homes = {"HOME": str(tmp_path), "TMPDIR": str(tmp_path)}
    code, out, err = python(closed, "use.py", **homes)
    assert code == 0, err
    assert out.split() == [str(tmp_path / ".cache/cosserat"), "FunctionCache", "2.0"]
    assert err.count("\n") == 1
    assert "compiled kernels are kept in" in err
    assert python(closed, "use.py", **homes) == (0, out, "")


def test_without_a_home_the_cache_is_a_private_temporary_folder(closed, tmp_path):
    nowhere = {"HOME": "/dev/null/none", "TMPDIR": str(tmp_path)}
    folder = tmp_path / f"cosserat-{os.getuid()}"
    code, out, err = python(closed, "use.py", **nowhere)
    assert code == 0, err
    assert out.split()[0] == str(folder)
    assert str(folder) in err
    assert folder.stat().st_mode & 0o077 == 0


@pytest.mark.parametrize("caches", [{}, {"XDG_CACHE_HOME": "missing/.cache"}])
def test_a_missing_home_is_not_made(closed, tmp_path, caches):
    """A superuser in a container could create the missing home; the package does not."""
    caches = {name: str(tmp_path / place) for name, place in caches.items()}
    code, out, err = python(
        closed, "use.py", HOME=str(tmp_path / "missing"), TMPDIR=str(tmp_path), **caches
    )
    assert code == 0, err
    assert out.split()[0] == str(tmp_path / f"cosserat-{os.getuid()}")
    assert [path.name for path in tmp_path.iterdir()] == [f"cosserat-{os.getuid()}"]


@pytest.mark.parametrize("reason", ["others may write there", "nothing can be written"])
def test_without_a_safe_folder_nothing_is_cached(closed, tmp_path, reason):
    """Code in a cache is executed, so a folder that others may write to is not used."""
    folder = tmp_path / f"cosserat-{os.getuid()}"
    if reason == "others may write there":
        folder.mkdir()
        folder.chmod(0o777)
    else:
        folder.touch()
    code, out, err = python(closed, "use.py", HOME="/dev/null/none", TMPDIR=str(tmp_path))
    assert code == 0, err
    assert out.split() == ["NullCache", "2.0"]  # no folder, no cache
    assert err.count("\n") == 1
    assert "set NUMBA_CACHE_DIR" in err
    assert not folder.is_dir() or not list(folder.iterdir())


def test_no_temporary_folder_at_all_is_no_error(monkeypatch):
    def none():
        raise FileNotFoundError("No usable temporary directory found")

    monkeypatch.setattr(tempfile, "gettempdir", none)
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")
    assert list(kernels._candidates()) == []


@pytest.mark.parametrize("arguments", [("--help",), ("cases",)])
def test_help_and_cases_load_nothing_compiled(closed, arguments):
    code = f"""
import sys
from cosserat.cli import main
try:
    main({list(arguments)})
finally:
    loaded = {{"numba", "scipy", "xarray", "pint", "matplotlib"}} & set(sys.modules)
    assert not loaded, loaded
"""
    code, out, err = python(closed, "-c", code, HOME="/dev/null/none", TMPDIR="/dev/null")
    assert (code, err) == (0, "")
    assert "clamped_free" in out


def test_a_result_is_shown_by_a_package_that_cannot_be_written(closed, tmp_path):
    stored = ROOT / "results/reference/hanging_bar.nc"
    code, out, err = python(
        closed, "-m", "cosserat", "show", str(stored), HOME="/dev/null/none", TMPDIR=str(tmp_path)
    )
    assert code == 0, err
    assert "hanging_bar" in out
