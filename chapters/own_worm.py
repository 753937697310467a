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
# # Your own worm
#
# This page makes a small soft robot that crawls like an earthworm, from an empty folder: its body, its muscles, and a gait
# that comes from a table of your own, as you would measure it in a film. As in [Your own rod](own_rod.ipynb),
# everything below was written, run and drawn while the book was built.
#
# :::{admonition} After this page you can
# :class: objectives
#
# * describe a body that crawls, its muscles and its weight;
# * give a gait by the times and places of its fronts, from CSV files;
# * say where the body holds on to the ground, and compute its stride;
# * predict a stride by hand, and check it.
# :::
#
# ## How it crawls
#
# The body has two kinds of muscles. Longitudinal muscles make a part short and fat; such a part *anchors*. Circular muscles
# make a part thin, and since the volume of the body is constant, long; such a part *advances*. The gait says which part does
# what, and when. It does so by *fronts* that travel along the body. Behind a front $\gamma$ the body anchors, and ahead of it the
# body advances. At a front $\eta$ it is the other way round. "Ahead" is the direction of crawling, and places are measured from
# the rear end. The first figure of [Chapter 2](ch2_peristalsis.ipynb) shows a worm with both fronts.
#
# Our robot first anchors everywhere. In the first second a front $\gamma$ starts at its front end and travels to the rear:
# the part ahead of it becomes thin and long, and pushes the front end forward, while the rear end holds. In the second second a
# front $\eta$ follows: the front end is fat again and holds, and the rear is pulled forward.
#
# ## Body and muscles
#
# The first part of the case is the body:

# %% tags=["remove-input"]
from cosserat.thesis.book import page

here = page.Folder.new()
here.write(
    "my.toml",
    """
[robot]
kind = "crawl"
strides = 2
step = "0.02 s"

[robot.crawler]
length = "12 cm"
radius = "8 mm"
mass = "25 g"
material = { kind = "incompressible", young = "20 kPa" }

[robot.loads]
anchoring = "1 N"
advancing = "6 kPa"
""",
)

# %% [markdown]
# * The body at rest is a round bar. A body that varies along its length has `segments`.
# * `incompressible` keeps the volume of every section. A body of foam would be `compressible`, with a Poisson's ratio.
# * `anchoring` is the force of the longitudinal muscles, and `advancing` the pressure of the circular ones.
# * `step` is the time between two computed instants. Each instant is an equilibrium: the robot is slow, and inertia does not
#   matter.
#
# ## The gait, from a table
#
# Somebody has filmed the robot and has noted where each front was. Distances are in cm along the resting body, from its
# rear end. Two files have these notes:

# %% tags=["remove-input"]
here.write(
    "gamma.csv",
    """
time, front
0.0, 12
0.5, 9
1.0, 5
2.0, 0
""",
)

# %% tags=["remove-input"]
here.write(
    "eta.csv",
    """
time [s], front [cm]
1.0, 12
1.5, 7
2.0, 0
""",
)

# %% [markdown]
# The case names the files. The last line says where the robot holds on to the ground. It has points `[phase, place]`: the phase
# counts the durations in `phases`, and the place is 0 at the rear end and 1 at the front end. So the rear end holds in the
# first second, and the front end in the second one.

# %% tags=["remove-input"]
here.write(
    "my.toml",
    """
[robot.gait]
phases = ["1 s", "1 s"]
measured = [
    { front = "gamma", table = "gamma.csv", length = "12 cm" },
    { front = "eta", table = "eta.csv", length = "12 cm" },
]
anchor = [[[0, 0], [1, 0]], [[1, 1], [2, 1]]]
""",
)

# %% tags=["remove-input"]
here.command("cosserat run robot --file my.toml", status=2)

# %% [markdown]
# ## A mistake
#
# One file has a header without units, and the library does not guess. The message names the key, `gait.measured.0.table`
# (lists count from 0), the file and its column, and says what to write. If both files were wrong, it would name both.

# %% tags=["remove-input"]
here.replace("gamma.csv", "time, front", "time [s], front [cm]")

# %% tags=["remove-input"]
here.command("cosserat run robot --file my.toml")

# %% [markdown]
# `cosserat plot robot.nc` draws the last instant, in which the robot is fat everywhere. Python draws any part of a result: here
# all instants until the middle of the second stride.

# %%
import cosserat

robot = cosserat.load("robot.nc")
_ = cosserat.plot(robot.sel(time=slice(0, 3.2)), "second_stride.svg")

# %% tags=["remove-input"]
here.picture(
    "second_stride.svg",
    "A body on the ground that is thin in its middle and fat at both ends, its three stretches along the body with a step at each "
    "front, and the paths of both ends over time: the front end advances first, and the rear end follows.",
    "The robot in its second stride. Above: the thin part is between both fronts; the triangle is the anchor. Middle: the "
    "stretches. Below: the paths of both ends. Each end stays where it is while it is the anchor.",
)

# %% [markdown]
# ## The stride
#
# How far does it crawl in one stride? Ask for the place of the rear end, in m along the ground:

# %%
rear = robot.along.isel(section=0)
stride = rear.sel(time=2.0).item() - rear.sel(time=0.0).item()
print(f"a stride is {1e3 * stride:.2f} mm")

# %% [markdown]
# This number can be predicted. At the end of the first second 7 cm of the body are thin: $\gamma$ has come to 5 cm. They were
# fat at the beginning. A fibre along the body has the stretch $\mu_3$ in either state, so the front end has advanced by
#
# $$
# (12\ \text{cm} - 5\ \text{cm}) \, (\mu_3^\text{thin} - \mu_3^\text{fat}) ,
# $$
#
# and in the second half of the stride the rear end is pulled forward by the same length.

# %%
middle = robot.sel(time=1.0)
thin, fat = middle.mu_3[-1].item(), middle.mu_3[0].item()
predicted = 0.07 * (thin - fat)
print(f"thin: {thin:.3f}, fat: {fat:.3f}; predicted stride {1e3 * predicted:.2f} mm")

# %% tags=["remove-cell"]
assert abs(stride / predicted - 1) < 0.01
assert thin > 1 > fat

# %% [markdown]
# The small difference is the layer round the front, in which the body is neither thin nor fat.
#
# ## A study in five lines
#
# What does a higher pressure of the circular muscles bring? Let it vary:

# %% tags=["remove-input"]
here.write(
    "my.toml",
    """
[pressures]
kind = "study"
of = "robot"
keep.gone = "change along at last"
vary = [{ loads.advancing = ["2 kPa", "4 kPa", "6 kPa", "8 kPa"] }]
""",
)

# %% tags=["remove-input"]
here.command("cosserat study pressures --file my.toml")

# %%
answer = cosserat.load("pressures.nc")
for pressure, gone in zip(answer.advancing.to_numpy(), answer.gone.to_numpy(), strict=True):
    print(f"{1e-3 * pressure:.0f} kPa: {1e3 * gone:5.2f} mm in two strides")

# %% tags=["remove-cell"]
assert abs(answer.gone.sel(advancing=6000.0).item() - 2 * stride) < 1e-6
assert all(answer.gone.diff("advancing") > 0)

# %% [markdown]
# `cosserat plot robot.nc --animate robot.gif` shows the robot crawling. The cases of [Chapter 2](ch2_crawlers.ipynb) are
# examples of other gaits: a robot that pushes and pulls, a worm with two waves, and an inchworm.
#
# ## Exercises
#
# :::{admonition} Exercise W.1: Wait longer
# :class: exercise
#
# Let $\gamma$ come to 2 cm before the anchor changes. Predict the stride, then compute it.
# :::

# %% tags=["hide-cell"]
fronts = {
    "phases": ["1 s", "1 s"],
    "gamma": [[[0, 1], [1, 2 / 12], [2, 0]]],
    "eta": [[[1, 1], [2, 0]]],
    "anchor": [[[0, 0], [1, 0]], [[1, 1], [2, 1]]],
}
longer = cosserat.run(cosserat.case("robot", "my.toml").vary("longer", gait={**fronts, "measured": []}))
rear = longer.along.isel(section=0)
found = rear.sel(time=2.0).item() - rear.sel(time=0.0).item()
print(f"predicted {1e3 * 0.10 * (thin - fat):.2f} mm, computed {1e3 * found:.2f} mm")
assert abs(found / (0.10 * (thin - fat)) - 1) < 0.01

# %% [markdown]
# :::{admonition} Exercise W.2: Backwards
# :class: exercise
#
# Change one line of the case, so that the robot crawls backwards with the same stride.
# :::

# %% tags=["hide-cell"]
swapped = {"gait": {"anchor": [[[0, 1], [1, 1]], [[1, 0], [2, 0]]]}}  # the front end holds first
backwards = cosserat.run(cosserat.case("robot", "my.toml").vary("backwards", **swapped))
rear = backwards.along.isel(section=0)
gone = rear.sel(time=2.0).item() - rear.sel(time=0.0).item()
print(f"the rear end moves by {1e3 * gone:.2f} mm")
assert abs(gone / -stride - 1) < 0.02

# %% [markdown]
# :::{admonition} Exercise W.3: How flat is it?
# :class: exercise
#
# The robot lies on the ground, and its weight flattens it. By how much do the height and the width of its fat part differ? Is the
# weight the reason? Take it away and look.
# :::

# %% tags=["hide-cell"]
weightless = cosserat.run(
    cosserat.case("robot", "my.toml").vary("weightless", strides=1, loads={"gravity": 0.0})
)
for name, result in (("with its weight", robot), ("without", weightless)):
    state = result.sel(time=1.0)
    ratio = state.mu_1[0].item() / state.mu_2[0].item()  # mu_1 is upright, mu_2 across
    print(f"{name}: height over width is {ratio:.5f}")
assert abs(ratio - 1) < 1e-9
assert robot.sel(time=1.0).mu_1[0].item() < robot.sel(time=1.0).mu_2[0].item()
