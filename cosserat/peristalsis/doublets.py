"""Longitudinal muscles as opposed forces along the centreline, section 2.2: doublets of finite width and their limit.

A muscle at gamma contracts its neighbourhood: forces of resultant P push forward on half a window of width w behind
gamma and backward on the half before it.  Their limit as w tends to zero is the doublet (2.2.1).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def load(xi: Array, centres: Array, width: float, strength: float) -> Array:
    """rho_0 f_A . e_3 of equal muscles, eqs. (2.2.1) and (2.2.5) with windows of finite width [N/m].

    xi, centres : places [m].  width : of each window [m].  strength : P [N].
    """
    offset = xi[:, None] - centres[None, :]
    inside = np.abs(offset) <= width / 2
    density: Array = -np.sign(offset) * inside * (2 * strength / width)
    total: Array = density.sum(axis=1)
    return total


def contact_force(xi: Array, centres: Array, width: float, strength: float) -> Array:
    """n . e_3 that balances these loads in a rod with free ends, eq. (2.2.6) [N].

    Each muscle adds a tent of height -P: with centres half a window apart the tents sum to -P between the first and
    the last, which is (2.2.7), and fall to zero within half a window beyond: there a force P acts on either end.
    """
    offset = np.abs(xi[:, None] - centres[None, :])
    tents = np.clip(1 - 2 * offset / width, 0.0, None)
    force: Array = -strength * tents.sum(axis=1)
    return force


def row(begin: float, end: float, count: int) -> tuple[Array, float]:
    """Centres of `count` muscles that fill a window, half their own window apart, and the width of each [m]."""
    spacing = (end - begin) / (count + 1)
    return np.asarray(begin + spacing * np.arange(1.0, count + 1)), 2 * spacing
