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
# # A rod that converges
#
# The published rod is right where it was tuned: at 20 vertices, for beams like the thesis's. This page is about a rod of the
# same degrees of freedom, a place and a director at each vertex, whose coefficients follow from $E$, $\nu$ and the section, and whose
# answers approach exact ones as the mesh is refined. Use it for your own rod: `rod.energy =
# "consistent"`.
#
# ## Why the published coefficients move with the mesh
#
# In (3.4.11) bending is charged on the turning of the centreline, and the director carries no load of its own. Let $\alpha$ be
# the angle of the tangent and $\vartheta$ that of shear. In the limit of many vertices the energy is that of
# $k_3 \alpha'^2 + k_4 \vartheta^2 + k_5 \vartheta'^2$, so that $k_5 \vartheta'' = k_4 \vartheta$: shear is not proportional to
# the shear force, but is confined to a layer beside a clamp, $\sqrt{k_5 / k_4}$ long, that acts as a hinge of stiffness
# $\sqrt{k_4 k_5}$ between clamp and tangent. What is missing is the cross term of $EI (\alpha' + \vartheta')^2$: bending must be
# charged on the turning of the *director*. With 20 vertices the layer is about one edge long, and four coefficients can make
# up for it there.
#
# ## The energy, term by term
#
# An edge $\mathbf{e}$ of reference length $h$ is measured in the frame of the director $\mathbf{m}$ half-way between those of
# its ends, as Reissner measures a beam:
#
# $$
# a = \frac{\mathbf{e} \times \mathbf{m}}{h} , \qquad g = \frac{\mathbf{e} \cdot \mathbf{m}}{h} , \qquad
# T = \angle(\mathbf{d}_K, \mathbf{d}_{K+1}) , \qquad \lambda = \frac{\|\mathbf{d}\|}{\|\mathbf{D}\|} .
# $$
#
# - *Stretch and volume.* $2\mu A (a-1)^2$ on edges, $2\mu A (\lambda-1)^2$ at vertices, and
#   $\Lambda A (a - 1 + \bar\lambda - 1)^2$ on edges with the mean $\bar\lambda$ of both ends: on edges alone the Poisson effect
#   would lock near $\nu = \tfrac12$, here it does not.
# - *Shear.* $k \mu A\, g^2$, of the edge against the mean director, which cannot lock: a thin rod bends as easily as it should.
# - *Bending.* $EI\, T^2 / h$, of the directors.
# - *A centreline anywhere.* If it misses the area centres, edges run between those, at $\mathbf{x} + Y^{02}\mathbf{d}$: the
#   body does not depend on the choice of its centreline. If the height varies along an edge, both ends of the edge are as far
#   off the centreline as the one axis in it that tension does not bend.
# - *Gradients of the section stretch.* $\mu I (\Delta\lambda)^2 / h$, the $k_{11}$ of Chapter 1.

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.exact import elastica
from cosserat.rods.energies import reissner_kernel
from cosserat.solvers import continuation
from cosserat.studies.calibration import beam_of
from cosserat.thesis.book import page
from cosserat.thesis.table import readouts

# %% tags=["remove-input"]
page.excerpt(reissner_kernel.assemble, "wide = (end_a", "if measuring")

# %% [markdown]
# A section may be free to contract in $\mathbf{E}_1$ (`lateral_constraint = "free"`: then $\Lambda = E\nu/(1-\nu^2)$, a pulled bar answers with
# $EA$ and necks by $-\nu n / EA$), it may keep its width (`"plane strain"`: Lamé's $\Lambda$, and $EI/(1-\nu^2)$ in bending), or
# it may keep its area in the plane, edge by edge (`"incompressible"`: stretch along times stretch across is one, by a penalty
# of $10^5 \cdot 2\mu A$ on $a \bar\lambda - 1$ in place of $a + \bar\lambda - 2$). The output says which. With
# `barrier = true` the stretches and the rotations resist collapse as in Fig. 3.7; that changes nothing to second order in
# the strains, nothing in the limit of many edges for bending, and it stiffens large stretches.
#
# The decay of a necked end, (3.5.9), is settled by this energy: one director in a section that is free in $\mathbf{E}_1$ gives
# $\beta^2 = 2(1+\nu)A/I$, in plane strain $2A/(I(1-\nu))$; the page has half of what two directors give.
#
# ## It converges

# %% tags=["remove-input"]
page.figure(
    "fig_convergence",
    "Every measure falls with the square of the edge. The published rod's error does not fall: it grows towards its limit.",
)

# %% tags=["remove-input"]
data = page.data("convergence")
edges = data.vertices.to_numpy() - 1
orders = -np.diff(np.log(data.errors.to_numpy()), axis=1) / np.diff(np.log(edges))
assert np.abs(orders[:, 1:] - 2).max() < 0.15
page.table(
    [
        (name, *(f"{value:.1e}" for value in values), f"{order[-1]:.2f}")
        for name, values, order in zip(
            data.measure.to_numpy(), data.errors.to_numpy(), orders, strict=True
        )
    ],
    ("measure", *(f"{int(n)} edges" for n in edges), "last order"),
)

