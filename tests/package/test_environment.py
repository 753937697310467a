"""The lock has every installed package, so no resolver runs; an incomplete environment is made again."""

import importlib.metadata
import re
import shutil
import subprocess
import sys
import tomllib

import pytest
from conftest import ROOT
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

LOCK = (ROOT / "requirements.lock").read_text()
PINS = [Requirement(pin) for pin in re.findall(r"^([a-zA-Z].*?) \\$", LOCK, flags=re.MULTILINE)]


def holds(requirement, extras=()):
    """Whether a requirement counts here, for a distribution asked for with these extras."""
    marker = requirement.marker
    return marker is None or any(marker.evaluate({"extra": extra}) for extra in ("", *extras))


def lacking(pins, asked, needs):
    """What is needed, from what is asked for on, and not pinned with its extras and in the asked range.

    pins : pinned requirements by canonical name; needs : the requirements of a distribution, as texts, by its name.
    """
    found, left, seen = [], [(line, ()) for line in asked], set()
    while left:
        line, extras = left.pop()
        wanted = Requirement(line)
        name = canonicalize_name(wanted.name)
        if not holds(wanted, extras) or (name, line, extras) in seen:
            continue
        seen.add((name, line, extras))
        pin = pins.get(name)
        version = pin and next(iter(pin.specifier)).version
        if pin is None or not wanted.specifier.contains(version, prereleases=True):
            found.append(line)
            continue
        found += [f"{name}[{extra}]" for extra in sorted(wanted.extras - pin.extras)]
        left += [(need, tuple(sorted(pin.extras))) for need in needs(name)]
    return sorted(set(found))


def asked_for():
    """The lines of requirements.in and of pyproject.toml, of every group of the package."""
    lines = re.findall(r"^[a-zA-Z].*$", (ROOT / "requirements.in").read_text(), flags=re.MULTILINE)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    groups = project["optional-dependencies"].values()
    return [*lines, *project["dependencies"], *(line for group in groups for line in group)]


def installed(name):
    return importlib.metadata.requires(name) or []


def pinned(pins):
    return {canonicalize_name(pin.name): pin for pin in pins if holds(pin)}


def test_the_lock_names_no_host_and_hashes_everything():
    assert "://" not in LOCK
    assert not re.search(r"index|find-links|trusted-host", LOCK)
    blocks = re.split(r"\n(?=[a-zA-Z])", LOCK)
    named = [block for block in blocks if re.match(r"[a-zA-Z]", block)]
    assert len(named) == len(PINS) > 50
    assert all("--hash=sha256:" in block for block in named)
    assert all(re.fullmatch(r"==[^,*]+", str(pin.specifier)) for pin in PINS)


def test_installed_packages_are_those_of_the_lock():
    for name, pin in pinned(PINS).items():
        assert pin.specifier.contains(importlib.metadata.version(name), prereleases=True), name


def test_the_lock_is_complete_with_extras():
    """So `pip install --no-deps` needs nothing else and installs no later version."""
    assert lacking(pinned(PINS), asked_for(), installed) == []


@pytest.mark.parametrize(
    ("without", "said"),
    [
        ("coverage[toml]", "coverage[toml]"),  # pinned without the extra that pytest-cov asks for
        ("llvmlite", "llvmlite"),
        ("snakemake", "snakemake"),
    ],
)
def test_an_incomplete_lock_is_noticed(without, said):
    name, _, extra = without.partition("[")
    kept = [pin for pin in PINS if pin.name != name]
    if extra:
        kept.append(Requirement(f"{name}=={importlib.metadata.version(name)}"))
    missing = lacking(pinned(kept), asked_for(), installed)
    assert any(re.match(re.escape(said), line) for line in missing), missing


STUB = """#!{python} -IS
import os, pathlib, sys
words = sys.argv[1:]
if words[:3] == ["-m", "venv", "--clear"]:
    made = pathlib.Path(words[3]) / "bin/python"
    made.parent.mkdir(parents=True, exist_ok=True)
    made.unlink(missing_ok=True)
    made.symlink_to(__file__)
    with open("made", "a") as log:
        log.write("made\\n")
elif words[:1] == ["-m"]:
    if os.environ.get("KILLED") in words:
        os.kill(os.getppid(), 9)
else:
    exec(words[1])
"""


