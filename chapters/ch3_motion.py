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
# # Chapter 3: the discrete planar rod in motion
#
# A rod that is released, shaken or thrown moves, because its forces do not balance. This part gives the vertices and directors
# their masses and follows the motion in small steps of time. Most methods lose or create energy if their steps are too long. The
# method of this library keeps the energy exactly, and you will see why that matters.
#
# :::{admonition} After this chapter you can
# :class: objectives
# * say which masses a vertex with a director has, and write its equations of motion;
# * explain why the step of an explicit method is limited, and what the implicit method does in its place;
# * predict the period of a clamped beam by hand, and why its kinetic energy oscillates twice as fast;
# * check a computed motion by its energy and its momenta.
# :::
#
# ## Mass and momentum
#
# The vertex moves with the velocity $\dot{\mathbf{x}}$ and its director changes with $\dot{\mathbf{d}}$. A point of the section
# lies at $\mathbf{x} + X \mathbf{d}$. Its coordinate $X$ is measured along the director and is 1 at the upper surface. So the
# point moves with $\dot{\mathbf{x}} + X \dot{\mathbf{d}}$. Summed over the section with the density $\rho_0^*$ of the material,
# three numbers remain: the mass per length, and the first and the second *inertia*,
#
# \begin{equation*}
# \begin{gathered}
# {}_K\rho_0 = \int \rho_0^*\, dA , \\
# {}_K\rho_0\, {}_K Y^{02} = \int X \rho_0^*\, dA , \\
# {}_K\rho_0\, {}_K Y^{22} = \int X X \rho_0^*\, dA .
# \end{gathered} \tag{3.3.28}
# \end{equation*}
#
# If the centreline runs through the middle of a rectangle, $Y^{02} = 0$ and $Y^{22} = \tfrac13$. The linear momentum of a
# section and the momentum of its director, both per length, are
#
# $$
# {}_K\mathbf{G} = {}_K\rho_0\, {}_K\dot{\mathbf{x}} + {}_K\rho_0\, {}_K Y^{02}\, {}_K\dot{\mathbf{d}} , \tag{3.3.30}
# $$
#
# $$
# {}_K\mathbf{L} = {}_K\rho_0\, {}_K Y^{02}\, {}_K\dot{\mathbf{x}} + {}_K\rho_0\, {}_K Y^{22}\, {}_K\dot{\mathbf{d}} . \tag{3.3.31}
# $$
#
# The balance laws are Newton's, one for the vertex and one for its director. The force $\mathbf{F}$ and the director force
# $\mathbf{P}$ are those of the loads and of the strain energy together. The third line says where energy can come from: the
# loads (*ext*) do work on the rod. It holds for the whole rod only, since neighbouring parts pass energy to one another:
#
# \begin{equation*}
# \begin{aligned}
# {}_K\dot{\mathbf{G}}\, {}_K L &= {}_K\mathbf{F} , \\
# {}_K\dot{\mathbf{L}}\, {}_K L &= {}_K\mathbf{P} , \\
# \sum_K \left( {}_K\dot T + {}_K\dot\Pi_e \right) {}_K L
# &= \sum_K {}_K\mathbf{F}_{ext} \cdot {}_K\dot{\mathbf{x}} \\
# & + \sum_K {}_K\mathbf{P}_{ext} \cdot {}_K\dot{\mathbf{d}} .
# \end{aligned} \tag{3.3.36}
# \end{equation*}
#
# With all degrees of freedom in one column $\mathbf{q}$ they become one equation with a mass matrix $\mathbf{M}$,
#
# $$
# \mathbf{M} \ddot{\mathbf{q}} = \mathbf{F} . \tag{3.3.50}
# $$

# %% tags=["remove-cell"]
from dataclasses import replace

import numpy as np

import cosserat
from cosserat.exact import beams
from cosserat.problems.calibration import beam_of
from cosserat.thesis.book import page

# %% tags=["remove-input"]
page.misprint("E3.21", "E3.28")

# %% tags=["remove-input"]
page.excerpt("cosserat.rods.energies.hemingway.Hemingway.mass", "m = rod.part_masses")

