"""Which keys decide a read-out: the indices of Sobol and the effects of Morris, each with confidence intervals.

Sobol's indices are those of Saltelli et al., Comput. Phys. Commun. 181 (2010) 259-270, Table 2 (b) and (f), as
`scipy.stats.sobol_indices` has them.  That function takes no number of base points but a power of two, which is lost
where a member failed, and its bootstrap takes no seed; so the sums are here, and `scipy.stats.bootstrap` is the rest.
Morris's effects (Technometrics 33 (1991) 161-174; mu* by Campolongo et al., Environ. Model. Softw. 22 (2007) 1509-1518)
are those of SALib.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from cosserat.arguments import NUMBER, TEXT, WHOLE, taking
from cosserat.data.content import stamped
from cosserat.data.dataset import name_of
from cosserat.errors import InputError
from cosserat.studies.analysis.answered import answer_of, dims_of, keys_along, read_out, unit_of
from cosserat.text import shown

Array = NDArray[np.float64]
_BATCH = 1 << 16  # numbers that one batch of the bootstrap takes
_MOST_RESAMPLES = 100_000
_SALIB_STEP, _STEP = 2 / 3, 1 / 2
"""What SALib divides a change by on four levels from 0 to 1, and the change of probability in designs of studies."""


@dataclass(frozen=True)
class Resampling:
    """How confidence intervals are found: their level, the number of resamples, and the seed."""

    confidence: float
    resamples: int
    seed: int


@dataclass(frozen=True)
class _Design:
    """A design for indices: the coordinates that place a member in it, the columns of a group, and the estimates.

    group, place : names of the coordinates.  beside : how many members of a group there are besides one for each key.
    called : a group in words.
    """

    group: str
    place: str
    beside: int
    called: str
    estimate: Callable[[Array, Array, Resampling], dict[str, Array]]
    about: dict[str, str]


@taking(of=TEXT, confidence=NUMBER, resamples=WHOLE, seed=WHOLE)
def indices(
    answer: xr.Dataset | str | Path,
    of: str,
    *,
    confidence: float = 0.95,
    resamples: int = 1000,
    seed: int = 0,
) -> xr.Dataset:
    """Which keys decide a read-out: Sobol's indices of a `saltelli` factor, or Morris's effects of a `morris` factor.

    The Dataset has the dimension `key`, with the names of the keys, behind the dimensions of all other factors.  Of a
    `saltelli` factor it has the shares of the variance `first` (by the key alone) and `total` (with all that it does
    together with others), without unit.  Of a `morris` factor it has `mu`, `mu_star` and `sigma`, the mean, the mean
    size and the deviation of its effects: the change of the read-out over that of the key's probability, in the unit
    of the read-out.  For a uniform key, that is per whole range.  Names with "_low" and "_high" behind are the ends of
    the confidence interval, by the bootstrap.  A base point or a trajectory of which a member has no answer is left
    out; `used` and `left_out` count them.

    answer : of `cosserat.study`, or the name of its file.  of : the name of a read-out.
    confidence : level of the intervals, between 0 and 1.  resamples, seed : of the bootstrap.

    Raises
    ------
    InputError : the answer has no such factor or read-out, fewer than two groups are whole, the read-out does not
        vary, or SALib is needed and not installed.
    """
    data = answer_of(answer)
    how = _resampling(confidence, resamples, seed)
    dim, design = _design(data)
    values = read_out(data, of)
    others = [other for other in dims_of(data) if other != dim]
    keys = keys_along(data, dim)
    rows, points = _grouped(data, values.transpose(*others, dim).to_numpy(), dim, design, keys)
    found: dict[str, Array] = {}
    shape = rows.shape[: len(others)]
    used = np.zeros(shape, dtype=np.int64)
    for index in np.ndindex(shape):
        whole = np.isfinite(rows[index]).all(axis=-1)
        used[index] = whole.sum()
        _check_groups(rows[index][whole], f"'{of}' of {name_of(data)}", design)
        for name, estimate in design.estimate(rows[index][whole], points[whole], how).items():
            found.setdefault(name, np.empty((*shape, len(keys))))[index] = estimate
    return _dataset(data, values, found, used, rows.shape[-2], others, keys, design, how)


def _resampling(confidence: float, resamples: int, seed: int) -> Resampling:
    if not 0 < confidence < 1:
        raise InputError(f"indices has confidence = {shown(confidence)}; it must be between 0 and 1")
    if not 2 <= resamples <= _MOST_RESAMPLES:
        raise InputError(
            f"indices has resamples = {shown(resamples)}; take 2 to {_MOST_RESAMPLES}, such as 1000"
        )
    return Resampling(confidence, resamples, seed)


def _design(data: xr.Dataset) -> tuple[str, _Design]:
    """The dimension of the design for indices, and the design."""
    for design in _DESIGNS:
        for dim in dims_of(data):
            if all(
                name in data.coords and data[name].dims == (dim,)
                for name in (design.group, design.place)
            ):
                return dim, design
    raise InputError(
        f"{name_of(data)} has no points for indices; give a factor 'saltelli = 1024' or 'morris = 20' and "
        "distributions of its keys"
    )


def _grouped(
    data: xr.Dataset, values: Array, dim: str, design: _Design, keys: tuple[str, ...]
) -> tuple[Array, Array]:
    """The values (..., groups, members of a group) and the points (groups, members, keys); nan where there is none."""
    group, number = np.unique(data[design.group].to_numpy(), return_inverse=True)
    place, size = data[design.place].to_numpy(), len(keys) + design.beside
    if (
        place.min(initial=0) < 0
        or place.max(initial=0) >= size
        or len(set(zip(number, place, strict=True))) < len(place)
    ):
        raise InputError(
            f"{name_of(data)} has {len(keys)} keys along '{dim}', to which '{design.place}' does not fit; use the "
            "answer as cosserat made it"
        )
    rows = np.full((*values.shape[:-1], group.size, size), np.nan)
    rows[..., number, place] = values
    points = np.full((group.size, size, len(keys)), np.nan)
    points[number, place] = np.column_stack([data[key].to_numpy() for key in keys])
    return rows, points


def _check_groups(rows: Array, of: str, design: _Design) -> None:
    if len(rows) < 2:
        raise InputError(
            f"{of} has an answer in all members of {len(rows)} {design.called}; indices need at least two"
        )
    if np.ptp(rows) <= 1e-13 * np.abs(rows).max():
        raise InputError(
            f"{of} is {rows.flat[0]:g} in all members, so no key decides it; vary others, or more"
        )


def _sobol(rows: Array, points: Array, how: Resampling) -> dict[str, Array]:
    """First and total shares of the variance; rows : (n, k + 2), A, B and A with one column of B."""
    from scipy.stats import bootstrap

    centred = np.ascontiguousarray((rows - rows[:, :2].mean()).T)

    def shares(picked: NDArray[np.int64], axis: int = -1) -> Array:
        """(2, k, ...) of base points by number, (..., n)."""
        f = centred[:, picked]
        a, b, ab = f[0], f[1], f[2:]
        both = np.concatenate([a, b], axis=-1)
        first = (b * (ab - a)).mean(axis=-1)
        total = 0.5 * ((a - ab) ** 2).mean(axis=-1)
        found: Array = np.array([first, total]) / both.var(axis=-1)
        return found

    every = np.arange(len(rows))
    first, total = shares(every)
    ends = bootstrap(
        (every,),
        shares,
        n_resamples=how.resamples,
        batch=max(1, _BATCH // centred.size),
        confidence_level=how.confidence,
        method="percentile",
        vectorized=True,
        rng=np.random.default_rng(how.seed),
    ).confidence_interval
    return {
        "first": first,
        "first_low": ends.low[0],
        "first_high": ends.high[0],
        "total": total,
        "total_low": ends.low[1],
        "total_high": ends.high[1],
    }


def _morris(rows: Array, points: Array, how: Resampling) -> dict[str, Array]:
    """Mean, mean size and deviation of the effects; rows : (n, k + 1) of trajectories, points : (n, k + 1, k).

    Of the points, SALib takes which key changes from one to the next, and whether it rises.
    """
    try:
        from SALib.analyze import morris
    except ImportError:
        raise InputError(
            "Morris's effects are found by SALib, which is not installed; install it with 'pip install "
            "cosserat[studies]'"
        ) from None
    keys = points.shape[-1]
    problem = {"num_vars": keys, "names": [str(k) for k in range(keys)], "bounds": [[0.0, 1.0]] * keys}
    found: Any = morris.analyze(
        problem,
        points.reshape(-1, keys),
        rows.ravel() * (_SALIB_STEP / _STEP),
        num_resamples=how.resamples,
        conf_level=how.confidence,
        num_levels=4,
        seed=how.seed,
    )
    mean, half = np.asarray(found["mu_star"]), np.asarray(found["mu_star_conf"])
    return {
        "mu": np.asarray(found["mu"]),
        "mu_star": mean,
        "mu_star_low": mean - half,
        "mu_star_high": mean + half,
        "sigma": np.asarray(found["sigma"]),
    }


_DESIGNS = (
    _Design(
        "base",
        "matrix",
        2,
        "base points",
        _sobol,
        {
            "first": "share of the variance by the key alone",
            "total": "share of the variance with the key",
        },
    ),
    _Design(
        "trajectory",
        "point",
        1,
        "trajectories",
        _morris,
        {
            "mu": "mean of the effects of the key",
            "mu_star": "mean size of the effects of the key",
            "sigma": "standard deviation of the effects of the key",
        },
    ),
)


def _dataset(
    data: xr.Dataset,
    values: xr.DataArray,
    found: dict[str, Array],
    used: NDArray[np.int64],
    groups: int,
    others: list[str],
    keys: tuple[str, ...],
    design: _Design,
    how: Resampling,
) -> xr.Dataset:
    unit = "1" if design.group == "base" else unit_of(values)
    made = xr.Dataset(
        coords={name: place for name, place in values.coords.items() if set(place.dims) <= set(others)}
    )
    made = made.assign_coords(key=("key", list(keys), {"long_name": "name of the varied key"}))
    for name, numbers in found.items():
        base, _, end = name.rpartition("_")
        ended = (
            f", {end} end of its {100 * how.confidence:g} % interval" if end in ("low", "high") else ""
        )
        about = {"units": unit, "long_name": design.about[base if ended else name] + ended}
        made[name] = ((*others, "key"), numbers, about)
    made["used"] = (others, used, {"units": "1", "long_name": f"{design.called} used"})
    about = {"units": "1", "long_name": f"{design.called} left out, since a member has no answer"}
    made["left_out"] = (others, groups - used, about)
    made.attrs = {
        "title": f"{data.attrs.get('title', '')}: which keys decide '{values.name}'",
        "of": str(values.name),
        "analysis": "indices",
    }
    if (lost := int((groups - used).sum())) > 0:
        made.attrs["warnings"] = (
            f"indices: {lost} of {groups * used.size} {design.called} are left out, since a member of each has no "
            "answer; the numbers are about the part of the ranges that has one"
        )
    return stamped(made)
