"""A long run killed at random moments: every file is complete, and the run continues to the same bytes."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from conftest import ROOT

import cosserat

LONG = """
[long]
like = "vibration_c4_20"
duration = "0.4 s"
every = "1 ms"
"""


def start(folder, name):
    return subprocess.Popen(
        [sys.executable, "-m", "cosserat", "run", "long", "--file", "long.toml", "-o", name],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def wait_for(running, folder, parts):
    """Until so many parts are stored, or the run has ended: by what it has done, however busy the machine is."""
    while running.poll() is None and len(list(folder.glob("*.nc"))) < parts:
        time.sleep(0.002)


@pytest.mark.workflow
def test_six_kills_leave_whole_files_and_the_same_bytes(tmp_path):
    (tmp_path / "long.toml").write_text(LONG)
    whole = start(tmp_path, "whole.nc")
    _, errors = whole.communicate()
    assert whole.returncode == 0, errors
    rng = np.random.default_rng(2026)
    folder = tmp_path / "cut.nc.parts"
    most = 0
    for _ in range(6):
        running = start(tmp_path, "cut.nc")
        begun = len(list(folder.glob("*.nc")))
        wait_for(running, folder, begun + int(rng.integers(0, 3)))
        time.sleep(float(rng.uniform(0, 0.1)))  # anywhere in the next part
        running.send_signal(signal.SIGKILL)
        running.communicate()
        assert running.returncode == -signal.SIGKILL or (tmp_path / "cut.nc").exists()
        whole_parts = sorted(folder.glob("*.nc"))
        for part in whole_parts:  # hidden names are what was being written when the kill came
            assert np.isfinite(cosserat.load(part).x).all()
        most = max(most, len(whole_parts))
        if (tmp_path / "cut.nc").exists():  # it got to its end: begin anew, to be killed again
            assert (tmp_path / "cut.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes()
            (tmp_path / "cut.nc").unlink()
    assert most > 0
    last = start(tmp_path, "cut.nc")
    _, errors = last.communicate()
    assert last.returncode == 0, errors
    assert (tmp_path / "cut.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["cut.nc", "long.toml", "whole.nc"]


@pytest.mark.workflow
def test_ctrl_c_says_how_to_continue(tmp_path):
    (tmp_path / "long.toml").write_text(LONG.replace("0.4 s", "4 s"))
    running = start(tmp_path, "cut.nc")
    while running.poll() is None and not (tmp_path / "cut.nc.parts").exists():
        time.sleep(0.05)
    running.send_signal(signal.SIGINT)
    _, errors = running.communicate()
    assert running.returncode in (130, -signal.SIGINT)  # Python itself may choose the latter
    assert "interrupted; run the same command again to resume from cut.nc.parts" in errors
    assert errors.count("\n") == 1