# %% [markdown]
# ## A step that keeps energy and momentum
#
# The thesis takes small *explicit* steps: it computes the forces now, and from them the positions a little later. An explicit
# step must be shorter than the fastest vibration of the rod, or errors grow without limit. The fastest one is that of a single
# edge or director, a thousand times faster than the bending that one wants to see. This method is here too (`rk45`, and
# `rk4` with a fixed step).
#
# The default is *implicit*: positions at the end of the step and forces are solved for together, by Newton's method. A step of the
# length $h$ from $\mathbf{q}_0$ with the velocities $\mathbf{v}_0$ to $\mathbf{q}_1$ with $\mathbf{v}_1$ obeys
#
# \begin{equation*}
# \begin{aligned}
# \frac{2}{h} \mathbf{M} \left( \frac{\mathbf{q}_1 - \mathbf{q}_0}{h} - \mathbf{v}_0 \right)
# &= \mathbf{F}_{ext} - \sum_s \frac{\partial \Pi_e}{\partial s}\left( \tfrac12 (s_0 + s_1) \right)
# \nabla s \left( \tfrac12 (\mathbf{q}_0 + \mathbf{q}_1) \right) - \sigma \mathbf{z} , \\
# \mathbf{v}_1 &= \frac{2}{h} (\mathbf{q}_1 - \mathbf{q}_0) - \mathbf{v}_0 .
# \end{aligned}
# \end{equation*}
#
# The sum runs over all strains $s$ of the rod. It has three ideas:
#
# * *The middle of the step.* Change of momentum over the step equals force in the middle of the step. This is accurate to second
#   order in $h$.
# * *Stresses of the mean strains.* Let a rod rotate by an angle $t$ without deforming. The points half-way between start and end
#   form a rod that is shorter by $t^2/8$, so the strains *of the middle* would press it, and a thin rod would buckle. The
#   *mean of the strains* at start and end is zero, and the rod rotates freely.
# * *A small force $\sigma\mathbf{z}$.* It makes the work of the elastic forces over the step equal to the change of the strain
#   energy, exactly. This is Gonzalez's discrete gradient. The vector $\mathbf{z}$ is the change over the step without its
#   rigid part, so the force has no resultant and no moment. So momentum and angular momentum are kept as well.
#
# In the code `work` is the work of the forces, and what is `missing` to the change of energy decides $\sigma$:

# %% tags=["remove-input"]
page.excerpt("cosserat.solvers.energy_momentum._sigma", "work, along = 0.0")

# %% [markdown]
# ## A vibrating beam
#
# A square beam of 1 m is clamped at one end. It starts in the shape of its first mode, at rest, and is let go. A *mode* is a
# shape in which the beam can vibrate with one frequency. A slender beam that only bends (Bernoulli and Euler) has the
# displacement $w(\xi, t)$ with
#
# $$
# EI \frac{\partial^4 w}{\partial \xi^4} + \rho_0 \frac{\partial^2 w}{\partial t^2} = 0 . \tag{3.5.10}
# $$
#
# A shape times a function of time,
#
# $$
# w(\xi, t) = W(\xi)\, T(t) , \tag{3.5.11}
# $$
#
# turns this into an equation for the shape,
#
# $$
# W^{(4)} = \beta^4 W . \tag{3.5.12}
# $$
#
# A clamp at one end and neither moment nor force at the other leave certain wavenumbers $\beta$ only,
#
# $$
# \cosh(\beta_n L) \cos(\beta_n L) + 1 = 0 , \tag{3.5.13}
# $$
#
# $$
# \frac{\beta_1 L}{\pi} = 0.59686 , \tag{3.5.14}
# $$
#
# with the shapes
#
# \begin{equation*}
# \begin{aligned}
# W_n = {}& A_n \bigl[ \cosh(\beta_n x) - \cos(\beta_n x) \\
# & + \frac{\cos(\beta_n L) + \cosh(\beta_n L)}{\sin(\beta_n L) + \sinh(\beta_n L)} \\
# & \times \bigl( \sin(\beta_n x) - \sinh(\beta_n x) \bigr) \bigr] ,
# \end{aligned} \tag{3.5.16}
# \end{equation*}
#
# and the lowest frequency
#
# $$
# \omega_1 = \frac{3.516}{L^2} \sqrt{\frac{EI}{\rho_0}} . \tag{3.5.15}
# $$
#
# The tip moves by $2 A_1$, which is the key `start.amplitude` of the case.

# %% tags=["remove-input"]
page.misprint("E3.19", "E3.20")

