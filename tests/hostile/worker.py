"""A process that runs commands in its own interpreter, one after another, and is ended when one does not end."""

from __future__ import annotations

import contextlib
import ctypes
import functools
import hashlib
import io
import multiprocessing
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, TextIO

from .judge import LIMIT, Input, Outcome

MEMORY = 4 << 30
"""Most memory of a worker, in bytes; beyond it, allocation fails as on a full machine."""
_FILE = 200 << 20
_BLOCKED = 6
_WITH_PARENT = 1  # of <sys/prctl.h>: the signal when the parent ends
_START = 90.0  # seconds for the imports of a new worker on a busy machine


def _cpu(process: int) -> float:
    """Seconds of CPU of a process and of the programs that it started and that have ended."""
    with contextlib.suppress(OSError):
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
        return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")
    return 0.0


class Worker:
    """Calls functions in a child process; a child that hangs or dies is replaced."""

    def __init__(self) -> None:
        self._folder = Path(tempfile.mkdtemp(prefix="hostile-"))
        self._child: Any = None
        self._pipe: Any = None

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, *_: object) -> None:
        self._end()
        shutil.rmtree(self._folder, ignore_errors=True)

    def run(self, given: Input) -> Outcome:
        """How a command ends."""
        return self.call(run_here, given, limit=LIMIT * (4 if given.alone else 1))

    def call(self, function: Callable[..., Outcome], *words: Any, limit: float = LIMIT) -> Outcome:
        """The answer of a function of a module; an `Outcome` that says so if there is none."""
        self._start()
        try:
            self._pipe.send((function, words))
            if not self._answers(limit):
                said = self._said()
                self._end()
                return Outcome(raised="no end", where="no end", err=said)
            answer: Outcome = self._pipe.recv()
            return answer
        except (EOFError, ConnectionError):
            self._child.join()
            code = self._child.exitcode
            self._end()
            return Outcome(raised=f"the process ended with {code}", where="no worker")

    def _answers(self, limit: float) -> bool:
        """Whether an answer comes within the limit of CPU time, or six times the limit on a clock."""
        clock, spent = time.monotonic(), _cpu(self._child.pid)
        while not self._pipe.poll(0.5):
            late = time.monotonic() - clock > _BLOCKED * limit
            if late or _cpu(self._child.pid) - spent > limit:
                return False
        return True

    def _said(self) -> str:
        with contextlib.suppress(OSError):
            return (self._folder / "stderr").read_text(errors="replace")
        return ""

    def _start(self) -> None:
        if self._child is not None and self._child.is_alive():
            return
        own, its = multiprocessing.Pipe()
        spawn = multiprocessing.get_context("spawn")
        self._child = spawn.Process(target=_serve, args=(its, self._folder), daemon=True)
        self._child.start()
        its.close()
        self._pipe = own
        if not own.poll(_START) or own.recv() != "ready":
            raise RuntimeError("a worker did not start")

    def _end(self) -> None:
        if self._child is not None:
            with contextlib.suppress(OSError):
                os.killpg(self._child.pid, signal.SIGKILL)  # with the programs that it started
            self._child.join()
            self._pipe.close()
            self._child = None
        for left in self._folder.iterdir():
            shutil.rmtree(left, ignore_errors=True) if left.is_dir() else left.unlink()


