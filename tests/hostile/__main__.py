"""`python -m tests.hostile inputs|fuzz|damage|lines`: how bad input ends; a table, and each failure again.

Exit 1 if anything does not end as promised: one sentence that begins with "cosserat: ", the exit code 1 or 2, no
traceback, no warning of a library, no file left, within ten seconds.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from . import damage, fuzz, inputs, lines, regressions
from .judge import Outcome, faults
from .report import Tally, followed, store
from .worker import Worker

_WHAT = {
    "inputs": "bad inputs: every key of every kind, every command, files",
    "fuzz": "case files changed by chance",
    "damage": "commands on results damaged by chance",
    "lines": "command lines by chance",
}


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.hostile", description=__doc__)
    commands = parser.add_subparsers(required=True, dest="command")
    sub = commands.add_parser("inputs", help="the corpus: from the schema and by hand")
    sub.add_argument("words", nargs="*", help="only inputs whose name has one of these words")
    sub.add_argument("--quick", action="store_true", help="only the part of `make test`")
    sub.add_argument("--every", type=int, default=1, help="only each so-manieth input,")
    sub.add_argument("--first", type=int, default=0, help="from this one on")
    sub = commands.add_parser("fuzz", help="case files by chance")
    sub.add_argument("--examples", type=int, default=1000)
    sub.add_argument("--seed", type=int, default=1)
    sub.add_argument("--solve", type=int, default=0, help="solve so many of those that are accepted")
    sub = commands.add_parser("damage", help="damaged results")
    sub.add_argument("--files", type=int, default=100)
    sub.add_argument("--seed", type=int, default=1)
    sub = commands.add_parser("damaged", help="write one damaged result, as a failure names it")
    sub.add_argument("kind")
    sub.add_argument("damage")
    sub.add_argument("digest", choices=damage.DIGESTS)
    sub.add_argument("number", type=int)
    sub.add_argument("output", type=Path)
    sub = commands.add_parser("lines", help="command lines by chance")
    sub.add_argument("--examples", type=int, default=500)
    sub.add_argument("--seed", type=int, default=1)
    for command in _WHAT:
        commands.choices[command].add_argument(
            "--write", action="store_true", help="store the counts in results/inputs.csv, for the book"
        )
    options = parser.parse_args(arguments)
    if options.command == "damaged":
        return _write(options)
    tally = {"inputs": _inputs, "fuzz": _fuzz, "damage": _damage, "lines": _lines}[options.command](
        options
    )
    print(tally.text())
    if options.write:
        store(tally, _WHAT[options.command], getattr(options, "seed", ""))
    return min(tally.bad, 1)


def _inputs(options: argparse.Namespace) -> Tally:
    known = [
        *(make() for make in regressions.FOUND.values()),
        *(inputs.refused_at_once() if options.quick else inputs.corpus()),
    ]
    chosen = inputs.named(known, options.words)[options.first :: options.every]
    tally = Tally()
    with Worker() as worker:
        for given in followed(chosen, len(chosen), "inputs"):
            ended = worker.run(given)
            tally.add(given.name, end_of(ended), faults(given, ended), given.reproduction)
    return tally


def _fuzz(options: argparse.Namespace) -> Tally:
    tally, left = Tally(), options.solve
    with Worker() as worker:
        for number in followed(range(options.examples), options.examples, "fuzz"):
            given = fuzz.example(options.seed, number)
            ended = fuzz.read(worker, given)
            wrong = fuzz.faults_of(ended)
            tally.add(fuzz.named(given), end_of(ended), wrong, _smallest(worker, given, wrong))
            if left and ended.code == 0 and not ended.raised:
                left -= 1
                ended = worker.run(given.input)
                wrong = faults(given.input, ended)
                tally.add(
                    f"solve: {given.kind}",
                    end_of(ended),
                    wrong,
                    given.input.reproduction if wrong else "",
                )
    return tally


def _smallest(worker: Worker, given: fuzz.Example, wrong: list[str]) -> str:
    """The reproduction of a failure with as few changes as needed."""
    if not wrong or wrong[0].startswith("endless"):
        return given.input.reproduction if wrong else ""
    small = fuzz.shrunk(given, lambda one: fuzz.faults_of(fuzz.read(worker, one))[:1] == wrong[:1])
    return small.input.reproduction


def _damage(options: argparse.Namespace) -> Tally:
    tally = Tally()
    with tempfile.TemporaryDirectory(prefix="hostile-") as folder, Worker() as worker:
        originals = damage.results(Path(folder))
        for number in followed(range(options.files), options.files, "damage"):
            given = damage.example(originals, options.seed, number)
            again = f"python -m tests.hostile damaged {given.kind!r} {given.damage!r} {given.digest} {given.seed} x.nc"
            scratch = (
                Path(folder) / f"damaged{number}.nc"
            )  # a new one: a reader that failed may still lock the last
            for command, ended, wrong in damage.tried(
                worker, given, scratch, len(damage.COMMANDS) if number % 4 == 0 else 1
            ):
                tally.add(
                    f"{command}, digest {given.digest}: {given.damage}", end_of(ended), wrong, again
                )
            scratch.unlink(missing_ok=True)
    return tally


def _write(options: argparse.Namespace) -> int:
    with tempfile.TemporaryDirectory(prefix="hostile-") as folder:
        originals = damage.results(Path(folder), [options.kind])
        content = damage.Damaged(originals[0], options.damage, options.number, options.digest).content(
            Path(folder) / "x.nc"
        )
        options.output.write_bytes(content)
    return 0


def _lines(options: argparse.Namespace) -> Tally:
    tally = Tally()
    with tempfile.TemporaryDirectory(prefix="hostile-") as folder, Worker() as worker:
        result = damage.results(Path(folder))[0].read_bytes()
        for number in followed(range(options.examples), options.examples, "lines"):
            given = lines.example(options.seed, number, result)
            ended = worker.run(given)
            tally.add(given.name, end_of(ended), faults(given, ended), given.reproduction)
    return tally


def end_of(ended: Outcome) -> str:
    """How a command ended, in a word."""
    return (
        ended.where
        if ended.code is None and ended.where in ("no end", "no worker")
        else f"code {ended.code}"
    )


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
