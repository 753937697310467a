"""Equilibria of a rod for many values of some keys at once, without an object for each.

The formulas are those of a single problem; they take one more axis, of the members.  The values are put into copies of
the parameter objects, which are not validated again: their ranges are checked before, a whole column at a time.  Every
member gets the bits of its single run, because `cosserat.solvers.many` solves one body as an array of one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import UnsupportedRodError
from cosserat.problems.columns import OF_BODY, fits, in_range, with_columns
from cosserat.problems.rates import Settled, field_rates, has_rates, moves
from cosserat.problems.static import FIELDS, RodStatics, State, check_supports
from cosserat.rods.energies import energy_named
from cosserat.rods.loads.dead import DeadLoad, Gravity
from cosserat.rods.loads.load import LoadedRod
from cosserat.rods.places import equal_mesh
from cosserat.rods.problem import LOADS
from cosserat.rods.reference import Geometry
from cosserat.rods.resolution import COARSE, coarse, largest_turning, surface_stretch
from cosserat.rods.rod import Rod
from cosserat.rods.space import RodSpace
from cosserat.solution import Field, FieldRates, Many
from cosserat.solvers.banded import Mask
from cosserat.solvers.many import Family
from cosserat.solvers.members import REACHED, Answers, Members
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]
_CHUNK = 2048  # members whose constants are in memory at once


def solve_many(
    problem: RodStatics,
    columns: Mapping[str, Array],
    wanted: Sequence[str] = tuple(FIELDS),
    by: Sequence[str] = (),
) -> Many | None:
    """The equilibria of a rod for many values (M,) of some keys, in SI units; None where they go one by one.

    columns : values by dotted keys, such as "rod.section.height" or "forces.0.force".
    wanted : names of the fields to give, of `cosserat.problems.static.FIELDS`.  by : keys with which they move.
    """
    count = next(iter(columns.values())).size
    family = _family(problem, columns)
    if family is None or not all(has_rates(problem, key, columns[key]) for key in by):
        return None
    parts, chunk = [], max(1, _CHUNK // (1 + len(by)))
    for first in range(0, count, chunk):
        own = {key: values[first : first + chunk] for key, values in columns.items()}
        if not in_range(problem, own).any():
            return None  # the problem of each says why
        parts.append(_solve(problem, own, (wanted, by), *family))
    return _joined(parts)


def _family(problem: RodStatics, columns: Mapping[str, Array]) -> tuple[Family, MechanicalSystem] | None:
    """What all members have in common, and one of them; None if the compiled loop or these formulas do not fit."""
    if not all(fits(problem, key, columns) for key in columns):
        return None
    geometry = problem.geometry
    system = problem.system(geometry)
    try:
        check_supports(system, "the rod")
    except UnsupportedRodError:
        return None
    family = family_of(problem, system)
    return None if family is None else (family, system)


def family_of(problem: RodStatics, system: MechanicalSystem) -> Family | None:
    """What rods that differ in columns have in common; None if the compiled loop does not take them."""
    return Family.of(system, problem.newton) if problem.pose is None else None


def members_of(
    problem: RodStatics, columns: Mapping[str, Array], system: MechanicalSystem
) -> tuple[Members, Geometry, Rod]:
    """The numbers of all members, their reference configurations, and their rod with columns in place of numbers.

    system : of the problem itself.
    """
    varied = with_columns(problem, columns)
    count = next(iter(columns.values())).size
    one = system.member
    geometry, rod = problem.geometry, problem.rod
    every = Members._make(np.repeat(values, count, axis=0) for values in one)
    if any(key in OF_BODY for key in columns):
        rod = varied.rod
        lengths = np.broadcast_to(np.asarray(rod.length), (count, 1))[:, 0]
        geometry = rod.geometry(
            equal_mesh(rod.vertices, lengths) if _is_equal(problem) else _rows(problem, count)
        )
        energy = energy_named(rod.energy).potential(rod, geometry, displacements=True)
        space = RodSpace(rod.kinematics, geometry.q, True, np.zeros_like(geometry.q))
        every = every._replace(
            constants=energy.data.reshape(count, -1), placed=geometry.q, scale=space.scale
        )
    dead, size = np.zeros_like(every.dead), np.zeros_like(every.dead)
    X, D = (np.broadcast_to(part, (count, rod.vertices, 2)) for part in (geometry.X, geometry.D))
    for force in _forces(varied, problem, LoadedRod(rod, Geometry(X, D)), columns):
        dead += force
        size += np.abs(force)
    sizes = np.stack([size.max(axis=-1), size.sum(axis=-1)], axis=-1)
    return every._replace(dead=dead, sizes=sizes), geometry, rod


def _is_equal(problem: RodStatics) -> bool:
    """Whether its vertices are equally spaced."""
    arc = problem.arc_length
    return bool((arc == equal_mesh(problem.rod.vertices, problem.rod.length)).all())


def _rows(problem: RodStatics, count: int) -> Array:
    return np.repeat(problem.arc_length[None], count, axis=0)


def _forces(
    varied: RodStatics, problem: RodStatics, body: LoadedRod, columns: Mapping[str, Array]
) -> Iterator[Array]:
    """The forces of each kind of loads on the DOFs, (M, n) or (n,) [N], in the order of a single problem."""
    for name, kind in LOADS.items():
        loads = varied.loads_of(name)
        if not loads or not issubclass(kind, DeadLoad):
            continue
        if issubclass(kind, Gravity) and not any(key in OF_BODY for key in columns):
            yield _weights(problem, columns)
        else:
            total = kind.total(loads, body)  # type: ignore[arg-type] # loads of this kind
            yield total.reshape(*total.shape[:-2], -1)


def _weights(problem: RodStatics, columns: Mapping[str, Array]) -> Array:
    """The weights on the DOFs, (M, n) or (n,) [N], of a rod whose mass is that of the problem."""
    gravity = problem.gravity
    assert gravity is not None
    body = LoadedRod(problem.rod, problem.geometry, masses=problem.masses)
    given = columns.get("gravity.g")
    falls = [gravity.g] if given is None else given.tolist()
    each = [gravity.model_copy(update={"g": g}) for g in falls]
    found = np.array([Gravity.total([one], body).ravel() for one in each])
    return found[0] if given is None else found


def _solve(
    problem: RodStatics,
    columns: Mapping[str, Array],
    asked: tuple[Sequence[str], Sequence[str]],
    family: Family,
    system: MechanicalSystem,
) -> Many:
    """The equilibria of some members; asked : the fields, and the keys with which they move."""
    wanted, by = asked
    sound = in_range(problem, columns)
    kept = {key: values[sound] for key, values in columns.items()}
    members, geometry, rod = members_of(problem, kept, system)
    answers = family.solve(members)
    solved = answers.status == REACHED
    state = State(rod, geometry, answers.q, members.dead, answers.reaction)
    x, d = state.vectors[..., 0, :], state.vectors[..., 1, :]
    with np.errstate(invalid="ignore", divide="ignore"):
        lower = np.full(rod.vertices, rod.below)
        solved &= (surface_stretch(geometry, x, d, lower) > 0).all(axis=(-2, -1))
        fields = {name: _field(name, state, sound) for name in wanted}
    places = np.flatnonzero(sound)
    doubtful = solved & (largest_turning(d) > COARSE)
    warnings = {int(places[m]): coarse(d[m]) for m in np.flatnonzero(doubtful)}
    done = np.zeros(sound.size, dtype=np.bool_)
    done[sound] = solved
    labels = {"axis": rod.kinematics.axes, "dof": rod.kinematics.dofs}
    rates = None
    if by:
        body = LoadedRod(rod, geometry, masses=problem.masses)
        settled = Settled(problem, kept, system, family, members, body, answers.q)
        with np.errstate(invalid="ignore", divide="ignore"):
            rates = _spread(field_rates(state, moves(settled, by), wanted), sound)
        done &= rates.known.all(axis=1)
    return Many(fields, _statistics(answers, sound), labels, done, warnings, rates)


def _spread(rates: FieldRates, sound: Mask) -> FieldRates:
    """Rates of some members among those of all, not a number for the others."""
    if sound.all():
        return rates
    each = rates.known.shape[1]

    def among(values: Array, rows: Mask) -> Array:
        found = np.full((rows.size, *values.shape[1:]), np.nan)
        found[rows] = values
        return found

    known = np.zeros((sound.size, each), dtype=np.bool_)
    known[sound] = rates.known
    return replace(
        rates,
        now={name: (dims, among(own, sound)) for name, (dims, own) in rates.now.items()},
        change={
            name: (dims, among(own, np.repeat(sound, each)))
            for name, (dims, own) in rates.change.items()
        },
        rounding=among(rates.rounding, sound),
        known=known,
    )


def _field(name: str, state: State, sound: Mask) -> Field:
    """A field of all members, NaN for those out of range."""
    dims, values = FIELDS[name]
    known = values(state)
    found = np.full((sound.size, *known.shape[-len(dims) :]), np.nan)
    found[sound] = known
    return ("member", *dims), found


def _statistics(answers: Answers, sound: Mask) -> dict[str, NDArray[Any]]:
    """Statistics by name, as a single problem has them."""
    columns: dict[str, NDArray[Any]] = {
        "iterations": answers.counts[:, 0],
        "cutbacks": answers.counts[:, 1],
        "residual_N": answers.forces[:, 0],
        "tolerance_N": answers.forces[:, 1],
        "rounding_N": answers.forces[:, -1],
    }
    every = {name: np.zeros(sound.size, dtype=values.dtype) for name, values in columns.items()}
    for name, values in columns.items():
        every[name][sound] = values
    return every


def _joined(parts: Sequence[Many]) -> Many:
    """Members of several parts, one after the other."""
    first, counts = parts[0], np.cumsum([0, *(part.solved.size for part in parts)])
    if len(parts) == 1:
        return first
    fields = _after([part.fields for part in parts])
    statistics = {
        name: np.concatenate([part.statistics[name] for part in parts]) for name in first.statistics
    }
    warnings = {
        int(start) + number: said
        for start, part in zip(counts[:-1], parts, strict=True)
        for number, said in part.warnings.items()
    }
    solved = np.concatenate([part.solved for part in parts])
    rates = _rates_after([part.rates for part in parts if part.rates is not None])
    return replace(
        first, fields=fields, statistics=statistics, solved=solved, warnings=warnings, rates=rates
    )


def _after(parts: Sequence[Mapping[str, Field]]) -> dict[str, Field]:
    return {
        name: (dims, np.concatenate([part[name][1] for part in parts]))
        for name, (dims, _) in parts[0].items()
    }


def _rates_after(parts: Sequence[FieldRates]) -> FieldRates | None:
    if not parts:
        return None
    return replace(
        parts[0],
        now=_after([part.now for part in parts]),
        change=_after([part.change for part in parts]),
        rounding=np.concatenate([part.rounding for part in parts]),
        known=np.concatenate([part.known for part in parts]),
    )
