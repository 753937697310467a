"""The command line: `cosserat --help`."""

from __future__ import annotations

import argparse
import gc
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cosserat.errors import CosseratError, CrossingError, DivergedError, InputError, NotConvergedError

if TYPE_CHECKING:
    from cosserat.cases.catalogue import Case

RESULTS = Path("results")
_INTERRUPTED = "cosserat: interrupted; nothing half-done was written"


def main(arguments: list[str] | None = None) -> int:
    """Run one command.

    Returns 0 if it did what was asked, 1 if a claim or a solve failed, 2 for a bad input, 130 if interrupted.
    """
    gc.set_threshold(100_000)  # a tenth of the time of a short run, most of which is imports
    try:
        options = _parser().parse_args(arguments)
        command: Callable[[argparse.Namespace], None] = options.command
        command(options)
        sys.stdout.flush()
    except CosseratError as error:
        print(f"cosserat: {error}", file=sys.stderr)
        return 2 if isinstance(error, InputError) else 1
    except MemoryError:
        print(
            "cosserat: this needs more memory than there is; take fewer vertices, sections, elements or frames",
            file=sys.stderr,
        )
        return 2
    except KeyboardInterrupt as stopped:
        print(f"cosserat: {stopped}" if str(stopped) else _INTERRUPTED, file=sys.stderr)
        return 130
    except BrokenPipeError:
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115 - whoever read our output has gone
        return 0
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="cosserat",
        description="Solve directed-rod problems and reproduce E. G. Hemingway's thesis (Berkeley, 2020).",
        epilog=_epilog(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--version", action=_Version, help="print the version and the digest of the computing code"
    )
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")

    def add(
        name: str, command: Callable[[argparse.Namespace], None], text: str
    ) -> argparse.ArgumentParser:
        sub = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        sub.set_defaults(command=command)
        return sub

    sub = add("cases", _cases, "list the cases: the published ones, or those of a file of yours")
    sub.add_argument("--file", type=Path, help="TOML file of cases (default: the published ones)")

    sub = add("run", _run, "solve one case and write its netCDF file")
    sub.add_argument(
        "case",
        help="name of a case, as 'cosserat cases' lists it; '-' reads cases from standard input, each a line of the "
        "JSON text in SI units that a result holds as its attribute 'parameters'",
    )
    sub.add_argument(
        "--file", type=Path, help="TOML file that holds the case (default: the published ones)"
    )
    sub.add_argument(
        "-o",
        "--output",
        type=Path,
        help="netCDF file to write, or a folder for CASE.nc (default: this folder)",
    )
    sub.add_argument(
        "--keep-last",
        action="store_true",
        help="where a growing load cannot be followed to its end, write what was reached and still fail",
    )

    sub = add("show", _show, "print what a result holds: parameters, solver, range of each variable")
    sub.add_argument("file", type=Path)

    sub = add("plot", _plot, "draw a stored result: the body, its displacement and its strains")
    sub.add_argument("file", type=Path, help="netCDF file of ours")
    sub.add_argument("-o", "--output", type=Path, help="SVG file to write (default: beside the file)")

    sub = add("figure", _figure, "draw figures of the thesis from stored results")
    sub.add_argument("figures", nargs="+", metavar="figure", help="such as fig_3_10")
    sub.add_argument(
        "--cases", type=Path, default=RESULTS / "cases", help="folder of the netCDF files (%(default)s)"
    )
    sub.add_argument(
        "-o", "--output", type=Path, default=Path(), help="SVG file, or folder for several (%(default)s)"
    )

    sub = add("measure", _measure, "measure every row of the results table on stored results")
    sub.add_argument(
        "--table", type=Path, default=RESULTS / "tolerances.csv", help="the table (%(default)s)"
    )
    sub.add_argument(
        "--cases", type=Path, default=RESULTS / "cases", help="folder of the netCDF files (%(default)s)"
    )
    sub.add_argument(
        "-o", "--output", type=Path, default=RESULTS / "report.csv", help="report (%(default)s)"
    )

    sub = add("check", _check, "fail if a claim of the report does not hold")
    sub.add_argument("report", type=Path, nargs="?", default=RESULTS / "report.csv")

    sub = add(
        "power",
        _power,
        "change inputs and physics one at a time and print which rows of the results table notice",
    )
    sub.add_argument(
        "--table", type=Path, default=RESULTS / "tolerances.csv", help="the table (%(default)s)"
    )
    sub.add_argument("words", nargs="*", help="only changes whose description has one of these words")

    sub = add("accept", _accept, "store a fresh result as the reference of its case, with the reason")
    sub.add_argument("case", help="name of a published case")
    sub.add_argument(
        "--because", required=True, help="the reason, in a sentence; it is stored in the file"
    )
    sub.add_argument(
        "--references", type=Path, default=RESULTS / "reference", help="folder (%(default)s)"
    )

    add(
        "speed",
        _speed,
        "time equilibria, the implicit integrator, and a stride of the worm by either solver",
    )

    sub = add(
        "peers", _peers, "time the consistent rod beside other packages; 'snakemake peers' sets them up"
    )
    sub.add_argument(
        "python", type=Path, help="the Python of the environment that holds the other packages"
    )
    sub.add_argument(
        "-o", "--output", type=Path, default=RESULTS / "peers.csv", help="table to write (%(default)s)"
    )

    sub = add("chapter", _chapter, "execute a chapter into a notebook")
    sub.add_argument("chapter", type=Path, help="the chapter's .py file")
    sub.add_argument("-o", "--output", type=Path, required=True, help="notebook to write")

    sub = add("book", _book, "render executed chapters as a book that needs no network")
    sub.add_argument(
        "notebooks", type=Path, nargs="+", help="executed notebooks, in the order of the book"
    )
    sub.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        help="folder of the book; index.html is its first page",
    )
    return parser


