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
# # Chapter 1: the directed rod
#
# A rod is a curve $\mathbf{r}(\xi)$ whose points carry two directors. The curve says where the cross-sections are; the
# directors say how each of them is stretched, sheared and rotated. This chapter gives the strains of such a rod, the energy
# that pays for them, the forces that follow from the energy, what a constraint does to them, and the inertia. If you have not
# met a director before, begin with [From beams to directed rods](beams_to_rods.ipynb).
#
# :::{admonition} After this chapter you can
# :class: objectives
#
# * read the energy of a directed rod term by term, and say where each stiffness comes from;
# * derive contact forces and director forces from an energy, and check that they balance;
# * say why a constraint may enter before or after the derivatives;
# * compute the momenta of a section, also about an axis that does not pass through its centre.
# :::
#
# ## Signs and symbols
#
# * The unloaded rod is straight and lies along the unit vector $\mathbf{E}_3$; $\mathbf{E}_1$ and $\mathbf{E}_2$ are across it.
#   The arc length $\xi$ of the unloaded rod names its points: $\mathbf{R} = \xi \mathbf{E}_3$ (1.3.1). Its directors are
#   $\mathbf{D}_1 = \mathbf{E}_1$ and $\mathbf{D}_2 = \mathbf{E}_2$ (1.3.2). Small letters are the loaded rod: $\mathbf{r}$,
#   $\mathbf{d}_1$, $\mathbf{d}_2$.
# * A prime is a derivative by $\xi$, and a dot one by time. For short, $\mathbf{d}_3 = \mathbf{r}'$ and
#   $\mathbf{D}_3 = \mathbf{R}' = \mathbf{E}_3$.
# * Greek indices $\alpha, \beta, \gamma$ are 1 or 2, Latin indices $i, j$ are 1, 2 or 3. An index that appears twice in a
#   product is summed, unless an equation says *no sum*.
# * $\mathbf{e}_i = \mathbf{d}_i / \|\mathbf{d}_i\|$ is the direction of a director: a unit vector.
# * $\rho_0$ is the mass per length of the unloaded rod, in kg/m, and $\psi$ the elastic energy per mass. So $\rho_0 \psi$ is the
#   energy per length, in J/m. The thesis also calls it $w$.
# * A function of the directors wears a hat, and the same quantity as a function of the stretches a tilde:
#   $w = \hat{w}(\mathbf{d}_i, \mathbf{d}'_\alpha) = \tilde{w}(\mu_i, \mu'_\alpha)$.
# * $\lambda$ and $\mu$ are the moduli of Lamé, in Pa; $\mu$ alone, without an index, is the shear modulus. With an index,
#   $\mu_i$ is a stretch. $E$ is Young's modulus, $\nu$ Poisson's ratio.
#
# ## Where the material is
#
# A material point has the coordinates $X^1, X^2$ in its section, in m. Its place in the loaded rod is
#
# $$
# \mathbf{r}^* = \mathbf{r} + X^\beta \mathbf{d}_\beta . \tag{1.3.4}
# $$
#
# This is the main assumption of the theory. The place is linear in $X^\beta$: plane sections stay plane, straight lines in a
# section stay straight, and all parts of a section stretch and shear alike. The slenderer the body, the
# better this is. Sections that warp or bend are out of reach, and the thesis reports poor agreement for them.

# %% tags=["remove-cell"]
import numpy as np

from cosserat.figures.deformations import DEFORMATIONS
from cosserat.rods import constrained_rod, directed_rod
from cosserat.thesis.book import page

# %% tags=["remove-input"]
page.figure(
    "fig_directed_rod",
    "The soft robot of the next chapter, its front half thinned by circular muscles: lateral surface, centreline and "
    "directors are one stored state of the library, magnified across the axis.",
)

# %% [markdown]
# The code of this picture is the equation. It takes points on the boundary of the round section, and adds their
# coordinates times the directors to the centreline:

# %% tags=["remove-input"]
page.excerpt("cosserat.thesis.figures.chapter1.surface", "x_1, x_2 = ", "return points")

