"""Measured fronts: tables of time and position, as rows or CSV files."""

from __future__ import annotations

from typing import Annotated, Literal

from cosserat.parameters import Parameters, Quantity
from cosserat.tables import Columns, Rows


class Measured(Parameters):
    """The path of one front, or of the point that holds on, as it was measured."""

    front: Literal["gamma", "eta", "anchor"]
    """Which path it is: of a front gamma or eta, or of the anchored point."""
    table: Annotated[Rows, Columns((("time", "s"), ("front", "m")))]
    """Times since the start of a stride, and distances from the rear end along the resting body."""
    length: Annotated[float, Quantity("m", r"\ell_0", "2.3.4", above=0)]
    """Length of the resting body that was measured; distances are taken as fractions of it."""