class _Version(argparse.Action):
    def __init__(self, **settings: Any) -> None:
        super().__init__(nargs=0, **settings)

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from cosserat.data.provenance import source

        print(source())
        parser.exit()


def _epilog() -> str:
    from cosserat.publications import titles

    width = max(map(len, titles()))
    listed = "\n".join(f"  {name:<{width}}  {title}" for name, (title, _) in titles().items())
    return (
        f"published cases:\n{listed}\n\n"
        "example:\n"
        "  cosserat run clamped_free        solves it and writes clamped_free.nc here\n"
        "  cosserat show clamped_free.nc    prints what came out\n"
        "  cosserat plot clamped_free.nc    draws it into clamped_free.svg\n\n"
        "a case of your own, in my.toml, may start from a published one:\n"
        '  [long_beam]\n  like = "clamped_free"\n  rod.length = "10 m"\n\n'
        "  cosserat run long_beam --file my.toml"
    )


def _cases(options: argparse.Namespace) -> None:
    from cosserat.publications import titles

    if options.file is None:
        known = titles()
    else:
        from cosserat.cases.catalogue import load

        known = {name: (case.title, case.source) for name, case in load(options.file).items()}
    width = max(map(len, known), default=0)
    for name, (title, source) in known.items():
        print(f"{name:<{width}}  {title}" + (f" ({source})" if source else ""))


def _run(options: argparse.Namespace) -> None:
    from cosserat.cases.catalogue import find, parse

    if options.case != "-":
        cases = [find(options.case, options.file)]
    elif options.file is not None:
        raise InputError("'-' reads the case from standard input, so '--file' has no use; leave it out")
    else:
        cases = [parse(line) for line in sys.stdin.read().strip().split("\n")]
    folder = Path() if options.output is None else options.output
    if len(cases) > 1 and not folder.is_dir():
        raise InputError(f"{folder} is no folder; several cases are written to one that exists")
    for case in cases:
        path = folder / f"{case.name}.nc" if folder.is_dir() else folder
        _run_case(case, path, keep_last=options.keep_last)


def _run_case(case: Case, path: Path, *, keep_last: bool) -> None:
    """Solve one case, write its file and say what it took."""
    from cosserat.data.checkpoints import Parts
    from cosserat.data.dataset import effort, save, statistics_of, warnings_of
    from cosserat.data.files import check_destination

    check_destination(path, ".nc")
    from cosserat.runner import run

    try:
        dataset = run(case, result=path, progress=_report_progress)
    except (NotConvergedError, CrossingError, DivergedError, KeyboardInterrupt) as stopped:
        kept, reached = Parts(path).folder, getattr(stopped, "dataset", None)
        if reached is not None and keep_last:
            save(reached, path)
            part = statistics_of(reached)["load_factor_reached"]
            raise type(stopped)(
                f"{stopped}; what was reached, {part:.4g} of the load, is in {path}"
            ) from None
        if not kept.is_dir():
            raise
        if isinstance(stopped, KeyboardInterrupt):
            raise KeyboardInterrupt(
                f"interrupted; run the same command again to go on from {kept}"
            ) from None
        raise type(stopped)(
            f"{stopped}; what was computed is in {kept}, which has to go before the case is changed"
        ) from None
    save(dataset, path)
    Parts(path).remove()
    print(f"{case.name}: {effort(dataset)}; wrote {path}")
    for warning in warnings_of(dataset):
        print(f"warning: {warning}", file=sys.stderr)


