"""Measure every row of the results table on the stored Datasets, and judge the claims."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import xarray as xr

from cosserat.data.dataset import load
from cosserat.errors import InputError, OutOfToleranceError
from cosserat.table.readouts import READOUTS
from cosserat.table.tolerances import Judged, Row


def measure(rows: list[Row], folder: Path) -> list[Judged]:
    """Judge the rows on the files `<case>.nc` of a folder.

    Raises
    ------
    InputError : a file is missing, unreadable or of another case.
    """
    cases = sorted({row.case for row in rows if row.standing != "not attempted"})
    datasets = {case: load(folder / f"{case}.nc") for case in cases}
    for case, data in datasets.items():
        if data.attrs.get("case") != case:
            raise InputError(
                f"{folder / case}.nc holds the case {data.attrs.get('case')!r}; run '{case}' again"
            )
    return [judge(row, datasets) for row in rows]


def judge(row: Row, datasets: Mapping[str, xr.Dataset]) -> Judged:
    """One row beside its measured number."""
    if row.standing == "not attempted":
        return Judged(row=row, expected=row.expected)
    reading = READOUTS[row.readout](datasets[row.case])
    expected = row.expected if reading.expected is None else reading.expected
    measured = reading.measured if row.against is None else abs(reading.measured / row.against - 1)
    return Judged.model_construct(row=row, expected=expected, measured=measured)


def summary(verdicts: list[str], standings: list[str]) -> str:
    """How many rows stand how, and how many claims fail."""
    counts = [f"{standings.count(name)} {name}" for name in dict.fromkeys(standings)]
    return f"{len(standings)} rows: {', '.join(counts)}; {verdicts.count('FAILS')} claims fail"


def check(report: list[dict[str, str]]) -> str:
    """A summary of a report whose claims all hold.

    Raises
    ------
    OutOfToleranceError : some claim does not hold; names each row, what was expected and what was measured.
    """
    failed = [
        f"{row['id']}: {row['quantity']}: published {row['published']}, expected {row['expected']} {row['units']}, "
        f"measured {row['measured']}, {row['error_over_tolerance']} of the tolerance, claimed '{row['claim']}'"
        for row in report
        if row["verdict"] == "FAILS"
    ]
    if failed:
        raise OutOfToleranceError(
            "claims of the results table that do not hold:\n  " + "\n  ".join(failed)
        )
    return summary([row["verdict"] for row in report], [row["standing"] for row in report])
