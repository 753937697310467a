"""Points of the unit cube: Sobol, Latin hypercube, and designs for the indices of Sobol and Morris."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import InputError

Array = NDArray[np.float64]
_BITS = 30
_LEVELS = 4  # of the grid of Morris


@dataclass(frozen=True)
class Points:
    """Points (n, d) in the open unit cube, and what else is known of each, by name, (n,)."""

    cube: Array
    about: Mapping[str, NDArray[np.int64]] = field(default_factory=dict)


def _sobol(count: int, keys: int, seed: int) -> Array:
    from scipy.stats import qmc

    if count & (count - 1):
        below = 1 << (count.bit_length() - 1)
        raise InputError(
            f"has {count} points; Sobol points are balanced for powers of two: take {below} or {2 * below}"
        )
    found: Array = qmc.Sobol(keys, scramble=True, bits=_BITS, rng=np.random.default_rng(seed)).random(
        count
    )
    return found + 2.0 ** -(_BITS + 1)  # the middles of the cells, so that no probability is 0


def sobol(count: int, keys: int, seed: int) -> Points:
    """Scrambled Sobol points; the first ones of a larger count are the same."""
    return Points(_sobol(count, keys, seed))


def latin_hypercube(count: int, keys: int, seed: int) -> Points:
    """A Latin hypercube; another count has other points."""
    from scipy.stats import qmc

    return Points(qmc.LatinHypercube(keys, rng=np.random.default_rng(seed)).random(count))


def saltelli(count: int, keys: int, seed: int) -> Points:
    """Of each of `count` base points: A, B, and A with one column of B each (Saltelli et al. 2010).

    Another power of two appends base points.
    """
    both = _sobol(count, 2 * keys, seed)
    a, b = both[:, :keys], both[:, keys:]
    rows = np.repeat(a[:, None], keys + 2, axis=1)
    rows[:, 1] = b
    for k in range(keys):
        rows[:, 2 + k, k] = b[:, k]
    base, matrix = np.divmod(np.arange(count * (keys + 2)), keys + 2)
    return Points(rows.reshape(-1, keys), {"base": base, "matrix": matrix})


def morris(count: int, keys: int, seed: int) -> Points:
    """`count` trajectories, each changes one key after the other by two of four levels (Morris 1991).

    The levels are the middles of four equal intervals of probability, so that a normal distribution has them too.
    """
    rng = np.random.default_rng(seed)
    step = _LEVELS // 2
    rows = np.empty((count, keys + 1, keys))
    for trajectory in rows:
        low = rng.integers(0, _LEVELS - step, keys)
        up = rng.integers(0, 2, keys).astype(bool)
        level = np.where(up, low, low + step).astype(np.float64)
        trajectory[0] = level
        for number, key in enumerate(rng.permutation(keys)):
            level[key] += step if up[key] else -step
            trajectory[number + 1] = level
    which, point = np.divmod(np.arange(count * (keys + 1)), keys + 1)
    return Points((rows.reshape(-1, keys) + 0.5) / _LEVELS, {"trajectory": which, "point": point})


DESIGNS: Mapping[str, Callable[[int, int, int], Points]] = {
    "sobol": sobol,
    "latin_hypercube": latin_hypercube,
    "saltelli": saltelli,
    "morris": morris,
}
"""Kinds of points by their word in a study: functions of the count, the number of keys and the seed."""


def number_of_points(design: str, count: int, keys: int) -> int:
    """How many members a design has."""
    return count * {"saltelli": keys + 2, "morris": keys + 1}.get(design, 1)
