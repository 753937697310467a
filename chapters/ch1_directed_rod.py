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
# directors say how each of them is stretched, sheared and turned. The material points of the body stand at
#
# $$
# \mathbf{r}^* = \mathbf{r} + X^\beta \mathbf{d}_\beta , \tag{1.3.4}
# $$
#
# with $X^1, X^2$ the place in the section: plane sections stay plane, and each deforms homogeneously. With
# $\mathbf{d}_3 = \mathbf{r}'$ the stretches are
#
# $$
# \mu_i = \|\mathbf{d}_i\| , \tag{1.3.6}
# $$
#
# $$
# \mu'_\alpha = \frac{\mathbf{d}_\alpha \cdot \mathbf{d}'_\alpha}{\|\mathbf{d}_\alpha\|} . \tag{1.3.7}
# $$

# %% tags=["remove-cell"]
import numpy as np

from cosserat.book import page
from cosserat.figures import chapter1
from cosserat.models import directed_rod

# %% tags=["remove-input"]
page.figure(
    "fig_directed_rod",
    "The soft robot of the next chapter, its front half thinned by circular muscles: lateral surface, centreline and "
    "directors are one stored state of the library.",
)

# %% tags=["remove-input"]
page.source(chapter1.surface)

# %% [markdown]
# ## What a section costs
#
# The measures of deformation, zero in a straight reference and under rotation, are
#
# $$
# \gamma_{ij} = \mathbf{d}_i \cdot \mathbf{d}_j - \mathbf{D}_i \cdot \mathbf{D}_j , \qquad
# \kappa_{\alpha i} = \mathbf{d}'_\alpha \cdot \mathbf{d}_i - \mathbf{D}'_\alpha \cdot \mathbf{D}_i . \tag{1.2.19}
# $$
#
# Put $\mathbf{r}^*$ into the energy of linear elasticity and integrate over the section, about any centreline and any axes,
# with its moments $S^\alpha = \int X^\alpha dA$ and $I^{\alpha\beta} = \int X^\alpha X^\beta dA$:
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
# With the centreline through the centre of the section and the directors along its principal axes, $S^\alpha$ and $I^{12}$
# vanish, and there remains
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
page.source(directed_rod.integrated_stiffnesses)

# %% tags=["remove-input"]
page.source(directed_rod.offset_energy)

# %% [markdown]
# Tests recover all of it by Gauss's rule over a rectangle, for random deformations: (1.2.94) about the centre, (1.2.93) off
# it and turned, where stretching and bending couple. These stiffnesses are too high in bending and torsion, because real
# sections do not stay plane; the thesis adds a term,
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
# corrects shear by a factor, $k_5 = k_6 = k \mu A$, and takes from exact solutions
#
# \begin{equation*}
# \begin{aligned}
# k_{12} = k_{13} &= \tfrac14 (\mu I_2 + \mu I_1 + \mathcal{D}) , \quad k_{14} = E I_2 , \quad k_{15} = E I_1 , \\
# k_{16} &= \tfrac12 (\mu I_2 + \mu I_1 - \mathcal{D})
# \end{aligned} \tag{1.2.98}
# \end{equation*}
#
# with the torsional rigidity $\mathcal{D}$, whose sign in the first is corrected (erratum E1.1); the others stay as they
# are, $k_{11}$ with $I_1$ (erratum E1.2).

# %% tags=["remove-input"]
page.source(directed_rod.adjusted_stiffnesses)

# %%
circle = directed_rod.Section.circle(0.01)
k = directed_rod.adjusted_stiffnesses(2e9, 0.3, circle, 0.9)
twist = np.array([[0, 1.0, 0], [-1.0, 0, 0]])  # d_1' = e_2, d_2' = -e_1: one radian per metre
_, shear = directed_rod.lame(2e9, 0.3)
stored = 2 * directed_rod.strain_energy(k, np.zeros((3, 3)), twist)
print(
    f"a twisted circle stores {stored / (shear * circle.torsion_constant):.3f} of what torsion theory says;"
)
polar, torsion = shear * 2 * circle.second_moment_1, shear * circle.torsion_constant
k[12] = k[13] = (polar - torsion) / 4
print(f"with the printed sign of D, {2 * directed_rod.strain_energy(k, np.zeros((3, 3)), twist):.3f}.")

# %% tags=["remove-cell"]
assert abs(stored / (shear * circle.torsion_constant) - 1) < 1e-12

# %% [markdown]
# ## Forces are gradients
#
# Contact force, intrinsic and contact director forces are the gradients of the energy by $\mathbf{r}'$,
# $\mathbf{d}_\alpha$ and $\mathbf{d}'_\alpha$. Where the energy is a function of stretches alone, they follow from
#
# \begin{equation*}
# \begin{aligned}
# \frac{\partial \mu_j}{\partial \mathbf{d}_i} &= \delta_i^j \mathbf{e}_j , \\
# \frac{\partial \mu'_\beta}{\partial \mathbf{d}_\alpha} &= \delta_\beta^\alpha
# (\mathbf{I} - \mathbf{e}_\beta \otimes \mathbf{e}_\beta) \frac{\mathbf{d}'_\beta}{\mu_\beta} , \\
# \frac{\partial \mu'_\beta}{\partial \mathbf{d}'_\alpha} &= \delta_\beta^\alpha \mathbf{e}_\beta
# \end{aligned} \tag{1.3.19}
# \end{equation*}

# %% tags=["remove-input"]
page.source(directed_rod.stretch_gradients)

# %% [markdown]
# and the chain rule:
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
page.source(directed_rod.internal_forces)

# %% [markdown]
# Tests compare both with differences of an energy. The second term of the first vanishes where directors only change their
# lengths, as they do in the next chapter. What does not follow from this theory is also worth saying: sections that warp,
# or bend across themselves, are not homogeneous, and the thesis reports poor agreement there.
#
# ## Where the page errs

# %% tags=["remove-input"]
page.table(
    [(name, entry.where, entry.why) for name, entry in page.errata().items() if name.startswith("E1.")],
    ("entry", "where", "why"),
)
