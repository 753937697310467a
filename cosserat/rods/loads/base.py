"""Motion of the base that carries the supports: displacements are relative to it, and inertia becomes a load."""

from __future__ import annotations

from typing import Annotated, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Quantity
from cosserat.rods.loads.dead import DeadLoad
from cosserat.rods.loads.load import LoadedRod
from cosserat.rods.naming import Direction, unit_vector
from cosserat.rods.time_functions import Table, TimeFunction
from cosserat.solvers.banded import band_product
from cosserat.tables import Columns, Rows

Array = NDArray[np.float64]


class Record(Table):
    """A record with straight lines between its rows, zero before and after."""

    def derivatives(self, t: Array) -> tuple[Array, Array, Array]:
        """Those of the table, zero outside."""
        inside = (t >= self.rows[0][0]) & (t < self.rows[-1][0])
        value, rate, second = super().derivatives(t)
        return inside * value, inside * rate, inside * second


class BaseMotion(DeadLoad):
    """Acceleration a of the base.  The load is -M a; displacements, velocities and damping are relative to the base.

    A constant one begins at time zero: no equilibrium from which a motion starts has it.
    """

    along: Direction
    """Direction of the acceleration."""
    acceleration: Annotated[float, Quantity("m/s^2")] | None = None
    """Acceleration, times its function of time if it has one."""
    record: Annotated[Rows, Columns((("time", "s"), ("acceleration", "m/s^2")))] | None = None
    """Accelerations over time, in place of `acceleration`; zero before and after."""

    @model_validator(mode="after")
    def _one(self) -> Self:
        if (self.acceleration is None) == (self.record is None):
            raise PydanticCustomError("either", "needs 'acceleration' or 'record', just one of them")
        if self.record is not None and self.time_function is not None:
            raise PydanticCustomError(
                "either", "has a 'record' and a 'time_function'; leave one of them out"
            )
        return self

    @property
    def level(self) -> TimeFunction | None:
        """The record, or the function of time."""
        return self.time_function if self.record is None else Record(rows=self.record)

    def on_dofs(self, body: LoadedRod) -> Array:
        """Inertia against the acceleration, or against one of 1 m/s^2 for a record."""
        field = body.no_force
        size = 1.0 if self.acceleration is None else self.acceleration
        field[:, :2] = -size * unit_vector(self.along)
        return band_product(body.mass, field.ravel()).reshape(field.shape)
