"""Inputs printed in the thesis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cosserat.units import to_si


@dataclass(frozen=True)
class Input:
    """One input as the thesis gives it.

    value : a number as printed, with its unit; or the content of a sentence (a direction, the DOFs of a support).
    where : the place.
    unit : SI unit of a number, "1" for a ratio; empty for other values.
    assumed : if the thesis is silent or ambiguous, the entry of the errata with our assumption.
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
        """The value for a case: the number in its SI unit, or the value itself."""
        return self.si if self.unit else self.value


Inputs = Mapping[str, Input]
"""Inputs of a case by their place in it, such as "rod.length"."""
