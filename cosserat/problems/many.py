"""Equilibria of a rod for many values of some keys at once, without an object for each.

The formulas are those of a single problem; they take one more axis, of the members.  The values are put into copies of
the parameter objects, which are not validated again: their ranges are checked before, a whole column at a time.  Every
member gets the bits of its single run, because `cosserat.solvers.many` solves one body as an array of one.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from cosserat.errors import UnsupportedRodError
from cosserat.problems.static import FIELDS, RodStatics, State, check_supports
from cosserat.quantities import Quantity
from cosserat.rods.elasticity import INCOMPRESSIBLE
from cosserat.rods.energies import energy_named
from cosserat.rods.loads.dead import DeadLoad, Gravity
from cosserat.rods.loads.load import LoadedRod
from cosserat.rods.places import equal_mesh
from cosserat.rods.problem import LOADS
from cosserat.rods.reference import Geometry
from cosserat.rods.resolution import coarse, surface_stretch
from cosserat.rods.rod import Rod
from cosserat.rods.sections.plain import Circle, Ellipse, Rectangle, Square
from cosserat.rods.space import RodSpace
from cosserat.solution import Field, Many
from cosserat.solvers.banded import Mask
from cosserat.solvers.many import Family
from cosserat.solvers.members import REACHED, Answers, Members
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]
OF_LOADS = {"forces": "force", "line_loads": "density", "gravity": "g"}
"""Keys of loads that may differ between members, and which number of theirs."""
OF_BODY = (
    "rod.length",
    *(f"rod.section.{name}" for name in ("height", "width", "side", "diameter")),
    *(f"rod.material.{name}" for name in ("young", "poisson", "shear_modulus", "bulk_modulus")),
    *(f"rod.material.{name}" for name in ("density", "line_density")),
)
"""Keys of the rod that may differ between members."""
_SECTIONS = (Rectangle, Square, Ellipse, Circle)
_CHUNK = 2048  # members whose constants are in memory at once


def solve_many(
    problem: RodStatics, columns: Mapping[str, Array], wanted: Sequence[str] = tuple(FIELDS)
) -> Many | None:
    """The equilibria of a rod for many values (M,) of some keys, in SI units; None where they go one by one.

    columns : values by dotted keys, such as "rod.section.height" or "forces.0.force".
    wanted : names of the fields to give, of `cosserat.problems.static.FIELDS`.
    """
    count = next(iter(columns.values())).size
    family = _family(problem, columns)
    if family is None:
        return None
    parts = []
    for first in range(0, count, _CHUNK):
        own = {key: values[first : first + _CHUNK] for key, values in columns.items()}
        if not in_range(problem, own).any():
            return None  # the problem of each says why
        parts.append(_solve(problem, own, wanted, *family))
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


def fits(problem: RodStatics, key: str, columns: Mapping[str, Array]) -> bool:
    """Whether a key may differ between members of this problem; columns : all keys that differ."""
    if key not in OF_BODY:
        kind, *_, number = key.split(".")
        return OF_LOADS.get(kind) == number and quantity_of(problem, key) is not None
    rod = problem.rod
    if quantity_of(problem, key) is None or type(rod.section) not in _SECTIONS:
        return False
    if problem.gravity is not None and problem.masses:
        return False
    if rod.energy != "consistent" or rod.stations or not rod.rest.straight or problem.imperfection:
        return False
    return key != "rod.length" or not _has_places(problem)


def _has_places(problem: RodStatics) -> bool:
    """Whether it names a place in metres, which another length would move."""
    places = [item.at for _, item in problem.constraints()]
    places += [item.at for key in ("masses", "probes") for item in getattr(problem, key)]
    places += [at for load in LOADS for item in problem.loads_of(load) for at in item.places]
    stretched = any(item.start or item.end is not None for item in problem.line_loads)
    return stretched or not all(at in ("first", "last") or isinstance(at, int) for at in places)


def quantity_of(problem: RodStatics, key: str) -> Quantity | None:
    """The range of a key that has a number; None if it has none."""
    at: Any = problem
    *path, last = key.split(".")
    for part in path:
        at = _child(at, part)
    if at is None or getattr(at, last, None) is None:
        return None
    field = type(at).model_fields[last]
    marks = [*field.metadata, *(mark for part in get_args(field.annotation) for mark in _marks(part))]
    return next((mark for mark in marks if isinstance(mark, Quantity)), None)


def _marks(annotation: Any) -> tuple[Any, ...]:
    return getattr(annotation, "__metadata__", ())


def _child(at: Any, part: str) -> Any:
    """A part of a parameter object or of a list; None if there is none."""
    if isinstance(at, tuple):
        return at[int(part)] if part.isdecimal() and int(part) < len(at) else None
    return getattr(at, part, None)


def put_inside(at: Any, path: Sequence[str], values: Array | float) -> Any:
    """A copy of a parameter object or a list with values in place of a number, not validated."""
    if not path:
        return values
    head, *rest = path
    if isinstance(at, tuple):
        changed = put_inside(at[int(head)], rest, values)
        return (*at[: int(head)], changed, *at[int(head) + 1 :])
    return at.model_copy(update={head: put_inside(getattr(at, head), rest, values)})


def in_range(problem: RodStatics, columns: Mapping[str, Array]) -> Mask:
    """Which members, (M,), have values that a single problem would accept."""
    found = np.ones(next(iter(columns.values())).size, dtype=np.bool_)
    for key, values in columns.items():
        quantity = quantity_of(problem, key)
        assert quantity is not None  # the caller has looked
        found &= quantity.holds(values)
    if not any(key.startswith("rod.material.") for key in columns):
        return found
    with np.errstate(all="ignore"):
        poisson = np.broadcast_to(_with(problem, columns).rod.poisson, (found.size, 1))[:, 0]
    found &= (poisson > -1) & (poisson < 0.5)
    if problem.rod.lateral_constraint == "incompressible":
        found &= poisson >= INCOMPRESSIBLE
    return found


def _with(problem: RodStatics, columns: Mapping[str, Array]) -> RodStatics:
    """A copy with columns (M, 1) in place of numbers."""
    for key, values in columns.items():
        problem = put_inside(problem, key.split("."), values[:, None])
    return problem


def members_of(
    problem: RodStatics, columns: Mapping[str, Array], system: MechanicalSystem
) -> tuple[Members, Geometry, Rod]:
    """The numbers of all members, their reference configurations, and their rod with columns in place of numbers.

    system : of the problem itself.
    """
    varied = _with(problem, columns)
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
    wanted: Sequence[str],
    family: Family,
    system: MechanicalSystem,
) -> Many:
    """The equilibria of some members."""
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
    warnings = {int(places[m]): found for m in np.flatnonzero(solved) if (found := coarse(d[m]))}
    done = np.zeros(sound.size, dtype=np.bool_)
    done[sound] = solved
    labels = {"axis": rod.kinematics.axes, "dof": rod.kinematics.dofs}
    return Many(fields, _statistics(answers, sound), labels, done, warnings)


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
    fields = {
        name: (dims, np.concatenate([part.fields[name][1] for part in parts]))
        for name, (dims, _) in first.fields.items()
    }
    statistics = {
        name: np.concatenate([part.statistics[name] for part in parts]) for name in first.statistics
    }
    warnings = {
        int(start) + number: said
        for start, part in zip(counts[:-1], parts, strict=True)
        for number, said in part.warnings.items()
    }
    solved = np.concatenate([part.solved for part in parts])
    return replace(first, fields=fields, statistics=statistics, solved=solved, warnings=warnings)
