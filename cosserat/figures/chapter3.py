"""Figures 3.8 to 3.12: the four static problems, computed and analytic side by side."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat import analytic
from cosserat.data.dataset import case_of
from cosserat.figures.style import (
    BODY,
    COMPUTED,
    EXACT,
    INK,
    VARIANT,
    canvas,
    computed_points,
    exact_curve,
)
from cosserat.table.readouts import beam_of, tension_of, weight_of

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_ALONG = r"arc length $\xi$ [m]"
_FINE = 401  # points of a closed form's curve


def fig_3_8(data: Data) -> Figure:
    """The four equilibria, displacements magnified."""
    figure, axes = canvas(7.2, 3.7, 2, 2)
    panels = [
        ("hanging_bar", "(a) hanging bar", 5_000),
        ("clamped_free", "(b) clamped-free beam", 20),
        ("clamped_clamped", "(c) clamped-clamped beam", 500),
        ("necking", "(d) necking", 80_000),
    ]
    for ax, (name, title, magnified) in zip(axes, panels, strict=True):
        _draw_panel(ax, data[name], magnified)
        ax.set_title(f"{title}, displacements × {magnified}")
        ax.set_aspect("equal")
        ax.set(
            xlim=(-0.9, 7.3),
            ylim=(-1.15, 1.6),
            xlabel=r"along $\mathbf{E}_3$ [m]",
            ylabel=r"along $\mathbf{E}_2$ [m]",
        )
    return figure


def _draw_panel(ax: Axes, data: xr.Dataset, magnified: float) -> None:
    """The rod as the body it stands for, with its supports and loads; lateral surfaces at x + d and x - d."""
    problem = case_of(data).problem
    X, D = data.x_ref.to_numpy(), data.d_ref.to_numpy()
    x, d = X + magnified * data.u.to_numpy(), D + magnified * data.delta.to_numpy()
    _draw_outline(ax, X, D, facecolor="none", edgecolor=EXACT, linestyle=":")
    _draw_outline(ax, x, d, facecolor=BODY, edgecolor=COMPUTED)
    ax.quiver(
        *x.T, *d.T, angles="xy", scale_units="xy", scale=1, color=COMPUTED, width=0.003, headwidth=5
    )
    ax.plot(*x.T, color=INK, linestyle="--", linewidth=0.9)
    for support in problem.supports:
        index = {"first": 0, "last": -1}[support.at] if isinstance(support.at, str) else support.at
        section = np.column_stack([x[index] - 1.7 * D[index], x[index] + 1.7 * D[index]])
        whole = {"d3", "d2"} <= set(support.hold)  # else the section may still stretch
        ax.plot(*section, color=INK, linewidth=3.0 if whole else 1.2, solid_capstyle="butt", zorder=4)
    if problem.gravity is not None:
        along = np.array([1.0, 0.0]) if problem.gravity.along == "E3" else np.array([0.0, -1.0])
        _draw_arrow(ax, np.array([2.5, 1.15]), along, "$g$")
    for force, foot in zip(problem.forces, (x[0], x[-1]), strict=False):
        _draw_arrow(ax, foot, np.array([1.0 if force.along == "E3" else -1.0, 0.0]), "$n$")


def _draw_outline(ax: Axes, x: Array, d: Array, **colours: Any) -> None:
    ax.fill(*np.vstack([x + d, (x - d)[::-1]]).T, linewidth=0.9, **colours)


def _draw_arrow(ax: Axes, foot: Array, along: Array, label: str) -> None:
    arrow = {"arrowstyle": "-|>", "color": VARIANT, "linewidth": 1.4}
    ax.annotate("", tuple(foot + 0.7 * along), tuple(foot), arrowprops=arrow)
    ax.annotate(
        label, tuple(foot + 0.5 * along), xytext=(4, 4), textcoords="offset points", color=VARIANT
    )


def fig_3_9(data: Data) -> Figure:
    """The hanging bar: displacement, and what the formula leaves out."""
    figure, (left, right) = canvas(7.2, 2.9, 1, 2)
    bar = data["hanging_bar"]
    problem = case_of(bar).problem
    xi, fine = bar.xi.to_numpy(), _fine(bar)
    exact = analytic.hanging_bar_displacement(beam_of(problem), weight_of(problem), fine)
    computed = bar.u.sel(axis="E3").to_numpy()
    exact_curve(left, fine, exact * 1e3, "eq. (3.5.2)")
    computed_points(left, xi, computed * 1e3, "discrete rod, $c_1 = 1/2$")
    left.set(
        xlabel=_ALONG,
        ylabel=r"displacement $\mathbf{u} \cdot \mathbf{E}_3$ [mm]",
        title="(a) displacement",
    )
    left.legend()
    at_vertices = analytic.hanging_bar_displacement(beam_of(problem), weight_of(problem), xi)
    computed_points(right, xi, (computed - at_vertices) / exact[-1] * 1e6, "")
    right.set(
        xlabel=_ALONG, ylabel="difference [$10^{-6}$ of the tip]", title="(b) computed less analytic"
    )
    return figure


def fig_3_10(data: Data) -> Figure:
    """The clamped-free beam: displacement and directors, both readings of eq. (3.4.10)."""
    return _beam(
        data["clamped_free"],
        data["clamped_free_ends_halved"],
        analytic.clamped_free_displacement,
        analytic.clamped_free_director,
        ("eq. (3.5.3)", "eq. (3.5.4)"),
    )


def fig_3_11(data: Data) -> Figure:
    """The clamped-clamped beam: displacement and directors, both readings of eq. (3.4.10)."""
    return _beam(
        data["clamped_clamped"],
        data["clamped_clamped_ends_halved"],
        analytic.clamped_clamped_displacement,
        analytic.clamped_clamped_director,
        ("eq. (3.5.6)", "eq. (3.5.7)"),
    )


def _beam(
    full: xr.Dataset,
    halved: xr.Dataset,
    displacement: analytic.BeamCurve,
    director: analytic.BeamCurve,
    equations: tuple[str, str],
) -> Figure:
    figure, (left, right) = canvas(7.2, 3.1, 1, 2)
    problem = case_of(full).problem
    fine, surface = _fine(full), problem.rod.height / 2
    exact_curve(left, fine, displacement(beam_of(problem), weight_of(problem), fine) * 1e3, equations[0])
    exact_curve(
        right, fine, director(beam_of(problem), weight_of(problem), fine) * surface * 1e3, equations[1]
    )
    for run, label, variant in ((full, "end areas full", False), (halved, "end areas halved", True)):
        xi = run.xi.to_numpy()
        computed_points(left, xi, run.u.sel(axis="E2").to_numpy() * 1e3, label, variant=variant)
        computed_points(right, xi, run.delta.sel(axis="E3").to_numpy() * 1e3, label, variant=variant)
    left.set(
        xlabel=_ALONG,
        ylabel=r"displacement $\mathbf{u} \cdot \mathbf{E}_2$ [mm]",
        title="(a) centreline",
    )
    right.set(
        xlabel=_ALONG,
        ylabel=r"$\boldsymbol{\delta} \cdot \mathbf{E}_3$ at the surface [mm]",
        title="(b) directors",
    )
    left.legend()
    return figure


def fig_3_12(data: Data) -> Figure:
    """Necking: the section strain, the page's decay and ours, and the coupling as printed."""
    figure, (left, right) = canvas(7.2, 3.3, 1, 2)
    necked, printed = data["necking"], data["necking_printed"]
    problem = case_of(necked).problem
    beam, n, xi, fine = beam_of(problem), tension_of(problem), necked.xi.to_numpy(), _fine(necked)
    theories: list[tuple[analytic.NeckingTheory, str]] = [
        ("printed", r"eqs. (3.5.8), (3.5.9) as printed"),
        ("two directors", r"(3.5.8), $\beta$ of two directors"),
    ]
    for ax in (left, right):
        for theory, label in theories:
            curve = analytic.necking_strain(beam, n, analytic.necking_decay(beam, theory), fine)
            exact_curve(ax, fine, curve * 1e6, label, dashed=theory != "printed")
        computed_points(ax, xi, (necked.lam.to_numpy() - 1) * 1e6, "discrete rod, half coupling")
        ax.set(xlabel=_ALONG, ylabel=r"section strain $\lambda - 1$ [$10^{-6}$]")
    computed_points(left, xi, (printed.lam.to_numpy() - 1) * 1e6, "coupling as printed", variant=True)
    left.set_title("(a) whole bar")
    left.legend(loc="center")
    right.set_title("(b) beside the held end")
    right.set_xlim(-0.03, 1.1)
    right.set_ylim(-1.35, 0.05)
    return figure


def _fine(data: xr.Dataset) -> Array:
    return np.linspace(0.0, case_of(data).problem.rod.length, _FINE)
