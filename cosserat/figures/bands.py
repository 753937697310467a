"""Uncertainty bands of a curve: filled between quantiles, with the median as a line."""

from __future__ import annotations

import itertools
import textwrap

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.data.dataset import name_of
from cosserat.data.variables import LABELS
from cosserat.errors import InputError
from cosserat.figures.answers import COLOURS, MOST_PANELS, choices, label_axis, legend
from cosserat.figures.style import canvas, plain, title_of

Array = NDArray[np.float64]
_PLACES = ("time", "xi", "xi_edge", "xi_section")
"""Coordinates along a curve, those first that are taken first."""


def picture(data: xr.Dataset) -> Figure:
    """The bands of `cosserat.bands`: a panel for each component, a colour for each choice of the other factors.

    Raises
    ------
    InputError : the variable is a curve along more than one dimension, or there are too many panels or colours.
    """
    name = str(data.attrs["bands"])
    values = data[name]
    factors = list(map(str, data["used"].dims))
    others = [str(dim) for dim in values.dims if dim not in (*factors, "quantile")]
    components = [dim for dim in others if dim in LABELS]
    along = [dim for dim in others if dim not in LABELS]
    if len(along) != 1:
        said = f"has curves along {' and '.join(along)}" if along else "has no curve"
        raise InputError(
            f"'{name}' of {name_of(data)} {said}; take the bands of one, such as answer.isel(vertex=-1) or "
            "answer.isel(time=-1)"
        )
    panels, groups = choices(data, components), choices(data, factors)
    if len(panels) > MOST_PANELS or len(groups) > len(COLOURS):
        raise InputError(
            f"'{name}' of {name_of(data)} has {len(panels)} components and {len(groups)} choices of other factors, and "
            f"{MOST_PANELS} and {len(COLOURS)} can be drawn; take the bands of a part of the answer"
        )
    columns = min(2, len(panels))
    rows = -(-len(panels) // columns)
    figure, axes = canvas(3.6 * columns + (1.5 if columns == 1 else 0), 2.6 * rows + 0.4, rows, columns)
    place = next((data[p] for p in _PLACES if p in data.coords and data[p].dims == (along[0],)), None)
    x: Array = (np.arange(data.sizes[along[0]]) if place is None else place.to_numpy()).astype(
        np.float64
    )
    for ax, (component, picked) in zip(axes, panels, strict=False):
        for (word, group), colour in zip(groups, COLOURS, strict=False):
            _draw(ax, x, values.isel({**picked, **group}), colour, word)
        label_axis(ax.yaxis, values, f"{name} {component}".strip())
        if place is None:
            ax.set_xlabel(f"{along[0]} [1]")
        else:
            label_axis(ax.xaxis, place, "time" if place.name == "time" else "arc length")
    for ax in axes[len(panels) :]:
        ax.remove()
    width = int(14 * figure.get_size_inches()[0])
    used = data["used"].to_numpy()
    members = f"{used.min()}" + (f" to {used.max()}" if used.max() > used.min() else "")
    said = f"{title_of(data)}: {plain(name).replace('_', ' ')} of {members} members"
    figure.suptitle(textwrap.fill(said, width), x=0.01, ha="left", fontsize=9)
    legend(figure, axes[: len(panels)])
    return figure


def _draw(ax: Axes, x: Array, values: xr.DataArray, colour: str, word: str) -> None:
    """The bands of one curve, the widest first, and the median if it is there."""
    levels = values["quantile"].to_numpy()
    rows = values.transpose("quantile", ...).to_numpy()
    before = f"{word}: " if word else ""
    for low, high in itertools.takewhile(
        lambda pair: pair[0] < pair[1],
        zip(range(levels.size), range(levels.size - 1, -1, -1), strict=True),
    ):
        label = f"{before}{100 * levels[low]:g} to {100 * levels[high]:g} %"
        alpha = 0.22 + 0.2 * low / levels.size
        ax.fill_between(x, rows[low], rows[high], color=colour, alpha=alpha, linewidth=0, label=label)
    if levels.size % 2:
        middle = levels.size // 2
        name = "median" if levels[middle] == 0.5 else f"{100 * levels[middle]:g} %"
        ax.plot(x, rows[middle], color=colour, label=f"{before}{name}")
