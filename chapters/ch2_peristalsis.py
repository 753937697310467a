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
# # Chapter 2: a rod with muscles
#
# A worm has two kinds of muscle. Those along its body shorten and thicken it; the thick parts are anchored to the ground.
# Those round its body thin it, and because its volume is constant it lengthens there and is pushed forward. Here the worm
# is one directed rod, its muscles are loads on it, and the thesis calls them *anchoring* and *advancing* loads.
#
# ## Muscles as loads
#
# A muscle along the centreline pulls two neighbouring places together. Spread over a window of width $\lambda$ that is a
# force forward and one backward; its limit is a doublet. A row of them that fills a window keeps the contact force at
#
# $$
# \mathbf{n}(\xi) = -\bar{D} \mathbf{e}_3 \quad \text{for } \xi_1 < \xi < \xi_2 . \tag{2.2.7}
# $$

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.data.dataset import case_of, statistics_of
from cosserat.peristalsis import crawler, doublets, instant, nearly_incompressible
from cosserat.solvers import regions
from cosserat.thesis.book import page

# %% tags=["remove-input"]
page.figure(
    "fig_2_5",
    "(a) One muscle: load and contact force. (b) Muscles half a window apart: between the first and the last the force is "
    "constant, and outside it falls to zero over half a window, which shrinks as their number grows.",
)

# %% tags=["remove-input"]
page.source(doublets.contact_force)

# %% [markdown]
# At each end of the window the row pushes with its whole force $\bar D$, so that $\mathbf{n}$ jumps there. Muscles round
# the body are a pressure $p$ on the lateral surface of the reference, which loads both directors alike:
#
# $$
# \rho_0 \mathbf{l}_A^1 = -p \pi R^2 \mathbf{e}_1 . \tag{2.2.9}
# $$
#
# The ground carries the weight, and because the sections stand on it, it flattens them. The page writes
#
# $$
# \lambda^E = \rho g = \frac{\rho_0 g}{\mu_3} , \tag{2.2.20}
# $$
#
# which is the weight over the current length, taken as a force over the reference length (erratum E2.7). We take
# $\rho_0 g$; the published numbers are computed with both.
#
# ## Two materials
#
# The energy of the soft robot is quadratic in the stretches and their gradients,
#
# \begin{equation*}
# \begin{aligned}
# 2w = {}& k_S [(\mu_1 - 1)^2 + (\mu_2 - 1)^2 + (\mu_3 - 1)^2] + k_G [(\mu'_1)^2 + (\mu'_2)^2] \\
# & + 2k_P [(\mu_1 - 1)(\mu_2 - 1) + (\mu_1 - 1)(\mu_3 - 1) + (\mu_2 - 1)(\mu_3 - 1)] ,
# \end{aligned} \tag{2.3.1}
# \end{equation*}
#
# and its stiffnesses are those of Chapter 1:
#
# $$
# k_S = \frac{E \pi R^2 (1 - \nu)}{(1 + \nu)(1 - 2\nu)} , \quad k_G = \frac{E \pi R^4}{8(1 + \nu)} , \quad
# k_P = \frac{\nu}{1 - \nu} k_S . \tag{2.6.20}
# $$
#
# The worm keeps the product of its stretches, $\mu_1 \mu_2 \mu_3 = 1$, with a multiplier $\lambda_c$ that is its
# hydrostatic skeleton. With $z = \xi/\ell_0$ and the dimensionless groups

# %% tags=["remove-input"]
page.source(crawler.Groups.of)

# %% [markdown]
# the robot obeys, in anchoring regions,
#
# \begin{equation*}
# \begin{aligned}
# \frac{d^2 \mu_1}{d\tilde{z}^2} &= \frac{\tilde{m}}{\bar{\mu}_3} + \tilde{g}\mu_1 + \tilde{p}\tilde{g}(\mu_2 + \bar{\mu}_3) -
# \tilde{g} - 2\tilde{p}\tilde{g} , \\
# \frac{d^2 \mu_2}{d\tilde{z}^2} &= \tilde{g}\mu_2 + \tilde{p}\tilde{g}(\mu_1 + \bar{\mu}_3) - \tilde{g} - 2\tilde{p}\tilde{g}
# \end{aligned} \tag{2.3.6}
# \end{equation*}
#
# with $\bar\mu_3$ from $\mathbf{n} = -\bar D \mathbf{e}_3$. In advancing regions the pressure is added, and $\mathbf{n}$ is
# zero; the page's $\mu_3$ there misses a 2 (erratum E2.1), with which a robot would *shorten* when it is squeezed:
#
# $$
# \mu_3 = 1 - \tilde{p}(\mu_1 + \mu_2 - 2) . \tag{2.3.10}
# $$

