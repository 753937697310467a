"""What follows from a least squares estimate: errors, intervals, and the directions that data do not determine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import InputError
from cosserat.studies.analysis.model import Free

Array = NDArray[np.float64]
ROUNDING = 1e-10
"""Of the values, what the solves leave at most: the search ends at the same change."""
_CONFIDENCE = 0.95
_SINGULAR = 1e-9  # of the largest singular value, below which a direction has no effect at all
_FAINT = 1e-4
"""Of the largest singular value, below which a direction is not determined in practice.  Data that are off by a part r
of their size along it move the keys by r over this ratio: here errors of 0.01 % move them by all of their values, as in
`_WEAK`, and few measurements are better.  A derivative by the tangent is refused if it is off by a tenth of this,
so what is above is no error of derivatives."""
_WEAK = 1.0  # relative standard error of a direction, above which the data hardly determine it
_AT_BOUND = 1e-6  # of the range, within which an estimate is at its end
_SHARE = 0.1  # of a direction, below which a key is not named


@dataclass(frozen=True)
class Estimate:
    """What least squares found.

    values : (k,) of the free keys.  residuals : (m,) measured less fitted, over their deviations.
    jacobian : (m, k) of the fitted values over their deviations.  steps : evaluations of the Jacobian.
    rounding : what the solves leave of the residuals, root mean square.
    """

    values: Array
    residuals: Array
    jacobian: Array
    steps: int
    rounding: float

    @property
    def is_finite(self) -> bool:
        """Whether all of it are numbers."""
        return all(np.isfinite(part).all() for part in (self.values, self.residuals, self.jacobian))

    def along(self, keys: Sequence[Free]) -> tuple[Array, Array, Array]:
        """Sizes of the keys (k,); singular values and directions of the Jacobian by relative changes of the keys."""
        sizes = np.where(self.values == 0, [one.scale for one in keys], np.abs(self.values))
        _, singular, directions = np.linalg.svd(self.jacobian * sizes, full_matrices=False)
        return sizes, singular, directions


@dataclass(frozen=True)
class Statistics:
    """What follows from an estimate.

    variance : of the residuals, m - k degrees of freedom.  noise : the same, or that of the solves if this is larger.
    covariance : (k, k), by the noise.  correlation : (k, k).  quantile : of Student's t.
    singular, directions : (k,) and (k, k) of the Jacobian by relative changes of the keys, the largest first.
    """

    freedom: int
    variance: float
    noise: float
    covariance: Array
    correlation: Array
    quantile: float
    singular: Array
    directions: Array

    @property
    def errors(self) -> Array:
        """The standard errors, (k,)."""
        return np.sqrt(np.diag(self.covariance))


def statistics_of(found: Estimate, keys: Sequence[Free], name: str) -> Statistics:
    """Errors and directions of an estimate.

    Raises
    ------
    InputError : the data do not determine the keys at all.
    """
    from scipy.special import stdtrit

    count, unknown = found.jacobian.shape
    sizes, singular, directions = found.along(keys)
    if singular[-1] <= _SINGULAR * singular[0]:
        raise InputError(
            f"{name}: the data do not determine {_in_words(directions[-1], keys)}; free fewer keys, or measure more"
        )
    variance = float(found.residuals @ found.residuals) / (count - unknown)
    noise = max(variance, found.rounding**2)
    half = (directions.T / singular) * sizes[:, None]
    own = half @ half.T
    lengths = np.sqrt(np.diag(own))
    return Statistics(
        count - unknown,
        variance,
        noise,
        noise * own,
        np.asarray(own / np.outer(lengths, lengths)),
        float(stdtrit(count - unknown, (1 + _CONFIDENCE) / 2)),
        singular,
        directions,
    )


def _in_words(direction: Array, keys: Sequence[Free]) -> str:
    """A direction of relative changes, its larger parts."""
    named = [
        f"{share:+.2f} '{one.path}'"
        for share, one in zip(direction, keys, strict=True)
        if abs(share) > _SHARE
    ]
    return named[0][6:] if len(named) == 1 else "the relative change " + " ".join(named)


def undetermined(found: Estimate, keys: Sequence[Free]) -> str:
    """The direction that the data determine least, with what to do, where they hardly do; else empty."""
    _, singular, directions = found.along(keys)
    if not singular[-1] <= _FAINT * singular[0]:
        return ""
    return _faint(directions[-1], keys, singular[-1] / singular[0])


def _faint(direction: Array, keys: Sequence[Free], ratio: float) -> str:
    """A direction that hardly changes the fitted values, and what to do."""
    several = np.count_nonzero(np.abs(direction) > _SHARE) > 1
    fix = (
        "fix one of these keys, or measure what tells them apart"
        if several
        else "fix it, or measure more"
    )
    return (
        f"the data hardly determine {_in_words(direction, keys)}; it changes the fitted values by {ratio:.2g} of what "
        f"the best determined direction does; {fix}"
    )


def sentences(found: Estimate, statistics: Statistics, keys: Sequence[Free]) -> list[str]:
    """What to know about the estimates."""
    said = []
    spread = np.sqrt(statistics.noise) / statistics.singular
    ratios = statistics.singular / statistics.singular[0]
    for size, ratio, direction in zip(spread, ratios, statistics.directions, strict=True):
        if size > _WEAK:
            said.append(
                f"identifiability: the data hardly determine {_in_words(direction, keys)}; its standard error is "
                f"{size:.2g} of the values"
            )
        elif ratio <= _FAINT:
            said.append(f"identifiability: {_faint(direction, keys, ratio)}")
    if statistics.noise > statistics.variance:
        said.append(
            "residuals: the fit meets the data to the round-off of the solves, and the standard errors are those of "
            "round-off; with data that were measured, they follow from the noise"
        )
    for value, one in zip(found.values, keys, strict=True):
        width = one.high - one.low
        ends = [end for end in (one.low, one.high) if abs(value - end) <= _AT_BOUND * width]
        if np.isfinite(width) and ends:
            said.append(
                f"bound: '{one.path}' is at the end {ends[0]:g} of its range, where its interval does not hold"
            )
    return said
