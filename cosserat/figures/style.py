"""Style and files of all figures: the same bytes for the same data."""

from __future__ import annotations

import contextlib
import io
import textwrap
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.data.files import whole_or_absent
from cosserat.text import printable
from cosserat.threads import DRAWING

Array = NDArray[np.float64]

INK, PAPER, BODY = "#222222", "#ffffff", "#c9dced"
EXACT, COMPUTED, VARIANT, FOURTH = "#6b6b6b", "#0b5fa5", "#c4501b", "#a0479b"
CONSISTENT, EARLIER = INK, "#5f93c4"
CURVES = (INK, EXACT, COMPUTED, VARIANT, FOURTH)
"""Black, grey, blue, vermilion and purple: told apart also by a deuteranope, and dark enough for text."""

ALONG_E3, ALONG_E2 = r"along $\mathbf{E}_3$ [m]", r"along $\mathbf{E}_2$ [m]"
"""Labels of the axes of a plane in which a rod lies."""
WIDTH = 5.0
"""Width of a picture of the book [in]: its texts are read on a phone, whose column is two thirds of it."""

PICTURES = {".svg": "Date", ".pdf": "CreationDate", ".png": ""}
"""Endings of pictures, and the name of the date that each format would carry."""

_DPI = 150  # of a PNG
_MARGIN = 0.04  # round a picture [in]
_SETTINGS: Any = {
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "lines.markersize": 4.5,
    "svg.hashsalt": "cosserat",
    "savefig.facecolor": PAPER,
}


@contextlib.contextmanager
def settings() -> Iterator[None]:
    """The settings of matplotlib for a figure; of letters that its font lacks it does not warn."""
    with DRAWING, mpl.rc_context(_SETTINGS), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph|Matplotlib currently does not support", UserWarning)
        yield


def title_of(data: xr.Dataset) -> str:
    """The title of a result, for a picture."""
    return plain(data.attrs.get("title", ""))


def plain(text: object) -> str:
    """A text of the user or of a file for a picture: a dollar is no sign of mathematics, and nothing is steered."""
    return "\n".join(map(printable, str(text).split("\n"))).replace("$", r"\$")


class Picture(Figure):
    """A figure that a notebook shows by itself, also where pyplot is not used."""

    def _repr_png_(self) -> bytes:
        drawn = io.BytesIO()
        with settings():
            self.savefig(drawn, format="png", dpi=_DPI)
        return drawn.getvalue()


def canvas(width: float, height: float, rows: int = 1, columns: int = 1) -> tuple[Figure, list[Axes]]:
    """A figure of that size in inches with its axes in reading order."""
    figure = Picture(figsize=(width, height), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    return figure, [ax for line in axes for ax in line]


def note(figure: Figure, said: list[str]) -> None:
    """Put warnings below a picture."""
    if said:
        width = int(20 * figure.get_size_inches()[0])
        lines = [textwrap.fill(f"Warning: {warning}", width) for warning in said]
        figure.supxlabel(plain("\n".join(lines)), x=0.01, ha="left", fontsize=7, color=VARIANT)


def write(figure: Figure, path: Path) -> None:
    """Write a picture without a date, whole or not at all, as the name ends."""
    with settings(), whole_or_absent(path) as temporary:
        date = PICTURES[path.suffix]
        figure.savefig(
            temporary,
            format=path.suffix[1:],
            dpi=_DPI,
            metadata={date: None} if date else {},
            bbox_inches="tight",
            pad_inches=_MARGIN,
        )


def beside(
    ax: Axes, place: tuple[float, float], text: str, aside: tuple[float, float], **look: Any
) -> None:
    """A text offset by `aside`, in points, from a place of the data: the name of a curve at the curve."""
    ax.annotate(text, place, aside, textcoords="offset points", **{"va": "center", **look})


def exact_curve(ax: Axes, xi: Array, values: Array, label: str, *, dashed: bool = False) -> None:
    """A closed form, as a line."""
    ax.plot(xi, values, color=EXACT, linestyle="--" if dashed else "-", label=label, zorder=2)


def computed_points(ax: Axes, xi: Array, values: Array, label: str, *, variant: bool = False) -> None:
    """Computed values, one marker per vertex; a variant is drawn hollow."""
    colour = VARIANT if variant else COMPUTED
    ax.plot(
        xi,
        values,
        linestyle="none",
        color=colour,
        marker="s" if variant else "o",
        markerfacecolor="none" if variant else colour,
        markeredgecolor=colour,
        label=label,
        zorder=3,
    )


def plain_points(ax: Axes, xi: Array, values: Array) -> None:
    """Values of the consistent rod, one hollow diamond per vertex, in which a point of another rod is seen."""
    ax.plot(
        xi,
        values,
        linestyle="none",
        color=CONSISTENT,
        marker="D",
        markersize=6,
        markerfacecolor="none",
        markeredgecolor=CONSISTENT,
        markeredgewidth=0.9,
        label="consistent rod",
        zorder=4,
    )