# %% tags=["remove-input"]
page.excerpt(crawler._compressible, "for k in range", "return f")

# %% [markdown]
# The worm obeys
#
# \begin{equation*}
# \begin{aligned}
# \frac{d^2\mu_1}{d\tilde{z}^2} &= \tilde{c} + \tilde{m}\mu_1\mu_2 + \frac{\tilde{\lambda}_c}{\mu_1} + \tilde{i}(2\mu_1 + \mu_2 - 3) , \\
# \frac{d^2\mu_2}{d\tilde{z}^2} &= \tilde{c} + \frac{\tilde{\lambda}_c}{\mu_2} + \tilde{i}(2\mu_2 + \mu_1 - 3) , \\
# \frac{d\tilde{\lambda}_c}{d\tilde{z}} &= -\tilde{\lambda}_c \left( \frac{\mu_1'}{\mu_1} + \frac{\mu_2'}{\mu_2} \right) .
# \end{aligned} \tag{2.4.13}
# \end{equation*}
#
# The last line has an integral: $\tilde\lambda_c \mu_1 \mu_2$, the contact force, is constant. On the common domain of
# (2.4.18) the page has the length of the region once too often, which breaks that integral and makes the answer
# depend on how long the region is (erratum E2.5). The published numbers carry it.

# %% tags=["remove-input"]
page.excerpt(crawler._incompressible, "for k in range", "return f")

# %% [markdown]
# ## Regions
#
# Where two regions meet, stretches and their gradients are continuous; at the ends the gradients vanish,
#
# $$
# \frac{d\mu_\alpha}{d\tilde{z}}(\tilde{z} = 0) = 0, \quad \frac{d\mu_\alpha}{d\tilde{z}}(\tilde{z} = 1) = 0 . \tag{2.3.13}
# $$
#
# The contact force differs there: in the robot it jumps to zero, in the worm it continues unchanged. Each is
# computed as in its section, and the other way round as a variant (question E2.10). Any sequence of regions is
# possible, also with an advancing one at an end, where the one junction it has closes the system (assumption E2.12).
#
# The states are plateaus joined by layers. Because $k_G / k_I$ in the worm and $k_G / (k_S - k_P)$ in the robot are
# $R^2/8$, the layers are $R/\sqrt{8}$ long or shorter, some in the loaded worm less than half of that: thinner than the
# body itself, a limit of the theory, which expects sections to change slowly (question E2.25).

# %%
body = cosserat.case("worm_at_rest").vary(
    "five",
    loads={"anchoring": "26 mN", "advancing": "1.36 kPa"},
    regions=[
        {"begin": 0.0, "end": 0.2, "load": "anchoring"},
        {"begin": 0.2, "end": 0.4, "load": "advancing"},
        {"begin": 0.4, "end": 0.6, "load": "anchoring"},
        {"begin": 0.6, "end": 0.8, "load": "advancing"},
        {"begin": 0.8, "end": 1.0, "load": "anchoring"},
    ],
)
five = cosserat.run(body)
print(
    "mu_3 in the middle of each region:",
    *five.mu_3.sel(section=[25, 75, 125, 175, 225]).round(3).to_numpy(),
)

# %% [markdown]
# ## Two solvers
#
# The thesis writes the equations as a first-order system, maps all regions to one domain and uses a collocation method.
# This solver is here too (`solver = "collocation"`, SciPy's `solve_bvp`), as the reference. Each stride needs a hundred
# such problems; a banded Newton method solves them on spectral elements that are fine in the layers,
# started from the last instant. Its weak form has the conditions on the gradients in it, and its quadrature points are its
# nodes, so that the physics enters node by node.

# %% tags=["remove-input"]
page.source(regions.solve)

# %% tags=["remove-input"]
banded, reference = page.data("worm"), page.data("worm_reference")
count = reference.sizes["time"]
lines = []
for name in ("mu_1", "mu_2", "mu_3"):
    largest = float(np.abs(banded[name][:count] - reference[name]).max())
    assert largest < 1e-6
    lines.append((f"largest difference in {name} over a stride", f"{largest:.0e}"))
