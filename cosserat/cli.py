"""The command line: `cosserat --help`."""

from __future__ import annotations

import argparse
import gc
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cosserat.errors import CosseratError, CrossingError, DivergedError, InputError, NotConvergedError
from cosserat.publications import Command, publications

if TYPE_CHECKING:
    from cosserat.cases.catalogue import Case

_INTERRUPTED = "cosserat: interrupted; no incomplete file was written"


def main(arguments: list[str] | None = None) -> int:
    """Run one command.

    Returns 0 for success, 1 if a claim or a solve failed, 2 for bad input, 130 if interrupted.
    """
    gc.set_threshold(100_000)  # a tenth of the time of a short run, mostly imports
    try:
        options = _parser().parse_args(arguments)
        command: Command = options.command
        command(options)
        sys.stdout.flush()
    except CosseratError as error:
        print(f"cosserat: {error}", file=sys.stderr)
        return 2 if isinstance(error, InputError) else 1
    except MemoryError:
        print(
            "cosserat: there is not enough memory; use fewer vertices, sections, elements or frames",
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

    def add(name: str, command: Command, text: str) -> argparse.ArgumentParser:
        sub = commands.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        sub.set_defaults(command=command)
        return sub

    sub = add("cases", _cases, "list the cases: the published ones, or those of your file")
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
        help="if a growing load cannot be followed to its end, write the part that was reached and still fail",
    )

    sub = add("show", _show, "print what a result holds: parameters, solver, range of each variable")
    sub.add_argument("file", type=Path)

    sub = add("plot", _plot, "draw a stored result: the body, its displacement and its strains")
    sub.add_argument("file", type=Path, help="netCDF file of cosserat")
    sub.add_argument("-o", "--output", type=Path, help="SVG file to write (default: beside the file)")

    sub = add("describe", _describe, "list the kinds of cases, or the keys of one kind")
    sub.add_argument("kind", nargs="*", help="such as rod statics (default: list the kinds)")

    sub = add("schema", _schema, "print the JSON Schema of case files, for editors")
    sub.add_argument(
        "--merged",
        action="store_true",
        help="of one case with all keys inherited by 'like' (default: of a file as it is written)",
    )

    for publication in publications():
        publication.add_commands()(add)
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
        "  cosserat show clamped_free.nc    prints its contents\n"
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
    if len(cases) > 1 and not os.path.isdir(folder):
        raise InputError(f"{folder} is not a folder; write several cases to an existing folder")
    for case in cases:
        path = folder / f"{case.name}.nc" if os.path.isdir(folder) else folder
        _run_case(case, path, keep_last=options.keep_last)


def _run_case(case: Case, path: Path, *, keep_last: bool) -> None:
    """Solve one case, write its file and report the effort."""
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
                f"{stopped}; the part reached, {part:.4g} of the load, is in {path}"
            ) from None
        if not kept.is_dir():
            raise
        if isinstance(stopped, KeyboardInterrupt):
            raise KeyboardInterrupt(
                f"interrupted; run the same command again to resume from {kept}"
            ) from None
        raise type(stopped)(
            f"{stopped}; the computed part is in {kept}; remove that folder before you change the case"
        ) from None
    save(dataset, path)
    Parts(path).remove()
    print(f"{case.name}: {effort(dataset)}; wrote {path}")
    for warning in warnings_of(dataset):
        print(f"warning: {warning}", file=sys.stderr)


def _report_progress(done: float, words: str) -> None:
    """A line that overwrites itself on a terminal, and nothing elsewhere."""
    if sys.stderr.isatty():
        print(f"\r{done:4.0%}  {words}   ", end="" if done < 1 else "\n", file=sys.stderr, flush=True)


def _describe(options: argparse.Namespace) -> None:
    from cosserat.describe.text import list_of_keys, list_of_kinds

    print(list_of_keys(" ".join(options.kind)) if options.kind else list_of_kinds())


def _schema(options: argparse.Namespace) -> None:
    import json

    from cosserat.describe.schema import as_written, merged

    print(json.dumps(merged() if options.merged else as_written(), indent=1, ensure_ascii=False))


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
