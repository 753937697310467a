"""The results table: one row for each number or curve that the thesis publishes, and how it is judged.

`results/tolerances.csv` is written by hand; `report.csv` is the same rows with what was measured.
"""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.data.files import whole_or_absent
from cosserat.errors import InputError
from cosserat.parameters import Parameters, Quantity
from cosserat.table.readouts import READOUTS
from cosserat.units import to_si

Standing = Literal["reproduced", "erratum", "assumption", "not attempted"]
Kind = Literal["printed", "analytic", "in words", "literature"]

_LOOSE = 1e-3  # an error this small a share of its tolerance shows that the tolerance hides more than it allows


class Row(Parameters):
    """One published number or curve.

    published : the text exactly as printed, or what stands in its place where nothing is.
    kind : "printed" numbers are compared with that text; "analytic" ones with a closed form, the page's or another
    exact one; "in words" with what the sentence says; "literature" with what a source of the page measured and the page
    does not print.  In these three the read-out knows what is expected.
    claim : whether we say that the measured number lies within the tolerance.
    against : the published number of another row, in its SI unit, which the table names by its id; what is measured is
    then the distance of the read-out from that number, as a share of it.
    """

    id: str
    where: str
    quantity: str
    symbol: str = ""
    units: str
    published: str
    kind: Kind
    case: str = ""
    readout: str = ""
    tolerance: Annotated[float, Quantity("1", above=0)] | None = None
    tolerance_kind: Literal["abs", "rel"] | None = None
    claim: Literal["within", "outside"] | None = None
    why: str
    standing: Standing
    erratum: str = ""
    against: Annotated[float, Quantity("1", above=0)] | None = None

    @model_validator(mode="after")
    def _complete(self) -> Self:
        needed = ("case", "readout", "tolerance", "tolerance_kind", "claim")
        if self.standing == "not attempted":
            return self
        missing = [name for name in needed if not getattr(self, name)]
        if missing:
            raise PydanticCustomError(
                "incomplete", f"needs {', '.join(missing)} unless it is 'not attempted'"
            )
        if self.readout not in READOUTS:
            raise PydanticCustomError("readout", f"names the unknown read-out '{self.readout}'")
        if self.standing != "reproduced" and not self.erratum:
            raise PydanticCustomError(
                "erratum", f"stands as '{self.standing}' but names no entry of the errata"
            )
        if self.claim == "outside" and self.standing == "reproduced":
            raise PydanticCustomError("claim", "cannot stand as 'reproduced' outside its tolerance")
        return self

    @property
    def expected(self) -> float | None:
        """The published text as a number in the row's unit; None if a read-out has to say what is expected."""
        return to_si(self.published, self.units, unit_required=False) if self.kind == "printed" else None


class Judged(Parameters):
    """A row beside what was measured."""

    row: Row
    expected: float | None = None
    measured: float | None = None

    @property
    def error(self) -> float | None:
        """Distance of the measured number from the expected one, in the row's unit."""
        if self.measured is None or self.expected is None:
            return None
        return abs(self.measured - self.expected)

    @property
    def error_over_tolerance(self) -> float | None:
        """The error as a multiple of what the tolerance allows."""
        if self.error is None or self.expected is None or self.row.tolerance is None:
            return None
        scale = abs(self.expected) if self.row.tolerance_kind == "rel" else 1.0
        return self.error / (self.row.tolerance * scale) if scale else math.inf

    @property
    def holds(self) -> bool:
        """Whether the claim of the row is true; a number that is not finite makes no claim true."""
        ratio = self.error_over_tolerance
        if self.row.standing == "not attempted":
            return True
        if ratio is None or not math.isfinite(ratio):
            return False
        return (ratio <= 1) == (self.row.claim == "within")

    @property
    def verdict(self) -> str:
        """One or two words for the report."""
        if self.row.standing == "not attempted":
            return "not attempted"
        if not self.holds:
            return "FAILS"
        if self.row.claim == "outside":
            return "outside, as claimed"
        ratio = self.error_over_tolerance
        return "within, loose" if ratio is not None and 0 < ratio < _LOOSE else "within"


VERDICTS = ("within", "within, loose", "outside, as claimed", "not attempted", "FAILS")
REPORT_COLUMNS = (*Row.model_fields, "expected", "measured", "error", "error_over_tolerance", "verdict")


def read_table(path: Path) -> list[Row]:
    """The hand-written rows, in their order.

    Raises
    ------
    InputError : the file is missing, a row is not valid, or an id stands twice.
    """
    try:
        with path.open(encoding="utf-8", newline="") as file:
            lines = list(csv.DictReader(file))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(
            f"cannot read the table {path}: {error}; restore it from the repository"
        ) from None
    rows = []
    for number, line in enumerate(lines, start=2):
        name = f"{path}, row '{line.get('id') or number}'"
        given: dict[str, object] = {key: text for key, text in line.items() if text}
        if "against" in given:
            given["against"] = _published_by(line["against"], lines, name)
        rows.append(Row.read(given, name))
    if not rows:
        raise InputError(f"the table {path} has no rows; restore it from the repository")
    ids = [row.id for row in rows]
    twice = sorted({name for name in ids if ids.count(name) > 1})
    if twice:
        raise InputError(
            f"{path}: the id {', '.join(twice)} stands more than once; give each row its own"
        )
    return rows


def _published_by(wanted: str, lines: list[dict[str, str]], name: str) -> float:
    """The published number of the line with that id, in its SI unit; `name` is the row that asks."""
    for line in lines:
        if line.get("id") == wanted and line.get("kind") == "printed":
            return to_si(line["published"], line["units"], unit_required=False)
    raise InputError(f"{name}: 'against' is '{wanted}'; give the id of a row of kind 'printed'")


def write_report(judged: list[Judged], path: Path) -> None:
    """Write the joined table; numbers with six digits, which is more than any tolerance resolves."""
    lines = []
    for item in judged:
        line = {name: getattr(item.row, name) for name in Row.model_fields}
        for name in ("expected", "measured", "error", "error_over_tolerance"):
            line[name] = getattr(item, name)
        line["verdict"] = item.verdict
        lines.append({key: _cell(value) for key, value in line.items()})
    with whole_or_absent(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, REPORT_COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(lines)


def read_report(path: Path) -> list[dict[str, str]]:
    """The rows of a report, as texts.

    Raises
    ------
    InputError : there is no report yet, or it is not a whole one.
    """
    try:
        with path.open(encoding="utf-8", newline="") as file:
            reader = csv.DictReader(file)
            rows = list(reader)
    except OSError:
        raise InputError(
            f"there is no report {path}; make it with 'snakemake all' or 'cosserat measure'"
        ) from None
    except (UnicodeDecodeError, csv.Error):
        raise InputError(f"{path} is not a report; make one with 'cosserat measure'") from None
    whole = rows and tuple(reader.fieldnames or ()) == REPORT_COLUMNS
    if not whole or {row["verdict"] for row in rows} - set(VERDICTS):
        raise InputError(f"{path} is not a whole report; make it again with 'cosserat measure'")
    return rows


def _cell(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)
