"""The command line: `cosserat --help`."""

from __future__ import annotations

import argparse
import contextlib
import gc
import logging
import os
import signal
import sys
import warnings
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NoReturn

from cosserat import commands
from cosserat.errors import NO_MEMORY, CosseratError, CosseratWarning, InputError, path_of
from cosserat.limits import GIGABYTES, HOURS
from cosserat.parameters import nearest
from cosserat.publications import AddCommand, Command, publications
from cosserat.signals import Stopped
from cosserat.text import printable, shortened, shown

_OWN = "commands"
_LONGEST_LINE = 2000  # characters of an error, whatever a file or a library put into it
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
_STUDY = """\
a study in my.toml:
  [cantilevers]
  kind = "study"
  of = "elastica"                                  a case, of this file or published
  keep.tip = "u.E2 at last"                        a read-out of each member
  [[cantilevers.vary]]
  rod.section.height = ["7 mm", "8 mm", "9 mm"]    a dimension of the answer
  [[cantilevers.vary]]
  sobol = 64                                       points: one dimension, 'member'
  forces.0.force = { uniform = ["0.5 N", "4.7 N"] }

  cosserat study cantilevers --file my.toml        writes cantilevers.nc
  cosserat run cantilevers --member 17 --file my.toml

What is solved is kept in the folder STUDY.study beside the answer: a study that was stopped goes on by the same
command, and one that was extended solves only what is new.  The exit status is 1 if some members have no answer."""
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


def main(arguments: list[str] | None = None) -> int:
    """Run one command.

    Returns 0 for success, 1 if a claim or a solve failed, 2 for bad input, 130 if interrupted (143 by SIGTERM, 129 by
    SIGHUP).
    """
    gc.set_threshold(100_000)  # a tenth of the time of a short run, mostly imports
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # where it keeps its fonts
    try:
        with _warnings_as_lines():
            options = _read(sys.argv[1:] if arguments is None else arguments)
            command: Command = options.command
            command(options)
            if sys.stdout is not None:  # there is none if the shell closed it
                sys.stdout.flush()
    except CosseratError as error:
        _complain(str(error))
        return 2 if isinstance(error, InputError) else 1
    except (MemoryError, ImportError) as error:
        if isinstance(error, ImportError) and "failed to map" not in str(error):
            raise
        _complain(NO_MEMORY)
        return 2
    except KeyboardInterrupt as interrupt:
        stopped = interrupt if isinstance(interrupt, Stopped) else Stopped(signal.SIGINT)
        _complain(str(stopped))
        return stopped.status
    except BrokenPipeError:
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115 - whoever read our output has gone
        return 0
    except OSError as error:
        reason = error.strerror or error
        if error.filename is not None:
            _complain(f"{error.filename}: {reason}; check name, space and permissions")
            return 2
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115 - what is left unprinted cannot be printed
        _complain(f"cannot write to standard output: {reason}; send it elsewhere")
        return 2
    return 0


def _complain(message: str) -> None:
    """Print a sentence about what went wrong; a closed terminal takes none."""
    lines = (printable(line)[:_LONGEST_LINE] for line in message.split("\n"))
    with contextlib.suppress(OSError):
        print("cosserat: " + "\n".join(lines), file=sys.stderr)


@contextlib.contextmanager
def _warnings_as_lines() -> Iterator[None]:
    """Print warnings of cosserat as one line each, and none of other packages."""

    def show(message: Warning | str, *_: object, **__: object) -> None:
        print(f"warning: {printable(message)}", file=sys.stderr)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", CosseratWarning)
        warnings.showwarning = show
        yield


def _read(arguments: list[str]) -> argparse.Namespace:
    """The options of a command; without any word, those of `--help`.

    Raises
    ------
    InputError : there is no such command or option.
    """
    parser = parser_of_commands()
    actions = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    known: dict[str, argparse.ArgumentParser] = dict(actions[0].choices or {})
    for given in arguments:
        if given.startswith("-") and given.endswith("=--"):  # which argparse reads as an empty list
            raise InputError(f"{shown(given)} gives no value; write one behind '='")
    word = arguments[0] if arguments else "--help"
    if not word.startswith("-") and word not in known:
        raise InputError(f"there is no command {shown(word)}{nearest(word, list(known), 0.6)}")
    options, unknown = parser.parse_known_args(arguments or [word])
    for value in vars(options).values():
        if isinstance(value, Path):
            path_of(value)
    if not unknown:
        return options
    asked = known.get(word, parser)
    given = unknown[0].partition("=")[0]
    if given.startswith("-"):
        named = [name for name in asked._option_string_actions if name.startswith("--")]
        raise InputError(f"'{asked.prog}' has no option {shown(given)}{nearest(given, named)}")
    raise InputError(f"{shown(given)} is one word too many; '{asked.prog} --help' tells what it takes")


