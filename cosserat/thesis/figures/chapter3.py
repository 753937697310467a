"""Figures 3.8 to 3.12: the four static problems, computed and analytic side by side."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.exact import beams
from cosserat.figures.crawlers import THINNED
from cosserat.figures.rod import draw_loads, draw_outline
from cosserat.figures.style import (
    ALONG_E2,
    ALONG_E3,
    BODY,
    COMPUTED,
    CONSISTENT,
    EXACT,
    INK,
    WIDTH,
    Picture,
    canvas,
    computed_points,
    exact_curve,
    plain_points,
)
from cosserat.figures.supports import draw_supports
from cosserat.problems.calibration import beam_of
from cosserat.rods.problem import RodProblem
from cosserat.thesis.table.readouts import tension_of, weight_of

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_ALONG = r"arc length $\xi$ [m]"
_THIN = THINNED  # the thinnest section
_SECTIONS = LinearSegmentedColormap.from_list("sections", [BODY, "#f4efe4", _THIN])
_CURVE_POINTS = 401  # points of a closed form's curve


def fig_3_8(data: Data) -> Figure:
    """The four equilibria, magnified, with their sections, and the centreline of the consistent rod."""
    panels = [
        ("hanging_bar", "(a) hanging bar: × 5000", 5_000, 5_000, (-0.9, 1.5)),
        ("clamped_free", "(b) clamped-free beam: × 20", 20, 20, (-1.2, 1.4)),
        ("clamped_clamped", "(c) clamped-clamped beam: × 500", 500, 500, (-0.9, 1.4)),
        ("necking", "(d) necking: × 80 000, sections × 400 000", 80_000, 400_000, (-0.9, 0.9)),
    ]
    figure = Picture(figsize=(WIDTH, 8.5), layout="constrained")
    axes = figure.subplots(4, 1, height_ratios=[np.ptp(panel[-1]) for panel in panels])
    for ax, (name, title, magnified, sections, heights) in zip(axes, panels, strict=True):
        _equilibrium(ax, data[name], data[f"{name}_consistent"], magnified, sections)
        ax.set_aspect("equal")
        ax.set(title=title, xlabel=ALONG_E3, ylabel=ALONG_E2, xlim=(-1.0, 7.7), ylim=heights)
    problem = problem_of(data["necking"], RodProblem)
    beam = beam_of(problem)
    end = beam.length * (1 + panels[-1][2] * tension_of(problem) / beam.axial_stiffness)
    axes[-1].plot([end, end], [-0.8, 0.8], color=EXACT, linestyle="-.", label=r"elongation $n\ell/EA$")
    looks = [
        Line2D([], [], color=EXACT, linestyle=":", label="reference"),
        Line2D([], [], color=INK, linewidth=3, label="section fixed"),
        Line2D([], [], color=COMPUTED, label="sections"),
        Line2D([], [], color=INK, linewidth=1.2, label="fixed, free to stretch"),
        Patch(facecolor=BODY, label=r"$\lambda = 1$"),
        *axes[-1].get_legend_handles_labels()[0],
        Patch(facecolor=_THIN, label=r"least $\lambda$"),
    ]
    figure.legend(handles=looks, loc="outside lower center", ncols=2)
    return figure


def _equilibrium(
    ax: Axes, run: xr.Dataset, other: xr.Dataset, magnified: float, sections: float
) -> None:
    """The body with its supports and loads; section displacements have their own magnification."""
    problem = problem_of(run, RodProblem)
    X, D = run.x_ref.to_numpy(), run.d_ref.to_numpy()
    x, d = X + magnified * run.u.to_numpy(), D + sections * run.delta.to_numpy()
    draw_outline(ax, X, D, problem, facecolor="none", edgecolor=EXACT, linestyle=":")
    _colour_sections(ax, x, d, run.lam.to_numpy() - 1)
    draw_outline(ax, x, d, problem, facecolor="none", edgecolor=COMPUTED)
    ends = np.stack([x - d, x + d, np.full_like(x, np.nan)], axis=1).reshape(-1, 2)
    ax.plot(*ends.T, color=COMPUTED, linewidth=0.9, label="_sections")
    draw_supports(ax, problem, x, D)
    place = (other.x_ref + magnified * other.u).to_numpy()
    ax.plot(
        *place.T, color=CONSISTENT, linestyle="--", linewidth=1.4, label="consistent rod, centreline"
    )
    far = x.copy()
    far[-1] = max(x[-1], place[-1], key=lambda point: float(point[0]))
    draw_loads(ax, problem, far, d)


def _colour_sections(ax: Axes, x: Array, d: Array, strain: Array) -> None:
    """Fill each edge of the body by its mean section strain: orange where it is thinnest, blue where it is at rest."""
    least = min(float(strain.min()), -1e-12)  # of a rod whose sections keep their height nothing is thin
    for k, share in enumerate((strain[:-1] + strain[1:]) / 2 / least):
        edge = [x[k] - d[k], x[k] + d[k], x[k + 1] + d[k + 1], x[k + 1] - d[k + 1]]
        ax.fill(*np.transpose(edge), facecolor=_SECTIONS(max(0.0, share)), linewidth=0)


def fig_3_9(data: Data) -> Figure:
    """The hanging bar: displacement, and the differences of both rods from the formula."""
    figure, (top, bottom) = canvas(WIDTH, 5.2, 2, 1)
    bar, free = data["hanging_bar"], data["hanging_bar_consistent"]
    problem = problem_of(bar, RodProblem)
    weight = weight_of(problem)

    def exact(xi: Array) -> Array:
        return beams.hanging_bar_displacement(beam_of(problem), weight, xi)

    tip = float(exact(np.array([problem.rod.length]))[0])
    exact_curve(top, _fine(bar), exact(_fine(bar)) * 1e3, "eq. (3.5.2)")
    for run, draw in (
        (bar, partial(computed_points, label="discrete rod, $c_1 = 1/2$")),
        (free, plain_points),
    ):
        xi, computed = run.xi.to_numpy(), run.u.sel(axis="E3").to_numpy()
        draw(top, xi, computed * 1e3)
        draw(bottom, xi, (computed - exact(xi)) / tip * 1e6)
    top.set(ylabel=r"$\mathbf{u} \cdot \mathbf{E}_3$ [mm]", title="(a) displacement")
    bottom.set(ylabel="difference [$10^{-6}$ of tip]", title="(b) computed less analytic")
    for ax in (top, bottom):
        ax.set_xlabel(_ALONG)
    top.legend()
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
    """Displacement and directors, each beside its formula, and below it the differences of all rods from that."""
    figure, axes = canvas(WIDTH, 8.8, 4, 1)
    problem = problem_of(full, RodProblem)
    beam, weight, surface = beam_of(problem), weight_of(problem), problem.rod.height / 2
    for ax, below, curve, scale, equation, (variable, axis) in (
        (axes[0], axes[1], displacement, 1e3, equations[0], ("u", "E2")),
        (axes[2], axes[3], director, surface * 1e3, equations[1], ("delta", "E3")),
    ):
        fine = _fine(full)
        exact_curve(ax, fine, curve(beam, weight, fine) * scale, equation)
        for run, draw in (
            (full, partial(computed_points, label="end areas full")),
            (halved, partial(computed_points, label="end areas halved", variant=True)),
            (consistent, plain_points),
        ):
            xi, computed = run.xi.to_numpy(), run[variable].sel(axis=axis).to_numpy() * 1e3
            draw(ax, xi, computed)
            draw(below, xi, computed - curve(beam, weight, xi) * scale)
    turn = r"$\boldsymbol{\delta} \cdot \mathbf{E}_3$ [mm]"
    axes[0].set(
        ylabel=r"$\mathbf{u} \cdot \mathbf{E}_2$ [mm]", title="(a) displacement of the centreline"
    )
    axes[2].set(ylabel=turn, title="(b) directors, at the surface")
    for ax, letter in ((axes[1], "a"), (axes[3], "b")):
        ax.set(ylabel="difference [mm]", title=f"({letter}) difference: computed less analytic")
    for ax in axes:
        ax.set_xlabel(_ALONG)
    handles, labels = axes[0].get_legend_handles_labels()
    handles, labels = [*handles[1:], handles[0]], [*labels[1:], " and ".join(equations)]
    figure.legend(handles, labels, loc="outside lower center", ncols=2)
    return figure


def fig_3_12(data: Data) -> Figure:
    """Necking: strains and displacements of the directors, three decays, and the coupling as printed."""
    figure = Picture(figsize=(WIDTH, 8.6), layout="constrained")
    panels = figure.subplot_mosaic([["a"], ["b"], ["c"]])
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
        ax.set(xlabel=_ALONG, ylabel=r"strain $\lambda - 1$ [$10^{-6}$]", title=title)
        _at_surface(ax, problem.rod.height / 2)
    panels["b"].set_xlim(-0.03, 1.1)
    handles, labels = panels["a"].get_legend_handles_labels()
    more = panels["c"].get_legend_handles_labels()
    figure.legend([*handles, more[0][-1]], [*labels, more[1][-1]], loc="outside lower center", ncols=1)
    return figure


def _at_surface(ax: Axes, reach: float) -> None:
    """A second scale: displacement of the surface, at `reach` from the centreline, relative to it [um]."""
    second = ax.secondary_yaxis(
        "right", functions=(lambda e: np.asarray(e) * reach, lambda u: np.asarray(u) / reach)
    )
    second.set_ylabel(r"$\boldsymbol{\delta} \cdot \mathbf{E}_2$ [µm]")


def _fine(data: xr.Dataset) -> Array:
    return np.linspace(0.0, problem_of(data, RodProblem).rod.length, _CURVE_POINTS)
