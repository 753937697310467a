"""Figures 3.1 to 3.7: the geometry of the discrete rod, drawn from configurations of the library, and its energies."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures.style import (
    ALONG_E2,
    ALONG_E3,
    BODY,
    COMPUTED,
    EXACT,
    INK,
    PAPER,
    VARIANT,
    WIDTH,
    Picture,
    canvas,
)
from cosserat.rods.energies.hemingway_kernel import squared_tangent, stretching
from cosserat.rods.problem import RodProblem
from cosserat.rods.reference import Geometry, strains, vertex_tangents

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]


def _arrow(ax: Axes, foot: Array, vector: Array, colour: str, label: str = "", far: float = 11) -> None:
    """An arrow with its label `far` points beyond its tip."""
    ax.quiver(
        *foot, *vector, angles="xy", scale_units="xy", scale=1, color=colour, width=0.006, zorder=4
    )
    if label:
        _label(ax, foot + vector, far * vector / np.hypot(*vector), label, colour)


def _label(ax: Axes, place: Array, aside: Array, label: str, colour: str = INK) -> None:
    """A text whose middle is offset by `aside`, in points, from a place of the data."""
    ax.annotate(
        label,
        tuple(place),
        xytext=tuple(aside),
        textcoords="offset points",
        ha="center",
        va="center",
        color=colour,
    )


def _span(ax: Axes, a: Array, b: Array, colour: str) -> None:
    """A measured length from a to b."""
    style = {"arrowstyle": "<->", "color": colour, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", tuple(b), tuple(a), arrowprops=style)


def _discrete(ax: Axes, x: Array, d: Array, name: str) -> None:
    """Centreline and directorline solid, directors, and the lower boundary as their reflection, dashed.

    name : the letter of centreline positions, printed with the numbers K of the vertices.
    """
    ax.plot(*x.T, color=INK, marker="o", markersize=4, label="centreline")
    ax.plot(*(x + d).T, color=COMPUTED, marker="s", markersize=3, label="directorline")
    ax.plot(*(x - d).T, color=EXACT, linestyle="--", label="reflected")
    for K, (foot, director) in enumerate(zip(x, d, strict=True)):
        _arrow(ax, foot, director, COMPUTED)
        below = -9 * director / np.hypot(*director)
        _label(ax, foot, below, rf"${{}}_{{{K}}}\mathbf{{{name}}}$")


def fig_3_1(data: Data) -> Figure:
    """A reference configuration and a current one, each vertex with its number."""
    low, middle, high = (-0.75, 0.75), (-0.95, 2.15), (-0.3, 5.35)
    figure = Picture(figsize=(WIDTH, 5.35), layout="constrained")
    axes = figure.subplots(2, 1, height_ratios=[np.ptp(low), np.ptp(middle)])
    rod = data["bent_rod"]
    _discrete(axes[0], rod.x_ref.to_numpy(), rod.d_ref.to_numpy(), "X")
    _discrete(axes[1], rod.x.to_numpy(), rod.d.to_numpy(), "x")
    axes[0].set_title(r"(a) reference: ${}_K\mathbf{X}$, ${}_K\mathbf{D}$")
    axes[1].set_title(r"(b) current: ${}_K\mathbf{x}$, ${}_K\mathbf{d}$")
    for ax, heights in zip(axes, (low, middle), strict=True):
        ax.set_aspect("equal")
        ax.set(xlabel=ALONG_E3, ylabel=ALONG_E2, xlim=high, ylim=heights)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def fig_3_2(data: Data) -> Figure:
    """A rod-like body, L >> D: a centreline close to its middle, and one section as a hatched area.

    A tube with elliptical sections, seen obliquely, with the length and the height of the rod.
    """
    figure, (ax,) = canvas(WIDTH, 3.1)
    rod = problem_of(data["clamped_free"], RodProblem).rod
    count, cut = 81, 48
    geometry = Geometry.arc(np.linspace(0.0, rod.length, count), np.full(count, rod.height / 2), 0.12)
    fraction = np.linspace(0, 1, count)[:, None]
    up = geometry.D * (
        0.9 + 0.1 * np.sin(2 * np.pi * fraction)
    )  # half the thickness, D where it is largest
    away = np.array([0.3, 0.2]) * rod.height / 2  # the other half-axis, seen obliquely
    towards = np.arctan2((away * up).sum(axis=1), (up * up).sum(axis=1))[:, None]
    edge = up * np.cos(towards) + away * np.sin(towards)  # where the line of sight touches the tube
    around = np.linspace(0, 2 * np.pi, 73)[:, None]

    def section(k: int, angles: Array = around) -> Array:
        ring: Array = geometry.X[k] + up[k] * np.cos(angles) + away * np.sin(angles)
        return ring

    behind = section(0, np.linspace(np.pi, 2 * np.pi, 37)[:, None])
    body = np.vstack([behind, geometry.X + edge, (geometry.X - edge)[::-1]])
    ax.fill(*body.T, facecolor=BODY, edgecolor=COMPUTED, linewidth=0.9)
    ax.fill(*section(count - 1).T, facecolor=BODY, edgecolor=COMPUTED, linewidth=0.9)
    ax.fill(
        *section(cut).T,
        facecolor=PAPER,
        edgecolor=VARIANT,
        hatch="/////",
        linewidth=1.2,
        label="section",
    )
    close = geometry.X + 0.3 * np.cos(3 * fraction) * up
    ax.plot(*close.T, color=INK, linestyle="--", label="centreline")
    thick = int(np.argmax(np.hypot(*up.T)))
    top, bottom = geometry.X[thick] + up[thick], geometry.X[thick] - up[thick]
    _span(ax, bottom, top, VARIANT)
    _label(ax, top, np.array([-6, 14]), f"thickness $D$ = {rod.height:g} m", VARIANT)
    below = geometry.X + np.array([0.1, -0.6])
    ax.plot(*below.T, color=INK, linewidth=0.9)
    for k, step in ((0, 1), (-1, -2)):
        ax.annotate(
            "", tuple(below[k]), tuple(below[k + step]), arrowprops={"arrowstyle": "->", "shrinkB": 0}
        )
    _label(ax, below[count // 2], np.array([48, -14]), f"length $L$ = {rod.length:g} m")
    ax.set_aspect("equal")
    ax.set(xlabel=ALONG_E3, ylabel=ALONG_E2, xlim=(-0.3, 5.15), ylim=(-0.85, 1.75))
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def fig_3_3(data: Data) -> Figure:
    """Sections with oblique coordinates: directors that end on the surface, W and H by projection on their lines."""
    figure, (left, right) = canvas(4.0, 6.7, 2, 1)
    rod = problem_of(data["clamped_free"], RodProblem).rod.replace(centreline=0.2)
    W, H = rod.width, rod.height
    slanted = np.array([[np.cos(0.15), np.sin(0.15)], [np.cos(1.35), np.sin(1.35)]])
    angle = np.linspace(0, 2 * np.pi, 721)
    rounded = np.column_stack(
        [np.sign(f) * np.abs(f) ** 0.4 * r for f, r in ((np.cos(angle), W / 2), (np.sin(angle), H / 2))]
    )
    centre = np.array([-0.04, -0.02])  # of the section, from the centreline
    _section(left, (centre + rounded) @ slanted, slanted)
    left.set_title("(a) any section, any close centreline")
    low = -rod.centreline * H
    corners = np.array([[-W / 2, low], [W / 2, low], [W / 2, low + H], [-W / 2, low + H], [-W / 2, low]])
    _section(right, corners, np.eye(2))
    right.set_title(f"(b) as in this rod: $Y^{{02}}$ = {rod.Y02:.3g}, $Y^{{22}}$ = {rod.Y22:.3g}")
    for ax in (left, right):
        ax.set_aspect("equal")
        ax.grid(visible=False)
        ax.set(
            xlim=(-0.7, 0.42), ylim=(-0.43, 0.47), xlabel=r"along $\mathbf{E}_1$ [m]", ylabel=ALONG_E2
        )
    return figure


def reach(boundary: Array, along: Array) -> float:
    """Distance of a closed curve (n, 2) round the origin from it along a unit vector [m]."""
    turned = boundary @ np.array([[along[0], -along[1]], [along[1], along[0]]])
    angle = np.arctan2(turned[:, 1], turned[:, 0])
    k = int(np.flatnonzero((angle[:-1] <= 0) & (angle[1:] > 0) & (turned[:-1, 0] > 0))[0])
    fraction = turned[k, 1] / (turned[k, 1] - turned[k + 1, 1])
    return float(turned[k, 0] + fraction * (turned[k + 1, 0] - turned[k, 0]))


def _section(ax: Axes, boundary: Array, along: Array) -> None:
    """A section, its boundary given anticlockwise from the centreline, with directors along two unit vectors."""
    ax.fill(*boundary.T, facecolor=BODY, edgecolor=COMPUTED)
    D = np.array([reach(boundary, unit) * unit for unit in along])
    corner = D[0] + D[1]
    for director in D:
        ax.plot(*np.column_stack([corner, corner - director]), color=EXACT, linestyle=":")
    ax.plot(*corner, "o", color=VARIANT)
    _label(ax, corner, np.array([10, 10]), "(1, 1)", VARIANT)
    for k, (name, sign) in enumerate((("W", -1), ("H", 1))):
        _arrow(ax, np.zeros(2), D[k], INK)
        _label(
            ax, D[k] / 2, 11 * sign * np.array([-along[k][1], along[k][0]]), rf"$\mathbf{{D}}_{k + 1}$"
        )
        across = sign * np.array([-along[k][1], along[k][0]])
        ends = [boundary[np.argmin(boundary @ along[k])], boundary[np.argmax(boundary @ along[k])]]
        shift = float((boundary @ across).max()) + 0.07
        feet = [(end @ along[k]) * along[k] + shift * across for end in ends]
        for end, foot in zip(ends, feet, strict=True):
            ax.plot(*np.column_stack([end, foot]), color=EXACT, linewidth=0.8)
        size = float((feet[1] - feet[0]) @ along[k])
        _span(ax, feet[0], feet[1], INK)
        far = (34 if k else 13) * across  # a text is wider than high
        _label(ax, (feet[0] + feet[1]) / 2, far, f"${name}$ = {size:.2f} m")


def fig_3_4(data: Data) -> Figure:
    """The discrete osculating circle of a negative turning angle: it touches both edges at half a Voronoi length."""
    figure, (ax,) = canvas(WIDTH, 4.7)
    rod = data["bent_rod"]
    x, K = rod.x.to_numpy(), 4
    phi = float(rod.phi[K])
    before, after = x[K] - x[K - 1], x[K + 1] - x[K]
    t_before, t_after = before / np.hypot(*before), after / np.hypot(*after)
    voronoi = (np.hypot(*before) + np.hypot(*after)) / 2
    bisector = (t_after - t_before) / np.hypot(*(t_after - t_before))
    radius = 1 / abs(float(rod.kappa[K]))
    centre = x[K] + bisector * np.hypot(radius, voronoi / 2)
    angles = np.linspace(0, 2 * np.pi, 361)
    ax.plot(
        *(centre[:, None] + radius * np.array([np.cos(angles), np.sin(angles)])),
        color=VARIANT,
        label="osculating circle",
    )
    ax.plot(*x.T, color=INK, marker="o", label="centreline")
    touch = np.array([x[K] - voronoi / 2 * t_before, x[K] + voronoi / 2 * t_after])
    ax.plot(
        *np.array([touch[0], x[K], touch[1]]).T,
        color=COMPUTED,
        linewidth=4,
        alpha=0.6,
        solid_capstyle="butt",
        label=rf"Voronoi length ${{}}_{K}\ell$ = {voronoi:.2f} m",
    )
    for point in touch:
        ax.plot(*np.column_stack([centre, point]), color=EXACT, linestyle=":")
        _label(ax, (point + x[K]) / 2, 18 * bisector, rf"${{}}_{K}\ell / 2$", COMPUTED)
    ax.plot(*np.column_stack([x[K], x[K] + t_before]), color=INK, linestyle="--", linewidth=0.9)
    _angle(ax, x[K], t_before, phi, 0.75, rf"${{}}_{K}\varphi = {phi:.2f}$ rad", np.array([32, -22]))
    ax.plot(*centre, "+", color=VARIANT, markersize=7)
    _label(ax, centre, np.array([-8, -13]), rf"${{}}_{K}r = {radius:.2f}$ m", VARIANT)
    for k, aside in ((K - 1, (-8, 10)), (K, (14, 9)), (K + 1, (13, 5))):
        _label(ax, x[k], np.array(aside), rf"${{}}_{k}\mathbf{{x}}$")
    ax.set_aspect("equal")
    ax.set(xlabel=ALONG_E3, ylabel=ALONG_E2, xlim=(0.5, 3.25), ylim=(-0.3, 1.72))
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def _angle(
    ax: Axes, vertex: Array, begin: Array, angle: float, radius: float, label: str, aside: Array
) -> None:
    """An angle from a unit vector, positive from E3 towards E2, with an arrowhead at its end and a label."""
    turned = np.linspace(0, angle, 30)
    c, s = np.cos(turned), np.sin(turned)
    arc = vertex + radius * np.column_stack([c * begin[0] - s * begin[1], s * begin[0] + c * begin[1]])
    ax.plot(*arc.T, color=INK, linewidth=0.9)
    ax.fill(*np.vstack([vertex, arc]).T, color="#ececec", zorder=0.5)
    head = {"arrowstyle": "-|>", "color": INK, "linewidth": 0.9, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", tuple(arc[-1]), tuple(arc[-4]), arrowprops=head)
    _label(ax, arc[15], aside, label)


def fig_3_5(data: Data) -> Figure:
    """Bending into a ring, then inflation: the curvature falls, its product with the stretch does not."""
    figure, (left, right) = canvas(WIDTH, 5.6, 2, 1)
    rod = problem_of(data["clamped_free"], RodProblem).rod
    for ax, n, title in ((left, 241, "(a) many vertices"), (right, 13, "(b) few vertices")):
        edge = rod.length / (n - 1)
        curvature = 2 * np.sin(np.pi / (n - 1)) / edge  # closed polygon
        ring = Geometry.arc(np.linspace(0.0, rod.length, n), np.full(n, rod.height / 2), curvature)
        flat = Geometry.straight(np.linspace(0.0, rod.length, n), rod.height / 2)
        for stretch, colour in ((1.0, COMPUTED), (1.4, VARIANT)):
            x = stretch * (ring.X - ring.X.mean(axis=0))
            measured = strains(flat, x, ring.D)
            middle = n // 2
            label = (
                rf"$\mu$ = {measured.mu[middle]:.2f}" + "\n"
                rf"$\kappa$ = {measured.kappa[middle]:.3f} m$^{{-1}}$" + "\n"
                rf"$\mu\kappa$ = {measured.mu[middle] * measured.kappa[middle]:.3f} m$^{{-1}}$"
            )
            ax.plot(*x.T, color=colour, marker="" if n > 100 else "o", label=label)
        ax.set_aspect("equal")
        ax.set(xlabel=ALONG_E3, ylabel=ALONG_E2, title=title, xlim=(-1.3, 1.3), ylim=(-1.3, 1.3))
        ax.legend(loc="center left", bbox_to_anchor=(1.02, 0.5), labelspacing=1.2)
    return figure


def fig_3_6(data: Data) -> Figure:
    """Tangents, Bishop vector and director at one vertex, and the two angles they make."""
    figure, (left, right) = canvas(WIDTH, 6.4, 2, 1)
    rod = data["bent_rod"]
    x, d, K = rod.x.to_numpy(), rod.d.to_numpy(), 2
    edges = np.diff(x, axis=0)
    t = edges / np.hypot(*edges.T)[:, None]
    tangent, unit = vertex_tangents(x)[K], d[K] / np.hypot(*d[K])
    bishop = np.array([-tangent[1], tangent[0]])
    vertex = np.zeros(2)
    for ax in (left, right):
        ax.plot(*(x[K - 1 : K + 2] - x[K]).T, color=EXACT, marker="o")
        _arrow(ax, vertex, unit, COMPUTED, rf"${{}}_{K}\hat{{\mathbf{{d}}}}$")
        for k in (K - 1, K):
            _arrow(ax, vertex, t[k], INK, rf"${{}}^{k}\mathbf{{t}}$")
    _arrow(left, vertex, tangent, VARIANT, rf"${{}}_{K}\mathbf{{t}}$")
    _arrow(right, vertex, bishop, VARIANT, rf"${{}}_{K}\mathbf{{b}}$")
    for begin, name, symbol, radius, aside in (
        (t[K - 1], "phi", r"\varphi", 0.8, (52, 34)),
        (bishop, "theta", r"\vartheta", 0.8, (-66, 8)),
    ):
        angle = float(rod[name][K])
        _angle(
            right,
            vertex,
            begin,
            angle,
            radius,
            rf"${{}}_{K}{symbol} = {angle:.2f}$ rad",
            np.array(aside),
        )
    for ax, title in ((left, "(a) tangents and director"), (right, "(b) Bishop vector and angles")):
        ax.set_aspect("equal")
        ax.grid(visible=False)
        ax.set(xlim=(-1.85, 1.45), ylim=(-0.5, 1.3), xlabel=ALONG_E3, ylabel=ALONG_E2, title=title)
    return figure


def fig_3_7(_: Data) -> Figure:
    """The two nonlinear characteristics of the energy, with their quadratic approximations."""
    figure, (left, right) = canvas(WIDTH, 5.2, 2, 1)
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