# %% [markdown]
# The length of a director is a stretch. $\mu_1$ and $\mu_2$ say how high and how wide a section is compared with its reference,
# and $\mu_3$ how long the centreline is:
#
# $$
# \mu_i = \|\mathbf{d}_i\| . \tag{1.3.6}
# $$
#
# The derivatives of the first two say how quickly a section becomes fatter along the rod. They follow from
# $\mu_\alpha^2 = \mathbf{d}_\alpha \cdot \mathbf{d}_\alpha$:
#
# $$
# \mu'_\alpha = \frac{\mathbf{d}_\alpha \cdot \mathbf{d}'_\alpha}{\|\mathbf{d}_\alpha\|} . \tag{1.3.7}
# $$
#
# ## The strains
#
# Lengths are not enough: directors may also be inclined to each other. The measures of strain compare all scalar
# products with those of the reference,
#
# $$
# \gamma_{ij} = \mathbf{d}_i \cdot \mathbf{d}_j - \mathbf{D}_i \cdot \mathbf{D}_j , \qquad
# \kappa_{\alpha i} = \mathbf{d}'_\alpha \cdot \mathbf{d}_i - \mathbf{D}'_\alpha \cdot \mathbf{D}_i . \tag{1.2.19}
# $$
#
# All are zero in the reference. A rotation of the whole rod changes no scalar product, so it changes no strain. The previous page
# shows what each of them does to a section.
#
# ## The energy of a section
#
# The rod is made of an elastic material. Insert (1.3.4) into the energy of linear elasticity and integrate over the section.
# Only the dependence on $X^\alpha$ must be integrated, and this gives moments of the section: the area $A$, the first moments
# $S^\alpha = \int X^\alpha dA$ and the second ones $I^{\alpha\beta} = \int X^\alpha X^\beta dA$. About any centreline and
# any axes the result is
#
# \begin{equation*}
# \begin{aligned}
# \rho_0 \bar{\psi} = {}& \tfrac18 (\lambda + 2\mu) A (\gamma_{11}^2 + \gamma_{22}^2 + \gamma_{33}^2) \\
# & + \tfrac12 \mu A \left( \tfrac14 (\gamma_{21} + \gamma_{12})^2 + \gamma_{13}^2 + \gamma_{23}^2 \right) \\
# & + \tfrac14 \lambda A (\gamma_{11}\gamma_{22} + \gamma_{11}\gamma_{33} + \gamma_{22}\gamma_{33}) \\
# & + \tfrac12 \mu I^{11} (\kappa_{11}^2 + \kappa_{12}^2) + \tfrac12 \mu I^{22} (\kappa_{22}^2 + \kappa_{21}^2) \\
# & + \tfrac12 (\lambda + 2\mu) (I^{11} \kappa_{13}^2 + I^{22} \kappa_{23}^2) \\
# & + \mu I^{12} (\kappa_{11}\kappa_{21} + \kappa_{12}\kappa_{22}) + (\lambda + 2\mu) I^{12} \kappa_{13}\kappa_{23} \\
# & + \tfrac12 \lambda (\gamma_{11} + \gamma_{22} + \gamma_{33}) (S^1 \kappa_{13} + S^2 \kappa_{23}) \\
# & + \mu S^1 (\gamma_{33}\kappa_{13} + \gamma_{13}\kappa_{11} + \gamma_{23}\kappa_{12}) \\
# & + \mu S^2 (\gamma_{33}\kappa_{23} + \gamma_{13}\kappa_{21} + \gamma_{23}\kappa_{22}) .
# \end{aligned} \tag{1.2.93}
# \end{equation*}
#
# Read it by lines. The first three are a section that is stretched and sheared as a whole; they have the area. The
# next three are sections that differ from their neighbours, in taper, twist and bending; they have second moments. The last
# three couple both, and have first moments: if the centreline is not in the centre, a pull also bends the rod.
# The function that computes the last four lines is short:

# %% tags=["remove-input"]
page.excerpt(directed_rod.offset_energy, "first, shear =")

