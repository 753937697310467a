"""A stage of the player as a film of Matplotlib, for a GIF."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec
from matplotlib.patches import PathPatch
from matplotlib.path import Path as Outline
from numpy.typing import NDArray

from cosserat.figures.drawing import WIDE, Frame
from cosserat.figures.stage import LOOKS, Line, Mark, Stage, at
from cosserat.figures.style import Picture, plain

Array = NDArray[np.float64]

_INCH = 100  # pixels of the drawing of a player in one inch of a film
_SIGNS = {"dot": "o", "ring": "o", "triangle": "^", "diamond": "D"}
_SHORTEST = 20  # from one frame to the next [ms]


def film(stage: Stage) -> FuncAnimation:
    """The film of a stage: its panels, and the value of the slider as title; its states follow at equal distances."""
    figure, shows = _figure(stage)
    interval = max(_SHORTEST, 10 * round(100 * stage.seconds / stage.states))
    heading = figure.suptitle("", fontsize=9)

    def draw(state: int) -> list[object]:
        for show in shows:
            show(state)
        heading.set_text(plain(f"{stage.title}\n{stage.spoken(state)}"))
        return []

    frames = stage.states - 1 if stage.loop else stage.states  # the last state of a cycle is its first
    return FuncAnimation(figure, draw, frames=frames, interval=interval, blit=False)  # type: ignore[arg-type]


def _figure(stage: Stage) -> tuple[Figure, list[Callable[[int], None]]]:
    """A figure with its axes, and the functions that show a state; it has the canvas that draws without a screen."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    frames = [Frame.of(panel) for panel in stage.panels]
    rows: list[list[Frame]] = []
    for frame in frames:
        if frame.panel.wide or not rows or len(rows[-1]) == 2 or rows[-1][0].panel.wide:
            rows.append([])
        rows[-1].append(frame)
    heights = [max(frame.height for frame in row) for row in rows]
    figure = Picture(figsize=(WIDE / _INCH, sum(heights) / _INCH + 0.9), layout="constrained")
    FigureCanvasAgg(figure)
    grid = GridSpec(len(rows), 2, figure, height_ratios=heights)
    shows: list[Callable[[int], None]] = []
    for number, row in enumerate(rows):
        for column, frame in enumerate(row):
            place = grid[number, :] if frame.panel.wide else grid[number, column]
            shows += _panel(figure.add_subplot(place), frame)
    handles = [_handle(part) for part in stage.labels]
    if handles:
        figure.legend(
            handles=handles, loc="outside lower center", ncols=min(4, len(handles)), fontsize=8
        )
    return figure, shows


def _panel(ax: Axes, frame: Frame) -> list[Callable[[int], None]]:
    panel = frame.panel
    ax.set(xlim=frame.xlim, ylim=frame.ylim, xlabel=panel.xlabel, ylabel=panel.ylabel)
    ax.set_title(plain(panel.title))
    if panel.true:
        ax.set_aspect(panel.tall)
        ax.grid(visible=False)
    shows = []
    for part in panel.parts:
        show = _mark(ax, part) if isinstance(part, Mark) else _line(ax, part)
        show(0)
        if part.moves:
            shows.append(show)
    return shows


def _colour(name: str) -> str:
    return LOOKS[name][0] if name else "none"


def _line(ax: Axes, part: Line) -> Callable[[int], None]:
    dash = tuple(float(word) / part.width for word in part.dash.split())
    patch = PathPatch(
        Outline([(0, 0)]),
        edgecolor=_colour(part.look),
        facecolor=_colour(part.fill),
        linewidth=part.width,
        linestyle=(0, dash) if dash else "-",
    )
    ax.add_patch(patch)

    def show(state: int) -> None:
        x, y = np.broadcast_arrays(at(part.x, state, 2), at(part.y, state, 2))
        patch.set_path(outline(x, y, part))

    return show


def outline(x: Array, y: Array, part: Line) -> Outline:
    """The path of a line, whose pen is lifted by a NaN."""
    known = np.isfinite(x) & np.isfinite(y)
    edges = np.flatnonzero(np.diff(np.r_[False, known, False].astype(int)))
    points: list[Array] = [np.empty((0, 2))]
    codes: list[int] = []
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        run = np.column_stack([x[begin:end], y[begin:end]])
        if part.base is not None:
            run = np.vstack([run, [run[-1, 0], part.base], [run[0, 0], part.base]])
        closed = part.closed or part.base is not None
        points += [run, run[:1]] if closed else [run]
        codes += [int(Outline.MOVETO), *[int(Outline.LINETO)] * (len(run) - 1)]
        codes += [int(Outline.CLOSEPOLY)] if closed else []
    return Outline(np.vstack(points), codes) if codes else Outline(np.full((1, 2), np.nan))


def _mark(ax: Axes, part: Mark) -> Callable[[int], None]:
    (drawn,) = ax.plot([], [], **_look(part), zorder=5, clip_on=False)

    def show(state: int) -> None:
        drawn.set_data([float(at(part.x, state, 1))], [float(at(part.y, state, 1))])

    return show


def _look(part: Mark) -> dict[str, Any]:
    colour = _colour(part.look)
    face = "none" if part.sign == "ring" else colour
    return {
        "marker": _SIGNS[part.sign],
        "color": colour,
        "markerfacecolor": face,
        "linestyle": "none",
        "markersize": 5,
    }


def _handle(part: Line | Mark) -> Artist:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    label = plain(part.label)
    if isinstance(part, Mark):
        return Line2D([], [], label=label, **_look(part))
    if part.fill:
        return Patch(facecolor=_colour(part.fill), edgecolor=_colour(part.look), label=label)
    return Line2D([], [], color=_colour(part.look), linestyle="--" if part.dash else "-", label=label)
