"""Distributions of a key's value: uniform, log-uniform, normal, truncated normal; quantities with units."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from cosserat.errors import InputError
from cosserat.studies.keys import VariedKey
from cosserat.text import shown
from cosserat.units import to_si

Array = NDArray[np.float64]

LAWS = {
    "uniform": ("low", "high"),
    "log_uniform": ("low", "high"),
    "normal": ("mean", "deviation"),
    "truncated": ("mean", "deviation", "low", "high"),
}
"""The laws by the word that names them in a study, with their numbers; `truncated` is a normal one between bounds."""


@dataclass(frozen=True)
class Distribution:
    """A distribution of one number; law : a word of `LAWS`.  numbers : its numbers, in SI units."""

    law: str
    numbers: tuple[float, ...]

    def values(self, probabilities: Array) -> Array:
        """The values below which the probabilities (n,) lie, each in (0, 1): (n,)."""
        return np.asarray(_VALUES[self.law](self.numbers, probabilities))

    def with_deviation(self, deviation: float) -> Distribution:
        """The normal distribution with another standard deviation."""
        return replace(self, numbers=(self.numbers[0], deviation))


def _ndtr(x: Array | float) -> Array:
    from scipy.special import ndtr  # takes 0.2 s: only to draw members

    return np.asarray(ndtr(x))


def _ndtri(p: Array) -> Array:
    from scipy.special import ndtri

    return np.asarray(ndtri(p))


def _truncated(numbers: tuple[float, ...], probabilities: Array) -> Array:
    mean, deviation, low, high = numbers
    if low > mean:  # the other tail, where probabilities near one would lose their digits
        return np.asarray(-_truncated((-mean, deviation, -high, -low), 1 - probabilities))
    below, above = (_ndtr((bound - mean) / deviation) for bound in (low, high))
    return np.asarray(mean + deviation * _ndtri(below + (above - below) * probabilities)).clip(low, high)


_VALUES: Mapping[str, Callable[[tuple[float, ...], Array], Array]] = {
    "uniform": lambda numbers, p: numbers[0] + (numbers[1] - numbers[0]) * p,
    "log_uniform": lambda numbers, p: numbers[0] * np.exp(np.log(numbers[1] / numbers[0]) * p),
    "normal": lambda numbers, p: numbers[0] + numbers[1] * _ndtri(p),
    "truncated": _truncated,
}


def is_distribution(value: object) -> bool:
    """Whether a value of a study names a law."""
    return isinstance(value, Mapping) and len(value) == 1 and next(iter(value)) in LAWS


def distribution(
    key: VariedKey, value: Mapping[str, Any], study: str, *, unit_required: bool, own: bool
) -> Distribution:
    """The distribution of a key; study : in errors.

    own : whether it states its deviation; if not, a covariance does.

    Raises
    ------
    InputError : it is not one of `LAWS` with its numbers, or its range is empty.
    """
    law, given = next(iter(value.items()))
    where = f"{study}: '{key.path}', {law}:"
    if not key.is_number:
        raise InputError(
            f"{study}: '{key.path}' is no number, and so has no distribution; give a list of values"
        )
    names = LAWS[law][:1] if not own and law == "normal" else LAWS[law]
    if not isinstance(given, Sequence) or isinstance(given, str) or len(given) != len(names):
        raise InputError(f"{where} has {shown(given)}; it takes [{', '.join(names)}]")
    numbers = tuple(
        _number(item, key.unit, f"{where} '{name}'", unit_required=unit_required)
        for name, item in zip(names, given, strict=True)
    )
    found = dict(zip(names, numbers, strict=True))
    if "deviation" in found and not found["deviation"] > 0:
        raise InputError(f"{where} 'deviation' is {found['deviation']:g}; it must be above 0")
    if "high" in found and not found["low"] < found["high"]:
        raise InputError(
            f"{where} the range from {found['low']:g} to {found['high']:g} is empty; give the lower end first"
        )
    if law == "log_uniform" and not found["low"] > 0:
        raise InputError(f"{where} 'low' is {found['low']:g}; it must be above 0")
    return Distribution(law, numbers)


def _number(value: object, unit: str, where: str, *, unit_required: bool) -> float:
    try:
        return to_si(value, unit, unit_required=unit_required)
    except PydanticCustomError as error:
        raise InputError(f"{where} {error.message()}") from None


def correlated(probabilities: Array, correlation: Array) -> Array:
    """Probabilities (n, d) whose normal values have a correlation (d, d): a Gaussian copula.

    Raises
    ------
    numpy.linalg.LinAlgError : the correlation is not positive definite.
    """
    factor = np.linalg.cholesky(correlation)
    normal = _ndtri(probabilities)
    mixed = sum((normal[:, k, None] * factor.T[k] for k in range(len(factor))), np.zeros_like(normal))
    return np.asarray(_ndtr(mixed))
