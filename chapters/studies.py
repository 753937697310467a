# ---
# jupyter:
#   jupytext:
#     formats: py:percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Studies: many cases, one answer
#
# One case answers one question. A study asks it for many values: it takes a case, varies some of its keys, and keeps some
# numbers of every member. Its answer is one labelled Dataset. Each varied key is a dimension or a coordinate with its unit.
# A member that has no solution keeps the reason.
#
# Each member is an ordinary case, solved from its own reference. So the answer depends neither on the order of the members
# nor on how many processes solve them. `cosserat run STUDY --member 17` solves one of them alone, to the same bits.
#
# The three studies of this page were solved when the book was built. The same lines with larger numbers run on a cluster:
# `cosserat study STUDY --profile profiles/slurm`.

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.problems.path import RodPath
from cosserat.studies.door import case_of_study
from cosserat.thesis.book import page
from cosserat.thesis.figures.studies import reach, strengths

stride = page.study("worm_stride")
beams = page.study("calibration_reach")
columns = page.study("column_strength")

# %% [markdown]
# ## Which inputs decide the stride of the earthworm?
#
# Section 2.8 takes the worm's length, radius and stiffness from measurements and fits both muscle loads. The thesis states no
# uncertainties. We assume ten per cent of standard deviation for each, and ask which of them the stride depends on.
#
# Sobol's first index of an input is the share of the variance of the stride that this input explains alone. Its total index
# adds what it explains together with others. The design of Saltelli takes pairs of random worms and exchanges one input at
# a time, so that both indices follow from the same members.

# %% tags=["remove-input"]
page.written("worm_stride")

# %%
indices = cosserat.indices(stride, of="stride")

# %% tags=["remove-input"]
page.table(
    [
        [
            str(key),
            f"{float(one['first']):.2f} ({float(one['first_low']):.2f} to {float(one['first_high']):.2f})",
            f"{float(one['total']):.2f} ({float(one['total_low']):.2f} to {float(one['total_high']):.2f})",
        ]
        for key in indices["key"].to_numpy()
        for one in [indices.sel(key=key)]
    ],
    ("input", "first index (95 %)", "total index (95 %)"),
)

# %% tags=["remove-input"]
page.figure(
    "fig_worm_stride",
    "(a) Sobol's indices of the stride with their 95 % intervals; (b), (c) the stride over the two inputs with the largest "
    "total index.",
)

# %% [markdown]
# The pressure of the circular muscles, the length and the radius decide the stride; the longitudinal muscles hardly matter.
# The reason is in the gait: the worm moves forward by what its advancing segments elongate, and the pressure elongates
# them. The indices add up to about one, so the inputs act almost independently.

# %% tags=["remove-cell"]
strongest = set(indices["key"].to_numpy()[np.argsort(-indices["total"].to_numpy())[:3]])
assert strongest == {"advancing", "length", "radius"}, strongest
assert 0.8 < float(indices["first"].sum()) < 1.2

# %% [markdown]
# ## How far does the published calibration reach?
#
# The seven coefficients of the published rod are fitted at 20 vertices, for one beam: ten times as long as it is high. Here is
# the sag of other beams, over that of Timoshenko's beam, with the coefficients as published.

# %% tags=["remove-input"]
page.written("calibration_reach")

# %% tags=["remove-input"]
page.figure(
    "fig_calibration_reach",
    "Sag of the tip of a clamped-free beam over that of Timoshenko's beam: (a) for numbers of vertices, (b) for Poisson's "
    "ratios. The line is the exact answer.",
)

# %%
ratio = reach(beams)

# %% tags=["remove-input"]
page.table(
    [
        [
            int(count),
            *(
                f"{float(ratio.sel(vertices=count, length=length, poisson=0.2)):.3f}"
                for length in (1, 5, 20)
            ),
        ]
        for count in ratio["vertices"].to_numpy()
    ],
    ("vertices", "2 heights long", "10 heights long", "40 heights long"),
)

# %% [markdown]
# The calibration holds for the beam that it was made for, to within one per cent, and Poisson's ratio matters little. A beam
# of 40 heights sags eight per cent too little at 20 vertices, and a short one of two heights 28 per cent too much. The
# coefficients stand for the mesh and the shape of one beam. The consistent rod of this package has no coefficients and
# needs none.

# %% tags=["remove-cell"]
calibrated = ratio.sel(vertices=20, length=5)
assert abs(calibrated - 1).max() < 0.03
assert abs(float(calibrated.sel(poisson=0.2)) - 1) < 0.01
assert 0.9 < float(ratio.sel(vertices=20, length=20, poisson=0.2)) < 0.93
assert 1.27 < float(ratio.sel(vertices=20, length=1, poisson=0.2)) < 1.29

# %% [markdown]
# ## The strength of imperfect columns
#
# A perfect column buckles at Euler's load. A real one is bent before, and its stress grows with the load from the start. Its
# strength is the load at which the largest stress reaches that of the material. Bow, stiffness and height scatter from column to
# column; so does the strength.

# %% tags=["remove-input"]
page.written("column_strength")

# %% tags=["remove-input"]
page.figure(
    "fig_column_strength",
    "(a) Strength over the bow, and the formula of Perry and Robertson with each column's own values; (b) the distribution.",
)

# %%
computed, formula = strengths(columns)
low, median, high = np.quantile(computed, (0.05, 0.5, 0.95))

# %% tags=["remove-input"]
page.table(
    [[f"{low:.2f}", f"{median:.2f}", f"{high:.2f}", f"{np.abs(computed / formula - 1).max():.1e}"]],
    ("5 % of columns below [N]", "median [N]", "95 % below [N]", "largest difference from the formula"),
)

# %% [markdown]
# Every column agrees with the formula to half a per cent. The formula is that of the linear theory at the middle of the column;
# the rod has its stress at the middle of an edge beside it. Half of the columns fail below 78 per cent of the load of
# Euler. One column in twenty fails below two thirds of it.

# %% tags=["remove-cell"]
rod = case_of_study(columns).problem_as(RodPath).rod
euler = np.pi**2 * rod.young * rod.second_moment / rod.length**2
assert np.abs(computed / formula - 1).max() < 5e-3
assert abs(100 * median / euler - 78) < 1
assert abs(low / euler - 2 / 3) < 0.02

# %% [markdown]
# ## A study of your own
#
# In a case file a study is a table beside its case. Each table `vary` is a factor, and factors multiply:
#
# ```toml
# [cantilevers]
# kind = "study"
# of = "elastica"
# keep.tip = "u.E2 at last"
#
# [[cantilevers.vary]]
# rod.section.height = ["7 mm", "8 mm", "9 mm"]
#
# [[cantilevers.vary]]
# sobol = 64
# forces.0.force = { uniform = ["0.5 N", "4.7 N"] }
# ```
#
# From Python the same is one call, and the answer is an xarray Dataset:

# %%
answer = cosserat.study(
    "elastica",
    vary={"rod.section.height": ["7 mm", "8 mm", "9 mm"], "forces.0.force": ["1 N", "2 N", "4 N"]},
    keep={"tip": "u.E2 at last"},
)
answer["tip"].to_pandas()
