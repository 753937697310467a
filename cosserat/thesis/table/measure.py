"""Measure every row of the results table on the stored Datasets, and judge the claims."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import xarray as xr

from cosserat.errors import OutOfToleranceError
from cosserat.thesis.stored import stored
from cosserat.thesis.table.arithmetic import ARITHMETIC
from cosserat.thesis.table.readouts import READOUTS
from cosserat.thesis.table.tolerances import Judged, Row


def measure(rows: list[Row], folder: Path) -> list[Judged]:
    """Judge the rows on the files of cases and studies; folder : of the cases.

    Raises
    ------
    InputError : a file is missing, damaged, changed or of another case.
    """
    cases = sorted({row.case for row in rows if row.case and row.standing != "not attempted"})
    datasets = {case: stored(folder, case) for case in cases}
    return [judge(row, datasets) for row in rows]


def judge(row: Row, datasets: Mapping[str, xr.Dataset]) -> Judged:
    """One row with its measured number."""
    if row.standing == "not attempted":
        return Judged(row=row, expected=row.expected)
    if row.kind == "arithmetic":
        return Judged.model_construct(row=row, expected=row.expected, measured=ARITHMETIC[row.readout]())
    reading = READOUTS[row.readout](datasets[row.case])
    expected = row.expected if reading.expected is None else reading.expected
    measured = reading.measured if row.against is None else abs(reading.measured / row.against - 1)
    return Judged.model_construct(row=row, expected=expected, measured=measured)


_OUTCOME_WORDS = {
    "reproduced": "reproduced as printed",
    "erratum": "only with a misprint that the errata name",
    "assumption": "only under an assumption",
    "missed": "missed",
    "recomputed": "arithmetic on other numbers of the thesis",
    "not attempted": "not attempted",
}
"""Outcomes of a number in words, the best first."""


def outcomes(report: Sequence[Mapping[str, str]]) -> dict[str, str]:
    """Outcome of each number of the thesis, by the id of its first row: the best of its readings.

    report : the rows of a report of the thesis's own numbers, as texts.
    """
    order = list(_OUTCOME_WORDS)
    best: dict[str, str] = {}
    for row in report:
        number = row["reading_of"] or row["id"]
        missed = row["claim"] == "outside" and row["standing"] != "recomputed"
        outcome = "missed" if missed else row["standing"]
        best[number] = min(outcome, best.get(number, outcome), key=order.index)
    return best


def distance(row: Mapping[str, str]) -> float:
    """Relative error of a row; for a row that is itself a ratio, the difference."""
    expected, error = float(row["expected"]), float(row["error"])
    return error if row["against"] or not expected else error / abs(expected)


def summary(report: Sequence[Mapping[str, str]]) -> str:
    """Summary: outcomes of the thesis's numbers, errors of the missed ones, and our own rod separately."""
    lines = [sentence(report)]
    missed = _missed(report)
    if missed:
        lines.append(
            "Missed, in the nearest reading by: "
            + ", ".join(f"{number} {100 * fraction:.2g} %" for number, fraction in missed.items())
        )
    of_thesis = _of_thesis(report)
    solved = [row for row in of_thesis if row["standing"] not in ("recomputed", "not attempted")]
    first = [row for row in solved if not row["reading_of"]]
    lines.append(
        f"Other readings of the same numbers: {len(of_thesis) - len(outcomes(of_thesis))} rows; the first readings "
        f"meet {_count_within(first)} of {len(first)} computed numbers."
    )
    lines.append(
        _counted("Measurements of its sources", [r for r in report if r["kind"] == "literature"])
    )
    failed = sum(row["verdict"] == "FAILS" for row in report)
    lines.append(f"{len(report)} rows; {failed} claims fail")
    return "\n".join(lines)


def sentence(report: Sequence[Mapping[str, str]]) -> str:
    """The sentence of the README."""
    outcome = list(outcomes(_of_thesis(report)).values())
    parts = [
        f"{outcome.count(name)} {words}" for name, words in _OUTCOME_WORDS.items() if name in outcome
    ]
    missed = list(_missed(report).items())
    if missed:
        number, fraction = missed[0]
        worst = f"missed (the worst, {number}, by {100 * fraction:.2g} %)"
        parts = [part.replace("missed", worst) for part in parts]
    recomputed = [row for row in _of_thesis(report) if row["standing"] == "recomputed"]
    others = len(recomputed) - _count_within(recomputed)
    if others:
        parts = [
            f"{part} ({others} of them not as printed)" if "arithmetic" in part else part
            for part in parts
        ]
    own = [row for row in report if row["id"].startswith("C-")]
    return (
        f"Of the thesis's {len(outcome)} numbers, curves and statements: {', '.join(parts)}. "
        f"Of {len(own)} exact answers that judge our own rod it meets {_count_within(own)}."
    )


def _of_thesis(report: Sequence[Mapping[str, str]]) -> list[Mapping[str, str]]:
    return [row for row in report if not row["id"].startswith("C-") and row["kind"] != "literature"]


def _missed(report: Sequence[Mapping[str, str]]) -> dict[str, float]:
    """Numbers outside their tolerance in every reading, with the error of the nearest reading, largest first."""
    rows = _of_thesis(report)
    errors = {
        number: min(distance(row) for row in rows if number in (row["id"], row["reading_of"]))
        for number, outcome in outcomes(rows).items()
        if outcome == "missed"
    }
    return dict(sorted(errors.items(), key=lambda item: item[1], reverse=True))


def _counted(what: str, rows: Sequence[Mapping[str, str]]) -> str:
    return f"{what}: {len(rows)} rows, {_count_within(rows)} within their tolerance."


def _count_within(rows: Sequence[Mapping[str, str]]) -> int:
    return sum(row["claim"] == "within" for row in rows)


def check(report: list[dict[str, str]]) -> str:
    """The summary of a report in which every claim holds.

    Raises
    ------
    OutOfToleranceError : some claim does not hold; names each row, with its expected and its measured number.
    """
    failed = [
        f"{row['id']}: {row['quantity']}: published {row['published']}, expected {row['expected']} {row['units']}, "
        f"measured {row['measured']}, {row['error_over_tolerance']} of the tolerance, claimed '{row['claim']}'"
        + (f" at {row['found']} within {row['found_tolerance']}" if row["found"] else "")
        for row in report
        if row["verdict"] == "FAILS"
    ]
    if failed:
        raise OutOfToleranceError(
            "claims of the results table that do not hold:\n  " + "\n  ".join(failed)
        )
    return summary(report)
