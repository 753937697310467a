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
# In the last chapter muscles held a body in one shape. Now the active regions travel along the body, and the body crawls. The
# chapter first shows the motion. It then says how positions on the ground follow from stretches, and computes a soft
# robot and an earthworm of 10 g beside what was measured on worms.
#
# :::{admonition} After this chapter you can
# :class: objectives
# * describe a gait by its fronts and its anchor;
# * predict the length of a stride by hand from the stretches of two plateaus;
# * say which number of the thesis belongs to its printed equations, which to the corrected ones, and which to neither;
# * write a gait of your own.
# :::

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.studies.door import case_of_study
from cosserat.thesis.book import page

# %% [markdown]
# ## Watch it first

# %% tags=["remove-input"]
page.player(
    "play_worm",
    "Two strides in real time. Heights are drawn three times as large. Segment 50 is marked.",
)

# %% [markdown]
# * A **front** is a junction that travels from the front end of the body to the rear. Behind a front $\gamma$ the body anchors,
#   ahead of it the body advances. At a front $\eta$ it is the other way round.
# * The **anchor** is the one point that is fixed to the ground at an instant. It is the section $\xi_A$.
# * In the **protrusion**, which lasts $t_p$, the front part becomes long and reaches forward while an anchor
#   behind it holds. In the **stance**, which lasts $t_s$, the front end holds, and the rear part becomes short and follows.
# * A **stride** is a protrusion and a stance. Its length $\Delta$ is how far the body is moved by both.
# * An earthworm consists of some 150 rings, the segments, counted from the front end. Quillin measured **segment 50**. It lies two
#   fifths of the length behind the front end, so at $\xi = 3\ell_0/5$. It is in **longitudinal contraction** when it
#   lies in an anchoring region, and in **circular contraction** when it lies in an advancing one.
#
# ## From stretches to motion
#
# The motion is slow, so it is a sequence of states at rest. The states are numbered by $i$, which stands at the upper left. At
# each instant the last chapter gives the stretches. The anchor of an instant stays where that section was at the instant
# before, and all other sections follow from it along the body:
#
# $$
# {}^i z({}^i \xi_A) = {}^{i-1} z({}^i \xi_A) , \tag{2.5.10}
# $$
#
# $$
# {}^i z(\xi) = {}^{i-1} z({}^i \xi_A) + \int_{{}^i \xi_A}^{\xi} \sqrt{{}^i \mu_3^2 - R^2\, {}^i {\mu'_1}^2}\, d\bar{\xi} .
# \tag{2.5.11}
# $$

# %% tags=["remove-input"]
page.excerpt("cosserat.peristalsis.ground.placed", "for number, poses", "return steps")

# %% [markdown]
# Why does this move the body forward? Follow one short piece of the body, $d\xi$ long at rest. When a front $\gamma$ passes it,
# the piece changes from fat to thin, and its length grows by $(\mu_3^{adv} - \mu_3^{anch})\, d\xi$, the difference of the two
# plateaus. If the anchor is behind the front, everything ahead of the piece is pushed forward by this much. When a front $\eta$
# passes, the piece becomes shorter by the same amount. If the anchor is ahead of the front, everything behind is pulled
# forward. So a body crawls if it pushes from a rear anchor with $\gamma$ and pulls to a front anchor with $\eta$. The same
# fronts with the wrong anchor move it backward.
#
# ## A gait is data
#
# Fronts and anchor are given as tracks of points `[phase, place]`. A phase is a time, counted in parts of the stride:
# 1 is the end of the first part, 1.5 the middle of the second. A place
# is a fraction of the length from the rear end. Here is the gait of the robot:
#
# ```toml
# [soft_robot.gait]
# phases = ["5 s", "7.5 s", "2.5 s", "7.5 s"]
# gamma = [[[1, 1], [2, 0.25], [3, 0]]]
# eta = [[[2, 1], [3, 0.75], [4, 0]]]
# anchor = [[[0, 0], [2, 0]], [[2, 1], [4, 1]]]
# ```
#
# A cycle begins with a pause. At phase 1 the front $\gamma$ starts at the front end; at phase 2 it has a quarter of the body
# left, and $\eta$ starts; at phase 3 $\gamma$ leaves the body at the rear end. The anchor is the rear end up to phase 2 and the
# front end after it.
#
# The library refuses a gait with a gap in time, with fronts that cross, with an anchor off the body or on a front, or with
# loads that change suddenly on a part of the body. A front leaves the body when its distance to an end is less than a clearance,
# which is a key of the case; the thesis asks only that fronts do not come too close to the ends.

