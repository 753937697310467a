"""From beams to directed rods: what acts on a slice, and the twelve deformations of a section."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.figures.deformations import DEFORMATIONS, Deformation, draw_body, on_paper
from cosserat.figures.style import BODY, COMPUTED, INK, PAPER, VARIANT, canvas

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_HALF = (0.5, 0.35)  # half height and half width of a drawn section
_LENGTH = 3.0  # of a drawn body
_COLUMNS = 2
_SPACING = (5.0, 3.7)  # from one drawn body to the next
_AMOUNTS = {  # of the drawn strains
    "axial stretch": 0.4,
    "lateral stretch": 0.4,
    "transverse shear": 0.3,
    "shear of the section": 0.4,
    "bending": 0.36,
    "twist": 0.5,
    "taper": 0.36,
    "growing shear of the section": 0.36,
}
WIDTH = 5.0  # of a picture [in]


def fig_directors(data: Data) -> Figure:
    """A bar at rest with its reference directors, and the same bar bent, twisted and thinned with its directors."""
    del data
    figure, (ax,) = canvas(WIDTH, 4.3)
    xi = np.linspace(0, 8, 49)
    straight = np.broadcast_to(np.eye(3), (xi.size, 3, 3))
    deformed = _bent_twisted_and_thin(xi)
    for r, d, height, lowest, letters, at, title in (
        (xi[:, None] * np.eye(3)[2], straight, 2.9, 1.9, "DE", (16,), "at rest: reference directors"),
        (*deformed, -0.9, -2.7, "dd", (7, 28, 42), "under load: directors, which follow the material"),
    ):
        middle = np.array([4.0, height])
        draw_body(ax, r, d, _SECTION, (middle[0], middle[1]))
        offset = middle - on_paper(r.mean(axis=0))
        ax.plot(*(on_paper(r) + offset).T, color=INK, linewidth=1.0, linestyle="--")
        for k in at:
            foot = on_paper(r[k]) + offset
            for number, long in ((1, 1.4), (2, 1.9), (3, 1.0)):
                along = on_paper(long * d[k, number - 1])
                _arrow(ax, (foot[0], foot[1]), (along[0], along[1]), VARIANT)
                letter = letters[1 if number == 3 and letters == "DE" else 0]
                beyond = foot + along * (1 + 0.24 / np.hypot(*along))
                box = {"facecolor": PAPER, "edgecolor": "none", "alpha": 0.8, "pad": 0.6}
                text = rf"$\mathbf{{{letter}}}_{number}$"
                ax.annotate(text, tuple(beyond), ha="center", va="center", color=VARIANT, bbox=box)
        ax.annotate(title, (4.0, lowest), ha="center", va="top", color=INK)
    ax.set(xlim=(-0.8, 9.2), ylim=(-3.3, 4.7), xticks=[], yticks=[])
    ax.set(xlabel=r"along $\mathbf{E}_3$ [heights of the section]")
    ax.set_aspect("equal")
    ax.spines[["left", "bottom"]].set_visible(False)
    return figure


_SECTION = (0.5, 0.4)  # half height and half width of the bar with directors


def _bent_twisted_and_thin(xi: Array) -> tuple[Array, Array]:
    """r, shape (n, 3), and d_i, shape (n, 3, 3): a bar that curves up, twists, and has a neck."""
    slope, twist = 0.5 * np.sin(np.pi * (xi / 8 - 0.5)), -0.09 * (xi - 3)
    neck = np.exp(-(((xi - 4.7) / 0.9) ** 2))
    e_3 = np.stack([np.sin(slope), 0 * xi, np.cos(slope)], axis=1)
    up = np.stack([np.cos(slope), 0 * xi, -np.sin(slope)], axis=1)
    beside = np.broadcast_to(np.eye(3)[1], up.shape)
    cos, sin = np.cos(twist)[:, None], np.sin(twist)[:, None]
    thin = (1 - 0.45 * neck)[:, None]
    d = np.stack([thin * (cos * up + sin * beside), thin * (cos * beside - sin * up), e_3], axis=1)
    d[:, 2] *= (1 + 0.4 * neck)[:, None]
    steps = np.diff(xi)[:, None] * (d[1:, 2] + d[:-1, 2]) / 2
    return np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)]), d


def fig_strains(data: Data) -> Figure:
    """Six bodies, each with one gamma_ij, over the body at rest, with the stiffness that pays."""
    del data
    return _gallery([found for found in DEFORMATIONS.values() if found.gamma])


def fig_gradients(data: Data) -> Figure:
    """Six bodies, each with one kappa_alpha i or two equal ones, over the body at rest, with what pays."""
    del data
    return _gallery([found for found in DEFORMATIONS.values() if found.kappa])


def _gallery(shown: list[Deformation]) -> Figure:
    rows = -(-len(shown) // _COLUMNS)
    figure, (ax,) = canvas(WIDTH, 1.86 * rows + 0.2)
    xi = np.linspace(-_LENGTH / 2, _LENGTH / 2, 19)
    for number, found in enumerate(shown):
        row, column = divmod(number, _COLUMNS)
        place = (_SPACING[0] * column, -_SPACING[1] * row)
        r, d, _ = found.directors(0.0, xi)
        bent, turned, _ = found.directors(_AMOUNTS[found.title], xi)
        draw_body(ax, bent, turned, _HALF, place)
        draw_body(ax, r, d, _HALF, place, look="none")
        above = (place[0], place[1] + 1.5)
        ax.annotate(found.title, above, ha="center", va="bottom", color=INK)
        text = f"${found.measure}$,  ${found.pays}$"
        ax.annotate(text, (above[0], above[1] - 0.06), ha="center", va="top", color=VARIANT)
        below = (place[0], place[1] - 1.25)
        ax.annotate(found.beam or "not in a beam", below, ha="center", va="top")
    ax.set(
        xlim=(-0.5 * _SPACING[0], (_COLUMNS - 0.5) * _SPACING[0]),
        ylim=(-_SPACING[1] * (rows - 1) - 1.8, 2.0),
        xticks=[],
        yticks=[],
        xlabel=r"along $\mathbf{E}_3$ [heights of the section]",
    )
    ax.set_aspect("equal")
    ax.spines[["left", "bottom"]].set_visible(False)
    return figure


_WIDE, _TALL = 0.8, 1.0  # half length and half height of the drawn slice
_GAP = 0.12  # from a face of the slice to the arrows that act on it


def fig_slice(data: Data) -> Figure:
    """A slice of a rod between two sections: its forces, and both kinds of director forces on it."""
    del data
    figure, (forces, legend, across, along) = canvas(WIDTH, 5.0, 2, 2)
    for ax, title in (
        (forces, "(a) forces"),
        (across, "(b) director forces along\n$\\mathbf{d}_1$ change its height"),
        (along, "(c) director forces along\n$\\mathbf{d}_3$ turn it"),
    ):
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * [_WIDE, _TALL]
        ax.fill(*corners.T, facecolor=BODY, edgecolor=COMPUTED, linewidth=0.9)
        ax.plot([-_WIDE, _WIDE], [0, 0], color=INK, linestyle="--", linewidth=0.8)
        ax.set(title=title, xlim=(-2.1, 2.1), ylim=(-1.75, 1.75), xticks=[], yticks=[])
        ax.set(xlabel=r"along $\mathbf{E}_3$ [d$\xi$]")
        ax.set_aspect("equal")
        ax.grid(visible=False)
        ax.spines[["left", "bottom"]].set_visible(False)
    _draw_forces(forces)
    _draw_across(across)
    _draw_along(along)
    _explain(legend)
    return figure


def _draw_forces(ax: Axes) -> None:
    """n on both faces, and the assigned force."""
    _arrow(ax, (_WIDE, 0), (0.8, 0.5), VARIANT)
    _arrow(ax, (-_WIDE, 0), (-0.8, -0.3), VARIANT)
    _arrow(ax, (0, 0), (0.1, -1.4), INK)
    _text(ax, (_WIDE + 0.72, 0.95), r"$\mathbf{n}(\xi + \mathrm{d}\xi)$", VARIANT)
    _text(ax, (-_WIDE - 0.55, 0.3), r"$-\mathbf{n}(\xi)$", VARIANT)
    _text(ax, (0.62, -1.3), r"$\rho_0 \mathbf{f}\, \mathrm{d}\xi$", INK)


def _draw_across(ax: Axes) -> None:
    """Tractions with a first moment along d_1: outward on one face, inward on the other, and inside."""
    for sign in (1.0, -1.0):
        _arrow(ax, (_WIDE + _GAP, 0.1 * sign), (0, 0.85 * sign), VARIANT)
        _arrow(ax, (-_WIDE - _GAP, 0.95 * sign), (0, -0.85 * sign), VARIANT)
        _arrow(ax, (0, _TALL * sign), (0, 0.6 * sign), INK)
        _arrow(ax, (-0.3, 0.9 * sign), (0, -0.75 * sign), COMPUTED)
    _text(ax, (1.62, 0.5), "$\\mathbf{m}^1$\n$(\\xi + \\mathrm{d}\\xi)$", VARIANT)
    _text(ax, (-1.5, 0.5), "$-\\mathbf{m}^1$\n$(\\xi)$", VARIANT)
    _text(ax, (0.62, 1.3), r"$\rho_0 \mathbf{l}^1 \mathrm{d}\xi$", INK)
    _text(ax, (0.28, 0.5), r"$-\mathbf{k}^1 \mathrm{d}\xi$", COMPUTED)


def _draw_along(ax: Axes) -> None:
    """Tractions with a first moment along d_3: a couple on each face, as in a beam."""
    for height in (0.3, 0.6, 0.9):
        for face, length in ((_WIDE, 0.85), (-_WIDE, 0.65)):
            pull = length * height * np.sign(face)
            _arrow(ax, (face, height), (pull, 0), VARIANT)  # tension above
            _arrow(ax, (face + pull, -height), (-pull, 0), VARIANT)  # compression below
    _text(ax, (1.3, 1.3), r"$\mathbf{m}^1(\xi + \mathrm{d}\xi)$", VARIANT)
    _text(ax, (-1.3, 1.3), r"$-\mathbf{m}^1(\xi)$", VARIANT)
    _text(ax, (0, -1.3), r"couple $\mathbf{m} = \mathbf{d}_\beta \times \mathbf{m}^\beta$", INK)


def _explain(ax: Axes) -> None:
    """What the colours of the arrows mean."""
    ax.spines[["left", "bottom"]].set_visible(False)
    ax.set(xlim=(0, 1), ylim=(0, 1), xticks=[], yticks=[], xlabel="forces [N], director forces [N m]")
    for height, colour, text in (
        (0.85, VARIANT, "contact loads: what the\nneighbours do to the faces"),
        (0.5, INK, "assigned loads: what acts\nfrom outside"),
        (0.15, COMPUTED, "intrinsic director force:\nwhat holds the slice together"),
    ):
        _arrow(ax, (0.0, height), (0.14, 0.0), colour)
        ax.annotate(text, (0.18, height), ha="left", va="center", color=colour)


def _arrow(ax: Axes, foot: tuple[float, float], along: tuple[float, float], colour: str) -> None:
    shape = {"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 9}
    ax.annotate("", (foot[0] + along[0], foot[1] + along[1]), foot, arrowprops=shape, zorder=5)


def _text(ax: Axes, middle: tuple[float, float], text: str, colour: str) -> None:
    ax.annotate(text, middle, ha="center", va="center", color=colour)
