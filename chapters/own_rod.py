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
# # Your own rod
#
# This page makes a soft finger from an empty file: a square bar of silicone rubber that sticks out of a wall, bends under its
# weight, and is pushed up again by a jet of air at its tip. Every file, command and picture below was written, run and
# drawn while the book was built, in an empty folder. Type them into a folder of your own, and you get the same numbers.
#
# :::{admonition} After this page you can
# :class: objectives
#
# * describe a rod, its supports and its loads in a few lines, and solve it;
# * read an error message of the library and repair the case;
# * compare a result with a closed form, and judge its mesh;
# * let one quantity vary and draw the answer.
# :::
#
# ## The rod
#
# The finger is 12 cm long and 12 mm thick. Silicone rubber has a Young's modulus of about 1 MPa and a Poisson's ratio
# near one half. Make an empty file `my.toml` and write the finger into it:

# %% tags=["remove-input"]
from cosserat.thesis.book import page

here = page.Folder.new()
here.write(
    "my.toml",
    """
[finger]
kind = "rod statics"
supports = [{ at = "first", fixed = "clamped" }]
gravity = { g = "9.81 m/s^2", along = "-E2" }

[finger.rod]
energy = "consistent"
vertices = 41
length = "12 cm"
section = { shape = "square", side = "12 mm", shear_factor = "5/6" }
material = { young = "1 MPa", poisson = 0.45, density = "1100 kg/m^3" }
""",
)

# %% [markdown]
# Read it line by line.
#
# * `[finger]` is the name of the case. The `kind` says what is asked: an equilibrium. Other kinds are motions, natural modes,
#   paths and critical loads.
# * A rod lies along $\mathbf{E}_3$, and $\mathbf{E}_2$ points up. So gravity acts along `"-E2"`. Its first vertex is
#   clamped: it neither moves nor turns. The last vertex has no support.
# * `energy = "consistent"` takes all stiffnesses from the material and the section. Use it for your own rods. The other choice,
#   `"published"`, is the rod of the thesis.
# * The rod is computed at 41 vertices. More vertices are more accurate, and slower.
# * Every number has a unit, in the way people write it. The library computes in SI units.
#
# Now solve it. The command writes the result into a file and tells how well the forces are in balance:

# %% tags=["remove-input"]
here.command("cosserat run finger --file my.toml")

# %% [markdown]
# and draw it:

# %% tags=["remove-input"]
here.command("cosserat plot finger.nc")

# %% tags=["remove-input"]
here.picture(
    "finger.svg",
    "A bar that is fixed to a wall at its left end and hangs down to the right, above six curves: displacements, section "
    "strain, shear angle, forces and bending moment along the bar.",
    "The finger in its true proportions, and what happens along it. Arrows are directors: they turn with the sections. The "
    "bending moment is largest at the wall and falls to zero at the tip.",
)

# %% [markdown]
# ## Numbers
#
# A result is an `xarray.Dataset`: each variable has named dimensions, a unit and a description. Ask it in Python:

# %%
import cosserat

finger = cosserat.load("finger.nc")
sag = -finger.u.sel(axis="E2")[-1].item()  # u is the displacement in m, at every vertex; -1 is the last
support = finger.reaction_force.sel(axis="E2", support="first").item()
weight = 1100 * 12e-3**2 * 0.12 * 9.81
print(f"the tip sinks by {1e3 * sag:.1f} mm")
print(f"the wall carries {support:.4f} N, and the finger weighs {weight:.4f} N")

# %% tags=["remove-cell"]
assert abs(support / weight - 1) < 1e-9

# %% [markdown]
# That the wall carries the weight is a good first check of any result: it fails if a load is forgotten or acts in another
# direction. `cosserat show finger.nc` lists all variables, and the page [What a result holds](conventions.ipynb) draws their
# signs.
#
# ## A mistake
#
# A jet of air pushes the tip with 40 g. So a scale says, and so we write:

# %% tags=["remove-input"]
here.write(
    "my.toml",
    """
[pushed]
like = "finger"
follower_forces = [{ at = "last", along = "E2", force = "40 g" }]
""",
)

# %% tags=["remove-input"]
here.command("cosserat run pushed --file my.toml", status=2)

