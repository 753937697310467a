"""Annotations of parameters: quantities with unit and range, counts, lists, words, and values with own rules."""

from __future__ import annotations

import functools
import math
import numbers
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeGuard

import numpy as np
from numpy.typing import NDArray
from pydantic import GetCoreSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

from cosserat.text import brief, shown
from cosserat.units import NOTHING, sizes_in, to_si

FROM_FILE = {"units": "required"}
"""Validation context of values from a file: a number without its unit is an error."""


MOST_ITEMS = 1000
"""Most items of a list in a case, where nothing else is said."""


@dataclass(frozen=True)
class Quantity:
    r"""Annotation of a physical parameter: `length: Annotated[float, Quantity("m", r"\ell_0", above=0)]`.

    This is the one place where values become numbers.  Their sizes are those that make sense for the unit, by
    `cosserat.units.sizes_in`, if nothing narrower is given.

    unit : SI unit, "1" for a ratio.
    symbol, source : the letter of the thesis (LaTeX) and the equation or section it comes from.
    above, below, at_least, at_most : the range of the value.
    """

    unit: str
    symbol: str = ""
    source: str = ""
    above: float = -math.inf
    below: float = math.inf
    at_least: float | None = None
    at_most: float | None = None

    @functools.cached_property
    def least(self) -> float:
        """The least value; where the range is open, the bound itself."""
        smallest, largest = sizes_in(self.unit)
        if self.at_least is not None:
            return self.at_least
        return smallest if self.above == 0 else max(-largest, self.above)

    @functools.cached_property
    def most(self) -> float:
        """The largest value; where the range is open, the bound itself."""
        return min(sizes_in(self.unit)[1] if self.at_most is None else self.at_most, self.below)

    @property
    def range(self) -> str:
        """The range in words, in the SI unit."""
        bounds = [f"above {brief(self.above)}"] if math.isfinite(self.above) else []
        bounds += [f"at least {brief(self.least)}"] if self.least > self.above else []
        bounds += [
            f"at most {brief(self.most)}" if self.most < self.below else f"below {brief(self.below)}"
        ]
        return ", ".join(bounds)

    def check(self, value: object, info: core_schema.ValidationInfo) -> float:
        """Read and range-check one value."""
        return self.read(value, unit_required=from_file(info))

    def read(self, value: object, *, unit_required: bool) -> float:
        """Read and range-check one value; unit_required : whether a number needs its unit.

        Raises
        ------
        PydanticCustomError : it is not a number with such a unit, or out of range.
        """
        return self.checked(to_si(value, self.unit, unit_required=unit_required))

    def checked(self, number: float) -> float:
        """A number in the SI unit, if it is in the range.

        Raises
        ------
        PydanticCustomError : it is not.
        """
        fault = ""
        if number <= self.above:
            fault = f"above {brief(self.above)}"
        elif number >= self.below:
            fault = f"below {brief(self.below)}"
        elif self.at_least is not None and number < self.at_least:
            fault = f"at least {brief(self.at_least)}"
        elif not self.least <= number <= self.most:
            fault = self.range
        elif 0 < abs(number) < NOTHING and self.least <= 0:
            fault = f"0, or at least {brief(NOTHING)} in size"
        if fault:
            shown_number = f"{number:g}" if self.unit == "1" else f"{number:g} {self.unit}"
            raise PydanticCustomError("range", f"is {shown_number}; it must be {fault}")
        return number

    def holds(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Which of many numbers in the SI unit are in the range, as `checked` has it for one."""
        size = np.abs(values)
        found = (values > self.above) & (values < self.below)
        if self.at_least is not None:
            found &= values >= self.at_least
        found &= (self.least <= values) & (values <= self.most)
        if self.least <= 0:
            found &= (size == 0) | (size >= NOTHING)
        return found

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.with_info_plain_validator_function(self.check)


@dataclass(frozen=True)
class Count:
    """Annotation of a whole-number parameter with its least and its largest value."""

    symbol: str = ""
    source: str = ""
    at_least: int = 0
    at_most: int = 1_000_000

    def check(self, value: object) -> int:
        """Read and range-check one value."""
        if isinstance(value, bool) or not isinstance(value, numbers.Integral):
            raise PydanticCustomError("type", f"is {shown(value)}; it must be a whole number")
        if value < self.at_least:
            raise PydanticCustomError(
                "range", f"is {shown(int(value))}; it must be at least {self.at_least}"
            )
        if int(value) > self.at_most:
            raise PydanticCustomError(
                "range", f"is {shown(int(value))}; it must be at most {self.at_most}"
            )
        return int(value)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)


@dataclass(frozen=True)
class Items:
    """Annotation of a list: how many items it has; without this one, up to `MOST_ITEMS`."""

    at_least: int = 0
    at_most: int = MOST_ITEMS

    @property
    def range(self) -> str:
        """The range in words."""
        return f"{self.at_least} to {self.at_most}" if self.at_least else f"up to {self.at_most}"

    def count(self, items: int) -> None:
        """Raise PydanticCustomError if a list cannot have so many items."""
        if not self.at_least <= items <= self.at_most:
            raise PydanticCustomError(
                "items", f"has {items} item{'s' * (items != 1)}; it must have {self.range}"
            )

    def check(self, value: object) -> object:
        """Count the items of a list before they are read; what is no list is left to its own check."""
        if is_list(value):
            self.count(len(value))
        return value

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_before_validator_function(self.check, handler(source))


def is_list(value: object) -> TypeGuard[Sequence[Any]]:
    """Whether a value is a list, a tuple or an array."""
    return isinstance(value, list | tuple) or getattr(value, "ndim", 0) > 0


class Reader:
    """Base of annotations that read a value by a rule of their own; descriptions and schemas follow its forms."""

    @property
    def alternatives(self) -> Any:
        """The forms, as a type with annotations."""
        raise NotImplementedError

    @property
    def said(self) -> str:
        """The type in words, for a description; empty where the alternatives say it."""
        return ""

    def check(self, value: object, info: core_schema.ValidationInfo) -> object:
        """Read one value.

        Raises
        ------
        PydanticCustomError : it has none of these forms.
        """
        raise NotImplementedError

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.with_info_plain_validator_function(self.check)


def from_file(info: core_schema.ValidationInfo) -> bool:
    """Whether a value comes from a file, where a number needs its unit."""
    return info.context is not None and info.context.get("units") == "required"


@dataclass(frozen=True)
class OneOf:
    """Annotation of a word that names an entry of a registry."""

    registry: Mapping[str, object]

    def check(self, value: object) -> str:
        """Read one word."""
        if not isinstance(value, str) or value not in self.registry:
            known = " or ".join(map(repr, self.registry))
            raise PydanticCustomError("word", f"is {shown(value)}; it must be {known}")
        return value

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.check)
