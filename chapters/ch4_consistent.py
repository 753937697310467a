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
# # Chapter 4: a rod that converges
#
# The published rod is accurate with the mesh of its calibration: 20 vertices, for beams like those of the thesis. This chapter
# is not in the thesis. It changes one idea of the energy and keeps everything else: the same vertices, the same directors, the same solvers.
# The new rod, the *consistent rod*, needs no coefficients. Its stiffnesses follow from the material and the section, and its
# answers tend to the exact ones as vertices are added. Use it for your own rod: `rod.energy = "consistent"`.
#
# :::{admonition} After this chapter you can
# :class: objectives
# * say which term the published energy lacks, and why its answers then depend on the mesh;
# * write the energy of the consistent rod from the strains of one edge;
# * measure the order of a method by refining its mesh;
# * predict buckling, large bending and lateral contraction, and compare.
# :::
#
# ## What the published energy lacks
#
# Let $\alpha$ be the angle of the tangent of the centreline and $\vartheta$ the shear angle, so that the director has turned by
# $\alpha + \vartheta$. A beam bends if neighbouring *sections* turn against each other. So its bending energy is
# $\tfrac12 EI (\alpha' + \vartheta')^2$, and that is
#
# $$
# \tfrac12 EI \left( \alpha'^2 + 2 \alpha' \vartheta' + \vartheta'^2 \right) .
# $$
#
# In (3.4.11) the third term has $\alpha'^2$ and the fifth one $\vartheta'^2$, and the product of both is missing. So nothing
# ties the rotation of the sections to that of the centreline. The director carries no moment, shear gathers in a thin layer beside
# the clamp, and the layer acts as a hinge, as the part on the calibration derives. With 20 vertices the layer is shorter than
# one edge, and coefficients can compensate it. They cannot with other vertices.
#
# The remedy is to measure bending between *directors*.
#
# ## The strains of an edge
#
# Take an edge $\mathbf{e}$ with the reference length $h$, and the unit vector $\mathbf{m}$ half-way between the directors at its two ends.
# These are the strains of Reissner's beam: the stretch $a$ along the normal of the section, the slide $g$ along the section, and the angle $T$ by
# which the section turns from one end to the other. Each vertex has the stretch $\lambda$ of its section:
#
# $$
# a = \frac{\mathbf{e} \times \mathbf{m}}{h} , \qquad g = \frac{\mathbf{e} \cdot \mathbf{m}}{h} , \qquad
# T = \angle(\mathbf{d}_K, \mathbf{d}_{K+1}) , \qquad \lambda = \frac{\|\mathbf{d}\|}{\|\mathbf{D}\|} .
# $$
#
# The cross product is its component along $-\mathbf{E}_1$: an edge along $\mathbf{E}_3$ with an upright $\mathbf{m}$ has
# $a = 1$ and $g = 0$.

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.data.dataset import statistics_of
from cosserat.exact import elastica
from cosserat.problems.calibration import beam_of
from cosserat.problems.critical import RodCriticalLoads
from cosserat.thesis.book import page

# %% tags=["remove-input"]
page.figure(
    "fig_edge_strains",
    "One edge of the consistent rod. The vector $\\mathbf{m}$ halves the angle $T$ between the two directors. Dashed: the part "
    "of the edge along the normal of $\\mathbf{m}$, here longer than the reference $h$, so that $a > 1$, and the part along "
    "$\\mathbf{m}$, which points down, so that $g < 0$.",
)

# %% tags=["remove-input"]
page.excerpt("cosserat.rods.energies.reissner_kernel._edge_strains", "s0, s1 = n0 + p0")

# %% [markdown]
# ## The energy
#
# Six terms, in the order of the code, with the shear modulus $G$, the shear factor $k$ and the mean $\bar\lambda$ of the stretches
# at both ends of an edge:
#
# \begin{equation*}
# \begin{aligned}
# 2\Pi_e &= \sum_{\text{edges}} 2GA\, (a - 1)^2\, h && (1) \\
#  &+ \sum_{\text{vertices}} 2GA\, (\lambda - 1)^2\, L && (2) \\
#  &+ \sum_{\text{edges}} EI\, \frac{T^2}{h} && (3) \\
#  &+ \sum_{\text{edges}} k\, GA\, g^2\, h && (4) \\
#  &+ \sum_{\text{edges}} \Lambda A\, (a - 1 + \bar\lambda - 1)^2\, h && (5) \\
#  &+ \sum_{\text{edges}} GI\, \frac{(\Delta\lambda)^2}{h} . && (6)
# \end{aligned}
# \end{equation*}
#
# 1. *Axial stretch*, of each edge.
# 2. *Section stretch*, at each vertex.
# 3. *Bending*: the directors turn against each other.
# 4. *Shear*: the edge slides along the mean section. Since $\mathbf{m}$ is the mean of both directors, a thin rod can bend without
#    any shear, and the term does not block it.
# 5. *Change of volume*: a longer edge with thinner sections may keep its volume, and then this term is zero. It is the Poisson effect.
#    It stands on edges with the mean $\bar\lambda$. If each edge had a section stretch of its own in its place, a nearly
#    incompressible rod would lock; the section on locking shows that this one does not.
# 6. *Gradients of the section stretch*, $\Delta\lambda$ from one vertex to the next: the stiffness $k_{11}$ of Chapter 1.
#
# Each strain is that above the reference, so a curved rod rests in its reference.