def _report_progress(share: float, words: str) -> None:
    """A line that overwrites itself on a terminal, and nothing elsewhere."""
    if sys.stderr.isatty():
        print(f"\r{share:4.0%}  {words}   ", end="" if share < 1 else "\n", file=sys.stderr, flush=True)


def _show(options: argparse.Namespace) -> None:
    from cosserat.data.dataset import case_of, load, statistics_of, warnings_of

    dataset = load(options.file)
    case, statistics = case_of(dataset), statistics_of(dataset)
    print(f"{case.name}: {case.title}\n{dataset.attrs['source']}")
    for warning in warnings_of(dataset):
        print(f"warning: {warning}")
    print("\nparameters (SI units)")
    for name, value in _flat(case.problem.model_dump()):
        print(f"  {name} = {value}")
    print("\nsolver\n" + "\n".join(f"  {name} = {value}" for name, value in statistics.items()))
    print("\nvariables: least, largest, unit")
    for variable, values in dataset.data_vars.items():
        about = {"units": "", "long_name": "", **values.attrs}
        print(
            f"  {variable!s:<9} {values.min():>14.7g} {values.max():>14.7g} {about['units']:<4} {about['long_name']}"
        )


def _flat(table: dict[str, object], prefix: str = "") -> list[tuple[str, object]]:
    rows: list[tuple[str, object]] = []
    for key, value in table.items():
        rows += _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else [(prefix + key, value)]
    return rows


def _figure(options: argparse.Namespace) -> None:
    from cosserat.thesis.figures.catalogue import draw_all

    for path in draw_all(options.figures, options.cases, options.output):
        print(f"wrote {path}")


def _plot(options: argparse.Namespace) -> None:
    from cosserat.data.dataset import case_of, load, warnings_of
    from cosserat.data.files import check_destination
    from cosserat.figures.style import note, settings, write
    from cosserat.publications import kinds

    path = options.output or options.file.with_suffix(".svg")
    check_destination(path, ".svg")
    data = load(options.file)
    kind = case_of(data).problem.kind
    if not kinds()[kind].picture:
        raise InputError(
            f"{options.file} is of kind '{kind}', which has no picture; see it with 'cosserat show'"
        )
    with settings():
        figure = kinds()[kind].picture_function()(data)
        note(figure, warnings_of(data))
    write(figure, path)
    print(f"wrote {path}")


def _measure(options: argparse.Namespace) -> None:
    from cosserat.data.files import check_destination
    from cosserat.thesis.table.measure import measure, summary
    from cosserat.thesis.table.tolerances import read_report, read_table, write_report

    check_destination(options.output)
    write_report(measure(read_table(options.table), options.cases), options.output)
    print(summary(read_report(options.output)))
    print(f"wrote {options.output}")


def _check(options: argparse.Namespace) -> None:
    from cosserat.thesis.table.measure import check
    from cosserat.thesis.table.tolerances import read_report

    print(check(read_report(options.report)))


def _power(options: argparse.Namespace) -> None:
    from cosserat.thesis.table.power import table
    from cosserat.thesis.table.tolerances import read_table

    for noticed in table(read_table(options.table), options.words):
        print(noticed, flush=True)


def _accept(options: argparse.Namespace) -> None:
    from cosserat.data.files import check_destination
    from cosserat.runner import run
    from cosserat.thesis.table.reference import accept

    path = options.references / f"{options.case}.nc"
    check_destination(path)
    for line in accept(run(options.case), path, options.because):
        print(line)
    print(f"wrote {path}")


def _speed(_: argparse.Namespace) -> None:
    from cosserat.thesis import benchmark

    for lines in (benchmark.statics, benchmark.integrator, benchmark.stride):
        for line in lines():
            print(line)


def _peers(options: argparse.Namespace) -> None:
    from cosserat.data.files import check_destination
    from cosserat.thesis.peers import compare

    check_destination(options.output, ".csv")
    lines = list(
        compare.compare(options.python, lambda words: print(words, file=sys.stderr, flush=True))
    )
    compare.write(lines, options.output)
    for line in lines:
        print(
            f"{line.problem:32} {line.package:11} {1e3 * line.seconds:10.2f} ms  error {line.error:.1e}"
        )
    print(f"wrote {options.output}")


def _chapter(options: argparse.Namespace) -> None:
    from cosserat.thesis.book.build import execute

    execute(options.chapter, options.output)
    print(f"wrote {options.output}")


def _book(options: argparse.Namespace) -> None:
    from cosserat.thesis.book.build import render

    print(f"wrote {render(options.notebooks, options.output)}")
