"""Keys of a case that make a read-out least, under bounds and constraints: `cosserat.design`."""

from __future__ import annotations

import functools
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from cosserat.arguments import KEYS, TEXT, taking
from cosserat.cases.catalogue import Case, case_given
from cosserat.data.content import stamped
from cosserat.data.dataset import origin
from cosserat.data.provenance import environment
from cosserat.errors import InputError, NotConvergedError
from cosserat.studies.analysis.model import Bounds, Model, free_keys
from cosserat.studies.answer import cf_unit, derivative_unit
from cosserat.studies.derivatives import Derivatives
from cosserat.studies.readouts import ReadOut, read_out, unit_to_read
from cosserat.studies.sensitivity import short_names
from cosserat.text import shown
from cosserat.units import to_si

Array = NDArray[np.float64]
_TOLERANCE = 1e-12  # of the goal, at which the search ends
_SETTLED = 1e-8  # optimality, and size by which constraints are missed, at which it ends before
_MOST_STEPS = 200
_MET = 1e-6  # of a constraint's size, by which it may be missed
_OPTIMAL = 1e-4  # of the gradient of the goal, that constraints and bounds may leave unbalanced
_GOAL = "goal"


@dataclass(frozen=True)
class Limit:
    """A constraint on a read-out: its value is from low to high, in SI units, or exactly low where both are equal."""

    one: ReadOut
    low: float
    high: float

    @property
    def equal(self) -> bool:
        """Whether it fixes the value."""
        return self.low == self.high

    @property
    def scale(self) -> float:
        """The size of its finite ends."""
        ends = [abs(end) for end in (self.low, self.high) if np.isfinite(end)]
        return max(ends) or 1.0

    def missed(self, value: float) -> float:
        """By how much a value is outside, over the scale."""
        return max(self.low - value, value - self.high, 0.0) / self.scale


@taking(free=KEYS, minimise=TEXT, maximise=TEXT)
def design(
    case: Case | str,
    free: Mapping[str, Bounds],
    minimise: str = "",
    *,
    maximise: str = "",
    subject_to: Mapping[str, object] | None = None,
) -> xr.Dataset:
    """Find the values of some keys of a case that make a read-out least, or with `maximise` greatest.

    free : the keys with their ranges, {"rod.section.height": ("5 mm", "30 mm")}.  The search begins at their values
        in the case; it finds a local optimum.
    minimise, maximise : one of them, a read-out such as "total_mass.E3" or "max |u.E2|".
    subject_to : constraints, read-outs with a range, {"u.E2 at last": (None, "5 mm")}, or with a value.

    The Dataset has each key, and where the search began; the goal, and each constraint, 'constraint_1' and so on, with
    the attribute 'read_out'; and the price of each, the change of the goal with the end of the range that it is at,
    zero where it is not at one.  The gradients are exact, and the optimum is checked by them: what is left of the
    gradient of the goal beside those of active constraints and bounds, as a fraction of it, is the attribute
    'optimality'.

    Raises
    ------
    InputError : a key, a range or a read-out is not valid, or a derivative does not exist on the way.
    NotConvergedError : no optimum is found, or no values meet the constraints.
    CosseratError : the case has no answer where the search begins or on its way.
    """
    base = case_given(case, "design")
    name = f"the design of case '{base.name}'"
    if bool(minimise) == bool(maximise):
        raise InputError(f"{name}: give one of 'minimise' and 'maximise'")
    if not isinstance({} if subject_to is None else subject_to, Mapping):
        raise InputError(
            f"{name}: 'subject_to' is {shown(subject_to)}; give each read-out a range, such as "
            "{'u.E2 at last': (None, '5 mm')}"
        )
    keys = free_keys(base, free, name, bounded=True)
    goal = read_out(_GOAL, minimise or maximise, name)
    limits = [
        _limit(number, text, given, name)
        for number, (text, given) in enumerate((subject_to or {}).items(), start=1)
    ]
    model = Model(base, keys, [goal, *(limit.one for limit in limits)])
    search = _Search(model, limits, -1.0 if maximise else 1.0, name)
    return _dataset(search, search.run())


