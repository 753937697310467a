"""Parts of a stopped motion that were deleted, swapped, cut, edited or replaced before it goes on."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import netCDF4
import numpy as np

import cosserat
from cosserat.problems.motion import RodMotion

from .damage import damage
from .processes import (
    call,
    copied,
    expect_bytes,
    expect_names,
    expect_sentence,
    expect_success,
    run_words,
    start,
    stopped_motion,
    store,
    undisturbed,
    wait_for_parts,
)
from .table import Trial, expect, fault

KIND = "parts"
NEVER = "Refused in one sentence that names it, exit 2, or computed anew to the same bytes; never another result"
Change = Callable[[list[Path], np.random.Generator], None]


def _delete(parts: list[Path], rng: np.random.Generator) -> None:
    rng.choice(parts).unlink()


def _delete_first(parts: list[Path], rng: np.random.Generator) -> None:
    parts[0].unlink()


def _truncate(parts: list[Path], rng: np.random.Generator) -> None:
    path = rng.choice(parts)
    os.truncate(path, int(rng.integers(1, path.stat().st_size)))


def _empty(parts: list[Path], rng: np.random.Generator) -> None:
    os.truncate(rng.choice(parts), 0)


def _swap(parts: list[Path], rng: np.random.Generator) -> None:
    one, other = rng.choice(parts, 2, replace=False)
    kept = one.read_bytes()
    one.write_bytes(other.read_bytes())
    other.write_bytes(kept)


def _repeat(parts: list[Path], rng: np.random.Generator) -> None:
    one, other = rng.choice(parts, 2, replace=False)
    shutil.copy(one, other)


def _one_too_many(parts: list[Path], rng: np.random.Generator) -> None:
    shutil.copy(parts[-1], parts[-1].with_name(f"{len(parts):05d}.nc"))


def _folder(parts: list[Path], rng: np.random.Generator) -> None:
    path = rng.choice(parts)
    path.unlink()
    path.mkdir()


def _edit(parts: list[Path], rng: np.random.Generator, value: float = 0.0) -> None:
    """One value of the state at the end of the last part, from which the run goes on."""
    with netCDF4.Dataset(parts[-1], "a") as opened:
        x = opened["x_rate"]
        x[-1, int(rng.integers(x.shape[1])), 0] = value


def _edit_within(parts: list[Path], rng: np.random.Generator) -> None:
    with netCDF4.Dataset(rng.choice(parts), "a") as opened:
        opened["x"][5, 3, 1] = 1.5 * opened["x"][5, 3, 1] + 1e-6


def _save_again(parts: list[Path], rng: np.random.Generator) -> None:
    """A changed velocity at the end of the last part, saved as a user saves a Dataset, with a digest that holds."""
    part = cosserat.load(parts[-1])
    part["x_rate"][-1, int(rng.integers(part.sizes["vertex"])), 0] = 0.1
    cosserat.save(part, parts[-1])


def _not_a_number(parts: list[Path], rng: np.random.Generator) -> None:
    _edit(parts, rng, np.nan)


def _edit_steps(parts: list[Path], rng: np.random.Generator) -> None:
    with netCDF4.Dataset(rng.choice(parts), "a") as opened:
        opened.solver = opened.solver.replace('"steps": 400', '"steps": 399')


def _other_case(parts: list[Path], rng: np.random.Generator) -> None:
    """Parts of a case that differs in one number, under the same name of the result."""
    other = store() / "other_case"
    if not other.is_dir():
        other.mkdir()
        text = '[motion]\nlike = "vibration_consistent"\nduration = "0.25 s"\nevery = "1 ms"\nrod.length = "{} m"\n'
        length = 1.001 * _length()
        (other / "other.toml").write_text(text.format(length))
        running = start(other, "run", "motion", "--file", "other.toml", "-o", "motion.nc")
        wait_for_parts(running, other / "motion.nc.parts", 3)
        running.kill()
        running.communicate()
    number = int(rng.integers(len(parts)))
    shutil.copy(other / "motion.nc.parts" / parts[number].name, parts[number])


def _length() -> float:
    problem = cosserat.case("vibration_consistent").problem_as(RodMotion)
    return problem.rod.length


def _bits(parts: list[Path], rng: np.random.Generator) -> None:
    damage(rng.choice(parts), rng)


def _whole_result(parts: list[Path], rng: np.random.Generator) -> None:
    shutil.copy(undisturbed("motion").path, rng.choice(parts))


CHANGES: tuple[Change, ...] = (
    _delete,
    _delete_first,
    _truncate,
    _empty,
    _swap,
    _repeat,
    _one_too_many,
    _folder,
    _edit,
    _edit_within,
    _save_again,
    _not_a_number,
    _edit_steps,
    _other_case,
    _whole_result,
    _bits,
)


def _enter(change: Change, count: int) -> None:
    words = change.__name__.strip("_").replace("_", " ")

    @fault(KIND, PHRASES.get(words, words), f"{NEVER}.", count)
    def attempt(trial: Trial) -> Iterator[None]:
        copied(stopped_motion(), trial.folder)
        folder = trial.folder / "motion.nc.parts"
        change(sorted(folder.glob("[0-9]*.nc")), trial.rng)
        done = call(trial.folder, *run_words("motion", "motion.nc"))
        if done.code == 0:
            expect_success(done)
            expect_bytes(trial.folder / "motion.nc", undisturbed("motion").bytes)
        else:
            expect_sentence(done, 2, naming=["motion.nc.parts"])
            expect(not (trial.folder / "motion.nc").exists(), "refused, and a result")
        yield


PHRASES = {
    "delete": "one is deleted",
    "delete first": "the first is deleted",
    "truncate": "one is cut short",
    "empty": "one is empty",
    "swap": "two are swapped",
    "repeat": "one is copied over another",
    "one too many": "the last is repeated under the next number",
    "folder": "one is a folder",
    "edit": "a velocity of the last is edited",
    "edit within": "a place within one is edited",
    "save again": "the last is changed and saved by the package itself",
    "not a number": "a velocity of the last is no number",
    "edit steps": "the count of steps of one is edited",
    "other case": "one is of a case that differs in one number",
    "whole result": "one is the whole result",
    "bits": "one has damaged bits, bytes or blocks",
}
for _change in CHANGES:
    _enter(_change, 12 if _change is _bits else 2)


@fault(KIND, "their times are in the future or in the past", "The run goes on to the same bytes.", 4)
def _clock(trial: Trial) -> Iterator[None]:
    """Also of a result that is already there, and of the case file."""
    copied(stopped_motion(), trial.folder)
    if trial.number % 2:
        shutil.copy(undisturbed("statics").path, trial.folder / "motion.nc")
    years = 40 if trial.number < 2 else -40
    for path in trial.folder.rglob("*"):
        moment = max(0.0, time.time() + years * 365 * 86400)
        os.utime(path, (moment, moment))
    expect_success(call(trial.folder, *run_words("motion", "motion.nc")))
    expect_bytes(trial.folder / "motion.nc", undisturbed("motion").bytes)
    expect_names(trial.folder, "motion.nc")
    yield
