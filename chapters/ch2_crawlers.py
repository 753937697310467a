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
# # Chapter 2: the soft robot and the earthworm crawl
#
# Peristalsis is a sequence of equilibrium states. Two kinds of fronts travel from the front end of the body to the rear.
# The body anchors behind a front $\gamma$ and advances ahead of it. It advances behind a front $\eta$ and anchors ahead of
# it. At each instant one point is fixed to the ground, and the rest of the body moves relative to it:
#
# $$
# {}^i z({}^i \xi_A) = {}^{i-1} z({}^i \xi_A) , \tag{2.5.10}
# $$
#
# $$
# {}^i z(\xi) = {}^{i-1} z({}^i \xi_A) + \int_{{}^i \xi_A}^{\xi} \sqrt{{}^i \mu_3^2 - R^2\, {}^i \mu_1'^2}\, d\bar{\xi} . \tag{2.5.11}
# $$

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.peristalsis import ground
from cosserat.thesis import earthworm
from cosserat.thesis.book import page
from cosserat.thesis.table import crawl_readouts

# %% tags=["remove-input"]
page.source(ground.placed)

# %% [markdown]
# A gait is data: tracks of points (phase, place) for $\gamma$, $\eta$ and the anchor. The case file of the robot has this
# gait:
#
# ```toml
# [soft_robot.gait]
# phases = ["5 s", "7.5 s", "2.5 s", "7.5 s"]
# gamma = [[[1, 1], [2, 0.25], [3, 0]]]
# eta = [[[2, 1], [3, 0.75], [4, 0]]]
# anchor = [[[0, 0], [2, 0]], [[2, 1], [4, 1]]]
# ```
#
# The library refuses a gait with a gap in time, with fronts that cross, with an anchor off the body or on a front, or with
# loads that change suddenly on a part of the body. A front leaves the body when its distance to an end is less than a
# clearance, which is a key of the case. The page says only that fronts must not come "too close".
#
# ## Push and pull
#
# The robot first waits in longitudinal contraction. Then $\gamma$ starts at the front. The thin part grows and pushes the
# head forward, while the rear end is anchored. When $\gamma$ has a quarter of the body left, $\eta$ appears at the front.
# The head is then the anchor, and the body pulls its rear forward.

# %% tags=["remove-input"]
page.player("play_robot", "Two cycles, four times as fast. Lengths are true to scale.")

# %% tags=["remove-input"]
page.figure(
    "fig_2_7",
    "One cycle: (a) push from the rear, (b) transition, (c) pull to the front. Ahead of $\\gamma$ (green) and behind "
    "$\\eta$ (blue) advancing loads make the body thin and long; the red triangle is the anchor.",
)

# %% tags=["remove-input"]
page.figure(
    "fig_2_8",
    "Discrete values of both fronts: (a) at the stored instants, from the first pause on, (b) at the time step "
    "of the thesis, which the library does not need. A front is on the body only between the ends, never at an end.",
)

# %% tags=["remove-input"]
page.figure(
    "fig_2_9",
    "(a) Ends and anchor. (b) Stretches when the anchor changes: two plateaus and a layer. (c), (d) The body on the "
    "ground in both cycles: the second cycle starts where the first ends.",
)

# %% [markdown]
# If the weight is a force per reference length, the robot's equations are linear, and the displacement in a cycle has a
# closed form: the head advances while $\gamma$ travels and is anchored from the instant when $\eta$ appears. The table shows
# the cycle with the largest difference from the closed form.
#
# Inflated artificial muscles ($\bar D = 0$, $p < 0$) are short and thick where their load acts, so $\gamma$ and $\eta$ must
# be exchanged. With the gait of the robot they crawl backwards and anchor with a thin part; the library then gives a warning.

# %% tags=["remove-input"]
page.rows("2.7")

# %% tags=["remove-input"]
lines = []
for name, what in (
    ("soft_robot", "as in the table"),
    ("soft_robot_printed_contact", "weight over the current length, (2.2.20) as printed"),
    ("soft_robot_held", "contact force constant through advancing regions, as in section 2.4"),
):
    lines.append((what, f"{1e3 * crawl_readouts.strides(page.data(name))[-1]:.2f} mm"))
page.table(lines, ("soft robot", "displacement in a cycle"))

# %% [markdown]
# ## Protrusion and stance
#
# The worm of 10 g protrudes its front end while its rear is anchored, and pulls its rear forward while the front is
# anchored. Its dimensions and times follow from the scaling laws of Table 2.1:

# %% tags=["remove-input"]
page.rows("T2.1", "2.8-circumference", "2.8.2", "2.8.3")

# %% tags=["remove-input"]
page.player(
    "play_worm", "Two strides in real time. Heights are drawn three times as large. Segment 50 is black."
)

