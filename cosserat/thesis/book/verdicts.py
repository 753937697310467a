"""Rows of the report and entries of the errata table, folded into a line that tells the verdict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

from IPython.display import HTML

from cosserat.errors import InputError, OutOfToleranceError
from cosserat.thesis.book.tables import mathematics, table
from cosserat.thesis.book.workflow import results
from cosserat.thesis.table.errata import Erratum, read_errata
from cosserat.thesis.table.tolerances import read_report

Row = Mapping[str, str]


def rows(*prefixes: str) -> HTML:
    """The rows of the report whose ids begin with the prefixes, folded; a failed row stops the chapter.

    Raises
    ------
    OutOfToleranceError : a claim does not hold.
    InputError : there is no such row.
    """
    found = [row for row in _report() if row["id"].startswith(prefixes)]
    if not found:
        raise InputError(f"the report has no row that begins with {' or '.join(prefixes)}")
    failed = [row["id"] for row in found if row["verdict"] == "FAILS"]
    if failed:
        raise OutOfToleranceError(
            f"rows {', '.join(failed)} of the results table fail; see results/report.csv"
        )
    lines = [
        [
            row["verdict"],
            row["quantity"],
            row["published"],
            amount(row["expected"], row["units"]),
            amount(row["measured"], row["units"]),
            f"{float(row['error_over_tolerance']):.2f}",
            row["id"],
        ]
        for row in found
    ]
    columns = ("verdict", "quantity", "printed text", "expected", "measured", "error / tolerance", "row")
    body = table(lines, columns).data
    return HTML(f'<details class="verdict"><summary>{verdict(found)}</summary>{body}</details>')


def verdict(found: Sequence[Row]) -> str:
    """One line for several rows: how many claims hold, and how near the worst is to its tolerance."""
    count = f"{len(found)} rows" if len(found) > 1 else "1 row"
    within = [float(row["error_over_tolerance"]) for row in found if row["verdict"] == "within"]
    outside = len(found) - len(within)
    parts = [f"{len(within)} within tolerance, the worst at {max(within):.2f} of it"] if within else []
    parts += [f"{outside} outside, as claimed"] if outside else []
    return f"{count} of the results table: {'; '.join(parts)}"


def row(name: str) -> Row:
    """One row of the report by its id.

    Raises
    ------
    InputError : there is no such row.
    """
    found = {row["id"]: row for row in _report()}
    if name not in found:
        raise InputError(f"the report has no row '{name}'")
    return found[name]


def amount(number: str, unit: str) -> str:
    """A number of the report with four digits and its unit."""
    return f"{float(number):.4g}" + ("" if unit == "1" else f"\u00a0{unit}")


def errata(*standings: str) -> dict[str, Erratum]:
    """The entries of the errata table with one of the standings, or all."""
    known = read_errata(results() / "errata.toml")
    return {name: item for name, item in known.items() if not standings or item.standing in standings}


def misprint(*names: str) -> HTML:
    """A note beside the text that folds: what is printed, what is right, and why, from the errata table.

    Raises
    ------
    InputError : there is no such entry.
    """
    known = errata()
    missing = [name for name in names if name not in known]
    if missing:
        raise InputError(f"the errata table has no entry {', '.join(missing)}")
    notes = [
        f'<details class="misprint"><summary>{_STANDINGS[known[name].standing]} {name}</summary>'
        f"<p>{escape(known[name].where)}. Printed: {mathematics(escape(known[name].printed))}. "
        f"Here: {mathematics(escape(known[name].corrected))}.</p>"
        f"<p>{mathematics(escape(known[name].why))}</p></details>"
        for name in names
    ]
    return HTML(f'<aside class="misprints">{"".join(notes)}</aside>')


_STANDINGS = {
    "erratum": "Misprint",
    "assumption": "Assumption",
    "question": "Open question",
    "refuted": "Not a misprint:",
}


def _report() -> list[Row]:
    return list(read_report(results() / "report.csv"))