# %% [markdown]
# The command ends with the exit status 2 and writes no file. Its message has three parts, as all messages of the library
# have: *where* (the case and the key; lists count from 0), *what* (the value as you wrote it, and what is wrong with it), and
# *what to do*. A gram is a mass. A scale that shows 40 g measures about 0.4 N. Correct the line in the file:

# %% tags=["remove-input"]
here.replace("my.toml", '"40 g"', '"0.4 N"')

# %% tags=["remove-input"]
here.command("cosserat run pushed --file my.toml")

# %% [markdown]
# ## A load that follows the rod
#
# `like = "finger"` copies the first case, and the next lines change it. The force is a *follower force*: when the tip turns, the
# force turns with it, as an air jet at the tip does. A dead force, such as a weight on a thread, would keep its
# direction; its key is `forces`.

# %% tags=["remove-input"]
here.command("cosserat plot pushed.nc")

# %% tags=["remove-input"]
here.picture(
    "pushed.svg",
    "The same bar, bent upward in a wide curve by an arrow at its tip that stands at right angles to it, above the six "
    "curves along the bar.",
    "The jet lifts the tip and keeps at right angles to it. The finger is far from straight: a linear beam theory does not "
    "hold here.",
)

# %% [markdown]
# How much does it matter that the force follows? Change the case in Python. `vary` takes the new name and the keys that change; a
# key that takes `()` is empty again.

# %%
pushed = cosserat.load("pushed.nc")
dead = cosserat.case("pushed", "my.toml").vary(
    "dead", follower_forces=(), forces=[{"at": "last", "along": "E2", "force": "0.4 N"}]
)
lifted = cosserat.run(dead)
for name, result in (("the follower force", pushed), ("the dead force", lifted)):
    along, up = 1e3 * result.u[-1].to_numpy()
    print(f"{name} moves the tip by {along:.1f} mm along E3 and {up:.1f} mm along E2")

# %% tags=["remove-cell"]
assert abs(pushed.u - lifted.u).max() > 1e-3

# %% [markdown]
# ## Is it right?
#
# Compare with something that you know. A cantilever under its weight $q$ per length sinks, in the linear theory of
# Timoshenko, by
#
# $$
# w = \frac{q L^4}{8 E I} + \frac{q L^2}{2 k G A} .
# $$
#
# The linear theory holds for small deflections. So let gravity become smaller, and see whether the ratio of both numbers goes to
# one:

# %%
side, length, young = 12e-3, 0.12, 1e6
shear_modulus = young / (2 * (1 + 0.45))
for g in (9.81, 9.81 / 10, 9.81 / 100):
    case = cosserat.case("finger", "my.toml").vary("light", gravity={"g": g, "along": "-E2"})
    found = -cosserat.run(case).u.sel(axis="E2")[-1].item()
    q = 1100 * side**2 * g
    linear = q * length**4 / (8 * young * side**4 / 12)
    linear += q * length**2 / (2 * 5 / 6 * shear_modulus * side**2)
    print(f"g = {g:6.4f} m/s^2: {found / linear:.5f} of the linear deflection")

# %% tags=["remove-cell"]
assert abs(found / linear - 1) < 5e-4
assert abs(sag / (100 * linear) - 1) > 5e-3

# %% [markdown]
# Under its whole weight the finger sinks less than the linear theory says, because the load's arm becomes shorter as the finger
# hangs down. At a hundredth of the weight both agree, up to the error of 41 vertices.
#
# And how large is this error? The option `--estimate-error` solves the case on finer meshes and extrapolates:

# %% tags=["remove-input"]
here.command("cosserat run finger --file my.toml --estimate-error", first=5)

# %% [markdown]
# The displacement is accurate to a fraction of a micrometre. The next lines of the output say the same of moments, forces and
# energy, or say that they cannot tell.
#
# ## A study in five lines
#
# How thick should the finger be? Let the side of its square vary, and keep one number of each member:

# %% tags=["remove-input"]
here.write(
    "my.toml",
    """
[sides]
kind = "study"
of = "finger"
keep.sag = "u.E2 at last"
vary = [{ rod.section.side = ["8 mm", "10 mm", "12 mm", "14 mm", "16 mm"] }]
""",
)