# %% tags=["remove-input"]
page.misprint("E2.14", "E2.16")

# %% [markdown]
# ## The soft robot pushes and pulls

# %% tags=["remove-input"]
page.player("play_robot", "Two cycles, four times as fast. Lengths are true to scale.")

# %% [markdown]
# The robot waits in longitudinal contraction. Then $\gamma$ travels, the thin part grows, and the head goes forward from the
# rear anchor. When $\eta$ appears, the head becomes the anchor, and the body pulls its rear forward.

# %% tags=["remove-input"]
page.figure(
    "fig_2_7",
    "One cycle: (a) push from the rear, (b) transition, (c) pull to the front. Look at the head: it moves in (a) and holds "
    "in (b) and (c). Ahead of $\\gamma$ and behind $\\eta$ the body is thin and long.",
)

# %% tags=["remove-input"]
page.figure(
    "fig_2_8",
    "Places of both fronts over time: (a) at the stored instants of both cycles, (b) at the time step of the thesis, which the "
    "library does not need. A front is on the body only between the ends, never at an end.",
)

# %% tags=["remove-input"]
page.figure(
    "fig_2_9",
    "(a) Ends and anchor. (b) Stretches when the anchor changes: two plateaus and a layer. (c), (d) The body on the "
    "ground in both cycles: the second cycle starts where the first ends.",
)

# %% [markdown]
# The equations of the robot are linear, so its displacement in a cycle has a closed form. The row compares it with
# the cycle that differs most from it. The thesis prints no number here.

# %% tags=["remove-input"]
page.rows("2.7")


# %% tags=["remove-input"]
def displacement(name):
    """Mean displacement of the front end in a stride or a cycle of a stored case [m]."""
    run = page.data(name)
    front = run.along.isel(section=-1)
    return float(front[-1] - front[0]) / cosserat.case_of(run).problem.strides


page.table(
    [
        (what, f"{1e3 * displacement(name):.2f} mm")
        for name, what in (
            ("soft_robot", "corrected equations"),
            ("soft_robot_printed_contact", "weight divided by $\\mu_3$, as printed in (2.2.20)"),
            ("soft_robot_held", "contact force continuous at junctions, the rule of section 2.4"),
        )
    ],
    ("soft robot", "displacement in a cycle"),
)

# %% [markdown]
# An inflated artificial muscle has no longitudinal force, $\bar D = 0$, and a negative pressure $p$. It is short and thick where
# its load acts, so $\gamma$ and $\eta$ exchange their roles. With the gait above it crawls backward and anchors with a thin
# part; the library gives a warning.
#
# ## The earthworm: protrusion and stance
#
# The worm of the thesis has a mass of 10 g. Its dimensions and times follow from the scaling laws of Table 2.1, which were
# measured on worms of every size. The peak loads of its muscles follow from strips of muscle in the laboratory; the thesis uses
# a share of them.

# %% tags=["remove-input"]
page.rows("T2.1", "2.8-circumference", "2.8.2", "2.8.3")

# %% tags=["remove-input"]
page.misprint("E2.13", "E2.22", "E2.28")

# %% tags=["remove-input"]
page.figure(
    "fig_2_1",
    "The six times of the thesis. Look at the fat part: it travels to the rear, while the black segment goes forward when the fat "
    "part is elsewhere. Solid: the corrected equations. Dotted: the equations as printed.",
)

# %% tags=["remove-input"]
page.figure(
    "fig_2_11",
    "The fronts over three strides. Lines: two other readings of the sentence that $\\gamma$ "
    '"then speeds up" at $t_p/2$. In both the front has passed one half before the protrusion ends.',
)

# %% tags=["remove-input"]
page.misprint("E2.15")

# %% [markdown]
# ### Segment 50, computed and measured
#
# Segment 50 is read in the middle of the protrusion, when it lies well inside an anchoring region, and in the middle of the
# stance, when it lies well inside an advancing one.

# %% tags=["remove-input"]
page.figure(
    "fig_2_2",
    "The stretches have two levels, because the segment lies in one of two plateaus. Dashed: the pressures that Quillin measured, "
    "and the measured ratios of length and width between the two contractions, times the stretches of the corrected worm in "
    "longitudinal contraction.",
)

