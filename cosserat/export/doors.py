"""`cosserat export`: a result as a file of another format."""

from __future__ import annotations

from pathlib import Path

from cosserat.data.dataset import content_of, holding_what_is_needed
from cosserat.data.files import check_destination
from cosserat.data.netcdf import existing, load
from cosserat.errors import InputError, path_of
from cosserat.export.table import write_csv
from cosserat.export.vtk import instant_of, write_vtk
from cosserat.text import shortened

_FORMATS = {".csv": "csv", ".vtu": "vtk", ".pvd": "vtk"}


def export(file: Path, to: str | None, output: Path | None, place: str | None) -> Path:
    """Write the result in a file as CSV or for VTK, and return the path of what was written.

    to : "csv" or "vtk"; by default as the output's name ends.
    output : the file to write, or a folder; by default a file beside the result.
    place : of a table, the place whose rows are written.

    Raises
    ------
    InputError : neither format nor ending says what to write, or a file cannot be read or written.
    """
    file = existing(file)
    output = None if output is None else path_of(output)
    named = None if output is None or output.is_dir() else output
    folder = file.parent if output is None else output
    if to is None and named is not None:
        to = _FORMATS.get(named.suffix)
    if to is None:
        raise InputError(
            "nothing says what to write; add '--to csv' or '--to vtk', or give a name that ends in '.csv', '.vtu' or "
            "'.pvd' with --output"
        )
    if place is not None and to != "csv":
        raise InputError(
            f"'--place {shortened(place)}' chooses rows of a table; leave it out, or write csv"
        )
    dataset = load(file)
    if to == "vtk" and (content := content_of(dataset)):
        raise InputError(
            f"{file} holds {content}, without a body; write csv, or the body of one case: 'cosserat run CASE', of a "
            "study 'cosserat run STUDY --member NUMBER'"
        )
    ending = "csv" if to == "csv" else "vtu" if instant_of(dataset) is None else "pvd"
    path = named or folder / f"{file.stem}.{ending}"
    check_destination(path, inputs=(file,))
    with holding_what_is_needed(dataset, "its table" if to == "csv" else "its mesh"):
        if to == "csv":
            write_csv(dataset, path, place)
        else:
            write_vtk(dataset, path)
    return path
