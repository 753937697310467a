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
# # Chapter 3: rods that are not uniform
#
# The four published problems have one section, one material, a straight reference and simple loads. The theory allows more. In
# this part the section varies, two materials meet, the centreline leaves the middle, a couple bends the rod, a support moves,
# and the rod is curved before any load acts. Each of these is a key of a case.
#
# :::{admonition} After this chapter you can
# :class: objectives
# * write a case with a tapered section or two materials, and check it by hand;
# * say why compliances, not stiffnesses, add up along a bar;
# * explain what the choice of the centreline changes, and what it must not change;
# * load a rod by couples and by supports that move, and predict its answer.
# :::

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.problems.calibration import beam_of
from cosserat.rods.variation import lump
from cosserat.thesis.book import page

# %% [markdown]
# ## Sections that vary
#
# The discrete rod needs one area for each vertex and one for each edge. They are means over the part that belongs to it,
#
# $$
# {}_K A = \frac{1}{{}_K L} \int A\, d\xi , \tag{3.4.8}
# $$
#
# $$
# {}^K A = \frac{1}{\|{}^K\mathbf{E}\|} \int A\, d\xi , \tag{3.4.9}
# $$
#
# over half an edge on both sides of a vertex, or over an edge. The second moment $I$, the moduli $E$ and $G$ and Poisson's ratio
# $\nu$ are averaged in the same way, each by itself. A case gives width, height, modulus, Poisson's ratio and density at *stations*
# along the rod, as multiples of their nominal values. Between two stations they are linear. Two stations at the same place make a step:
# a rod of two materials.

# %% tags=["remove-input"]
page.excerpt("cosserat.rods.variation.lump", "area * s.width", "]")

# %% [markdown]
# A beam that keeps its clamped end and becomes thin towards the free one is lighter where its weight has the longest arm:

# %%
cone = cosserat.case("clamped_free").vary(
    "my_cone", rod={"stations": [{"at": "0 m"}, {"at": "5 m", "height": 0.3, "width": 0.5}]}
)
tapered = cosserat.run(cone).u.sel(axis="E2")[-1].item()
uniform = page.data("clamped_free").u.sel(axis="E2")[-1].item()
print(
    f"The tip of the tapered beam sinks by {-1e3 * tapered:.1f} mm, that of the uniform beam by {-1e3 * uniform:.1f} mm."
)

# %% [markdown]
# And a bar that hangs from its stiff upper part, with a lower part that is softer and heavier:

# %%
glued = [
    {"at": "2 m"},
    {"at": "2 m", "young": 0.3, "poisson": 1.5, "density": 3.0},
]
bar = cosserat.case("hanging_bar").vary("my_bar", rod={"stations": glued})
of_two = cosserat.run(bar).u.sel(axis="E3")[-1].item()
of_one = page.data("hanging_bar").u.sel(axis="E3")[-1].item()
print(f"Its tip hangs {1e3 * of_two:.3f} mm down, that of the uniform bar {1e3 * of_one:.3f} mm.")

# %% tags=["remove-input"]
page.figure(
    "fig_varied_sections",
    "(a) The tapered beam sags less than the uniform beam, and bends most where it is thin. (b) The displacement of the bar of two "
    "materials has a kink at the joint. Below the joint the published rod hangs too high at every vertex: it has lost "
    "something in one edge, the one with the joint in it.",
)

# %% [markdown]
# What did the published rod lose? The table has the averages around the joint, which lies inside an edge.