@pytest.fixture
def folder(tmp_path):
    """A checkout with a Python that only pretends to make environments, and writes down that it did."""
    here = tmp_path / "my repo's folder"
    (here / ".ci").mkdir(parents=True)
    for name in ("Makefile", ".ci/environment", "requirements.lock", "pyproject.toml"):
        shutil.copy(ROOT / name, here / name)
    stub = tmp_path / "python3"
    stub.write_text(STUB.format(python=sys.executable))
    stub.chmod(0o755)
    return here


def set_up(folder, **environment):
    done = subprocess.run(
        ["make", "environment", f"PYTHON={folder.parent / 'python3'}"],
        cwd=folder,
        env={"PATH": "/usr/bin:/bin", **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    log = folder / "made"
    return done.returncode, log.read_text().count("made") if log.exists() else 0


@pytest.mark.parametrize("linked", [False, True])
def test_a_folder_of_the_user_is_not_made_into_an_environment(folder, linked):
    mine = folder / ("mine" if linked else ".venv")
    mine.mkdir()
    (mine / "thesis.tex").write_text("mine")
    if linked:
        (mine / "pyvenv.cfg").touch()  # somebody else's environment
        (folder / ".venv").symlink_to(mine)
    code, count = set_up(folder)
    assert code != 0
    assert count == 0
    assert (mine / "thesis.tex").read_text() == "mine"


def test_an_environment_with_leftovers_of_a_kill_is_made_again(folder):
    assert set_up(folder) == (0, 1)
    (folder / ".venv/.ready").unlink()
    (folder / ".venv/lib").mkdir()  # and no pyvenv.cfg: it was being cleared
    assert set_up(folder) == (0, 2)


def test_an_environment_is_made_once_and_again_for_another_lock(folder):
    assert [set_up(folder), set_up(folder)] == [(0, 1), (0, 1)]
    (folder / "requirements.lock").write_text("# nothing\n")
    assert [set_up(folder), set_up(folder)] == [(0, 2), (0, 2)]


@pytest.mark.parametrize("at", ["--editable", "check"])
def test_an_environment_whose_installation_was_killed_is_made_again(folder, at):
    code, count = set_up(folder, KILLED=at)
    assert code != 0
    assert count == 1
    assert [set_up(folder), set_up(folder)] == [(0, 2), (0, 2)]


def test_an_environment_killed_during_its_second_installation_is_made_again(folder):
    assert set_up(folder) == (0, 1)
    lock = (folder / "requirements.lock").read_text()
    (folder / "requirements.lock").write_text("# nothing\n")
    assert set_up(folder, KILLED="--editable")[0] != 0
    (folder / "requirements.lock").write_text(lock)  # and the stamp of the first would say it is whole
    assert set_up(folder) == (0, 3)


def test_an_environment_of_another_folder_is_made_again(folder):
    assert set_up(folder) == (0, 1)
    moved = folder.rename(folder.with_name("moved"))
    assert [set_up(moved), set_up(moved)] == [(0, 2), (0, 2)]


def test_an_environment_without_its_python_is_made_again(folder):
    assert set_up(folder) == (0, 1)
    (folder / ".venv/bin/python").unlink()
    assert set_up(folder) == (0, 2)


@pytest.mark.parametrize("home", ["", "/dev/null/none", "here"])
def test_without_a_home_to_write_to_the_workflow_keeps_its_files_in_the_checkout(folder, home):
    assert set_up(folder) == (0, 1)
    stub = folder / ".venv/bin/snakemake"
    stub.write_text('#!/bin/sh\necho "cache ${XDG_CACHE_HOME-none} ${MPLCONFIGDIR-none}"\n')
    stub.chmod(0o755)
    done = subprocess.run(
        ["make", f"PYTHON={folder.parent / 'python3'}"],
        cwd=folder,
        env={"PATH": "/usr/bin:/bin", "HOME": str(folder.parent) if home == "here" else home},
        capture_output=True,
        text=True,
        check=True,
    )
    cache = folder / ".snakemake/cache"
    kept = "none none" if home == "here" else f"{cache} {cache}/matplotlib"
    assert done.stdout == f"cache {kept}\n"
