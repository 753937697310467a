"""The results table: one row for each published number or curve of the thesis, with its judgement.

`results/tolerances.csv` is written by hand; `report.csv` has the same rows with the measured numbers.
"""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.data.files import whole_or_absent
from cosserat.errors import InputError
from cosserat.parameters import Parameters, Quantity
from cosserat.reading import read_text
from cosserat.units import to_si

Standing = Literal["reproduced", "erratum", "assumption", "recomputed", "not attempted"]
Kind = Literal["printed", "analytic", "in words", "literature", "arithmetic"]

_PRINTED_KINDS = ("printed", "arithmetic")  # kinds whose published text is the expected number
_LOOSE_RATIO = 1e-3  # ratio of error to tolerance below which the tolerance is loose


class Row(Parameters):
    """One published number or curve.

    published : the text exactly as printed, or a description if nothing is printed.
    kind : "printed" numbers are compared with that text; "analytic" ones with a closed form, the thesis's or another
    exact one; "in words" with the statement; "literature" with a measurement of a source of the thesis that it does
    not print.  In these three the read-out gives the expected number.  "arithmetic" numbers follow from others of the
    page: nothing is solved, no case is read, and their standing is "recomputed", which is less than "reproduced".
    claim : whether the measured number should lie within the tolerance.
    found, found_tolerance : for a claim outside it, the number measured instead, and its tolerance, both in the row's
    unit.
    reading_of : the row with the same published number in our reading; this row is another reading.
    against : the published number of another row, in its SI unit; the table gives that row's id.  The measured number
    is then the relative distance of the read-out from it.
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
    tolerance: Annotated[float, Quantity("1", above=0, at_least=1e-18)] | None = None
    tolerance_kind: Literal["abs", "rel"] | None = None
    claim: Literal["within", "outside"] | None = None
    found: Annotated[float, Quantity("1")] | None = None
    found_tolerance: Annotated[float, Quantity("1", above=0, at_least=1e-18)] | None = None
    why: str
    standing: Standing
    erratum: str = ""
    against: Annotated[float, Quantity("1", above=0)] | None = None
    reading_of: str = ""

    @model_validator(mode="after")
    def _complete(self) -> Self:
        from cosserat.thesis.table.arithmetic import (
            ARITHMETIC,
        )  # and the solvers, which a page has no need of
        from cosserat.thesis.table.readouts import READOUTS

        if self.standing == "not attempted":
            return self
        is_arithmetic = self.kind == "arithmetic"
        needed = [
            "readout",
            "tolerance",
            "tolerance_kind",
            "claim",
            *([] if is_arithmetic else ["case"]),
        ]
        missing = [name for name in needed if not getattr(self, name)]
        if missing:
            raise PydanticCustomError(
                "incomplete", f"needs {', '.join(missing)} unless it is 'not attempted'"
            )
        if self.readout not in (ARITHMETIC if is_arithmetic else READOUTS):
            raise PydanticCustomError("readout", f"names the unknown read-out '{self.readout}'")
        if is_arithmetic and self.case:
            raise PydanticCustomError(
                "case", f"is of kind 'arithmetic' but reads the case '{self.case}'; leave 'case' empty"
            )
        if is_arithmetic != (self.standing == "recomputed"):
            raise PydanticCustomError(
                "standing",
                f"is of kind '{self.kind}' and stands as '{self.standing}'; "
                "only rows of kind 'arithmetic', and all of them, have the standing 'recomputed'",
            )
        return self

    @model_validator(mode="after")
    def _two_sided(self) -> Self:
        if self.standing == "not attempted":
            return self
        if self.standing not in ("reproduced", "recomputed") and not self.erratum:
            raise PydanticCustomError(
                "erratum", f"stands as '{self.standing}' but names no entry of the errata"
            )
        if self.claim == "outside" and self.standing == "reproduced":
            raise PydanticCustomError("claim", "cannot stand as 'reproduced' outside its tolerance")
        given = [self.found is not None, self.found_tolerance is not None]
        if self.claim == "outside" and not all(given):
            raise PydanticCustomError(
                "found",
                "is claimed outside but does not say what is found there; give 'found' and 'found_tolerance'",
            )
        if self.claim == "within" and any(given):
            raise PydanticCustomError(
                "found",
                "is claimed within its tolerance; leave out 'found' and 'found_tolerance'",
            )
        return self

    @property
    def expected(self) -> float | None:
        """The published text as a number in the row's unit; None if the read-out gives the expected number."""
        if self.kind not in _PRINTED_KINDS:
            return None
        return to_si(self.published, self.units, unit_required=False)

    @property
    def ours(self) -> bool:
        """Whether the row is about the consistent rod and not about the thesis."""
        return self.id.startswith("C-")


class Judged(Parameters):
    """A row with its measured number."""

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
        """The error over the tolerance."""
        if self.error is None or self.expected is None or self.row.tolerance is None:
            return None
        scale = abs(self.expected) if self.row.tolerance_kind == "rel" else 1.0
        return self.error / (self.row.tolerance * scale) if scale else math.inf

    @property
    def holds(self) -> bool:
        """Whether the claim of the row is true; with a non-finite number it is not.

        A number claimed outside the published tolerance must lie outside it, and within `found_tolerance` of `found`.
        """
        ratio, row = self.error_over_tolerance, self.row
        if row.standing == "not attempted":
            return True
        if ratio is None or not math.isfinite(ratio) or self.measured is None:
            return False
        if row.claim == "within":
            return ratio <= 1
        assert row.found is not None
        assert row.found_tolerance is not None
        return ratio > 1 and abs(self.measured - row.found) <= row.found_tolerance

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
        return "within, loose" if ratio is not None and 0 < ratio < _LOOSE_RATIO else "within"


VERDICTS = ("within", "within, loose", "outside, as claimed", "not attempted", "FAILS")
REPORT_COLUMNS = (*Row.model_fields, "expected", "measured", "error", "error_over_tolerance", "verdict")


def read_table(path: Path) -> list[Row]:
    """The hand-written rows, in their order.

    Raises
    ------
    InputError : the file is missing, a row is not valid, or an id occurs twice.
    """
    try:
        lines = list(csv.DictReader(io.StringIO(read_text(path))))
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
            f"{path}: the id {', '.join(twice)} occurs more than once; give each row its own"
        )
    _check_readings(rows, path)
    return rows


def _check_readings(rows: list[Row], path: Path) -> None:
    """Check that each other reading names a first reading with the same published text."""
    known = {row.id: row for row in rows}
    for row in rows:
        if not row.reading_of:
            continue
        first = known.get(row.reading_of)
        if first is None or first.reading_of or first.published != row.published:
            raise InputError(
                f"{path}, row '{row.id}': 'reading_of' is '{row.reading_of}'; "
                "give the id of the first row with the same published text"
            )


def _published_by(wanted: str, lines: list[dict[str, str]], name: str) -> float:
    """The published number of the row with that id, in its SI unit; `name` : the row that refers to it."""
    for line in lines:
        if line.get("id") == wanted and line.get("kind") in _PRINTED_KINDS:
            return to_si(line["published"], line["units"], unit_required=False)
    raise InputError(f"{name}: 'against' is '{wanted}'; give the id of a row that prints a number")


def write_report(judged: list[Judged], path: Path) -> None:
    """Write the joined table; numbers with six digits, more than any tolerance resolves."""
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
        reader = csv.DictReader(io.StringIO(read_text(path)))
        rows = list(reader)
    except OSError as error:
        raise InputError(
            f"there is no report {path} ({error.strerror}); make it with 'snakemake all' or 'cosserat measure'"
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