# %% tags=["remove-input"]
rod = bar.problem.rod
arc, joint = rod.geometry().arc_length, rod.stations[0].at
of_vertices, of_edges = lump(
    rod.stations,
    arc,
    area=rod.area,
    second_moment=rod.second_moment,
    young=rod.young,
    poisson=rod.poisson,
)
edge = int(np.searchsorted(arc, joint)) - 1
assert arc[edge] < joint < arc[edge + 1]
assert 0.3 * rod.young < of_edges.young[edge] < rod.young
page.table(
    [
        (
            f"{kind} {k}",
            *(
                f"{getattr(lumped, key)[k] / unit:.3g}"
                for key, unit in (
                    ("area", 1),
                    ("second_moment", 1),
                    ("young", 1e9),
                    ("shear", 1e9),
                    ("poisson", 1),
                )
            ),
        )
        for k in (edge - 1, edge, edge + 1)
        for kind, lumped in (("vertex", of_vertices), ("edge", of_edges))
    ],
    ("Table 3.1 around the joint", "$A$ [m²]", "$I$ [m⁴]", "$E$ [GPa]", "$G$ [GPa]", "$\\nu$ [1]"),
)

# %% [markdown]
# The edge with the joint has a mean of two moduli. But a force $n$ through two pieces in a row stretches each by $n/EA$ per
# length, so it is the *compliances* $1/EA$ that add up: $u = \int n/EA\, d\xi$. The mean of $E$ is larger than the modulus
# that gives the right stretch, and the bar is too stiff there. The error is as large as the edge is long, of first order. The
# consistent rod of Chapter 4 averages compliances, and its error is of second order. Against the closed form:

# %%
problem = bar.problem
weight = problem.rod.line_density * problem.gravity.g
exact = (weight * 2 * (2 / 2 + 3 * 3) + 3 * weight * 3 * 3 / 2 / 0.3) / (rod.young * rod.area)
converging = cosserat.run(bar.vary("added_up", rod={"energy": "consistent", "calibration": "none"}))
added_up = converging.u.sel(axis="E3")[-1].item()
print(
    f"closed form {1e3 * exact:.5f} mm; averages {100 * (of_two / exact - 1):+.2f} %, "
    f"compliances {100 * (added_up / exact - 1):+.2f} %"
)

# %% tags=["remove-cell"]
assert abs(of_two / exact - 1) > 0.01
assert abs(added_up / exact - 1) < 1e-3

# %% [markdown]
# ## A centreline anywhere in the section
#
# The key `centreline` is the height of the centreline above the lower surface, as a fraction of the height: 0.5 is the middle. One
# may want it elsewhere, for example on the surface that touches something. Then the first inertia ${}_K Y^{02}$ is not zero. The
# mass matrix of a vertex has it between position and director: who accelerates the one also accelerates the other.
#
# \begin{equation*}
# {}_K\mathbf{M} = {}_K\rho_0\, {}_K L \begin{bmatrix} 1 & 0 & Y^{02} & 0 \\ 0 & 1 & 0 & Y^{02} \\
# Y^{02} & 0 & Y^{22} & 0 \\ 0 & Y^{02} & 0 & Y^{22} \end{bmatrix} . \tag{3.3.43}
# \end{equation*}
#
# For the same reason gravity acts on the directors too. A free rod conserves its momenta with any centreline: its centre of mass
# moves on a straight line, and the centreline rotates around it.
#
# The *body* does not know which line the modeller has chosen, so its sag must not depend on it. In the published rod it does.
# Bending such a rod stretches its centreline, and (3.4.11) has no term that couples the two; it only takes the larger $I$
# about the new line. The thesis leaves the rest to calibration.

# %% tags=["remove-input"]
page.figure(
    "fig_low_centreline",
    "The same beam under its weight, modelled twice, with the centreline in the middle and near the lower surface. The two rows "
    "of markers, the published rod, disagree. The solid and the dotted line, the consistent rod, lie on one another.",
)

# %% tags=["remove-input"]
sags = {
    name: page.data(name).u.sel(axis="E2")[-1].item()
    for name in (
        "low_centreline",
        "clamped_free",
        "low_centreline_consistent",
        "clamped_free_consistent",
    )
}
body = cosserat.case_of(page.data("low_centreline")).problem.rod
stiffer = 1 + 12 * (0.5 - body.centreline) ** 2
assert abs(stiffer * sags["low_centreline"] / sags["clamped_free"] - 1) < 0.1
moved = sags["low_centreline_consistent"] / sags["clamped_free_consistent"] - 1
assert abs(moved) < 1e-2
page.text(
    f"With the centreline at {body.centreline:g} of the height the second moment about it is {stiffer:.2f} times as large, and the "
    f"published rod sags {sags['low_centreline'] / sags['clamped_free']:.2f} times as far. The sag of the consistent rod changes by "
    f"{page.tens(abs(moved))} of itself."
)