# %% tags=["remove-input"]
page.figure(
    "fig_3_13",
    "(a) The kinetic energy of the first mode, with two shear stiffnesses and of the consistent rod. Count the peaks: the beam is "
    "fastest twice in each period, on its way up and on its way down. So the kinetic energy has half the period of the "
    "motion. (c) The whole kinetic energy of $c_4 = 20$ has a fast ripple, which is explained below.",
)

# %% tags=["remove-input"]
page.rows("F3.13", "3.5.1")

# %% tags=["remove-input"]
page.misprint("E3.18", "E3.25")

# %% tags=["remove-input"]
page.player(
    "play_vibration",
    "One period, slowed down some hundred times. Watch the two energies below the beam: where the beam is straight all of it is "
    "kinetic, where it is bent most all of it is strain energy. Their sum stays.",
)

# %% [markdown]
# Frequencies can be found without any motion, from the stiffness and the mass of the rod: `cosserat.modes`. The motion must agree
# with them, and its energy must stay as it is:

# %% tags=["remove-input"]
lines = []
for name, row in (("vibration_c4_2", "F3.13-period-c4-2"), ("vibration_c4_20", "F3.13-period")):
    data = page.data(name)
    energy = (data.kinetic_energy + data.strain_energy).to_numpy()
    seen = 2 * float(page.row(row)["measured"])
    mode = 1 / float(cosserat.modes(cosserat.case(name), 1).natural_frequency[0])
    assert abs(seen / mode - 1) < 1e-3
    assert np.abs(energy / energy[0] - 1).max() < 1e-8
    lines.append([name, f"{seen:.5f}", f"{mode:.5f}", page.tens(np.abs(energy / energy[0] - 1).max())])
page.table(
    lines,
    (
        "case",
        "period, twice that of the kinetic energy [s]",
        "period of the lowest mode [s]",
        "change of energy [1]",
    ),
)

# %% tags=["remove-input"]
page.player(
    cosserat.animate(cosserat.modes("vibration_c4_20", 4)),
    "The same modes, each at its own pace. The higher ones are faster; the third one stretches the beam and does not bend it.",
    name="play_modes",
)

# %% tags=["remove-input"]
page.figure(
    "fig_modes",
    "The lowest modes of the beam with $c_4 = 20$, each at both ends of its swing; the amplitude is arbitrary. (a), (b) and (d) "
    "bend, with one more point at rest each time. In (c) the bar moves along its axis: compare the distances of the sections. Arrows go from one end of the "
    "swing to the other.",
)

# %% tags=["remove-input"]
beam = cosserat.case("vibration_c4_20")
fine = beam.vary("fine", rod={"vertices": 10 * beam.problem.rod.vertices})
coarse_one, fine_one = (
    2 * np.pi * float(cosserat.modes(case, 1).natural_frequency[0]) for case in (beam, fine)
)
bernoulli = beams.first_frequency(beam_of(beam.problem))
assert fine_one < bernoulli < coarse_one
page.text(
    f"The lowest frequency is {bernoulli:.1f} rad/s by (3.5.15), {coarse_one:.1f} rad/s with {beam.problem.rod.vertices} "
    f"vertices and {fine_one:.1f} rad/s with ten times as many. The published rod bends at inner vertices only, so half an "
    "edge beside the clamp is rigid, and the beam is too stiff. With more vertices this effect vanishes. What remains is too "
    "soft: the layer beside the clamp, which the part on the calibration calls a hinge."
)

# %% [markdown]
# ## Two methods, one motion
#
# Where does the ripple in Fig. 3.13 come from? At the start each director is turned with the beam, except the clamped one. The
# first edge is tilted already, and by (3.3.8) the tangent at the clamp is that of this edge. So the clamped section is sheared
# at the start, and with $c_4 = 20$ shear is stiff. The energy that is stored there becomes a vibration of the vertices beside
# the clamp. The next lines compare the implicit method with the explicit one over a quarter of a period.

