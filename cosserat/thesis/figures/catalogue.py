"""The list of figures, and how each is drawn from stored results."""

from __future__ import annotations

import csv
import importlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cosserat.errors import InputError
from cosserat.parameters import nearest
from cosserat.text import shortened
from cosserat.thesis.figures.entries import FIGURES
from cosserat.thesis.figures.entry import Entry

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


__all__ = ["FIGURES", "TABLE", "Entry", "draw", "draw_all", "draw_to", "entry"]

TABLE = Path("results/tolerances.csv")
"""The results table of the current checkout."""


def draw(name: str, data: Mapping[str, xr.Dataset], table: Path = TABLE) -> Figure:
    """Draw a figure from its Datasets by case name.

    table : the results table, read where the figure shows published numbers.

    Raises
    ------
    InputError : no figure of that name, or the table lacks a row that it shows.
    """
    from cosserat.figures.style import settings

    found = entry(name)
    module = importlib.import_module(f"cosserat.thesis.figures.{found.module}")
    published = (_published(found.rows, table),) if found.rows else ()
    tabulated = [_rows(table.parent / name) for name in found.tables]
    with settings():
        figure: Figure = getattr(module, name)(data, *published, *tabulated)
    return figure


def draw_to(name: str, folder: Path, path: Path, table: Path = TABLE) -> None:
    """Draw a figure from the files of cases and studies and the results table, and write it as SVG.

    folder : of the cases.

    Raises
    ------
    InputError : no figure of that name, or a file is missing or unreadable.
    """
    from cosserat.data.files import check_destination
    from cosserat.figures.style import write
    from cosserat.thesis.stored import stored

    check_destination(path, ".svg")
    found = entry(name)
    data = {case: stored(folder, case) for case in (*found.cases, *found.studies)}
    write(draw(name, data, table), path)


def _published(rows: tuple[str, ...], table: Path) -> dict[str, float]:
    """The published numbers of rows by their ids, in their SI units."""
    from cosserat.thesis.table.tolerances import read_table

    known = {row.id: row.expected for row in read_table(table) if row.expected is not None}
    missing = [name for name in rows if name not in known]
    if missing:
        raise InputError(f"{table} has no printed number {', '.join(missing)}; restore it")
    return {name: known[name] for name in rows}


def _rows(path: Path) -> list[dict[str, str]]:
    """The rows of a tracked table."""
    if not path.is_file():
        raise InputError(f"there is no {path}; restore it with 'git checkout {path}'")
    with path.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def draw_all(names: Sequence[str], folder: Path, output: Path) -> Iterator[Path]:
    """Draw figures one by one into the folder `output`, or one figure into the file; yields each path written.

    Raises
    ------
    InputError : as `draw_to`, or there are several figures and no such folder.
    """
    if len(names) > 1 and not output.is_dir():
        raise InputError(f"{output} is not a folder; make a folder for several figures first")
    for name in names:
        path = output / f"{name}.svg" if output.is_dir() else output
        draw_to(name, folder, path)
        yield path


def entry(name: str) -> Entry:
    """The entry of a figure.

    Raises
    ------
    InputError : no figure of that name.
    """
    if name not in FIGURES:
        raise InputError(f"there is no figure '{shortened(name)}'{nearest(name, list(FIGURES))}")
    return FIGURES[name]
