"""The rigid part of a change of degrees of freedom (DOFs) that are components of vectors of one space."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.solvers.banded import Vector

Fields = NDArray[np.float64]

_RIGID = 0.1  # share of a change below which what deforms is called hardly anything


@njit(cache=True)
def _remove(part: Vector, x: Vector) -> None:
    """Make x orthogonal to part."""
    share, size = 0.0, 0.0
    for i in range(x.size):
        share += part[i] * x[i]
        size += part[i] * part[i]
    for i in range(x.size):
        x[i] -= share / size * part[i]


@njit(cache=True)
def deforming_part(
    change: Vector, middle: Vector, translations: Fields, rotations: Fields, z: Vector
) -> bool:
    """z: a change less its rigid part at the midpoint, the change itself where no translations are free.

    rotations : (d (d - 1) / 2, n) is overwritten.  DOFs are components of vectors of a space of dimension d, the number
    of translations.  True where hardly anything is left.
    """
    z[:] = change
    dimension = translations.shape[0]
    if dimension == 0:
        return False
    number = 0
    for a in range(dimension):
        for b in range(a + 1, dimension):
            spin = rotations[number]
            spin[:] = 0.0
            for i in range(0, change.size, dimension):
                spin[i + a], spin[i + b] = -middle[i + b], middle[i + a]
            for _ in range(2):  # twice: far from the origin a rotation is nearly a translation
                for k in range(dimension):
                    _remove(translations[k], spin)
                for k in range(number):
                    _remove(rotations[k], spin)
            number += 1
    for _ in range(2):
        for k in range(dimension):
            _remove(translations[k], z)
        for k in range(number):
            _remove(rotations[k], z)
    return bool((z * z).sum() < _RIGID**2 * (change * change).sum())
