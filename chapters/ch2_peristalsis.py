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
# A worm has two kinds of muscle. Longitudinal muscles run along the body; they make it short and fat. Circular muscles run
# round the body; they make it thin. The volume of the body does not change, so a part that becomes thin also becomes long.
# In this chapter the worm is one directed rod, and its muscles are loads on this rod. The chapter computes the shape of the
# body at one instant. In the next chapter the body crawls.
#
# :::{admonition} After this chapter you can
# :class: objectives
# * say which load a muscle puts on the rod, and which force the rod carries where the muscle acts;
# * derive the equations of a soft robot and of a worm from the balances of forces;
# * find by hand how much a long part of the body stretches, and over which length it passes into the next part;
# * compute a body with any sequence of active muscles.
# :::

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.thesis.book import page

# %% [markdown]
# ## Words and symbols

# %% tags=["remove-input"]
page.figure(
    "fig_worm_parts",
    "The worm of this chapter at two times of a stride. Fronts travel from the front end to the rear end. Behind a front "
    "$\\gamma$ the body anchors, ahead of it the body advances; at a front $\\eta$ it is the other way round.",
)

# %% [markdown]
# * A **region** is a part of the body in which the same muscles act. In an **anchoring region** the longitudinal muscles act:
#   it is fat and holds on to the ground. In an **advancing region** the circular muscles act: it is thin and slides.
# * A **junction** is a place where two regions meet. A junction that travels along the body is a **front**. Behind a
#   front $\gamma$ the body anchors, behind a front $\eta$ it advances. This $\gamma$ is not a strain $\gamma_{ij}$.
# * A **stride** is one cycle of the muscles. After it the body has its first shape again, further on.
# * A **plateau** is the inner part of a region, in which the stretches are the same everywhere. A **layer** is the short part
#   round a junction in which they pass from one plateau to the next.
#
# The body lies straight on level ground. At rest its length is $\ell_0$ and its radius $R$. A cross-section, in short a
# *section*, is named by its distance $\xi$ from the rear end at rest. $\mathbf{E}_1$ points up, $\mathbf{E}_2$ across the body
# and $\mathbf{E}_3$ forward. Sections stay upright when the body moves, so the two directors of a section change their lengths
# but not their directions:
#
# $$
# \mathbf{d}_\alpha = \mu_\alpha \mathbf{E}_\alpha , \quad \mathbf{d}'_\alpha = \mu'_\alpha \mathbf{E}_\alpha
# \quad (\alpha = 1, 2; \text{ no sum}) . \tag{2.1.1}
# $$
#
# A prime is a derivative by $\xi$. $\mu_1$ is the stretch of a section upwards and $\mu_2$ its stretch across. $\mu_3$ is the
# stretch of the centreline along its tangent $\mathbf{e}_3$. A stretch is a length over the same length at rest: 1 is the state
# at rest, and 0.9 is shorter by a tenth.
#
# Three letters need care. In this chapter $\tilde{z} = \xi/\ell_0$ is a place in the body, as a fraction of its length, and $z$
# is a position along the ground; the code calls them `z` and `along`. A tilde marks a number without a unit. The letter below
# the tilde says nothing: $\tilde{p}$ is a ratio of two stiffnesses, and $p$ is the pressure of the circular muscles. The
# letter $\lambda$ has three meanings, and its indices tell them apart: the window of a muscle, the force $\lambda^E$ of the
# ground, and the multipliers $\lambda^I$, $\lambda_c^I$ of a constant volume.
#
# ## Muscles as loads
#
# A crawling body is slow, so each slice of it is at rest. Then the forces on a slice are in balance, and so are the forces
# on its directors. These are the balances (1.2.71) and (1.2.82) without inertia:
#
# $$
# \mathbf{n}' + \rho_0 \mathbf{f} = \mathbf{0} , \qquad {\mathbf{m}^\alpha}' - \mathbf{k}^\alpha + \rho_0 \mathbf{l}^\alpha =
# \mathbf{0} .
# $$
#
# $\mathbf{n}$ [N] is the contact force: the part of the body ahead of a section pulls with it on the part behind.
# $\rho_0 \mathbf{f}$ [N/m] is the load on the centreline. The force $\mathbf{k}^\alpha$ [N] resists a stretch of the director
# $\mathbf{d}_\alpha$. The director couple $\mathbf{m}^\alpha$ [N m] resists a change of this stretch from section to section.
# $\rho_0 \mathbf{l}^\alpha$ [N] is the load on the director, per length of the body. Each muscle is one of these loads.
#
# **Longitudinal muscles** pull two neighbouring points of the centreline together. One muscle occupies a short window of
# the length $\lambda$. It pushes forward on the rear half of the window and backward on the front half; each push is a force
# $P$. Many muscles stand in a row. The forward push of one muscle cancels the backward push of the muscle behind it. What is
# left is a force at each end of the row, and between them a constant contact force:
#
# $$
# \mathbf{n}(\xi) = -\bar{D} \mathbf{e}_3 \quad \text{for } \xi_1 < \xi < \xi_2 . \tag{2.2.7}
# $$
#
# $\bar{D}$ [N] is the strength of the row, and the row fills the body from $\xi_1$ to $\xi_2$. The minus sign says that the body
# is compressed. At either end of the row $\mathbf{n}$ jumps, because the whole force $\bar{D}$ acts there.

