"""The result of a read-out."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Measurement:
    """measured, in the unit of the row; expected : None for the published number itself."""

    measured: float
    expected: float | None = None
