"""Names, links, pipes and memory: what else a run may find around itself."""

from __future__ import annotations

import resource
import shutil
import subprocess
import sys
from collections.abc import Iterator

from cosserat.memory import LEAST

from .processes import (
    CASES,
    Done,
    call,
    end,
    environment,
    expect_bytes,
    expect_sentence,
    expect_success,
    expect_whole_files,
    run_words,
    start,
    undisturbed,
)
from .table import Trial, expect, fault

KIND = "surroundings"
KEPT = (
    ("plot", "x.svg"),
    ("plot", "x.svg", "-o", "./x.svg"),
    ("plot", "x.gif", "--animate", "x.gif"),
    ("export", "x.csv", "--to", "csv"),
    ("export", "x.csv", "-o", "linked.csv"),
    ("export", "x.pvd", "--to", "vtk"),
    ("measure", "--table", "x.csv", "--output", "x.csv", "--cases", "."),
    ("chapter", "x.py", "--output", "x.py"),
)
"""Commands whose output is their input."""


@fault(
    KIND,
    "the output is the input",
    "Refused in one sentence, exit 2; the input keeps its bytes.",
    len(KEPT),
)
def _own_input(trial: Trial) -> Iterator[None]:
    words = KEPT[trial.number]
    name = next(word for word in words if word.startswith("x."))
    path = trial.folder / name
    shutil.copy(undisturbed("motion").path, path)
    if "linked.csv" in words:
        (trial.folder / "linked.csv").symlink_to(path)
    before = path.read_bytes()
    done = call(trial.folder, *words)
    expect(path.read_bytes() == before, f"the input was overwritten: {done.told}")
    if done.code:
        expect_sentence(done, 2)
    else:
        expect(path.is_file() and "linked.csv" in words, f"not refused: {done.told}")
    yield


LINKS = ("to a file", "to nothing", "to a folder", "to itself")


@fault(
    KIND,
    "the output is a symbolic link",
    "It is followed and stays a link, or refused in one sentence; its target is whole.",
    2 * len(LINKS),
)
def _link(trial: Trial) -> Iterator[None]:
    link, target = trial.folder / "link.nc", trial.folder / "far" / "target.nc"
    target.parent.mkdir()
    to = LINKS[trial.number % len(LINKS)]
    if to == "to a file":
        shutil.copy(undisturbed("modes").path, target)
    link.symlink_to({"to a folder": target.parent, "to itself": link}.get(to, target))
    case = ("statics", "motion")[trial.number // len(LINKS)]
    done = call(trial.folder, *run_words(case, "link.nc"))
    expect(link.is_symlink(), "the link was replaced by a file")
    if done.code == 0:
        expect_success(done)
        written = target.parent / f"{case}.nc" if to == "to a folder" else target
        expect_bytes(written, undisturbed(case).bytes)
    else:
        expect_sentence(done, 2, naming=["link.nc"])
        if to == "to a file":
            expect_bytes(target, undisturbed("modes").bytes)
    yield


PIPES = (
    "cases | head -1",
    "cases | true",
    "describe rod motion | head -1",
    "schema | head -1",
    "--help | head -1",
    "show {motion} | head -1",
    "run motion --file {file} -o x.nc | true",
    "cases >&-",
    "show {motion} 2>&-",
    "run motion --file {file} -o x.nc 2>&-",
    "run motion --file {file} -o x.nc <&- >&- 2>&-",
    "run motion --file {file} -o x.nc <&-",
)


@fault(KIND, "a closed pipe", "No error, no word; what is written is whole.", len(PIPES))
def _pipe(trial: Trial) -> Iterator[None]:
    text = PIPES[trial.number].format(motion=undisturbed("motion").path, file=CASES)
    done = subprocess.run(
        ["bash", "-o", "pipefail", "-c", f"'{sys.executable}' -m cosserat {text}"],
        cwd=trial.folder,
        env=environment(),
        capture_output=True,
        text=True,
        check=False,
    )
    told = Done(done.returncode, done.stdout, done.stderr).told
    expect(done.returncode == 0 and not done.stderr, f"{PIPES[trial.number]}: {told}")
    if " run " in f" {text} ":
        expect_bytes(trial.folder / "x.nc", undisturbed("motion").bytes)
    yield


@fault(KIND, "the current folder is gone", "One sentence, exit 2; nothing is written.", 2)
def _gone(trial: Trial) -> Iterator[None]:
    output = trial.folder.parent / f"{trial.folder.name}.nc"
    words = run_words("motion", output) if trial.number else ("cases",)
    done = call(trial.folder, *words, before=lambda: shutil.rmtree(trial.folder))
    trial.folder.mkdir()
    expect_sentence(done, 2)
    expect("current folder" in done.err and not output.exists(), done.told)
    yield


MEMORY = ("motion", "long_posture", "long_statics", "long_motion", "long_path", "large_modes")


@fault(KIND, "too little memory", "One sentence, exit 2, or the result; nothing invalid is left.", 24)
def _memory(trial: Trial) -> Iterator[None]:
    """From half of what cosserat asks for to twice as much, under a limit of the address space."""
    case = MEMORY[trial.number % len(MEMORY)]
    limit = int(LEAST * trial.rng.uniform(*((0.5, 1.0) if trial.number % 4 == 0 else (1.0, 2.0))))

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))

    running = start(trial.folder, *run_words(case, "x.nc"), before=limited)
    try:
        running.wait(20)
    except subprocess.TimeoutExpired:  # it had enough, and can be stopped
        running.terminate()
        done = end(running)
        if done.code or not (trial.folder / "x.nc").exists():  # else it was at its end
            expect_sentence(done, 143)
        yield
        return
    done = end(running)
    expect_whole_files(trial.folder)
    if done.code == 0:
        expect_success(done)
    else:
        expect_sentence(done, 1, 2)
        expect("memory" in done.err or "address space" in done.err, f"not about memory: {done.told}")
        left = [path.name for path in trial.folder.iterdir() if path.name != "x.nc.parts"]
        expect(not left, f"left in the folder: {' '.join(left)}")
    yield
