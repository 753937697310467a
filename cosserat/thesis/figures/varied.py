"""Rods that are not uniform, straight or loaded by their weight alone."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cosserat.data.dataset import problem_of
from cosserat.figures.rod import draw_body, draw_outline
from cosserat.figures.style import (
    ALONG_E2,
    ALONG_E3,
    BODY,
    COMPUTED,
    CONSISTENT,
    EXACT,
    INK,
    VARIANT,
    WIDTH,
    canvas,
    computed_points,
    exact_curve,
    plain_points,
)
from cosserat.rods.problem import RodProblem

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]
_SAG = 20  # magnification of displacements under the weight


def _plane(ax: Axes, title: str) -> None:
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel=ALONG_E3, ylabel=ALONG_E2, title=title)


def fig_varied_sections(data: Data) -> Figure:
    """A tapered beam beside the uniform one, and the displacement of a bar of two materials with its closed form."""
    figure, (left, right) = canvas(WIDTH, 5.6, 2, 1)
    draw_body(left, data["cone"], _SAG)
    uniform = data["clamped_free"]
    x, d = (
        uniform[ref].to_numpy() + _SAG * uniform[moved].to_numpy()
        for ref, moved in (("x_ref", "u"), ("d_ref", "delta"))
    )
    problem = problem_of(uniform, RodProblem)
    draw_outline(left, x, d, problem, facecolor="none", edgecolor=VARIANT, linestyle="--")
    _plane(left, f"(a) tapered; dashed: uniform; × {_SAG}")
    averaged, added = data["two_materials"], data["two_materials_consistent"]
    rod = problem_of(averaged, RodProblem).rod
    joint, scale = rod.stations[0].at, rod.stations[1]
    xi = np.linspace(0.0, rod.length, 201)
    exact = _two_materials(xi, rod.length, joint, scale.young, scale.density)
    unit = 1e6 * rod.line_density * _gravity(averaged) / (rod.young * rod.area)
    exact_curve(right, xi, unit * exact, "closed form")
    computed_points(right, averaged.xi, 1e6 * averaged.u.sel(axis="E3"), "published rod")
    plain_points(right, added.xi, 1e6 * added.u.sel(axis="E3"))
    right.axvline(joint, color=INK, linestyle=":", linewidth=0.9)
    right.annotate(
        "joint", (joint, 0), xytext=(3, 4), textcoords="offset points", color=INK, va="bottom"
    )
    right.set(
        xlabel=r"arc length $\xi$ [m]",
        ylabel=r"displacement $\mathbf{u} \cdot \mathbf{E}_3$ [µm]",
        title="(b) a bar of two materials",
    )
    right.legend()
    return figure


def _gravity(data: xr.Dataset) -> float:
    gravity = problem_of(data, RodProblem).gravity
    assert gravity is not None
    return gravity.g


def _two_materials(xi: Array, length: float, joint: float, young: float, density: float) -> Array:
    """Displacement of a bar that hangs from 0, times EA / (rho0 g) of its upper part, (n,) [m^2].

    young, density : of the part below `joint`, over those of the part above.  derived: the integral of the weight below
    each point over its modulus.
    """
    below = density * (length - joint)
    upper = np.minimum(xi, joint)
    lower = np.maximum(xi - joint, 0.0)
    above: Array = (below + joint) * upper - upper**2 / 2
    return above + density / young * ((length - joint) * lower - lower**2 / 2)


def fig_low_centreline(data: Data) -> Figure:
    """Sag of one body with its centreline in the middle and near the lower surface, by both rods."""
    figure, (ax,) = canvas(WIDTH, 4.2)
    for name, marker, colour, label in (
        ("clamped_free", "o", COMPUTED, "published rod, centreline in the middle"),
        ("low_centreline", "s", VARIANT, "published rod, centreline near the lower surface"),
    ):
        ax.plot(
            data[name].xi,
            1e3 * data[name].u.sel(axis="E2"),
            linestyle="none",
            marker=marker,
            color=colour,
            markerfacecolor="none" if marker == "s" else colour,
            label=label,
        )
    for name, line, colour, width, label in (
        ("clamped_free_consistent", "-", CONSISTENT, 1.0, "consistent rod, in the middle"),
        ("low_centreline_consistent", ":", INK, 2.4, "consistent rod, near the lower surface"),
    ):
        sag = 1e3 * data[name].u.sel(axis="E2")
        ax.plot(data[name].xi, sag, linestyle=line, color=colour, linewidth=width, label=label)
    ax.set(xlabel=r"arc length $\xi$ [m]", ylabel=r"displacement $\mathbf{u} \cdot \mathbf{E}_2$ [mm]")
    figure.legend(loc="outside lower center", ncols=1)
    return figure


def fig_couple_and_support(data: Data) -> Figure:
    """A beam bent by a couple on its last section, and one whose second clamp has sunk and turned."""
    figure, (left, right) = canvas(WIDTH, 5.4, 2, 1)
    draw_body(left, data["couple"], 1.0)
    _plane(left, "(a) a couple on the last section")
    draw_body(right, data["turned_support"], 1.0)
    _plane(right, "(b) the right clamp sinks and turns")
    return figure


def fig_hook(data: Data) -> Figure:
    """A rod whose reference is an arc: at rest with the intrinsic curvature subtracted, straightened without it."""
    figure, (ax,) = canvas(WIDTH, 4.2)
    for name, face, edge, label in (
        ("hook", BODY, COMPUTED, "intrinsic curvature subtracted: it stays"),
        ("hook_printed", "none", VARIANT, "whole curvature, as printed: it straightens"),
    ):
        run = data[name]
        x, d = run.x.to_numpy(), run.d.to_numpy()
        problem = problem_of(run, RodProblem)
        draw_outline(ax, x, d, problem, facecolor=face, edgecolor=edge, label=label)
        ax.plot(*x.T, color=edge, marker=".", markersize=3, linewidth=0.8)
    reference = data["hook"].x_ref.to_numpy()
    ax.plot(*reference.T, color=EXACT, linestyle=":", linewidth=2.0, label="reference")
    _plane(ax, "no load acts")
    figure.legend(loc="outside lower center")
    return figure
