"""What `cosserat study` does: plan, solve here or by Snakemake, gather, and tell how it went."""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import os
import subprocess
import sys
import time
from pathlib import Path

from cosserat.errors import CosseratError, InputError
from cosserat.limits import Limits
from cosserat.problem import Forecast
from cosserat.progress import bar, duration
from cosserat.studies.elsewhere import alone, cancel, jobs
from cosserat.studies.family import Family
from cosserat.studies.plan import (
    answer_file,
    folder_of,
    gathered,
    left,
    members_in,
    plan,
    set_aside,
    sweep,
)
from cosserat.studies.stored import BATCHES, Plan, read_task, write_solved
from cosserat.text import shortened

WORKFLOW = Path(__file__).with_name("study.smk")
_HERE_SECONDS = 30.0
"""Work that one process does here and now, where nothing else is asked for."""


def study(options: argparse.Namespace) -> None:
    """Solve a study and write its answer, or tell or change how it stands.

    Raises
    ------
    InputError : the study is not valid, or Slurm does not answer.
    FailedMembersError : some members have no answer.
    OverLimitError : it would take longer than allowed.
    """
    from cosserat.data.files import check_destination
    from cosserat.data.locks import only_writer
    from cosserat.data.netcdf import check_replaceable
    from cosserat.studies.door import find_study

    began = time.monotonic()
    _check_options(options)
    found = find_study(options.study, options.file)
    path = _destination(options.output, found.name)
    check_destination(path, ".nc", inputs=() if options.file is None else (options.file,))
    check_replaceable(path)
    folder = folder_of(path)
    for part in (folder, folder / BATCHES):
        if os.path.lexists(part) and not os.path.isdir(part):
            kind = "a link that leads to no folder" if part.is_symlink() else "a file"
            raise InputError(
                f"{part} is {kind}, where the parts of the study go; move it or choose another --output"
            )
    if options.cancel:
        ended = cancel(folder)
        print(f"{found.name}: {len(ended)} jobs ended on Slurm; what is solved is in {folder}")
        return
    if options.status:
        _tell(found, folder, _planned(options, found, folder, began))
        return
    with only_writer(path):
        made = _planned(options, found, folder, began)
        if options.sweep:
            print(f"{found.name}: {sweep(folder, made)} batches deleted that the study does not use")
        if options.plan or options.sweep:
            _tell(found, folder, made)
            return
        written = not options.partial and _solve(options, found, folder, path, made)
        _report(found, folder, path, partial=options.partial, written=written)


def _planned(options: argparse.Namespace, found: Family, folder: Path, began: float) -> Plan:
    with bar(found.name, began) as report:
        return plan(found, folder, options.batch, report)


def _check_options(options: argparse.Namespace) -> None:
    """Raise InputError before anything is written for numbers of cores or hours and profiles that cannot be."""
    if options.cores is not None and options.cores < 1:
        raise InputError(f"--cores is {options.cores}; give 1 or more")
    if options.profile is not None and not Path(options.profile).exists():
        raise InputError(
            f"there is no profile {shortened(str(options.profile), 200)}; give its folder, such as profiles/slurm"
        )
    Limits.read({"hours": options.hours}, "limits")


def _destination(given: Path | None, name: str) -> Path:
    path = Path() if given is None else given
    return path / f"{name}.nc" if os.path.isdir(path) else path


def _solve(options: argparse.Namespace, found: Family, folder: Path, path: Path, made: Plan) -> bool:
    """Solve what is left, here or by Snakemake; returns whether the answer is written too."""
    names = left(folder, made)
    if not names:
        return False
    seconds = made.seconds * sum(members_in(folder, name) for name in names)
    by_snakemake = bool(options.profile or options.cores)
    if not by_snakemake and seconds > _HERE_SECONDS:
        by_snakemake = importlib.util.find_spec("snakemake") is not None
    if not options.profile:
        cores = (options.cores or os.cpu_count() or 1) if by_snakemake else 1
        limits = Limits.read({"hours": options.hours}, "limits")
        limits.check(
            Forecast(seconds / cores, 0.0, f"{found.size} members", "vary fewer values"),
            f"study '{found.name}'",
            path,
        )
    set_aside(folder, names)
    if by_snakemake:
        _by_snakemake(
            options,
            found.name,
            folder,
            path,
            f"{_counted(len(names))} left, about {duration(seconds)} of work",
        )
    else:
        _here(found, folder, names)
    return by_snakemake


