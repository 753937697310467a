"""The frames and the signs of a rod and of its internal forces, drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.figures.style import (
    ALONG_E2,
    ALONG_E3,
    BODY,
    COMPUTED,
    EXACT,
    INK,
    VARIANT,
    WIDTH,
    Picture,
)

Array = NDArray[np.float64]
_LEAN = 0.3  # of the section that is drawn, from E2 backwards [rad]
NORMAL = np.array([np.cos(_LEAN), np.sin(_LEAN)])
"""The normal of the section of the cut, as drawn."""
SECTION = np.array([-np.sin(_LEAN), np.cos(_LEAN)])
"""The direction of its director, as drawn."""


def picture() -> Figure:
    """Axes and surfaces of a rod, positive forces at a cut, and the stresses that beams make of them."""
    figure = Picture(figsize=(WIDTH, 7.8), layout="constrained")
    frame, cut, stress = figure.subplots(3, 1, height_ratios=[1.15, 1.0, 0.9])
    _draw_frame(frame)
    _draw_cut(cut)
    _draw_stress(stress)
    for ax in (frame, cut):
        ax.set_aspect("equal")
        ax.grid(visible=False)
        ax.set(xticks=[], yticks=[])
        ax.set(xlabel=ALONG_E3, ylabel=ALONG_E2)
    return figure


def _draw_frame(ax: Axes) -> None:
    """A rod bent from E3 towards E2, with its directors, its surfaces and its axes."""
    angles = np.linspace(0.0, 0.76, 40)
    x = 2.4 * np.column_stack([np.sin(angles), 1 - np.cos(angles)])
    d = 0.28 * np.column_stack([-np.sin(angles), np.cos(angles)])
    body = np.concatenate([x + d, (x - d)[::-1]])
    ax.fill(*body.T, facecolor=BODY, edgecolor=COMPUTED, linewidth=0.9)
    ax.plot(*x.T, color=INK, linestyle="--", linewidth=0.9)
    for k in (0, 20, 39):
        arrow(ax, x[k], d[k], COMPUTED)
    label(ax, x[0] + [-0.06, 0.14], r"$\mathbf{d}$", COMPUTED, ha="right")
    label(ax, (0.5, 0.36), "upper surface", INK, ha="right", va="bottom")
    label(ax, (0.9, -0.2), "lower surface", INK, va="top")
    label(ax, x[29] + [0.02, -0.03], r"$\xi$", INK, va="top")
    corner = np.array([-0.1, 1.0])
    arrow(ax, corner, np.array([0.55, 0.0]), INK)
    arrow(ax, corner, np.array([0.0, 0.55]), INK)
    label(ax, np.add(corner, (0.57, 0.0)), r"$\mathbf{E}_3$", INK, va="center")
    label(ax, np.add(corner, (0.0, 0.57)), r"$\mathbf{E}_2$", INK, ha="center", va="bottom")
    label(ax, np.add(corner, (-0.1, -0.02)), r"$\mathbf{E}_1 \otimes$", INK, ha="right", va="top")
    turn(ax, corner, 0.34, 0.1, 1.45)
    label(ax, np.add(corner, (0.33, 0.28)), r"$\varphi, \kappa > 0$", VARIANT)
    ax.set(title="(a) axes, rotations, surfaces", xlim=(-0.86, 2.0), ylim=(-0.76, 1.9))


def _draw_cut(ax: Axes) -> None:
    """What acts on either side of a cut where N, Q and M are positive."""
    half, gap = 0.42, 0.62
    for side in (1.0, -1.0):  # before the cut, then beyond it
        face = -side * gap * NORMAL
        far = face - side * 0.76 * NORMAL
        corners = [
            face + half * SECTION,
            face - half * SECTION,
            far - half * SECTION,
            far + half * SECTION,
        ]
        ax.fill(*np.array(corners).T, facecolor=BODY, edgecolor="none")
        ax.plot(
            *np.array([face + half * SECTION, face - half * SECTION]).T, color=COMPUTED, linewidth=1.4
        )
        ax.plot(*np.array([face, far]).T, color=INK, linestyle="--", linewidth=0.9)
        arrow(ax, face, side * 0.5 * NORMAL, VARIANT)
        arrow(ax, face + side * 0.05 * NORMAL, side * 0.62 * SECTION, VARIANT)
        middle = float(np.arctan2(*(side * NORMAL)[::-1]))
        turn(ax, face, 0.27, *((middle - 1.2, middle + 1.2)[:: int(side)]))
    label(ax, (0.44 - gap) * NORMAL + [0.0, -0.07], "$N$", VARIANT, va="top")
    label(ax, -gap * NORMAL + 0.66 * SECTION, "$Q$", VARIANT, ha="right", va="bottom")
    label(ax, (0.16 - gap) * NORMAL + 0.22 * SECTION, "$M$", VARIANT, va="bottom")
    label(ax, -1.0 * NORMAL - 0.5 * SECTION, "before", INK, ha="center", va="top")
    label(ax, 1.0 * NORMAL - 0.5 * SECTION, "beyond", INK, ha="center", va="top")
    ax.set(title="(b) positive $N, Q, M$ at a cut", xlim=(-1.5, 1.5), ylim=(-1.2, 1.2))


def _draw_stress(ax: Axes) -> None:
    """The axial stress over the height for a positive N and a positive M."""
    y, mean, bending = np.array([-0.5, 0.5]), 0.6, 1.0
    ax.fill_betweenx(y, 0.0, mean - 2 * bending * y, facecolor=BODY)
    ax.plot(mean - 2 * bending * y, y, color=COMPUTED)
    ax.axvline(0.0, color=INK, linewidth=0.9)
    ax.plot([mean, mean], y, color=EXACT, linestyle="--", linewidth=0.9)
    label(ax, (mean + 0.06, 0.33), "$N/A$", EXACT)
    label(ax, (mean + bending, -0.52), r"$N/A + M h / 2 I$", COMPUTED, ha="right", va="top")
    label(ax, (-0.06, 0.53), r"$N/A - M h / 2 I$", COMPUTED, ha="right", va="bottom")
    ax.set(title="(c) stress as beams have it", xlim=(-0.8, 1.8), ylim=(-0.86, 0.86))
    ax.set(xlabel=r"axial stress [$M h / 2 I$]", ylabel="height above centre [$h$]")


def arrow(ax: Axes, foot: Array, along: Array, colour: str, style: str = "-|>") -> None:
    """An arrow from a foot."""
    shape = {"arrowstyle": style, "color": colour, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 10}
    ax.annotate("", tuple(foot + along), tuple(foot), arrowprops=shape, zorder=5)


def turn(ax: Axes, centre: Array, radius: float, start: float, stop: float) -> None:
    """An arc with an arrowhead at its end: positive from E3 towards E2."""
    angles = np.linspace(start, stop, 30)
    arc = centre + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    ax.plot(*arc[:-1].T, color=VARIANT, linewidth=1.2)
    arrow(ax, arc[-3], arc[-1] - arc[-3], VARIANT)


def label(ax: Axes, place: Any, text: str, colour: str, **how: Any) -> None:
    """A text at a place."""
    ax.annotate(text, tuple(np.asarray(place, dtype=float)), color=colour, **how)