def _limit(number: int, text: str, given: object, name: str) -> Limit:
    one = read_out(f"constraint_{number}", text, name)
    given = given.tolist() if isinstance(given, np.ndarray) else given
    pair = isinstance(given, Sequence) and not isinstance(given, str)
    ends = list(given) if pair and isinstance(given, Sequence) else [given, given]
    where = f"{name}: the range of '{one.text}'"
    if len(ends) != 2 or ends == [None, None]:
        raise InputError(
            f"{where} is {shown(given)}; give (low, high), None for an open end, or one value"
        )
    numbers = []
    for end, open_end in zip(ends, (-np.inf, np.inf), strict=True):
        try:
            numbers.append(
                open_end if end is None else to_si(end, unit_to_read(one.units), unit_required=False)
            )
        except PydanticCustomError as error:
            raise InputError(f"{where}: {error.message()}") from None
    if numbers[0] > numbers[1]:
        raise InputError(
            f"{where} from {numbers[0]:g} to {numbers[1]:g} is empty; give the lower end first"
        )
    return Limit(one, *numbers)


@dataclass(frozen=True)
class Optimum:
    """values : (k,) of the keys.  read : the read-outs there and their derivatives.  steps : of the search.

    prices : (c,) of the constraints, derivatives of the goal by their ends.  optimality : as in `design`.
    """

    values: Array
    read: Derivatives
    steps: int
    prices: Array
    optimality: float


class _SettledError(Exception):
    """The search is at an optimum."""


