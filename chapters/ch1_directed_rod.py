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
# Put $\mathbf{r}^*$ into the energy of linear elasticity, integrate over the section about its centre, and there remains
# a quadratic form with the stiffnesses
#
# \begin{equation*}
# \begin{aligned}
# \bar{k}_1 = \bar{k}_2 = \bar{k}_3 &= \tfrac14 (\lambda + 2\mu) A , \quad \bar{k}_4 = \bar{k}_5 = \bar{k}_6 = \mu A , \\
# \bar{k}_7 = \bar{k}_8 = \bar{k}_9 &= \tfrac12 \lambda A , \\
# \bar{k}_{10} = \bar{k}_{12} &= \mu I_2 , \quad \bar{k}_{11} = \bar{k}_{13} = \mu I_1 , \quad
# \bar{k}_{14} = (\lambda + 2\mu) I_2 , \quad \bar{k}_{15} = (\lambda + 2\mu) I_1 .
# \end{aligned} \tag{1.2.95}
# \end{equation*}

# %% tags=["remove-input"]
page.source(directed_rod.integrated_stiffnesses)

# %% [markdown]
# A test recovers each of them by Gauss's rule over a rectangle, for random deformations. These stiffnesses are too high
# in bending and torsion, because real sections do not stay plane; the thesis replaces five of them:
#
# \begin{equation*}
# \begin{aligned}
# k_{12} = k_{13} &= \tfrac14 (\mu I_2 + \mu I_1 + \mathcal{D}) , \quad k_{14} = E I_2 , \quad k_{15} = E I_1 , \\
# k_{16} &= \tfrac12 (\mu I_2 + \mu I_1 - \mathcal{D}) .
# \end{aligned} \tag{1.2.98}
# \end{equation*}
#
# (the sign of $\mathcal{D}$ in the first is corrected, erratum E1.1).

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
# $$
# \frac{\partial \mu_j}{\partial \mathbf{d}_i} = \delta_i^j \mathbf{e}_j , \qquad
# \frac{\partial \mu'_\beta}{\partial \mathbf{d}_\alpha} = \delta_\beta^\alpha
# (\mathbf{I} - \mathbf{e}_\beta \otimes \mathbf{e}_\beta) \frac{\mathbf{d}'_\beta}{\mu_\beta} , \qquad
# \frac{\partial \mu'_\beta}{\partial \mathbf{d}'_\alpha} = \delta_\beta^\alpha \mathbf{e}_\beta . \tag{1.3.19}
# $$

# %% tags=["remove-input"]
page.source(directed_rod.stretch_gradients)

# %% [markdown]
# The second vanishes where directors only change their lengths, as they do in the next chapter. What does not follow from
# this theory is also worth saying: sections that warp, or bend across themselves, are not homogeneous, and the thesis
# reports poor agreement there.
#
# ## Where the page errs

# %% tags=["remove-input"]
page.table(
    [(name, entry.where, entry.why) for name, entry in page.errata().items() if name.startswith("E1.")],
    ("entry", "where", "why"),
)
