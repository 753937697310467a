"""How equilibria of many rods move with keys whose formulas take columns: exactly, with one factorisation each.

derived: such a key changes a straight, uniform rod by its stiffnesses, by its length and its height as fractions, and
by its loads.  If the DOFs grow with these lengths the strains stay, so that the gradient changes with stiffnesses and
loads alone (`cosserat.rods.energies.reissner.softening`), and the Hessian answers that.  Forces do not depend on the
rod; line loads grow with its length, and weights with its mass.  Only rates of products of a few numbers, such as EI,
are differences: of their formulas.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import cast

import numpy as np
from numpy.typing import NDArray

from cosserat.problems.columns import OF_BODY, fits, holds, unit, with_columns
from cosserat.problems.static import FIELDS, RodStatics, State
from cosserat.rods.energies.reissner import SOFTENED, softening
from cosserat.rods.loads.dead import DeadLoad
from cosserat.rods.loads.load import LoadedRod
from cosserat.rods.problem import LOADS
from cosserat.rods.reference import Geometry, StrainRates, Strains
from cosserat.rods.rod import Rod
from cosserat.solution import Field, FieldRates
from cosserat.solvers.banded import Mask
from cosserat.solvers.many import Family
from cosserat.solvers.members import CRITICAL, UNSTABLE, Members, Ways
from cosserat.solvers.slopes import extrapolated, halved
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]
_STEP = 2.0**-10  # of a key: short enough for moduli near nu = 0.5, and their formulas hardly round
_NUMBER = np.dtype(np.float64).itemsize
_ROUGH = 1e-9  # of a stiffness, above which the error of its rate leaves a rod to its own problem


def has_rates(problem: RodStatics, key: str, values: Array) -> bool:
    """Whether equilibria have rates with a key that has these values (M,)."""
    if not fits(problem, key, {key: values}):
        return False
    return key not in OF_BODY or problem.rod.elastic_offset == 0.0


@dataclass(frozen=True)
class Settled:
    """M rods of a family at their equilibria.

    columns : values of keys, each (M,).  system : of the problem itself.  body : of all rods; its numbers may be
    columns (M, 1).  q : (M, n) [m].
    """

    problem: RodStatics
    columns: Mapping[str, Array]
    system: MechanicalSystem
    family: Family
    members: Members
    body: LoadedRod
    q: Array


@dataclass(frozen=True)
class Growth:
    """Rates, as fractions, of the length, the height and the mass of M rods with K keys, each (M, K)."""

    length: Array
    height: Array
    mass: Array


@dataclass(frozen=True)
class Moves:
    """How M equilibria move with K keys, by the step of each: a fraction of its value, or itself where that is zero.

    q, reaction, load : (M, K, n) rates of the DOFs [m] and of forces [N].  rounding : (M, K) of them, as a fraction.
    known : (M, K) which are.  critical : (M,) those at a limit point or a bifurcation, where none exist.
    """

    growth: Growth
    q: Array
    reaction: Array
    load: Array
    rounding: Array
    known: Mask
    critical: Mask


def moves(many: Settled, keys: Sequence[str]) -> Moves:
    """How the equilibria of some rods move with keys among their columns."""
    (count, n), each = many.q.shape, len(keys)
    sizes = halved(_STEP)
    steps = np.array([0.0, *sizes, *(-size for size in sizes)])
    stepped = _stepped(many.columns, keys, steps)
    varied = with_columns(many.problem, stepped)
    sound = holds(many.problem, stepped, varied).reshape(count, each, -1).all(axis=-1)
    growth = Growth(*np.zeros((3, count, each)))
    softens = np.array([key in OF_BODY for key in keys])
    softened, places = np.empty((count * each, 0)), np.empty((0, 0), dtype=np.int64)
    if softens.any():
        own, rates, known = _differenced(varied.rod, (count, each, steps.size))
        sound &= known
        growth = _growth(keys, own, rates)
        softened = softening(own[:6, :, None], rates[:6], growth.length).reshape(count * each, -1)
        places = _places(many.system.internal.constants)
    load = _load_rates(many, keys, growth)
    by_vector = np.stack([growth.length, growth.height], axis=-1)[:, :, None, :, None]
    scaled = np.broadcast_to(by_vector, (count, each, n // 4, 2, 2)).reshape(count * each, n)
    ways = Ways(softened, places, softens, scaled, load.reshape(count * each, n))
    found = many.family.rates(many.members, many.q, ways)
    shape = count, each, n
    return Moves(
        growth,
        found.q.reshape(shape),
        found.reaction.reshape(shape),
        load,
        found.rounding.reshape(count, each),
        sound & (found.status != UNSTABLE)[:, None],
        found.status == CRITICAL,
    )


def _stepped(columns: Mapping[str, Array], keys: Sequence[str], steps: Array) -> dict[str, Array]:
    """Columns of all rods after all steps of each key alone, (M K S,)."""
    found = {}
    for name, values in columns.items():
        rows = np.repeat(values, len(keys) * steps.size).reshape(-1, len(keys), steps.size)
        if name in keys:
            rows[:, keys.index(name)] += steps * unit(values)[:, None]
        found[name] = rows.ravel()
    return found


def _differenced(rod: Rod, shape: tuple[int, int, int]) -> tuple[Array, Array, Mask]:
    """Six stiffnesses, height and line density of rods, (8, M), their rates, (8, M, K), and which are good, (M, K).

    rod : its numbers perhaps columns (M K S, 1), of all S steps of each of K keys.
    """
    with np.errstate(all="ignore"):
        numbers = (*rod.elastic, rod.height, rod.line_density)
        rows = shape[0] * shape[1] * shape[2]
        every = np.stack([np.broadcast_to(part, (rows, 1)).reshape(shape) for part in numbers])
        sizes = halved(_STEP)
        ahead, behind = (
            [every[..., 1 + k + first] for k in range(len(sizes))] for first in (0, len(sizes))
        )
        rates, errors = extrapolated(ahead, behind, sizes)
        good = (errors <= _ROUGH * np.abs(every[..., 0])) | (errors <= _ROUGH * np.abs(rates))
    return every[:, :, 0, 0], rates, good.all(axis=0)


def _growth(keys: Sequence[str], own: Array, rates: Array) -> Growth:
    longer = np.broadcast_to(np.array([float(key == "rod.length") for key in keys]), rates.shape[1:])
    height, line_density = rates[-2:] / own[-2:, :, None]
    return Growth(longer, height, line_density + longer)


def _places(constants: NDArray[np.void]) -> NDArray[np.int64]:
    """Where the constants that soften a rod are among all of its constants as numbers, (N, 6)."""
    at = np.array([constants.dtype.fields[name][1] for name in SOFTENED])  # type: ignore[index] # it has fields
    size = constants.itemsize
    found: NDArray[np.int64] = (np.arange(constants.size)[:, None] * size + at) // _NUMBER
    return found


def _load_rates(many: Settled, keys: Sequence[str], growth: Growth) -> Array:
    """Rates of the loads on the DOFs, (M, K, n) [N]."""
    found = np.zeros((*growth.length.shape, many.q.shape[1]))
    for k, key in enumerate(keys):
        if key not in OF_BODY:
            found[:, k] = _of_load(many, key)
    grown = {"line_loads": growth.length, "gravity": growth.mass}
    named = [name for name in grown if many.problem.loads_of(name) and grown[name].any()]
    varied = with_columns(many.problem, many.columns) if named else many.problem
    for name in named:
        total = LOADS[name].total(varied.loads_of(name), many.body)  # type: ignore[attr-defined] # a dead load
        found += grown[name][..., None] * np.atleast_2d(_flat(total))[:, None]
    return found


def _of_load(many: Settled, key: str) -> Array:
    """The rate of the loads with the number of one of them, (M, n) [N]: its forces are proportional to it."""
    name, *place, number = key.split(".")
    load = many.problem.loads_of(name)[int(place[0]) if place else 0]
    one = cast("DeadLoad", load.model_copy(update={number: 1.0}))
    return np.asarray(unit(many.columns[key])[:, None] * _flat(one.on_dofs(many.body)))


def _flat(forces: Array) -> Array:
    """Forces by vertex (..., N, k) as those on the DOFs, (..., n)."""
    return forces.reshape(*forces.shape[:-2], -1)


class StateRates:
    """Rates of M displaced rods with K keys, each (M, K, ...)."""

    def __init__(self, state: State, moved: Moves) -> None:
        self.state, self.moves = state, moved

    def along(self, lengths: Array) -> Array:
        """Of lengths along the reference, (N,) or (M, N) [m]."""
        return _grown(self.moves.growth.length, lengths, 1)

    @cached_property
    def reference(self) -> tuple[Array, Array]:
        """Of positions and directors of the reference, (M, K, N, 2) [m]."""
        geometry, growth = self.state.geometry, self.moves.growth
        return _grown(growth.length, geometry.X, 2), _grown(growth.height, geometry.D, 2)

    @cached_property
    def moved(self) -> tuple[Array, Array]:
        """Of displacements, likewise."""
        split = self.state.rod.kinematics.split(self.moves.q)
        return split[..., 0, :], split[..., 1, :]

    @cached_property
    def vectors(self) -> tuple[Array, Array]:
        """Of positions and directors, likewise."""
        (X, D), (u, delta) = self.reference, self.moved
        return X + u, D + delta

    @cached_property
    def measured(self) -> StrainRates:
        """Of the strain measures."""
        geometry, growth, vectors = self.state.geometry, self.moves.growth, self.state.vectors[:, None]
        many = Geometry(
            *(part if part.ndim == 2 else part[:, None] for part in (geometry.X, geometry.D))
        )
        strains = self.state.measured
        now = Strains(*(getattr(strains, item.name)[:, None] for item in fields(Strains)))
        places = vectors[..., 0, :], vectors[..., 1, :]
        return StrainRates(many, now, places, self.vectors, (growth.length, growth.height))


def _grown(rate: Array, values: Array, dims: int) -> Array:
    """Rates (M, K, ...) of numbers of `dims` axes of one rod or of M rods, which grow at rates (M, K)."""
    rows = values if values.ndim == dims else values[:, None]
    return np.asarray(rate.reshape(*rate.shape, *(1,) * dims) * rows)


_RATES: dict[str, Callable[[StateRates], Array]] = {
    "xi": lambda r: r.along(r.state.geometry.arc_length),
    "xi_edge": lambda r: r.along(FIELDS["xi_edge"][1](r.state)),
    "x_ref": lambda r: r.reference[0],
    "d_ref": lambda r: r.reference[1],
    "x": lambda r: r.vectors[0],
    "d": lambda r: r.vectors[1],
    "u": lambda r: r.moved[0],
    "delta": lambda r: r.moved[1],
    "mu_edge": lambda r: r.measured.mu_edge,
    "mu": lambda r: r.measured.mu,
    "lam": lambda r: r.measured.lam,
    "phi": lambda r: r.measured.phi,
    "kappa": lambda r: r.measured.kappa,
    "applied_force": lambda r: r.state.of_vertices(r.moves.load),
    "support_force": lambda r: r.state.of_vertices(r.moves.reaction),
}
"""Rates of `cosserat.problems.static.FIELDS`."""


def field_rates(state: State, moved: Moves, names: Iterable[str]) -> FieldRates:
    """Fields of M rods, and their rates with K keys."""
    count, each = moved.known.shape
    rates = StateRates(state, moved)
    now: dict[str, Field] = {}
    change: dict[str, Field] = {}
    for name in names:
        dims, values = FIELDS[name]
        found, rate = values(state), _RATES[name](rates)
        shape = rate.shape[2:]
        now[name] = ("member", *dims), np.broadcast_to(found, (count, *shape))
        change[name] = ("member", *dims), rate.reshape(count * each, *shape)
    labels = {"axis": state.rod.kinematics.axes, "dof": state.rod.kinematics.dofs}
    return FieldRates(now, change, labels, moved.rounding, moved.known & ~moved.critical[:, None])
