"""The drawn page of frames and signs, for the book."""

from __future__ import annotations

from collections.abc import Mapping

import xarray as xr
from matplotlib.figure import Figure

from cosserat.figures import conventions


def fig_conventions(_: Mapping[str, xr.Dataset]) -> Figure:
    """Axes and surfaces of a rod, positive forces at a cut, and stresses."""
    return conventions.picture()
