"""Derivatives of what read-outs do with values that move: rows of values with their rates, all rows at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cosserat.studies.readouts import ReadOut

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_EQUAL = 1e-13  # of the largest value, within which two are equal and the first one stands for both
_TIE = 1e-9
"""Of the largest value, within which a solve cannot tell which of two is larger: an equilibrium resolves its state to
about 1e-12, and strains and forces, which are differences of it between neighbours, to 1e-10.  Such a tie matters only
if the values change differently, by more than round-off: what a symmetry makes equal keeps its derivative."""
_SAME = 1e-6  # of the largest derivative, within which two are the same
_ZERO = 1e-9  # of its change with the step, below which a value is zero
_KINK = "its values have a kink there"


def reduced(one: ReadOut, values: Array, rates: Array, kinks: Mask) -> tuple[Array, dict[int, str]]:
    """The derivatives of a read-out, (R,), and why there is none, by row.

    values, rates : (R, L) of the L values that are left after components and places were taken.
    kinks : (R, L) where the values have no derivative.
    """
    over = "" if one.where is not None else one.over
    if one.size and not one.sized:
        kinks = kinks | (np.abs(values) < _ZERO * np.abs(rates))
        rates, values = rates * np.where(values < 0, -1.0, 1.0), np.abs(values)
    if over in ("max", "min"):
        return _extreme(1.0 if over == "max" else -1.0, values, rates, kinks)
    if over == "range":
        high, why = _extreme(1.0, values, rates, kinks)
        low, more = _extreme(-1.0, values, rates, kinks)
        return high - low, more | why
    why = _said(np.asarray(kinks.any(axis=-1)), _KINK)
    if over == "mean":
        return rates.mean(axis=-1), why
    if over == "norm":
        return _of_norm(values, rates, why)
    return rates[:, 0], why


def _said(rows: Mask, why: str) -> dict[int, str]:
    return dict.fromkeys(np.flatnonzero(rows).tolist(), why)


def _of_norm(values: Array, rates: Array, why: dict[int, str]) -> tuple[Array, dict[int, str]]:
    """The derivatives of roots of sums of squares."""
    norm = np.sqrt((values * values).sum(axis=-1))
    still = norm == 0
    found = (values * rates).sum(axis=-1) / np.where(still, 1.0, norm)
    return found, _said(still & rates.any(axis=-1), "a norm has none at zero") | why


def _extreme(sign: float, values: Array, rates: Array, kinks: Mask) -> tuple[Array, dict[int, str]]:
    """The derivatives of the largest values, or with a negative sign of the smallest."""
    over, size = sign * values, np.abs(values).max(axis=-1)
    below = over.max(axis=-1)[:, None] - over
    tied = below <= _TIE * size[:, None]
    first = (below <= _EQUAL * size[:, None]).argmax(axis=-1)
    found = np.take_along_axis(rates, first[:, None], axis=-1)[:, 0]
    away = np.abs(rates - found[:, None]).max(axis=-1, where=tied, initial=0.0)
    split = np.flatnonzero(away > _SAME * np.abs(rates).max(axis=-1) + _TIE * size)
    which = "largest" if sign > 0 else "smallest"
    why = {
        row: f"{tied[row].sum()} values share the {which} one and change differently"
        for row in split.tolist()
    }
    return found, why | _said((kinks & tied).any(axis=-1), _KINK)