# %% tags=["remove-input"]
page.figure(
    "fig_2_5",
    "(a) One muscle: its load on the centreline, and the contact force that balances it. (b) Rows of 2, 6 and 40 muscles that "
    "overlap by half a window. Look at the middle: the force is constant, however few muscles there are. As their number grows, "
    "the windows become shorter and the force at the ends becomes a jump.",
)

# %% tags=["remove-input"]
page.excerpt("cosserat.peristalsis.doublets.contact_force", "offset =", "return")

# %% tags=["remove-input"]
page.misprint("E2.23")

# %% [markdown]
# **Circular muscles** press on the surface of the body with a pressure $p$ [Pa], a force per area of the surface at rest. The
# load on a director is the pressure times the position $X^\alpha$ in the section, summed along the circumference. It is the
# same for both directors, and it makes both shorter:
#
# $$
# \rho_0 \mathbf{l}^\alpha_A = \oint -p \, \mathbf{e}_r X^\alpha \, R \, d\phi = -p \pi R^2 \mathbf{e}_\alpha . \tag{2.2.9}
# $$
#
# Here $\mathbf{e}_r$ points outwards from the centre of the section, $\phi$ is the angle round it, and $\mathbf{e}_\alpha$ is
# the direction of $\mathbf{d}_\alpha$.
#
# **The ground** carries the body. The weight pulls at the centre of each section; the ground pushes up at its lowest point with
# a force $\lambda^E$ per length. The two forces cancel. But the push is a distance $R$ below the centre, so it flattens the
# section:
#
# $$
# \rho_0 \mathbf{l}^1_C = -R \lambda^E \mathbf{E}_1 , \tag{2.2.17}
# $$
#
# $$
# \lambda^E = \rho_0 g . \tag{2.2.20}
# $$
#
# $\rho_0$ [kg/m] is the mass per length at rest and $g$ the acceleration of free fall.

# %% tags=["remove-input"]
page.misprint("E2.7")