# %% [markdown]
# ## Couples and supports that move
#
# A *couple* $M$ on a section turns with it and does the work $M\alpha$ while the director rotates by $\alpha$. A director of the
# length $\|\mathbf{d}\|$ rotates by $\alpha$ if its tip moves by $\|\mathbf{d}\| \alpha$ across it. So the couple is a director
# force across the director, of the size $M/\|\mathbf{d}\|$:
#
# $$
# {}_K\mathbf{P}_{ext} = \frac{{}_K\mathbf{M}}{\|{}_K\mathbf{d}\|} \times {}_K\hat{\mathbf{d}} .
# $$
#
# The thesis writes it with the current height $\lambda H$ of the section,
#
# $$
# {}_K\mathbf{P}_{ext} = \frac{{}_K\mathbf{M}}{{}_K\lambda H} \times {}_K\hat{\mathbf{d}} , \tag{3.3.41}
# $$
#
# A director from the middle to the surface has the length $\lambda H/2$, so this is half of the force above. The code
# computes the work of the couple; the forces are its derivatives:

# %% tags=["remove-input"]
page.misprint("E3.10")

# %% tags=["remove-input"]
page.excerpt("cosserat.rods.loads.couples._work", "terms[0] -= M", "if task in")

# %% [markdown]
# *Line loads* act over any part of the rod. A vertex takes what falls on the part around it:

# %% tags=["remove-input"]
page.excerpt("cosserat.rods.loads.dead.LineLoad.on_dofs", "forces = body")

# %% [markdown]
# A *support* holds degrees of freedom, and it may move them: `prescribed_displacements` to a new place, and
# `prescribed_rotations` through an angle. A rotated director goes along a circle. If its two components went along straight lines,
# the section would be pressed on the way:

# %% tags=["remove-input"]
page.excerpt("cosserat.rods.constraints.RotatedDirector.place", "c, s =")

# %% tags=["remove-input"]
page.figure(
    "fig_couple_and_support",
    "True shapes, not magnified. (a) A couple bends the beam evenly, so its centreline is nearly a circle. (b) The right clamp has "
    "sunk and its section has turned: the beam leaves the left clamp level and arrives at the right one along the turned "
    "normal. The dotted lines are the reference.",
)

# %% [markdown]
# ## Rods that are curved at rest
#
# A hook is curved before it is loaded. Its *intrinsic curvature* $\kappa_0$ costs no energy. Euler's inextensible rod measures
# bending from it, with the energy per length
#
# $$
# \rho_0 \psi = \frac{EI}{2} (\kappa - \kappa_0)^2 , \tag{3.2.3}
# $$
#
# and section 3.2 of the thesis says that intrinsic quantities are always subtracted. The printed energy (3.4.11) does not. It takes
# the whole curvature, and a hook would straighten without any load. The library subtracts the curvature of the reference,
# which `rod.rest` describes; the printed form is the variant `intrinsic_curvature = "printed"`. The directors of the reference are along the
# Bishop vectors, so that it has no shear.

# %% tags=["remove-input"]
page.misprint("E3.24")

# %%
hook = cosserat.case("clamped_free").vary(
    "my_hook", gravity=None, rod={"rest": {"kind": "arc", "curvature": "0.3 m^-1"}}
)
whole = hook.vary("my_hook", rod={"intrinsic_curvature": "printed"})
rested, straightened = (cosserat.run(case).u.sel(axis="E2")[-1].item() for case in (hook, whole))
print(
    f"Unloaded, the tip of the hook moves by {abs(rested):.0e} m; with the printed energy by {abs(straightened):.2f} m."
)

# %% tags=["remove-cell"]
assert abs(rested) < 1e-9 < abs(straightened)

