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
# The theory allows more than the published problems use. Each of the following is a key of a case, and each has a test with
# an independent answer.

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.rods import constraints, variation
from cosserat.rods.loads import couples, dead
from cosserat.thesis.book import page

# %% [markdown]
# ## Sections that vary
#
# The properties of a part are means over it,
#
# $$
# {}_K A = \frac{1}{{}_K L} \int A\, d\xi , \tag{3.4.8}
# $$
#
# and likewise for edges and for $I$, $E$, $G$ and $\nu$ (Table 3.1). Width, height, modulus, Poisson's ratio and density are
# given at stations along the rod, relative to their nominal values, and are linear between them. Two stations at one place
# give a step, as in a rod of several materials. The line density is proportional to density times area.

# %% tags=["remove-input"]
page.source(variation.lump)

# %%
cone = cosserat.case("clamped_free").vary(
    "cone", rod={"stations": [{"at": "0 m", "height": 1.0}, {"at": "5 m", "height": 0.3, "width": 0.5}]}
)
uniform = page.data("clamped_free").u.sel(axis="E2")[-1].item()
tapered = cosserat.run(cone).u.sel(axis="E2")[-1].item()
print(
    f"The tapered beam's tip sinks by {-1e3 * tapered:.1f} mm, the uniform one's by {-1e3 * uniform:.1f} mm."
)

# %%
glued = [
    {"at": "2 m"},
    {"at": "2 m", "young": 0.3, "poisson": 1.5, "density": 3.0},
]
bar = cosserat.case("hanging_bar").vary("two_materials", rod={"stations": glued})
of_two, of_one = (
    data.u.sel(axis="E3")[-1].item() for data in (cosserat.run(bar), page.data("hanging_bar"))
)
print(
    f"A bar of two materials hangs with its tip {1e3 * of_two:.3f} mm down, the uniform one {1e3 * of_one:.3f} mm."
)

# %% tags=["remove-input"]
rod = bar.problem.rod
arc, joint = rod.geometry().arc_length, rod.stations[0].at
of_vertices, of_edges = variation.lump(
    rod.stations,
    arc,
    area=rod.area,
    second_moment=rod.second_moment,
    young=rod.young,
    poisson=rod.poisson,
)
edge = int(np.searchsorted(arc, joint)) - 1
near = [
    (f"{kind} {k}", lumped, k)
    for kind, lumped in (("vertex", of_vertices), ("edge", of_edges))
    for k in (edge - 1, edge, edge + 1)
]
properties = {
    "A [m\u00b2]": "area",
    "I about the centreline [m\u2074]": "second_moment",
    "E [Pa]": "young",
    "G [Pa]": "shear",
    "\u03bd": "poisson",
}
page.table(
    [
        (name, *(f"{getattr(lumped, key)[k]:.4g}" for _, lumped, k in near))
        for name, key in properties.items()
    ],
    ("Table 3.1 around the joint", *(where for where, _, _ in near)),
)

# %% tags=["remove-cell"]
assert arc[edge] < joint < arc[edge + 1]
assert 0.3 * rod.young < of_edges.young[edge] < rod.young

# %% [markdown]
# The joint lies inside an edge, and there the averages of Table 3.1 are inaccurate: the compliances $1/EA$ add up along a
# bar, but the table takes the mean of $E$. The error is of first order in the edge length. The rod of Chapter 4 adds up
# compliances, and its error falls with the square of the edge length. The comparison with $u = \int n/EA\, d\xi$:

# %%
problem = bar.problem
rod, w = problem.rod, problem.rod.line_density * problem.gravity.g
exact = (w * 2 * (2 / 2 + 3 * 3) + 3 * w * 3 * 3 / 2 / 0.3) / (rod.young * rod.area)
converging = cosserat.run(bar.vary("added_up", rod={"energy": "consistent", "calibration": "none"}))
added_up = converging.u.sel(axis="E3")[-1].item()
print(
    f"closed form {1e3 * exact:.5f} mm, averages {of_two / exact - 1:+.1%}, compliances {added_up / exact - 1:+.0e}"
)

# %% tags=["remove-cell"]
assert abs(of_two / exact - 1) > 0.01
assert abs(added_up / exact - 1) < 1e-3

