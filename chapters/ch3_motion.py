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
# Each vertex has the mass of the part around it. The coordinate $X$ is measured along the director and is 1 at its tip.
# The section at vertex $K$ has the inertias
#
# \begin{equation*}
# \begin{gathered}
# {}_K\rho_0 = \int \rho_0^*\, dA , \\
# {}_K\rho_0\, {}_K Y^{02} = \int X \rho_0^*\, dA , \qquad
# {}_K\rho_0\, {}_K Y^{22} = \int X X \rho_0^*\, dA ,
# \end{gathered} \tag{3.3.28}
# \end{equation*}
#
# which form its mass matrix. The equation of motion of the rod is
#
# $$
# \mathbf{M} \ddot{\mathbf{q}} = \mathbf{F} . \tag{3.3.50}
# $$

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.data.dataset import case_of
from cosserat.exact import beams
from cosserat.rods.energies import hemingway
from cosserat.solvers import energy_momentum
from cosserat.studies.calibration import beam_of
from cosserat.thesis.book import page
from cosserat.thesis.table import readouts

# %% tags=["remove-input"]
page.source(hemingway.Hemingway.mass)

# %% [markdown]
# ## Conservation of energy and momentum
#
# The thesis integrates with an explicit Runge-Kutta method. The highest frequency of the rod limits its step. The library
# has that method too (`rk45`, and `rk4` with a fixed step; a step beyond its limit is an error). The other method resolves
# the motion of interest only. It is the midpoint rule with stresses of the mean strains,
#
# \begin{equation*}
# \begin{aligned}
# \frac{2}{h} \mathbf{M} \left( \frac{\mathbf{q}_1 - \mathbf{q}_0}{h} - \mathbf{v}_0 \right)
# &= \mathbf{F}_{ext} - \sum_s \frac{\partial \Pi_e}{\partial s}\left( \tfrac12 (s_0 + s_1) \right)
# \nabla s \left( \tfrac12 (\mathbf{q}_0 + \mathbf{q}_1) \right) - \sigma \mathbf{z} , \\
# \mathbf{v}_1 &= \frac{2}{h} (\mathbf{q}_1 - \mathbf{q}_0) - \mathbf{v}_0 ,
# \end{aligned}
# \end{equation*}
#
# summed over the strains $s$. Stresses at the midpoint itself would be wrong: a pure rotation by an angle $t$ shortens the
# edges at the midpoint by $t^2/8$, which for a thin rod is a compression beyond buckling. With the mean strains it rotates
# freely at 25 steps a turn. The force $\sigma \mathbf{z}$ makes the work of the elastic forces over the step exactly equal to
# the change of energy: this is Gonzalez's discrete gradient. If $\mathbf{z}$ were the step itself, the force would have a
# resultant. Here $\mathbf{z}$ is the step without its rigid part. So the force has neither a resultant nor a moment, and
# momentum and angular momentum are conserved as well.

# %% tags=["remove-input"]
page.source(energy_momentum._solve_step)

# %% tags=["remove-input"]
page.source(energy_momentum._sigma)

# %% [markdown]
# ## A vibrating beam
#
# A square beam of 1 m, clamped at one end, is released from the first mode of a Bernoulli-Euler beam. Its modes have
#
# $$
# W^{(4)} = \beta^4 W , \tag{3.5.12}
# $$
#
# $$
# \cosh(\beta_n L) \cos(\beta_n L) + 1 = 0 , \tag{3.5.13}
# $$
#
# \begin{equation*}
# \begin{aligned}
# W_n = {}& A_n \bigl[ \cosh(\beta_n x) - \cos(\beta_n x) \\
# & + \frac{\cos(\beta_n L) + \cosh(\beta_n L)}{\sin(\beta_n L) + \sinh(\beta_n L)}
# \bigl( \sin(\beta_n x) - \sinh(\beta_n x) \bigr) \bigr] ,
# \end{aligned} \tag{3.5.16}
# \end{equation*}
#
# both corrected (E3.20); the tip moves by $2 A_1$, which is the key `start.amplitude`. The lowest frequency is
#
# $$
# \omega_1 = \frac{3.516}{L^2} \sqrt{\frac{EI}{\rho_0}} . \tag{3.5.15}
# $$

