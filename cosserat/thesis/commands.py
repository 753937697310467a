"""Commands of `cosserat` that reproduce the thesis: figures, the judged table, references, timings, the book."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from cosserat.publications import AddCommand

RESULTS = Path("results")


def add_commands(add: AddCommand) -> None:
    """Add the commands to the command line."""
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

    sub = add(
        "accept", _accept, "store a fresh result as the reference of its case or study, with the reason"
    )
    sub.add_argument("case", help="name of a published case or study")
    sub.add_argument(
        "--because", required=True, help="the reason, in a sentence; it is stored in the file"
    )
    sub.add_argument(
        "--references", type=Path, default=RESULTS / "reference", help="folder (%(default)s)"
    )

    _add_commands_of_outputs(add)

    add(
        "speed",
        _speed,
        "time equilibria, one and many, a run, the implicit integrator, and a stride of the worm by either solver",
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

    sub = add(
        "webassembly",
        _webassembly,
        "compile the rod that a reader of the book pulls into a module for browsers",
    )
    sub.add_argument(
        "-o",
        "--output",
        type=Path,
        default=RESULTS / "pull.wasm",
        help="module to write (%(default)s)",
    )

    sub = add("chapter", _chapter, "execute chapters into notebooks")
    sub.add_argument("chapters", type=Path, nargs="+", help="the chapters' .py files")
    sub.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        help="notebook to write, or the folder of several",
    )

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

    sub = add("pdf", _pdf, "print a built book as one PDF, by the Chromium of the system")
    sub.add_argument(
        "book", type=Path, nargs="?", default=RESULTS / "book", help="folder of the book (%(default)s)"
    )
    sub.add_argument(
        "-o", "--output", type=Path, default=RESULTS / "cosserat.pdf", help="PDF to write (%(default)s)"
    )


def _add_commands_of_outputs(add: AddCommand) -> None:
    """Add the commands about the outputs as a whole."""
    sub = add("verify", _verify, "say of every output whether it is as released, on any machine")
    sub.description = (
        "Say of every output of the manifest whether it has the same bytes, the same values, values within their "
        "floor, or differs and by how much; fail if one differs or is missing."
    )
    sub.add_argument("--results", type=Path, default=RESULTS, help="folder of the outputs (%(default)s)")
    sub.add_argument(
        "--references",
        type=Path,
        default=RESULTS / "reference",
        help="folder of the manifest and the references (%(default)s)",
    )

    sub = add("manifest", _manifest, "store the digests of all outputs, for a release")
    sub.add_argument("--results", type=Path, default=RESULTS, help="folder of the outputs (%(default)s)")
    sub.add_argument(
        "--references",
        type=Path,
        default=RESULTS / "reference",
        help="folder of the references, for the manifest too (%(default)s)",
    )

    sub = add("archive", _archive, "write one file to deposit: a research object of the reproduction")
    sub.add_argument(
        "-o", "--output", type=Path, default=RESULTS / "archive.zip", help="file to write (%(default)s)"
    )


def _figure(options: argparse.Namespace) -> None:
    from cosserat.thesis.figures.catalogue import FIGURES, draw_all
    from cosserat.thesis.outputs.verify import warn_unless_released

    read = {case for name in options.figures if name in FIGURES for case in FIGURES[name].cases}
    warn_unless_released(options.cases.parent, [f"cases/{case}.nc" for case in read])
    for path in draw_all(options.figures, options.cases, options.output):
        print(f"wrote {path}")


def _measure(options: argparse.Namespace) -> None:
    from cosserat.data.files import check_destination
    from cosserat.thesis.outputs.verify import warn_unless_released
    from cosserat.thesis.table.measure import measure, summary
    from cosserat.thesis.table.tolerances import read_report, read_table, write_report

    check_destination(options.output, inputs=(options.table,))
    rows = read_table(options.table)
    warn_unless_released(options.cases.parent, [f"cases/{row.case}.nc" for row in rows if row.case])
    write_report(measure(rows, options.cases), options.output)
    print(summary(read_report(options.output)))
    print(f"wrote {options.output}")


def _check(options: argparse.Namespace) -> None:
    from cosserat.thesis.outputs.verify import warn_unless_released
    from cosserat.thesis.table.measure import check
    from cosserat.thesis.table.tolerances import read_report

    warn_unless_released(options.report.parent, [options.report.name])
    print(check(read_report(options.report)))


def _power(options: argparse.Namespace) -> None:
    from cosserat.thesis.table.power import table
    from cosserat.thesis.table.tolerances import read_table

    for noticed in table(read_table(options.table), options.words):
        print(noticed, flush=True)


def _accept(options: argparse.Namespace) -> None:
    from cosserat.data.files import check_destination
    from cosserat.runner import run
    from cosserat.studies.door import find_study, published_studies, solved
    from cosserat.thesis.table.reference import accept

    name, path = options.case, options.references / f"{options.case}.nc"
    check_destination(path)
    fresh = solved(find_study(name)) if name in published_studies() else run(name)
    for line in accept(fresh, path, options.because):
        print(line)
    print(f"wrote {path}")


def _verify(options: argparse.Namespace) -> None:
    from cosserat.thesis.outputs import manifest, verify

    listed = manifest.read(options.references / manifest.NAME)
    verdicts = verify.verify(listed, options.results, options.references)
    for verdict in verdicts:
        print(verdict)
    print(verify.conclude(verdicts))


def _manifest(options: argparse.Namespace) -> None:
    from cosserat.thesis.outputs import manifest
    from cosserat.thesis.table.tolerances import read_table

    path = options.references / manifest.NAME
    manifest.store_copies(options.results, options.references)
    rows = read_table(options.results / "tolerances.csv")
    outputs = manifest.make(options.results, options.references, rows)
    manifest.write(outputs, path)
    print(f"wrote {path}: {len(outputs)} outputs")


def _archive(options: argparse.Namespace) -> None:
    from cosserat.data.files import check_destination
    from cosserat.thesis.outputs.archive import write

    check_destination(options.output, ".zip")
    write(Path(), options.output)
    print(f"wrote {options.output}")


def _speed(_: argparse.Namespace) -> None:
    from cosserat.thesis import benchmark

    parts = (benchmark.statics, benchmark.many, benchmark.paths, benchmark.one_run)
    for lines in (*parts, benchmark.integrator, benchmark.stride):
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


def _webassembly(options: argparse.Namespace) -> None:
    import hashlib

    from cosserat.data.files import check_destination, whole_or_absent
    from cosserat.export.webassembly.build import pulled_rod

    check_destination(options.output, ".wasm")
    module = pulled_rod()
    with whole_or_absent(options.output) as temporary:
        temporary.write_bytes(module)
    print(f"wrote {options.output}: {len(module)} bytes, sha256 {hashlib.sha256(module).hexdigest()}")


def _chapter(options: argparse.Namespace) -> None:
    from cosserat.errors import InputError
    from cosserat.thesis.book.execution import execute

    chapters, output = options.chapters, options.output
    if len(chapters) > 1 and not output.is_dir():
        raise InputError(f"{output} is not a folder; make a folder for several notebooks first")
    outputs = [output / f"{chapter.stem}.ipynb" if output.is_dir() else output for chapter in chapters]
    for written in execute(chapters, outputs):
        print(f"wrote {written}")


def _book(options: argparse.Namespace) -> None:
    from cosserat.thesis.book.build import render

    print(f"wrote {render(options.notebooks, options.output)}")


def _pdf(options: argparse.Namespace) -> None:
    from cosserat.thesis.book.paper import print_book

    pages = print_book(options.book, options.output)
    print(f"wrote {options.output}, {pages} pages")