# %% tags=["remove-cell"]
NUMBERS = {
    name: float(page.row(name)["measured"])
    for name in (
        "2.8-stride",
        "2.8-stride-printed-early",
        "2.8-stride-corrected",
        "2.8-stride-corrected-early",
        "2.8-mu3-circular-corrected",
        "2.8-mu3-longitudinal-corrected",
        "2.8-p-circular-corrected",
        "2.8-p-longitudinal-corrected",
        "2.8-p-rest",
    )
}

# %% [markdown]
# The printed and the corrected equations both give the published stretches and pressure of longitudinal contraction. In circular
# contraction they differ. The printed ones give the published lateral stretch, and miss the axial stretch and the pressure by
# less than one unit of the last digit. The corrected ones give other numbers, so the published numbers were computed
# with the misprint of E2.5, which is about equation (2.4.18). Separate rows show its correction alone, and
# together with the weight of E2.7.

# %% tags=["remove-input"]
page.rows("2.8-mu1", "2.8-mu3", "2.8-p-")

# %% [markdown]
# Quillin gives ratios between the two contractions. The corrected worm agrees with the ratio of lengths, but not with the ratio
# of widths. No round body of constant volume agrees with both: the ratio of lengths times the square of the ratio of
# widths would have to be 1, and it is not.

# %% tags=["remove-input"]
page.rows("2.8.10", "2.8.6")

# %% tags=["remove-input"]
page.misprint("E2.5", "E2.21")

# %% [markdown]
# The thesis divides the force on a section by the area of the section at rest. This is a Piola pressure. A gauge in the fluid
# measures the Cauchy pressure, a force per present area. The present area is $\mu_1 \mu_2 = 1/\mu_3$ times the area at rest, so
# the gauge shows $\mu_3$ times as much:

# %% tags=["remove-input"]
page.table(
    [
        (
            f"{load} contraction",
            f"{pressure:.0f} Pa",
            f"{pressure * NUMBERS[f'2.8-mu3-{load}-corrected']:.0f} Pa",
            page.row(f"2.8-p-{load}-measured")["published"],
        )
        for load in ("circular", "longitudinal")
        for pressure in [NUMBERS[f"2.8-p-{load}-corrected"]]
    ],
    ("segment 50", "Piola, as in the thesis", "Cauchy", "measured by Quillin"),
)

# %% tags=["remove-input"]
page.text(
    "At rest only the weight acts. The pressure is then "
    f"$\\mu_1 \\mu_2 \\, \\rho_0 g / (3 \\pi R)$, which is {NUMBERS['2.8-p-rest']:.0f} Pa. "
    f"Quillin measured {page.row('2.8-p-rest-measured')['published']}: the muscles of a resting worm keep some tone. "
    "Neither the thesis nor this library models it."
)

# %% tags=["remove-input"]
page.misprint("E2.20", "E2.26")

# %% [markdown]
# ## The stride: which reading gives which length

# %% tags=["remove-input"]
page.text(
    f"The thesis prints a stride of {page.row('2.8-stride')['published']}. No reading of its text gives this number. Three "
    "choices are open, and none of them was tuned to come near it."
)

# %% [markdown]
# **When does the anchor change to the rear end?** In the beginning of the protrusion there are two fronts, and the anchor is in the
# middle between them, in the fat part. Later the anchor is the rear end. The thesis does not say when it changes. Until $t_p/2$,
# when $\eta$ leaves the body, the rear end is thin; after that it is fat. Section 2.1 says that a worm anchors "where the worm
# longitudinally contracts and fattens". Only a change at $t_p/2$ never anchors with a thin part, so this library uses it. The other
# reading is $t_p/3$, an instant at which the thesis draws the worm. From $t_p/3$ to $t_p/2$ that worm holds on with
# its thin rear end. Meanwhile $\eta$ passes a sixth of the body, which becomes shorter and pulls everything ahead of it backward.

# %% tags=["remove-input"]
page.figure(
    "fig_2_12",
    "The anchored point over three strides, in both readings. From $t_p/3$ to $t_p/2$ they differ: the rear end is thin there.",
)