# %% tags=["remove-input"]
here.command("cosserat study sides --file my.toml")

# %%
answer = cosserat.load("sides.nc")
for side, sag_of_side in zip(answer.side.to_numpy(), answer.sag.to_numpy(), strict=True):
    print(f"{1e3 * side:4.0f} mm: the tip sinks by {-1e3 * sag_of_side:4.1f} mm")

# %% tags=["remove-input"]
here.command("cosserat plot sides.nc")

# %% tags=["remove-input"]
here.picture(
    "sides.svg",
    "Five points on a rising curve: the thicker the bar, the nearer its tip stays to its place.",
    "A finger twice as thick weighs four times as much and is sixteen times as stiff, so it sinks to about a quarter.",
)

# %% tags=["remove-cell"]
assert answer.sizes == {"side": 5}
assert 3.2 < answer.sag.values[0] / answer.sag.values[-1] < 4

# %% [markdown]
# The page [Studies](studies.ipynb) has larger ones: distributions, sensitivities, fits and designs. [Keys of a case](case_keys.ipynb)
# lists everything that a rod may have.
#
# ## Exercises
#
# :::{admonition} Exercise R.1: A round finger
# :class: exercise
#
# Give the finger a round section of the same area. Does it sink more or less than the square one? Estimate by which factor
# before you compute.
# :::

# %% tags=["hide-cell"]
import math

diameter = 2 * 12e-3 / math.sqrt(math.pi)
section = {"shape": "circle", "diameter": diameter, "shear_factor": "cowper"}
round_finger = cosserat.run(cosserat.case("finger", "my.toml").vary("round", rod={"section": section}))
more = round_finger.u.sel(axis="E2")[-1].item() / -sag
# The area is the same, so the weight is too. I is A^2 / 12 for a square and A^2 / (4 pi) for a circle.
print(f"it sinks {more:.3f} times as far; pi / 3 is {math.pi / 3:.3f}")
assert abs(more / (math.pi / 3) - 1) < 0.01

# %% [markdown]
# :::{admonition} Exercise R.2: Does it swing?
# :class: exercise
#
# Compute the three lowest natural frequencies of the finger with `cosserat.modes`. How far is the first one from the
# frequency of Euler and Bernoulli's cantilever, $f = \frac{1.875^2}{2 \pi} \sqrt{E I / (\rho A L^4)}$?
# :::

# %% tags=["hide-cell"]
frequencies = cosserat.modes(cosserat.case("finger", "my.toml"), 3).natural_frequency.to_numpy()
root = 1.9
for _ in range(20):  # cos(root) cosh(root) = -1, by Newton's method
    left = math.cos(root) * math.cosh(root) + 1
    root -= left / (math.cos(root) * math.sinh(root) - math.sin(root) * math.cosh(root))
beam = root**2 / (2 * math.pi) * math.sqrt(1e6 * 12e-3**2 / (12 * 1100 * 0.12**4))
print("in Hz:", *(f"{f:.2f}" for f in frequencies))
print(f"the first is {100 * (frequencies[0] / beam - 1):.1f} % off the beam's {beam:.2f} Hz")
# The finger hangs a little, which raises its frequency, and its shear and rotary inertia lower it.
assert abs(frequencies[0] / beam - 1) < 0.02

# %% [markdown]
# :::{admonition} Exercise R.3: The finger stands up
# :class: exercise
#
# Turn the finger so that it stands on the wall: gravity acts along `"-E3"`. How many times its weight could it carry before
# it buckles? The kind is `critical loads`. Greenhill's column buckles when $q L^3 / E I$ reaches 7.84.
# :::

# %% tags=["hide-cell"]
here.write(
    "my.toml",
    """
[upright]
like = "finger"
kind = "critical loads"
gravity.along = "-E3"
""",
)
upright = cosserat.run(cosserat.case("upright", "my.toml"))
factor = upright.special_load_factor[0].item()
greenhill = 7.84 * 1e6 * 12e-3**2 / 12 / (1100 * 9.81 * 0.12**3)
print(f"it buckles at {factor:.3f} times its weight, Greenhill's column at {greenhill:.3f}")
# Shear makes the finger a little softer than Greenhill's column.
assert 0.98 < factor / greenhill < 1