class _Search:
    """The search, in logarithms of keys whose ranges are above zero, and in multiples of their scales otherwise."""

    def __init__(self, model: Model, limits: Sequence[Limit], sign: float, name: str) -> None:
        self.model, self.limits, self.sign, self.name = model, tuple(limits), sign, name
        self.paths = [one.path for one in model.free]
        self.names = [one.name for one in model.read_outs]
        self.by_ratio = np.array([one.low > 0 for one in model.free])
        self.scales = np.array([one.scale for one in model.free])
        self.known: dict[tuple[bytes, bool], Derivatives] = {}
        self.start = np.array([one.own.value for one in model.free])
        self.unit = abs(self.at(self.into(self.start)).values[_GOAL]) or 1.0

    def into(self, values: Array) -> Array:
        """Variables of the search from values of the keys."""
        ratios = values / self.scales
        return np.where(self.by_ratio, np.log(np.where(self.by_ratio, ratios, 1.0)), ratios)

    def out(self, x: Array) -> Array:
        """Values of the keys from variables of the search, within their ranges."""
        values = np.where(self.by_ratio, np.exp(np.where(self.by_ratio, x, 0.0)), x) * self.scales
        low, high = ([getattr(one, end) for one in self.model.free] for end in ("low", "high"))
        return np.asarray(values.clip(low, high))

    def at(self, x: Array, *, exact: bool = False) -> Derivatives:
        """The read-outs there.

        Raises
        ------
        CosseratError : there is no answer.
        """
        for known in ((x.tobytes(), True), (x.tobytes(), exact)):
            if known in self.known:
                return self.known[known]
        values = self.out(x)
        try:
            found = self.model.read(values, exact=exact)
        except NotConvergedError as error:
            said = ", ".join(
                f"{path} = {value:g}" for path, value in zip(self.paths, values, strict=True)
            )
            raise NotConvergedError(
                f"{self.name} has no answer on its way, at {said}; narrow the ranges ({error})"
            ) from None
        self.known[x.tobytes(), exact] = found
        return found

    def gradients(self, x: Array) -> Array:
        """Derivatives of the read-outs by the variables of the search, (read-outs, k), the goal first."""
        by_value = self.at(x, exact=True).matrix(self.names, self.paths)
        return np.asarray(by_value * np.where(self.by_ratio, self.out(x), self.scales))

    def goal(self, x: Array) -> float:
        """What is made least: an increasing function of the goal, of few decades where the goal has many."""
        return self.sign * float(np.arcsinh(self.at(x).values[_GOAL] / self.unit))

    def slope(self, x: Array) -> Array:
        """The gradient of what is made least, (k,)."""
        ratio = self.at(x).values[_GOAL] / self.unit
        return np.asarray(self.sign * self.gradients(x)[0] / self.unit / np.hypot(1.0, ratio))

    def constraints(self) -> list[dict[str, Any]]:
        """The constraints as SciPy takes them."""
        return [
            {
                "type": "eq" if limit.equal else "ineq",
                "fun": functools.partial(self._room, number, side),
                "jac": functools.partial(self._room_slope, number, side),
            }
            for number, limit in enumerate(self.limits)
            for side, end in ((1.0, limit.low), (-1.0, limit.high))
            if np.isfinite(end) and not (limit.equal and side < 0)
        ]

    def _ratio(self, number: int, side: float, x: Array) -> float:
        """How far a read-out is inside an end of its range, over the size of the range."""
        limit = self.limits[number]
        value, end = self.at(x).values[limit.one.name], limit.low if side > 0 else limit.high
        return side * (value - end) / limit.scale

    def _room(self, number: int, side: float, x: Array) -> float:
        """The same, of few decades: its zero and its sign stay."""
        return float(np.arcsinh(self._ratio(number, side, x)))

    def _room_slope(self, number: int, side: float, x: Array) -> Array:
        """The gradient of that, (k,)."""
        inside = np.hypot(1.0, self._ratio(number, side, x))
        return np.asarray(side * self.gradients(x)[number + 1] / self.limits[number].scale / inside)

    def run(self) -> Optimum:
        """The optimum.

        Raises
        ------
        NotConvergedError : there is none.
        """
        from scipy.optimize import minimize

        ends = [
            self.into(np.array([getattr(one, end) for one in self.model.free]))
            for end in ("low", "high")
        ]
        seen: list[tuple[tuple[float, float], Array]] = []

        def look(x: Array) -> None:
            seen.append((self._rank(x, ends), x.copy()))
            if max(seen[-1][0]) <= _SETTLED:
                raise _SettledError

        why = ""
        try:
            found = minimize(
                self.goal,
                self.into(self.start),
                jac=self.slope,
                bounds=list(zip(*ends, strict=True)),
                constraints=self.constraints(),
                method="SLSQP",
                options={"ftol": _TOLERANCE, "maxiter": _MOST_STEPS},
                callback=look,
            )
            seen.append((self._rank(found.x, ends), found.x))
            why = str(found.message).lower()
        except _SettledError:
            pass
        x = min(seen, key=lambda point: point[0])[1]
        prices, left = self._checked(x, ends, why, len(seen))
        return Optimum(self.out(x), self.at(x, exact=True), len(seen), prices, left)

    def _rank(self, x: Array, ends: Sequence[Array]) -> tuple[float, float]:
        """How much is missed, zero within the tolerance, and the optimality; the least is best."""
        missed = self._worst(x)[1]
        return missed if missed > _SETTLED else 0.0, self._balance(x, ends)[1]

    def _worst(self, x: Array) -> tuple[Limit | None, float]:
        """The constraint that is missed most, and by how much."""
        read = self.at(x)
        worst = max(self.limits, key=lambda one: one.missed(read.values[one.one.name]), default=None)
        return worst, 0.0 if worst is None else worst.missed(read.values[worst.one.name])

    def _checked(self, x: Array, ends: Sequence[Array], why: str, steps: int) -> tuple[Array, float]:
        """Prices and optimality of the end of the search; why : what it says itself.

        Raises
        ------
        NotConvergedError : it is no optimum.
        """
        worst, missed = self._worst(x)
        if worst is not None and missed > _MET:
            raise NotConvergedError(
                f"{self.name}: no values within the ranges are found that meet the constraint on '{worst.one.text}', "
                f"which is {self.at(x).values[worst.one.name]:g}; widen a range, or begin elsewhere",
                iterations=steps,
            )
        prices, left = self._balance(x, ends)
        if left > _OPTIMAL:
            raise NotConvergedError(
                f"{self.name}: the search ends where the goal still improves ({why}); begin elsewhere",
                iterations=steps,
            )
        return prices, left

    def _balance(self, x: Array, ends: Sequence[Array]) -> tuple[Array, float]:
        """Prices of the constraints, and what the active ones and the bounds leave of the goal's gradient."""
        from scipy.optimize import lsq_linear

        read, (gradient, *others) = self.at(x, exact=True), self.gradients(x)
        columns, low, high, owner = [], [], [], []
        for number, (limit, slope) in enumerate(zip(self.limits, others, strict=True)):
            value = read.values[limit.one.name]
            at = [abs(value - end) <= _MET * limit.scale for end in (limit.low, limit.high)]
            if any(at):
                columns.append(slope)
                owner.append(number)
                low.append(0.0 if not at[1] else -np.inf)
                high.append(0.0 if not at[0] else np.inf)
        count = len(columns)
        for axis, sides in enumerate(zip(*ends, strict=True)):
            for side, push in zip(sides, (1.0, -1.0), strict=True):
                if abs(x[axis] - side) <= _MET * max(1.0, abs(side)):
                    columns.append(np.eye(x.size)[axis] * push)
                    low.append(0.0)
                    high.append(np.inf)
        prices = np.zeros(len(self.limits))
        size = max(float(np.linalg.norm(gradient)), self.unit)
        if not columns:
            return prices, float(np.linalg.norm(gradient)) / size
        sizes = np.array([float(np.linalg.norm(column)) or 1.0 for column in columns])
        matrix = np.column_stack(columns) / sizes
        found = lsq_linear(matrix, self.sign * gradient / size, (np.array(low), np.array(high)))
        prices[owner] = self.sign * found.x[:count] / sizes[:count] * size
        return prices, float(np.linalg.norm(found.fun))