# %% tags=["remove-input"]
page.excerpt(
    "cosserat.rods.energies.reissner_kernel.assemble", "terms[0] += rod[J].k_axial", "if measuring"
)

# %% [markdown]
# If the centreline does not pass through the middle of the sections, the edges run between the middles, at
# $\mathbf{x} + Y^{02}\mathbf{d}$, so the choice of the centreline does not change the body.
#
# What is $\Lambda$? The rod is planar, and its sections may do one of three things across the plane, which the key
# `lateral_constraint` chooses:
#
# * `"free"`: they contract freely in $\mathbf{E}_1$. Then $\Lambda = E\nu/(1-\nu^2)$. Under a tension $n$ the terms (1), (2) and (5)
#   give $\lambda - 1 = -\nu (a - 1)$ and $n = EA (a - 1)$, as they must.
# * `"plane strain"`: they keep their width. $\Lambda$ is Lamé's constant $E\nu/((1+\nu)(1-2\nu))$, and the bending stiffness is
#   $EI/(1-\nu^2)$.
# * `"incompressible"`: each edge keeps its area in the plane. The term (5) becomes a penalty of $10^5 \cdot 2GA$ on
#   $a \bar\lambda - 1$.
#
# With `barrier = true` stretches and rotations resist collapse as in Fig. 3.7. For small strains this changes nothing.
#
# The energy also decides how fast a necked end recovers, the $\beta$ of (3.5.9). The balance of director forces gives
# $\beta^2 = 2(1+\nu)A/I$ for a free section and $2A/(I(1-\nu))$ in plane strain.

# %% tags=["remove-input"]
page.misprint("E3.13")

# %% [markdown]
# ## Convergence
#
# A method has *order two* if its error falls to a quarter when each edge is halved. A test on one mesh cannot show this; five
# meshes can. The number behind $P$ in the figure and the table is $PL^2/EI$ of a slender rod with the force $P$
# across its tip. An *elastica* is such a rod that bends far.
# The frequencies are the five lowest of the vibrating beam.

# %% tags=["remove-input"]
page.figure(
    "fig_convergence",
    "Errors over the number of edges, both logarithmic, so order two is a straight line with the slope $-2$. All errors of "
    "the consistent rod follow it. The error of the published rod does not fall: it grows to a limit, as the hinge predicts.",
)

# %% tags=["remove-input"]
data = page.study("convergence")
edges = data.vertices.to_numpy().astype(int) - 1
errors = data.errors.to_numpy().T  # of each measure, by vertices
orders = -np.diff(np.log(errors), axis=1) / np.diff(np.log(edges))
assert np.abs(orders[:, 1:] - 2).max() < 0.15
page.table(
    [
        (name, *(page.tens(value, 2) for value in values[::2]), f"{order[-1]:.2f}")
        for name, values, order in zip(data.measure.to_numpy(), errors, orders, strict=True)
    ],
    ("relative error [1]", *(f"{n} edges" for n in edges[::2]), "last order"),
)

# %% [markdown]
# ## The problems of Chapter 3 without calibration
#
# Figs. 3.8 to 3.13 show this rod beside the published one. It meets the same closed forms, with 20 vertices, and none of its
# stiffnesses has been fitted:

# %% tags=["remove-input"]
page.rows("C-3")

# %% [markdown]
# ## Large deflections
#
# A slender rod rotates a lot and hardly stretches. Near such a shape the energy is a narrow, curved valley: steep for
# stretching, flat for bending. The solver lets the load grow in increments in which no section turns by more than 0.7 rad. It
# predicts the end of each increment from the rates of rotation before, and accepts the equilibrium that it finds if it is
# near the prediction and stable. Few increments are refused:

# %% tags=["remove-input"]
lines = []
for name in ("elastica", "roll_up"):
    done = statistics_of(page.data(name))
    lines.append((page.data(name).attrs["title"], done["iterations"], done["cutbacks"]))
page.table(lines, ("problem", "Newton iterations", "increments refused"))