# %% tags=["remove-input"]
page.figure(
    "fig_3_13",
    "Two shear stiffnesses. The kinetic energy oscillates twice as fast as the beam; the page calls the shorter of the "
    "two the period of vibration. The band of $c_4 = 20$ in (a) is a shear mode that the start excites and the step does not "
    "resolve. The stored file has a warning about it.",
)

# %% tags=["remove-input"]
page.rows("F3.13", "3.5.1")

# %% tags=["remove-input"]
page.player("play_vibration", "Slowed down some hundred times.")

# %% tags=["remove-input"]
lines = []
for name in ("vibration_c4_2", "vibration_c4_20"):
    data = page.data(name)
    energy = (data.kinetic_energy + data.strain_energy).to_numpy()
    tip = readouts.period(data.time.to_numpy(), data.x.sel(axis="E2").isel(vertex=-1).to_numpy())
    mode = 2 * np.pi / case_of(data).problem.modes(1).angular_frequency[0]
    assert abs(tip / mode - 1) < 1e-3
    assert np.abs(energy / energy[0] - 1).max() < 1e-8
    lines.append([name, f"{tip:.5f} s", f"{mode:.5f} s", f"{np.abs(energy / energy[0] - 1).max():.0e}"])
page.table(
    lines,
    ("case", "period of the tip", "period of the lowest mode", "largest relative change of energy"),
)

# %% [markdown]
# The period of the computed motion is that of the lowest mode of the same rod, which follows from its Hessian and its mass.
# `modes` gives frequencies and shapes about any stable equilibrium; an unstable one, such as a column above Euler's
# load, is an error.

# %% tags=["remove-input"]
page.player(
    cosserat.animate(cosserat.modes("vibration_c4_20", 4)),
    "Each mode at its own pace; the amplitudes are arbitrary. The third one stretches the beam and does not bend it.",
    name="play_modes",
)

# %% tags=["remove-input"]
page.figure(
    "fig_modes",
    "The lowest modes of the beam with $c_4 = 20$, each at both extremes. The amplitude is arbitrary. In (c) the bar "
    "oscillates along its axis.",
)

# %% tags=["remove-input"]
beam = case_of(page.data("vibration_c4_20")).problem
found, bernoulli = beam.modes(4).angular_frequency, beams.first_frequency(beam_of(beam))
assert abs(found[0] / bernoulli - 1) < 0.1
fine = beam.replace(rod=beam.rod.replace(vertices=10 * beam.rod.vertices)).modes(1).angular_frequency[0]
assert fine < bernoulli < found[0]
page.text(
    f"The lowest frequency is {bernoulli:.1f} rad/s by (3.5.15), {found[0]:.1f} rad/s with {beam.rod.vertices} vertices "
    f"and {fine:.1f} rad/s with ten times as many. The published energy has bending at interior vertices only, so half an "
    "edge at the clamp is rigid. This effect vanishes under refinement; the hinge of the chapter on calibration remains."
)

# %% [markdown]
# ## Where the two integrators agree
#
# The initial state rotates all directors with the beam except the fixed one at the clamp. The tangent at the clamp is that of
# the first edge, (3.3.9), which is tilted. So the section at the clamp is sheared initially, and with $c_4 = 20$ shear is
# stiff. The energy stored there becomes a vibration of the vertices beside the clamp. It is hundreds of times faster than the
# bending, and a step for the bending cannot resolve it. The following compares both methods over a quarter of a period, from
# rest to the largest velocity.