# %% [markdown]
# ## The soft robot: a material that changes its volume
#
# The energy per length of the soft robot is quadratic in the stretches and in their gradients,
#
# \begin{equation*}
# \begin{aligned}
# 2w = {}& k_S [(\mu_1 - 1)^2 + (\mu_2 - 1)^2 + (\mu_3 - 1)^2] \\
# & + 2k_P [(\mu_1 - 1)(\mu_2 - 1) + (\mu_1 - 1)(\mu_3 - 1) \\
# & \hphantom{{} + 2k_P [} + (\mu_2 - 1)(\mu_3 - 1)] \\
# & + k_G [(\mu'_1)^2 + (\mu'_2)^2] .
# \end{aligned} \tag{2.3.1}
# \end{equation*}
#
# The first line resists each stretch by itself. The terms with $k_P$ couple them: pull the body along, and it becomes thin. The
# last line resists a section that differs from its neighbour. The three stiffnesses follow from Young's modulus $E$ and
# Poisson's ratio $\nu$, and they are those of Chapter 1. In the library a problem with all its data is a *case*, and
# the name of each datum is a *key*. A case may give the bulk modulus in place of one of the two.
#
# \begin{equation*}
# \begin{aligned}
# k_S &= \frac{E \pi R^2 (1 - \nu)}{(1 + \nu)(1 - 2\nu)} , \\
# k_P &= \frac{\nu}{1 - \nu} k_S , \quad k_G = \frac{E \pi R^4}{8(1 + \nu)} .
# \end{aligned} \tag{2.6.20}
# \end{equation*}
#
# ### From the balances to the equations, in four steps
#
# 1. *Forces are derivatives of the energy.* Each stretch has its force:
#
# \begin{equation*}
# \begin{aligned}
# \mathbf{k}^1 &= [k_S (\mu_1 - 1) + k_P (\mu_2 + \mu_3 - 2)] \, \mathbf{E}_1 , \\
# \mathbf{k}^2 &= [k_S (\mu_2 - 1) + k_P (\mu_1 + \mu_3 - 2)] \, \mathbf{E}_2 , \\
# \mathbf{n} &= [k_S (\mu_3 - 1) + k_P (\mu_1 + \mu_2 - 2)] \, \mathbf{e}_3 , \\
# \mathbf{m}^\alpha &= k_G \mu'_\alpha \mathbf{E}_\alpha .
# \end{aligned} \tag{2.3.2}
# \end{equation*}
#
# 2. *The muscles give the contact force.* It is $-\bar{D}\mathbf{e}_3$ in an anchoring region and zero in an advancing one. The
#    direction of $\mathbf{e}_3$ is taken as constant, though it turns in the layers. The third line of (2.3.2) then gives the stretch along the body from the other two. With $\tilde{p} = k_P/k_S$ and
#    $\tilde{d} = \bar{D}/k_S$ it is $\bar\mu_3$ in an anchoring region and $\hat\mu_3$ in an advancing one. This hat
#    is not that of Chapter 1:
#
# $$
# \bar\mu_3 = 1 - \tilde{d} - \tilde{p} (\mu_1 + \mu_2 - 2) , \tag{2.3.5}
# $$
#
# $$
# \hat\mu_3 = 1 - \tilde{p} (\mu_1 + \mu_2 - 2) . \tag{2.3.10}
# $$
#
# 3. *The balance of the directors.* With the loads (2.2.9) and (2.2.17), and with $p = 0$ in anchoring regions,
#
# $$
# k_G \mu''_1 = \mathbf{k}^1 \cdot \mathbf{E}_1 + R \rho_0 g + p \pi R^2 , \qquad
# k_G \mu''_2 = \mathbf{k}^2 \cdot \mathbf{E}_2 + p \pi R^2 .
# $$
#
# 4. *Numbers without units.* Multiply by $\ell_0^2/k_G$, and write every length as a fraction of $\ell_0$. These groups are left, all of them ratios to
#    $k_G$ or to $k_S$:
#
# \begin{equation*}
# \begin{aligned}
# \tilde{g} &= k_S \, \ell_0^2 / k_G , && \text{stretch over its gradient} \\
# \tilde{p} &= k_P / k_S , && \text{coupling of the stretches} \\
# \tilde{d} &= \bar{D} / k_S , && \text{longitudinal muscles} \\
# \tilde{m} &= R \, \rho_0 g \, \ell_0^2 / k_G , && \text{weight}
# \end{aligned} \tag{2.3.4}
# \end{equation*}
#
# \begin{equation*}
# \begin{aligned}
# \tilde{c} &= p \pi R^2 \ell_0^2 / k_G . && \text{circular muscles}
# \end{aligned} \tag{2.3.8}
# \end{equation*}

# %% tags=["remove-input"]
page.misprint("E2.1", "E2.3", "E2.6", "E2.24")

# %% [markdown]
# The equations of an anchoring region are now
#
# \begin{equation*}
# \begin{aligned}
# \frac{d^2 \mu_1}{d\tilde{z}^2} &= \tilde{m} + \tilde{g} (\mu_1 - 1) + \tilde{p} \tilde{g} (\mu_2 + \bar\mu_3 - 2) , \\
# \frac{d^2 \mu_2}{d\tilde{z}^2} &= \tilde{g} (\mu_2 - 1) + \tilde{p} \tilde{g} (\mu_1 + \bar\mu_3 - 2) ,
# \end{aligned} \tag{2.3.6}
# \end{equation*}
#
# and those of an advancing region
#
# \begin{equation*}
# \begin{aligned}
# \frac{d^2 \mu_1}{d\tilde{z}^2} &= \tilde{m} + \tilde{g} (\mu_1 - 1) + \tilde{p} \tilde{g} (\mu_2 + \hat\mu_3 - 2) + \tilde{c} , \\
# \frac{d^2 \mu_2}{d\tilde{z}^2} &= \tilde{g} (\mu_2 - 1) + \tilde{p} \tilde{g} (\mu_1 + \hat\mu_3 - 2) + \tilde{c} .
# \end{aligned} \tag{2.3.9}
# \end{equation*}
#
# In the code below `n` is $-\tilde{d}$ or zero, and `c` is $\tilde{c}$ or zero, so one function serves both regions. It has
# $\mu_3$ inserted in the brackets, which keeps all digits when $\nu$ is near one half. The thesis divides the weight by $\mu_3$
# in these equations (E2.7); the code can do so too.

# %% tags=["remove-input"]
page.excerpt("cosserat.peristalsis.equations.compressible", "mu_3[k] =", "df[k, 0, 0]")

# %% tags=["remove-input"]
page.excerpt("cosserat.peristalsis.crawler.Groups.of", "square =")

# %% [markdown]
# Two checks by differences stand in the folded cell. First, the forces (2.3.2) are derivatives of the energy (2.3.1). Second,
# a body that the library has solved satisfies (2.3.6) and (2.3.9): the second difference of its stretches is the right-hand
# side, at every place except the two junctions.

