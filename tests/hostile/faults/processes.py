"""Processes of `python -m cosserat`, and what may be expected of them whatever happens."""

from __future__ import annotations

import contextlib
import csv
import functools
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import warnings
import xml.etree.ElementTree
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import cosserat
from cosserat.errors import CosseratError, CosseratWarning

from .table import expect

ROOT = Path(__file__).parents[3]
CASES = Path(__file__).with_name("cases.toml")
OWN = tomllib.loads(CASES.read_text(encoding="utf-8"))
"""Names of the table's own cases; others are published ones."""
HANGS = 120.0
"""Seconds after which a process counts as hung, on a busy machine too."""
_MARKED = """\
import sys
from cosserat import __main__ as program
minded = program.end_by_signals
def told():
    minded()
    print("begun", flush=True)
program.end_by_signals = told
sys.exit(program.main())
"""
"""`python -m cosserat`, which says on standard output when `main` minds signals, the first thing that it does.

Before that a signal ends any process by itself, without a word; on a busy machine one came between.
"""


@dataclass(frozen=True)
class Done:
    """How a process ended."""

    code: int
    out: str
    err: str

    @property
    def told(self) -> str:
        """The end and the last words, on one line."""
        return f"exit {self.code}, " + (repr(self.err.strip()[-300:]) if self.err.strip() else "no word")


def environment() -> dict[str, str]:
    """The environment of every process: this checkout's package, one thread, no lines of progress."""
    path = os.pathsep.join([str(Path(sys.executable).parent), *os.get_exec_path()])
    return {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "OMP_NUM_THREADS": "1",
        "TQDM_DISABLE": "1",
        "PATH": path,
    }


def start(
    folder: Path,
    *words: object,
    marked: bool = False,
    before: Callable[[], None] | None = None,
    stdout: int | IO[bytes] = subprocess.PIPE,
    prefix: Sequence[str] = (),
) -> subprocess.Popen[str]:
    """A process of `python -m cosserat` in a folder.

    marked : return when `main` begins.  before : what the process does to itself first.  prefix : the program that
        starts it.
    """
    entry = ["-c", _MARKED] if marked else ["-m", "cosserat"]
    running = subprocess.Popen(
        [*prefix, sys.executable, *entry, *map(str, words)],
        cwd=folder,
        env=environment(),
        stdin=subprocess.DEVNULL,
        stdout=stdout,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=before or interruptible,  # noqa: PLW1509 - this process has no other threads
        start_new_session=True,
    )
    if marked and running.stdout is not None:
        running.stdout.readline()
    return running