# %% tags=["remove-input"]
lines = []
for name, what in (("worm", "$t_p/2$"), ("worm_early", "$t_p/3$")):
    run = page.data(name)
    back = np.maximum.accumulate(run.along.to_numpy()) - run.along.to_numpy()
    crawl = cosserat.case(name).problem
    thin, all_of_them = len(crawl.thin_anchors()), len(crawl.gait.instants(crawl.step))
    lines.append(
        (
            what,
            f"{1e3 * displacement(name):.1f} mm",
            f"{thin} of {all_of_them} instants",
            f"{1e3 * back[:, -1].max():.1f} mm",
            f"{1e3 * back.max():.1f} mm",
        )
    )
page.table(
    lines,
    (
        "change to the rear end at",
        "stride",
        "anchor in a thin part",
        "head slips back by",
        "any part slips back by",
    ),
)

# %% [markdown]
# The thesis says that a model with one anchor may account for "backslipping". The last two columns say how much.
#
# **How does $\gamma$ move in the second half of the protrusion?** Two sentences of the thesis contradict each other, and each
# reading keeps a part of them (E2.15). The stride is the same in all three, to all digits: the head moves until $\gamma$
# has reached the middle of the body, and is the anchor after that.
#
# **How near do the fronts come to the ends?** If a front leaves the body a little early, the stride does not change. If it stops
# before the end and waits there, a short piece of the body never changes, and the stride with the change at $t_p/2$ becomes some
# millimetres shorter (E2.14). That is not enough either.

# %% tags=["remove-input"]
page.rows("2.8-stride", "2.8.4-stride")

# %% tags=["remove-input"]
page.misprint("E2.17", "E2.18")

# %% [markdown]
# The stride does not depend on the time step if the events of the gait are times of the grid. While the anchor lies between
# two fronts, it lies on a plateau whose stretches do not change. So every point of this plateau gives the same stride.
#
# ## Calibrated again
#
# The thesis chose $E$, $\bar{D}$ and $p$ "to match the expected outcomes", and does not say how. The expected outcomes are four
# numbers: the two ratios (2.8.6) and the two measured pressures. Here the three parameters are fitted to them by least squares,
# each misfit relative to its number. Other values come out. With them both pressures agree, and the ratios agree as well as
# before.

# %% tags=["remove-input"]
page.rows("2.8-E", "2.8-share")

# %% tags=["remove-input"]
lines = []
for name, what in (("worm_calibration_printed", "as printed"), ("worm_calibration", "corrected")):
    fit = page.data(name)
    for label, values in (
        ("those of the thesis", fit.given_outcomes),
        ("fitted", fit.fitted_outcomes),
    ):
        lines.append((what, label, *(f"{float(ratio):.3f}" for ratio in values)))
assert fit.sizes["outcome"] == 4
outcomes = ("ratio of $\\mu_1$", "ratio of $\\mu_3$", "longitudinal pressure", "circular pressure")
page.folded(
    "Four outcomes, computed over measured, before and after the fit",
    page.table(lines, ("equations", "parameters", *outcomes)),
)

# %% tags=["remove-input"]
page.misprint("E2.27")

# %% [markdown]
# ## Worms of every size
#
# Quillin measured earthworms from hatchlings of 0.01 g to adults of 10 g. Table 2.1 gives their length, radius and times. It does
# not give the loads. How do the force and the pressure of the muscles depend on the radius? Three laws are tried:
#
# | law | force $\bar{D}$ grows as | pressure $p$ grows as | why |
# |---|---|---|---|
# | strip tension | $R$ | $1/R$ | a strip of muscle has the same tension in every worm; the pressure is this tension over the radius, as in a tube |
# | strip tension, constant $p$ | $R$ | constant | the same strip, and one pressure for all |
# | constant stress | $R^2$ | constant | the muscle is as thick as its worm is large, and its force per area is the same |

# %% tags=["remove-input"]
page.excerpt("cosserat.thesis.earthworm.BodyMass.scaled", "mass = self")

# %% tags=["remove-input"]
page.figure(
    "fig_masses",
    "Stride, speed, frequency and the extreme stretches of segment 50 over the mass of the body, under three laws for the "
    "muscles, beside the slopes of the literature. Look at the stretches: only one law keeps them constant.",
)

# %% tags=["remove-input"]
page.rows("2.8.4-exponent", "2.8-slope", "2.8-strain")

# %% [markdown]
# Only worms with muscles of constant stress crawl like earthworms of every size. Their strains do not depend on the mass, as
# Quillin found, and their stride grows with it as in (2.8.4). With constant tension and constant pressure small worms hardly become
# thin. With constant tension and the pressure of a tube they become so thin that their surface cannot stay on the
# ground (E2.13). The frequency is an input, from Table 2.1, and is the same in all three. A speed is a stride times a frequency,
# so its power of the mass is the sum of the two.

