"""What became of every output of the manifest on this machine: the same bytes, the same values, or by how much not."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from cosserat.data.netcdf import load
from cosserat.errors import CosseratWarning, InputError, OutOfToleranceError
from cosserat.thesis.outputs.manifest import (
    CHECK,
    NAME,
    OF_A_TOLERANCE,
    REPORT,
    Output,
    content_of,
    digest,
    is_round_off,
    read,
    reference_of,
)
from cosserat.thesis.table.reference import compare
from cosserat.thesis.table.tolerances import read_report

SAME_BYTES, SAME_VALUES, WITHIN = "same bytes", "same values", "within its floor"
DIFFERS, MISSING = "differs", "missing"
WORDS = (SAME_BYTES, SAME_VALUES, WITHIN, DIFFERS, MISSING)
"""The verdicts, the best first."""


@dataclass(frozen=True)
class Verdict:
    """What became of one output, in a word of `WORDS` and its reason."""

    path: str
    word: str
    reason: str = ""

    def __str__(self) -> str:
        return f"{self.word:17} {self.path}{self.reason and f': {self.reason}'}"


def verify(outputs: Sequence[Output], results: Path, reference: Path) -> list[Verdict]:
    """The verdict on every output of a manifest; changed contents are compared with the stored references."""
    return [_verdict(output, results / output.path, reference) for output in outputs]


def warn_unless_released(results: Path, paths: Sequence[str]) -> None:
    """Warn of outputs in a folder of results that differ from those of its manifest; without a manifest, of none.

    A digest is no signature: whoever changes a result can compute it anew.  The manifest is tracked with the code.
    """
    reference = results / "reference"
    if not (reference / NAME).is_file():
        return
    for output in read(reference / NAME):
        if output.path not in paths:
            continue
        found = _verdict(output, results / output.path, reference)
        if found.word == DIFFERS:
            warnings.warn(
                f"{results / output.path} is not as released: {found.reason}; if neither its case nor the code was "
                "changed, delete it and make it again",
                CosseratWarning,
                stacklevel=2,
            )


def conclude(verdicts: Sequence[Verdict]) -> str:
    """The summary of verdicts of which none is bad.

    Raises
    ------
    OutOfToleranceError : an output differs or is missing.
    """
    counts = Counter(verdict.word for verdict in verdicts)
    counted = ", ".join(f"{counts[word]} {word}" for word in WORDS if counts[word])
    summary = f"{len(verdicts)} outputs: {counted}"
    if counts[DIFFERS] or counts[MISSING]:
        raise OutOfToleranceError(f"{summary}; these are not the results as released")
    return summary


def _verdict(output: Output, file: Path, reference: Path) -> Verdict:
    if not file.exists():
        return Verdict(output.path, MISSING, "'make' makes it")
    try:
        if digest(file) == output.bytes:
            return Verdict(output.path, SAME_BYTES)
        if content_of(file, round_off=is_round_off(output.path)) == output.content:
            return Verdict(output.path, SAME_VALUES)
        word, reason = _compared(output, file, reference)
    except InputError as error:
        word, reason = DIFFERS, str(error)
    return Verdict(output.path, word, reason)


def _compared(output: Output, file: Path, reference: Path) -> tuple[str, str]:
    """Verdict and reason of an output whose content is not as released.

    Raises
    ------
    InputError : it cannot be read, or not be compared with its reference.
    """
    stored = reference_of(output.path, reference)
    if stored is None:
        return DIFFERS, f"the drawing moved ({output.floor})"
    if digest(stored) != output.reference:
        return DIFFERS, f"{stored} is not the reference of the manifest; renew that: 'cosserat manifest'"
    if output.path == REPORT:
        return _compared_reports(file, stored)
    if output.path == CHECK:
        return DIFFERS, f"compare it with {stored}"
    changes = compare(load(file, own=True), load(stored, own=True))
    worst = max(changes, key=lambda change: change.largest / change.allowed)
    if not worst.largest:
        return WITHIN, "no value that the reference keeps changed"
    share = f"{worst.largest / worst.allowed:.2g} of what is allowed"
    return WITHIN if worst.held else DIFFERS, f"{share}, {worst}"


def _compared_reports(file: Path, stored: Path) -> tuple[str, str]:
    """Rows and verdicts have to be the same; measured numbers may change by a part of the row's tolerance."""
    fresh, old = read_report(file), read_report(stored)
    if [row["id"] for row in fresh] != [row["id"] for row in old]:
        return DIFFERS, "it has other rows"
    turned = [
        f"{new['id']}: {new['verdict']}"
        for new, row in zip(fresh, old, strict=True)
        if new["verdict"] != row["verdict"]
    ]
    if turned:
        return DIFFERS, f"other verdicts: {', '.join(turned)}"
    changes = [(_moved(new, row), new["id"]) for new, row in zip(fresh, old, strict=True)]
    largest, row = max(changes)
    reason = f"{row} moved by {largest:.2g} of its tolerance (allowed {OF_A_TOLERANCE:g})"
    return WITHIN if largest <= OF_A_TOLERANCE else DIFFERS, reason


def _moved(new: dict[str, str], old: dict[str, str]) -> float:
    """Change of a row's measured and expected numbers over its tolerance."""
    if not old["tolerance"]:
        return 0.0
    scale = abs(float(old["expected"])) if old["tolerance_kind"] == "rel" else 1.0
    change = sum(abs(float(new[key]) - float(old[key])) for key in ("measured", "expected"))
    return change / (float(old["tolerance"]) * scale) if change else 0.0
