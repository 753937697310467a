"""The manifest: every output as released, with digests of its bytes and of its content, its floor, and its rows.

The digest of the content leaves out what changes without a number changing.  Of a netCDF file it has names,
dimensions, units and values, and none of the file's attributes, which name the code and the versions.  Of a picture it
has the drawing to a tenth of a point, without the names that Matplotlib makes from digests.  The pages of the book are
not listed: they change with every sentence, and their numbers are those of the report.
"""

from __future__ import annotations

import csv
import hashlib
import io
import math
import re
from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import xarray as xr

from cosserat.cases.catalogue import published
from cosserat.data.content import digest_of_values
from cosserat.data.files import whole_or_absent
from cosserat.data.netcdf import load
from cosserat.data.variables import VARIABLES
from cosserat.errors import InputError
from cosserat.reading import read_text
from cosserat.studies.door import published_studies
from cosserat.thesis.figures.catalogue import FIGURES
from cosserat.thesis.stored import STUDIES
from cosserat.thesis.table.reference import variables_read
from cosserat.thesis.table.tolerances import Row

NAME = "manifest.csv"
REPORT, CHECK = "report.csv", "check.txt"

OF_A_TOLERANCE = 0.1
"""Change of a measured number that is allowed between machines, over the tolerance of its row."""
OF_A_POINT = 0.1
"""Change of a place in a picture that is allowed between machines, in points."""

_ASIDE = 0.0371  # of rounding, in points: places on round numbers are then not on its edges
_NUMBER = re.compile(r"(?<![#0-9a-f.])-?\d+\.?\d*(?:e-?\d+)?")  # and no part of a colour or of a name


@dataclass(frozen=True)
class Output:
    """One line of the manifest.

    path : from the folder of results.
    bytes, content : digests of the file as released, and of what is in it.
    reference : digest of the stored reference with which a changed content is compared; empty if there is none.
    floor : what counts as round-off.
    rows : ids of the rows of the results table that are read from it.
    """

    path: str
    bytes: str
    content: str
    reference: str
    floor: str
    rows: str


COLUMNS = tuple(field.name for field in fields(Output))


def expected(rows: Sequence[Row]) -> dict[str, tuple[str, str]]:
    """Path of every output, with its floor where it does not depend on the file, and its rows."""
    found = {f"cases/{name}.nc": ("", _rows_of(name, rows)) for name in published()}
    found |= {f"{STUDIES}/{name}.nc": ("", _rows_of(name, rows)) for name in published_studies()}
    for name, entry in FIGURES.items():
        places = "none, it draws round-off" if entry.round_off else f"places {OF_A_POINT:g} pt"
        found[f"figures/{name}.svg"] = (places, "")
    found[REPORT] = (f"measured {OF_A_TOLERANCE:g} of the row's tolerance", "all")
    found[CHECK] = ("the same text", "all")
    return found


def _rows_of(case: str, rows: Sequence[Row]) -> str:
    return " ".join(row.id for row in rows if row.case == case and row.standing != "not attempted")


def make(results: Path, reference: Path, rows: Sequence[Row]) -> list[Output]:
    """The manifest of a folder of results.

    Raises
    ------
    InputError : an output or a reference is missing or cannot be read.
    """
    return [
        _output(results, reference, path, floor, ids) for path, (floor, ids) in expected(rows).items()
    ]


def _output(results: Path, reference: Path, path: str, floor: str, ids: str) -> Output:
    file, stored = results / path, reference_of(path, reference)
    if path.endswith(".nc"):
        data = load(file, own=True)
        content, floor = digest_of_values(data), floors(data)
    else:
        content = content_of(file, round_off=is_round_off(path))
    return Output(path, digest(file), content, digest(stored) if stored else "", floor, ids)


def store_copies(results: Path, reference: Path) -> None:
    """Store the report and its summary beside the references of cases and studies.

    Raises
    ------
    InputError : one is missing or cannot be written.
    """
    for name in (REPORT, CHECK):
        content = _read(results / name)
        with whole_or_absent(reference / name) as temporary:
            temporary.write_bytes(content)


def reference_of(path: str, reference: Path) -> Path | None:
    """The stored reference of an output; None for a picture, which follows from its cases."""
    return None if path.endswith(".svg") else reference / Path(path).name


def is_round_off(path: str) -> bool:
    """Whether an output is a picture of round-off."""
    name = Path(path).stem
    return path.endswith(".svg") and name in FIGURES and FIGURES[name].round_off


def digest(file: Path) -> str:
    """SHA-256 of a file's bytes.

    Raises
    ------
    InputError : the file cannot be read.
    """
    return hashlib.sha256(_read(file)).hexdigest()


def _read(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {file} ({error.strerror}); make it with 'make'") from None


def content_of(file: Path, *, round_off: bool = False) -> str:
    """SHA-256 of what is in a file: values of a netCDF file, the drawing of a picture, else its bytes.

    round_off : take the form of the picture alone, without any place.

    Raises
    ------
    InputError : the file cannot be read.
    """
    if file.suffix == ".nc":
        return digest_of_values(load(file, own=True))
    if file.suffix != ".svg":
        return digest(file)
    form, places = drawing(_read(file).decode())
    parts = [form] if round_off else [form, *map(str, places)]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def drawing(svg: str) -> tuple[str, list[int]]:
    """An SVG without its places and the names that depend on them, and the places in tenths of a point."""
    form, numbers = structure(svg)
    return form, [math.floor((number + _ASIDE) / OF_A_POINT) for number in numbers]


def structure(svg: str) -> tuple[str, list[float]]:
    """An SVG without its numbers and the names that depend on them, and the numbers."""
    drawn = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    named = re.sub(r"[0-9a-f]{10}", "id", drawn)
    return _NUMBER.sub("0", named), [float(text) for text in _NUMBER.findall(named)]


def floors(data: xr.Dataset) -> str:
    """The floor of every variable of a Dataset with its unit."""
    known = {name: name for name in VARIABLES if name in data.variables} | variables_read(data)
    about = {name: VARIABLES[variable] for name, variable in known.items()}
    return "; ".join(f"{name} {one.floor:g} {one.units}" for name, one in about.items())


def write(outputs: Sequence[Output], path: Path) -> None:
    """Write the manifest."""
    with whole_or_absent(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(astuple(output) for output in outputs)


def read(path: Path) -> list[Output]:
    """The lines of a manifest.

    Raises
    ------
    InputError : there is none, or it is not a whole one.
    """
    try:
        header, *lines = csv.reader(io.StringIO(read_text(path)), strict=True)
    except (OSError, UnicodeDecodeError, csv.Error, ValueError) as error:
        raise InputError(
            f"cannot read the manifest {path} ({error}); restore it, or make it with 'cosserat manifest'"
        ) from None
    if tuple(header) != COLUMNS or any(len(line) != len(COLUMNS) for line in lines):
        raise InputError(f"{path} is not a whole manifest; make it again with 'cosserat manifest'")
    return [Output(*line) for line in lines]
