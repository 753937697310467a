"""Disks that are full, read-only or gone."""

from __future__ import annotations

import contextlib
import os
import re
import resource
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from .processes import (
    Done,
    amounts,
    call,
    copied,
    end,
    expect_bytes,
    expect_names,
    expect_sentence,
    expect_success,
    expect_whole_files,
    run_words,
    start,
    stopped_motion,
    undisturbed,
    wait_for_parts,
)
from .table import CannotBeTriedError, Trial, expect, fault

KIND = "disk"
SIZES = ("64k", "200k", "400k", "1m", "2m", "4m")
CASES = (
    "motion",
    "statics",
    "path",
    "modes",
    "critical",
    "crawl",
    "posture",
    "calibration",
    "errors",
)
FULL = (
    "One sentence with path, need and free space, exit 2; nothing invalid is left; where there is space, the "
    "same bytes"
)


@contextlib.contextmanager
def small_disk(folder: Path, size: str) -> Iterator[Path]:
    """A file system of that size.

    Raises
    ------
    CannotBeTriedError : this user may not mount any.
    """
    place = folder / "disk"
    place.mkdir()
    words = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", place]
    try:
        done = subprocess.run(words, capture_output=True, check=False)
    except OSError:
        raise CannotBeTriedError("there is no 'mount' here") from None
    if done.returncode:
        raise CannotBeTriedError("a small disk needs the rights of root")
    try:
        yield place
    finally:
        subprocess.run(["umount", "-l", place], check=True)


def expect_full(done: Done, name: str) -> None:
    """One sentence about a full disk: the file or its folder, and two amounts of bytes."""
    expect_sentence(done, 2)
    expect(name in done.err or " free in " in done.err, f"neither file nor folder is named: {done.told}")
    expect(len(amounts(done.err)) >= 2, f"need and free space are not named: {done.told}")


