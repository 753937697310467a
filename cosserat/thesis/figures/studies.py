"""Figures of the published studies."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from numpy.typing import NDArray

from cosserat.exact import beams
from cosserat.figures.style import COMPUTED, EXACT, INK, VARIANT, WIDTH, Picture, canvas
from cosserat.problems.calibration import beam_of
from cosserat.problems.path import RodPath
from cosserat.problems.static import RodStatics
from cosserat.studies.analysis.indices import indices
from cosserat.studies.door import case_of_study
from cosserat.studies.readouts import read_out

Array = NDArray[np.float64]
Data = Mapping[str, xr.Dataset]
_LOOKS = ((EXACT, "^:"), (COMPUTED, "o-"), (VARIANT, "s-."), (INK, "D--"))
"""Colours, markers and lines of four curves."""
_KEYS = {
    "length": r"length $\ell_0$",
    "radius": "radius $R$",
    "young": "Young's modulus $E$",
    "anchoring": r"anchoring $\bar{D}$",
    "advancing": "advancing $p$",
}


def fig_worm_stride(data: Data) -> Figure:
    """Sobol's indices of the stride with their intervals, and the stride over its two strongest inputs."""
    answer = data["worm_stride"]
    found = indices(answer, of="stride")
    figure = Picture(figsize=(WIDTH, 5.6), layout="constrained")
    panels = figure.subplot_mosaic([["a", "a"], ["b", "c"]])
    left = panels["a"]
    names = [str(name) for name in found["key"].to_numpy()]
    places = np.arange(len(names))
    for shift, kind, colour in ((-0.18, "first", COMPUTED), (0.18, "total", VARIANT)):
        value, low, high = (found[f"{kind}{end}"].to_numpy() for end in ("", "_low", "_high"))
        left.barh(places + shift, value, 0.32, color=colour, label=f"{kind} order")
        left.hlines(places + shift, low, high, color=INK, linewidth=1)
    left.set_yticks(places, [_KEYS[name] for name in names])
    left.invert_yaxis()
    left.set(xlabel="Sobol's index [1]", ylabel="input [name]", title="(a) share of the variance")
    left.set_xlim(right=1.05)
    left.legend(loc="lower right")
    order = np.argsort(-found["total"].to_numpy())[:2]
    base = answer.isel(member=answer["matrix"].to_numpy() < 2)
    for k, letter in zip(order, "bc", strict=True):
        key = names[int(k)]
        scale, unit = _scaled(answer[key].attrs["units"])
        ax = panels[letter]
        ax.plot(base[key] * scale, base["stride"] * 1e3, ".", color=COMPUTED)
        ax.set(xlabel=f"{_KEYS[key]} [{unit}]", ylabel="stride [mm]", title=f"({letter})")
    return figure


def _scaled(units: str) -> tuple[float, str]:
    return {"m": (1e3, "mm"), "Pa": (1e-3, "kPa"), "N": (1e3, "mN")}[units]


def fig_calibration_reach(data: Data) -> Figure:
    """Sag of the published rod over that of Timoshenko's beam, by length, vertices and Poisson's ratio."""
    answer = data["calibration_reach"]
    ratio = reach(answer)
    figure, axes = canvas(WIDTH, 5.8, 2, 1)
    slender = ratio["length"] / case_of_study(answer).problem_as(RodStatics).rod.height
    for (colour, look), count in zip(_LOOKS, ratio["vertices"].to_numpy(), strict=True):
        values = ratio.sel(vertices=count, poisson=0.2)
        axes[0].semilogx(slender, values, look, color=colour, label=f"N = {count}")
    for (colour, look), poisson in zip(_LOOKS, ratio["poisson"].to_numpy(), strict=True):
        values = ratio.sel(vertices=20, poisson=poisson)
        axes[1].semilogx(slender, values, look, color=colour, label=rf"$\nu$ = {poisson:g}")
    for ax, title in zip(axes, (r"(a) $\nu$ = 0.2", "(b) N = 20, that of the calibration"), strict=True):
        ax.axhline(1, color=INK, linewidth=0.8, zorder=1)
        ax.set_xticks(slender, [f"{value:g}" for value in slender.to_numpy()], minor=False)
        ax.xaxis.set_minor_locator(NullLocator())
        ax.set(xlabel="length over height [1]", ylabel="sag over the beam's [1]", title=title)
        ax.legend()
    return figure


def reach(answer: xr.Dataset) -> xr.DataArray:
    """The tip's sag over that of a clamped-free Timoshenko beam, eq. (3.5.3)."""
    problem = case_of_study(answer).problem_as(RodStatics)
    material, gravity = problem.rod.material, problem.gravity
    assert material is not None
    assert gravity is not None

    def exact(length: float, poisson: float) -> float:
        rod = problem.rod.replace(length=length, material=material.replace(poisson=poisson))
        beam = beam_of(problem.replace(rod=rod))
        return float(beams.clamped_free_displacement(beam, gravity.g, np.array([length]))[0])

    sag = xr.apply_ufunc(np.vectorize(exact), answer["length"], answer["poisson"])
    ratio: xr.DataArray = answer["sag"] / sag
    return ratio


def fig_column_strength(data: Data) -> Figure:
    """The strength over the bow beside the formula, and its distribution."""
    answer = data["column_strength"]
    figure, (left, right) = canvas(WIDTH, 5.4, 2, 1)
    strength, exact = strengths(answer)
    left.plot(answer["amplitude"] * 1e3, strength, ".", color=COMPUTED, label="computed")
    left.plot(
        answer["amplitude"] * 1e3, exact, "x", color=INK, markersize=4, label="Perry and Robertson"
    )
    left.set(xlabel="bow [mm]", ylabel="strength [N]", title="(a) every column")
    left.legend()
    right.hist(strength, 16, color=COMPUTED, edgecolor="white")
    low, middle, high = np.quantile(strength, (0.05, 0.5, 0.95))
    for value, style in ((low, ":"), (middle, "-"), (high, ":")):
        right.axvline(value, color=VARIANT, linestyle=style)
    right.set(xlabel="strength [N]", ylabel="number of columns [1]", title="(b) 5 %, median, 95 %")
    return figure


def strengths(answer: xr.Dataset) -> tuple[Array, Array]:
    """The strength of every column, computed and by Perry and Robertson's formula [N]."""
    problem = case_of_study(answer).problem_as(RodPath)
    full, width, length = problem.forces[0].force, problem.rod.width, problem.rod.length
    level = read_out("strength", answer["strength"].attrs["read_out"], "column_strength").level
    young, height, bow = (answer[name].to_numpy() for name in ("young", "height", "amplitude"))
    euler = np.pi**2 * young * height**2 / (12 * length**2)
    middle = (level + (1 + 6 * bow / height) * euler) / 2
    exact = (middle - np.sqrt(middle**2 - level * euler)) * width * height
    return answer["strength"].to_numpy() * full, exact