def parser_of_commands() -> argparse.ArgumentParser:
    """The reader of the command line, with the commands of the publications."""
    listed: dict[str, list[tuple[str, str]]] = {_OWN: []}
    parser = _Parser(
        prog="cosserat",
        usage="cosserat [-h] [--version] COMMAND ...",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--version", action=_Version, help="print the version and the digest of the computing code"
    )
    groups = parser.add_subparsers(
        prog="cosserat", required=True, metavar="COMMAND", help=argparse.SUPPRESS
    )

    def add(name: str, command: Command, text: str) -> argparse.ArgumentParser:
        sub = groups.add_parser(
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
    sub = add("run", commands.run, "solve one case and write its netCDF file")
    sub.add_argument(
        "case",
        help="name of a case, as 'cosserat cases' lists it; '-' reads cases from standard input, each a line of the "
        "JSON text in SI units that a result holds as its attribute 'parameters'",
    )
    sub.add_argument(
        "--file", type=Path, help="TOML file that holds the case (default: the published ones)"
    )
    sub.add_argument(
        "--member", type=int, metavar="NUMBER", help="solve one member of the study of this name instead"
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
    sub.add_argument(
        "--hours",
        type=float,
        default=HOURS,
        help="longest time that the run may take, as estimated or measured (default: %(default)g)",
    )
    sub.add_argument(
        "--gigabytes",
        type=float,
        default=GIGABYTES,
        help="largest result that may be computed (default: %(default)g)",
    )

    sub.add_argument(
        "--estimate-error",
        nargs="*",
        metavar="READ-OUT",
        help="also solve the case on coarser and finer meshes within the same --hours, and print the estimated error "
        "of read-outs such as 'u.E2 at last' or 'max |kappa|' (default: some that the result has)",
    )

    _add_study(add)
    commands.add_fit(add)
    _add_results(add)
    _add_listings(add)


def _add_study(add: AddCommand) -> None:
    """Add the command for studies."""
    sub = add("study", commands.study, "solve a case for many values of its keys, as one netCDF file")
    sub.epilog = _STUDY
    sub.add_argument("study", help="name of a study in a case file, or of a published one")
    sub.add_argument(
        "--file", type=Path, help="TOML file that holds the study (default: the published ones)"
    )
    sub.add_argument(
        "-o",
        "--output",
        type=Path,
        help="netCDF file to write, or a folder for STUDY.nc (default: this folder)",
    )
    sub.add_argument(
        "--cores", type=int, metavar="N", help="let Snakemake solve it in batches on so many cores"
    )
    sub.add_argument(
        "--batch",
        type=int,
        metavar="MEMBERS",
        help="members that one job solves, when a study is first planned (default: what takes about a minute)",
    )
    sub.add_argument(
        "--profile", type=Path, metavar="FOLDER", help="let Snakemake solve it by this profile"
    )
    sub.add_argument(
        "--hours",
        type=float,
        default=HOURS,
        help="longest time that it may take on this machine, as estimated (default: %(default)g)",
    )
    ways = sub.add_mutually_exclusive_group()
    for name, words in (
        ("plan", "only divide the study into batches, and tell how many"),
        ("status", "only tell how far it is"),
        ("partial", "only write what is solved so far; other members have the status 'not_yet'"),
        ("cancel", "cancel the jobs of the study that wait or run on a cluster"),
        ("sweep", "delete stored batches that the study no longer uses"),
    ):
        ways.add_argument(f"--{name}", action="store_true", help=words)


def _add_results(add: AddCommand) -> None:
    """Add the commands for results."""
    sub = add("plot", commands.plot, "draw a result, or animate it")
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

    sub = add(
        "show", commands.show, "print what a result holds: parameters, solver, range of each variable"
    )
    sub.add_argument("file", type=Path, help="netCDF file of cosserat")

    sub = add(
        "export",
        commands.export,
        "write a result for other programs: a table as CSV, or the body for VTK",
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
    sub = add("describe", commands.describe, "list the kinds of cases, or the keys of one kind")
    sub.add_argument(
        "kind",
        nargs="*",
        help="such as rod statics, perhaps with one of its keys, such as rod.section (default: list the kinds)",
    )

    sub = add("schema", commands.schema, "print the JSON Schema of case files, for editors")
    sub.add_argument(
        "--merged",
        action="store_true",
        help="of one case with all keys inherited by 'like' (default: of a file as it is written)",
    )

    sub = add("cases", commands.cases, "list the cases: the published ones, or those of your file")
    sub.add_argument("--file", type=Path, help="TOML file of cases (default: the published ones)")


class _Parser(argparse.ArgumentParser):
    """Raises its complaints, which argparse would print with the usage in front."""

    def error(self, message: str) -> NoReturn:
        raise InputError(
            f"'{self.prog}': {shortened(message, 300)}; '{self.prog} --help' tells what it takes"
        )

    def print_help(self, file: Any = None) -> None:
        """Print the help; argparse would not say that it cannot be printed."""
        print(self.format_help(), end="", file=file, flush=True)


class _Version(argparse.Action):
    def __init__(self, **settings: Any) -> None:
        super().__init__(nargs=0, **settings)

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from cosserat.data.provenance import source

        print(source(), flush=True)
        parser.exit()


def _lines(named: Iterable[tuple[str, str]], width: int) -> list[str]:
    return [f"  {name:<{width}}{text}" for name, text in named]


def _published() -> list[str]:
    """Names and titles of the published cases."""
    from cosserat.publications import titles

    width = 2 + max(map(len, titles()))
    return _lines(((name, title) for name, (title, _) in titles().items()), width)