# %% tags=["remove-input"]
page.figure(
    "fig_2_1",
    "The six times of the thesis, heights magnified. Solid: the corrected equations. Dotted: the equations as printed, "
    "which give the numbers of the thesis.",
)

# %% tags=["remove-input"]
page.figure(
    "fig_2_11",
    'The fronts over three strides. Lines: two other readings of the sentence that $\\gamma$ "then speeds up" at $t_p/2$. '
    "In both readings the front is at one half before the protrusion ends (assumption E2.15).",
)

# %% tags=["remove-input"]
page.figure(
    "fig_2_2",
    "Segment 50 over three strides, by the corrected and by the printed equations. Quillin measured the pressures, and the "
    "ratios of length and of width between circular and longitudinal contraction. The figure shows these ratios times "
    "the stretches of the corrected worm in longitudinal contraction.",
)

# %% [markdown]
# Segment 50 is read in the middle of the stance and in the middle of the protrusion, when it lies well inside an advancing
# and an anchoring region. The longitudinal contraction agrees with the published one. In circular contraction the printed
# equations give the published lateral stretch; their axial stretch and pressure differ from the published ones by less than
# one printed unit. The corrected equations give other numbers (erratum E2.5). Separate rows show the correction of (2.4.18)
# alone and with that of the weight. The corrected model agrees with the measured ratio of axial stretches, but not with the
# lateral one. No round body of constant volume agrees with both (question E2.21).

# %% tags=["remove-input"]
page.rows("2.8-mu1", "2.8-mu3", "2.8-p-")

# %% tags=["remove-input"]
page.rows("2.8.10", "2.8.6")

# %% [markdown]
# The pressure here is that of the page: a Piola traction, per area of the reference. A gauge in the fluid measures the
# Cauchy pressure, which is the Piola traction divided by $\mu_1 \mu_2$ (question E2.20):

# %% tags=["remove-input"]
worm = page.data("worm")
lines = []
for phase, what in (
    (crawl_readouts.CIRCULAR, "circular"),
    (crawl_readouts.LONGITUDINAL, "longitudinal"),
):
    at = crawl_readouts.at_phase(worm, phase)
    cauchy = float(at.p_coelom / (at.mu_1 * at.mu_2))
    lines.append((f"{what} contraction", f"{float(at.p_coelom):.0f} Pa", f"{cauchy:.0f} Pa"))
page.table(lines, ("segment 50", "Piola, as published", "Cauchy"))

# %% [markdown]
# At rest the weight alone causes the pressure, which is $\rho_0 g / (3 \pi R)$ times $\mu_1 \mu_2$. The page calls it
# "minimal (10 Pa)". Quillin measured ten times as much: the muscles of a worm at rest have some tone. Neither the page nor
# this library models it (assumption E2.26).
#
# ## The stride: which reading gives which length
#
# The page prints a stride of 39 mm. No reading of the page gives 39 mm. Three choices are open; none of them was tuned.
#
# **When the anchor changes from the mean of $\gamma$ and $\eta$ to the rear end.** Both fronts are on the body until $t_p/2$,
# when $\eta$ leaves it. Until then the rear is thin; afterwards it is fat. Section 2.1 says that a worm anchors "where the
# worm longitudinally contracts and fattens". Only with a switch at $t_p/2$ is the anchor never in a thin part, so this
# library uses $t_p/2$ (assumption E2.17). The other reading is $t_p/3$, an instant at which the page draws the worm. It
# gives a stride nearer to the printed one, but its worm anchors with a thin rear end and slips back.

# %% tags=["remove-input"]
page.figure(
    "fig_2_12",
    "The anchored point: at the beginning of the protrusion the mean of both fronts, then the rear end. From $t_p/3$ "
    "to $t_p/2$ the rear end is thin.",
)

# %% tags=["remove-input"]
lines = []
for name, what in (("worm", "$t_p/2$"), ("worm_early", "$t_p/3$")):
    run = page.data(name)
    back = np.maximum.accumulate(run.along.to_numpy()) - run.along.to_numpy()
    case = cosserat.case(name).problem
    thin = len(case.thin_anchors()), len(case.gait.instants(case.step))
    lines.append(
        (
            what,
            f"{1e3 * crawl_readouts.strides(run)[-1]:.1f} mm",
            f"{thin[0]} of {thin[1]} instants",
            f"{1e3 * back[:, -1].max():.1f} mm",
            f"{1e3 * back.max():.1f} mm",
        )
    )
page.table(
    lines,
    (
        "switch to the rear at",
        "stride",
        "anchor in a thin part",
        "head slips back",
        "any part slips back",
    ),
)

