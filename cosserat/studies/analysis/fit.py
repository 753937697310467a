"""Keys of a case fitted to measured data by least squares: `cosserat.fit`."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from cosserat.arguments import COLUMNS, KEYS, TABLE, taking
from cosserat.cases.catalogue import Case, case_given
from cosserat.data.content import stamped
from cosserat.data.dataset import origin
from cosserat.data.provenance import environment
from cosserat.errors import CosseratError, InputError, NotConvergedError
from cosserat.studies.analysis.determined import (
    ROUNDING,
    Estimate,
    Statistics,
    sentences,
    statistics_of,
    undetermined,
)
from cosserat.studies.analysis.measured import Columns, Measured, measured
from cosserat.studies.analysis.model import Bounds, Free, Model, free_keys
from cosserat.studies.answer import cf_unit
from cosserat.studies.readouts import read_outs_by_name
from cosserat.studies.sensitivity import short_names

Array = NDArray[np.float64]
_TOLERANCE = 1e-10  # relative change of estimates, sum and gradient at which the search ends
_MOST_STEPS = 100
_LARGEST = 1e30  # of a measured value in its SI unit, so that its square is a number with room to spare
_APART = 1e15  # how far a deviation may be from the size of the measured values, for the same reason


@taking(data=COLUMNS, free=KEYS, deviations=TABLE)
def fit(
    case: Case | str,
    data: str | Path | Columns | pd.DataFrame,
    free: Mapping[str, Bounds] | Sequence[str],
    of: Mapping[str, str],
    *,
    deviations: Mapping[str, object] | None = None,
) -> xr.Dataset:
    """Fit some keys of a case to measured data by least squares, with exact derivatives.

    data : name of a CSV file, each row one experiment.  Its header names with their units the keys that differ from row
        to row, "forces.0.force [N]", the read-outs that were measured, "tip [mm]", and with "tip_deviation [mm]" their
        standard deviations.  Empty cells were not measured.  Or columns by name, also of a DataFrame, in SI units.
    free : the keys that are sought, with their ranges: {"rod.material.young": ("1 GPa", "5 GPa")}, or without: a list.
        The search begins at their values in the case.
    of : the read-outs by name, {"tip": "u.E2 at last"}.
    deviations : standard deviations by read-out.  They weigh the data; their common factor follows from the residuals.

    The Dataset has each key with its standard error and the ends of its 95 % interval by Student's t, 'young',
    'young_error', 'young_low', 'young_high'; the correlations; the singular values of the weighted Jacobian by relative
    changes, with their directions; and on the dimension 'row' the conditions, and for each read-out what was measured,
    fitted and left.  A direction that the data hardly determine is named by a sentence in the attribute 'warnings':
    its standard error is above the values, or it changes the fitted values by less than 1e-4 of what the direction does
    that changes them most.  Errors are never below those that the round-off of the solves gives.

    Raises
    ------
    InputError : a key, a column or a value is not valid, there are too few data, or they do not determine the keys.
    NotConvergedError : the search does not end; if the data leave a direction open, the sentence names it.
    CosseratError : the case at which the search begins has no answer.
    """
    base = case_given(case, "fit")
    name = f"the fit of case '{base.name}'"
    keys = free_keys(base, [free] if isinstance(free, str) else free, name, bounded=False)
    if not of:
        raise InputError(f"{name}: no read-out is fitted; name one, such as {{'tip': 'u.E2 at last'}}")
    read_outs = read_outs_by_name(of, name)
    table = measured(data, base.problem, read_outs, deviations or {}, name)
    _check(table, keys, name)
    search = _Search(Model(base, keys, read_outs), table, name)
    with np.errstate(all="ignore"):  # the search refuses an end that is no number
        found = search.run()
        statistics = statistics_of(found, keys, name)
    return _dataset(search, found, statistics)


def _check(table: Measured, keys: Sequence[Free], name: str) -> None:
    clash = {key.path for key in table.keys} & {one.path for one in keys}
    if clash:
        raise InputError(f"{name}: '{min(clash)}' is free and a column of the data; leave one out")
    lacking = [word for word, spread in table.deviations.items() if spread is None]
    if lacking and len(table.values) > 1:
        raise InputError(
            f"{name}: several read-outs are fitted and '{lacking[0]}' has no standard deviation that weighs it; give a "
            f"column '{lacking[0]}_deviation' or deviations = {{'{lacking[0]}': ...}}"
        )
    count = sum(int(np.isfinite(column).sum()) for column in table.values.values())
    if count <= len(keys):
        raise InputError(
            f"{name}: {count} measured values cannot determine {len(keys)} keys with an error; give more"
        )
    for word, column in table.values.items():
        _check_sizes(word, column, table.deviations[word], name)


def _check_sizes(word: str, column: Array, spread: Array | None, name: str) -> None:
    """Raise InputError for measured values and deviations whose squares are no numbers."""
    there = np.isfinite(column)
    largest = float(np.abs(column[there]).max(initial=0.0))
    if largest > _LARGEST:
        raise InputError(
            f"{name}: '{word}' has the measured value {largest:g}; give values up to {_LARGEST:g}, in SI units"
        )
    size = largest or 1.0
    for one in [] if spread is None else spread[there]:
        if not size / _APART <= one <= size * _APART:
            raise InputError(
                f"{name}: the standard deviation of '{word}' is {one:g}; give it from {size / _APART:.3g} to "
                f"{size * _APART:.3g}, for measured values of up to {size:.3g}"
            )


class _Search:
    """Least squares on the residuals of all rows, in multiples of the scales of the keys."""

    def __init__(self, model: Model, table: Measured, name: str) -> None:
        self.model, self.table, self.name = model, table, name
        self.scales = np.array([one.scale for one in model.free])
        self.names = [one.name for one in model.read_outs]
        stacked = np.column_stack([table.values[word] for word in self.names])
        given = (table.deviations[word] for word in self.names)
        spread = [np.ones(table.size) if own is None else own for own in given]
        self.known = np.isfinite(stacked)
        self.measured, self.spread = stacked, np.column_stack(spread)

    def conditions(self, row: int) -> dict[str, object]:
        """The keys of one row."""
        return {
            key.path: column[row]
            for key, column in zip(self.table.keys, self.table.conditions, strict=True)
        }

    def fitted(self, values: Array) -> Array:
        """The read-outs of every row, (rows, read-outs).

        Raises
        ------
        CosseratError : a row has no answer.
        """
        found = np.empty_like(self.measured)
        for row in range(self.table.size):
            read = self.model.read(values, self.conditions(row))
            found[row] = [read.values[word] for word in self.names]
        return found

    def weighed(self, rows: Array) -> Array:
        """Values (rows, read-outs) over their deviations, those that were measured, (m,)."""
        return np.asarray((rows / self.spread)[self.known])

    def residuals(self, scaled: Array) -> Array:
        """Fitted less measured, (m,); infinite where a row has no answer, which shortens the step."""
        try:
            return self.weighed(self.fitted(scaled * self.scales) - self.measured)
        except CosseratError:
            return np.full(int(self.known.sum()), np.inf)

    def jacobian(self, scaled: Array) -> Array:
        """Derivatives of the residuals by the scaled keys, (m, k)."""
        paths = [one.path for one in self.model.free]
        rows = np.empty((*self.measured.shape, len(paths)))
        for row in range(self.table.size):
            read = self.model.read(scaled * self.scales, self.conditions(row), exact=True)
            rows[row] = read.matrix(self.names, paths)
        return np.asarray((rows / self.spread[..., None])[self.known] * self.scales)

    def run(self) -> Estimate:
        """The estimate."""
        from scipy.optimize import least_squares

        free = self.model.free
        start = np.array([one.own.value for one in free]) / self.scales
        self.fitted(start * self.scales)  # says why there is no answer, if there is none
        low, high = (
            np.array([getattr(one, end) for one in free]) / self.scales for end in ("low", "high")
        )
        found = least_squares(
            self.residuals,
            start,
            self.jacobian,
            (low, high),
            xtol=_TOLERANCE,
            ftol=_TOLERANCE,
            gtol=_TOLERANCE,
            max_nfev=_MOST_STEPS,
        )
        weighed = self.weighed(self.measured)
        rounding = float(np.sqrt(np.mean(weighed**2))) * ROUNDING
        jacobian = self.jacobian(found.x) / self.scales
        estimate = Estimate(found.x * self.scales, -found.fun, jacobian, int(found.njev), rounding)
        if found.status <= 0 or not estimate.is_finite:
            self._refuse(estimate, int(found.nfev))
        return estimate

    def _refuse(self, estimate: Estimate, steps: int) -> NoReturn:
        """Say why the search does not end.

        Raises
        ------
        NotConvergedError : always.
        """
        why = undetermined(estimate, self.model.free) if estimate.is_finite else ""
        bounded = all(np.isfinite(one.high - one.low) for one in self.model.free)
        why = why or (
            "begin nearer, or narrow the ranges" if bounded else "begin nearer, or give ranges"
        )
        raise NotConvergedError(
            f"{self.name} does not end within {_MOST_STEPS} steps; {why}", iterations=steps
        )


def _dataset(search: _Search, found: Estimate, statistics: Statistics) -> xr.Dataset:
    keys, table = search.model.free, search.table
    names = short_names([*(one.path for one in keys), *(key.path for key in table.keys)], search.names)
    own = [names[one.path] for one in keys]
    coords: dict[str, Any] = {
        "parameter": (("parameter",), own, {"long_name": "fitted key"}),
        "with": (("with",), own, {"long_name": "the other fitted key"}),
        "row": (("row",), np.arange(1, table.size + 1), {"units": "1", "long_name": "row of the data"}),
    }
    for key, column in zip(table.keys, table.conditions, strict=True):
        about = {"long_name": key.meaning, "key": key.path}
        numbers = all(isinstance(item, int | float) for item in column)
        values = column.astype(np.float64) if numbers else [str(item) for item in column]
        coords[names[key.path]] = (
            ("row",),
            values,
            about | ({"units": cf_unit(key.unit)} if numbers else {}),
        )
    variables = _estimates(keys, own, found, statistics)
    variables |= _residuals(search, found)
    return _described(search, xr.Dataset(variables, coords), found, statistics)


def _estimates(
    keys: Sequence[Free], names: Sequence[str], found: Estimate, statistics: Statistics
) -> dict[str, Any]:
    """The estimates with their errors, correlations and directions."""
    variables: dict[str, Any] = {}
    for number, (one, word) in enumerate(zip(keys, names, strict=True)):
        value, error = found.values[number], statistics.errors[number]
        reach = statistics.quantile * error
        unit = {"units": cf_unit(one.own.key.unit), "key": one.path}
        for ending, part, meaning in (
            ("", value, "least squares estimate"),
            ("_error", error, "standard error"),
            ("_low", value - reach, "lower end of the 95 % interval"),
            ("_high", value + reach, "upper end of the 95 % interval"),
            ("_start", one.own.value, "start of the search"),
        ):
            variables[f"{word}{ending}"] = (
                (),
                float(part),
                {**unit, "long_name": f"{one.own.key.meaning}: {meaning}"},
            )
    pure = {"units": "1"}
    return variables | {
        "correlation": (
            ("parameter", "with"),
            statistics.correlation,
            {**pure, "long_name": "correlation of the estimates"},
        ),
        "singular_value": (
            ("direction",),
            statistics.singular,
            {
                **pure,
                "long_name": "change of the weighted residuals by a relative change of the keys along a direction",
            },
        ),
        "direction_of_keys": (
            ("direction", "parameter"),
            statistics.directions,
            {**pure, "long_name": "relative change of the keys along a direction, of unit length"},
        ),
    }


def _residuals(search: _Search, found: Estimate) -> dict[str, Any]:
    """What was measured, fitted and left, by row."""
    fitted = search.fitted(found.values)
    variables: dict[str, Any] = {}
    for number, one in enumerate(search.model.read_outs):
        measured_, own = search.measured[:, number], fitted[:, number]
        left = measured_ - own
        about = {"units": one.units, "read_out": one.text}
        for ending, values, meaning in (
            ("measured", measured_, "measured"),
            ("fitted", own, "fitted"),
            ("residual", left, "measured less fitted"),
            ("deviation", search.spread[:, number], "standard deviation that weighs the measurement"),
        ):
            if ending == "deviation" and search.table.deviations[one.name] is None:
                continue
            variables[f"{one.name}_{ending}"] = (
                ("row",),
                values,
                {**about, "long_name": f"{one.long_name}, {meaning}"},
            )
    return variables


def _described(
    search: _Search, dataset: xr.Dataset, found: Estimate, statistics: Statistics
) -> xr.Dataset:
    """The Dataset with what it is."""
    base = search.model.case
    dataset.attrs = {
        **origin(f"{base.title}: fit", base.source or "a case of the user"),
        "degrees_of_freedom": statistics.freedom,
        "reduced_chi_square": statistics.variance,
        "steps": found.steps,
        "warnings": "\n".join(sentences(found, statistics, search.model.free)),
        "parameters": json.dumps(base.model_dump(mode="json"), sort_keys=True),
        "fit": json.dumps(
            {
                "free": {one.path: [repr(one.low), repr(one.high)] for one in search.model.free},
                "of": {one.name: one.text for one in search.model.read_outs},
            },
            sort_keys=True,
        ),
        "environment": json.dumps(environment(), sort_keys=True),
    }
    return stamped(dataset)
