"""Jobs of a run on Slurm, with stand-ins for squeue and scancel; `.ci/slurm` has a real one."""

import fcntl
import os
import signal
import socket
import subprocess
import sys

import pytest
from conftest import ROOT

from cosserat.errors import InputError
from cosserat.studies import elsewhere
from cosserat.studies.elsewhere import Job

OURS, OTHER = "3f2a0000-1111-2222-3333-444444444444", "77770000-1111-2222-3333-444444444444"
QUEUE = f"""{OURS}|7|RUNNING|rule_study_batch_wildcards_3f2a
{OURS}|8|PENDING|rule_simulate_rod_path_0
{OTHER}|9|RUNNING|rule_study_batch_wildcards_4711
"""
# A queue in a file, one job a line; it says what it was asked.
SQUEUE = """#!/bin/sh
echo "squeue $*" >>"$QUEUE.asked"
for word; do case $word in --name=*) names=$(echo "${word#--name=}" | sed 's/,/|/g');; esac; done
grep -E "^($names)[|]" "$QUEUE" || true
"""
SCANCEL = """#!/bin/sh
echo "scancel $*" >>"$QUEUE.asked"
grep -v "^${1#--name=}[|]" "$QUEUE" >"$QUEUE.left"
mv "$QUEUE.left" "$QUEUE"
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder in which Snakemake used Slurm once, and Slurm's commands."""
    log = tmp_path / "run/.snakemake/log/2026-01-01T000000.snakemake.log"
    log.parent.mkdir(parents=True)
    log.write_text(f"Building DAG of jobs...\nSLURM run ID: {OURS}\nUsing shell: /bin/bash\n")
    (tmp_path / "queue").write_text(QUEUE)
    (tmp_path / "bin").mkdir()
    put(tmp_path, "squeue", SQUEUE)
    put(tmp_path, "scancel", SCANCEL)
    monkeypatch.setenv("QUEUE", str(tmp_path / "queue"))
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:/usr/bin:/bin")
    return tmp_path / "run"


def put(where, name, text):
    program = where / "bin" / name
    program.write_text(text)
    program.chmod(0o755)


def test_jobs_are_those_of_the_runs_in_the_folder(folder):
    assert elsewhere.jobs(folder) == [
        Job("7", "RUNNING", "3f2a"),
        Job("8", "PENDING", "simulate_rod_path_0"),
    ]


def test_a_folder_that_never_used_slurm_needs_none(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    assert elsewhere.jobs(tmp_path) == []
    assert elsewhere.cancel(tmp_path) == []


def test_only_the_jobs_of_the_folder_are_cancelled_and_once(folder):
    assert [job.id for job in elsewhere.cancel(folder)] == ["7", "8"]
    assert elsewhere.cancel(folder) == []
    assert (folder.parent / "queue").read_text().startswith(OTHER)
    asked = (folder.parent / "queue.asked").read_text().splitlines()
    assert [line for line in asked if line.startswith("scancel")] == [f"scancel --name={OURS}"]


def test_jobs_that_do_not_end_are_named(folder, monkeypatch):
    put(folder.parent, "scancel", "#!/bin/sh\n")
    monkeypatch.setattr(elsewhere, "_END", 0.1)
    with pytest.raises(
        InputError, match=r"^Slurm has not ended job 7, 8 within 0.1 s of scancel; look at it with"
    ):
        elsewhere.cancel(folder)


@pytest.mark.parametrize(
    ("squeue", "sentence"),
    [
        (
            None,
            "the run used Slurm and there is no squeue on this machine; ask where Slurm's commands are",
        ),
        (
            "echo 'slurm_load_jobs error: Unable to contact\nhelp' >&2; exit 1",
            "squeue failed \\('slurm_load.*contact'",
        ),
        ("exit 3", "squeue failed \\('exit code 3'\\); try again when Slurm answers"),
        ("exec sleep 5", "squeue did not answer within 0.2 s; try again when Slurm answers"),
    ],
)
def test_a_slurm_that_does_not_answer_is_one_sentence(folder, monkeypatch, squeue, sentence):
    monkeypatch.setattr(elsewhere, "_ANSWER", 0.2)
    if squeue is None:
        monkeypatch.setenv("PATH", str(folder))
    else:
        put(folder.parent, "squeue", f"#!/bin/sh\n{squeue}\n")
    with pytest.raises(InputError, match=sentence):
        elsewhere.jobs(folder)


def test_the_next_run_ends_what_a_killed_one_left_and_a_dry_one_does_not(folder, capsys):
    elsewhere.alone(folder, change=False).close()
    assert capsys.readouterr().err == ""
    assert len(elsewhere.jobs(folder)) == 2
    elsewhere.alone(folder).close()
    assert (
        "ended job 8 on Slurm, which a killed run left: simulate_rod_path_0\n" in capsys.readouterr().err
    )
    assert elsewhere.jobs(folder) == []
    put(folder.parent, "squeue", "#!/bin/sh\nexit 1\n")
    elsewhere.alone(folder).close()
    assert capsys.readouterr().err.startswith("jobs of an earlier run may be left: squeue failed")


# A Snakemake, as far as its lock goes.
HOLDER = """
import signal, sys
from cosserat.studies import elsewhere
if sys.argv[2] == "stubborn":
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
running = elsewhere.alone(sys.argv[1], change=False)
print("held", flush=True)
signal.pause()
"""


@pytest.mark.parametrize(("kind", "end"), [("meek", signal.SIGTERM), ("stubborn", signal.SIGKILL)])
def test_the_snakemake_that_would_submit_again_is_ended_too(folder, monkeypatch, kind, end):
    monkeypatch.setattr(elsewhere, "_POLITE", 0.2)
    command = [sys.executable, "-c", HOLDER, folder, kind]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as holder:
        assert holder.stdout.readline() == "held\n"
        assert [job.id for job in elsewhere.cancel(folder)] == ["7", "8"]
        assert holder.wait(5) == -end


def test_a_snakemake_on_another_machine_is_left_alone(folder):
    with (folder / ".snakemake/running").open("w") as running:
        fcntl.flock(running, fcntl.LOCK_EX)
        print("login2", os.getpid(), file=running, flush=True)
        with pytest.raises(InputError, match=r"^Snakemake runs in .* on 'login2'; cancel it there$"):
            elsewhere.cancel(folder)
    assert socket.gethostname() != "login2"
    assert len(elsewhere.jobs(folder)) == 2
