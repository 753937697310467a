"""Every block of TOML, shell and Python in the README is executed, and its picture is up to date."""

import os
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

import cosserat
from cosserat.cli import main
from cosserat.figures.style import write
from cosserat.thesis.figures.catalogue import FIGURES, draw
from cosserat.thesis.outputs.manifest import structure

TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w*)\n(.*?)^```$", TEXT, flags=re.MULTILINE | re.DOTALL)
PICTURE = ROOT / "chapters/opening.svg"
ELSEWHERE = {  # lines that are not executed here, and where they are
    "make": "minutes: .ci/run, in a fresh clone",
    "make test": "runs this test: .ci/run",
    "make test-workflow": "minutes: .ci/run",
    "source .venv/bin/activate": "sets the path up, as is done here by hand",
    "make archive": "after make: .ci/run, and tests/thesis/test_released_outputs.py writes one of some outputs",
    ".venv/bin/cosserat verify": "after make: .ci/run, and tests/thesis/test_released_outputs.py",
    ".venv/bin/python -m tests.outside": "minutes: tests/outside/test_public_cases.py runs its quick cases",
    ".venv/bin/cosserat power": "minutes: tests/thesis/test_power.py runs it for some changes",
}


def blocks(language):
    return [text for found, text in BLOCKS if found == language]


TABLES = [
    (name, text)
    for text in blocks("toml")
    for name, table in tomllib.loads(text).items()
    if table.get("kind") != "study"  # which the shell lines solve
]
LINES = [line.split("  #")[0].strip() for text in blocks("sh") for line in text.splitlines()]


def test_every_block_is_in_a_language_that_is_executed():
    assert {language for language, _ in BLOCKS} == {"toml", "sh", "python", "console"}
    assert TEXT.count("```") == 2 * len(BLOCKS)
    prose = re.sub(r"^```.*?^```$", "", TEXT, flags=re.MULTILINE | re.DOTALL)
    assert not re.search(r"^(    |\t)", prose, flags=re.MULTILINE), (
        "code outside a block with its language"
    )
    assert max(map(len, TEXT.splitlines())) <= 120


def test_the_command_for_a_cluster_is_run_on_a_small_one():
    """With other targets, and the partition of the Slurm that `.ci/slurm` starts."""
    (line,) = "".join(blocks("console")).splitlines()
    given, _ = line.removeprefix("snakemake all ").split("=PARTITION")
    assert f'snakemake "$@" {given}=one' in (ROOT / ".ci/slurm").read_text()


@pytest.mark.parametrize("name", [name for name, _ in TABLES])
def test_a_case_of_the_readme_is_solved(name, tmp_path, monkeypatch, capsys):
    """A second of motion is read as it is and solved for its first tenth, which has its largest amplitude."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TQDM_DISABLE", "1")  # a slow machine would show progress
    text = "\n".join(blocks("toml"))
    Path("whole.toml").write_text(text, encoding="utf-8")
    assert cosserat.case(name, "whole.toml").name == name
    Path("my.toml").write_text(text.replace('duration = "1 s"', 'duration = "0.1 s"'), encoding="utf-8")
    assert main(["run", name, "--file", "my.toml"]) == 0
    said = capsys.readouterr()
    assert said.err == "", "an example warns"
    assert said.out.endswith(f"wrote {name}.nc\n")
    assert cosserat.load(f"{name}.nc").attrs["case"] == name


@pytest.mark.parametrize("text", blocks("python"))
def test_python_of_the_readme_is_executed(text, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    exec(compile(text, "README.md", "exec"), {})
    assert float(capsys.readouterr().out) > 0
    written = {file.name for file in tmp_path.iterdir()}
    assert written == set(re.findall(r"(\w+\.(?:nc|svg))", text))


def test_shell_lines_of_the_readme_are_executed_in_their_order(tmp_path, monkeypatch, capsys):
    """The cases of the README are in my.toml, and each line writes the file that the README names."""
    assert set(ELSEWHERE) <= set(LINES), "an exemption of a line that the README does not have"
    (tmp_path / "my.toml").write_text("\n".join(blocks("toml")), encoding="utf-8")
    path = os.pathsep.join([str(Path(sys.executable).parent), *os.get_exec_path()])
    environment = {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT)}
    monkeypatch.chdir(tmp_path)
    here = [line for line in LINES if line and line not in ELSEWHERE]
    assert here
    shown = set()
    for line in here:
        command, *words = shlex.split(line)
        if (
            command == "cosserat" and command in shown
        ):  # the first one shows that there is such a command
            assert (main(words), capsys.readouterr().err) == (0, ""), line
            continue
        done = subprocess.run(
            line, shell=True, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )
        assert (done.returncode, done.stderr) == (0, ""), line
        shown.add(command)
    written = re.findall(r"\b(\w+\.(?:nc|svg))\b", "\n".join(blocks("sh")))
    assert written
    assert set(written) <= {file.name for file in tmp_path.iterdir()}


def test_commands_within_sentences_have_the_options_that_they_name():
    """`cosserat run CASE --keep-last`: read by the command line, not run."""
    from cosserat.cli import parser_of_commands

    named = re.findall(r"`(cosserat [^`]+)`", TEXT)
    assert named
    for code in named:
        assert parser_of_commands().parse_args(shlex.split(code)[1:]), code


def test_files_named_in_the_readme_exist():
    patterns = (
        r"\]\(([^)#]+)\)",
        r"`((?:cosserat|chapters|tests)/[\w/]+\.\w+)`",
        r"\b[A-Z]+\.(?:md|cff)\b",
    )
    named = [name for pattern in patterns for name in re.findall(pattern, TEXT)]
    assert len(named) > 3
    assert [name for name in named if not (ROOT / name).exists()] == []


def same_picture(one, other):
    """Whether two SVGs differ by no more than a hundredth of a point."""
    (form, numbers), (other_form, others) = structure(one), structure(other)
    return form == other_form and bool(np.abs(np.subtract(numbers, others)).max() < 0.01)


@pytest.fixture(scope="module")
def redrawn(solved, tmp_path_factory):
    path = tmp_path_factory.mktemp("opening") / "opening.svg"
    write(draw("fig_opening", {case: solved[case] for case in FIGURES["fig_opening"].cases}), path)
    return path.read_text(encoding="utf-8")


def test_the_picture_of_the_readme_is_up_to_date(redrawn):
    assert f"({PICTURE.relative_to(ROOT)})" in TEXT
    assert same_picture(PICTURE.read_text(encoding="utf-8"), redrawn), (
        "chapters/opening.svg is stale: 'make', then 'cosserat figure fig_opening -o chapters/opening.svg'"
    )
    assert PICTURE.stat().st_size < 150_000
    assert re.search(r'<path d="M 0 [\d.]+ \nL [^"]*" style="fill: #ffffff"/>', redrawn), (
        "no ground of its own"
    )


def test_a_stale_picture_is_noticed(redrawn):
    assert same_picture(redrawn, redrawn)
    place = redrawn.index("L ", len(redrawn) // 2) + 2
    digit = redrawn[place]
    moved = redrawn[:place] + str((int(digit) + 1) % 10) + redrawn[place + 1 :]
    assert not same_picture(redrawn, moved)
    assert not same_picture(redrawn, redrawn.replace("#9cc1e2", "#9cc1e3"))
