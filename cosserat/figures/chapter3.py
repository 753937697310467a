"""Figures 3.8 to 3.12: the four static problems, computed and analytic side by side."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat import analytic
from cosserat.figures.rod import draw_body
from cosserat.figures.style import canvas, computed_points, exact_curve, plain_points
from cosserat.models.calibration import beam_of
from cosserat.table.readouts import problem_of, tension_of, weight_of

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]

_ALONG = r"arc length $\xi$ [m]"
_FINE = 401  # points of a closed form's curve


def fig_3_8(data: Data) -> Figure:
    """The four equilibria, displacements magnified, and the centreline of the consistent rod."""
    figure, axes = canvas(7.2, 3.7, 2, 2)
    panels = [
        ("hanging_bar", "(a) hanging bar", 5_000),
        ("clamped_free", "(b) clamped-free beam", 20),
        ("clamped_clamped", "(c) clamped-clamped beam", 500),
        ("necking", "(d) necking", 80_000),
    ]
    for ax, (name, title, magnified) in zip(axes, panels, strict=True):
        draw_body(ax, data[name], magnified)
        other = data[f"{name}_consistent"]
        place = (other.x_ref + magnified * other.u).to_numpy()
        plain_points(ax, place[:, 0], place[:, 1])
        ax.set_title(f"{title}, displacements × {magnified}")
        ax.set_aspect("equal")
        ax.set(
            xlim=(-0.9, 7.3),
            ylim=(-1.15, 1.6),
            xlabel=r"along $\mathbf{E}_3$ [m]",
            ylabel=r"along $\mathbf{E}_2$ [m]",
        )
    return figure


def fig_3_9(data: Data) -> Figure:
    """The hanging bar: displacement, and what the formula leaves out."""
    figure, (left, right) = canvas(7.2, 2.9, 1, 2)
    bar = data["hanging_bar"]
    problem = problem_of(bar)
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
    free = data["hanging_bar_consistent"]
    plain_points(left, free.xi.to_numpy(), free.u.sel(axis="E3").to_numpy() * 1e3)
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
        data["clamped_free_consistent"],
        analytic.clamped_free_displacement,
        analytic.clamped_free_director,
        ("eq. (3.5.3)", "eq. (3.5.4)"),
    )


def fig_3_11(data: Data) -> Figure:
    """The clamped-clamped beam: displacement and directors, both readings of eq. (3.4.10)."""
    return _beam(
        data["clamped_clamped"],
        data["clamped_clamped_ends_halved"],
        data["clamped_clamped_consistent"],
        analytic.clamped_clamped_displacement,
        analytic.clamped_clamped_director,
        ("eq. (3.5.6)", "eq. (3.5.7)"),
    )


def _beam(
    full: xr.Dataset,
    halved: xr.Dataset,
    consistent: xr.Dataset,
    displacement: analytic.BeamCurve,
    director: analytic.BeamCurve,
    equations: tuple[str, str],
) -> Figure:
    figure, (left, right) = canvas(7.2, 3.1, 1, 2)
    problem = problem_of(full)
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
    left.legend()
    right.legend()
    return figure


def fig_3_12(data: Data) -> Figure:
    """Necking: the section strain, the page's decay and ours, and the coupling as printed."""
    figure, (left, right) = canvas(7.2, 3.3, 1, 2)
    necked, printed = data["necking"], data["necking_printed"]
    problem = problem_of(necked)
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
    free = data["necking_consistent"]
    for ax in (left, right):
        plain_points(ax, free.xi.to_numpy(), (free.lam.to_numpy() - 1) * 1e6)
    computed_points(left, xi, (printed.lam.to_numpy() - 1) * 1e6, "coupling as printed", variant=True)
    left.set_title("(a) whole bar")
    left.legend(loc="center")
    right.set_title("(b) beside the held end")
    right.set_xlim(-0.03, 1.1)
    right.set_ylim(-1.35, 0.05)
    return figure


def _fine(data: xr.Dataset) -> Array:
    return np.linspace(0.0, problem_of(data).rod.length, _FINE)