# %% [markdown]
# If the centreline passes through the centre of the section and the directors are along its principal axes, $S^\alpha$ and
# $I^{12}$ vanish. Then the strains are coupled only by Poisson's ratio, in the terms with $\bar{k}_7$ to $\bar{k}_9$:
#
# \begin{equation*}
# \begin{aligned}
# 2 \rho_0 \bar{\psi} = {}& \bar{k}_1 \gamma_{11}^2 + \bar{k}_2 \gamma_{22}^2 + \bar{k}_3 \gamma_{33}^2 \\
# & + \tfrac14 \bar{k}_4 (\gamma_{21} + \gamma_{12})^2 + \bar{k}_5 \gamma_{13}^2 + \bar{k}_6 \gamma_{23}^2 \\
# & + \bar{k}_7 \gamma_{11}\gamma_{22} + \bar{k}_8 \gamma_{11}\gamma_{33} + \bar{k}_9 \gamma_{22}\gamma_{33} \\
# & + \bar{k}_{10} \kappa_{11}^2 + \bar{k}_{11} \kappa_{22}^2 + \bar{k}_{12} \kappa_{12}^2 + \bar{k}_{13} \kappa_{21}^2 \\
# & + \bar{k}_{14} \kappa_{13}^2 + \bar{k}_{15} \kappa_{23}^2
# \end{aligned} \tag{1.2.94}
# \end{equation*}
#
# with $I_2 = I^{11}$, $I_1 = I^{22}$ and the stiffnesses
#
# \begin{equation*}
# \begin{aligned}
# \bar{k}_1 = \bar{k}_2 = \bar{k}_3 &= \tfrac14 (\lambda + 2\mu) A , \\
# \bar{k}_4 = \bar{k}_5 = \bar{k}_6 &= \mu A , \\
# \bar{k}_7 = \bar{k}_8 = \bar{k}_9 &= \tfrac12 \lambda A , \\
# \bar{k}_{10} = \bar{k}_{12} &= \mu I_2 , \quad \bar{k}_{11} = \bar{k}_{13} = \mu I_1 , \\
# \bar{k}_{14} &= (\lambda + 2\mu) I_2 , \quad \bar{k}_{15} = (\lambda + 2\mu) I_1 .
# \end{aligned} \tag{1.2.95}
# \end{equation*}

# %% tags=["remove-input"]
page.excerpt(directed_rod.integrated_stiffnesses, "stretch =")

# %% [markdown]
# The factors are no accident. $\gamma_{33}$ is twice the engineer's strain, so its square takes a quarter of
# $\lambda + 2\mu$, and $\gamma_{13}$ is the engineer's shear angle, so it takes $\mu$ itself. Tests check both energies by
# Gauss's rule over a rectangle, for random deformations: (1.2.94) about the centre, (1.2.93) off the centre and with rotated
# axes.
#
# ## Better stiffnesses
#
# These stiffnesses are too high in bending, twist and shear, because real sections do not stay plane and are free to contract.
# The form of the energy is kept, with one more term for the twist,
#
# \begin{equation*}
# \begin{aligned}
# 2 \rho_0 \psi = {}& k_1 \gamma_{11}^2 + k_2 \gamma_{22}^2 + k_3 \gamma_{33}^2 \\
# & + \tfrac14 k_4 (\gamma_{21} + \gamma_{12})^2 + k_5 \gamma_{13}^2 + k_6 \gamma_{23}^2 \\
# & + k_7 \gamma_{11}\gamma_{22} + k_8 \gamma_{11}\gamma_{33} + k_9 \gamma_{22}\gamma_{33} \\
# & + k_{10} \kappa_{11}^2 + k_{11} \kappa_{22}^2 + k_{12} \kappa_{12}^2 + k_{13} \kappa_{21}^2 \\
# & + k_{14} \kappa_{13}^2 + k_{15} \kappa_{23}^2 + k_{16} \kappa_{12}\kappa_{21} ,
# \end{aligned} \tag{1.2.97}
# \end{equation*}
#
# and four groups of stiffnesses are replaced. Shear takes a correction factor $k$, as in Timoshenko's beam:
# $k_5 = k_6 = k \mu A$. Bending takes Young's modulus, and twist the torsional rigidity $\mathcal{D}$ of an exact solution:
#
# \begin{equation*}
# \begin{aligned}
# k_{12} = k_{13} &= \tfrac14 (\mu I_2 + \mu I_1 + \mathcal{D}) , \\
# k_{14} &= E I_2 , \quad k_{15} = E I_1 , \\
# k_{16} &= \tfrac12 (\mu I_2 + \mu I_1 - \mathcal{D}) .
# \end{aligned} \tag{1.2.98}
# \end{equation*}
#
# The other stiffnesses do not change. Why does twist need $k_{16}$? Two strains take part in it, $\kappa_{12}$ and
# $\kappa_{21}$. If they are opposite, the section only rotates along the rod, and the energy must be that of a
# twisted shaft; if they are equal, the section is sheared more and more, and the elasticity of the section pays. Two
# conditions need two numbers, $k_{12}$ and $k_{16}$.

