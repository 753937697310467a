"""Exact derivatives of read-outs by keys of a case, from a result that moves with each key to first order."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from cosserat.data.variables import VARIABLES
from cosserat.errors import CosseratError, InputError, OutOfReachError
from cosserat.problem import Problem
from cosserat.problems.columns import put_inside
from cosserat.problems.moving import moves_exactly, moving
from cosserat.problems.tangents import Motion, Moving, Nearby, NearKey
from cosserat.solution import FieldRates, Solution
from cosserat.solvers.slopes import slope
from cosserat.studies.keys import VariedKey, put, table_of, varied_key
from cosserat.studies.readouts import ReadOut
from cosserat.studies.reduced import reduced
from cosserat.text import shown

Array = NDArray[np.float64]
TANGENT = "the equilibrium's tangent: one solve with its Hessian"
DIFFERENCES = "differences of whole solves"
_ROUGH = {TANGENT: 1e-5, DIFFERENCES: 1e-3}
"""Error of a derivative, as a fraction of it, above which there is none; by method."""
_ROUND_OFF = {TANGENT: 16 * float(np.finfo(float).eps), DIFFERENCES: 3e-11}
"""Of the values, in which they may be round-off."""
_SCATTER = {TANGENT: _ROUND_OFF[TANGENT], DIFFERENCES: 1e-13}
"""Standard deviation of round-off as a fraction of the values; that of motions, 2e-12 to 2.2e-11, is beyond."""
_TIGHT = 1e-14  # tolerance of Newton's method where whole solves are differenced


@dataclass(frozen=True)
class Parameter:
    """A key of a case by which derivatives are taken, and its value in SI units."""

    key: VariedKey
    value: float

    def after(self, step: float) -> float:
        """Its value after a step: times exp(step); the step itself for one that is zero."""
        return self.value * float(np.exp(step)) if self.value else step

    def rate(self, by_step: float) -> float:
        """A derivative by the value from one by the step."""
        return by_step / self.value if self.value else by_step


@dataclass(frozen=True)
class Derivative:
    """A derivative by a key in SI units, and an estimate of its error."""

    value: float
    error: float


@dataclass(frozen=True)
class Derivatives:
    """values : of the read-outs by name.  by : their derivatives, by the names of the read-outs and the paths of keys.

    missing : why there is no derivative, by the same.  method : how they were taken.
    """

    values: Mapping[str, float]
    by: Mapping[tuple[str, str], Derivative]
    missing: Mapping[tuple[str, str], str]
    method: str

    def matrix(self, names: Sequence[str], keys: Sequence[str]) -> Array:
        """The derivatives of some read-outs by some keys, (names, keys).

        Raises
        ------
        InputError : one does not exist.
        """
        for pair in ((name, key) for name in names for key in keys):
            if pair in self.missing:
                raise InputError(self.missing[pair])
        return np.array([[self.by[name, key].value for key in keys] for name in names])


def parameter(problem: Problem, path: str, name: str) -> Parameter:
    """A key of a problem by its path; name : in errors.

    Raises
    ------
    InputError : it is no quantity with a value.
    """
    key = varied_key(problem, path, name)
    value: Any = table_of(problem)
    for part in path.split("."):
        value = value[int(part)] if isinstance(value, Sequence) else value[part]
    if key.quantity is None or isinstance(value, bool) or not isinstance(value, int | float):
        said = "is a count" if key.is_number and key.quantity is None else f"is {shown(value)}"
        said = "is not given" if value is None or value == "" else said
        raise InputError(f"{name}: '{path}' {said}; derivatives are by quantities that the case gives")
    return Parameter(key, float(value))


def derivatives(
    problem: Problem, parameters: Sequence[Parameter], read_outs: Sequence[ReadOut], name: str
) -> Derivatives:
    """Read-outs of a problem with their derivatives; one that does not exist is `missing`.

    name : of the case in errors.

    Raises
    ------
    CosseratError : the problem has no result, or none with the read-outs.
    """
    table = functools.cache(lambda: table_of(problem, [one.key.path for one in parameters]))
    near = [_nearby(problem, table, one) for one in parameters]
    wanted = {word for one in read_outs for word in one.needs()}
    motion, method = _motion(problem, near, name, wanted)
    fields = _fields(motion.base, read_outs)
    values = {one.name: float(one.of(fields.fields, fields.labels)) for one in read_outs}
    by: dict[tuple[str, str], Derivative] = {}
    missing: dict[tuple[str, str], str] = {}
    rates = motion.rates
    quick = {} if rates is None else {one.name: rated(one, rates) for one in read_outs}
    for k, (own, way, why) in enumerate(zip(parameters, motion.ways, motion.lost, strict=True)):
        known: dict[float, Solution] = {0.0: fields}
        for one in read_outs:
            pair = (one.name, own.key.path)
            try:
                if why:
                    raise InputError(why)
                if quick and k in motion.rated:
                    by[pair] = quick[one.name].of(own, motion.rated[k])
                else:
                    by[pair] = _derivative(one, own, way, read_outs, known, method)
            except CosseratError as error:
                missing[pair] = f"{name}: {lacking(*pair, str(error).removeprefix(f'{name}: '))}"
    return Derivatives(values, by, missing, method)


def lacking(read_out: str, path: str, why: str) -> str:
    """The sentence about a derivative that does not exist."""
    return f"'{read_out}' has no derivative by '{path}': {why}"


@dataclass(frozen=True)
class Rated:
    """Derivatives of one read-out of M results by the steps of K keys, and their errors, (M, K).

    why : there is none, by the numbers of a result and a key.
    """

    value: Array
    error: Array
    why: Mapping[tuple[int, int], str]

    def of(self, own: Parameter, number: int) -> Derivative:
        """The derivative of a single result by a key with its number.

        Raises
        ------
        InputError : there is none.
        """
        if (0, number) in self.why:
            raise InputError(self.why[0, number])
        value, error = float(self.value[0, number]), float(self.error[0, number])
        return Derivative(own.rate(value), abs(own.rate(error)))


def rated(one: ReadOut, rates: FieldRates) -> Rated:
    """The derivatives of a read-out from the rates of fields."""
    if one.needs() != {one.variable}:
        return _rated_between(one, rates)
    (count, each), labels = rates.known.shape, rates.labels
    now = one.picked(rates.now, labels)[1].reshape(count, -1)
    change = one.picked(rates.change, labels)[1].reshape(count * each, -1)
    smooth = np.zeros(change.shape, dtype=np.bool_)
    found, why = reduced(one, np.repeat(now, each, axis=0), change, smooth)
    error = np.abs(change).max(axis=-1, initial=0.0) * rates.rounding.ravel()
    places = {divmod(row, each): said for row, said in why.items()}
    return Rated(found.reshape(count, each), error.reshape(count, each), places)


def _rated_between(one: ReadOut, rates: FieldRates) -> Rated:
    """Likewise at a place between two vertices, which may pass it."""
    found, error = np.full((2, *rates.known.shape), np.nan)
    why: dict[tuple[int, int], str] = {}
    for m, k in map(tuple, np.argwhere(rates.known).tolist()):
        try:
            values = functools.partial(_picked_after, one, rates, m, k)
            found[m, k], error[m, k] = _by_step(one, values, TANGENT, _SCATTER[TANGENT])
        except InputError as lacks:
            why[m, k] = str(lacks)
    return Rated(found, error, why)


def _picked_after(one: ReadOut, rates: FieldRates, result: int, key: int, step: float) -> Array:
    return one.picked(rates.after(result, key, step), rates.labels)[1]


def _nearby(problem: Problem, table: Callable[[], Mapping[str, Any]], own: Parameter) -> Nearby:
    """The problem after a step of a parameter."""
    path, valid = own.key.path.split("."), {True: 0.0, False: 0.0}

    def after(step: float) -> Problem:
        ahead = step > 0
        if abs(step) < valid[ahead]:  # between valid values: a copy that is not validated again
            return cast("Problem", put_inside(problem, path, own.after(step)))
        changed = put(table(), path, own.after(step))
        found = type(problem).read(changed, f"'{own.key.path}'", units_required=False)
        valid[ahead] = abs(step)
        return found

    return NearKey(after, own.key.path, own.after)


class _Solved:
    """A result whose problem is solved anew after every step."""

    lacks = ""

    def __init__(self, near: Nearby, name: str) -> None:
        self.near, self.name = near, name

    def solution(self, step: float) -> Solution:
        """The result after a step."""
        return sharp(cast("Problem", self.near(step))).solve(self.name)


def method_of(problem: Problem) -> str:
    """How derivatives of a problem are taken."""
    return TANGENT if moves_exactly(problem) else DIFFERENCES


def _motion(problem: Problem, near: Sequence[Nearby], name: str, wanted: Set[str]) -> tuple[Motion, str]:
    """The result and how it moves with each parameter, and the method."""
    found = moving(problem, near, name, wanted)
    if found is not None:
        return found, TANGENT
    ways = tuple(_Solved(one, name) for one in near)
    return Motion(sharp(problem).solve(name), ways, ("",) * len(ways)), DIFFERENCES


def sharp(problem: Problem) -> Problem:
    """A problem whose equilibria, if it has some, are found to round-off."""
    newton = getattr(problem, "newton", None)
    if newton is None:
        return problem
    return problem.replace(newton=newton.replace(tolerance=min(_TIGHT, newton.tolerance)))


def _fields(found: Solution, read_outs: Sequence[ReadOut]) -> Solution:
    """A result with those fields that follow from it, if they are read."""
    names = {name for one in read_outs for name in one.needs()}
    if names <= set(found.fields) or found.derive is None:
        return found
    more = found.derive(names - set(found.fields))
    return Solution({**more.fields, **found.fields}, {}, {**more.labels, **found.labels})


def _derivative(
    one: ReadOut,
    own: Parameter,
    way: Moving,
    read_outs: Sequence[ReadOut],
    known: dict[float, Solution],
    method: str,
) -> Derivative:
    """One derivative; known : results by step, which several read-outs share.

    Raises
    ------
    InputError : it does not exist.
    """

    def values(step: float) -> Array:
        if step not in known:
            known[step] = _fields(way.solution(step), read_outs)
        if way.lacks and one.variable not in known[step].fields:
            raise InputError(way.lacks)
        try:
            return one.picked(known[step].fields, known[step].labels)[1]
        except OutOfReachError as error:
            raise InputError(str(error)) from None  # which shorter steps may reach

    moves = method == DIFFERENCES and "time" in known[0.0].fields
    value, error = _by_step(one, values, method, (_ROUND_OFF if moves else _SCATTER)[method])
    return Derivative(own.rate(value), abs(own.rate(error)))


def _by_step(
    one: ReadOut, values: Callable[[float], Array], method: str, scatter: float
) -> tuple[float, float]:
    """The derivative of a read-out by the step of a parameter, and its error.

    values : those that are left after components and places were taken, after a step.
    scatter : standard deviation of round-off as a fraction of them.

    Raises
    ------
    InputError : there is none.
    """
    now = values(0.0)
    size = float(np.abs(now).max(initial=0.0))
    floor = max(_ROUND_OFF[method] * size, VARIABLES[one.variable].floor / 16)
    found = slope(values, floor, scatter * size)
    if found.relative > _ROUGH[method]:
        raise InputError(
            f"'{one.variable}' does not change smoothly (differences disagree by {found.relative:.2g} of it)"
        )
    rates, kinks = found.value.reshape(1, -1), found.kink.reshape(1, -1)
    (by_step,), why = reduced(one, now.reshape(1, -1), rates, kinks)
    if why:
        raise InputError(why[0])
    return float(by_step), float(found.error.max(initial=0.0))