# %% tags=["remove-input"]
page.figure(
    "fig_far",
    "Four slender rods, all true to scale. Dotted: the reference. Light: points of the path on the way. In (b) the couple has rolled "
    "the rod into a closed circle; in (d) the arch has turned inside out.",
)

# %% [markdown]
# How far is the textbook's straight line right? Move the load:

# %% tags=["remove-input"]
page.explore(
    "explore_load",
    "Solid: the exact elastica. Dots: the consistent rod under the load of the slider. Dashed: the line of small deflections. "
    "It is right for small loads; for larger ones it goes on in proportion, and the rod cannot.",
)

# %% tags=["remove-input"]
page.rows("C-e", "C-r", "C-column")

# %% [markdown]
# At ten times the load of (a) the tip stands nearly along the force:

# %%
bent = cosserat.run(
    cosserat.case("elastica").vary(
        "pulled_hard", forces=[{"at": "last", "along": "E2", "force": "47 N"}], rod={"vertices": 81}
    )
)
print(f"The tip of the rod of 1 m moves sideways by {float(bent.u.sel(axis='E2')[-1]):.4f} m.")

# %% [markdown]
# If the next equilibrium is unstable, the solver halves the increment until it has the load at which the rod loses its stability,
# and continues along the softest mode there. Which way a perfect column buckles is chance, and the answer has a warning. Any
# imperfection decides it, such as a force of $10^{-9}$ N across a column under 18 N. If a load cannot be reached at all, the
# error tells the largest load and has the last state.
#
# ## Along the path
#
# An arch that snaps through has no equilibrium nearby when its largest load is passed. To see the way between, the load must be
# allowed to fall. A case of kind `rod path` follows the equilibria by their *arc length*: the distance along the path, in
# displacement and load together, is given, and the load is an unknown. So the path goes through *limit points*, where the load turns back.

# %% tags=["remove-input"]
page.player(
    "play_column",
    "The slider is the number of the point on the path, and the dot on the load curve goes with it. The column stays straight "
    "until the curve bends.",
)

# %% tags=["remove-input"]
page.player(
    "play_arch",
    "Follow the dot over the first limit point: the load falls while the middle of the arch goes on rising. No constant load holds it "
    "there; it would snap to the other side.",
)

# %% tags=["remove-input"]
page.figure(
    "fig_paths",
    "Load over displacement; hollow points are unstable. (a) The column stays straight up to Euler's load and then bends with "
    "little more. (b) The load of the arch rises, falls below zero, and rises again: between its two limit points the arch "
    "would jump.",
)

# %% tags=["remove-cell"]
column = page.data("column_path")
problem = cosserat.case_of(column).problem
beam = beam_of(problem)
euler = np.pi**2 / 4 * beam.bending_stiffness / beam.length**2
assert np.abs(column.load_factor.to_numpy() * problem.forces[0].force / euler).max() > 1.5

# %% [markdown]
# ## Motion
#
# The integrator of Chapter 3 computes the motion of this rod as well, with the same promise: energy and momenta stay constant.

# %% tags=["remove-input"]
page.player(
    "play_tumbling",
    "The throw of Chapter 3 with this rod, slowed down some thirty times, without gravity. It bends to and fro as it spins.",
)

# %% tags=["remove-input"]
page.figure(
    "fig_tumbling",
    "(a) A rod in free flight at equal times: it rises, spins and bends. (b) The momenta stay constant to round-off, and the energy "
    "to less than the tolerance that is claimed, the dashed line.",
)

# %% [markdown]
# ## No locking
#
# Two kinds of rods are hard for many methods. In a *thin* rod bending is a million times softer than stretching. If the mesh cannot
# bend without some stretching or shearing, the rod is far too stiff: it *locks*. The same happens in a *nearly incompressible* rod, if
# the mesh cannot stretch without changing its volume. Neither happens here: the error with 20 edges does not depend on the
# thickness,

# %% tags=["remove-input"]
lines = []
for side in (1e-1, 1e-2, 1e-3, 1e-4):
    thin = cosserat.case("elastica").vary(
        "thin", rod={"section": {"height": side, "width": side}, "vertices": 21}
    )
    beam = beam_of(thin.problem)
    unit = beam.bending_stiffness / beam.length**2
    thin = thin.vary("thin", forces=[{"at": "last", "along": "E2", "force": unit}])
    exact, _ = elastica.shearable_tip(1.0, beam.axial_stiffness / unit, beam.shear_stiffness / unit)
    off = abs(float(cosserat.run(thin).u.sel(axis="E2")[-1]) / exact - 1)
    assert off < 1e-3
    lines.append((f"{side:g}", page.tens(off, 2)))
page.table(lines, ("thickness over length [1]", "error of the tip's lateral displacement [1]"))

# %% [markdown]
# nor on how near Poisson's ratio is to one half:

