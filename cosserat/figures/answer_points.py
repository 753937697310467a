"""Read-outs of scattered members over each key, with the means in intervals of the key: the main effects."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.figures.answers import (
    COLOURS,
    MOST_PANELS,
    choices,
    head,
    is_axis,
    is_logarithmic,
    is_points,
    label_axis,
    legend,
    mark_failed,
    panel_title,
)
from cosserat.figures.style import canvas
from cosserat.studies.analysis.answered import dims_of, keys_along, solved

Array = NDArray[np.float64]
_MOST_BINS = 10
_IN_A_BIN = 8  # members at least, of which a mean is drawn
_MOST_POINTS = 4000  # in one panel: more hide each other


def pairs(data: xr.Dataset, names: tuple[str, ...]) -> Figure:
    """Read-outs over keys: a row for each read-out, a column for each number that is varied.

    A factor with names, if there is one, colours the points.
    """
    flat, groups = _flattened(data)
    keys = _keys(data)
    kept = _most_telling(flat, keys, names) if len(keys) > MOST_PANELS else keys
    columns, rows = len(kept), len(names)
    figure, axes = canvas(max(2.2 * columns + 0.9, 4.2), 2.0 * rows + 0.6, rows, columns)
    for number, ax in enumerate(axes):  # a column has one key, a row one read-out
        ax.sharex(axes[number % columns])
        ax.sharey(axes[number - number % columns])
    for number, ax in enumerate(axes):
        name, key = names[number // columns], kept[number % columns]
        for (word, members), colour in zip(groups, COLOURS, strict=False):
            _draw_panel(ax, flat.isel(member_=members), key, name, colour, word)
        if number // columns == rows - 1:
            label_axis(ax.xaxis, data[key])
        else:
            ax.tick_params(labelbottom=False)
        if number % columns == 0:
            label_axis(ax.yaxis, data[name], name)
            ax.set_title(panel_title(data[name]))
        else:
            ax.tick_params(labelleft=False)
        if ax.get_xscale() == "linear":
            ax.locator_params(axis="x", nbins=5)
    head(figure, data)
    legend(figure, axes)
    return figure


def _keys(data: xr.Dataset) -> list[str]:
    """The varied numbers of scattered members and of grids."""
    found: list[str] = []
    for dim in dims_of(data):
        if is_axis(data, dim):
            found.append(dim)
        elif is_points(data, dim):
            found += [key for key in keys_along(data, dim) if data[key].dtype.kind in "fi"]
    return found


def _flattened(data: xr.Dataset) -> tuple[xr.Dataset, list[tuple[str, NDArray[np.int64]]]]:
    """All members along one dimension, and the numbers of those of each choice of names."""
    dims = dims_of(data)
    named = [dim for dim in dims if not is_axis(data, dim) and not is_points(data, dim)]
    numbers = np.arange(data["status"].size).reshape(data["status"].shape)
    order = [dims.index(dim) for dim in named]
    groups = [
        (word, np.moveaxis(numbers, order, range(len(order)))[tuple(picked.values())].ravel())
        for word, picked in choices(data, named)
    ]
    wanted = [
        *_keys(data),
        "status",
        *(str(n) for n, v in data.data_vars.items() if set(v.dims) == set(dims)),
    ]
    flat = xr.Dataset(
        {
            name: (
                "member_",
                data[name].broadcast_like(data["status"]).transpose(*dims).to_numpy().ravel(),
            )
            for name in dict.fromkeys(wanted)
        }
    )
    return flat, groups if len(groups) <= len(COLOURS) else [("", numbers.ravel())]


def _most_telling(flat: xr.Dataset, keys: list[str], names: tuple[str, ...]) -> list[str]:
    """The keys whose means move a read-out most, as a part of its deviation; in their order."""

    def moved(key: str) -> float:
        found = [0.0]
        for name in names:
            x, y = _solved_values(flat, key, name)
            if x.size:
                _, means = binned(x, y)
                found.append(float(np.std(means) / (np.std(y) or 1.0)))
        return max(found)

    first = sorted(keys, key=moved, reverse=True)[:MOST_PANELS]
    return [key for key in keys if key in first]


def _solved_values(flat: xr.Dataset, key: str, name: str) -> tuple[Array, Array]:
    x, y = flat[key].to_numpy().astype(np.float64), flat[name].to_numpy()
    there = solved(flat).to_numpy() & np.isfinite(x) & np.isfinite(y)
    return x[there], y[there]


def binned(x: Array, y: Array) -> tuple[Array, Array]:
    """Mean places and values of members in intervals of equal numbers of them, or at each value if these are few."""
    places = np.unique(x)
    if places.size <= _MOST_BINS:
        groups = [x == place for place in places]
    else:
        bins = int(np.clip(x.size // _IN_A_BIN, 1, _MOST_BINS))
        number = np.empty(x.size, dtype=np.int64)
        number[np.argsort(x, kind="stable")] = np.arange(x.size) * bins // x.size
        groups = [number == k for k in range(bins)]
    return np.array([x[group].mean() for group in groups]), np.array(
        [y[group].mean() for group in groups]
    )


def _draw_panel(ax: Axes, flat: xr.Dataset, key: str, name: str, colour: str, word: str) -> None:
    """The members of one group over one key, their means, and crosses at the lower edge where there is no answer."""
    x, y = _solved_values(flat, key, name)
    if is_logarithmic(flat[key].to_numpy()):
        ax.set_xscale("log")
    shown = slice(None, None, -(-x.size // _MOST_POINTS) or 1)
    ax.plot(x[shown], y[shown], ".", color=colour, markersize=3, alpha=0.45, label=word or "member")
    if x.size:
        label = "mean of members nearby" if not word else f"{word}: mean nearby"
        ax.plot(*binned(x, y), color=colour, linewidth=1.8, marker="o", markersize=3.5, label=label)
    mark_failed(ax, flat[key].to_numpy()[~solved(flat).to_numpy()])
