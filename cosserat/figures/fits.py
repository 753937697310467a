"""Fits: what was measured over what is fitted, and the residuals in standard deviations."""

from __future__ import annotations

import textwrap

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cosserat.figures.answers import label_axis
from cosserat.figures.style import COMPUTED, EXACT, INK, canvas, plain, title_of

_MOST_CONDITIONS = 1
"""Number of keys that differ from row to row, up to which residuals are drawn over them, and not over the row."""


def picture(data: xr.Dataset) -> Figure:
    """The picture of `cosserat.plot` for a fit: a row of two panels for each read-out.

    Left, measured values with their deviations over fitted ones, with the line where both are equal; right, residuals
    over the key that differs, or over the number of the row, in deviations that are scaled to the spread of all.
    """
    names = [
        str(name).removesuffix("_fitted") for name in data.data_vars if str(name).endswith("_fitted")
    ]
    figure, axes = canvas(7.2, 2.7 * len(names) + 0.4, len(names), 2)
    for number, name in enumerate(names):
        _draw_values(axes[2 * number], data, name)
        _draw_residuals(axes[2 * number + 1], data, name)
    width = int(14 * figure.get_size_inches()[0])
    parameters = [
        f"{word} {data[word].item():.4g} [{data[f'{word}_low'].item():.4g}, {data[f'{word}_high'].item():.4g}]"
        f" {data[word].attrs['units']}"
        for word in map(str, data["parameter"].to_numpy())
    ]
    said = f"{title_of(data)}: {plain(', '.join(parameters))}"
    figure.suptitle(textwrap.fill(said, width), x=0.01, ha="left", fontsize=9)
    return figure


def _draw_values(ax: Axes, data: xr.Dataset, name: str) -> None:
    """Measured over fitted values."""
    fitted, measured = data[f"{name}_fitted"], data[f"{name}_measured"]
    ends = [float(fitted.min()), float(fitted.max())]
    ax.plot(ends, ends, color=EXACT, linestyle=":")
    spread = data.get(f"{name}_deviation")
    ax.errorbar(
        fitted, measured, None if spread is None else spread, fmt=".", color=COMPUTED, elinewidth=0.8
    )
    label_axis(ax.xaxis, fitted, f"{name}, fitted")
    label_axis(ax.yaxis, measured, f"{name}, measured")


def _draw_residuals(ax: Axes, data: xr.Dataset, name: str) -> None:
    """Residuals over their standard deviation."""
    own = data.get(f"{name}_deviation")
    scale = np.sqrt(float(data.attrs["reduced_chi_square"]))
    left = data[f"{name}_residual"] / (scale * (1.0 if own is None else own))
    differing = [
        data[str(key)]
        for key, values in data.coords.items()
        if values.dims == ("row",) and key != "row" and values.dtype.kind == "f"
    ]
    ax.axhline(0.0, color=INK, linewidth=0.8)
    for edge in (-2.0, 2.0):
        ax.axhline(edge, color=EXACT, linewidth=0.8, linestyle=":")
    if len(differing) == _MOST_CONDITIONS:
        ax.plot(differing[0], left, ".", color=COMPUTED)
        label_axis(ax.xaxis, differing[0])
    else:
        ax.plot(data["row"], left, ".", color=COMPUTED)
        ax.set_xlabel("row of the data")
    ax.set_ylabel(f"{plain(name)}: residual / deviation")