# %% tags=["hide-cell"]
k_s, k_p, k_g = cosserat.case("soft_robot").problem.crawler.stiffnesses


def energy(mu):
    """w of (2.3.1) without gradients, of the three stretches [N]."""
    e = mu - 1
    return (k_s * (e @ e) + 2 * k_p * (e[0] * e[1] + e[0] * e[2] + e[1] * e[2])) / 2


mu, h = np.array([0.8, 0.9, 1.3]), 1e-6
force = k_s * (mu - 1) + k_p * (mu.sum() - mu - 2)  # k^1, k^2 and n by (2.3.2)
differences = [(energy(mu + h * axis) - energy(mu - h * axis)) / (2 * h) for axis in np.eye(3)]
assert np.allclose(differences, force, rtol=1e-8)

robot = cosserat.case("soft_robot").problem
body, loads = robot.crawler, robot.loads
posture = cosserat.case("worm_at_rest").vary(
    "robot",
    crawler={
        "length": body.length,
        "radius": body.radius,
        "mass": "none",
        "density": body.density,
        "material": {"kind": "compressible", "young": "10 kPa", "poisson": 0.3},
    },
    loads={"anchoring": loads.anchoring, "advancing": loads.advancing},
    regions=[
        {"begin": 0.0, "end": 0.3, "load": "anchoring"},
        {"begin": 0.3, "end": 0.7, "load": "advancing"},
        {"begin": 0.7, "end": 1.0, "load": "anchoring"},
    ],
    sections=20001,
)
state = cosserat.run(posture)
mu_1, mu_2, mu_3, thin = (state[name].to_numpy() for name in ("mu_1", "mu_2", "mu_3", "advancing"))
square = body.length**2 / k_g
g, p = k_s * square, k_p / k_s
m = body.radius * body.line_density * loads.gravity * square
c = loads.advancing * np.pi * body.radius**2 * square
step = 1 / (mu_1.size - 1)
inside = thin[2:] == thin[:-2]  # not across a junction
for own, other, weight in ((mu_1, mu_2, m), (mu_2, mu_1, 0)):
    right = weight + g * (own - 1) + p * g * (other + mu_3 - 2) + c * thin
    second = (own[2:] - 2 * own[1:-1] + own[:-2]) / step**2
    assert np.abs(second - right[1:-1])[inside].max() < 1e-6 * g
assert np.allclose(mu_3, 1 - loads.anchoring / k_s * (1 - thin) - p * (mu_1 + mu_2 - 2), atol=1e-12)

# %% [markdown]
# ### Plateaus and layers
#
# $\tilde{g}$ is large, because the body is long. So the stretches change only near junctions. On a plateau the second
# derivatives are zero, and three linear equations for three stretches are left. Near a junction the distance from the
# plateau falls like $e^{-|\xi - \xi_j|/a}$, where $\xi_j$ is the place of the junction. The length $a$ follows from (2.3.6): a
# difference between $\mu_1$ and $\mu_2$ decays over
#
# $$
# a = \sqrt{\frac{k_G}{k_S - k_P}} = \frac{R}{\sqrt{8}} ,
# $$
#
# and a common change of both decays over $1/\sqrt{1 + 2\tilde{p}}$ times this length. Both are shorter than the radius. This is a limit of the
# theory, because a rod theory assumes that sections change slowly along the body.

# %% tags=["remove-input"]
page.misprint("E2.25")

# %% [markdown]
# Move the front through the robot. The layer goes with it and keeps its shape until it comes near an end. The two plateaus keep
# their stretches, so the body becomes longer by the same amount for each step of the front.

# %% tags=["remove-input"]
page.explore(
    "explore_front",
    "The anchoring load acts behind the front, the advancing load ahead of it. Each position of the slider is an equilibrium "
    "that is stored with the book.",
)