# %% tags=["remove-input"]
lines = []
for gap in (0.4, 0.02, 2e-4):
    nu = (1 - gap) / 2
    necked = cosserat.case("necking_plane_strain").vary(
        "necked", rod={"material": {"poisson": nu}, "vertices": 21}
    )
    data = cosserat.run(necked)
    far = -nu * (1 + nu) * necked.problem.forces[-1].force / beam_of(necked.problem).axial_stiffness
    off = abs((float(data.lam[data.sizes["vertex"] // 2]) - 1) / far - 1)
    assert off < 1e-3
    lines.append((f"{gap:g}", page.tens(off, 2)))
page.table(lines, ("$1 - 2\\nu$ [1]", "error of the section strain far from the ends, plane strain [1]"))

# %% [markdown]
# ## Limits
#
# Sections stay plane and stretch uniformly. The model does not describe a section that warps or bends, as the wide strip of a
# measuring tape does; section 1.2 of the thesis warns of this. The rod is planar, has no contact, no actuators and no branches. The
# law of the material is linear in the strains of this rod, so it describes no real material at strains of order one.
# Its speed is measured on the page [Beside other packages](ch5_peers.ipynb).
#
# ## Exercises
#
# :::{admonition} Exercise 4.1: the order of a mesh
# :class: exercise
# The rod `elastica` is bent far by a force across its tip, with $PL^2/EI = 10$. Compute it with 10, 20 and 40 edges, and compare
# the lateral displacement of its tip with the exact one, `cosserat.exact.elastica.shearable_tip`. What is the order? How many edges do you
# need for an error of $10^{-6}$?
# :::

# %% tags=["hide-cell"]
case = cosserat.case("elastica")
beam, force = beam_of(case.problem), case.problem.forces[0].force
unit = beam.bending_stiffness / beam.length**2
exact, _ = elastica.shearable_tip(force / unit, beam.axial_stiffness / unit, beam.shear_stiffness / unit)
errors = []
for edges in (10, 20, 40):
    data = cosserat.run(case.vary("mesh", rod={"vertices": edges + 1}))
    errors.append(abs(float(data.u.sel(axis="E2")[-1]) / (exact * beam.length) - 1))
    print(f"{edges} edges: error {errors[-1]:.1e}")
order = np.log2(errors[1] / errors[2])
enough = 40 * (errors[2] / 1e-6) ** (1 / order)
print(f"order {order:.2f}; {enough:.0f} edges for an error of 1e-6")
assert abs(order - 2) < 0.05

# %% [markdown]
# :::{admonition} Exercise 4.2: Euler's load
# :class: exercise
# A column of 1 m is clamped at its foot and pressed at its free end. Compute $\pi^2 EI/4L^2$ for the section and material of the case
# `column_path`. Then ask the library for the critical load with 10, 20 and 40 edges. From which side does it come, and with
# which order?
# :::

# %% tags=["hide-cell"]
case = cosserat.case("column_path")
beam, press = beam_of(case.problem), case.problem.forces[0].force
euler = np.pi**2 / 4 * beam.bending_stiffness / beam.length**2
print(f"by hand {euler:.4f} N")
errors = []
for edges in (10, 20, 40):
    column = case.vary("mesh", rod={"vertices": edges + 1}).problem
    found = RodCriticalLoads.of(column, 1).solve("column")
    load = press * float(found["special_load_factor"][0])
    errors.append(load / euler - 1)
    print(f"{edges} edges: {load:.4f} N, error {errors[-1]:+.1e}")
assert min(errors) > 0  # a column of few edges is too stiff: the load comes from above
assert abs(np.log2(errors[0] / errors[1]) - 2) < 0.05

# %% [markdown]
# :::{admonition} Exercise 4.3: how thin does it become?
# :class: exercise
# A bar with $\nu = 0.3$ is pulled by 1 kN. Its ends may contract. By how much does its height shrink if it is free across the plane,
# and by how much in plane strain? Why is it more in plane strain?
# :::

# %% tags=["hide-cell"]
supports = [{"at": "first", "fixed": ["x3", "x2", "d3"]}, {"at": "last", "fixed": ["d3"]}]
tension = 1e3 / (1e9 * 0.25)  # n / EA
expected = {"free": -0.3 * tension, "plane strain": -0.3 * 1.3 * tension}
for constraint, by_hand in expected.items():
    bar = cosserat.case("necking_consistent").vary(
        "bar", rod={"lateral_constraint": constraint}, supports=supports
    )
    found = float(cosserat.run(bar).lam[10]) - 1
    print(f"{constraint}: {found:.4e}, by hand {by_hand:.4e}")
    assert abs(found / by_hand - 1) < 1e-6
# what cannot come from the width must come from the height