def _dataset(search: _Search, found: Optimum) -> xr.Dataset:
    keys, read = search.model.free, found.read
    words = short_names(search.paths, search.names)
    variables: dict[str, Any] = {}
    for one, value in zip(keys, found.values, strict=True):
        about = {"units": cf_unit(one.own.key.unit), "key": one.path}
        meaning = one.own.key.meaning
        variables[words[one.path]] = ((), float(value), {**about, "long_name": f"{meaning}: optimum"})
        variables[f"{words[one.path]}_start"] = (
            (),
            one.own.value,
            {**about, "long_name": f"{meaning}: start of the search"},
        )
    for kept in search.model.read_outs:
        about = {"units": kept.units, "long_name": kept.long_name, "read_out": kept.text}
        variables[kept.name] = ((), read.values[kept.name], about)
    unit = search.model.read_outs[0].units
    for limit, price in zip(search.limits, found.prices, strict=True):
        about = {
            "units": derivative_unit(unit, limit.one.units),
            "long_name": f"change of the goal with the active end of the range of {limit.one.text}",
        }
        variables[f"{limit.one.name}_price"] = ((), float(price), about)
    base = search.model.case
    dataset = xr.Dataset(variables)
    dataset.attrs = {
        **origin(f"{base.title}: design", base.source or "a case of the user"),
        "steps": found.steps,
        "optimality": found.optimality,
        "parameters": json.dumps(base.model_dump(mode="json"), sort_keys=True),
        "design": json.dumps(_asked(search), sort_keys=True),
        "environment": json.dumps(environment(), sort_keys=True),
    }
    return stamped(dataset)


def _asked(search: _Search) -> dict[str, Any]:
    """The design as plain tables, open ends as null."""
    return {
        "maximise" if search.sign < 0 else "minimise": search.model.read_outs[0].text,
        "free": {one.path: [one.low, one.high] for one in search.model.free},
        "subject_to": {
            limit.one.text: [end if np.isfinite(end) else None for end in (limit.low, limit.high)]
            for limit in search.limits
        },
    }