# %% [markdown]
# ## The worm: a material that keeps its volume
#
# A worm is filled with fluid, and thin walls divide it into many chambers. So each slice keeps its volume:
#
# $$
# \mu_1 \mu_2 \mu_3 = 1 . \tag{2.4.1}
# $$
#
# The fluid presses on the walls as much as this needs. In the equations the pressure is a new unknown, the multiplier
# $\lambda_c^I$ [N], and the forces are
#
# \begin{equation*}
# \begin{aligned}
# \mathbf{k}^1 &= \left[ k_I (2\mu_1 + \mu_2 - 3) + \lambda_c^I / \mu_1 \right] \mathbf{E}_1 , \\
# \mathbf{k}^2 &= \left[ k_I (2\mu_2 + \mu_1 - 3) + \lambda_c^I / \mu_2 \right] \mathbf{E}_2 , \\
# \mathbf{n} &= \lambda_c^I \mu_1 \mu_2 \, \mathbf{e}_3 , \qquad \mathbf{m}^\alpha = k_G \mu'_\alpha \mathbf{E}_\alpha .
# \end{aligned} \tag{2.4.4}
# \end{equation*}
#
# Only Young's modulus is left in the two stiffnesses, because a material that keeps its volume has $\nu = 1/2$:
#
# $$
# k_I = \tfrac{2}{3} E \pi R^2 , \tag{2.6.17}
# $$
#
# $$
# k_G = \tfrac{1}{12} E \pi R^4 . \tag{2.6.22}
# $$
#
# The same four steps lead to the equations of the worm. The groups $\tilde{m}$ and $\tilde{c}$ are as before, and
#
# \begin{equation*}
# \begin{aligned}
# \tilde{i} &= k_I \, \ell_0^2 / k_G , && \text{stretch over its gradient} \\
# \tilde{\delta} &= \bar{D} \, \ell_0^2 / k_G , && \text{longitudinal muscles}
# \end{aligned} \tag{2.4.9}
# \end{equation*}
#
# are new. With $\tilde{\lambda}_c^I = \lambda_c^I \ell_0^2 / k_G$ an advancing region has
#
# \begin{equation*}
# \begin{aligned}
# \frac{d^2\mu_1}{d\tilde{z}^2} &= \tilde{c} + \tilde{m} + \tilde{\lambda}_c^I / \mu_1 + \tilde{i} (2\mu_1 + \mu_2 - 3) , \\
# \frac{d^2\mu_2}{d\tilde{z}^2} &= \tilde{c} + \tilde{\lambda}_c^I / \mu_2 + \tilde{i} (2\mu_2 + \mu_1 - 3) , \\
# \frac{d\tilde{\lambda}_c^I}{d\tilde{z}} &= -\tilde{\lambda}_c^I \left( \frac{1}{\mu_1} \frac{d\mu_1}{d\tilde{z}} + \frac{1}{\mu_2}
# \frac{d\mu_2}{d\tilde{z}} \right) .
# \end{aligned} \tag{2.4.13}
# \end{equation*}
#
# The third line is the balance of forces, and it can be solved at once: $\tilde{\lambda}_c^I \mu_1 \mu_2$ is constant, because it is
# the contact force, and no load acts on the centreline here. An anchoring region has the same equations without $\tilde{c}$, and
# its muscles give the constant:
#
# $$
# \lambda_c^I = -\frac{\bar{D}}{\mu_1 \mu_2} . \tag{2.4.7}
# $$

# %% tags=["remove-input"]
page.misprint("E2.5", "E2.11")

# %% tags=["remove-input"]
page.excerpt("cosserat.peristalsis.equations.incompressible", "mu_3[k] =", "df[k, 0, 0]")

# %% [markdown]
# The numbers that the thesis prints for the worm contain the misprint of E2.5. The library computes both forms, and the rows of
# the results table say which number belongs to which form.
#
# ## Regions and junctions
#
# The body has no gap at a junction, so the stretches are continuous there. No single load acts on the directors there, so
# their couples $\mathbf{m}^\alpha$ and with them the gradients are continuous too. At the two ends nothing pulls on the
# directors:
#
# $$
# \frac{d\mu_\alpha}{d\tilde{z}}(\tilde{z} = 0) = 0, \quad \frac{d\mu_\alpha}{d\tilde{z}}(\tilde{z} = 1) = 0 . \tag{2.3.13}
# $$

# %% tags=["remove-input"]
page.misprint("E2.4", "E2.8")

# %% [markdown]
# The contact force needs a rule of its own, and the thesis has two. In the robot it jumps to zero where an advancing
# region begins: the row of longitudinal muscles ends there with its whole force. In the worm it is continuous, so advancing
# regions carry $-\bar{D}$ as well. The library computes each body by the rule of its own section; the key
# `loads.advancing_force` takes the other one. An advancing region at an end of the body has one junction only, and the
# contact force is continuous there.

# %% tags=["remove-input"]
page.misprint("E2.10", "E2.12")

# %% [markdown]
# Any sequence of regions can be computed. Here the worm has five regions of equal length:

# %%
muscles = cosserat.case("worm").problem.loads
sequence = ["anchoring", "advancing", "anchoring", "advancing", "anchoring"]
regions = [
    {"begin": number / 5, "end": (number + 1) / 5, "load": load} for number, load in enumerate(sequence)
]
worm = cosserat.case("worm_at_rest").vary(
    "five",
    loads={"anchoring": muscles.anchoring, "advancing": muscles.advancing},
    regions=regions,
)
five = cosserat.run(worm)

# %% tags=["remove-input"]
page.figure(
    "fig_five_regions",
    "The worm of these lines. Look at (b): each stretch has only two values, one in anchoring and one in advancing regions, "
    "however long the regions are. $\\mu_1$ is a little below $\\mu_2$, because the weight flattens the sections. Look at (c): the "
    "whole layer is about as long as the body is thick.",
)

