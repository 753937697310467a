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
# One case answers one question: how far does this beam sag, how far does this worm crawl? A study asks the same question for many
# values. It takes a case, varies some of its keys, and keeps some numbers of every solution. Each case of a study is a
# *member*, and each number that is kept is a *read-out*.
#
# The answer of a study is one labelled table, an xarray Dataset. Each varied key is a dimension or a coordinate with its unit. A
# member without a solution keeps the reason. Each member is solved from its own state at rest, so the answer depends
# neither on the order of the members nor on the number of processes.
#
# :::{admonition} After this chapter you can
# :class: objectives
# * say which of several uncertain inputs decides a result, and by how much;
# * find the range in which a calibrated model can be trusted;
# * turn a scatter of inputs into a distribution of strengths;
# * write a study of your own, in a case file or in Python.
# :::
#
# The three studies below were solved when the book was built. The same lines with larger numbers run on a cluster, by
# `cosserat study STUDY --profile profiles/slurm`. One member alone, to the same bits, is `cosserat run STUDY --member 17`.
# Other pages read studies too: the [calibration](ch3_calibration.ipynb) at five numbers of vertices, the errors of the
# [consistent rod](ch4_consistent.ipynb), and [worms of every size](ch2_crawlers.ipynb).

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.thesis.book import page

stride = page.study("worm_stride")
beams = page.study("calibration_reach")
columns = page.study("column_strength")

# %% [markdown]
# ## Which inputs decide the stride of the earthworm?
#
# The thesis takes the length and the radius of the worm from measurements, and fits its modulus and both muscle loads. It states no
# uncertainty of any. We assume a standard deviation of a tenth for each of the five, and ask which of them the stride
# depends on.
#
# Sobol's indices answer this. Let $y$ be the stride and $x_k$ an input. The *first index* is the share of the variance
# of $y$ that would vanish if $x_k$ were known. The *total index* is the share that would be left if all inputs but $x_k$ were known.
# With $\mathrm{E}$ for a mean and $\mathrm{Var}$ for a variance,
#
# $$
# S_k = \frac{\mathrm{Var}(\mathrm{E}[y \mid x_k])}{\mathrm{Var}(y)} , \qquad
# T_k = 1 - \frac{\mathrm{Var}(\mathrm{E}[y \mid \text{all but } x_k])}{\mathrm{Var}(y)} .
# $$
#
# If the inputs act one by one, both are the same and add up to one. The design of Saltelli finds both from the same members: it
# draws pairs of random worms and exchanges one input at a time between them.

# %% tags=["remove-input"]
page.written("worm_stride")

# %%
indices = cosserat.indices(stride, of="stride")

# %% tags=["remove-input"]
page.figure(
    "fig_worm_stride",
    "(a) Sobol's indices of the stride with their 95 % intervals; (b), (c) the stride over the two inputs with the largest "
    "total index. Look at (b) and (c): a cloud with a clear slope is an input that matters.",
)

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

# %% [markdown]
# The pressure of the circular muscles, the radius and the length decide the stride. The longitudinal muscles hardly matter. Chapter 2
# says why. The stride is half the length of the worm times the difference of the two plateaus, and the plateaus depend on
# $p/E$ and $\bar{D}/(E R^2)$ alone, if the weight is small. Advancing regions carry the force $\bar{D}$ too. So stronger longitudinal
# muscles shorten both plateaus, the long one more, and the stride becomes a little shorter. The radius acts against this force with
# its second power: twice the effect, so four times the variance. The modulus weakens both loads, and the two effects partly cancel.
# The folded cell checks both statements. The first indices add up to about one, so the inputs act nearly one by one.

# %% tags=["hide-cell"]
strongest = set(indices["key"].to_numpy()[np.argsort(-indices["total"].to_numpy())[:3]])
assert strongest == {"advancing", "length", "radius"}, strongest
first = {str(key): float(indices["first"].sel(key=key)) for key in indices["key"].to_numpy()}
assert 0.8 < sum(first.values()) < 1.2
assert abs(first["radius"] - 4 * first["anchoring"]) < 0.1
assert abs(first["young"] - (first["advancing"] ** 0.5 - first["anchoring"] ** 0.5) ** 2) < 0.05

# %% [markdown]
# Derivatives say nearly the same without a random worm. To first order an input $x_k$ with the standard deviation $s_k$
# adds $(s_k \, \partial y / \partial x_k)^2$ to the variance of the stride. All inputs scatter by the same tenth, so the shares
# are those of the squares of $x_k \, \partial y / \partial x_k$. `cosserat.sensitivity` takes these derivatives from one crawl: every
# instant solves its equations for any value of an input, and the matrix of Newton's method tells how the stretches follow.