# %% [markdown]
# ## A centreline anywhere in the section
#
# The key `centreline` is its height above the lower surface. If it does not pass through the area centre, the first inertia
# ${}_K Y^{02}$ is not zero, the mass matrix couples positions and directors,
#
# \begin{equation*}
# {}_K\mathbf{M} = {}_K\rho_0\, {}_K L \begin{bmatrix} 1 & 0 & Y^{02} & 0 \\ 0 & 1 & 0 & Y^{02} \\
# Y^{02} & 0 & Y^{22} & 0 \\ 0 & Y^{02} & 0 & Y^{22} \end{bmatrix} , \tag{3.3.43}
# \end{equation*}
#
# and gravity acts on the directors too. A free rod conserves its momenta, its centre of mass moves on a straight line, and
# the centreline rotates around it. The energy (3.4.11) has no coupling of stretching and bending for such a rod: only $I$ is
# taken about the centreline, and the thesis leaves the rest to calibration. The sag of a body does not depend on the choice
# of its centreline, but that of this rod does.

# %% tags=["remove-input"]
low = cosserat.case("clamped_free").vary("low", rod={"centreline": 0.2})
sags = [cosserat.run(low).u.sel(axis="E2")[-1].item(), uniform]
body = low.problem.rod
stiffer = 1 + 12 * (0.5 - body.centreline) ** 2
assert abs(stiffer * sags[0] / sags[1] - 1) < 0.1
page.text(
    f"With its centreline at {body.centreline:g} of the height the clamped-free beam sags {sags[0] / sags[1]:.2f} times as "
    f"far as with the centreline in the middle, because $I$ is {stiffer:.2f} times as large. The consistent rod has the "
    "coupling, and its sag does not change."
)

# %% [markdown]
# ## Couples, line loads, moved supports
#
# A couple on a section rotates with it and does the work of a couple: its potential is $-M\alpha$, with $\alpha$ the angle
# by which the director has rotated, so the director force is
#
# $$
# {}_K\mathbf{P}_{ext} = \frac{{}_K\mathbf{M}}{\|{}_K\mathbf{d}\|} \times {}_K\hat{\mathbf{d}} ,
# $$
#
# The page has
#
# $$
# {}_K\mathbf{P}_{ext} = \frac{{}_K\mathbf{M}}{{}_K\lambda H} \times {}_K\hat{\mathbf{d}} , \tag{3.3.41}
# $$
#
# which is half as much for a director that ends at the surface, at half the height (E3.10).

# %% tags=["remove-input"]
page.excerpt(couples._work, "terms[0] = 0.0", "energy: float")

# %% [markdown]
# Line loads act over any part of the rod. Fixed degrees of freedom may have prescribed displacements
# (`prescribed_displacements`): to a new place in statics, and also sinusoidally in motion. A fixed section may be rotated
# through any angle (`prescribed_rotations`); if the components of its director moved along straight lines, it would stretch.

# %% tags=["remove-input"]
page.source(dead.LineLoad.on_dofs)

# %% tags=["remove-input"]
page.source(constraints.RotatedDirector.place)

# %% [markdown]
# ## Curved references
#
# With `rod.rest = { kind = "arc", ... }` the reference is an arc. Its directors are along the Bishop vectors, so there is no intrinsic
# shear. By section 3.2 intrinsic quantities are subtracted from the strains. The printed (3.4.11) depends on the whole
# curvature, so a curved rod would straighten without a load (E3.24). The library subtracts the intrinsic curvature; the
# printed form is the variant `intrinsic_curvature = "printed"`.

# %%
hook = cosserat.case("clamped_free").vary(
    "hook", gravity=None, rod={"rest": {"kind": "arc", "curvature": "0.3 m^-1"}}
)
printed = hook.vary("hook", rod={"intrinsic_curvature": "printed"})
rested, straightened = (cosserat.run(case).u.sel(axis="E2")[-1].item() for case in (hook, printed))
print(
    f"Unloaded, the tip of the hook moves by {abs(rested):.0e} m; with the printed energy by {abs(straightened):.2f} m."
)

# %% tags=["remove-cell"]
assert abs(rested) < 1e-9 < abs(straightened)
