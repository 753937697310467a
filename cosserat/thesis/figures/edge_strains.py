"""The strains of one edge of the consistent rod, drawn from the formulas."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.figures.conventions import arrow, label
from cosserat.figures.style import ALONG_E2, ALONG_E3, COMPUTED, EXACT, INK, VARIANT, WIDTH, canvas

Array = NDArray[np.float64]
_AXIAL, _SLIDE = 1.25, -0.3  # a and g of the drawn edge [1]
_HALFWAY, _TURN = np.radians(112), np.radians(44)  # the direction of m, and T [rad]
_DIRECTOR = 0.62  # length of the directors [m]


def fig_edge_strains(data: Mapping[str, xr.Dataset]) -> Figure:
    """An edge with its two directors, the vector half-way between them, and the strains a, g and T."""
    figure, (ax,) = canvas(WIDTH, 3.0)
    m = _unit(_HALFWAY)
    normal = np.array([m[1], -m[0]])
    first, knee = np.zeros(2), _AXIAL * normal
    last = knee + _SLIDE * m
    before, after = (_unit(_HALFWAY + sign * _TURN / 2) for sign in (-1, 1))
    ax.plot(*np.array([first, last]).T, color=INK, marker="o", markersize=5, linewidth=2.2)
    ax.plot(*np.array([first, knee, last]).T, color=VARIANT, linestyle="--")
    for foot, direction, name in ((first, before, "K"), (last, after, "K+1")):
        arrow(ax, foot, _DIRECTOR * direction, COMPUTED)
        above = foot + (_DIRECTOR + 0.08) * direction
        label(ax, above, rf"${{}}_{{{name}}}\mathbf{{d}}$", COMPUTED, ha="center")
    middle = last / 2
    arrow(ax, middle, _DIRECTOR * m, VARIANT)
    label(ax, middle + (_DIRECTOR + 0.07) * m, r"$\mathbf{m}$", VARIANT, ha="center")
    label(ax, 0.72 * last - 0.07 * m, r"$\mathbf{e}$", INK, ha="center", va="top")
    label(ax, 0.62 * knee + 0.06 * m, r"$h\,a$", VARIANT, ha="right", va="bottom")
    label(ax, (knee + last) / 2 + 0.09 * normal, r"$h\,|g|$", VARIANT, va="center")
    tick = normal  # the length of the reference, h = 1 m
    ax.plot(*np.array([tick - 0.05 * m, tick + 0.05 * m]).T, color=EXACT)
    label(ax, tick + 0.07 * m, "$h$", EXACT, ha="center", va="bottom")
    _draw_turn(ax, last)
    ax.set_aspect("equal")
    ax.grid(visible=False)
    ax.set(xlabel=ALONG_E3, ylabel=ALONG_E2, xlim=(-0.35, 1.6))
    return figure


def _draw_turn(ax: Axes, last: Array) -> None:
    """The first director once more at the last vertex, thin, and the angle T from it to the last director."""
    before = _HALFWAY - _TURN / 2
    ax.plot(*np.array([last, last + _DIRECTOR * _unit(before)]).T, color=EXACT, linewidth=0.9)
    angles = np.linspace(before, before + _TURN, 30)
    arc = last + 0.42 * np.column_stack([np.cos(angles), np.sin(angles)])
    ax.plot(*arc.T, color=INK, linewidth=0.9)
    label(ax, last + 0.49 * _unit(_HALFWAY), "$T$", INK, ha="center")


def _unit(angle: float) -> Array:
    return np.array([np.cos(angle), np.sin(angle)])
