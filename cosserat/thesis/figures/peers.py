"""The comparison with other packages as a picture: error against time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from cosserat.figures.style import COMPUTED, INK, PAPER, VARIANT, canvas

Row = Mapping[str, str]

_LOOKS = {"cosserat": (COMPUTED, "o"), "Exudyn": (VARIANT, "s"), "PyElastica": (INK, "^")}
_TITLES = {
    "(a)": "(a) clamped-free beam at rest",
    "(b)": "(b) large deflection at rest",
    "(c)": "(c) a fifth of a second of vibration",
}
_BESIDE = {"cosserat": (-6, 0, "right"), "Exudyn": (6, 0, "left"), "PyElastica": (6, 0, "left")}
"""Where the number of elements stands beside a point, in points, and its side there."""
_CROWDED = {"cosserat": (-4, -8, "right"), "Exudyn": (0, 9, "center"), "PyElastica": (6, 0, "left")}
"""The same in the last panel, whose points lie near each other."""


def fig_peers(_: Mapping[str, xr.Dataset], rows: Sequence[Row]) -> Figure:
    """Relative error over the time of the solver, one panel a problem; every point has its number of elements."""
    figure, axes = canvas(5.0, 7.2, 3, 1)
    for ax, (letter, title) in zip(axes, _TITLES.items(), strict=True):
        _panel(ax, [row for row in rows if row["problem"].startswith(letter)], crowded=letter == "(c)")
        ax.set(xlabel="time of the solver [s]", ylabel="relative error [1]", title=title)
    times = [float(row[key]) for row in rows for key in ("least", "most")]
    errors = [float(row["error"]) for row in rows]
    for ax in axes:
        ax.set(xlim=(min(times) / 3, max(times) * 3), ylim=(min(errors) / 2, max(errors) * 2))
    looks = [
        Line2D([], [], color=colour, marker=marker, label=name)
        for name, (colour, marker) in _LOOKS.items()
    ]
    figure.legend(handles=looks, loc="outside lower center", ncols=3)
    return figure


def _panel(ax: Axes, rows: Sequence[Row], *, crowded: bool) -> None:
    """One problem: a line a package through its meshes, with the least and the most time of the runs."""
    for package, (colour, marker) in _LOOKS.items():
        own = [row for row in rows if row["package"] == package]
        time, least, most, error = (
            [float(row[key]) for row in own] for key in ("seconds", "least", "most", "error")
        )
        ax.loglog(time, error, color=colour, marker=marker)
        ax.hlines(error, least, most, color=colour, linewidth=3, alpha=0.35)
        across, up, side = (_CROWDED if crowded else _BESIDE)[package]
        for row, at, height in zip(own, time, error, strict=True):
            ax.annotate(
                row["problem"].split(", ")[1].split()[0],
                (at, height),
                xytext=(across, up),
                textcoords="offset points",
                ha=side,
                va="center",
                bbox={"facecolor": PAPER, "edgecolor": "none", "pad": 0.5},
                color=colour,
            )
