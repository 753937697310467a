"""Pictures of the answer of a study, by what is varied: lines, maps, or points with main effects."""

from __future__ import annotations

import itertools
import re
import textwrap
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter
from numpy.typing import NDArray

from cosserat.data.dataset import name_of
from cosserat.errors import InputError
from cosserat.export.members import dims_of_members
from cosserat.figures.style import (
    BODY,
    COMPUTED,
    CONSISTENT,
    EXACT,
    INK,
    VARIANT,
    canvas,
    plain,
    title_of,
)
from cosserat.studies.analysis.answered import dims_of, keys_along, read_outs, solved, unit_of
from cosserat.studies.answer import counts

Array = NDArray[np.float64]
COLOURS = (COMPUTED, VARIANT, CONSISTENT, "#7b4ea3", "#b8860b", "#1f9e9e", INK, EXACT)
"""Colours of lines and groups of points, in their order."""
_SHADES = LinearSegmentedColormap.from_list("answers", ["#eef4fa", BODY, "#3f8fd0"])
MOST_PANELS = 6
"""Most read-outs, and most keys, in one picture."""
_SHORT = (0.09, 1e4)  # sizes of numbers that are short as they are
_SIMPLE = ("m", "N", "Pa", "J", "Hz", "W")
_PREFIXES = {-9: "n", -6: "µ", -3: "m", 3: "k", 6: "M", 9: "G"}
_LOG = 30.0  # from this ratio of the ends on, values with equal ratios have a logarithmic axis
FAILED: dict[str, Any] = {
    "marker": "x",
    "color": "#b00020",
    "linestyle": "none",
    "markersize": 5,
    "zorder": 6,
}
"""How a member without an answer is marked."""
_MARK, _LETTER, _LINE = 0.6, 0.065, 0.2  # sizes of a legend [in]
NO_ANSWER = "no answer"
"""What the legend says of these."""


def picture(data: xr.Dataset) -> Figure:
    """The picture of `cosserat plot` for the answer of a study.

    One varied number gives lines, one panel for each read-out and a line for each value of a factor with names.  Two
    numbers on a grid give maps with contours.  Points, or more numbers, give the read-outs over each key, with the
    means of the members in intervals of the key.  Members without an answer are marked.

    Raises
    ------
    InputError : the answer has no read-out, or no member has an answer.
    """
    data = _with_status(data)
    names = read_outs(data)[:MOST_PANELS]
    if not names:
        raise InputError(
            f"{name_of(data)} keeps no read-out to draw; keep one, or draw a whole variable with cosserat.bands"
        )
    if not dims_of(data):
        raise InputError(
            f"{name_of(data)} is one member of an answer; run it by itself and draw its result"
        )
    if not bool(solved(data).any()):
        raise InputError(
            f"{name_of(data)} has no member with an answer; see the reasons with 'cosserat show'"
        )
    numbers = [dim for dim in dims_of(data) if is_axis(data, dim)]
    scattered = [dim for dim in dims_of(data) if is_points(data, dim)]
    if scattered or len(numbers) > 2:
        from cosserat.figures.answer_points import pairs

        return pairs(data, names)
    if len(numbers) == 2:
        return maps(data, names, *numbers)
    return lines(data, names, numbers[0] if numbers else None)


def _with_status(data: xr.Dataset) -> xr.Dataset:
    """An answer; where a user took variables without "status", every member counts as solved and none is said to be."""
    dims = dims_of_members(data)
    if "status" in data:
        return data
    none = np.zeros([data.sizes[dim] for dim in dims], dtype=np.int8)
    return data.assign(status=(dims, none, {"assumed": 1}))


def is_axis(data: xr.Dataset, dim: str) -> bool:
    """Whether a dimension is one varied number, and so an axis of a picture."""
    return dim in data.coords and "key" in data[dim].attrs and data[dim].dtype.kind in "fi"


def is_points(data: xr.Dataset, dim: str) -> bool:
    """Whether the members along a dimension are points of several numbers, without names."""
    named = dim in data.coords and data[dim].dtype.kind not in "fi"
    numbers = [key for key in keys_along(data, dim) if data[key].dtype.kind in "fi"]
    return not is_axis(data, dim) and not named and bool(numbers)


def head(figure: Figure, data: xr.Dataset) -> None:
    """The title over all panels, with the counts of members."""
    width = int(14 * figure.get_size_inches()[0])
    status = data["status"]
    known = f"{status.size} members" if "assumed" in status.attrs else counts(data)
    said = textwrap.fill(f"{title_of(data)}: {known}", width)
    figure.suptitle(said, x=0.01, ha="left", fontsize=9)