def _here(found: Family, folder: Path, given: list[str]) -> None:
    """Solve batches one after the other in this process; each is stored as soon as it is done.

    The Snakemake of a run that was killed may still be at work; what it solves is not solved again.
    """
    used = (folder / ".snakemake").is_dir()
    with alone(folder) if used else contextlib.nullcontext():
        _each(found, folder, [name for name in given if not os.path.lexists(answer_file(folder, name))])


def _each(found: Family, folder: Path, names: list[str]) -> None:
    from cosserat.studies.solving import solve_members

    sizes = [members_in(folder, name) for name in names]
    with bar(found.name) as report:
        for number, name in enumerate(names):
            begin, share = sum(sizes[:number]) / sum(sizes), sizes[number] / sum(sizes)
            task = read_task(folder / BATCHES / f"{name}.npz")

            def tell(fraction: float, words: str, begin: float = begin, share: float = share) -> None:
                report(begin + share * fraction, words)

            solved = solve_members(task, tell, os.cpu_count() or 1)
            write_solved(answer_file(folder, name), task, solved)


def _by_snakemake(options: argparse.Namespace, name: str, folder: Path, path: Path, work: str) -> None:
    """Let Snakemake solve the batches and gather the answer; `name` : of the study.  `work` : what is left, in words.

    Only this process works in the folder, so a lock that Snakemake finds there is one of a killed run.
    """
    if importlib.util.find_spec("snakemake") is None:
        raise InputError(
            "'--cores' and '--profile' need Snakemake: pip install snakemake; or leave them out"
        )
    command = [
        *(sys.executable, "-m", "snakemake", "--snakefile", str(WORKFLOW), "--directory", str(folder)),
        *("--config", f"answer={path.resolve()}"),
        *(
            "--nolock",
            "--ignore-incomplete",  # a batch is whole or absent, also where Snakemake was killed beside it
            "--keep-going",
            "--rerun-triggers",
            "mtime",
            "--quiet",
            "rules",
        ),
    ]
    if options.profile:
        command += ["--profile", str(Path(options.profile).resolve())]
    if options.cores or not options.profile:
        command += ["--cores", str(options.cores or "all")]
    print(f"{name}: {work}; Snakemake's log is in {folder / '.snakemake' / 'log'}", file=sys.stderr)
    environment = os.environ | {"OMP_NUM_THREADS": "1", "PYTHONPATH": _import_path()}
    done = subprocess.run(command, check=False, env=environment, stderr=sys.stderr)
    if done.returncode:
        raise CosseratError(
            f"Snakemake ended with status {done.returncode}; what is solved is in {folder}: run the same command again"
        )


def _counted(batches: int) -> str:
    return f"{batches} batch" + "es" * (batches != 1)


def _import_path() -> str:
    """Where this package is, for processes in another folder."""
    own = str(Path(__file__).resolve().parents[2])
    return os.pathsep.join(filter(None, [own, os.environ.get("PYTHONPATH")]))


def _report(found: Family, folder: Path, path: Path, *, partial: bool, written: bool) -> None:
    """Write the answer, unless Snakemake has, and tell how it went."""
    from cosserat.data.netcdf import load, save
    from cosserat.studies.answer import answer, check_solved, counts

    data = load(path, own=True) if written else answer(*gathered(folder, partial=partial))
    if not written:
        save(data, path)
    print(f"{found.name}: {counts(data)}; wrote {path}")
    check_solved(data, str(path))


def _tell(found: Family, folder: Path, made: Plan) -> None:
    """Print how a study stands."""
    names = left(folder, made)
    members = sum(members_in(folder, name) for name in names)
    work = f", about {duration(made.seconds * members)} of work" if members and made.seconds else ""
    shape = " x ".join(f"{size} {dim}" for dim, size in zip(found.dims(), found.shape, strict=True))
    print(f"{found.name}: {found.size} members ({shape}) in {_counted(len(made.batches))} in {folder}")
    print(f"left: {members} members in {_counted(len(names))}{work}")
    for job in jobs(folder):
        print(f"on Slurm: job {job.id}, {job.state}, {job.batch}")