def _serve(pipe: Connection, folder: Path) -> None:
    """The child: answers calls until the pipe closes."""
    with contextlib.suppress(AttributeError):  # only Linux ends a child with its parent
        ctypes.CDLL(None).prctl(_WITH_PARENT, signal.SIGKILL)
    os.setsid()
    os.chdir(folder)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_FSIZE, (_FILE, _FILE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    for ignored in (DeprecationWarning, PendingDeprecationWarning, ImportWarning, ResourceWarning):
        warnings.simplefilter("ignore", ignored)
    for shown in (RuntimeWarning, UserWarning, FutureWarning, SyntaxWarning, UnicodeWarning):
        warnings.simplefilter("always", shown)  # so that the second leak of a place is seen too
    import cosserat.runner  # noqa: F401
    from cosserat import cli

    cli.parser_of_commands = functools.cache(
        cli.parser_of_commands
    )  # more than half of the time of a refusal
    pipe.send("ready")
    while True:
        try:
            function, words = pipe.recv()
        except EOFError:
            return
        pipe.send(function(*words))


def run_here(given: Input) -> Outcome:
    """Run one command in this process, in an empty folder."""
    if given.alone or given.shell:
        return run_alone(given)
    place, err = Path.cwd(), Path.cwd() / "stderr"
    folder = Path(tempfile.mkdtemp(dir=place))
    written(given, folder)
    os.chdir(folder)
    try:
        for words in given.before:
            with _redirected(b"", place / "stdout", err):
                _call(words)
        before = contents(folder)
        start = time.process_time()
        with _redirected(given.stdin, place / "stdout", err):
            code, raised, where = _call(given.arguments)
        spent = time.process_time() - start
        wrong = _not_finite(folder, before) if code == 0 else ()
        after = contents(folder)
    finally:
        os.chdir(place)
        shutil.rmtree(folder, ignore_errors=True)
    out = (place / "stdout").read_text(errors="replace")
    return Outcome(
        code,
        out,
        err.read_text(errors="replace"),
        spent,
        raised,
        where,
        *_compared(before, after),
        wrong,
    )


def read_here(content: bytes, name: str, json: bool) -> Outcome:
    """Read one case, study or fit of a file, or a case as JSON."""
    from cosserat.cases.catalogue import parse
    from cosserat.errors import CosseratWarning, InputError

    file = Path("c.toml")
    file.write_bytes(content)
    code, said, raised, place = 0, "", "", ""
    start = time.process_time()
    with warnings.catch_warnings(record=True) as leaked:
        try:
            parse(content.decode()) if json else _read(name, file)
        except InputError as error:
            code, said = 2, f"cosserat: {error}\n"
        except BaseException as error:
            raised, place = traceback.format_exc(limit=-30), where(error)
    foreign = [found for found in leaked if not issubclass(found.category, CosseratWarning)]
    shown = "".join(f"{found.category.__name__}: {found.message}\n" for found in foreign)
    return Outcome(code, "", shown + said, time.process_time() - start, raised, place)


def _read(name: str, file: Path) -> None:
    from cosserat.cases.catalogue import find, find_base, fit_tables, study_tables
    from cosserat.studies.analysis.fitting import Fit
    from cosserat.studies.door import find_study

    if name in study_tables(file):
        find_study(name, file)
    elif name in (fits := fit_tables(file)):
        find_base(Fit.read(fits[name], "fit").of, file)
    else:
        find(name, file)


def run_alone(given: Input) -> Outcome:
    """Run one command as a process of its own, perhaps by a shell that joins it with others."""
    folder = Path(tempfile.mkdtemp(dir=Path.cwd()))
    written(given, folder)
    before = contents(folder)
    command = f"{sys.executable} -m cosserat"
    line = given.shell.replace("cosserat ", f"{command} ")
    words = ["/bin/bash", "-c", line] if line else [*command.split(), *given.arguments]
    path = os.pathsep.join([str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")])
    start = os.times()
    with (Path.cwd() / "stderr").open("wb") as err:
        done = subprocess.run(
            [os.fsencode(word) for word in words],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": path},
            input=given.stdin,
            stdout=subprocess.PIPE,
            stderr=err,
            check=False,
        )
    end = os.times()
    spent = end.children_user - start.children_user - 2.0  # without the start-up
    said = (Path.cwd() / "stderr").read_text(errors="replace")
    after = contents(folder)
    shutil.rmtree(folder, ignore_errors=True)
    out = done.stdout.decode(errors="replace")
    return Outcome(done.returncode, out, said, spent, "", "", *_compared(before, after))


def _call(arguments: tuple[str, ...]) -> tuple[int | None, str, str]:
    """Exit code, traceback, and its exception and place."""
    from cosserat.cli import main

    try:
        return main(list(arguments)), "", ""
    except SystemExit as left:
        code = left.code
        return (code if isinstance(code, int) else 0 if code is None else 1), "", ""
    except BaseException as error:
        return None, traceback.format_exc(limit=-30), where(error)
    finally:
        with contextlib.suppress(Exception):
            sys.stdout.flush()


def where(error: BaseException) -> str:
    """An exception and the last line of the package that it passed."""
    frames = traceback.extract_tb(error.__traceback__)
    ours = [f for f in frames if "/cosserat/" in f.filename and "site-packages" not in f.filename]
    place = f"{Path(ours[-1].filename).name}:{ours[-1].lineno} {ours[-1].name}" if ours else "?"
    return f"{type(error).__name__} in {place}"


def written(given: Input, folder: Path) -> None:
    """Write the files and links of an input."""
    for name, content in given.files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    for name, target in given.links.items():
        (folder / name).symlink_to(target)


def contents(folder: Path) -> dict[str, str]:
    """The digest of each file in a folder by its name; links and devices by what they are."""
    found = {}
    for root, folders, files in os.walk(os.fsencode(folder)):
        for name in [*files, *folders]:
            path = os.path.join(root, name)
            shown = os.fsdecode(os.path.relpath(path, os.fsencode(folder)))
            if os.path.islink(path):
                found[shown] = f"link to {os.fsdecode(os.readlink(path))}"
            elif os.path.isfile(path):
                found[shown] = hashlib.sha256(Path(os.fsdecode(path)).read_bytes()).hexdigest()
    return found


def _compared(before: dict[str, str], after: dict[str, str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    added = tuple(sorted(set(after) - set(before)))
    changed = tuple(sorted(name for name in before if after.get(name) != before[name]))
    return added, changed


def _not_finite(folder: Path, before: dict[str, str]) -> tuple[str, ...]:
    """Faults of the results that a command wrote."""
    import netCDF4
    import numpy as np

    found = []
    for path in sorted(folder.glob("*.nc")):
        if path.name in before or path.is_symlink():
            continue
        with netCDF4.Dataset(path) as data:
            data.set_auto_mask(False)
            for name, variable in data.variables.items():
                if variable.dtype != str and not np.isfinite(variable[...]).all():
                    found.append(f"not finite: {name}")
    return tuple(found)


@contextlib.contextmanager
def _redirected(stdin: bytes, out: Path, err: Path) -> Iterator[None]:
    """Files in the place of the standard streams, those of the system and those of Python."""
    saved, usual = [os.dup(n) for n in range(3)], (sys.stdin, sys.stdout, sys.stderr)
    with tempfile.TemporaryFile() as source, out.open("wb") as to_out, err.open("wb") as to_err:
        source.write(stdin)
        source.seek(0)
        for n, stream in enumerate((source, to_out, to_err)):
            os.dup2(stream.fileno(), n)
        sys.stdin, sys.stdout = _text(0, "r", "strict"), _text(1, "w", "strict")
        sys.stderr = _text(2, "w", "backslashreplace")
        try:
            yield
        finally:
            for stream in (sys.stdout, sys.stderr):
                with contextlib.suppress(Exception):
                    stream.flush()
            sys.stdin, sys.stdout, sys.stderr = usual
            for n, kept in enumerate(saved):
                os.dup2(kept, n)
                os.close(kept)


def _text(stream: int, mode: str, errors: str) -> TextIO:
    return io.TextIOWrapper(
        io.FileIO(stream, mode, closefd=False), "utf-8", errors, write_through=mode == "w"
    )
