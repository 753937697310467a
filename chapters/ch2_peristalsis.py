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
# A worm has two kinds of muscle. Longitudinal muscles shorten and thicken the body; the thick parts are anchored to the
# ground. Circular muscles make the body thin. Its volume is constant, so the thin parts lengthen and push the body forward.
# The model of the worm is one directed rod, and the muscles are loads on it: *anchoring* and *advancing* loads in the words
# of the thesis.
#
# ## Muscles as loads
#
# A muscle along the centreline pulls two neighbouring points together. Over a window of width $\lambda$ it is a forward and a
# backward force; the limit is a doublet. In a row of muscles that fills a window the contact force is constant,
#
# $$
# \mathbf{n}(\xi) = -\bar{D} \mathbf{e}_3 \quad \text{for } \xi_1 < \xi < \xi_2 . \tag{2.2.7}
# $$

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.data.dataset import case_of, statistics_of
from cosserat.peristalsis import crawler, doublets, equations, nearly_incompressible, profile
from cosserat.solvers import regions
from cosserat.thesis.book import page

# %% tags=["remove-input"]
page.figure(
    "fig_worm_parts",
    "The worm of this chapter at two times of a stride. Fronts travel from the front end to the rear end. Behind a front "
    "$\\gamma$ the body anchors, ahead of it the body advances; at a front $\\eta$ it is the other way round.",
)

# %% tags=["remove-input"]
page.figure(
    "fig_2_5",
    "(a) One muscle: load and contact force. (b) Muscles half a window apart: the force is constant between the first and "
    "the last and falls to zero over half a window outside. The window becomes smaller as their number grows.",
)

# %% tags=["remove-input"]
page.source(doublets.contact_force)

# %% [markdown]
# At each end of the window the row exerts its whole force $\bar D$, so $\mathbf{n}$ jumps there. Circular muscles are a
# pressure $p$ on the lateral surface of the reference. It loads both directors equally:
#
# $$
# \rho_0 \mathbf{l}_A^1 = -p \pi R^2 \mathbf{e}_1 . \tag{2.2.9}
# $$
#
# The ground supports the weight. The sections stand on the ground, and its reaction flattens them. The page writes
#
# $$
# \lambda^E = \rho g = \frac{\rho_0 g}{\mu_3} , \tag{2.2.20}
# $$
#
# which is the weight per current length, used as a force per reference length (erratum E2.7). This library uses
# $\rho_0 g$. The published numbers are computed with both.
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
# The worm is incompressible: $\mu_1 \mu_2 \mu_3 = 1$. The multiplier $\lambda_c$ of this constraint models the hydrostatic
# skeleton. With $z = \xi/\ell_0$ and the dimensionless groups

# %% tags=["remove-input"]
page.source(crawler.Groups.of)

# %% [markdown]
# the equations of the robot in anchoring regions are
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
# zero. There the printed $\mu_3$ lacks a 2 (erratum E2.1), and the printed robot *shortens* under lateral pressure. The
# corrected form is
#
# $$
# \mu_3 = 1 - \tilde{p}(\mu_1 + \mu_2 - 2) . \tag{2.3.10}
# $$

# %% tags=["remove-input"]
page.excerpt(equations.compressible, "for k in range", "return f")

# %% [markdown]
# The equations of the worm are
#
# \begin{equation*}
# \begin{aligned}
# \frac{d^2\mu_1}{d\tilde{z}^2} &= \tilde{c} + \tilde{m}\mu_1\mu_2 + \frac{\tilde{\lambda}_c}{\mu_1} + \tilde{i}(2\mu_1 + \mu_2 - 3) , \\
# \frac{d^2\mu_2}{d\tilde{z}^2} &= \tilde{c} + \frac{\tilde{\lambda}_c}{\mu_2} + \tilde{i}(2\mu_2 + \mu_1 - 3) , \\
# \frac{d\tilde{\lambda}_c}{d\tilde{z}} &= -\tilde{\lambda}_c \left( \frac{\mu_1'}{\mu_1} + \frac{\mu_2'}{\mu_2} \right) .
# \end{aligned} \tag{2.4.13}
# \end{equation*}
#
# The last equation has a first integral: the contact force $\tilde\lambda_c \mu_1 \mu_2$ is constant. In (2.4.18), on the
# common domain of the regions, the page has one factor of the region's length too many. With it the integral is not
# constant, and the answer depends on the length of the region (erratum E2.5). The published numbers contain this error.