# %% tags=["remove-input"]
page.misprint("E1.1", "E1.2")

# %% tags=["remove-input"]
page.excerpt(directed_rod.adjusted_stiffnesses, "polar, torsion =")

# %% [markdown]
# Try it. A round bar is twisted by one radian per metre, and its energy is compared with that of the theory of torsion. With
# the sign that is printed for $\mathcal{D}$ in $k_{12}$, the bar could be twisted for nothing:

# %%
circle = directed_rod.Section.circle(0.01)
k = directed_rod.adjusted_stiffnesses(2e9, 0.3, circle, 0.9)
twist = np.array([[0, 1.0, 0], [-1.0, 0, 0]])  # d_1' = e_2, d_2' = -e_1: one radian per metre
_, shear = directed_rod.lame(2e9, 0.3)
torsion = shear * circle.torsion_constant
stored = 2 * directed_rod.strain_energy(k, np.zeros((3, 3)), twist)
polar = shear * 2 * circle.second_moment_1
printed = k | dict.fromkeys((12, 13), (polar - torsion) / 4)
stored_as_printed = 2 * directed_rod.strain_energy(printed, np.zeros((3, 3)), twist)
print(f"energy over that of torsion theory: {stored / torsion:.3f}")
print(f"with the printed sign of D: {stored_as_printed / torsion:.3f}")

# %% tags=["remove-cell"]
assert abs(stored / torsion - 1) < 1e-12
assert abs(stored_as_printed) < 1e-9 * torsion

# %% [markdown]
# ## Forces are gradients
#
# Three forces act inside a rod. A section acts on its neighbour with the contact force $\mathbf{n}$ and with the contact director
# forces $\mathbf{m}^\alpha$. The intrinsic director forces $\mathbf{k}^\alpha$ resist a change of the section itself. Together they
# must do the work that the energy stores, in any motion. This leaves no choice:
#
# $$
# \mathbf{n} = \frac{\partial \hat{w}}{\partial \mathbf{r}'} , \quad
# \mathbf{k}^\alpha = \frac{\partial \hat{w}}{\partial \mathbf{d}_\alpha} , \quad
# \mathbf{m}^\alpha = \frac{\partial \hat{w}}{\partial \mathbf{d}'_\alpha} . \tag{1.3.18}
# $$
#
# For the energy (1.2.97) they follow from the chain rule. Let $\Gamma_{ij}$ and $K_{\alpha i}$ be its
# derivatives by $\gamma_{ij}$ and $\kappa_{\alpha i}$, with $\Gamma_{ij} = \Gamma_{ji}$. Then
#
# $$
# \frac{\partial \hat{w}}{\partial \mathbf{d}_i} = 2 \Gamma_{ij} \mathbf{d}_j + K_{\alpha i} \mathbf{d}'_\alpha , \qquad
# \frac{\partial \hat{w}}{\partial \mathbf{d}'_\alpha} = K_{\alpha i} \mathbf{d}_i .
# $$
#
# In the code the rows of `d` are the three directors, so the sums are products of matrices:

# %% tags=["remove-input"]
page.excerpt(directed_rod.forces, "by_d =")