robot, other = page.data("soft_robot"), page.data("soft_robot_reference")
at = [int(np.abs(robot.time.to_numpy() - t).argmin()) for t in other.time.to_numpy()]
largest = max(
    float(np.abs(robot[n].to_numpy()[at] - other[n].to_numpy()).max()) for n in ("mu_1", "mu_2", "mu_3")
)
assert largest < 1e-6
lines.append(("largest difference in the robot's stretches", f"{largest:.0e}"))
lines.append(
    (
        "instants, Newton iterations of all three strides",
        f"{statistics_of(banded)['instants']}, {statistics_of(banded)['newton_iterations']}",
    )
)
lines.append(
    ("largest R mu_1'/mu_3 of the worm", f"{statistics_of(banded)['largest_sine_of_tilt']:.2f}")
)
lines.append(
    ("largest R mu_1'/mu_3 of the robot", f"{statistics_of(robot)['largest_sine_of_tilt']:.2f}")
)
least = np.sqrt(1 - statistics_of(banded)["largest_sine_of_tilt"] ** 2)
lines.append(("least true volume in the worm's layers, over the reference", f"{least:.2f}"))
page.table(lines, ("", "measured"))

# %% [markdown]
# The last line is the part of the true volume that the constraint on the product of the stretches keeps where sections tilt
# against the centreline (erratum E2.11). Outside the layers the volume is kept, and the whole worm loses less than two parts
# in a thousand.
#
# `cosserat speed` times a stride by both on your machine. Neither returns an answer that has not converged; loads that
# would collapse a section are an error before anything is solved, with this sentence:

# %%
try:
    cosserat.run(body.vary("crushed", loads={"advancing": "30 kPa", "advancing_force": "none"}))
except cosserat.InputError as error:
    print(error)

# %% tags=["remove-input"]
page.source(instant.check_tilt)

# %% [markdown]
# ## Is the one material the limit of the other?
#
# As $\nu$ tends to $1/2$ the robot's material keeps $\mu_1 + \mu_2 + \mu_3 = 3$, which is $\mu_1 \mu_2 \mu_3 = 1$ for small
# strains only. So there are two questions: how fast the two rods approach each other under small loads, and by how much
# they differ under finite ones. The body is the worm's, both rods join their regions as in section 2.4 (the contact force
# continues), and loads and weight are a fraction of the worm's.

# %% tags=["remove-input"]
page.source(nearly_incompressible.largest_difference)

# %% tags=["remove-input"]
worm = case_of(banded).problem


def difference(poisson, fraction):
    """Largest difference of the lateral stretches."""
    return nearly_incompressible.largest_difference(worm.crawler, worm.loads, poisson, fraction)


gaps, fractions = np.array([1e-2, 1e-3, 1e-4]), np.array([1, 2, 4]) / 80
small = np.array([difference(0.5 - gap, 1e-6) for gap in gaps])
limit = np.array([difference(0.5 - 1e-7, fraction) for fraction in fractions])
by_gap = np.polyfit(np.log(2 * gaps), np.log(small), 1)[0]
by_load = np.polyfit(np.log(fractions), np.log(limit), 1)[0]
assert abs(by_gap - 1) < 0.01
assert abs(by_load - 2) < 0.01
page.text(
    f"Under a millionth of the loads the two rods differ by {small[0] / (2 * gaps[0]) / 1e-6:.2f} $(1 - 2\\nu)$ times that "
    f"fraction of the loads, with a measured order of {by_gap:.2f} in $1 - 2\\nu$. With $\\nu$ at the limit they still differ: "
    f"the difference grows as the power {by_load:.2f} of the load, because the sum of the stretches and their product differ by "
    f"products of two strains. Under a twentieth of the worm's loads a stretch differs by {100 * limit[-1]:.2f} %, under "
    f"all of them by {100 * difference(0.5 - 1e-7, 1.0):.0f} %: a nearly incompressible robot is no worm."
)

# %% [markdown]
# ## From the ground up
#
# The sections stand on the ground, so the centreline rises with them, and the arc between two sections projects on
# the ground as
#
# $$
# x(\xi) = R(\mu_1(\xi) - 1) , \tag{2.5.7}
# $$
#
# $$
# z(\xi) - z(\xi_A) = \int_{\xi_A}^{\xi} \sqrt{\mu_3^2 - R^2 \mu_1'^2} \, d\bar{\xi} . \tag{2.5.8}
# $$
#
# The page expects $\mu_3 \gg R \mu_1'$; in the layers it is not so, as the table above shows (erratum E2.19). At one
# instant this fixes the shape. In the next chapter it moves.

# %% tags=["remove-cell"]
assert case_of(banded).problem.loads.contact == "weight"