def label_axis(axis: Axis, values: xr.DataArray, name: str = "") -> None:
    """Name and unit of an axis, with a prefix of the unit where the numbers are long; a long name is broken."""
    power = 0 if axis.get_scale() == "log" else power_of(values.to_numpy())
    if power:
        axis.set_major_formatter(FuncFormatter(lambda number, _: f"{number / 10**power:g}"))
    name = textwrap.fill(plain(name or str(values.name)).replace("_", " "), 26)
    axis.set_label_text(f"{name} [{_unit(unit_of(values), power)}]")


def power_of(values: Array) -> int:
    """The power of ten, a multiple of three, in which an axis counts; 0 where the numbers are short as they are."""
    largest = float(np.abs(values[np.isfinite(values)]).max(initial=0.0))
    if largest == 0 or _SHORT[0] <= largest < _SHORT[1]:
        return 0
    return 3 * int(np.floor(np.log10(largest) / 3))


def _unit(unit: str, power: int) -> str:
    """A unit with a power of ten before it: as a prefix if it is simple."""
    if power and unit in _SIMPLE and power in _PREFIXES:
        return f"{_PREFIXES[power]}{unit}"
    raised = re.sub(r"([A-Za-z])(-?\d+)", r"\1$^{\2}$", plain(unit))
    return rf"$10^{{{power}}}$ {raised}" if power else raised


def panel_title(values: xr.DataArray) -> str:
    """What a read-out is."""
    return textwrap.fill(plain(values.attrs.get("read_out", values.name)), 36)


def is_logarithmic(values: Array) -> bool:
    """Whether positive values have equal ratios rather than equal steps, over a wide range."""
    ordered = np.unique(values)
    if ordered.size < 3 or ordered[0] <= 0 or ordered[-1] < _LOG * ordered[0]:
        return False
    steps, ratios = np.diff(ordered), np.diff(np.log(ordered))
    return bool(np.ptp(ratios) / ratios.mean() < np.ptp(steps) / steps.mean())


