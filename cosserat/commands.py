"""What the commands for cases and results of one's own do."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from cosserat.errors import (
    CosseratError,
    CrossingError,
    DivergedError,
    InputError,
    NotConvergedError,
    OverLimitError,
)
from cosserat.signals import Stopped
from cosserat.text import printable

_MOST_INPUT = 100_000_000  # characters of cases on standard input

if TYPE_CHECKING:
    import argparse

    import xarray as xr

    from cosserat.cases.catalogue import Case
    from cosserat.limits import Limits
    from cosserat.publications import AddCommand


def cases(options: argparse.Namespace) -> None:
    """List cases with their titles."""
    from cosserat.publications import titles

    if options.file is None:
        known = titles()
    else:
        from cosserat.cases.catalogue import load

        known = {name: (case.title, case.source) for name, case in load(options.file).items()}
    width = max(map(len, known), default=0)
    for name, (title, source) in known.items():
        print(printable(f"{name:<{width}}  {title}" + (f" ({source})" if source else "")))


def run(options: argparse.Namespace) -> None:
    """Solve cases and write their files."""
    from cosserat.cases.catalogue import find, parse

    if options.member is not None:
        from cosserat.studies.door import find_study

        cases = [find_study(options.case, options.file).case(options.member)]
    elif options.case != "-":
        cases = [find(options.case, options.file)]
    elif options.file is not None:
        raise InputError("'-' reads the case from standard input, so '--file' has no use; leave it out")
    else:
        cases = [parse(line) for line in _standard_input().strip().split("\n")]
    from cosserat.limits import Limits

    limits = Limits.read({"hours": options.hours, "gigabytes": options.gigabytes}, "limits")
    folder = Path() if options.output is None else options.output
    if len(cases) > 1 and not os.path.isdir(folder):
        raise InputError(f"{folder} is not a folder; write several cases to an existing folder")
    wanted = _wanted(cases, options.estimate_error)
    for case in cases:
        path = folder / f"{case.name}.nc" if os.path.isdir(folder) else folder
        began = time.monotonic()
        dataset = _run_case(case, path, limits, file=options.file, keep_last=options.keep_last)
        if wanted is not None:
            hours = max(limits.hours - (time.monotonic() - began) / 3600, 1e-9)
            _print_errors(case, dataset, wanted, limits.replace(hours=hours))


def _wanted(cases: list[Case], read_outs: list[str] | None) -> dict[str, str] | None:
    """The read-outs whose errors are estimated, by any names; None if none are, before anything is solved.

    Raises
    ------
    InputError : a case has no mesh, or a read-out is none.
    """
    if read_outs is None:
        return None
    from cosserat.studies.analysis.estimates import what_to_estimate

    wanted = {f"value_{number}": text for number, text in enumerate(read_outs)}
    for case in cases:
        what_to_estimate(case, wanted)
    return wanted


def _print_errors(case: Case, dataset: xr.Dataset, wanted: dict[str, str], limits: Limits) -> None:
    """Estimate the errors of a result and print them."""
    from cosserat.data.dataset import warnings_of
    from cosserat.studies.analysis.estimates import estimate_error, lines

    found = estimate_error(case, wanted, limits=limits, result=dataset)
    print("\n".join(map(printable, lines(found))))
    for warning in warnings_of(found):
        print(f"warning: {printable(warning)}", file=sys.stderr)


def _standard_input() -> str:
    """The text on standard input.

    Raises
    ------
    InputError : it is no text, or a very long one.
    """
    if sys.stdin is None:
        raise InputError("standard input is closed; give cases as JSON text there")
    try:
        given = sys.stdin.read(_MOST_INPUT + 1)
    except UnicodeDecodeError:
        raise InputError("standard input is not in UTF-8; give cases as JSON text") from None
    if len(given) > _MOST_INPUT:
        raise InputError(
            f"standard input is longer than {_MOST_INPUT:g} characters; give fewer cases at once"
        )
    return given


def _run_case(
    case: Case, path: Path, limits: Limits, *, file: Path | None, keep_last: bool
) -> xr.Dataset:
    """Solve one case, write its file and report the effort; returns the result."""
    from cosserat.data.checkpoints import Parts
    from cosserat.data.dataset import effort, warnings_of
    from cosserat.data.files import check_destination
    from cosserat.data.locks import only_writer
    from cosserat.data.netcdf import check_replaceable, save

    check_destination(path, ".nc", inputs=() if file is None else (file,))
    check_replaceable(path)
    from cosserat.runner import run as solve

    with only_writer(path):
        try:
            dataset = solve(case, result=path, limits=limits)
        except (NotConvergedError, CrossingError, DivergedError, OverLimitError) as stopped:
            left = _what_is_left(stopped, path, keep_last=keep_last)
            raise type(stopped)(f"{stopped}{left}") from None
        except KeyboardInterrupt as stopped:
            kept, number = Parts(path).folder, getattr(stopped, "number", signal.SIGINT)
            if not kept.is_dir():
                raise
            raise Stopped(number, f"run the same command again to resume from {kept}") from None
        save(dataset, path)
        Parts(path).remove()
    print(f"{case.name}: {effort(dataset)}; wrote {path}")
    for warning in warnings_of(dataset):
        print(f"warning: {printable(warning)}", file=sys.stderr)
    return dataset


def _what_is_left(stopped: CosseratError, path: Path, *, keep_last: bool) -> str:
    """The clause about what a run leaves that has stopped: the part reached, the parts of a motion, or nothing."""
    from cosserat.data.checkpoints import Parts
    from cosserat.data.dataset import statistics_of
    from cosserat.data.netcdf import save

    kept, reached = Parts(path).folder, getattr(stopped, "dataset", None)
    if reached is not None and keep_last:
        save(reached, path)
        part = statistics_of(reached)["load_factor_reached"]
        return f"; the part reached, {part:.4g} of the load, is in {path}"
    if not kept.is_dir():
        return ""
    if isinstance(stopped, OverLimitError):
        return f"; the computed part is in {kept}, and the run goes on from there"
    return f"; the computed part is in {kept}; remove that folder before you change the case"


def study(options: argparse.Namespace) -> None:
    """Solve a study."""
    from cosserat.studies.command import study as solve

    solve(options)


def fit(options: argparse.Namespace) -> None:
    """Fit keys of a case to data."""
    from cosserat.studies.analysis.fitting import command

    command(options)


def add_fit(add: AddCommand) -> None:
    """Add the command for fits."""
    sub = add("fit", fit, "fit keys of a case to measured data, as one netCDF file")
    sub.add_argument("fit", help="name of a table of kind 'fit' in the case file")
    sub.add_argument("--file", type=Path, required=True, help="TOML file that holds the fit")
    sub.add_argument(
        "-o",
        "--output",
        type=Path,
        help="netCDF file to write, or a folder for FIT.nc (default: this folder)",
    )


def describe(options: argparse.Namespace) -> None:
    """Describe kinds or keys."""
    from cosserat.describe.text import description

    print(description(options.kind))


def schema(options: argparse.Namespace) -> None:
    """Print the JSON Schema of case files."""
    import json

    from cosserat.describe.schema import as_written, merged

    print(json.dumps(merged() if options.merged else as_written(), indent=1, ensure_ascii=False))


def show(options: argparse.Namespace) -> None:
    """Print what a result holds."""
    from cosserat.data.dataset import (
        by_name,
        case_of,
        content_of,
        holding_what_is_needed,
        statistics_of,
        warnings_of,
    )
    from cosserat.data.netcdf import load

    dataset = load(options.file)
    if "study" in dataset.attrs and "bands" not in dataset.attrs:
        from cosserat.studies.analysis.contents import contents

        with holding_what_is_needed(dataset, "'show'"):
            print("\n".join(map(printable, contents(dataset))))
        return
    title, solver = str(dataset.attrs.get("title", "")), dict[str, object]()
    case = case_of(dataset) if "parameters" in dataset.attrs else None
    if case is not None and not content_of(dataset):
        title, solver = f"{case.name}: {case.title}", dict(statistics_of(dataset))
    lines = [title, str(dataset.attrs.get("source", ""))]
    lines += [f"warning: {warning}" for warning in warnings_of(dataset)]
    if case is not None:
        lines += ["", "parameters (SI units)"]
        lines += [f"  {name} = {value}" for name, value in _flat(case.problem.model_dump())]
    if solver:
        lines += ["", "solver", *(f"  {name} = {value}" for name, value in solver.items())]
    lines += ["", "variables: least, largest, unit"]
    with holding_what_is_needed(dataset, "'show'"):
        for variable, values in dataset.data_vars.items():
            about = {"units": "", "long_name": "", **values.attrs}
            for label, part in by_name(values):
                lines.append(
                    f"  {f'{variable}{label}':<9} {_range(part)} {about['units']:<4} {about['long_name']}"
                )
    print("\n".join(map(printable, lines)))


def _range(values: xr.DataArray) -> str:
    """The least and the largest value, in two columns; blank where there are no numbers."""
    if values.dtype.kind not in "iuf" or not values.size:
        return " " * 29
    return f"{values.min():>14.7g} {values.max():>14.7g}"


def _flat(table: dict[str, object], prefix: str = "") -> list[tuple[str, object]]:
    rows: list[tuple[str, object]] = []
    for key, value in table.items():
        rows += _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else [(prefix + key, value)]
    return rows


def plot(options: argparse.Namespace) -> None:
    """Draw or animate a result."""
    from cosserat.data.netcdf import existing
    from cosserat.figures.doors import animate, plot

    file = existing(options.file)
    path = options.animate or options.output or file.with_suffix(".svg")
    if options.animate is not None:
        animate(file, path, options.frames)
    else:
        plot(file, path)
    print(f"wrote {path}")


def export(options: argparse.Namespace) -> None:
    """Write a result for other programs."""
    from cosserat.export.doors import export

    print(f"wrote {export(options.file, options.to, options.output, options.place)}")
