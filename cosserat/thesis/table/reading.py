"""What a read-out gives back."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Reading:
    """measured, in the unit of the row; expected, where not the published number itself is what is expected."""

    measured: float
    expected: float | None = None
