"""What a printed input is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cosserat.units import to_si


@dataclass(frozen=True)
class Input:
    """One input as the page gives it.

    value : a number as printed, with its unit; or what a sentence says (a direction, what a support holds).
    where : the place.
    unit : SI unit of a number, "1" for a ratio; empty for all else.
    assumed : where the page is silent or ambiguous, the entry of the errata that says what we take.
    """

    value: object
    where: str
    unit: str = ""
    assumed: str = ""

    @property
    def si(self) -> float:
        """The number in its SI unit."""
        return to_si(self.value, self.unit, unit_required=False)

    @property
    def plain(self) -> object:
        """What a case must hold: the number in its SI unit, or the value itself."""
        return self.si if self.unit else self.value


Inputs = Mapping[str, Input]
"""Inputs of a case by their place in it, such as "rod.length"."""
