"""Animations of results, as Matplotlib's: natural modes, critical loads, motions and paths.

Each takes a Dataset and the number of frames.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures.animated import FRAMES
from cosserat.figures.modes import SHOWN, amplitude, buckled, label, mode_shape, panels, spoken
from cosserat.figures.rod import draw_outline, magnification, outline
from cosserat.figures.style import BODY, COMPUTED, EXACT, canvas, title_of
from cosserat.figures.supports import draw_supports
from cosserat.rods.problem import RodProblem

Array = NDArray[np.float64]
_INTERVAL = 50  # from one frame to the next [ms]


def modes(data: xr.Dataset, frames: int = FRAMES) -> FuncAnimation:
    """The lowest modes side by side, each through one cycle of its own; none grows or fades while it is shown."""
    problem, x, d = problem_of(data, RodProblem), data.x.to_numpy(), data.d.to_numpy()
    figure, axes = panels(min(SHOWN, data.sizes["mode"]))
    bodies = []
    for mode, ax in enumerate(axes):
        u, delta = mode_shape(data, mode)
        size = amplitude(problem, np.abs(u), np.abs(delta), d)
        cycle = np.exp(2j * np.pi * np.arange(frames) / frames)[:, None, None]
        draw_outline(ax, x, d, problem, facecolor="none", edgecolor=EXACT, linestyle=":")
        draw_supports(ax, problem, x, d)
        moved = x + size * (cycle * u).real, d + size * (cycle * delta).real
        bodies.append(_body(ax, outline(*moved, problem)))
        label(ax, spoken(data, mode))
    return _animation(figure, lambda frame: [show(frame) for show in bodies], frames)


def critical(data: xr.Dataset, frames: int = FRAMES) -> FuncAnimation:
    """The rod moves to and fro along each mode of its critical loads."""
    problem, shown = problem_of(data, RodProblem), buckled(data)
    figure, axes = panels(len(shown))
    bodies = []
    swing = np.sin(2 * np.pi * (np.arange(frames) + 0.5) / frames)[:, None, None]
    for ax, (x, d, u, delta, title) in zip(axes, shown, strict=True):
        size = amplitude(problem, u, delta, d) * swing
        draw_outline(ax, x, d, problem, facecolor="none", edgecolor=EXACT, linestyle=":")
        draw_supports(ax, problem, x, data.d_ref.to_numpy())
        bodies.append(_body(ax, outline(x + size * u, d + size * delta, problem)))
        label(ax, title)
    return _animation(figure, lambda frame: [show(frame) for show in bodies], frames)


def motion(data: xr.Dataset, frames: int = FRAMES) -> FuncAnimation:
    """The body through the frames of its motion, in equal times."""
    shown = _chosen(data.sizes["time"], frames)
    times = data.time.to_numpy()[shown]
    return _states(data, shown, [f"t = {time:.4g} s" for time in times])


def path(data: xr.Dataset, frames: int = FRAMES) -> FuncAnimation:
    """The body along its path of equilibria, with the load at each."""
    shown = _chosen(data.sizes["point"], frames)
    loads, stable = data.load_factor.to_numpy()[shown], data.stable.to_numpy()[shown] > 0.5
    said = [
        f"{load:.4g} of the load, {'stable' if rests else 'unstable'}"
        for load, rests in zip(loads, stable, strict=True)
    ]
    return _states(data, shown, said)


def _states(data: xr.Dataset, shown: NDArray[np.int64], said: list[str]) -> FuncAnimation:
    """The body in chosen states, displacements magnified as in the picture."""
    problem = problem_of(data, RodProblem)
    X, D = data.x_ref.to_numpy(), data.d_ref.to_numpy()
    x, d = data.x.to_numpy()[shown], data.d.to_numpy()[shown]
    magnified = magnification(x - X, problem.rod.length)
    figure, (ax,) = canvas(5.0, 4.0)
    draw_outline(ax, X, D, problem, facecolor="none", edgecolor=EXACT, linestyle=":")
    body = _body(ax, outline(X + magnified * (x - X), D + magnified * (d - D), problem))
    label(ax, "")

    def show(frame: int) -> None:
        body(frame)
        ax.set_title(f"{title_of(data)}, displacements × {magnified:g}\n{said[frame]}")

    return _animation(figure, show, shown.size)


def _body(ax: Axes, outlines: Array) -> Callable[[int], None]:
    """A closed curve that takes each of its outlines, (frames, k, 2); the axes hold all of them."""
    patch = Polygon(outlines[0], closed=True, facecolor=BODY, edgecolor=COMPUTED, linewidth=0.9)
    ax.add_patch(patch)
    ax.update_datalim(outlines.reshape(-1, 2))
    ax.autoscale_view()
    return lambda frame: patch.set_xy(outlines[frame])


def _chosen(count: int, frames: int) -> NDArray[np.int64]:
    """Indices of at most so many states, the first and the last among them."""
    chosen: NDArray[np.int64] = np.unique(np.linspace(0, count - 1, frames).round().astype(np.int64))
    return chosen


def _animation(figure: Figure, show: Callable[[int], object], frames: int) -> FuncAnimation:
    """An animation; its figure gets the canvas that draws it without a screen."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(figure)

    def draw(frame: int) -> list[object]:
        show(frame)
        return []

    return FuncAnimation(figure, draw, frames=frames, interval=_INTERVAL, blit=False)  # type: ignore[arg-type]