# %% [markdown]
# ## The forces balance by themselves
#
# The energy does not change when the rod is rotated. So in a rotation the forces do no work, and this is possible for every axis
# only if their couples cancel:
#
# $$
# \mathbf{r}' \times \mathbf{n} + \mathbf{d}_\beta \times \mathbf{k}^\beta + \mathbf{d}'_\beta \times \mathbf{m}^\beta
# = \mathbf{0} . \tag{1.2.91}
# $$
#
# In three dimensions the same argument makes the stress symmetric. A beam has the balance of moments as an equation of
# its own. A directed rod needs none: (1.2.91) holds for every state, at rest or not, and with the balances of
# director forces it gives the balance of moments. A random state shows (1.2.91):

# %%
rng = np.random.default_rng(1)
d = np.eye(3) + 0.3 * rng.uniform(-1, 1, (3, 3))
d_prime = 30 * rng.uniform(-1, 1, (2, 3))
n, intrinsic, m = directed_rod.forces(
    d, d_prime, *directed_rod.energy_gradient(k, *directed_rod.measures(d, d_prime))
)
left = np.abs(directed_rod.unbalanced_couple(d, d_prime, n, intrinsic, m)).max()
largest = np.abs(np.cross(d[2], n)).max()
print(f"the first term is up to {largest:.1e} N, the sum of all three {left:.0e} N")

# %% tags=["remove-cell"]
assert left < 1e-13 * largest

# %% [markdown]
# Tests compare the forces with exact differences of the energy and with the forces of the rotated rod. They check that in
# any motion the rate of the energy is their power (1.3.11), and that for small deformations they are integrals of the stress
# over a rectangle.
#
# ## An energy of the stretches alone
#
# A worm needs less. Its sections stay upright, and its energy in Chapter 2 is a function $\tilde{w}$ of the stretches and of
# their derivatives alone. Stretches do not change in a rotation, so any such function is allowed. The forces follow from the
# gradients of (1.3.6) and (1.3.7), in which $\delta_i^j$ is 1 if $i = j$ and else 0, $\mathbf{I}$ is the identity,
# $(\mathbf{a} \otimes \mathbf{b}) \mathbf{c} = \mathbf{a} (\mathbf{b} \cdot \mathbf{c})$, and nothing is summed:
#
# \begin{equation*}
# \begin{aligned}
# \frac{\partial \mu_j}{\partial \mathbf{d}_i} &= \delta_i^j \mathbf{e}_j , \\
# \frac{\partial \mu'_\beta}{\partial \mathbf{d}_\alpha} &= \delta_\beta^\alpha
# (\mathbf{I} - \mathbf{e}_\beta \otimes \mathbf{e}_\beta) \frac{\mathbf{d}'_\beta}{\mu_\beta} , \\
# \frac{\partial \mu'_\beta}{\partial \mathbf{d}'_\alpha} &= \delta_\beta^\alpha \mathbf{e}_\beta .
# \end{aligned} \tag{1.3.19}
# \end{equation*}
#
# The first line says that only the director itself changes its length, and most quickly along its own direction. The second one
# says that $\mu'_\beta$ also changes if the director turns away from its derivative. The chain rule gives the forces:
#
# \begin{equation*}
# \begin{aligned}
# \frac{\partial \hat{w}}{\partial \mathbf{d}_\alpha} &= \frac{\partial \tilde{w}}{\partial \mu_\alpha} \mathbf{e}_\alpha
# + \frac{\partial \tilde{w}}{\partial \mu'_\alpha} (\mathbf{I} - \mathbf{e}_\alpha \otimes \mathbf{e}_\alpha)
# \frac{\mathbf{d}'_\alpha}{\mu_\alpha} , \\
# \frac{\partial \hat{w}}{\partial \mathbf{r}'} &= \frac{\partial \tilde{w}}{\partial \mu_3} \mathbf{e}_3 , \quad
# \frac{\partial \hat{w}}{\partial \mathbf{d}'_\alpha} = \frac{\partial \tilde{w}}{\partial \mu'_\alpha} \mathbf{e}_\alpha .
# \end{aligned} \tag{1.3.20}
# \end{equation*}

# %% tags=["remove-input"]
page.excerpt(directed_rod.internal_forces, "along, turned, across =")

