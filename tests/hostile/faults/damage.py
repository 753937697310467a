"""Results whose bits, bytes or blocks are damaged, read by the command line and by `cosserat.load`."""

from __future__ import annotations

import functools
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import netCDF4
import numpy as np

import cosserat
from cosserat.data.content import stamped

from .processes import ROOT, call, end, environment, expect_sentence, expect_success, start, undisturbed
from .table import Trial, expect, fault

KIND = "damaged file"
RESULTS = (
    "statics",
    "motion",
    "path",
    "modes",
    "critical",
    "crawl",
    "posture",
    "calibration",
    "mass",
)
REFUSED_OR_SAME = (
    "Refused in one sentence that names the file, or read with the same content or a warning, "
    "within ten seconds"
)
HANGS = 30.0
"""Seconds until a process of the command line counts as hung, on a busy machine too."""


def damage(path: Path, rng: np.random.Generator) -> str:
    """Damage a file at random, and say how."""
    data = bytearray(path.read_bytes())
    at, kind = int(rng.integers(len(data))), int(rng.integers(8))
    size = int(rng.choice((16, 512, 4096)))
    if kind <= 1:
        for _ in range(int(rng.integers(1, 4))):
            data[int(rng.integers(len(data)))] ^= 1 << int(rng.integers(8))
        what = "bits flipped"
    elif kind == 2:
        data[at] ^= int(rng.integers(1, 256))
        what = f"byte {at} changed"
    elif kind == 3:
        data[at : at + size] = bytes(len(data[at : at + size]))
        what = f"{size} bytes zeroed at {at}"
    elif kind == 4:
        data[at : at + size] = rng.bytes(len(data[at : at + size]))
        what = f"{size} random bytes at {at}"
    elif kind == 5:
        del data[at:]
        what = f"cut to {at} bytes"
    elif kind == 6:
        del data[at : at + size]
        what = f"{size} bytes taken out at {at}"
    else:
        data += rng.bytes(size)
        what = f"{size} bytes appended"
    path.write_bytes(data)
    return what


@fault(KIND, "shown", f"{REFUSED_OR_SAME}.", 40)
def _shown(trial: Trial) -> Iterator[None]:
    case = RESULTS[trial.number % len(RESULTS)]
    path = trial.folder / f"{case}.nc"
    path.write_bytes(undisturbed(case).bytes)
    what = damage(path, trial.rng)
    done = end(start(trial.folder, "show", path.name), HANGS)
    if done.code == 0:
        expect_success(done)
        told = "another program" in done.err
        expect(told or done.out == _show(case), f"{what}: shown with other content without a word")
    else:
        expect_sentence(done, 2, naming=[path.name])
    yield


@functools.cache
def _show(case: str) -> str:
    """What is shown of the result without damage."""
    return call(undisturbed(case).path.parent, "show", undisturbed(case).path.name).out


@fault(KIND, "loaded in Python", f"{REFUSED_OR_SAME}.", 40)
def _loaded(trial: Trial) -> Iterator[None]:
    """Twenty-five damaged files of a case, each read in a process of its own."""
    case = RESULTS[trial.number % len(RESULTS)]
    rng, damaged = trial.rng, {}
    for number in range(25):
        path = trial.folder / f"{case}_{number}.nc"
        path.write_bytes(undisturbed(case).bytes)
        damaged[path] = damage(path, rng)
    reader = Path(__file__).with_name("reading.py")
    done = subprocess.run(
        [sys.executable, reader, undisturbed(case).path, *damaged],
        env=environment(),
        capture_output=True,
        text=True,
        check=True,
    )
    for what, found in zip(damaged.values(), done.stdout.splitlines(), strict=True):
        expect(found in ("same", "refused", "said to be changed"), f"{case}, {what}: {found}")
        yield


@fault(
    KIND,
    "a value of a result is edited with another program",
    "Shown with a word that the file is no longer the package's own, or refused by name; never silently.",
    3,
)
def _edited(trial: Trial) -> Iterator[None]:
    path = trial.folder / "statics.nc"
    path.write_bytes(undisturbed("statics").bytes)
    if trial.number == 0:
        with netCDF4.Dataset(path, "a") as opened:
            opened["x"][3, 1] = 0.5
    elif trial.number == 1:
        with netCDF4.Dataset(path, "a") as opened:
            opened.title = "another title"
    else:
        text = "import xarray as xr; d = xr.load_dataset('statics.nc'); d['x'][3, 1] = 0.5; d.to_netcdf('statics.nc')"
        subprocess.run([sys.executable, "-c", text], cwd=trial.folder, check=True)
    done = call(trial.folder, "show", path.name)
    if done.code == 0:
        expect(
            "warning" in done.out + done.err or "no longer" in done.out + done.err, "read without a word"
        )
        expect("Traceback" not in done.err, done.told)
    else:
        expect_sentence(done, 2, naming=[path.name])
    yield


@fault(
    KIND,
    "a value of a released output is edited and all its digests are computed anew",
    "`verify` says that it differs; what measures or draws it says that it is not as released.",
    3,
)
def _forged(trial: Trial) -> Iterator[None]:
    """The file alone cannot tell: the manifest of the release does."""
    cases, reference = trial.folder / "cases", ROOT / "results" / "reference"
    cases.mkdir()
    (trial.folder / "reference").symlink_to(reference)
    path = cases / "clamped_free.nc"
    expect_success(call(trial.folder, "run", "clamped_free", "-o", path))
    result = cosserat.load(path)
    result["u"][7, 1] += 1e-6
    cosserat.save(stamped(result), path)
    words = (
        ("verify", "--results", trial.folder, "--references", reference),
        ("measure", "--cases", cases, "--table", ROOT / "results" / "tolerances.csv", "-o", "x.csv"),
        ("figure", "fig_3_10", "--cases", cases, "-o", "x.svg"),
    )[trial.number]
    done = call(trial.folder, *words)  # other cases are missing there
    said = [line for line in (done.out + done.err).splitlines() if "clamped_free.nc" in line]
    expect(done.code in (1, 2), done.told)
    expect(any("differs" in line or "not as released" in line for line in said), f"no word: {done.told}")
    yield


@fault(
    KIND,
    "a result that its user changed and saved by `cosserat.save`",
    "It can be read, with a word that it is no longer the package's own.",
    1,
)
def _changed(trial: Trial) -> Iterator[None]:
    result = cosserat.load(undisturbed("statics").path)
    result["x"][3, 1] = 0.5
    cosserat.save(result, trial.folder / "mine.nc")
    done = call(trial.folder, "show", "mine.nc")
    expect(done.code == 0 and "Traceback" not in done.err, done.told)
    expect("warning" in done.out + done.err or "no longer" in done.out + done.err, "read without a word")
    expect(float(cosserat.load(trial.folder / "mine.nc")["x"][3, 1]) == 0.5, "another value was read")
    yield