@fault(
    KIND,
    "full, while a case of each kind is run",
    f"{FULL}; a motion keeps its parts.",
    len(SIZES) * len(CASES),
)
def _full_run(trial: Trial) -> Iterator[None]:
    size, case = SIZES[trial.number % len(SIZES)], CASES[trial.number // len(SIZES) % len(CASES)]
    result, usual = f"{case}.nc", undisturbed(case)
    with small_disk(trial.folder, size) as disk:
        done = call(disk, *run_words(case, result))
        expect_whole_files(disk)
        if done.code == 0:
            expect_bytes(disk / result, usual.bytes)
            expect_names(disk, result)
            yield
            return
        expect_full(done, result)
        expect(not (disk / result).exists(), "exit 2, and a result")
        hidden = [path.name for path in disk.rglob(".*")]
        expect(not hidden, f"left on the disk: {' '.join(hidden)}")
        larger = trial.folder / "larger"
        copied(disk, larger)
    expect_success(call(larger, *run_words(case, result)))
    expect_bytes(larger / result, usual.bytes)
    expect_names(larger, result)
    yield


@fault(
    KIND,
    "filled by others while a motion is run",
    f"{FULL}; the parts are kept, and the same command goes on from them.",
    3,
)
def _filled(trial: Trial) -> Iterator[None]:
    with small_disk(trial.folder, "16m") as disk:
        running = start(disk, *run_words("motion", "motion.nc"))
        wait_for_parts(running, disk / "motion.nc.parts", 1 + trial.number)
        filler = disk / "of_others"
        filler.write_bytes(b"-" * max(0, _free(disk) - 4096))
        done = end(running)
        if done.code == 0:
            return  # it had ended before
        expect_full(done, "motion.nc")
        filler.unlink()
        kept = len(list((disk / "motion.nc.parts").glob("[0-9]*.nc")))
        expect(kept > trial.number, f"{kept} parts are kept")
        expect_whole_files(disk)
        expect_success(call(disk, *run_words("motion", "motion.nc")))
        expect_bytes(disk / "motion.nc", undisturbed("motion").bytes)
        expect_names(disk, "motion.nc")
        yield


WRITERS = (
    ("plot", "motion", "motion.svg"),
    ("plot", "crawl", "crawl.png"),
    ("export", "motion", "motion.csv"),
    ("export", "path", "path.pvd"),
    ("export", "statics", "statics.vtu"),
    ("plot --frames 20 --animate", "path", "path.gif"),
    ("plot --frames 20 --animate", "path", "path.html"),
    ("figure", "bent_rod", "fig_3_1.svg"),
)


@fault(
    KIND,
    "full, while a picture, a table or a mesh is written",
    f"{FULL}.",
    len(WRITERS) * 3,
)
def _full_written(trial: Trial) -> Iterator[None]:
    size, chosen = SIZES[trial.number // len(WRITERS)], WRITERS[trial.number % len(WRITERS)]
    verb, case, name = chosen
    result = undisturbed(case).path
    words = [*verb.split(), name, result] if "--animate" in verb else [verb, result, "-o", name]
    if verb == "figure":
        words = [verb, Path(name).stem, "--cases", result.parent, "-o", name]
    with small_disk(trial.folder, size) as disk:
        (disk / "filled").write_bytes(b"-" * (_free(disk) - 8192))  # any output is larger
        done = call(disk, *words)
        expect_whole_files(disk)
        if done.code == 0 and name.endswith((".png", ".gif")):
            yield  # a small picture
            return
        expect_full(done, Path(name).stem)
        expect_names(disk, "filled")
        yield


def _free(disk: Path) -> int:
    told = os.statvfs(disk)
    return told.f_bavail * told.f_frsize


@fault(
    KIND,
    "no file may be longer than a limit",
    "One sentence with the path, exit 2; nothing invalid is left; without the limit, the same bytes.",
    6,
)
def _limited_files(trial: Trial) -> Iterator[None]:
    case, limit = ("motion", "statics", "crawl")[trial.number % 3], int(trial.rng.integers(1, 60)) * 1024

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    done = call(trial.folder, *run_words(case, "x.nc"), before=limited)
    expect_sentence(done, 2, naming=["x.nc"])
    expect_whole_files(trial.folder)
    expect_success(call(trial.folder, *run_words(case, "x.nc")))
    expect_bytes(trial.folder / "x.nc", undisturbed(case).bytes)
    expect_names(trial.folder, "x.nc")
    yield


@fault(
    KIND,
    "read-only from the beginning",
    "One sentence with the path, exit 2, before anything is computed.",
    6,
)
def _read_only(trial: Trial) -> Iterator[None]:
    with small_disk(trial.folder, "8m") as disk:
        copied(stopped_motion(), disk) if trial.number % 2 else None
        _until(lambda: _remounted(disk, "ro"))
        verb = ("run", "plot", "export")[trial.number // 2]
        words: tuple[object, ...] = run_words("motion", disk / "motion.nc")
        if verb != "run":
            words = (
                verb,
                undisturbed("statics").path,
                "-o",
                disk / f"x.{'svg' if verb == 'plot' else 'csv'}",
            )
        done = call(trial.folder, *words)
        expect_sentence(done, 2, naming=[disk])
        yield


@fault(
    KIND,
    "a folder without the right to write",
    "One sentence with the path, exit 2, before anything is computed.",
    2,
)
def _no_right(trial: Trial) -> Iterator[None]:
    """That of the result, or that of the parts which are already there."""
    copied(stopped_motion(), trial.folder)
    closed = trial.folder / "motion.nc.parts" if trial.number else trial.folder
    closed.chmod(0o555)
    done = end(start(trial.folder, *run_words("motion", "motion.nc"), prefix=_without_all_rights()))
    closed.chmod(0o755)
    expect_sentence(done, 2)
    expect(re.search("cannot be written|permission", done.err, re.IGNORECASE), done.told)
    expect_success(call(trial.folder, *run_words("motion", "motion.nc")))
    expect_bytes(trial.folder / "motion.nc", undisturbed("motion").bytes)
    yield


@fault(
    KIND,
    "the right to write is taken away while a motion is run",
    "One sentence with the path, exit 2; when it is given back, the same command goes on to the same bytes.",
    3,
)
def _right_taken_away(trial: Trial) -> Iterator[None]:
    folder = trial.folder / "motion.nc.parts"
    running = start(trial.folder, *run_words("motion", "motion.nc"), prefix=_without_all_rights())
    wait_for_parts(running, folder, 1 + trial.number)
    closed = [place for place in (folder, trial.folder) if place.is_dir()]
    for place in closed:
        place.chmod(0o555)
    done = end(running)
    for place in reversed(closed):
        place.chmod(0o755)
    expect_sentence(done, 2, naming=["motion.nc"])
    expect_whole_files(trial.folder)
    expect_success(call(trial.folder, *run_words("motion", "motion.nc")))
    expect_bytes(trial.folder / "motion.nc", undisturbed("motion").bytes)
    expect_names(trial.folder, "motion.nc")
    yield


def _without_all_rights() -> tuple[str, ...]:
    """The program that starts a process of root which may write only where others of its rights may."""
    if os.getuid() != 0:
        return ()
    if shutil.which("setpriv") is None:
        raise CannotBeTriedError("root writes anywhere without 'setpriv'")
    return ("setpriv", "--bounding-set=-dac_override,-dac_read_search")


def _remounted(disk: Path, how: str) -> bool:
    done = subprocess.run(["mount", "-o", f"remount,{how}", disk], capture_output=True, check=False)
    return done.returncode == 0


def _until(done: Callable[[], bool], seconds: float = 5.0) -> None:
    """Repeat what is refused while a file is open."""
    until = time.monotonic() + seconds
    while not done() and time.monotonic() < until:
        time.sleep(0.002)


@fault(
    KIND,
    "the folder vanishes while a motion is run",
    "One sentence with the path, exit 2; when it is back, the same command goes on to the same bytes.",
    4,
)
def _vanishes(trial: Trial) -> Iterator[None]:
    """The folder of the result, or that of its parts."""
    folder = trial.folder / "results"
    folder.mkdir()
    gone = folder if trial.number % 2 else folder / "motion.nc.parts"
    running = start(trial.folder, *run_words("motion", folder / "motion.nc"))
    wait_for_parts(running, folder / "motion.nc.parts", 1 + trial.number)
    gone.rename(trial.folder / "elsewhere")
    done = end(running)
    if done.code == 0:  # it had only to write the result, or made the folder again
        expect_success(done)
        expect_bytes(folder / "motion.nc", undisturbed("motion").bytes)
        yield
        return
    expect_sentence(done, 2, naming=["motion.nc"])
    expect_whole_files(trial.folder)
    if not gone.exists():
        (trial.folder / "elsewhere").rename(gone)
    expect_success(call(trial.folder, *run_words("motion", folder / "motion.nc")))
    expect_bytes(folder / "motion.nc", undisturbed("motion").bytes)
    yield


@fault(
    KIND,
    "standard output is full",
    "One sentence, exit 2; a result is whole.",
    3,
)
def _full_output(trial: Trial) -> Iterator[None]:
    words = (("cases",), ("show", undisturbed("motion").path), run_words("statics", "statics.nc"))[
        trial.number
    ]
    with Path("/dev/full").open("wb") as full:
        done = end(start(trial.folder, *words, stdout=full))
    expect_sentence(done, 2)
    expect_whole_files(trial.folder)
    yield
