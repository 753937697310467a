"""Figures 3.8 to 3.12: the four static problems, computed and analytic side by side."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.exact import beams
from cosserat.figures.rod import draw_loads, draw_outline
from cosserat.figures.style import (
    BODY,
    COMPUTED,
    CONSISTENT,
    EXACT,
    INK,
    canvas,
    computed_points,
    exact_curve,
    plain_points,
)
from cosserat.figures.supports import draw_supports
from cosserat.rods.problem import RodProblem
from cosserat.studies.calibration import beam_of
from cosserat.thesis.table.readouts import tension_of, weight_of

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_ALONG = r"arc length $\xi$ [m]"
_CURVE_POINTS = 401  # points of a closed form's curve


def fig_3_8(data: Data) -> Figure:
    """The four equilibria, magnified, with directors of unit length, and the centreline of the consistent rod."""
    figure, axes = canvas(7.2, 4.5, 2, 2)
    panels = [
        ("hanging_bar", "(a) hanging bar: × 5000", 5_000, 5_000),
        ("clamped_free", "(b) clamped-free beam: × 20", 20, 20),
        ("clamped_clamped", "(c) clamped-clamped beam: × 500", 500, 500),
        ("necking", "(d) necking: × 80 000, sections × 400 000", 80_000, 400_000),
    ]
    for ax, (name, title, magnified, sections) in zip(axes, panels, strict=True):
        _equilibrium(ax, data[name], data[f"{name}_consistent"], magnified, sections)
        ax.set_title(title)
        ax.set_aspect("equal")
        ax.set(
            xlim=(-1.1, 7.7),
            ylim=(-1.3, 2.1),
            xlabel=r"along $\mathbf{E}_3$ [m]",
            ylabel=r"along $\mathbf{E}_2$ [m]",
        )
    problem = problem_of(data["necking"], RodProblem)
    beam = beam_of(problem)
    end = beam.length * (1 + panels[-1][2] * tension_of(problem) / beam.axial_stiffness)
    axes[-1].plot([end, end], [-0.8, 0.8], color=EXACT, linestyle="-.", label=r"elongation $n\ell/EA$")
    looks = [
        Line2D([], [], color=EXACT, linestyle=":", label="reference"),
        Patch(facecolor=BODY, edgecolor=COMPUTED, label="body"),
        Line2D([], [], color=INK, linestyle="--", linewidth=0.9, label="centreline"),
        Line2D([], [], color=COMPUTED, marker="^", label="directors of unit length"),
        Line2D([], [], color=INK, linewidth=3, label="section fixed"),
        Line2D([], [], color=INK, linewidth=1.2, label="section fixed, free to stretch"),
        *axes[-1].get_legend_handles_labels()[0],
    ]
    figure.legend(handles=looks, loc="outside lower center", ncols=4, fontsize=8)
    return figure


def _equilibrium(
    ax: Axes, run: xr.Dataset, other: xr.Dataset, magnified: float, sections: float
) -> None:
    """The body with its supports and loads; section displacements have their own magnification."""
    problem = problem_of(run, RodProblem)
    X, D = run.x_ref.to_numpy(), run.d_ref.to_numpy()
    x, d = X + magnified * run.u.to_numpy(), D + sections * run.delta.to_numpy()
    unit = d / np.linalg.norm(D, axis=1)[:, None]
    draw_outline(ax, X, D, problem, facecolor="none", edgecolor=EXACT, linestyle=":")
    draw_outline(ax, x, d, problem, facecolor=BODY, edgecolor=COMPUTED)
    ax.quiver(
        *x.T, *unit.T, angles="xy", scale_units="xy", scale=1, color=COMPUTED, width=0.004, headwidth=4
    )
    ax.plot(*x.T, color=INK, linestyle="--", linewidth=0.9)
    draw_supports(ax, problem, x, D)
    place = (other.x_ref + magnified * other.u).to_numpy()
    plain_points(ax, place[:, 0], place[:, 1])
    ends = x.copy()
    ends[-1] = max(x[-1], place[-1], key=lambda point: float(point[0]))
    draw_loads(ax, problem, ends, unit)


def fig_3_9(data: Data) -> Figure:
    """The hanging bar: displacement, and its difference from the formula."""
    figure, (left, right) = canvas(7.2, 2.9, 1, 2)
    bar = data["hanging_bar"]
    problem = problem_of(bar, RodProblem)
    xi, fine = bar.xi.to_numpy(), _fine(bar)
    exact = beams.hanging_bar_displacement(beam_of(problem), weight_of(problem), fine)
    computed = bar.u.sel(axis="E3").to_numpy()
    exact_curve(left, fine, exact * 1e3, "eq. (3.5.2)")
    computed_points(left, xi, computed * 1e3, "discrete rod, $c_1 = 1/2$")
    left.set(
        xlabel=_ALONG,
        ylabel=r"displacement $\mathbf{u} \cdot \mathbf{E}_3$ [mm]",
        title="(a) displacement",
    )
    left.legend()
    free = data["hanging_bar_consistent"]
    plain_points(left, free.xi.to_numpy(), free.u.sel(axis="E3").to_numpy() * 1e3)
    left.legend()
    at_vertices = beams.hanging_bar_displacement(beam_of(problem), weight_of(problem), xi)
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
        data["clamped_free_consistent"],
        beams.clamped_free_displacement,
        beams.clamped_free_director,
        ("eq. (3.5.3)", "eq. (3.5.4)"),
    )


def fig_3_11(data: Data) -> Figure:
    """The clamped-clamped beam: displacement and directors, both readings of eq. (3.4.10)."""
    return _beam(
        data["clamped_clamped"],
        data["clamped_clamped_ends_halved"],
        data["clamped_clamped_consistent"],
        beams.clamped_clamped_displacement,
        beams.clamped_clamped_director,
        ("eq. (3.5.6)", "eq. (3.5.7)"),
    )


def _beam(
    full: xr.Dataset,
    halved: xr.Dataset,
    consistent: xr.Dataset,
    displacement: beams.BeamCurve,
    director: beams.BeamCurve,
    equations: tuple[str, str],
) -> Figure:
    figure, (left, right) = canvas(7.2, 3.1, 1, 2)
    problem = problem_of(full, RodProblem)
    fine, surface = _fine(full), problem.rod.height / 2
    exact_curve(left, fine, displacement(beam_of(problem), weight_of(problem), fine) * 1e3, equations[0])
    exact_curve(
        right, fine, director(beam_of(problem), weight_of(problem), fine) * surface * 1e3, equations[1]
    )
    for run, label, variant in ((full, "end areas full", False), (halved, "end areas halved", True)):
        xi = run.xi.to_numpy()
        computed_points(left, xi, run.u.sel(axis="E2").to_numpy() * 1e3, label, variant=variant)
        computed_points(right, xi, run.delta.sel(axis="E3").to_numpy() * 1e3, label, variant=variant)
    for ax, values in (
        (left, consistent.u.sel(axis="E2")),
        (right, consistent.delta.sel(axis="E3")),
    ):
        plain_points(ax, consistent.xi.to_numpy(), values.to_numpy() * 1e3)
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
    left.legend(fontsize=8)
    right.legend(fontsize=8)
    return figure


def fig_3_12(data: Data) -> Figure:
    """Necking: strains and displacements of the directors, three decays, and the coupling as printed."""
    figure = Figure(figsize=(7.2, 6.4), layout="constrained")
    panels = figure.subplot_mosaic([["a", "b"], ["c", "c"]], height_ratios=[1.5, 1])
    necked, printed, free = data["necking"], data["necking_printed"], data["necking_consistent"]
    problem = problem_of(necked, RodProblem)
    beam, n, xi, fine = beam_of(problem), tension_of(problem), necked.xi.to_numpy(), _fine(necked)
    theories: list[tuple[beams.NeckingTheory, str, str]] = [
        ("printed", "(3.5.8), (3.5.9) as printed", "-"),
        ("two directors", r"(3.5.8), $\beta$ of two directors", "--"),
        ("free section", r"(3.5.8), $\beta$ of a free section", "-."),
    ]
    for letter, title in (
        ("a", "(a) whole bar"),
        ("b", "(b) beside the fixed end"),
        ("c", "(c) with the coupling as printed"),
    ):
        ax = panels[letter]
        for theory, label, line in theories if letter != "c" else theories[:1]:
            curve = beams.necking_strain(beam, n, beams.necking_decay(beam, theory), fine)
            colour = CONSISTENT if theory == "free section" else EXACT
            ax.plot(fine, curve * 1e6, color=colour, linestyle=line, label=label, zorder=2)
        if letter == "c":
            computed_points(
                ax,
                xi,
                (printed.lam.to_numpy() - 1) * 1e6,
                "discrete rod, coupling as printed",
                variant=True,
            )
        else:
            computed_points(ax, xi, (necked.lam.to_numpy() - 1) * 1e6, "discrete rod, half coupling")
            plain_points(ax, free.xi.to_numpy(), (free.lam.to_numpy() - 1) * 1e6)
        ax.set(xlabel=_ALONG, ylabel=r"section strain $\lambda - 1$ [$10^{-6}$]", title=title)
        _at_surface(ax, problem.rod.height / 2)
    panels["b"].set_xlim(-0.03, 1.1)
    handles, labels = panels["a"].get_legend_handles_labels()
    more = panels["c"].get_legend_handles_labels()
    figure.legend(
        [*handles, more[0][-1]], [*labels, more[1][-1]], loc="outside lower center", ncols=3, fontsize=8
    )
    return figure


def _at_surface(ax: Axes, reach: float) -> None:
    """A second scale: displacement of the surface, at `reach` from the centreline, relative to it [um]."""
    second = ax.secondary_yaxis(
        "right", functions=(lambda e: np.asarray(e) * reach, lambda u: np.asarray(u) / reach)
    )
    second.set_ylabel(r"$\boldsymbol{\delta} \cdot \mathbf{E}_2$ [µm]")


def _fine(data: xr.Dataset) -> Array:
    return np.linspace(0.0, problem_of(data, RodProblem).rod.length, _CURVE_POINTS)