# %% [markdown]
# The folded cell checks that all regions of one kind have the same plateau, that the product of the stretches is one, and that
# the second differences of a finer state are the right-hand sides of (2.4.13).

# %% tags=["hide-cell"]
middles = five.mu_3.sel(section=[25, 75, 125, 175, 225]).to_numpy()
assert np.ptp(middles[[0, 2, 4]]) < 1e-6
assert np.ptp(middles[[1, 3]]) < 1e-6
assert np.allclose(five.mu_1 * five.mu_2 * five.mu_3, 1, rtol=1e-14)
print(f"mu_3 is {middles[0]:.2f} in anchoring and {middles[1]:.2f} in advancing regions.")

fine = cosserat.run(worm.vary("fine", sections=20001, mesh={"elements": 12}))
mu_1, mu_2, thin = (fine[name].to_numpy() for name in ("mu_1", "mu_2", "advancing"))
crawler = worm.problem.crawler
k_i, k_g = crawler.incompressible_stiffnesses
square = crawler.length**2 / k_g
m = crawler.radius * crawler.line_density * muscles.gravity * square
c = muscles.advancing * np.pi * crawler.radius**2 * square
i, multiplier = k_i * square, -muscles.anchoring * square / (mu_1 * mu_2)
inside = thin[2:] == thin[:-2]
for own, other, weight in ((mu_1, mu_2, m), (mu_2, mu_1, 0)):
    right = c * thin + weight + multiplier / own + i * (2 * own + other - 3)
    second = (own[2:] - 2 * own[1:-1] + own[:-2]) * (own.size - 1) ** 2
    assert np.abs(second - right[1:-1])[inside].max() < 1e-4 * i

# %% [markdown]
# Two regions are enough to see what each muscle does. Tension acts in the rear half, pressure in the front half:

# %% tags=["remove-input"]
page.explore(
    "explore_muscles",
    "Heights are drawn three times as large. Look at the right: the same pressure makes the body longer if the tension is small, "
    "because the contact force of the tension compresses the front half as well.",
)

# %% [markdown]
# ## The pressure inside
#
# The constraint carries a part of the force on a section. This part over the area of the section at rest is the pressure of the
# fluid in the body, the coelomic pressure:
#
# $$
# p_{coelom} = -\frac{\lambda^I \mu_1 \mu_2}{\pi R^2} , \tag{2.8.8}
# $$
#
# $$
# \lambda^I = \lambda_c^I - k_I (2 - \mu_1 - \mu_2) . \tag{2.8.9}
# $$
#
# $\lambda_c^I$ contains a part of the elastic force, which (2.8.9) takes away. The next chapter compares this pressure with
# measured ones.
#
# ## Two solvers
#
# The thesis writes the equations as a first-order system, maps all regions to one domain and solves them by
# collocation: the unknowns are polynomials, piece by piece, that satisfy the equations at chosen points. The
# library has this method as a reference (`solver = "collocation"`, SciPy's `solve_bvp`). A stride consists of a hundred
# such problems, so the library has a faster one for daily work. It divides the body into elements that are short in the layers.
# The stretches are polynomials in each element, given by their values at some points, the nodes. The polynomial $v_k$
# is 1 at node $k$ and 0 at all others, and for each $k$
#
# $$
# \int_0^1 \left( \frac{d\mu_\alpha}{d\tilde{z}} \frac{dv_k}{d\tilde{z}} + f_\alpha(\mu_1, \mu_2) \, v_k \right) d\tilde{z} = 0 ,
# $$
#
# where $f_\alpha$ is the right-hand side of (2.3.6), (2.3.9) or (2.4.13). The conditions (2.3.13) are contained in this form. The
# integral is a sum over the nodes, so each node needs the equations of its own region only. Newton's method solves
# these equations: it replaces them by linear ones, solves those, and repeats this. It starts from the state
# of the previous instant. The two solvers share the equations and nothing else, so their agreement checks both:

# %% tags=["remove-input"]
lines = []
for name, other, what in (
    ("worm", "worm_reference", "the worm, over a stride"),
    ("soft_robot", "soft_robot_reference", "the robot, over a cycle"),
):
    banded, reference = page.data(name), page.data(other)
    at = [int(np.abs(banded.time.to_numpy() - t).argmin()) for t in reference.time.to_numpy()]
    largest = max(
        float(np.abs(banded[key].to_numpy()[at] - reference[key].to_numpy()).max())
        for key in ("mu_1", "mu_2", "mu_3")
    )
    assert largest < 1e-6
    lines.append((what, f"{len(at)}", page.tens(largest)))
page.table(lines, ("body", "instants", "largest difference of a stretch"))

# %% tags=["remove-input"]
page.misprint("E2.2", "E2.9")

