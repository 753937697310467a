"""The command line: `cosserat --help`."""

from __future__ import annotations

import argparse
import gc
import os
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cosserat.errors import CosseratError, CrossingError, DivergedError, InputError, NotConvergedError
from cosserat.parameters import nearest
from cosserat.publications import AddCommand, Command, publications

if TYPE_CHECKING:
    from cosserat.cases.catalogue import Case

_OWN = "commands"
_EXAMPLE = """\
example:
  cosserat run clamped_free        solves it and writes clamped_free.nc here
  cosserat show clamped_free.nc    prints its contents
  cosserat plot clamped_free.nc    draws it into clamped_free.svg
  cosserat COMMAND --help          tells all about a command

a case of your own, in my.toml, may start from a published one:
  [long_beam]
  like = "clamped_free"
  rod.length = "10 m"

  cosserat run long_beam --file my.toml"""
_EXPORT = """\
CSV: one tidy table.
  A row is one place of the body at one instant: the column 'place' says vertex, edge or section, and
  'number' counts them from 0. What belongs to the body as a whole, such as energies, has rows of its
  own: 'whole'. Each variable and component is a column with its unit, such as 'x_E2 [m]'. A value stands
  where it was computed and nowhere else: other cells are empty, and nothing is interpolated.
  In Python: cosserat.to_dataframe(result).

VTK: the body as a mesh, for ParaView; it needs meshio ('pip install meshio').
  A single state is one file, .vtu. A motion, a path or a crawl is a .pvd file, to be opened, and a folder
  with a .vtu for each instant. A rod is a row of quadrilaterals between its lateral surfaces, a crawler a
  closed surface; x is along E3, y along E2. Points have the numbers of their vertex or section, and for a
  rod displacement and velocity; cells have those of their edge.

examples:
  cosserat export elastica.nc --to csv
  cosserat export elastica.nc -o vertices.csv --place vertex
  cosserat export worm.nc -o worm.pvd"""
_INTERRUPTED = "cosserat: interrupted; no incomplete file was written"


def main(arguments: list[str] | None = None) -> int:
    """Run one command.

    Returns 0 for success, 1 if a claim or a solve failed, 2 for bad input, 130 if interrupted.
    """
    gc.set_threshold(100_000)  # a tenth of the time of a short run, mostly imports
    try:
        options = _read(sys.argv[1:] if arguments is None else arguments)
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


def _read(arguments: list[str]) -> argparse.Namespace:
    """The options of a command; without any word, those of `--help`.

    Raises
    ------
    InputError : there is no such command or option.
    """
    parser = parser_of_commands()
    actions = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    commands: dict[str, argparse.ArgumentParser] = dict(actions[0].choices or {})
    word = arguments[0] if arguments else "--help"
    if not word.startswith("-") and word not in commands:
        raise InputError(f"there is no command '{word}'{nearest(word, list(commands), 0.6)}")
    options, unknown = parser.parse_known_args(arguments or [word])
    if unknown and unknown[0].startswith("-"):
        known = [name for name in commands[word]._option_string_actions if name.startswith("--")]
        given = unknown[0].partition("=")[0]
        raise InputError(f"'cosserat {word}' has no option '{given}'{nearest(given, known)}")
    if unknown:
        raise InputError(
            f"'{unknown[0]}' is one word too many; 'cosserat {word} --help' tells what it takes"
        )
    return options