# %% [markdown]
# The page says that "backslipping may be accounted for" by a model with one anchor. The last two columns give the lengths.
#
# **How $\gamma$ moves in the second half of the protrusion.** Two sentences of the page contradict each other, and each
# reading keeps a part of them (assumption E2.15). The stride is the same in all three readings, to all digits: the head
# advances until $\gamma$ is at 0.5, and is at rest after that.
#
# **How near to the ends the fronts may come.** If a front leaves the body a little earlier, the stride does not change. If
# a front stops before the end and waits, the stride of the worm with the switch at $t_p/2$ falls by some millimetres, which
# is not enough. The stride of the worm with the switch at $t_p/3$ does not change (assumption E2.14).

# %% tags=["remove-input"]
page.rows("2.8-stride", "2.8.4-stride")

# %% [markdown]
# The stride does not depend on the time step if the events of the gait are times of the grid. While the anchor lies between
# the fronts, it is on a plateau that moves without a change of stretch. Any point of the plateau gives the same stride.
#
# ## Calibrated again
#
# The page found E, the force and the pressure by calibration "to match the expected outcomes": the two ratios (2.8.6) and
# the two measured pressures. A least-squares fit of the relative misfits of these four numbers gives other values
# (assumption E2.27). With these values both pressures agree, and the ratios of stretches agree as well as before.

# %% tags=["remove-input"]
page.rows("2.8-E", "2.8-share")

# %% tags=["remove-input"]
lines = []
for name, what in (("worm_calibration_printed", "as printed"), ("worm_calibration", "corrected")):
    fit = page.data(name)
    for label, values in (
        ("the page's parameters", fit.given_outcomes),
        ("calibrated again", fit.fitted_outcomes),
    ):
        lines.append((what, label, *(f"{float(ratio):.3f}" for ratio in values)))
names = [str(name) for name in fit.outcome.to_numpy()]
page.table(lines, ("equations", "model over measured, with", *names))

# %% [markdown]
# ## Worms of every size
#
# Quillin measured earthworms from hatchlings of 0.01 g to adults of 10 g. How does the force of the muscles depend on the
# mass? In section 2.8 a strip of muscle has the same tension in every worm. Then the force is proportional to the
# circumference. The pressure is inversely proportional to the radius by hoop balance, or constant as the 5.7 kPa of the
# page. If instead the *stress* of the muscle is constant and its thickness is proportional to the radius, the force is
# proportional to the area, and the pressure is constant.

# %% tags=["remove-input"]
page.source(earthworm.BodyMasses.scaled)

# %% tags=["remove-input"]
page.figure("fig_masses", "Three laws for the muscles; slopes in the legends.")

# %% tags=["remove-input"]
page.rows("2.8.4-exponent", "2.8-slope", "2.8-strain")

# %% [markdown]
# Only worms with muscles of constant stress crawl like earthworms of every size: their strains do not depend on the mass,
# and their stride grows with it as in (2.8.4). With constant tension and constant pressure small worms hardly become
# thinner. With constant tension and the pressure of hoop balance they become so thin that their surface cannot stay on the
# ground. The frequency is an input, from Table 2.1, and is the same in all three. The exponent of the speed is the sum of
# the exponents of stride and frequency.

# %%
small = cosserat.case("worm_masses_strip").vary("one_gram", masses=["1 g"])
try:
    cosserat.run(small)
except cosserat.CosseratError as error:
    print(error)

# %% [markdown]
# ## A gait of your own
#
# ```toml
# [inchworm]
# like = "worm"
# gait.phases = ["1 s", "1 s"]
# gait.gamma = [[[0, 1], [1, 0.2], [2, 0]]]
# gait.eta = [[[1, 1], [2, 0]]]
# gait.anchor = [[[0, 0], [1, 0]], [[1, 1], [2, 1]]]
# ```
#
# `cosserat run inchworm --file my.toml` computes it, and `cosserat plot inchworm.nc` draws it. In Python:

# %%
inchworm = cosserat.case("worm").vary(
    "inchworm",
    gait={
        "phases": ["1 s", "1 s"],
        "gamma": [[[0, 1], [1, 0.2], [2, 0]]],
        "eta": [[[1, 1], [2, 0]]],
        "anchor": [[[0, 0], [1, 0]], [[1, 1], [2, 1]]],
    },
)
crawled = cosserat.run(inchworm)
print(f"The stride is {1e3 * float(crawled.along[-1, -1] - crawled.along[0, -1]) / 3:.0f} mm.")

# %% [markdown]
# ## Errata and open questions

# %% tags=["remove-input"]
page.table(
    [
        (name, entry.standing, entry.where, entry.why)
        for name, entry in page.errata().items()
        if name.startswith("E2.")
    ],
    ("entry", "standing", "where", "why"),
)

# %% tags=["remove-cell"]
assert len([name for name in page.errata() if name.startswith("E2.")]) >= 20