# %%
worm = cosserat.case("worm").vary("one_stride", strides=1, step="1 s")
inputs = [
    "crawler.length",
    "crawler.radius",
    "crawler.material.young",
    "loads.anchoring",
    "loads.advancing",
]
slopes = cosserat.sensitivity(worm, inputs, {"stride": "change along at last"})
shares = slopes.stride_scaled**2 / (slopes.stride_scaled**2).sum()

# %% tags=["remove-input"]
page.table(
    [
        [key, f"{1e3 * float(slope):.1f} mm", f"{float(share):.2f}"]
        for key, slope, share in zip(inputs, slopes.stride_scaled, shares, strict=True)
    ],
    ("input", "derivative of the stride times the input", "share of the variance"),
)

# %% [markdown]
# The shares lie inside the intervals of the indices. The derivatives come from one crawl, the indices from several hundred. But
# derivatives hold for small scatter alone, while indices hold for any.

# %% tags=["hide-cell"]
for key, share in zip(inputs, shares, strict=True):
    own = indices.sel(key=key.rpartition(".")[2])
    assert float(own["first_low"]) < float(share) < float(own["first_high"])

# %% [markdown]
# ## How far does the published calibration reach?
#
# The rod of the thesis has seven coefficients. They were fitted at 20 vertices and for one beam, which is ten times as long as it is
# high. What do they give for other beams? The study computes the sag of the tip under the weight. It is divided by the exact sag
# of Timoshenko's beam, which is (3.5.3) at the tip:
#
# $$
# u = \frac{\rho_0 g \ell^4}{8 EI} + \frac{(1 + \nu) \rho_0 g \ell^2}{k EA} .
# $$
#
# The first part is bending, the second is shear. $\ell$ is the length of the beam, $EA$ and $EI$ are its stiffnesses, and $k$ is the
# shear factor of the section.

# %% tags=["remove-input"]
page.written("calibration_reach")

# %%
rod = cosserat.case("clamped_free").problem.rod
load = rod.line_density * 0.1  # N/m, of the light beam of the study
bending = load * beams.length**4 / (8 * rod.young * rod.second_moment)
shear = (1 + beams.poisson) * load * beams.length**2 / (rod.shear_correction * rod.young * rod.area)
ratio = -beams.sag / (bending + shear)

# %% tags=["remove-input"]
page.figure(
    "fig_calibration_reach",
    "Sag of the tip of a clamped-free beam over that of Timoshenko's beam: (a) for numbers of vertices, (b) for Poisson's "
    "ratios. The line at one is the exact answer. Look at (a): the curves cross it at different lengths.",
)

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

# %% tags=["remove-input"]
calibrated = ratio.sel(vertices=20, poisson=0.2)
short, own, long = (float(calibrated.sel(length=length)) for length in (1, 5, 20))
fine = float(ratio.sel(vertices=80, poisson=0.2, length=5))
page.text(
    "The calibration holds to within one per cent for the beam that it was made for, and Poisson's ratio matters little. At 20 "
    f"vertices a beam of 40 heights sags {100 * (1 - long):.0f} % too little, and a short one of two heights "
    f"{100 * (short - 1):.0f} % too much. More vertices do not help: with 80 of them even the beam of "
    f"the calibration sags {100 * (fine - 1):.0f} % too much. So the coefficients stand for one mesh and one shape. The "
    "consistent rod of Chapter 4 has no coefficients and needs none."
)

# %% tags=["remove-cell"]
assert abs(ratio.sel(vertices=20, length=5) - 1).max() < 0.03
assert abs(own - 1) < 0.01
assert 0.9 < long < 0.93
assert 1.27 < short < 1.29

# %% [markdown]
# ## The strength of imperfect columns
#
# A perfect column stays straight up to Euler's load. A real column has a bow before it is loaded. Its bow grows with the load, and
# the largest stress grows faster than the load. Its *strength* is the load at which this stress reaches the strength $\sigma_m$ of
# the material. Bow, modulus and height scatter from column to column, so the strength scatters too.
#
# Perry and Robertson's formula gives the strength by the linear theory. A bow $a$ grows to $a/(1 - \sigma/\sigma_E)$ under the
# mean stress $\sigma$, where $\sigma_E = \pi^2 E h^2/(12 \ell^2)$ is the stress at Euler's load and $h$ the height of the
# section. With the stress of bending it reaches $\sigma_m$ when
#
# $$
# \sigma_m = \sigma \left( 1 + \frac{6a}{h} \, \frac{1}{1 - \sigma/\sigma_E} \right) .
# $$
#
# This is a quadratic equation for $\sigma$, and its smaller root is the formula.

# %% tags=["remove-input"]
page.written("column_strength")

# %%
column = cosserat.case("column_path").problem.rod
width, length = column.width, column.length  # m; the study varies height, modulus and bow
full, level = 5.55, 0.2e6  # N, Pa: the force and the stress in the study
euler = np.pi**2 * columns.young * columns.height**2 / (12 * length**2)
middle = (level + (1 + 6 * columns.amplitude / columns.height) * euler) / 2
formula = (middle - np.sqrt(middle**2 - level * euler)) * width * columns.height
computed = columns.strength * full
low, median, high = np.quantile(computed, (0.05, 0.5, 0.95))

