"""Pictures of natural modes and of critical loads: the body displaced along each mode."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures.rod import draw_loads, draw_outline
from cosserat.figures.style import ALONG_E2, ALONG_E3, BODY, COMPUTED, EXACT, canvas, plain, title_of
from cosserat.figures.supports import draw_supports
from cosserat.rods.problem import RodProblem

Array = NDArray[np.float64]
SHOWN = 6
"""Most modes in one picture."""
_AMPLITUDE = 0.12  # of the largest displacement of a drawn mode, as a fraction of the rod's length
_LARGEST_DIRECTOR = 0.5  # largest change of a drawn director, as a fraction of its length


def picture(data: xr.Dataset) -> Figure:
    """The picture of `cosserat plot` for natural modes: the lowest ones, both extremes of each, with frequencies."""
    problem = problem_of(data, RodProblem)
    figure, axes = panels(min(SHOWN, data.sizes["mode"]))
    for mode, ax in enumerate(axes):
        x, d = data.x.to_numpy(), data.d.to_numpy()
        u, delta = mode_shape(data, mode)
        size = amplitude(problem, u.real, delta.real, d)
        draw_outline(ax, x - size * u.real, d - size * delta.real, problem, **_ghost())
        draw_outline(
            ax, x + size * u.real, d + size * delta.real, problem, facecolor=BODY, edgecolor=COMPUTED
        )
        draw_supports(ax, problem, x, d)
        label(ax, spoken(data, mode))
    figure.suptitle(title_of(data), fontsize=9)
    return figure


def critical_picture(data: xr.Dataset) -> Figure:
    """The picture of `cosserat plot` for critical loads: the rod under its loads in each mode."""
    problem = problem_of(data, RodProblem)
    X, D = data.x_ref.to_numpy(), data.d_ref.to_numpy()
    shown = buckled(data)
    figure, axes = panels(len(shown))
    for ax, (x, d, u, delta, title) in zip(axes, shown, strict=True):
        size = amplitude(problem, u, delta, d)
        moved_x, moved_d = x + size * u, d + size * delta
        draw_outline(ax, X, D, problem, **_ghost())
        draw_outline(ax, moved_x, moved_d, problem, facecolor=BODY, edgecolor=COMPUTED)
        draw_supports(ax, problem, moved_x, D)
        for loaded in (problem, getattr(problem, "start_from", None)):
            if loaded is not None:
                draw_loads(ax, loaded, moved_x, moved_d)
        label(ax, title)
    figure.suptitle(title_of(data), fontsize=9)
    return figure


def buckled(data: xr.Dataset) -> list[tuple[Array, Array, Array, Array, str]]:
    """Of the first critical loads, the true one before the linear ones: x, d, the mode's u, delta, and words."""
    X, D = data.x_ref.to_numpy(), data.d_ref.to_numpy()
    shown: list[tuple[Array, Array, Array, Array, str]] = []
    for k in range(data.sizes.get("special", 0)):
        load, kind = float(data.special_load_factor[k]), str(data.special.to_numpy()[k])
        x, d, u, delta = (data[f"special_{name}"].to_numpy()[k] for name in ("x", "d", "u", "delta"))
        words = f"true criterion: {load:.6g} × the loads, {plain(kind.partition(',')[0])}"
        shown.append((x, d, u, delta, words))
    for mode in range(data.sizes.get("mode", 0)):
        u, delta = (data[name].to_numpy()[mode] for name in ("linear_u", "linear_delta"))
        load = float(data.linear_load_factor[mode])
        shown.append((X, D, u, delta, f"linear criterion: {load:.6g} × the loads"))
    nothing = (X, D, np.zeros_like(X), np.zeros_like(D), "no critical load was found")
    return shown[:SHOWN] or [nothing]


def mode_shape(data: xr.Dataset, mode: int) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Displacements of positions and directors of a mode, (N, 2) each, complex."""
    found = []
    for name in ("mode_u", "mode_delta"):
        part = data[name].to_numpy()[mode].astype(complex)
        if f"{name}_imaginary" in data:
            part += 1j * data[f"{name}_imaginary"].to_numpy()[mode]
        found.append(part)
    return found[0], found[1]


def spoken(data: xr.Dataset, mode: int) -> str:
    """The number of a mode, its frequency and, if it grows or fades, its rate."""
    hertz, growth = float(data.natural_frequency[mode]), float(data.growth_rate[mode])
    rate = f", {'grows' if growth > 0 else 'fades'} by {abs(growth):.4g} 1/s" if growth else ""
    return f"mode {mode + 1}: {hertz:.5g} Hz{rate}"


def amplitude(problem: RodProblem, u: Array, delta: Array, d: Array) -> float:
    """Size of a drawn mode: the largest displacement is a share of the rod's length, and no section turns over."""
    moved = float(np.linalg.norm(u, axis=1).max())
    turned = float((np.linalg.norm(delta, axis=1) / np.linalg.norm(d, axis=1)).max())
    sizes = [_AMPLITUDE * problem.rod.length / moved] if moved > 0 else []
    sizes += [_LARGEST_DIRECTOR / turned] if turned > 0 else []
    return min(sizes, default=0.0)


def panels(count: int) -> tuple[Figure, list[Axes]]:
    """As many axes as modes, two in a row."""
    rows = math.ceil(count / 2)
    figure, axes = canvas(7.2, 0.5 + 1.9 * rows, rows, min(count, 2))
    for ax in axes[count:]:
        ax.remove()
    return figure, axes[:count]


def label(ax: Axes, title: str) -> None:
    """Equal axes with units."""
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel=ALONG_E3, ylabel=ALONG_E2, title=title)


def _ghost() -> dict[str, str]:
    return {"facecolor": "none", "edgecolor": EXACT, "linestyle": ":"}