# %% [markdown]
# ## The problems of section 3.5 without calibration
#
# The figures of the last chapters carry this rod as green diamonds, beside the published one.

# %% tags=["remove-input"]
page.rows("C-3")

# %% [markdown]
# ## Large deflections
#
# A slender rod rotates a lot and hardly stretches. Its energy is a narrow, curved valley, where a line search is slow;
# full Newton steps cross it. The load grows in increments, in each of which a section may rotate by 0.7 rad. An increment
# is accepted if the rates of rotation before it predict its end, and if the rod is stable there:

# %% tags=["remove-input"]
lines = []
for name in ("elastica", "roll_up"):
    done = cosserat.data.dataset.statistics_of(page.data(name))
    lines.append((page.data(name).attrs["title"], done["iterations"], done["cutbacks"]))
page.table(lines, ("problem", "Newton iterations", "increments refused"))

# %% tags=["remove-input"]
page.figure("fig_far", "Dotted: the reference. Light: points of the path on the way.")

# %% tags=["remove-input"]
page.rows("C-e", "C-r", "C-column")

# %% [markdown]
# If the next equilibrium is unstable, bisection locates the load at which the rod loses its stability, and the rod continues
# along its softest motion there. An imperfection decides the side, of any size above round-off: a force of $10^{-9}$ N
# across a column under 18 N. A rod without any may go to either side, and its answer has a warning. If a load cannot be
# reached, the error has the load that was reached and the last state.
#
# ## Along the path
#
# A case of kind `rod path` traces the equilibria themselves by arcs, through limit points:

# %% tags=["remove-input"]
page.source(continuation._corrected)

# %% tags=["remove-input"]
page.figure(
    "fig_paths",
    "(a) leaves the straight column at Euler's load; (b) has two limit points, and loads of the opposite sign between them.",
)

# %%
bent = cosserat.run(
    cosserat.case("elastica").vary(
        "pulled_hard", forces=[{"at": "last", "along": "E2", "force": "47 N"}], rod={"vertices": 81}
    )
)
print(
    f"at ten times the load of the figure the tip moves sideways by {float(bent.u.sel(axis='E2')[-1]):.4f} m"
)

# %% tags=["remove-cell"]
assert readouts.buckling_ratio(page.data("column_path")).max() > 1.5

# %% [markdown]
# ## Motion
#
# The integrator of Chapter 3 moves this rod too.

# %% tags=["remove-input"]
page.figure(
    "fig_tumbling",
    "Thrown, spinning, bent. Dashed: the tolerance of the energy. Momenta are conserved to round-off.",
)

# %% [markdown]
# ## Thin, and hardly compressible
#
# No locking: the error at 20 edges against the exact answer, for thinner and thinner rods across, and for sections that
# change their volume less and less in a necked bar.

# %% tags=["remove-input"]
lines = []
for side in (1e-1, 1e-2, 1e-3, 1e-4):
    slender = cosserat.case("elastica").problem
    section = slender.rod.section.replace(height=side, width=side)
    problem = slender.replace(rod=slender.rod.replace(section=section, vertices=21))
    beam = beam_of(problem)
    unit = beam.bending_stiffness / beam.length**2
    problem = problem.replace(forces=({"at": "last", "along": "E2", "force": unit},))
    exact, _ = elastica.shearable_tip(1.0, beam.axial_stiffness / unit, beam.shear_stiffness / unit)
    lines.append((f"{side:g}", f"{abs(problem.solve('thin')['u'][-1, 1] / exact - 1):.1e}"))
page.table(lines, ("thickness over length", "error of the tip across"))

# %% tags=["remove-input"]
lines = []
for gap in (0.4, 0.02, 2e-4):
    poisson = (1 - gap) / 2
    necked = cosserat.case("necking_plane_strain").problem
    material = necked.rod.material.replace(poisson=poisson)
    necked = necked.replace(rod=necked.rod.replace(material=material, vertices=21))
    beam, fields = beam_of(necked), necked.solve("necked")
    middle = necked.rod.vertices // 2
    far = -poisson * (1 + poisson) * necked.forces[-1].force / beam.axial_stiffness
    lines.append((f"{gap:g}", f"{abs((fields['lam'][middle] - 1) / far - 1):.1e}"))
page.table(lines, ("1 - 2 nu", "error of the section strain far from the ends, plane strain"))

# %% [markdown]
# ## Limits
#
# Sections stay plane and stretch uniformly: a section that warps, or bends across itself as a wide strip does when it is
# bent, is not described, as section 1.2 of the thesis warns. The rod is planar, has no contact, no actuators and no
# branches; other omissions of the thesis are on the page *What is left out*. Its law is linear in its own measures, which are
# not those of any material at strains of order one. Speed beside other packages is measured by `snakemake peers`, which
# needs a network and is the next page; `cosserat speed` times this machine alone.
