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
# The published rod is accurate at the mesh of its calibration: 20 vertices, for beams like those of the thesis. This page is
# about a rod with the same degrees of freedom, a position and a director at each vertex. Its coefficients follow from $E$,
# $\nu$ and the section, and its answers converge to exact ones under refinement. Use it for your own rod: `rod.energy =
# "consistent"`.
#
# ## Why the published coefficients depend on the mesh
#
# In (3.4.11) the bending energy depends on the rotation of the centreline, and the director carries no moment. Let $\alpha$
# be the angle of the tangent and $\vartheta$ that of shear. In the limit of many vertices the energy is that of
# $k_3 \alpha'^2 + k_4 \vartheta^2 + k_5 \vartheta'^2$, so that $k_5 \vartheta'' = k_4 \vartheta$. Shear is not proportional to
# the shear force, but is confined to a layer beside a clamp. The layer is $\sqrt{k_5 / k_4}$ long and acts as a hinge of
# stiffness $\sqrt{k_4 k_5}$ between clamp and tangent. The energy lacks the cross term of $EI (\alpha' + \vartheta')^2$:
# bending must depend on the rotation of the *director*. With 20 vertices the layer is about one edge long, and four
# coefficients can compensate it.
#
# ## The energy, term by term
#
# The strains of an edge $\mathbf{e}$ of reference length $h$ are those of Reissner's beam, in the frame of the director
# $\mathbf{m}$ half-way between those of its ends:
#
# $$
# a = \frac{\mathbf{e} \times \mathbf{m}}{h} , \qquad g = \frac{\mathbf{e} \cdot \mathbf{m}}{h} , \qquad
# T = \angle(\mathbf{d}_K, \mathbf{d}_{K+1}) , \qquad \lambda = \frac{\|\mathbf{d}\|}{\|\mathbf{D}\|} .
# $$
#
# - *Stretch and volume.* $2\mu A (a-1)^2$ on edges, $2\mu A (\lambda-1)^2$ at vertices, and
#   $\Lambda A (a - 1 + \bar\lambda - 1)^2$ on edges with the mean $\bar\lambda$ of both ends. With section stretches on edges
#   alone the Poisson effect would lock near $\nu = \tfrac12$; here it does not.
# - *Shear.* $k \mu A\, g^2$, of the edge relative to the mean director. This term does not lock in thin rods.
# - *Bending.* $EI\, T^2 / h$, of the directors.
# - *A centreline anywhere.* If it does not pass through the area centres, edges run between the area centres, at
#   $\mathbf{x} + Y^{02}\mathbf{d}$. So the body does not depend on the choice of its centreline. If the height varies along an
#   edge, both ends of the edge have the distance from the centreline at which tension causes no bending.
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
# The key `lateral_constraint` has three values. With `"free"` a section is free to contract in $\mathbf{E}_1$: then
# $\Lambda = E\nu/(1-\nu^2)$, and a bar in tension has the stiffness $EA$ and the lateral strain $-\nu n / EA$. With
# `"plane strain"` it keeps its width: $\Lambda$ is Lamé's, and the bending stiffness is $EI/(1-\nu^2)$. With
# `"incompressible"` each edge keeps its area in the plane: axial stretch times lateral stretch is one, by a penalty of
# $10^5 \cdot 2\mu A$ on $a \bar\lambda - 1$ in place of $a + \bar\lambda - 2$. The output says which. With `barrier = true`
# the stretches and the rotations resist collapse as in Fig. 3.7. To second order in the strains this changes nothing. In the
# limit of many edges it does not change bending. It stiffens large stretches.
#
# This energy determines the decay of a necked end, (3.5.9): one director in a section that is free in $\mathbf{E}_1$ gives
# $\beta^2 = 2(1+\nu)A/I$, in plane strain $2A/(I(1-\nu))$. The page has half of the value for two directors.
#
# ## Convergence

# %% tags=["remove-input"]
page.figure(
    "fig_convergence",
    "Every error of the consistent rod falls with the square of the edge length. The error of the published rod does not "
    "fall: it grows to a limit.",
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
# The figures of the last chapters show this rod as green diamonds, beside the published one.

# %% tags=["remove-input"]
page.rows("C-3")

# %% [markdown]
# ## Large deflections
#
# A slender rod rotates a lot and hardly stretches. Its energy is a narrow, curved valley, where a line search is slow, so
# the solver takes full Newton steps. The load grows in increments. In each of them a section may rotate by 0.7 rad. An
# increment is accepted if the rates of rotation before it predict its end, and if the rod is stable there:

# %% tags=["remove-input"]
lines = []
for name in ("elastica", "roll_up"):
    done = cosserat.data.dataset.statistics_of(page.data(name))
    lines.append((page.data(name).attrs["title"], done["iterations"], done["cutbacks"]))
page.table(lines, ("problem", "Newton iterations", "increments refused"))

# %% tags=["remove-input"]
page.figure("fig_far", "Dotted: the reference configuration. Light: intermediate points of the path.")

# %% tags=["remove-input"]
page.rows("C-e", "C-r", "C-column")

# %% [markdown]
# If the next equilibrium is unstable, bisection locates the load at which the rod loses its stability, and the rod continues
# along its softest mode there. An imperfection of any size above round-off decides the side, such as a lateral force of
# $10^{-9}$ N on a column under 18 N. A rod without an imperfection may go to either side, and its answer has a warning. If a
# load cannot be reached, the error has the largest load and the last state.
#
# ## Along the path
#
# A case of kind `rod path` follows the equilibria by arc-length continuation, through limit points:

# %% tags=["remove-input"]
page.source(continuation.corrected)

# %% tags=["remove-input"]
page.player(
    "play_column",
    "The slider is the number of the point on the path. The dot on the load curve goes with it.",
)

# %% tags=["remove-input"]
page.player(
    "play_arch",
    "Between the two limit points no dead load holds the arch: it would snap to the other side.",
)

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
    f"At ten times the load of the figure the lateral displacement of the tip is {float(bent.u.sel(axis='E2')[-1]):.4f} m."
)

# %% tags=["remove-cell"]
assert readouts.buckling_ratio(page.data("column_path")).max() > 1.5

# %% [markdown]
# ## Motion
#
# The integrator of Chapter 3 also computes the motion of this rod.

# %% tags=["remove-input"]
page.player(
    "play_tumbling", "A rod is thrown upwards and spins. Slowed down some thirty times, without gravity."
)

# %% tags=["remove-input"]
page.figure(
    "fig_tumbling",
    "A rod in free flight, which spins and bends. Dashed: the tolerance of the energy. Momenta are conserved to round-off.",
)

# %% [markdown]
# ## No locking in thin and nearly incompressible rods
#
# The first table has the error at 20 edges of thin rods under a lateral force. The second has the error of a necked bar as
# its material becomes incompressible.

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
page.table(lines, ("thickness over length", "error of the tip's lateral displacement"))

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
# Sections stay plane and stretch uniformly. The model does not describe a section that warps or bends, as that of a wide
# strip in bending does; section 1.2 of the thesis warns of this. The rod is planar, has no contact, no actuators and no
# branches; the page *What is left out* lists other omissions of the thesis. The constitutive law is linear in the strains of
# this rod. At strains of order one it is not that of any material. `snakemake peers` compares the speed with other packages
# and needs a network; the next page has its results. `cosserat speed` times this machine alone.
