"""`python -m tests.studies.kills`: a study killed at random moments, finished by the same command to the same bytes."""

import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

STUDY = """
[many]
kind = "study"
of = "elastica"
keep.tip = "u.E2 at last"
keep_whole = ["x"]
[[many.vary]]
sobol = {count}
rod.material.young = {{ log_uniform = ["1 GPa", "9 GPa"] }}
[[many.vary]]
forces.0.force = ["1 N", "1 MN", "4 N"]
"""
COMMAND = [
    sys.executable,
    "-m",
    "cosserat",
    "study",
    "many",
    "--file",
    "many.toml",
    "--cores",
    "2",
    "--batch",
]


def run(folder, batch, after=None, *, whole_group=True):
    """Run the study; kill it with SIGKILL after some seconds; returns its status."""
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])}
    process = subprocess.Popen(
        [*COMMAND, str(batch)],
        cwd=folder,
        start_new_session=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=environment,
    )
    if after is None:
        return process.wait()
    time.sleep(after)
    if whole_group:
        os.killpg(process.pid, signal.SIGKILL)
    else:  # the jobs of Snakemake go on without it
        process.kill()
    return process.wait()


def prepared(folder, count):
    folder.mkdir()
    (folder / "many.toml").write_text(STUDY.format(count=count))
    return folder


def main(kills=10, count=64, batch=16, seed=1):
    """Print what was done; returns 0 if every answer has the bytes of the undisturbed one."""
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory() as name:
        home = Path(name)
        begun = time.monotonic()
        whole = prepared(home / "whole", count)
        status = run(whole, 3 * count)
        lasted = time.monotonic() - begun
        expected = (whole / "many.nc").read_bytes()
        print(f"undisturbed, one batch: status {status}, {lasted:.1f} s", flush=True)
        same = 0
        for number in range(kills):
            folder = prepared(home / f"killed{number}", count)
            after = [chance.uniform(0.5, 2 * lasted) for _ in range(2)]
            for seconds in after:
                run(folder, batch, seconds, whole_group=number % 2 == 0)
            status = run(folder, batch)
            alike = status == 1 and (folder / "many.nc").read_bytes() == expected
            left = [path.name for path in folder.rglob("*.part")]
            same += alike and not left
            print(
                f"killed after {after[0]:.1f} s and {after[1]:.1f} s: status {status}, same bytes: {alike}",
                flush=True,
            )
            shutil.rmtree(folder, ignore_errors=True)
    print(f"{same} of {kills} finished to the same bytes")
    return 0 if same == kills else 1


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