# %%
worm = case_of_study(page.study("worm_masses_strip"))
try:
    cosserat.run(worm.vary("one_gram", body_mass="1 g"))
except cosserat.CosseratError as error:
    print(error)

# %% [markdown]
# ## A gait of your own
#
# An inchworm sends $\gamma$ over most of its body in one second, then $\eta$ over all of it in the next:
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
gait = {
    "phases": ["1 s", "1 s"],
    "gamma": [[[0, 1], [1, 0.2], [2, 0]]],
    "eta": [[[1, 1], [2, 0]]],
    "anchor": [[[0, 0], [1, 0]], [[1, 1], [2, 1]]],
}
inchworm = cosserat.run(cosserat.case("worm").vary("inchworm", gait=gait))
head = inchworm.along.isel(section=-1)
print(f"The stride is {1e3 * float(head[-1] - head[0]) / 3:.0f} mm.")

# %% tags=["remove-input"]
page.player(
    cosserat.animate(inchworm),
    "Three strides of the inchworm, in real time. In each second only one end of the body moves.",
    name="play_inchworm",
    title="The inchworm crawls",
)

# %% [markdown]
# ## Exercises
#
# :::{admonition} Exercise 2.4: a stride by hand
# :class: exercise
# In the protrusion $\gamma$ travels from the front end to the middle of the body, while the anchor is behind it. In the stance
# the front end holds. Predict the stride of the worm from the stretches of the two plateaus alone, and do the same for the
# inchworm.
# :::

# %% tags=["hide-cell"]
worm = page.data("worm")
length = float(worm.xi_section[-1])
thin = worm.advancing.to_numpy() > 0.5
advancing, anchoring = (np.median(worm.mu_3.to_numpy()[where]) for where in (thin, ~thin))
growth = length * (advancing - anchoring)  # of the whole body from fat to thin [m]
by_hand = growth / 2  # half of the body changes
assert abs(by_hand / displacement("worm") - 1) < 0.01
assert abs(0.8 * growth / (float(head[-1] - head[0]) / 3) - 1) < 0.01
print(f"By hand {1e3 * by_hand:.1f} mm, computed {1e3 * displacement('worm'):.1f} mm.")
print(f"The inchworm: by hand {1e3 * 0.8 * growth:.1f} mm.")

# %% [markdown]
# :::{admonition} Exercise 2.5: the price of the wrong anchor
# :class: exercise
# With the change at $t_p/3$ the worm holds on with its thin rear end until $t_p/2$. The front $\eta$ starts at the middle of the
# body and reaches the rear end at $t_p/2$. How much shorter does the stride become?
# :::

# %% tags=["hide-cell"]
# From t_p/3 to t_p/2 the front passes the last third of its way, so a sixth of the body becomes short.
early = by_hand - growth / 6
assert abs(early / displacement("worm_early") - 1) < 0.01
print(f"By hand {1e3 * early:.1f} mm, computed {1e3 * displacement('worm_early'):.1f} mm.")

# %% [markdown]
# :::{admonition} Exercise 2.6: why muscles of constant stress keep the shape
# :class: exercise
# Show that without weight the plateaus depend on $\bar{D}/(E R^2)$ and $p/E$ alone. Under which of the three laws are both
# the same in every worm? By which power of the mass does the stride then grow?
# :::

# %% tags=["hide-cell"]
# k_I and p pi R^2 grow as E R^2.  Divide a plateau of (2.4.13) by k_I: D / k_I and p pi R^2 / k_I are left.
# Constant stress keeps both, so the stretches are the same, and the stride grows as the length of the body.
masses = page.study("worm_masses")
worm = case_of_study(masses)
scaled = [worm.vary("scaled", body_mass=float(mass)).problem.scaled() for mass in masses.body_mass]
lengths = np.array([crawl.crawler.length for crawl in scaled])
power = np.polyfit(np.log(masses.body_mass), np.log(masses.stride), 1)[0]
expected = np.polyfit(np.log(masses.body_mass), np.log(lengths), 1)[0]
assert abs(power - expected) < 5e-3
print(f"The stride grows as the power {power:.2f} of the mass, the length as {expected:.2f}.")
