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
# # Pull it yourself
#
# This page has a rod that you can take by its tip. The page solves each of its equilibria while you move, with the energy
# and the solver of the package. No server and no network is involved.
#
# :::{admonition} After this chapter you can
# :class: objectives
#
# - say which force the hand needs to hold the tip of a rod, and estimate it by beam theory;
# - find by hand where a pushed rod buckles, and say why it cannot stay straight;
# - say what "stable" means for a rod whose ends are held;
# - tell which code has solved the figure, and how far its numbers can be trusted.
# :::
#
# ## The rod
#
# The rod is a bar of soft rubber, 200 mm long and 20 mm thick, clamped at its left end. The hand holds its last vertex at a
# place, and the section there is free to turn. So the place of the tip is prescribed, and the force of the hand is what the
# solver finds. In the package this is a case with two prescribed displacements:

# %% tags=["remove-cell"]
import numpy as np

import cosserat
from cosserat.thesis.book import page

# %% tags=["remove-input"]
page.source("cosserat.thesis.book.pulling.pulled_case")

# %% tags=["remove-input"]
page.pull(
    "The tint is the stretch of the sections: orange where they are thinner than at rest, blue where they are "
    "thicker. The arrow is the force of the hand. The energy is that of the whole rod. On paper, and in a browser "
    "that cannot run the solver, stored equilibria are drawn, above the force of the hand over the way of the tip."
)

# %% [markdown]
# Try three things. Pull the tip to the right: the rod grows thinner everywhere, except near the clamp, where the section
# cannot shrink. Move the tip up: the force is small, because bending is soft. Push the tip straight to the left with the
# arrow key: the force grows, until the rod buckles to one side.
#
# ## Why it buckles
#
# With the tip held, an equilibrium is *stable* if its energy is a minimum among all shapes with the same tip. The solver
# accepts only these. It tests each state by Cholesky's factorisation of the Hessian, the matrix of second derivatives of
# the energy: the factorisation exists only if every small change of shape costs energy. A straight rod that is pushed too
# far fails this test. Then the solver lets the rod fall: step by step its energy decreases, with the tip in place, until it
# is at rest in a minimum. The line below the figure says so. A rod that is symmetric may fall to either side; the solver
# takes one of them. One step of the fall is this: the step is halved until the energy decreases.

# %% tags=["remove-input"]
page.source("cosserat.export.webassembly.pull._descend")

# %% [markdown]
# ## Which code solves it
#
# The functions of the energy and of the solver are written in Python and compiled by Numba. Numba turns them into the
# intermediate code of LLVM, a compiler that knows many processors. One of these is WebAssembly, an imagined
# processor that every browser imitates. So the same lines that solve a case of this book become a module of some 40 kB, which is part of this page. The
# script of the page moves the ring and draws. It contains no mechanics.
#
# The module imports nothing. Sine, cosine, tangent and arctangent usually come from a library, and libraries differ in the
# last bit. The module has its own, built from sums and products alone:

# %% tags=["remove-input"]
page.source("cosserat.export.webassembly.elementary.atan2")

# %% [markdown]
# ## What is guaranteed
#
# Tests compare the module with the package, in a program that runs WebAssembly and lends it nothing.
#
# - *The same bits.* For 200 random states the energy, the gradient and the Hessian have the same bits as those of Numba on an
#   ordinary processor, if Numba is lent the module's four functions. With the functions of the machine's own library
#   they differ by at most 4 units in the last place of the largest term. No sum is reordered, and no product is
#   fused with a sum, in either of them.
# - *The same equilibria.* A rod that is dragged, in one go or in many small steps, ends within $10^{-9}$ of the
#   answer of `cosserat.run` for the same place of the tip. A browser drags the ring of this page with a mouse, a
#   keyboard and a finger, and is compared in the same way.
#
# ## Limits
#
# The material is linear: twice the strain is twice the stress. Rubber is linear only for small strains, so the numbers of a
# rod that is pulled far are those of the model and not those of rubber. The tip stays within 1.25 lengths of the clamp. The
# rod may cross itself, as contact is not part of the model. Where several equilibria exist, the one that you see depends on
# the way that the tip took.
#
# ## Exercises
#
# :::{admonition} Exercise P.1: the force of the hand
# :class: exercise
#
# Move the tip up by 2 mm, one press of the arrow key. Which force does beam theory predict for a cantilever with
# $E$ = 1 MPa, $\nu$ = 0.45 and a square section of 20 mm? How much of the deflection is shear? Why is the force found 3 %
# larger? (The tip cannot come nearer to the clamp, so a bent rod must also stretch.)
# :::

# %% tags=["hide-cell"]
E, nu, side, length, moved = 1e6, 0.45, 0.02, 0.2, 2e-3
base = cosserat.case("elastica").vary(
    "held_tip",
    rod={
        "length": length,
        "section": {"width": side, "height": side},
        "material": {"young": E, "poisson": nu},
    },
    supports=[{"at": "first", "fixed": "clamped"}, {"at": "last", "fixed": "pinned"}],
    forces=[],
)


def held(by_3, by_2):
    """The rod with its tip moved along E3 and E2 [m]."""
    moves = [("x3", by_3), ("x2", by_2)]
    return cosserat.run(
        base.vary(
            "held_tip",
            prescribed_displacements=[{"at": "last", "dof": dof, "by": by} for dof, by in moves],
        )
    )


bending = length**3 / (3 * E * side**4 / 12)
shear = length / (5 / 6 * E / (2 * (1 + nu)) * side**2)
predicted = moved / (bending + shear)
found = held(0, moved).support_force[-1, 1].item()
print(f"{1e3 * predicted:.2f} mN predicted, {1e3 * found:.2f} mN found")
print(f"shear is {100 * shear / (bending + shear):.1f} % of the deflection")
tenth = 10 * held(0, moved / 10).support_force[-1, 1].item()
print(f"ten times the force at a tenth of the way: {1e3 * tenth:.2f} mN")
assert abs(tenth / predicted - 1) < 1e-3
assert (
    0.01 < found / predicted - 1 < 0.05
)  # the tip is held along E3 too, so the bent rod is pulled as well

# %% [markdown]
# :::{admonition} Exercise P.2: where it buckles
# :class: exercise
#
# Euler's load of a column with one clamped and one pinned end is $20.19\, EI/L^2$. By how much is the rod shorter at this
# load? Push the tip to the left in the figure and compare.
# :::

# %% tags=["hide-cell"]
load = 20.19 * E * side**4 / 12 / length**2
shorter = load * length / (E * side**2)
print(f"{load:.2f} N and {1e3 * shorter:.2f} mm by Euler's formula")
sideways = {
    by: np.abs(held(-by, 0).u.sel(axis="E2")).max().item() for by in (0.9 * shorter, 1.1 * shorter)
}
straight, bent = sideways.values()
print(f"largest deflection {1e3 * straight:.1e} mm before and {1e3 * bent:.1f} mm after it")
assert straight < 1e-9
assert bent > 1e-3

# %% [markdown]
# :::{admonition} Exercise P.3: how thin it becomes
# :class: exercise
#
# Pull the tip to the right by 10 mm. By how much are the sections in the middle thinner? Poisson's ratio $\nu$ is 0.45.
# :::

# %% tags=["hide-cell"]
pulled_by = 0.01
middle = held(pulled_by, 0).lam[20].item()
print(
    f"{100 * (middle - 1):.2f} % in the middle; the formula says {-100 * nu * pulled_by / length:.2f} %"
)
assert abs((middle - 1) / (-nu * pulled_by / length) - 1) < 0.02