# %% tags=["remove-cell"]
short = beam.vary("short", duration="15 ms")
implicit = cosserat.run(short)
explicit = cosserat.run(
    short.vary("short", integrator={"method": "rk45", "step": "1 s", "tolerance": 1e-8})
)
problem = beam.problem
system, start = problem.system(problem.rod.geometry()), problem.begin()
every = problem.modes(start.q.size)
coordinates = every.coordinates(system.inertia, [start.q - problem.rod.geometry().q])[0]
energy = (every.angular_frequency * coordinates) ** 2 / 2
stiff = int(np.argmax(energy[1:])) + 1
shape = np.abs(every.shape[stiff]).reshape(problem.rod.vertices, -1)
assert shape.max(axis=1).argmax() == 1  # beside the clamp


def tip(run):
    """Displacement of the last vertex across the beam."""
    return run.x.sel(axis="E2").isel(vertex=-1).to_numpy()


def first_mode(run):
    """Kinetic energy of the lowest mode."""
    rates = np.concatenate([run.x_rate, run.d_rate], axis=2).reshape(run.sizes["time"], -1)
    return every.coordinates(system.inertia, rates)[:, 0] ** 2 / 2


def difference(read):
    """Largest difference of the two runs, and the largest value."""
    return np.abs(read(implicit) - read(explicit)).max(), np.abs(read(explicit)).max()


tips, slow, whole = (
    difference(read) for read in (tip, first_mode, lambda run: run.kinetic_energy.to_numpy())
)
assert tips[0] < 0.02 * tips[1]
assert slow[0] < 5e-3 * slow[1]

# %% tags=["remove-input"]
page.text(
    f"The first mode has {100 * energy[0] / energy.sum():.0f} % of the energy of the start. A single other mode has "
    f"{100 * energy[stiff] / energy.sum():.0f} %, with a period of {2e6 * np.pi / every.angular_frequency[stiff]:.0f} µs. "
    f"The implicit step is {1e6 * problem.integrator.step:.0f} µs, which is about as long: it cannot follow this mode. Even "
    f"so the tips of both methods agree to {100 * tips[0] / tips[1]:.1f} % of the amplitude, and the kinetic energies of the "
    f"first mode to {100 * slow[0] / slow[1]:.2f} %. Only the whole kinetic energies differ, by up to {whole[0]:.2f} of "
    f"{whole[1]:.1f} J. The long steps keep the energy of the fast mode but not its phase. So the form of the ripple depends "
    "on the step. The stored file has a warning about it. The period of the beam does not depend on the step."
)

# %% [markdown]
# ## Coming to rest
#
# The thesis finds its equilibria by damping: it releases the rods and waits. It gives no law of damping. The library takes a force
# $-c\, \mathbf{M} \dot{\mathbf{q}}$ with $c = 2 \zeta \omega_1$, the lowest frequency $\omega_1$ of the supported rod, and
# $\zeta = 1$, which is critical damping: the slowest mode returns to rest without swinging past it. The force vanishes at rest,
# so it cannot change the equilibrium.
#
# The damping multiplies all momenta by $e^{-ch/2}$ before each step and after it, so every mode loses its energy at the rate
# $c$, also one that the step cannot follow. The energy that is lost is stored as `dissipated_energy`.

# %% tags=["remove-input"]
page.misprint("E3.22")

# %% tags=["remove-input"]
page.player(
    "play_relaxation",
    "The four rods of the last part are let go and settle, slowed down some seven times. The number behind each name "
    "magnifies the displacements. Look how soon each is at rest: the lowest mode does not swing past it.",
)

# %% [markdown]
# The four rods of the last part come to rest at the equilibria that Newton's method has found:

# %% tags=["remove-input"]
lines = []
for name in ("hanging_bar", "clamped_free", "clamped_clamped", "necking"):
    settled, newton = page.data(f"relaxing_{name}"), page.data(name)
    size = float(np.abs(newton.u).max())
    apart = max(float(np.abs(settled[v][-1] - newton[v]).max()) for v in ("x", "d")) / size
    ratio = float(settled.kinetic_energy[-1] / settled.strain_energy[-1])
    assert apart < 1e-6
    lines.append([name, page.tens(apart), page.tens(ratio)])
page.table(
    lines,
    (
        "rod",
        "distance from Newton's equilibrium / largest displacement [1]",
        "kinetic / strain energy at the end [1]",
    ),
)

# %% [markdown]
# ## A rod in the air
#
# A rod without supports is the hardest test of a method: it rotates through large angles, bends and stretches at once, and no
# support hides an error. This one is bent like a clamped beam in its first mode, thrown up with 2 m/s, and spun with 20 rad/s
# about its first end. There is no gravity.