def parser_of_commands() -> argparse.ArgumentParser:
    """The reader of the command line, with the commands of the publications."""
    listed: dict[str, list[tuple[str, str]]] = {_OWN: []}
    parser = argparse.ArgumentParser(
        prog="cosserat",
        usage="cosserat [-h] [--version] COMMAND ...",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--version", action=_Version, help="print the version and the digest of the computing code"
    )
    commands = parser.add_subparsers(
        prog="cosserat", required=True, metavar="COMMAND", help=argparse.SUPPRESS
    )

    def add(name: str, command: Command, text: str) -> argparse.ArgumentParser:
        sub = commands.add_parser(
            name,
            description=text[0].upper() + text[1:] + ".",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        sub.set_defaults(command=command)
        listed[next(reversed(listed))].append((name, text))
        return sub

    _add_commands(add)
    for publication in publications():
        listed[publication.title] = []
        publication.add_commands()(add)
    width = 2 + max(len(name) for group in listed.values() for name, _ in group)
    own, *others = ("\n".join([f"{title}:", *_lines(group, width)]) for title, group in listed.items())
    parser.description = f"Solve rods, worms and soft robots of your own.\n\n{own}"
    parser.epilog = "\n\n".join([_EXAMPLE, *others, "\n".join(["published cases:", *_published()])])
    return parser


def _add_commands(add: AddCommand) -> None:
    """Add the commands for cases and results of one's own."""
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

    _add_results(add)
    _add_listings(add)


def _add_results(add: AddCommand) -> None:
    """Add the commands for results."""
    sub = add("plot", _plot, "draw a result, or animate it")
    sub.add_argument("file", type=Path, help="netCDF file of cosserat")
    written = sub.add_mutually_exclusive_group()
    written.add_argument(
        "-o",
        "--output",
        type=Path,
        help="picture to write: .svg, .pdf or .png (default: an SVG beside the file)",
    )
    written.add_argument(
        "--animate",
        type=Path,
        metavar="FILE",
        help="write an animation instead: .gif, or .html with buttons",
    )
    sub.add_argument(
        "--frames", type=int, default=100, help="most frames of an animation (default: %(default)s)"
    )

    sub = add("show", _show, "print what a result holds: parameters, solver, range of each variable")
    sub.add_argument("file", type=Path, help="netCDF file of cosserat")

    sub = add(
        "export", _export, "write a result for other programs: a table as CSV, or the body for VTK"
    )
    sub.epilog = _EXPORT
    sub.add_argument("file", type=Path, help="netCDF file of cosserat")
    sub.add_argument(
        "--to", choices=("csv", "vtk"), help="what to write (default: by the output's ending)"
    )
    sub.add_argument(
        "-o",
        "--output",
        type=Path,
        help="file to write: .csv, .vtu or .pvd; or a folder (default: beside the file)",
    )
    sub.add_argument(
        "--place", help="csv: only rows of this place, such as vertex, without empty columns"
    )


def _add_listings(add: AddCommand) -> None:
    """Add the commands that tell what there is."""
    sub = add("describe", _describe, "list the kinds of cases, or the keys of one kind")
    sub.add_argument(
        "kind",
        nargs="*",
        help="such as rod statics, perhaps with one of its keys, such as rod.section (default: list the kinds)",
    )

    sub = add("schema", _schema, "print the JSON Schema of case files, for editors")
    sub.add_argument(
        "--merged",
        action="store_true",
        help="of one case with all keys inherited by 'like' (default: of a file as it is written)",
    )

    sub = add("cases", _cases, "list the cases: the published ones, or those of your file")
    sub.add_argument("--file", type=Path, help="TOML file of cases (default: the published ones)")


class _Version(argparse.Action):
    def __init__(self, **settings: Any) -> None:
        super().__init__(nargs=0, **settings)

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from cosserat.data.provenance import source

        print(source())
        parser.exit()


def _lines(named: Iterable[tuple[str, str]], width: int) -> list[str]:
    return [f"  {name:<{width}}{text}" for name, text in named]


def _published() -> list[str]:
    """Names and titles of the published cases."""
    from cosserat.publications import titles

    width = 2 + max(map(len, titles()))
    return _lines(((name, title) for name, (title, _) in titles().items()), width)


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
        dataset = run(case, result=path)
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


def _describe(options: argparse.Namespace) -> None:
    from cosserat.describe.text import description

    print(description(options.kind))


def _schema(options: argparse.Namespace) -> None:
    import json

    from cosserat.describe.schema import as_written, merged

    print(json.dumps(merged() if options.merged else as_written(), indent=1, ensure_ascii=False))


def _show(options: argparse.Namespace) -> None:
    from cosserat.data.dataset import by_name, case_of, load, statistics_of, warnings_of

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
        for label, part in by_name(values):
            print(
                f"  {f'{variable}{label}':<9} {part.min():>14.7g} {part.max():>14.7g} {about['units']:<4} "
                f"{about['long_name']}"
            )


def _flat(table: dict[str, object], prefix: str = "") -> list[tuple[str, object]]:
    rows: list[tuple[str, object]] = []
    for key, value in table.items():
        rows += _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else [(prefix + key, value)]
    return rows


def _plot(options: argparse.Namespace) -> None:
    from cosserat.figures.doors import animate, plot

    if options.animate is not None:
        path = options.animate
        animate(options.file, path, options.frames)
    else:
        path = options.output or options.file.with_suffix(".svg")
        plot(options.file, path)
    print(f"wrote {path}")


def _export(options: argparse.Namespace) -> None:
    from cosserat.export.doors import export

    print(f"wrote {export(options.file, options.to, options.output, options.place)}")