# %% tags=["remove-cell"]
short = cosserat.case("vibration_c4_20").vary("short", duration="15 ms")
implicit = cosserat.run(short)
explicit = cosserat.run(
    short.vary("short", integrator={"method": "rk45", "step": "1 s", "tolerance": 1e-8})
)
system, start = beam.system(beam.rod.geometry()), beam.begin()
every = beam.modes(start.q.size)
coordinates = every.coordinates(system.mass, [start.q - beam.rod.geometry().q])[0]
energy = (every.angular_frequency * coordinates) ** 2 / 2
stiff = int(np.argmax(energy[1:])) + 1
assert (
    np.abs(every.shape[stiff]).reshape(beam.rod.vertices, -1).max(axis=1).argmax() == 1
)  # beside the clamp


def tip(run):
    """Displacement of the last vertex across the beam."""
    return run.x.sel(axis="E2").isel(vertex=-1).to_numpy()


def first_mode(run):
    """Kinetic energy of the lowest mode."""
    rates = np.concatenate([run.x_rate, run.d_rate], axis=2).reshape(run.sizes["time"], -1)
    return every.coordinates(system.mass, rates)[:, 0] ** 2 / 2


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
    f"The first mode has {energy[0] / energy.sum():.0%} of the initial energy, and a single mode of "
    f"{every.angular_frequency[stiff]:,.0f} rad/s has {energy[stiff] / energy.sum():.0%}. Its period is "
    f"{2 * np.pi / every.angular_frequency[stiff] * 1e6:.0f} µs; the implicit step is "
    f"{beam.integrator.step * 1e6:.0f} µs. The tips agree to {tips[0] / tips[1]:.1%} of the amplitude and the "
    f"kinetic energies of the first mode to {slow[0] / slow[1]:.2%}. The whole kinetic energies differ by up to "
    f"{whole[0]:.2f} of {whole[1]:.1f} J: the long steps keep the energy of the fast vibration but not its phase. "
    "The ripple on the curves of Fig. 3.13 is this vibration. It depends on the step as well as on the rod; the period does not."
)

# %% [markdown]
# ## Coming to rest
#
# The thesis finds its equilibria by releasing the rods and "tuning the material damping towards critical". It gives no
# damping law. The library uses a force $-c\, \mathbf{M} \dot{\mathbf{q}}$, $c = 2 \zeta \omega_1$, with the lowest frequency
# $\omega_1$ of the supported rod and $\zeta = 1$. It multiplies all momenta by $e^{-ch/2}$ before and after each undamped step.
# So every mode loses its energy at the rate $c$, even if the step does not resolve it, as long as $c\, \omega h^2 < 8$.
# Inside the midpoint rule the damping of such a mode would be $1 + (\omega h/2)^2$ times too small. The file stores the
# dissipated energy. The four rods of the last chapter come to rest at the equilibria of Newton's method. The implicit method
# computes this here; the explicit method of the thesis gives the same in many more steps.

# %% tags=["remove-input"]
page.player(
    "play_relaxation",
    "The number behind each name magnifies the displacements. Slowed down some seven times.",
)

# %% tags=["remove-input"]
lines = []
for name in ("hanging_bar", "clamped_free", "clamped_clamped", "necking"):
    settled, newton = page.data(f"relaxing_{name}"), page.data(name)
    size = float(np.abs(newton.u).max())
    difference = max(float(np.abs(settled[v][-1] - newton[v]).max()) for v in ("x", "d")) / size
    ratio = float(settled.kinetic_energy[-1] / settled.strain_energy[-1])
    assert difference < 1e-6
    lines.append([name, f"{difference:.0e}", f"{ratio:.0e}"])
page.table(
    lines,
    (
        "rod",
        "distance from Newton's equilibrium / largest displacement",
        "kinetic / strain energy at the end",
    ),
)

# %% [markdown]
# ## A rod in the air
#
# This rod has no supports. It is thrown up, spins and bends in flight.

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
print(
    f"energy changes by {np.abs(total / total[0] - 1).max():.0e}, angular momentum by {np.abs(spin / spin[0] - 1).max():.0e}"
)

# %% tags=["remove-cell"]
assert np.abs(total / total[0] - 1).max() < 1e-8
assert np.abs(spin / spin[0] - 1).max() < 1e-10