# %%
thrown = cosserat.case("vibration_c4_20").vary(
    "thrown",
    supports=[],
    start={"amplitude": "5 cm", "speed": "2 m/s", "along": "E2", "spin": "20 rad/s"},
    duration="0.1 s",
    every="2 ms",
)
flight = cosserat.run(thrown)
total = (flight.kinetic_energy + flight.strain_energy).to_numpy()
spin = flight.angular_momentum.to_numpy()
print(f"change of energy {np.abs(total / total[0] - 1).max():.0e}")
print(f"change of angular momentum {np.abs(spin / spin[0] - 1).max():.0e}")

# %% tags=["remove-cell"]
assert np.abs(total / total[0] - 1).max() < 1e-8
assert np.abs(spin / spin[0] - 1).max() < 1e-10

# %% tags=["remove-input"]
page.player(
    replace(cosserat.animate(flight), title="A rod in the air"),
    "The flight of this rod, slowed down. It rises and spins, and bends to and fro at the same time.",
    name="play_thrown",
)

# %% [markdown]
# ## Exercises
#
# :::{admonition} Exercise 3.4: the period by hand
# :class: exercise
# Find $\beta_1 L$ from (3.5.13) by bisection, and from it the period $2\pi/\omega_1$ of the vibrating beam: 1 m long, 0.1 m
# square, 1 GPa, 10 kg/m. The thesis gives about 0.03 s. What has this period?
# :::

# %% tags=["hide-cell"]
below, above = 1.8, 1.9
for _ in range(50):
    middle = (below + above) / 2
    below, above = (middle, above) if np.cosh(middle) * np.cos(middle) + 1 > 0 else (below, middle)
second_moment = 0.1**4 / 12
omega = below**2 / 1.0**2 * np.sqrt(1e9 * second_moment / 10)
print(f"beta_1 L = {below:.5f}, period {2 * np.pi / omega:.4f} s, half of it {np.pi / omega:.4f} s")
# the kinetic energy is largest twice in a period, so it has half the period
assert abs(np.pi / omega / float(page.row("F3.13-period-analytic")["measured"]) - 1) < 1e-6

# %% [markdown]
# :::{admonition} Exercise 3.5: a thinner beam
# :class: exercise
# The beam is made half as high, and its mass halves with it. What happens to the lowest frequency by (3.5.15)? Compute both
# beams with `cosserat.modes`, with the consistent rod. The computed ratio is a little higher than yours. Why?
# :::

# %% tags=["hide-cell"]
high = cosserat.case("vibration_consistent")
low = high.vary("low", rod={"section": {"height": "5 cm"}, "material": {"line_density": "5 kg/m"}})
before, after = (float(cosserat.modes(case, 1).natural_frequency[0]) for case in (high, low))
print(f"{before:.3f} Hz and {after:.3f} Hz: a ratio of {after / before:.4f}")
# EI falls to 1/8 and the mass to 1/2, so the frequency falls to 1/2.  Shear and the rotation of the sections slow down the
# higher beam, which the formula of Bernoulli and Euler leaves out; the thinner one hardly feels them.
assert 0.5 < after / before < 0.51

# %% [markdown]
# :::{admonition} Exercise 3.6: momenta of the thrown rod
# :class: exercise
# The thrown rod has the mass $m = 10$ kg and the length $L = 1$ m. Its points start with the velocity $v + \omega \xi$ across
# it. Compute its momentum along $\mathbf{E}_2$ and its angular momentum about the origin. Compare them with the stored ones at
# the start and at the end. Why is the angular momentum slightly larger?
# :::

# %% tags=["hide-cell"]
m, L, v, omega = 10.0, 1.0, 2.0, 20.0
momentum, angular = m * (v + omega * L / 2), m * (v * L / 2 + omega * L**2 / 3)
print(f"by hand {momentum:.1f} kg m/s and {angular:.1f} kg m²/s")
found = flight.momentum.sel(axis="E2").to_numpy()
print(
    f"stored {found[0]:.1f} and {spin[0]:.1f} at the start, {found[-1]:.1f} and {spin[-1]:.1f} at the end"
)
# the sections rotate too, with m H²/12 each metre, and the bent rod has mass beside its axis
assert abs(found[0] / momentum - 1) < 1e-3
assert 0 < spin[0] / angular - 1 < 0.01