# %% [markdown]
# The second term of the first equation vanishes if the directors only change their lengths, as in the next chapter. Tests compare
# both equations with differences of an energy.
#
# ## A constraint may enter before or after the gradients
#
# Some bodies cannot deform freely: a worm keeps the volume of each section, and a rope keeps the length of its centreline. Such
# a rod obeys an internal constraint $\phi^I(\mathbf{r}', \mathbf{d}_\alpha, \mathbf{d}'_\alpha) = 0$. What forbids the
# deformation is a force, the *reaction*. It does no work in any motion that the constraint allows, so it is along the
# gradient of $\phi^I$. Its size is a multiplier $\lambda^I$, an unknown that the balances determine. One may take the gradients of
# $\hat{w}$ as they are and add the reaction,
#
# \begin{equation*}
# \begin{aligned}
# \mathbf{n} &= \frac{\partial \hat{w}}{\partial \mathbf{r}'} + \lambda^I \frac{\partial \phi^I}{\partial \mathbf{r}'} , \\
# \mathbf{k}^\alpha &= \frac{\partial \hat{w}}{\partial \mathbf{d}_\alpha}
# + \lambda^I \frac{\partial \phi^I}{\partial \mathbf{d}_\alpha} , \\
# \mathbf{m}^\alpha &= \frac{\partial \hat{w}}{\partial \mathbf{d}'_\alpha}
# + \lambda^I \frac{\partial \phi^I}{\partial \mathbf{d}'_\alpha} ,
# \end{aligned} \tag{1.3.26}
# \end{equation*}
#
# or first put the constraint into the energy, $\hat{w}_c = \hat{w}|_{\phi^I = 0}$ (1.3.27), as in Chapter 2. The multiplier
# is then another one:
#
# \begin{equation*}
# \begin{aligned}
# \mathbf{n} &= \frac{\partial \hat{w}_c}{\partial \mathbf{r}'} + \lambda_c^I \frac{\partial \phi^I}{\partial \mathbf{r}'} , \\
# \mathbf{k}^\alpha &= \frac{\partial \hat{w}_c}{\partial \mathbf{d}_\alpha}
# + \lambda_c^I \frac{\partial \phi^I}{\partial \mathbf{d}_\alpha} , \\
# \mathbf{m}^\alpha &= \frac{\partial \hat{w}_c}{\partial \mathbf{d}'_\alpha}
# + \lambda_c^I \frac{\partial \phi^I}{\partial \mathbf{d}'_\alpha} .
# \end{aligned} \tag{1.3.28}
# \end{equation*}
#
# The two ways differ in the code by two lines: the strain $\gamma_{33}$ is eliminated, and its derivative goes into the
# other forces.

# %% tags=["remove-input"]
page.excerpt(constrained_rod.constrained_forces, "gamma, kappa =")

# %% [markdown]
# "The resulting equations will yield the same state of deformation," says the thesis. Here is a soft bar that keeps its
# volume, twisted by a third of a radian per centimetre and pulled, or bent into a circle with a radius of three centimetres.
# It is uniform: each section is rotated into the next, $\mathbf{d}'_i = \boldsymbol{\omega} \times \mathbf{d}_i$. So the balances say
# that $\mathbf{n}$ is along $\boldsymbol{\omega}$ and that
# $\boldsymbol{\omega} \times \mathbf{m}^\alpha = \mathbf{k}^\alpha$. The unknowns are the nine components of the
# directors and the multiplier.

# %%
soft = directed_rod.adjusted_stiffnesses(1e6, 0.3, circle, 0.9)
turns = {
    "twisted and pulled": (np.array([0, 0, 33.0]), 60.0),
    "bent": (np.array([0, 33.0, 0]), 0.0),
}
found = {}
for name, (turn, pull) in turns.items():
    for form in ("after", "before"):
        found[name, form] = constrained_rod.uniform_state(
            soft, constrained_rod.INCOMPRESSIBLE, form, turn, pull
        )

# %% tags=["remove-input"]
page.table(
    [
        (name, form, *(f"{mu:.4f}" for mu in np.linalg.norm(d, axis=1)), f"{multiplier:.2f}")
        for (name, form), (d, multiplier) in found.items()
    ],
    ("bar", "constraint enters", "$\\mu_1$", "$\\mu_2$", "$\\mu_3$", "multiplier [N]"),
)