def legend(figure: Figure, axes: list[Axes]) -> None:
    """One legend below all panels, for what they have in common."""
    found = {
        label: handle
        for ax in axes
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)
    }
    if not found:
        return
    if NO_ANSWER in found:
        found[NO_ANSWER] = found.pop(NO_ANSWER)  # last
    width, height = figure.get_size_inches()
    fitting = max(1, int(width / (_MARK + _LETTER * max(map(len, found)))))
    rows = -(-len(found) // fitting)
    figure.set_size_inches(width, height + _LINE * rows)
    handles, columns = list(found.values()), -(-len(found) // rows)
    figure.legend(handles, list(found), loc="outside lower left", ncols=columns, fontsize=8)


def choices(data: xr.Dataset, dims: list[str]) -> list[tuple[str, dict[str, int]]]:
    """Every combination of values along some dimensions, in words and by number."""
    found = []
    for index in itertools.product(*(range(data.sizes[dim]) for dim in dims)):
        picked = dict(zip(dims, index, strict=True))
        words = [_word(data, dim, k) for dim, k in picked.items()]
        found.append((", ".join(words), picked))
    return found


def _word(data: xr.Dataset, dim: str, number: int) -> str:
    if dim not in data.coords:
        return f"{dim} {number}"
    value = data[dim].to_numpy()[number]
    if data[dim].dtype.kind == "f":
        return plain(f"{dim} = {value:.5g} {unit_of(data[dim])}")
    return plain(value if data[dim].dtype.kind not in "iu" else f"{dim} {value}")


def lines(data: xr.Dataset, names: tuple[str, ...], along: str | None) -> Figure:
    """Read-outs over one varied number, or over names where none is a number; a line for each other choice."""
    dims = [dim for dim in dims_of(data) if dim != along]
    if along is None:
        along, dims = dims[-1], dims[:-1]
    rows = -(-len(names) // 2) if len(names) > 1 else 1
    columns = min(2, len(names))
    figure, axes = canvas(3.6 * columns + (1.5 if columns == 1 else 0), 2.6 * rows + 0.4, rows, columns)
    every = choices(data, dims)
    if len(every) > len(COLOURS):
        raise InputError(
            f"{name_of(data)} would have {len(every)} lines in a panel, and {len(COLOURS)} can be told apart; draw a "
            f"part of it, such as answer.isel({dims[0]}=[0, 1])"
        )
    numbers = is_axis(data, along)
    x: Array = (data[along].to_numpy() if numbers else np.arange(data.sizes[along])).astype(np.float64)
    order = np.argsort(x)
    for ax, name in zip(axes, names, strict=False):
        values = data[name].where(solved(data))
        for (word, picked), colour in zip(every, COLOURS, strict=False):
            y = values.isel(picked).to_numpy()
            style: dict[str, Any] = {"marker": "."} if numbers else {"marker": "o", "linestyle": "none"}
            ax.plot(x[order], y[order], color=colour, label=word or None, **style)
        mark_failed(ax, x[(~solved(data)).any(dims).to_numpy()])
        label_axis(ax.yaxis, values, name)
        ax.set_title(panel_title(values))
        if numbers:
            ax.set_xscale("log" if is_logarithmic(x) else "linear")
            label_axis(ax.xaxis, data[along])
        else:
            words = [textwrap.fill(_word(data, along, k), 14) for k in range(x.size)]
            ax.set_xticks(x, words, rotation=0 if x.size <= 4 else 90)
            ax.set_xlabel(f"{plain(along)}".replace("_", " "))
            ax.margins(x=0.15)
    for ax in axes[len(names) :]:
        ax.remove()
    head(figure, data)
    legend(figure, axes[: len(names)])
    return figure


def mark_failed(ax: Axes, places: Array) -> None:
    """Crosses at the lower edge of a panel, where a member has no answer."""
    if places.size:
        edge = np.full(places.size, 0.0)
        ax.plot(
            places, edge, transform=ax.get_xaxis_transform(), clip_on=False, label=NO_ANSWER, **FAILED
        )


def maps(data: xr.Dataset, names: tuple[str, ...], upward: str, across: str) -> Figure:
    """Read-outs over two varied numbers: a map with contours, a row for each read-out and a column for each choice."""
    every = choices(data, [dim for dim in dims_of(data) if dim not in (upward, across)])
    if len(every) > MOST_PANELS:
        raise InputError(
            f"{name_of(data)} would have {len(every)} maps beside each other, and {MOST_PANELS} fit; draw a part of "
            "it, such as answer.isel(...)"
        )
    single = len(every) == 1
    columns = min(2, len(names)) if single else len(every)
    rows = -(-len(names) // columns) if single else len(names)
    figure, axes = canvas(3.7 * columns + 0.2, 2.9 * rows + 0.4, rows, columns)
    for ax, (name, (word, picked)) in zip(axes, itertools.product(names, every), strict=False):
        values = data[name].where(solved(data)).isel(picked).transpose(upward, across)
        _draw_map(figure, ax, values, upward, across)
        said = panel_title(data[name]) + (f"\n{word}" if word else "")
        label_axis(ax.xaxis, data[across])
        label_axis(ax.yaxis, data[upward])
        ax.set_title(said)
    for ax in axes[len(names) * len(every) :]:
        ax.remove()
    head(figure, data)
    legend(figure, axes[: len(names) * len(every)])
    return figure


def _edges(places: Array) -> Array:
    """The ends of cells round places, (n + 1,), half way between them along their axis."""
    on = np.log(places) if is_logarithmic(places) else places
    inner = (on[1:] + on[:-1]) / 2
    half = (on[1] - on[0], on[-1] - on[-2]) if on.size > 1 else (abs(on[0]) or 1.0,) * 2
    ends = np.concatenate([[on[0] - half[0] / 2], inner, [on[-1] + half[1] / 2]])
    return np.exp(ends) if is_logarithmic(places) else ends


def _draw_map(figure: Figure, ax: Axes, values: xr.DataArray, upward: str, across: str) -> None:
    """One map; members without an answer are left white, with a cross."""
    y, x = values[upward].to_numpy(), values[across].to_numpy()
    rows, columns = np.argsort(y), np.argsort(x)
    y, x, z = y[rows], x[columns], values.to_numpy()[np.ix_(rows, columns)]
    ax.set_xscale("log" if is_logarithmic(x) else "linear")
    ax.set_yscale("log" if is_logarithmic(y) else "linear")
    drawn = ax.pcolormesh(_edges(x), _edges(y), np.ma.masked_invalid(z), cmap=_SHADES)
    bar = figure.colorbar(drawn, ax=ax)
    label_axis(bar.ax.yaxis, values)
    if min(z.shape) > 1 and np.isfinite(z).sum() > 3 and np.nanmax(z) > np.nanmin(z):
        curves = ax.contour(x, y, np.ma.masked_invalid(z), levels=6, colors=INK, linewidths=0.7)
        bar.add_lines(
            curves
        )  # where the bar has their values, they need no labels, which would meet each other
    lost = np.argwhere(~np.isfinite(z))
    if lost.size:
        ax.plot(x[lost[:, 1]], y[lost[:, 0]], label=NO_ANSWER, **FAILED)
    ax.grid(visible=False)
