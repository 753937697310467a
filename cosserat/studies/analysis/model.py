"""Read-outs of a case as functions of some of its keys, with exact derivatives: for fits and designs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cosserat.cases.catalogue import Case
from cosserat.errors import InputError
from cosserat.studies.derivatives import Derivatives, Parameter, derivatives, parameter, sharp
from cosserat.studies.keys import case_with, read_value, table_of
from cosserat.studies.readouts import ReadOut
from cosserat.text import shown
from cosserat.threads import solving

Array = NDArray[np.float64]
Bounds = tuple[object, object] | Sequence[object] | None


@dataclass(frozen=True)
class Free:
    """A key that is sought.

    own : the key with its value in the case, where the search begins.  low, high : its range in SI units.
    """

    own: Parameter
    low: float
    high: float

    @property
    def path(self) -> str:
        """The path of the key."""
        return self.own.key.path

    @property
    def scale(self) -> float:
        """What the search counts in: the value in the case, or the width of the range where that is zero."""
        if self.own.value:
            return abs(self.own.value)
        width = self.high - self.low
        return width if np.isfinite(width) and width > 0 else 1.0


def free_keys(
    case: Case, free: Mapping[str, Bounds] | Sequence[str], name: str, *, bounded: bool
) -> tuple[Free, ...]:
    """The keys that are sought, with their ranges.

    free : paths, or paths with (low, high) each; numbers are in SI units.  bounded : whether each needs a range.

    Raises
    ------
    InputError : a key or a range is not valid, or the value in the case is outside it.
    """
    ranges = dict(free) if isinstance(free, Mapping) else dict.fromkeys(free)
    if not ranges:
        raise InputError(f"{name}: no key is free; name one, such as 'rod.material.young'")
    return tuple(_free(case, path, given, name, bounded=bounded) for path, given in ranges.items())


def _free(case: Case, path: str, given: Bounds, name: str, *, bounded: bool) -> Free:
    own = parameter(case.problem, path, name)
    quantity = own.key.quantity
    assert quantity is not None  # `parameter` takes no other
    if given is None:
        if bounded:
            raise InputError(f"{name}: '{path}' has no range; give (low, high)")
        least = quantity.above if quantity.at_least is None else quantity.at_least
        most = quantity.below if quantity.at_most is None else quantity.at_most
        return Free(own, float(least), float(most))
    if isinstance(given, str) or not isinstance(given, Sequence) or len(given) != 2:
        raise InputError(f"{name}: the range of '{path}' is {shown(given)}; give (low, high)")
    low, high = (
        float(str(read_value(own.key, item, f"{name}: the range of '{path}':", unit_required=False)))
        for item in given
    )
    if not low < high:
        raise InputError(
            f"{name}: the range of '{path}' from {low:g} to {high:g} is empty; give the lower end first"
        )
    if not low <= own.value <= high:
        raise InputError(
            f"{name}: '{path}' is {own.value:g} in the case, outside its range from {low:g} to {high:g}; begin inside"
        )
    return Free(own, low, high)


class Model:
    """Read-outs of one case at values of its free keys, its equilibria found to round-off."""

    def __init__(self, case: Case, free: Sequence[Free], read_outs: Sequence[ReadOut]) -> None:
        self.case, self.free, self.read_outs = case, tuple(free), tuple(read_outs)
        self._table = table_of(sharp(case.problem))

    def at(self, values: Array, conditions: Mapping[str, object] | None = None) -> Case:
        """The case at values of the free keys (k,) and of others.

        Raises
        ------
        InputError : they are not valid.
        """
        own = {one.path: float(value) for one, value in zip(self.free, values, strict=True)}
        return case_with(self.case, self._table, {**(conditions or {}), **own}, self.case.name)

    def read(
        self, values: Array, conditions: Mapping[str, object] | None = None, *, exact: bool = False
    ) -> Derivatives:
        """The read-outs there, and with `exact` their derivatives by the free keys.

        Raises
        ------
        CosseratError : there is no answer.
        """
        case = self.at(values, conditions)
        own = [parameter(case.problem, one.path, case.name) for one in self.free] if exact else []
        with solving():
            return derivatives(case.problem, own, self.read_outs, f"case '{case.name}'")
