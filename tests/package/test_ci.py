"""Continuous integration runs the commands of the README, on the oldest supported Python and on a newer one."""

import os
import re
import tomllib

import yaml
from conftest import ROOT
from packaging.specifiers import SpecifierSet
from packaging.version import Version

WORKFLOW = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text())
SCRIPT = (ROOT / ".ci/run").read_text()
README = (ROOT / "README.md").read_text()


def commands(text, name):
    """Lines of a script or of the README that call a program, without environment, pipes and comments."""
    plain = re.sub(r'^"\$\{clean\[@\]\}" ', "", text, flags=re.MULTILINE)
    found = re.findall(rf"^{name}\b.*$", plain, flags=re.MULTILINE)
    return [re.split(r"\s+(?:#|\||>|2>)", line)[0].strip() for line in found]


def job():
    (only,) = WORKFLOW["jobs"].values()
    return only


def test_ci_runs_on_the_oldest_supported_python_and_a_newer_one():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    promised = SpecifierSet(project["requires-python"])
    versions = job()["strategy"]["matrix"]["python"]
    assert all(isinstance(version, str) for version in versions), "3.10 is 3.1 without quotation marks"
    assert len(set(versions)) > 1
    assert all(Version(version) in promised for version in versions)
    assert promised == SpecifierSet(f">={min(versions, key=Version)}")
    assert f"Python {min(versions, key=Version)} or newer" in README


def test_ci_runs_the_commands_of_the_readme_on_each_python():
    steps = job()["steps"]
    (step,) = (step for step in steps if "run" in step)
    assert step["run"] == ".ci/run"
    assert os.access(ROOT / ".ci/run", os.X_OK)
    assert step["env"] == {"PYTHON": "python${{ matrix.python }}"}
    assert '${PYTHON:+"PYTHON=$PYTHON"}' in SCRIPT  # which it hands on to make
    (set_up,) = (step for step in steps if step.get("uses", "").startswith("actions/setup-python@"))
    assert set_up["with"]["python-version"] == "${{ matrix.python }}"
    assert (ROOT / set_up["with"]["cache-dependency-path"]).is_file()


def test_the_ci_script_runs_every_command_of_the_readme_and_no_other():
    typed = "".join(re.findall(r"^```sh\n(.*?)^```$", README, flags=re.MULTILINE | re.DOTALL))
    for name in ("make", "cosserat"):
        said = commands(typed, name)
        assert len(said) > 2
        assert list(dict.fromkeys(commands(SCRIPT, name))) == said
