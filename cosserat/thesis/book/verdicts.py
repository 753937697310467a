"""Rows of the report and entries of the errata table, folded into a line that tells the verdict."""

from __future__ import annotations

import re
from collections.abc import Sequence

from IPython.display import HTML

from cosserat.errors import InputError, OutOfToleranceError
from cosserat.thesis.book.tables import prose, typeset
from cosserat.thesis.book.workflow import results
from cosserat.thesis.table.errata import Erratum, read_errata
from cosserat.thesis.table.tolerances import read_report

Row = dict[str, str]


def rows(*prefixes: str) -> HTML:
    """The rows of the report whose ids begin with the prefixes, folded; a failed row stops the chapter.

    A first prefix such as "T2.1" makes them the place to which links of Table 2.1 lead.

    Raises
    ------
    OutOfToleranceError : a claim does not hold.
    InputError : there is no such row.
    """
    found = [row for row in report() if row["id"].startswith(prefixes)]
    if not found:
        raise InputError(f"the report has no row that begins with {' or '.join(prefixes)}")
    failed = [row["id"] for row in found if row["verdict"] == "FAILS"]
    if failed:
        raise OutOfToleranceError(
            f"rows {', '.join(failed)} of the results table fail; see results/report.csv"
        )
    columns = ("verdict", "quantity", "printed text", "expected", "measured", "error / tolerance", "row")
    head = "".join(f'<th scope="col">{name}</th>' for name in columns)
    body = "".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in _cells(row))}</tr>" for row in found)
    shown = (
        f'<table class="rows" tabindex="0"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'
    )
    name = re.fullmatch(r"T(\d\.\d)", prefixes[0])
    anchor = f' id="table-{name[1]}"' if name else ""
    return HTML(f'<details class="verdict"{anchor}><summary>{verdict(found)}</summary>{shown}</details>')


def _cells(row: Row) -> tuple[str, ...]:
    """The cells of a row of the report as HTML."""
    return (
        row["verdict"],
        typeset(row["quantity"]),
        typeset(row["published"]),
        amount(row["expected"], row["units"]),
        amount(row["measured"], row["units"]),
        f"{float(row['error_over_tolerance']):.2f}",
        row["id"],
    )


def verdict(found: Sequence[Row]) -> str:
    """One line for several rows: how many claims hold, and how near the worst is to its tolerance."""
    count = f"{len(found)} rows" if len(found) > 1 else "1 row"
    within = [float(row["error_over_tolerance"]) for row in found if row["verdict"].startswith("within")]
    outside = len(found) - len(within)
    parts = [f"{len(within)} within tolerance, the worst at {max(within):.2f} of it"] if within else []
    parts += [f"{outside} outside, as claimed"] if outside else []
    return f"{count} of the results table: {'; '.join(parts)}"


def report() -> list[Row]:
    """All rows of the report."""
    return list(read_report(results() / "report.csv"))


def today() -> tuple[str, ...]:
    """What `cosserat check` says of the report, line by line."""
    from cosserat.thesis.table.measure import check  # two pages need it

    return tuple(check(report()).splitlines())


def overview() -> tuple[str, ...]:
    """The counts of the report by kind and standing, line by line."""
    from cosserat.thesis.table.measure import summary

    return tuple(summary(report()).splitlines())


def unseen_changes() -> list[tuple[str, str]]:
    """Changes of inputs and physics that no row of the table notices, and why."""
    from cosserat.thesis.table.power import changes

    return [(change.what, change.unseen) for change in changes() if change.unseen]


def row(name: str) -> Row:
    """One row of the report by its id.

    Raises
    ------
    InputError : there is no such row.
    """
    found = {row["id"]: row for row in report()}
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
        f"<p>{prose(known[name].where)}. Printed: {prose(known[name].printed)}. "
        f"Here: {prose(assumed(known[name].corrected))}.</p>"
        f"<p>{prose(known[name].why)}</p><p>With its test: {name}.</p></details>"
        for name in names
    ]
    return HTML(f'<aside class="misprints">{"".join(notes)}</aside>')


def assumed(text: str) -> str:
    """A text of the errata table as a sentence: its mark of an assumption in words."""
    return text.replace("ASSUME ", "we assume ")


_STANDINGS = {
    "erratum": "Misprint",
    "assumption": "Assumption",
    "question": "Open question",
    "refuted": "Not a misprint:",
}
