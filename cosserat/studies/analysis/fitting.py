"""Fits as tables of a case file: their keys, and what `cosserat fit` does."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Annotated, Any, Literal

import xarray as xr

from cosserat.cases.catalogue import find_base, fit_tables
from cosserat.data.content import stamped
from cosserat.data.files import check_destination
from cosserat.data.locks import only_writer
from cosserat.data.netcdf import check_replaceable, save
from cosserat.errors import InputError, path_of
from cosserat.limits import Limits, Watched
from cosserat.parameters import Items, Parameters, nearest
from cosserat.progress import bar
from cosserat.solvers.heartbeat import listening
from cosserat.studies.analysis.fit import fit
from cosserat.studies.study import flattened
from cosserat.text import Title, printable, shortened


class Fit(Parameters):
    """A fit of some keys of a case to measured data.

    [stiffness]
    kind = "fit"
    of = "cantilever"                                        # where the search begins
    data = "measured.csv"                                    # forces.0.force [N], tip [mm], tip_deviation [mm]
    free.rod.material.young = ["0.1 GPa", "10 GPa"]          # ranges; or a list of keys without
    keep.tip = "u.E2 at last"                                # what was measured, by the columns of the data
    deviations.tip = "0.5 mm"                                # where the data have no column of them
    """

    kind: Literal["fit"] = "fit"
    title: Title = ""
    """Description in a few words; the name by default."""
    source: Title = ""
    """Its place in a publication, or its origin."""
    of: str
    """Name of the case whose keys are fitted."""
    data: str
    """Name of a CSV file: keys that differ from row to row, and what was measured, each with its unit in brackets."""
    free: dict[str, Any] | Annotated[tuple[str, ...], Items(1, 1000)]
    """The keys that are sought with their ranges, or a list of them."""
    keep: dict[str, str]
    """Read-outs by name, which are columns of the data."""
    deviations: dict[str, str | float] = {}  # noqa: RUF012 - pydantic copies it
    """Standard deviations of read-outs that have no column of them."""

    @property
    def ranges(self) -> dict[str, Any] | list[str]:
        """The free keys by their paths."""
        return list(self.free) if isinstance(self.free, tuple) else dict(flattened(self.free))


def fitted(name: str, file: str | Path) -> xr.Dataset:
    """The fit of that name in a case file.

    Raises
    ------
    InputError : there is no such fit, or it is not valid.
    CosseratError : it has no answer.
    """
    tables = fit_tables(file)
    if name not in tables:
        raise InputError(f"there is no fit '{shortened(name)}' in {file}{nearest(name, list(tables))}")
    read = Fit.read(tables[name], f"fit '{shortened(name)}'")
    folder = path_of(file).parent
    found = fit(
        find_base(read.of, file), folder / read.data, read.ranges, read.keep, deviations=read.deviations
    )
    about = {"title": read.title or name, "comment": read.source or "a fit of the user"}
    return stamped(found.assign_attrs(about))


def command(options: argparse.Namespace) -> None:
    """Solve a fit of a case file, write its Dataset and print the estimates."""
    given = Path() if options.output is None else options.output
    path = given / f"{options.fit}.nc" if os.path.isdir(given) else given
    check_destination(path, ".nc", inputs=(options.file,))
    check_replaceable(path)
    name = f"fit '{shortened(options.fit)}'"
    with only_writer(path), bar(options.fit) as report, listening(Watched(report, Limits(), name).hear):
        found = fitted(options.fit, options.file)
        save(found, path)
    print(printable(f"{options.fit}: {found.attrs['title']}"))
    for word in map(str, found["parameter"].to_numpy()):
        value, error, low, high = (
            found[f"{word}{end}"].item() for end in ("", "_error", "_low", "_high")
        )
        unit = found[word].attrs["units"]
        print(
            f"  {word} = {value:.6g} {unit}, standard error {error:.2g}, 95 % from {low:.6g} to {high:.6g}"
        )
    chi = found.attrs["reduced_chi_square"]
    print(f"  {found.attrs['degrees_of_freedom']} degrees of freedom, reduced chi square {chi:.3g}")
    for warning in filter(None, found.attrs["warnings"].split("\n")):
        print(printable(f"  warning: {warning}"))
    print(f"  written to {path}")
