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
# Static problems, paths and motions give the same outputs. The solvers do not need them: they follow from the states when the
# Dataset is made, and its attribute `derived` names them.

# %% tags=["remove-cell"]
from cosserat.data.variables import VARIABLES
from cosserat.problems import outputs
from cosserat.rods import resultants
from cosserat.thesis.book import page

# %% tags=["remove-input"]
page.figure(
    "fig_conventions",
    "(a) Rotations, curvatures and couples are positive from $\\mathbf{E}_3$ towards $\\mathbf{E}_2$; $\\mathbf{E}_1$ points "
    "away from the reader. (b) The part beyond a cut acts on the part before it with $N$, $Q$ and $M$, and the other "
    "way round. (c) What beams make of them.",
)

# %% [markdown]
# ## Axes
#
# All vectors have their components along $\mathbf{E}_3$ and $\mathbf{E}_2$, in space and not along the rod: `u.sel(axis="E2")` is
# the deflection of a rod that is straight at rest. A rod starts at the origin along $\mathbf{E}_3$; directions of loads may be angles. To
# turn a case is to turn its loads.
#
# ## Forces inside
#
# Let $W$ be the strain energy. Cut the edge $K$ and move all that is beyond the cut: a translation gives the force, a rotation about
# the middle $\mathbf{c}$ of the edge gives the moment,
#
# $$
# \mathbf{n}_K = \sum_{J > K} \frac{\partial W}{\partial \mathbf{x}_J} , \qquad
# M_K = \sum_{J > K} (\mathbf{x}_J - \mathbf{c}) \times \frac{\partial W}{\partial \mathbf{x}_J}
# + \mathbf{d}_J \times \frac{\partial W}{\partial \mathbf{d}_J} .
# $$
#
# This holds for every energy, at rest and in motion. $N$ is along the normal of the section and $Q$ along the section, as in
# Reissner's beams; the section of an edge is half-way between its two directors. In a straight rod $M' = -Q$.

# %% tags=["remove-input"]
page.excerpt(resultants.resultants, "middle =", "return")

# %% [markdown]
# *Director forces.* The contact director force $\mathbf{m}$ does work on the change of the director along the rod, the intrinsic
# one $\mathbf{k}$ on the director itself (Chapter 1). Along the director they belong to the stretch of the section, across it to
# bending and shear: in the consistent rod $\mathbf{d} \times \mathbf{m}$ is $M$. In the published rod the centreline carries the
# bending moment, and $\mathbf{m}$ has only what its two gradient terms give.
#
# ## Supports
#
# Each vertex with supports has a force, a moment on its section, and a force on its director, which also holds the stretch of a section
# that is bonded. In a motion these are the forces of an instant,
#
# $$
# \mathbf{R} = \mathbf{M} \ddot{\mathbf{q}} + \frac{\partial}{\partial \mathbf{q}} (W + W_{\text{loads}}) ,
# $$
#
# in the rows of the supports, where the other rows give the accelerations. Damping acts on the other rows only. Where a step does not resolve
# fast modes, the force of an instant has their arbitrary phase: see the warnings of the result, and take means.
#
# ## Energy and work
#
# The strain energy by its terms is that above the reference. `load_potential` is minus the work that constant loads of their
# present size would do from the reference, and `attached_energy` is that of springs. In a motion `total_load_work` is the work of the loads since
# the start, `load_work` the part of loads without a constant potential, `support_work` that of moved supports, and
# `dissipated_energy` what damping took; kinetic and stored energy balance them. Along a path loads and
# supports grow slowly; `total_load_work` and `support_work` add up their work from point to point by the trapezoidal rule, and
# together they are the stored energy, to second order in the length of the arcs. A static problem stores no work: only its end is known.
#
# ## Stresses
#
# $N/A \mp M h / 2I$ at the upper and the lower surface, with $M$ about the area centre, and $Q/A$ on average. These are the
# formulas of beams, not results of the directed rod: no concentration of stress at supports, loads, steps or notches, no
# distribution of the shear, and the section of the reference. The strains are those of a fibre that is free across the plane, or kept by
# `rod.lateral_constraint`. A section of layers or of given stiffnesses has none of them.
#
# ## Points
#
# `probes = [{ at = "0.35 m", name = "tip" }]` stores displacement and rotation of points by their names. Rotations count whole
# turns.
#
# ## All of them

# %% tags=["remove-input"]
derived = (
    "contact_force normal_force shear_force bending_moment contact_director_force intrinsic_director_force "
    "reaction_force reaction_moment reaction_director_force strain_energy attached_energy load_potential "
    "total_load_work load_work support_work "
    "fibre_stress fibre_strain shear_stress rotation probe_displacement probe_rotation"
)
page.table(
    [
        (name, ", ".join(VARIABLES[name].dims), VARIABLES[name].units, VARIABLES[name].long_name)
        for name in derived.split()
    ],
    ("variable", "along", "unit", "meaning"),
)

# %% [markdown]
# Motions have `time` before these dimensions, and paths `point`.

# %% tags=["remove-input"]
page.source(outputs.outputs)