# %% tags=["remove-input"]
page.figure(
    "fig_column_strength",
    "(a) Strength over the bow, and the formula of Perry and Robertson with each column's own values; (b) the distribution. "
    "Look at (a): a bow of a fifth of the height costs about a third of the strength.",
)

# %% tags=["remove-input"]
page.table(
    [
        [
            f"{low:.2f} N",
            f"{median:.2f} N",
            f"{high:.2f} N",
            f"{100 * float(np.abs(computed / formula - 1).max()):.1f} %",
        ]
    ],
    (
        "5 % of columns are below",
        "half are below",
        "95 % are below",
        "largest difference from the formula",
    ),
)

# %% tags=["remove-input"]
perfect = np.pi**2 * column.young * column.second_moment / length**2
page.text(
    "Every column agrees with the formula to half a per cent. The rest is a difference of place: the formula takes the stress at "
    "the middle of the column, the rod has it at the middle of an edge beside it. Half of the columns fail below "
    f"{100 * median / perfect:.0f} % of Euler's load, and one in twenty below {100 * low / perfect:.0f} %."
)

# %% tags=["remove-cell"]
assert np.abs(computed / formula - 1).max() < 5e-3
assert abs(100 * median / perfect - 78) < 1
assert abs(low / perfect - 2 / 3) < 0.02

# %% [markdown]
# ## A study of your own
#
# In a case file a study is a table beside its case. Each table `vary` is a factor. Factors multiply: here every height
# meets every force.
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
    vary={
        "rod.section.height": ["7 mm", "8 mm", "9 mm"],
        "forces.0.force": ["1 N", "2 N", "4 N"],
    },
    keep={"tip": "u.E2 at last"},
)
answer["tip"].to_pandas()

# %% [markdown]
# ## Exercises
#
# :::{admonition} Exercise S.1: where the linear theory ends
# :class: exercise
# The linear theory gives the deflection $F \ell^3/(3EI)$ at the tip of a clamped rod under a force $F$. At which deflection, as a
# part of the length, does it err by one per cent? Vary the force of the case `elastica`.
# :::

# %% tags=["hide-cell"]
forces = [0.05 * k for k in range(1, 11)]  # N
bent = cosserat.study("elastica", {"forces.0.force": forces}, keep={"tip": "u.E2 at last"})
arm = cosserat.case("elastica").problem.rod
linear = bent.force * arm.length**3 / (3 * arm.young * arm.second_moment)
error = (linear / bent.tip - 1).to_numpy()
assert (np.diff(error) > 0).all()
found = float(np.interp(0.01, error, bent.tip)) / arm.length
assert 0.05 < found < 0.15
print(f"At a deflection of {100 * found:.0f} % of the length.")

# %% [markdown]
# :::{admonition} Exercise S.2: an index by hand
# :class: exercise
# A light load bends the same rod a little. The force has a standard deviation of 10 %, the modulus one of 5 %. Find both first
# indices of the deflection by hand, and compare with a design of Saltelli.
# :::

# %% tags=["hide-cell"]
# The deflection is proportional to the force and to one over the modulus, so relative variances add up.
by_hand = np.array([0.1**2, 0.05**2]) / (0.1**2 + 0.05**2)
scattered = cosserat.study(
    "elastica",
    [
        {
            "saltelli": 64,
            "seed": 1,
            "forces.0.force": {"normal": ["1 mN", "0.1 mN"]},
            "rod.material.young": {"normal": ["1 GPa", "0.05 GPa"]},
        }
    ],
    keep={"tip": "u.E2 at last"},
)
estimated = cosserat.indices(scattered, of="tip")
assert (estimated.first_low < by_hand).all()
assert (by_hand < estimated.first_high).all()
print("by hand:", by_hand, " estimated:", estimated["first"].to_numpy().round(2))

# %% [markdown]
# :::{admonition} Exercise S.3: the order of convergence
# :class: exercise
# Solve `elastica` on five meshes, each twice as fine as the one before. With which power of the edge length does the error of the
# tip fall? How many vertices keep it below a thousandth of the deflection?
# :::

# %% tags=["hide-cell"]
meshes = cosserat.study("elastica", {"rod.vertices": [6, 11, 21, 41, 81]}, keep={"tip": "u.E2 at last"})
order = cosserat.orders(meshes)
assert abs(float(order.tip_order) - 2) < 0.05
left = np.abs(meshes.tip / order.tip_limit - 1)
enough = int(meshes.vertices[left < 1e-3][0])
print(f"The order is {float(order.tip_order):.2f}; {enough} vertices are enough.")