# %% [markdown]
# `cosserat speed` times a stride with both solvers on your machine. Both raise an error if they do not converge.
#
# ## Loads that are too strong
#
# A load that is strong enough would press a section to nothing. The library refuses such a load before it solves
# anything, and the message names the
# load and the remedy:

# %%
crushing = {"advancing": "30 kPa", "advancing_force": "none"}
try:
    cosserat.run(worm.vary("crushed", loads=crushing))
except cosserat.InputError as error:
    print(error)

# %% [markdown]
# The second limit is the tilt of the centreline. Where the body becomes thinner, the centreline goes down towards the ground.
# The angle $\theta$ between the centreline and the ground has
#
# $$
# \sin\theta = \frac{R \mu'_1}{\mu_3} . \tag{2.5.5}
# $$
#
# If this reaches one, the surface cannot stay on the ground, and the library raises an error. The thesis expects the ratio to be
# small. It is not small in the layers, as the table shows. Because sections stay upright, the true volume of a slice is
# $\mu_1 \mu_2 \mu_3 \cos\theta$, so the layers lose some volume. Outside the layers nothing is lost.

# %% tags=["remove-input"]
lines = []
for name, what in (("worm", "worm"), ("soft_robot", "robot")):
    run = page.data(name)
    length, radius = float(run.xi_section[-1]), cosserat.case_of(run).problem.crawler.radius
    sine = radius * np.abs(run.mu_1_slope / run.mu_3)
    cosine = np.sqrt(1 - sine**2)
    lost = float((1 - cosine).mean())
    lines.append((what, f"{float(sine.max()):.2f}", f"{float(cosine.min()):.2f}", f"{100 * lost:.1f} %"))
page.table(
    lines,
    (
        "body",
        "largest sine of the tilt at a stored section",
        "smallest true volume of a slice over $\\mu_1\\mu_2\\mu_3$",
        "lost by the whole body",
    ),
)

# %% tags=["remove-input"]
page.misprint("E2.19")

# %% [markdown]
# ## Is one material the limit of the other?
#
# Rubber has a Poisson's ratio just below one half and is often called incompressible. So one may hope that the robot with
# $\nu \to 1/2$ becomes the worm. But there $\mu_1 + \mu_2 + \mu_3 = 3$ holds in the robot and $\mu_1 \mu_2 \mu_3 = 1$ in the worm,
# and these agree for small strains only. Two questions remain: how fast do the two bodies approach each other under small
# loads, and how far apart are they under large ones? In the folded cell both bodies have the dimensions of the worm, the rule of
# section 2.4 for the contact force, and a fraction of the loads and of the weight of the worm.

# %% tags=["hide-cell"]
THREE = [
    {"begin": 0.0, "end": 0.25, "load": "anchoring"},
    {"begin": 0.25, "end": 0.75, "load": "advancing"},
    {"begin": 0.75, "end": 1.0, "load": "anchoring"},
]


def stretches(fraction, **material):
    """mu_1 and mu_2 of a worm of a material under a fraction of its loads."""
    loads = {
        "anchoring": fraction * muscles.anchoring,
        "advancing": fraction * muscles.advancing,
        "gravity": fraction * muscles.gravity,
        "advancing_force": "continuous",
    }
    case = cosserat.case("worm_at_rest").vary(
        "body", crawler={"material": material}, loads=loads, regions=THREE, sections=2001
    )
    return np.array([cosserat.run(case)[name] for name in ("mu_1", "mu_2")])


def difference(poisson, fraction):
    """Largest difference of a stretch between a robot of that Poisson's ratio and the worm."""
    robot = stretches(fraction, kind="compressible", young="2 kPa", poisson=poisson)
    return np.abs(robot - stretches(fraction, kind="incompressible", young="2 kPa")).max()


gaps, fractions = np.array([1e-2, 1e-3, 1e-4]), np.array([1, 2, 4]) / 80
small = np.array([difference(0.5 - gap, 1e-6) for gap in gaps])
limit = np.array([difference(0.5 - 1e-7, fraction) for fraction in fractions])
by_gap = np.polyfit(np.log(2 * gaps), np.log(small), 1)[0]
by_load = np.polyfit(np.log(fractions), np.log(limit), 1)[0]
assert abs(by_gap - 1) < 0.01
assert abs(by_load - 2) < 0.01

# %% tags=["remove-input"]
page.text(
    f"Under a millionth of the loads the difference of a stretch falls with the power {by_gap:.2f} of $1 - 2\\nu$: there the worm "
    f"is the limit. At the limit itself, the difference grows with the power {by_load:.2f} of the load, because the sum and the "
    f"product differ by products of two strains. Under a twentieth of the loads it is {100 * limit[-1]:.2f} %, and under the full "
    f"loads {100 * difference(0.5 - 1e-7, 1.0):.0f} %. So a nearly incompressible robot does not replace the worm."
)

