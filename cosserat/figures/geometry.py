"""Figures 3.1 to 3.7: the geometry of the discrete rod, drawn from configurations of the library, and its energies."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc
from numpy.typing import NDArray

from cosserat.figures.style import BODY, COMPUTED, EXACT, INK, VARIANT, canvas
from cosserat.models.planar_rod import Geometry, strains, vertex_tangents
from cosserat.models.published import squared_tangent, stretching
from cosserat.table.readouts import problem_of

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_ALONG, _UP = r"along $\mathbf{E}_3$ [m]", r"along $\mathbf{E}_2$ [m]"


def _plane(ax: Axes, title: str) -> None:
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel=_ALONG, ylabel=_UP, title=title)


def _arrow(ax: Axes, foot: Array, vector: Array, colour: str, label: str = "") -> None:
    ax.quiver(
        *foot, *vector, angles="xy", scale_units="xy", scale=1, color=colour, width=0.006, zorder=4
    )
    if label:
        tip = foot + vector
        ax.annotate(label, tuple(tip), xytext=(4, 4), textcoords="offset points", color=colour)


def _discrete(ax: Axes, x: Array, d: Array) -> None:
    """Centreline and directorline solid, directors, and the lower boundary as their reflection, dashed."""
    ax.plot(*x.T, color=INK, marker="o", markersize=4, label="centreline")
    ax.plot(*(x + d).T, color=COMPUTED, marker="s", markersize=3, label="directorline")
    ax.plot(*(x - d).T, color=EXACT, linestyle="--", label="reflected")
    for foot, director in zip(x, d, strict=True):
        _arrow(ax, foot, director, COMPUTED)


def fig_3_1(data: Data) -> Figure:
    """A reference configuration and a current one."""
    figure, (left, right) = canvas(7.2, 3.0, 1, 2)
    rod = data["bent_rod"]
    _discrete(left, rod.x_ref.to_numpy(), rod.d_ref.to_numpy())
    _discrete(right, rod.x.to_numpy(), rod.d.to_numpy())
    _plane(left, r"(a) reference: ${}_K\mathbf{X}$, ${}_K\mathbf{D}$")
    _plane(right, r"(b) current: ${}_K\mathbf{x}$, ${}_K\mathbf{d}$")
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def fig_3_2(data: Data) -> Figure:
    """A rod-like body: long against its section, with a close centreline and one section."""
    figure, (ax,) = canvas(7.2, 2.2)
    rod = problem_of(data["clamped_free"]).rod
    geometry = Geometry.arc(41, rod.length, np.full(41, rod.height / 2), 0.12)
    outline = np.vstack([geometry.X + geometry.D, (geometry.X - geometry.D)[::-1]])
    ax.fill(*outline.T, facecolor=BODY, edgecolor=COMPUTED)
    ax.plot(*geometry.X.T, color=INK, linestyle="--", label="centreline")
    foot, director = geometry.X[24], geometry.D[24]
    section = np.column_stack([foot - director, foot + director])
    ax.plot(*section, color=VARIANT, linewidth=4, label="cross-section")
    ax.annotate(f"$D$ = {rod.height:g} m", tuple(foot + 1.3 * director), color=VARIANT, ha="center")
    ax.annotate(f"$L$ = {rod.length:g} m", tuple(geometry.X[10] - 1.9 * geometry.D[10]), color=INK)
    _plane(ax, "")
    ax.legend(loc="lower right")
    return figure


def fig_3_3(data: Data) -> Figure:
    """Sections of two choices of centreline: the director reaches the lateral surface, where X = 1."""
    figure, axes = canvas(7.2, 2.8, 1, 2)
    rod = problem_of(data["clamped_free"]).rod
    for ax, share, title in zip(
        axes, (0.5, 0.2), ("(a) area centre", "(b) near the surface"), strict=True
    ):
        chosen = rod.replace(centreline=share)
        length = chosen.geometry().director_length[0]
        low, W, H = -share * rod.height, rod.width, rod.height
        ax.fill(
            *np.array([[-W / 2, low], [W / 2, low], [W / 2, low + H], [-W / 2, low + H]]).T,
            facecolor=BODY,
            edgecolor=COMPUTED,
        )
        _arrow(ax, np.zeros(2), np.array([0.0, length]), INK, r"$\mathbf{D}_2$")
        _arrow(ax, np.zeros(2), np.array([W / 2, 0.0]), INK, r"$\mathbf{D}_1$")
        ax.set_aspect("equal", adjustable="datalim")
        ax.set(xlabel=r"along $\mathbf{E}_1$ [m]", ylabel=_UP)
        ax.set_title(
            f"{title}: $Y^{{02}}$ = {chosen.first_inertia:.3g}, $Y^{{22}}$ = {chosen.second_inertia:.3g}"
        )
    return figure


def fig_3_4(data: Data) -> Figure:
    """The discrete osculating circle: it touches both edges half a Voronoi length from the vertex."""
    figure, (ax,) = canvas(5.2, 3.6)
    rod = data["bent_rod"]
    x, K = rod.x.to_numpy(), 2
    measured = strains(problem_of(rod).rod.geometry(), x, rod.d.to_numpy())
    before, after = x[K] - x[K - 1], x[K + 1] - x[K]
    voronoi = (np.hypot(*before) + np.hypot(*after)) / 2
    bisector = after / np.hypot(*after) - before / np.hypot(*before)
    radius = 1 / abs(float(measured.kappa[K]))
    centre = x[K] + bisector / np.hypot(*bisector) * np.hypot(radius, voronoi / 2)
    angles = np.linspace(0, 2 * np.pi, 361)
    ax.plot(
        *(centre[:, None] + radius * np.array([np.cos(angles), np.sin(angles)])),
        color=VARIANT,
        label="osculating circle",
    )
    ax.plot(*x.T, color=INK, marker="o", label="centreline")
    for edge, sign in ((before, -1), (after, 1)):
        touch = x[K] + sign * voronoi / 2 * edge / np.hypot(*edge)
        ax.plot(*np.column_stack([centre, touch]), color=EXACT, linestyle=":")
    ax.annotate(
        rf"${{}}_K\varphi$ = {measured.phi[K]:.2f} rad",
        tuple(x[K]),
        xytext=(8, -14),
        textcoords="offset points",
    )
    ax.annotate(rf"${{}}_K r$ = {radius:.2f} m", tuple(centre), color=VARIANT)
    _plane(ax, "")
    ax.legend(loc="upper left")
    return figure


def fig_3_5(data: Data) -> Figure:
    """Bending into a ring, then inflation: the curvature falls, its product with the stretch does not."""
    figure, (left, right) = canvas(7.2, 3.6, 1, 2)
    rod = problem_of(data["clamped_free"]).rod
    for ax, n, title in ((left, 241, "(a) many vertices"), (right, 13, "(b) few vertices")):
        edge = rod.length / (n - 1)
        curvature = 2 * np.sin(np.pi / (n - 1)) / edge  # the polygon closes
        ring = Geometry.arc(n, rod.length, np.full(n, rod.height / 2), curvature)
        flat = Geometry.straight(n, rod.length, rod.height / 2)
        for stretch, colour in ((1.0, COMPUTED), (1.4, VARIANT)):
            x = stretch * (ring.X - ring.X.mean(axis=0))
            measured = strains(flat, x, ring.D)
            middle = n // 2
            label = (
                rf"$\mu$ = {measured.mu[middle]:.2f}, $\kappa$ = {measured.kappa[middle]:.3f} m$^{{-1}}$, "
                rf"$\mu\kappa$ = {measured.mu[middle] * measured.kappa[middle]:.3f} m$^{{-1}}$"
            )
            ax.plot(*x.T, color=colour, marker="" if n > 100 else "o", label=label)
        _plane(ax, title)
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), fontsize=8)
    return figure


def fig_3_6(data: Data) -> Figure:
    """Tangents, Bishop vector and director at one vertex, and the two angles they make."""
    figure, (left, right) = canvas(7.2, 3.4, 1, 2)
    rod = data["bent_rod"]
    x, d, K = rod.x.to_numpy(), rod.d.to_numpy(), 2
    edges = np.diff(x, axis=0)
    t = edges / np.hypot(*edges.T)[:, None]
    tangent, unit = vertex_tangents(x)[K], d[K] / np.hypot(*d[K])
    bishop = np.array([-tangent[1], tangent[0]])
    measured = strains(problem_of(rod).rod.geometry(), x, d)
    for ax in (left, right):
        ax.plot(*(x[K - 1 : K + 2] - x[K]).T, color=EXACT, marker="o")
    _arrow(left, np.zeros(2), t[K - 1], INK, r"${}^{K-1}\mathbf{t}$")
    _arrow(left, np.zeros(2), t[K], INK, r"${}^{K}\mathbf{t}$")
    _arrow(left, np.zeros(2), tangent, VARIANT, r"${}_{K}\mathbf{t}$")
    _arrow(left, np.zeros(2), unit, COMPUTED, r"${}_K\hat{\mathbf{d}}$")
    _arrow(right, np.zeros(2), bishop, VARIANT, r"${}_K\mathbf{b}$")
    _arrow(right, np.zeros(2), unit, COMPUTED, r"${}_K\hat{\mathbf{d}}$")
    _arrow(right, np.zeros(2), t[K - 1], INK)
    _arrow(right, np.zeros(2), t[K], INK)
    for a, b, size, label in (
        (t[K - 1], t[K], 1.3, rf"${{}}_K\varphi$ = {measured.phi[K]:.2f} rad"),
        (bishop, unit, 1.5, rf"${{}}_K\vartheta$ = {measured.theta[K]:.2f} rad"),
    ):
        start, stop = np.degrees(np.arctan2(a[1], a[0])), np.degrees(np.arctan2(b[1], b[0]))
        right.add_patch(
            Arc((0, 0), size, size, theta1=min(start, stop), theta2=max(start, stop), color=INK)
        )
        middle = np.radians((start + stop) / 2)
        right.annotate(
            label,
            (size / 2 * np.cos(middle), size / 2 * np.sin(middle)),
            xytext=(6, 2),
            textcoords="offset points",
        )
    for ax, title in ((left, "(a) tangents and director"), (right, "(b) Bishop vector and angles")):
        ax.set_aspect("equal")
        ax.set(xlim=(-1.3, 1.3), ylim=(-1.1, 1.3), xlabel=_ALONG, ylabel=_UP, title=title)
    return figure


def fig_3_7(_: Data) -> Figure:
    """The two nonlinear energy characteristics, with their quadratic approximations."""
    figure, (left, right) = canvas(7.2, 3.0, 1, 2)
    mu = np.linspace(0.08, 3.0, 400)
    left.plot(mu, [stretching(s)[0] for s in mu], color=COMPUTED, label=r"$\mu^2 - \mu + \mu^{-1} - 1$")
    left.plot(mu, 2 * (mu - 1) ** 2, color=EXACT, linestyle="--", label=r"$2 (\mu - 1)^2$")
    left.set(
        xlabel=r"stretch $\mu$ [1]", ylabel=r"$2 \pi_1 / k_1$ [1]", title="(a) stretching", ylim=(0, 8)
    )
    theta = np.linspace(-1.45, 1.45, 401)
    right.plot(
        theta, [squared_tangent(a, 0.0)[0] for a in theta], color=COMPUTED, label=r"$\tan^2 \vartheta$"
    )
    right.plot(theta, theta**2, color=EXACT, linestyle="--", label=r"$\vartheta^2$")
    right.set(
        xlabel=r"shear angle $\vartheta$ [rad]",
        ylabel=r"$2 \pi_2 / k_4$ [1]",
        title="(b) shearing",
        ylim=(0, 20),
    )
    for ax in (left, right):
        ax.legend()
    return figure