# %% tags=["remove-input"]
page.figure(
    "fig_hook",
    "No load acts. The filled hook lies on its reference, as a body at rest must. The outlined one has the printed energy and has "
    "straightened.",
)

# %% [markdown]
# ## Exercises
#
# :::{admonition} Exercise 3.10: two halves
# :class: exercise
# A bar of 5 m is pulled by 1 kN. Its right half has half the modulus of its left half. How much longer does it become than a
# bar with the modulus of the left half? Compute it with the published and with the consistent rod, with 20 vertices.
# :::

# %% tags=["hide-cell"]
halves = [{"at": "2.5 m"}, {"at": "2.5 m", "young": 0.5}]
pull = [{"at": "last", "along": "E3", "force": "1 kN"}]
plain = 1e3 * 5.0 / (1e9 * 0.25)
expected = 0.5 + 0.5 / 0.5  # each half on its own: compliances add up
ratios = {}
for name in ("hanging_bar", "hanging_bar_consistent"):
    case = cosserat.case(name).vary("halves", gravity=None, forces=pull, rod={"stations": halves})
    ratios[name] = cosserat.run(case).u.sel(axis="E3")[-1].item() / plain
    print(f"{name}: {ratios[name]:.4f} times as much; expected {expected}")
assert abs(ratios["hanging_bar_consistent"] / expected - 1) < 1e-4
assert 2e-3 < 1 - ratios["hanging_bar"] / expected < 2e-2  # the edge with the joint is too stiff

# %% [markdown]
# :::{admonition} Exercise 3.11: a couple at the tip
# :class: exercise
# A couple of 10 kN m turns the last section of the clamped beam: 5 m long, 0.5 m square, 1 GPa, without weight. By which angle does
# this section turn, and how far does the tip rise? Use the consistent rod.
# :::

# %% tags=["hide-cell"]
case = cosserat.case("clamped_free_consistent").vary(
    "turned", gravity=None, couples=[{"at": "last", "moment": "10 kN*m"}]
)
turned = cosserat.run(case)
angle = 10e3 * 5.0 / beam_of(case.problem).bending_stiffness  # the moment is the same everywhere
rise = angle * 5.0 / 2
found, risen = turned.rotation[-1].item(), turned.u.sel(axis="E2")[-1].item()
print(
    f"by hand {angle:.4f} rad and {1e3 * rise:.2f} mm; computed {found:.4f} rad and {1e3 * risen:.2f} mm"
)
assert abs(found / angle - 1) < 1e-9
assert abs(risen / rise - 1) < 1e-4

# %% [markdown]
# :::{admonition} Exercise 3.12: a clamp that sinks
# :class: exercise
# The right clamp of the beam between two clamps sinks by 1 mm and does not turn. Beam theory gives the force
# $12 EI/\ell^3$ times the sinking, and shear divides it by $1 + 12 EI/(kGA\, \ell^2)$. Compute the force, and find it in the result as
# `reaction_force`. Which order has the error of the consistent rod?
# :::

# %% tags=["hide-cell"]
sunk = cosserat.case("clamped_clamped_consistent").vary(
    "sunk", gravity=None, prescribed_displacements=[{"at": "last", "dof": "x2", "by": "-1 mm"}]
)
beam = beam_of(sunk.problem)
slender = 12 * beam.bending_stiffness / beam.length**3 * 1e-3
force = slender / (1 + 12 * beam.bending_stiffness / (beam.shear_stiffness * beam.length**2))
errors = []
for edges in (20, 40, 80):
    data = cosserat.run(sunk.vary("sunk", rod={"vertices": edges + 1}))
    errors.append(data.reaction_force.sel(axis="E2")[0].item() / force - 1)
    print(f"{edges} edges: {force * (1 + errors[-1]):.2f} N, error {errors[-1]:+.1e}")
print(
    f"by hand {force:.2f} N; without shear {slender:.2f} N; order {np.log2(errors[0] / errors[1]):.2f}"
)
assert abs(np.log2(errors[0] / errors[1]) - 2) < 0.1
