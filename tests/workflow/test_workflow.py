"""Snakemake on a copy of the repository: the jobs that rerun after a change, and the effect of a failing claim."""

import base64
import fcntl
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import small
from conftest import ROOT

import cosserat

pytestmark = pytest.mark.workflow

# The judged table and three figures, two of them drawn together: enough to see what reruns; one page of the book is
# made by the test that reads it.
DRAWN = ("fig_3_7", "fig_3_8", "fig_3_12")
# The cases that these need: the copy knows no others.
KEPT = (
    "hanging_bar",
    "clamped_free",
    "clamped_clamped",
    "necking",
    "necking_printed",
    "hanging_bar_consistent",
    "clamped_free_consistent",
    "clamped_clamped_consistent",
    "necking_consistent",
)
TARGETS = ("results/check.txt", *(f"results/figures/{name}.svg" for name in DRAWN))


def environment(folder):
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    return {**os.environ, "PYTHONPATH": str(folder), "PATH": path}


def call(folder, *arguments, cwd=None):
    done = subprocess.run(
        arguments,
        cwd=cwd or folder,
        env=environment(folder),
        capture_output=True,
        text=True,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr


def snakemake(folder, *arguments):
    return call(folder, "snakemake", *arguments)


def planned(folder):
    """Rules that a dry run would use and files that it would make, below results."""
    code, text = snakemake(folder, *TARGETS, "--dry-run")
    assert code == 0, text
    rules = set(re.findall(r"^(?:local)?rule ([a-z]+)\w*:$", text, re.MULTILINE))
    lines = re.findall(r"^    output: (.+)$", text, re.MULTILINE)
    outputs = {name.removeprefix("results/") for line in lines for name in line.split(", ")}
    return rules, outputs


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """A copy of the tracked files in which everything up to the figures has been made."""
    folder = tmp_path_factory.mktemp("checkout")
    small.copy(folder, KEPT, DRAWN)
    code, text = snakemake(folder, *TARGETS)
    assert code == 0, text
    return folder


@pytest.fixture
def edited(checkout):
    """Edit a file of the checkout for one test."""
    kept = {}

    def edit(name, old, new):
        file = checkout / name
        text = kept.setdefault(file, file.read_text())
        assert old in text
        file.write_text(text.replace(old, new))

    yield edit
    for file, text in kept.items():
        file.write_text(text)


def test_a_finished_workflow_has_nothing_to_rerun(checkout):
    assert planned(checkout) == (set(), set())


def test_an_edited_case_reruns_only_its_batch_and_what_depends_on_it(checkout, edited):
    key = 'rod.poisson_coupling = "printed"'
    edited("cosserat/thesis/cases/chapter3.toml", key, f"{key}\nrod.material.poisson = 0.31")
    rules, outputs = planned(checkout)
    assert rules == {"simulate", "measure", "check", "figure"}
    drawn = {"figures/fig_3_8.svg", "figures/fig_3_12.svg"}  # together, in one process
    solved = {name for name in outputs if name.startswith("cases/")}
    assert solved | {"report.csv", "check.txt"} | drawn == outputs
    assert "cases/necking_printed.nc" in solved
    assert len(solved) <= 6  # in one process
    assert len(solved) < len(KEPT)


def test_an_edited_solver_reruns_every_simulation(checkout, edited):
    edited(
        "cosserat/solvers/equilibrium.py",
        "_DECISIVE_ROUND_OFF_RATIO = 5.0",
        "_DECISIVE_ROUND_OFF_RATIO = 6.0",
    )
    _, outputs = planned(checkout)
    assert {f"cases/{name}.nc" for name in KEPT} <= outputs
    assert set(KEPT) < set(cosserat.published())


@pytest.mark.parametrize("name", ["beams", "elastica"])
def test_an_edited_formula_reruns_what_depends_on_it(checkout, edited, name):
    """Models start from closed forms, and rows and figures are compared with them."""
    file = f"cosserat/exact/{name}.py"
    edited(file, "import annotations", "import annotations  # edited")
    rules, outputs = planned(checkout)
    assert rules == {"simulate", "measure", "check", "figure"}
    assert {f"cases/{case}.nc" for case in KEPT} <= outputs


def test_edited_plotting_reruns_no_simulation(checkout, edited):
    edited("cosserat/figures/style.py", '"font.size": 10', '"font.size": 11')
    assert planned(checkout) == ({"figure"}, {f"figures/{name}.svg" for name in DRAWN})


def test_an_edited_tolerance_reruns_the_measurement_and_no_simulation(checkout, edited):
    edited("results/tolerances.csv", ',1e-4,abs,within,,,"lumped', ',2e-4,abs,within,,,"lumped')
    assert planned(checkout)[0] == {"measure", "check"}


def test_a_claim_that_fails_stops_the_workflow_and_leaves_the_report(checkout, edited):
    edited("results/tolerances.csv", ',1e-4,abs,within,,,"lumped', ',1e-9,abs,within,,,"lumped')
    code, text = snakemake(checkout, "results/check.txt")
    assert code != 0
    assert "F3.9-profile: displacement of the hanging bar" in text
    assert "FAILS" in (checkout / "results/report.csv").read_text()


def test_an_edited_reason_appears_in_the_book(checkout, edited):
    """The reason changes report.csv and not the summary of the check: a page reruns when its input changes."""
    page, summaries = "results/notebooks/results_table.ipynb", set()
    for reason in ("lumped weights give", "weights that are lumped give"):
        edited("results/tolerances.csv", "lumped weights give", reason)
        for target in (
            "results/check.txt",
            page,
        ):  # one by one: whatever changes in a run is followed anyway
            code, text = snakemake(checkout, target)
            assert code == 0, text
        assert reason in (checkout / page).read_text()
        summaries.add((checkout / "results/check.txt").read_text())
    assert len(summaries) == 1


def test_a_case_that_cannot_be_solved_stops_the_workflow_with_its_sentence(checkout, edited):
    edited("cosserat/thesis/cases/chapter3.toml", '"1 kN"', '"-1 GN"')
    code, text = snakemake(checkout, "results/cases/necking.nc")
    assert code != 0
    assert "case 'necking': the sections of vertices 0 and 1 cross" in text


def test_the_workflow_may_be_called_from_another_folder(checkout, tmp_path):
    target = checkout / "results/cases/hanging_bar.nc"
    target.unlink(missing_ok=True)
    code, text = call(
        checkout, "snakemake", "-s", checkout / "Snakefile", "results/cases/hanging_bar.nc", cwd=tmp_path
    )
    assert code == 0, text
    assert target.is_file()
    assert {file.name for file in tmp_path.iterdir()} == {".snakemake"}  # its protocol alone


SOME = ("necking", "hanging_bar", "clamped_free")
AGAIN = [f"results/cases/{name}.nc" for name in SOME]


def started(folder, *arguments):
    """Snakemake as the leader of a group of processes, its words to be read line by line."""
    return subprocess.Popen(
        ["snakemake", *arguments],
        cwd=folder,
        env=environment(folder),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )


def read_until(process, words):
    """Its words up to the first line that holds these, or to the end."""
    seen = []
    for line in process.stdout:
        seen.append(line)
        if words in line:
            break
    return "".join(seen)


def test_the_same_command_continues_after_a_kill_at_any_moment(checkout):
    """The kill is of the whole process group, or of Snakemake alone; its job then continues and is waited for."""
    code, text = snakemake(checkout, *AGAIN)
    assert code == 0, text
    before = {name: (checkout / name).read_bytes() for name in AGAIN}
    for moment in ("Building DAG", "rule simulate", "alone"):
        with started(checkout, *AGAIN, "--forceall") as running:
            words = "rule simulate" if moment == "alone" else moment
            assert words in read_until(running, words)
            (os.kill if moment == "alone" else os.killpg)(running.pid, signal.SIGKILL)
        code, text = snakemake(checkout, *AGAIN)
        assert code == 0, moment + text
        assert {name: (checkout / name).read_bytes() for name in AGAIN} == before


def test_an_incomplete_output_is_made_again(checkout):
    """The job is killed after its file is complete and before Snakemake has recorded that."""
    code, text = snakemake(checkout, AGAIN[0])
    assert code == 0, text
    marker = checkout / ".snakemake/incomplete" / base64.urlsafe_b64encode(AGAIN[0].encode()).decode()
    marker.write_text('{"external_jobid": null}')
    code, text = snakemake(checkout, AGAIN[0])
    assert code == 0, text
    assert "1 of 1 steps" in text
    assert not marker.exists()


def test_a_run_of_a_live_process_is_waited_for(checkout):
    left = checkout / ".snakemake/locks/0.output.lock"
    held = (checkout / ".snakemake/held").open()
    fcntl.flock(held, fcntl.LOCK_SH)  # as a running job holds it
    left.parent.mkdir(exist_ok=True)
    left.write_text(AGAIN[0] + "\n")
    with started(checkout, *AGAIN) as second:
        assert "waiting for another run in this folder" in read_until(second, "waiting")
        assert left.exists()
        assert second.poll() is None
        held.close()
        text = second.stdout.read()
    assert second.returncode == 0, text
    assert not left.exists()


def test_every_rule_has_a_log_and_a_benchmark():
    rules = re.split(r"\n(?= *rule\b)", (ROOT / "Snakefile").read_text())[2:]
    assert len(rules) >= 6
    for rule in rules:
        assert "log:" in rule, rule
        measured_anew = rule.startswith("rule peers:")  # a benchmark counts as an output that is there
        assert ("benchmark:" in rule) != measured_anew, rule


def test_lint_complains_only_of_missing_conda_environments(checkout):
    _, text = call(checkout, "snakemake", "--lint")
    complaints = [line for line in text.splitlines() if line.startswith("    * ")]
    assert [line for line in complaints if "Specify a conda environment" not in line] == []


@pytest.mark.parametrize(
    ("stub", "sentence"),
    [
        ("exit 1", "cosserat needs Python 3.11 or newer as"),
        ('case "$2" in *ensurepip*) exit 1;; esac', "apt-get install python3-venv"),
    ],
)
def test_make_names_what_the_machine_lacks(checkout, tmp_path, stub, sentence):
    python = tmp_path / "python3"
    python.write_text(f"#!/bin/sh\n{stub}\n")
    python.chmod(0o755)
    code, text = call(checkout, "make", f"PYTHON={python}", "VENV=.other")
    assert code != 0
    assert sentence in text
    assert not (checkout / ".other").exists()


def test_the_report_is_one_file(checkout):
    code, text = snakemake(checkout, "results/check.txt", "--report", "report.html")
    assert code == 0, text
    assert (checkout / "report.html").stat().st_size > 100_000
