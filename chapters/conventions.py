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
# # What a result holds: frames, signs, forces
#
# A computed rod is stored with its positions and directors, and with what an engineer asks for: internal forces, reactions,
# energies, stresses. This page defines each of them and its sign. Problems at rest, paths and motions all have the same
# ones.

# %% tags=["remove-cell"]
from cosserat.thesis.book import page

# %% tags=["remove-input"]
page.figure(
    "fig_conventions",
    "(a) Rotations, curvatures and couples are positive from $\\mathbf{E}_3$ towards $\\mathbf{E}_2$; $\\mathbf{E}_1$ points "
    "away from the reader. (b) At a cut the part beyond acts on the part before with the normal force $N$, the shear force $Q$ "
    "and the bending moment $M$, all drawn positive. The part before acts on the part beyond with the opposite ones. (c) The "
    "stresses that beam theory makes of them.",
)

# %% [markdown]
# ## Axes
#
# A rod starts at the origin and lies along $\mathbf{E}_3$; $\mathbf{E}_2$ points up. All vectors have their components along these
# fixed axes, and not along the bent rod. So `u.sel(axis="E2")` is the deflection of a rod that is straight at rest. The direction of
# a load may be an axis, an angle or two components. A rod that stands upright is a rod along $\mathbf{E}_3$ with its gravity
# along $-\mathbf{E}_3$.
#
# ## Forces inside
#
# Cut the edge $K$ in thought, and move all that lies beyond the cut. Moving it costs strain energy $W$, and the cost per distance is
# the force at the cut. Turning it about the middle $\mathbf{c}$ of the edge costs energy per angle, and this is the moment:
#
# $$
# \mathbf{n}_K = \sum_{J > K} \frac{\partial W}{\partial \mathbf{x}_J} , \qquad
# M_K = \sum_{J > K} \left[ (\mathbf{x}_J - \mathbf{c}) \times \frac{\partial W}{\partial \mathbf{x}_J}
# + \mathbf{d}_J \times \frac{\partial W}{\partial \mathbf{d}_J} \right] .
# $$
#
# This definition needs no theory of beams, so it holds for every energy, at rest and in motion. The normal force $N$ is the part
# of $\mathbf{n}$ along the normal of the section, positive in tension. The shear force $Q$ is the part along the section. The section
# of an edge is half-way between its two directors. In a straight rod $M' = -Q$.

# %% tags=["remove-input"]
page.excerpt("cosserat.rods.resultants.resultants", "middle =", "return")

# %% [markdown]
# *Director forces.* Chapter 1 has two more: the contact director force $\mathbf{m}$ does work when the director changes along the rod,
# the intrinsic one $\mathbf{k}$ when the director itself changes. Their parts along the director stretch the section. Their parts
# across it bend and shear. In the consistent rod $\mathbf{d} \times \mathbf{m}$ is the bending moment $M$. In the published rod the
# centreline carries the moment, and $\mathbf{m}$ has only what the two gradient terms of (3.4.11) give.
#
# ## Supports
#
# A support exerts a force on its vertex, a moment on its section, and a force along the director if it holds the height of the
# section. In a motion they are those of the instant, with the mass matrix $\mathbf{M}$ and the energy of all loads that have one,
#
# $$
# \mathbf{R} = \mathbf{M} \ddot{\mathbf{q}} + \frac{\partial}{\partial \mathbf{q}} (W + W_{\text{loads}}) ,
# $$
#
# in the rows of the degrees of freedom that are held. The other rows give the accelerations, and damping acts on those alone. A
# step that is too long for a fast mode gives this mode an arbitrary phase, and the force of an instant has it too. The
# result then has a warning. Take means over some instants.
#
# ## Energy and work
#
# `strain_energy` is that above the reference, in total and by terms. `attached_energy` is that of springs. `load_potential` is minus
# the work that the loads, with their present size, would do from the reference to here.
#
# In a motion the work is added up step by step. `total_load_work` is that of all loads since the start, and `load_work` the part of
# loads that have no constant potential. `support_work` is that of supports that move, and `dissipated_energy` what damping took. The
# kinetic and the stored energy balance them. Along a path loads and supports grow slowly, and their work is added up from point to
# point by the trapezoidal rule, so it meets the stored energy to second order in the length of the arcs. A problem at rest
# stores no work: only its end is known.
#
# ## Stresses
#
# The stress at the upper and the lower surface is
#
# $$
# \frac{N}{A} \mp \frac{M h}{2I} ,
# $$
#
# with the height $h$ and with $M$ about the middle of the area; the mean shear stress is $Q/A$. These are the formulas of beam
# theory for the reference section. They know no concentration at supports, loads, steps or notches, and not how shear is
# distributed over the height. The strains are those of a fibre that is free across the plane, or held there as
# `rod.lateral_constraint` says. A section of layers or of given stiffnesses has neither stresses nor strains.
#
# ## Points
#
# `probes = [{ at = "0.35 m", name = "tip" }]` stores displacement and rotation of a point under its name. Rotations count whole
# turns: a rod that has rolled up once has $2\pi$ and not zero.
#
# ## All of them
#
# They follow from the stored states when a result is made, and the attribute `derived` of the result lists them. Motions have `time`
# before these dimensions, and paths `point`.

# %% tags=["remove-input"]
page.variables(
    "contact_force",
    "normal_force",
    "shear_force",
    "bending_moment",
    "contact_director_force",
    "intrinsic_director_force",
    "reaction_force",
    "reaction_moment",
    "reaction_director_force",
    "strain_energy",
    "attached_energy",
    "load_potential",
    "total_load_work",
    "load_work",
    "support_work",
    "fibre_stress",
    "fibre_strain",
    "shear_stress",
    "rotation",
    "probe_displacement",
    "probe_rotation",
)