# %% tags=["remove-input"]
page.excerpt(equations.incompressible, "for k in range", "return f")

# %% [markdown]
# ## Regions
#
# At a junction of two regions the stretches and their gradients are continuous. At the ends the gradients vanish,
#
# $$
# \frac{d\mu_\alpha}{d\tilde{z}}(\tilde{z} = 0) = 0, \quad \frac{d\mu_\alpha}{d\tilde{z}}(\tilde{z} = 1) = 0 . \tag{2.3.13}
# $$
#
# The condition on the contact force at a junction is not the same in both: in the robot it jumps to zero, in the worm it is
# continuous. Each is computed as in its section of the thesis, and with the condition of the other as a variant (question
# E2.10). Any sequence of regions is possible. An advancing region at an end has one junction, whose conditions close the
# system (assumption E2.12).
#
# The states are plateaus joined by layers. Because $k_G / k_I$ in the worm and $k_G / (k_S - k_P)$ in the robot are
# $R^2/8$, the layers are at most $R/\sqrt{8}$ long. In the loaded worm some are less than half as long. The layers are
# thinner than the body. This is a limit of the theory, which assumes that sections change slowly (question E2.25).

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
# The library has this solver as its reference (`solver = "collocation"`, SciPy's `solve_bvp`). A stride consists of a
# hundred such problems. A banded Newton method solves them on spectral elements that are fine in the layers. It starts from
# the state of the previous instant. Its weak form contains the conditions on the gradients as natural boundary conditions.
# The quadrature points are the nodes, so each node has its own constitutive equations.

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
lines.append(("smallest true volume in the worm's layers / reference volume", f"{least:.2f}"))
page.table(lines, ("", "measured"))

# %% [markdown]
# The constraint on the product of the stretches does not conserve the true volume where sections tilt relative to the
# centreline (erratum E2.11). The last row is the smallest ratio of true to reference volume. Outside the layers the volume is
# conserved, and the whole worm loses less than two parts in a thousand.
#
# `cosserat speed` times a stride with both solvers on your machine. Both raise an error if they do not converge. Loads that
# collapse a section are an error before the solution starts:

# %%
try:
    cosserat.run(body.vary("crushed", loads={"advancing": "30 kPa", "advancing_force": "none"}))
except cosserat.InputError as error:
    print(error)

# %% tags=["remove-input"]
page.source(profile.check_tilt)

# %% [markdown]
# ## Is the one material the limit of the other?
#
# As $\nu$ tends to $1/2$, the robot's material satisfies $\mu_1 + \mu_2 + \mu_3 = 3$. This equals $\mu_1 \mu_2 \mu_3 = 1$ for
# small strains only. So there are two questions: how fast the difference of the two rods vanishes under small loads, and how
# large it is under finite loads. The body is that of the worm, both rods have the junctions of section 2.4 (the contact
# force is continuous), and loads and weight are a fraction of the worm's.

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
    f"fraction of the loads, with a measured order of {by_gap:.2f} in $1 - 2\\nu$. With $\\nu$ at the limit they still differ. "
    f"The difference grows as the power {by_load:.2f} of the load, because the sum of the stretches and their product differ by "
    f"products of two strains. Under a twentieth of the worm's loads a stretch differs by {100 * limit[-1]:.2f} %, under "
    f"the full loads by {100 * difference(0.5 - 1e-7, 1.0):.0f} %. So a nearly incompressible robot does not replace the worm."
)

# %% [markdown]
# ## The shape on the ground
#
# The sections stand on the ground, so the height of the centreline follows from the lateral stretch. The distance of two
# sections along the ground is the projection of the arc between them:
#
# $$
# x(\xi) = R(\mu_1(\xi) - 1) , \tag{2.5.7}
# $$
#
# $$
# z(\xi) - z(\xi_A) = \int_{\xi_A}^{\xi} \sqrt{\mu_3^2 - R^2 \mu_1'^2} \, d\bar{\xi} . \tag{2.5.8}
# $$
#
# The page assumes $\mu_3 \gg R \mu_1'$. In the layers this is not the case, as the table above shows (erratum E2.19). These
# equations determine the shape at one instant. The next chapter computes the motion.

# %% tags=["remove-cell"]
assert case_of(banded).problem.loads.contact == "weight"