# %% [markdown]
# ## The shape on the ground
#
# The stretches give the shape. Each section stands on the ground, so its centre is at the height of its stretched radius. Let
# $x$ be the height of the centreline above its height at rest. The distance of two sections along the ground is the
# sum of the level parts of the
# centreline between them. The position of the anchored section $\xi_A$ is known:
#
# $$
# x(\xi) = R \, (\mu_1(\xi) - 1) , \tag{2.5.7}
# $$
#
# $$
# z(\xi) - z(\xi_A) = \int_{\xi_A}^{\xi} \sqrt{\mu_3^2 - R^2 {\mu'_1}^2} \, d\bar{\xi} . \tag{2.5.8}
# $$

# %% tags=["remove-input"]
page.excerpt("cosserat.problems.crawler.CrawlerProblem.length_along", "tilt = profile.slope")

# %% [markdown]
# This is the shape at one instant. In the next chapter the muscles change from instant to instant, and the body moves.
#
# ## Exercises
#
# :::{admonition} Exercise 2.1: a force for a given stretch
# :class: exercise
# A worm without weight lies in one anchoring region, so all of it is a plateau. Which force $\bar{D}$ of the longitudinal muscles
# shortens it to nine tenths of its length? Use (2.4.7) and (2.4.13), and check the answer with the library.
# :::

# %% tags=["hide-cell"]
# With mu_1 = mu_2 = mu and mu_3 = 1 / mu^2 the plateau has 0 = -D / mu^3 + 3 k_I (mu - 1).
crawler = cosserat.case("worm_at_rest").problem.crawler
k_i = 2 / 3 * crawler.material.young * np.pi * crawler.radius**2
fat = 0.9 ** (-1 / 2)
pull = 3 * k_i * (fat - 1) * fat**3
short = cosserat.run(
    cosserat.case("worm_at_rest").vary("short", loads={"anchoring": pull, "gravity": 0})
)
assert np.allclose(short.mu_3, 0.9, atol=1e-9)
print(f"The force is {1e3 * pull:.1f} mN, and the section becomes {fat:.2f} times as thick.")

# %% [markdown]
# :::{admonition} Exercise 2.2: the plateaus of the robot
# :class: exercise
# Show from (2.3.2) and (2.6.20) that a robot without weight has $\mu_3 = 1 - \bar{D}/(E \pi R^2)$ in an anchoring region,
# as a bar under compression, and $\mu_3 = 1 + 2\nu p/E$, $\mu_1 = \mu_2 = 1 - (1 - \nu) p/E$ in an advancing one. Compare
# with the state of the check above, computed again without weight.
# :::

# %% tags=["hide-cell"]
# Anchoring: k^1 = k^2 = 0 and n = -D.  Advancing: k^1 = k^2 = -p pi R^2 and n = 0.  Each is three linear equations.
stiffness = k_p + np.diag([k_s - k_p] * 3)
section = np.pi * body.radius**2
young, poisson = body.material.young, body.material.poisson
anchored = 1 + np.linalg.solve(stiffness, [0, 0, -loads.anchoring])
advanced = 1 + np.linalg.solve(stiffness, [-loads.advancing * section] * 2 + [0])
assert np.isclose(anchored[2], 1 - loads.anchoring / (young * section))
strains = loads.advancing / young * np.array([poisson - 1, poisson - 1, 2 * poisson])
assert np.allclose(advanced - 1, strains)
light = cosserat.run(posture.vary("light", loads={"gravity": 0}))
middle = light.sizes["section"] // 2
assert np.allclose([light[f"mu_{k}"][middle] for k in (1, 2, 3)], advanced, atol=2e-3)
assert np.allclose([light[f"mu_{k}"][0] for k in (1, 2, 3)], anchored, atol=2e-3)

# %% [markdown]
# :::{admonition} Exercise 2.3: the length of a layer
# :class: exercise
# Without weight $\mu_1$ and $\mu_2$ are equal. Over which length does the robot pass into its plateau? Read the slope of
# $\log|\mu_1 - \mu_1^{plateau}|$ from the computed state, and compare it with $R/\sqrt{8(1 + 2\tilde{p})}$.
# :::

# %% tags=["hide-cell"]
xi, stretch = light.xi_section.to_numpy(), light.mu_1.to_numpy()
after = slice(6200, 7200)  # sections of 20001; the junction is at section 6000
slope = np.polyfit(xi[after], np.log(stretch[after] - stretch[middle]), 1)[0]
expected = body.radius / np.sqrt(8 * (1 + 2 * p))
assert abs(-1 / slope / expected - 1) < 0.01
print(f"Measured: {-1e3 / slope:.2f} mm.  Expected: {1e3 * expected:.2f} mm.")
