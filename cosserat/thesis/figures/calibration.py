"""The fitted coefficients, and the error at the published ones, over the number of vertices."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from cosserat.exact import beams
from cosserat.figures.style import COMPUTED, EXACT, FOURTH, INK, VARIANT, WIDTH, canvas
from cosserat.problems.calibration import Calibration, beam_of
from cosserat.studies.door import case_of_study


def limit(data: xr.Dataset) -> float:
    """Limit of the clamped-free tip over Timoshenko's at the published coefficients."""
    problem = case_of_study(data).problem_as(Calibration).clamped_free
    assert problem.gravity is not None
    beam, c = beam_of(problem), problem.rod.calibration
    assert c is not None
    tip = beams.clamped_free_tip_of_published_rod(beam, problem.gravity.g, c.c3, c.c4, c.c5)
    exact = beams.clamped_free_displacement(beam, problem.gravity.g, np.array([beam.length]))
    return tip / float(exact[0])


def fig_calibration(data: Mapping[str, xr.Dataset]) -> Figure:
    """Above, answers at the published coefficients; below, coefficients that fit."""
    figure, (top, bottom) = canvas(WIDTH, 6.0, 2, 1)
    run = data["calibration"]
    n = run.vertices
    curves = [
        ("hanging_bar", "hanging bar", INK, "^"),
        ("clamped_free", "clamped-free", COMPUTED, "o"),
        ("clamped_clamped", "clamped-clamped", VARIANT, "s"),
        ("necking", "necking", FOURTH, "D"),
    ]
    for name, label, colour, marker in curves:
        top.semilogx(n, run[f"{name}_published"], color=colour, marker=marker, label=label)
    top.axhline(limit(run), color=EXACT, linestyle="--", label="limit, clamped-free")
    top.set(
        xlabel="vertices $N$ [1]",
        ylabel="computed / analytic [1]",
        title="(a) at the published coefficients",
    )
    beam, section = run.clamped_free_coefficients, run.necking_coefficients
    product = np.sqrt(beam.sel(beam_coefficient="c4") * beam.sel(beam_coefficient="c5"))
    for values, label, colour, marker in (
        (beam.sel(beam_coefficient="c3"), "$c_3$", COMPUTED, "o"),
        (product, r"$\sqrt{c_4 c_5}$", VARIANT, "s"),
        (section.sel(section_coefficient="c6"), "$c_6$", FOURTH, "D"),
        (section.sel(section_coefficient="c7"), "$c_7$", INK, "^"),
    ):
        bottom.loglog(n, values, color=colour, marker=marker, label=label)
    bottom.set(
        xlabel="vertices $N$ [1]", ylabel="fitted coefficient [1]", title="(b) coefficients that fit"
    )
    bottom.set_yticks([0.3, 0.5, 1, 2, 5], ["0.3", "0.5", "1", "2", "5"])
    for ax in (top, bottom):
        ax.set_xticks(n.to_numpy(), [f"{value:.0f}" for value in n.to_numpy()])
        ax.minorticks_off()
    top.legend(loc="lower right")
    top.set_ylim(bottom=0.84)
    bottom.legend(loc="upper left", ncols=2)
    bottom.set_ylim(0.27, 12)
    return figure
