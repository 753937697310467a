"""Equilibria that move with keys of a case whose formulas take columns: no object is made for each step.

`cosserat.problems.many` puts the values after all steps of all keys into the formulas of a single problem, as if they
were members of a study.  So a derivative needs neither a validated problem nor a system for each step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cosserat.problems.many import family_of, fits, in_range, members_of
from cosserat.problems.static import RodStatics
from cosserat.problems.tangents import Body, Moved, Nearby, NearKey, placed
from cosserat.rods.reference import Geometry
from cosserat.rods.rod import Rod
from cosserat.solvers.equilibrium import Equilibrium
from cosserat.solvers.potential import Potential
from cosserat.solvers.slopes import steps_with
from cosserat.solvers.system import MechanicalSystem

Array = NDArray[np.float64]


@dataclass(frozen=True)
class _Row:
    """The rod after one step of one key.

    vectors : positions and directors of the reference, (N, m, 2) [m].  carried : (n,) DOFs with the strains of no
    step.  dead : (n,) forces of its loads [N].
    """

    geometry: Geometry
    vectors: Array
    carried: Array
    energy: Potential
    dead: Array


class _Rows:
    """The rods after all steps that are taken together, of every key; a step out of range has none."""

    def __init__(
        self, problem: RodStatics, keys: Sequence[NearKey], base: Body, point: Equilibrium
    ) -> None:
        self.problem, self.keys, self.base, self.point = problem, keys, base, point
        self.known: dict[tuple[int, float], _Row | None] = {}

    def row(self, key: int, step: float) -> _Row | None:
        """The rod after a step of a key by its number; None where a single problem has to say."""
        if (key, step) not in self.known:
            sizes = steps_with(step)
            if not sizes:
                return None
            self._compute([sign * size for sign in (1.0, -1.0) for size in sizes])
        return self.known[key, step]

    def _compute(self, steps: Sequence[float]) -> None:
        count = len(steps)
        columns = {near.key: np.full(count * len(self.keys), near.after(0.0)) for near in self.keys}
        for number, near in enumerate(self.keys):
            columns[near.key][number * count : (number + 1) * count] = [near.after(s) for s in steps]
        sound = in_range(self.problem, columns)
        for near in self.keys:
            columns[near.key][~sound] = near.after(0.0)
        members, geometry, rod = members_of(self.problem, columns, self.base.system)
        own = self.base.system.internal
        shape = (sound.size, *self.base.geometry.X.shape)
        X, D = (np.broadcast_to(part, shape) for part in (geometry.X, geometry.D))
        vectors = rod.kinematics.split(rod.strain_energy.reference(Geometry(X, D)))
        carried = placed(
            self.base, self.point.q, np.zeros_like(self.point.q), np.zeros(sound.size), vectors
        )
        for place, (number, step) in enumerate((n, s) for n in range(len(self.keys)) for s in steps):
            constants = members.constants[place].view(own.constants.dtype)
            self.known[number, step] = (
                _Row(
                    Geometry(X[place], D[place]),
                    vectors[place],
                    carried[place],
                    replace(own, constants=constants),
                    members.dead[place],
                )
                if sound[place]
                else None
            )


class MovedRow(Moved):
    """An equilibrium that moves with a key whose formulas take columns."""

    def __init__(self, near: Nearby, base: Body, point: Equilibrium, rows: _Rows, number: int) -> None:
        super().__init__(near, base, point)
        self.rows, self.number = rows, number

    def _row(self, step: float) -> _Row | None:
        return self.rows.row(self.number, step) if step else None

    def system(self, step: float) -> MechanicalSystem:
        """That of no step: a key that takes columns changes neither frames nor constraints."""
        return self.base.system if self._row(step) else super().system(step)

    def reference(self, step: float) -> Array:
        """Positions and directors of the reference after a step, (N, m, 2) [m]."""
        row = self._row(step)
        return super().reference(step) if row is None else row.vectors

    def carried(self, step: float) -> Array:
        """The DOFs after a step with the rotations and stretches of no step, (n,)."""
        row = self._row(step)
        return super().carried(step) if row is None else row.carried

    def shape(self, step: float) -> tuple[Rod, Geometry]:
        """The rod, of which only the layout counts, and its reference after a step."""
        row = self._row(step)
        return super().shape(step) if row is None else (self.base.problem.rod, row.geometry)

    def gradient(self, step: float) -> Array:
        """The gradient of the carried equilibrium after a step, (n,) [N]."""
        row = self._row(step)
        if row is None:
            return super().gradient(step)
        gradient = -self.point.factor * row.dead
        row.energy.add_gradient(self.carried(step), row.energy.history, gradient)
        return gradient


def moved_by_rows(
    problem: RodStatics, nearby: Sequence[Nearby], base: Body, point: Equilibrium
) -> list[Moved]:
    """The equilibrium moving with each parameter, by rows where they can be had."""
    keys = [near for near in nearby if isinstance(near, NearKey) and _takes_columns(problem, near)]
    if not keys or family_of(problem, base.system) is None:
        return [Moved(near, base, point) for near in nearby]
    rows = _Rows(problem, keys, base, point)
    return [
        MovedRow(near, base, point, rows, keys.index(near)) if near in keys else Moved(near, base, point)
        for near in nearby
    ]


def _takes_columns(problem: RodStatics, near: NearKey) -> bool:
    return fits(problem, near.key, {near.key: np.array([near.after(0.0)])})