# %% tags=["remove-cell"]
differences = [np.abs(found[name, "after"][0] - found[name, "before"][0]).max() for name in turns]
assert max(differences) < 1e-12
assert all(abs(found[name, "after"][1] - found[name, "before"][1]) > 1 for name in turns)

# %% tags=["remove-input"]
page.text(
    f"The two states of each bar differ by at most {page.tens(max(differences))}. The multipliers do not agree and need not: the second "
    "contains a part of the energy's own force. So a multiplier alone is not a pressure; one must also say to which energy it was added."
)

# %% [markdown]
# ## Inertia
#
# Multiply the density by powers of $X^\alpha$ and integrate over the section, as for the energy. This gives the mass
# $\rho_0$ and the inertias $\rho_0 y_0^{0\alpha}$ and $\rho_0 y_0^{\alpha\beta}$ per length, in kg/m, kg and kg m. The centreline
# moves with the velocity $\mathbf{v} = \dot{\mathbf{r}}$, and its directors with $\mathbf{w}_\alpha = \dot{\mathbf{d}}_\alpha$.
# There is a momentum for each: the linear momentum
#
# $$
# \mathbf{G} = \rho_0 \mathbf{v} + \rho_0 y_0^{0\beta} \mathbf{w}_\beta , \tag{1.2.39}
# $$
#
# and the director momenta
#
# $$
# \mathbf{L}^\alpha = \rho_0 y_0^{0\alpha} \mathbf{v} + \rho_0 y_0^{\alpha\beta} \mathbf{w}_\beta . \tag{1.2.41}
# $$
#
# They stand on the right-hand sides of the balances of forces and of director forces when the rod moves. The kinetic energy per
# length is
#
# $$
# T = \tfrac12 (\mathbf{G} \cdot \mathbf{v} + \mathbf{L}^\beta \cdot \mathbf{w}_\beta) . \tag{1.2.43}
# $$
#
# The inertias belong to the unloaded section and do not change in time.

# %% tags=["remove-input"]
page.misprint("E1.3")

# %% [markdown]
# A section that rotates like a rigid body must have the energy of a rigid body. Its moment of inertia is
#
# $$
# \mathbf{J}_0 = \rho_0 y_0^{\beta\gamma} \left( (\mathbf{D}_\beta \cdot \mathbf{D}_\gamma) \mathbf{I}
# - \mathbf{D}_\beta \otimes \mathbf{D}_\gamma \right) . \tag{1.2.34}
# $$

# %%
centred = directed_rod.Offset(np.zeros(2), 0.0)
heavy = directed_rod.Inertia.homogeneous(1000.0, circle, centred)
omega = np.array([3.0, -1.0, 2.0])
w = np.cross(omega, np.eye(3)[:2])
turning = heavy.kinetic_energy(np.zeros(3), w)
rigid = omega @ heavy.tensor @ omega / 2
print(f"a rotating circle has {turning / rigid:.12f} times the energy of a rigid one")

# %% tags=["remove-cell"]
assert abs(turning / rigid - 1) < 1e-12

# %% [markdown]
# The bodies of Chapter 2 move so slowly that each instant is in balance, so the chapter does not need the momenta.
# Chapter 3 has the same momenta for each part of its rod.
#
# ## Exercises
#
# :::{admonition} Exercise 1.1: Which $\nu$ is allowed?
# :class: exercise
#
# An energy must be positive for every strain that is not zero, or the rod would deform by itself. For which values of Poisson's
# ratio is (1.2.97) positive? And for which is it positive with the printed sign of $\mathcal{D}$? Only two groups of strains are
# coupled: $\gamma_{11}, \gamma_{22}, \gamma_{33}$, and $\kappa_{12}, \kappa_{21}$. Write each group as a symmetric matrix, and
# look at its eigenvalues.
# :::

# %% tags=["hide-cell"]


def least_eigenvalues(k):
    """Of the stretches and of the twist; the other strains have their own stiffness each."""
    stretching = [[k[1], k[7] / 2, k[8] / 2], [k[7] / 2, k[2], k[9] / 2], [k[8] / 2, k[9] / 2, k[3]]]
    twisting = [[k[12], k[16] / 2], [k[16] / 2, k[13]]]
    return np.linalg.eigvalsh(stretching)[0], np.linalg.eigvalsh(twisting)[0]