def interruptible() -> None:
    """Ctrl-C reaches a process also if the shell behind this one ignores it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def end(running: subprocess.Popen[str], seconds: float = HANGS) -> Done:
    """Wait for a process; one that does not end in so many seconds is killed, which is not as promised."""
    try:
        out, err = running.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        os.killpg(running.pid, signal.SIGKILL)
        running.communicate()
        expect(False, f"no end after {seconds:g} s")
    return Done(running.returncode, out or "", err or "")


def call(folder: Path, *words: object, before: Callable[[], None] | None = None) -> Done:
    """Run `python -m cosserat` to its end."""
    return end(start(folder, *words, before=before))


def run_words(case: str, output: object) -> tuple[object, ...]:
    """The words that solve a case of the table into a file."""
    return ("run", case, "--file", CASES, "-o", output) if case in OWN else ("run", case, "-o", output)


@dataclass(frozen=True)
class Undisturbed:
    """A run that nothing happened to: its file, and the seconds from the start of `main` to its end."""

    path: Path
    seconds: float

    @functools.cached_property
    def bytes(self) -> bytes:
        return self.path.read_bytes()


@functools.cache
def store() -> Path:
    """A folder for what all attempts share, until this process ends."""
    return Path(_STORE.enter_context(tempfile.TemporaryDirectory(prefix="faults-")))


_STORE = contextlib.ExitStack()


@functools.cache
def undisturbed(case: str) -> Undisturbed:
    """The result of a case of the table that nothing happened to, made when it is first asked for."""
    path = store() / f"{case}.nc"
    running = start(path.parent, *run_words(case, path.name), marked=True)
    begun = time.monotonic()
    done = end(running)
    expect(done.code == 0, f"without any fault: {done.told}")
    return Undisturbed(path, time.monotonic() - begun)


@functools.cache
def stopped_motion(parts: int = 3) -> Path:
    """A folder with the first parts of the case `motion`, whose run was killed."""
    folder = store() / f"stopped_{parts}"
    folder.mkdir()
    running = start(folder, *run_words("motion", "motion.nc"))
    wait_for_parts(running, folder / "motion.nc.parts", parts)
    running.kill()
    running.communicate()
    expect(not (folder / "motion.nc").exists(), "the run ended before it could be killed")
    return folder


def wait_for_parts(running: subprocess.Popen[str], folder: Path, count: int) -> None:
    """Until so many parts are stored, or the run has ended: by what it has done, however busy the machine is."""
    while running.poll() is None and len(list(folder.glob("[0-9]*.nc"))) < count:
        time.sleep(0.002)


def copied(source: Path, folder: Path) -> Path:
    """The contents of a folder in another one."""
    return shutil.copytree(source, folder, dirs_exist_ok=True, symlinks=True)


def expect_sentence(done: Done, *codes: int, naming: Sequence[object] = ()) -> None:
    """One sentence on standard error that names these, no traceback, and one of these exit codes."""
    expect(done.code in codes, f"{done.told}, not {' or '.join(map(str, codes))}")
    lines = done.err.strip().split("\n")
    expect(
        len(lines) == 1 and lines[0].startswith("cosserat: ") and len(lines[0]) < 1000,
        f"not one sentence: {len(lines)} lines, {done.told}",
    )
    for name in naming:
        expect(str(name) in lines[0], f"the sentence does not name {name}: {done.told}")


def expect_success(done: Done) -> None:
    """Exit 0, and nothing on standard error but warnings about the result."""
    odd = [line for line in done.err.splitlines() if not line.startswith("warning: ")]
    expect(done.code == 0 and not odd, done.told)


def expect_bytes(path: Path, right: bytes) -> None:
    """A file with these bytes."""
    expect(path.is_file(), f"{path.name} was not written")
    expect(path.read_bytes() == right, f"{path.name} has other bytes than that of an undisturbed run")


def expect_names(folder: Path, *names: str) -> None:
    """These files and folders and no others, at any depth."""
    found = sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))
    expect(
        found == sorted(names),
        f"left in the folder: {' '.join(found) or 'nothing'}, not {' '.join(names)}",
    )


def expect_whole_files(folder: Path) -> None:
    """Every file with the name of a result, a picture or a table is whole."""
    for path in sorted(folder.rglob("*")):
        if path.is_file() and not path.name.startswith("."):
            try:
                _READERS.get(path.suffix, Path.read_bytes)(path)
            except (
                CosseratError,
                CosseratWarning,
                xml.etree.ElementTree.ParseError,
                ValueError,
                SyntaxError,
            ) as error:
                expect(False, f"{path.relative_to(folder)} is not whole: {error}")


def _load(path: Path) -> None:
    """Read a result that cosserat itself wrote to its end; of any other there is a warning."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cosserat.load(path)


def _read_table(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    lengths = {len(line) for line in csv.reader(text.splitlines())}
    if len(lengths) != 1 or not text.endswith("\n"):
        raise ValueError("its last line is cut")


_READERS: dict[str, Callable[[Path], object]] = {
    ".nc": _load,
    ".svg": xml.etree.ElementTree.parse,
    ".vtu": xml.etree.ElementTree.parse,
    ".pvd": xml.etree.ElementTree.parse,
    ".csv": _read_table,
}


def amounts(text: str) -> list[str]:
    """Amounts of bytes in a sentence, such as "1.7 MB"."""
    return re.findall(r"\d[\d.,]*\s?(?:[kKMGT]i?B|bytes)\b", text)