for nu in (-1.1, -0.9, 0.0, 0.3, 0.49, 0.51):
    of_nu = directed_rod.adjusted_stiffnesses(1e6, nu, circle, 0.9)
    rigidity = directed_rod.lame(1e6, nu)[1] * circle.torsion_constant
    as_printed = of_nu | dict.fromkeys((12, 13), of_nu[12] - rigidity / 2)
    stretching, twisting = least_eigenvalues(of_nu)
    twisting_as_printed = least_eigenvalues(as_printed)[1]
    print(
        f"nu = {nu:5.2f}: {stretching:8.1f} N, {twisting:9.1e} N m^2, as printed {twisting_as_printed:8.0e}"
    )
    assert (stretching > 0 and twisting > 0) == (-1 < nu < 0.5)
    assert abs(twisting_as_printed) < 1e-12 * abs(rigidity)
# The energy is positive for nu between -1 and 1/2, as in three dimensions. As printed it is positive for no nu: the
# eigenvalue of the twist is zero.

# %% [markdown]
# :::{admonition} Exercise 1.2: The moment of a bent rod
# :class: exercise
#
# Bend the round bar so that $\kappa_{13} = 0.5$ per metre and all other strains are zero. Compute its director forces and its moment
# $\mathbf{m} = \mathbf{d}_\beta \times \mathbf{m}^\beta$ (1.2.89). About which axis does it act, and how large is it? Is the rod
# curved towards $\mathbf{E}_1$ or away from it?
# :::

# %% tags=["hide-cell"]
bent = DEFORMATIONS["bending_1"].directors(0.5, np.zeros(1))
strains = directed_rod.measures(bent[1][0], bent[2][0])
k = directed_rod.adjusted_stiffnesses(2e9, 0.3, circle, 0.9)
n, intrinsic, m = directed_rod.forces(bent[1][0], bent[2][0], *directed_rod.energy_gradient(k, *strains))
moment = directed_rod.couple(bent[1][0], m)
print("moment along E_1, E_2, E_3 in N m:", np.round(moment, 6))
print(f"E I kappa is {2e9 * circle.second_moment_2 * 0.5:.6f} N m")
# d_1' has a part along d_3: the upper ends of the sections go apart, so the rod curves away from E_1. The moment is
# that of a beam, about -E_2.
assert np.allclose(moment, [0, -2e9 * circle.second_moment_2 * 0.5, 0], rtol=1e-12, atol=1e-12)

# %% [markdown]
# :::{admonition} Exercise 1.3: An axis beside the centre
# :class: exercise
#
# Let the centreline of the round bar pass through its lateral surface, at the distance $R$ from the centre along
# $\mathbf{E}_1$. Which first and second moments does the section have now? Check that the kinetic energy of a rotation about
# $\mathbf{E}_2$ obeys Steiner's theorem of parallel axes.
# :::

# %% tags=["hide-cell"]
radius = 0.01
shifted = directed_rod.Section(
    circle.area,
    circle.second_moment_1,  # I^22, about the X^1 axis, which still passes through the centre
    circle.second_moment_2 + circle.area * radius**2,  # I^11
    circle.torsion_constant,
)
beside = directed_rod.Offset(np.array([circle.area * radius, 0.0]), 0.0)  # S^1, S^2 and I^12
eccentric = directed_rod.Inertia.homogeneous(1000.0, shifted, beside)
omega = np.array([0.0, 4.0, 0.0])
w = np.cross(omega, np.eye(3)[:2])
about_centre = heavy.kinetic_energy(np.zeros(3), w)
about_surface = eccentric.kinetic_energy(np.zeros(3), w)
steiner = about_centre + heavy.mass * (radius * omega[1]) ** 2 / 2
print(f"about the centre {about_centre:.3e} J/m, about the surface {about_surface:.3e} J/m")
assert abs(about_surface / steiner - 1) < 1e-12
# and if the centreline moves so that the centre of mass is at rest, the second term vanishes
v = -np.cross(omega, [radius, 0, 0])
assert abs(eccentric.kinetic_energy(v, w) / about_centre - 1) < 1e-12
