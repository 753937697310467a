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
# # Beside other packages
#
# How accurate is the consistent rod of Chapter 4, and how long does it take, beside other programs for rods? Two packages solve
# the same three problems. Exudyn is a program for systems of rigid and flexible bodies; its beam is the geometrically exact one
# with linear elements. PyElastica is a program for soft rods in space; its rod has straight elements and explicit time
# steps.
#
# :::{admonition} After this chapter you can
# :class: objectives
# * say what is compared, and what is not;
# * read an error and a time from one picture, and choose a number of elements;
# * repeat the comparison on your own machine.
# :::
#
# ## Three problems
#
# * **(a)** The clamped-free beam of section 3.5 sags under its weight. The exact answer is that of the linear beam.
# * **(b)** A slender clamped rod is bent far by a lateral force at its tip, ten times $EI/L^2$, from the straight state. The exact
#   answer is the elastica with stretch and shear.
# * **(c)** The beam of section 3.5 vibrates in its first mode for a fifth of a second. The exact answer is the
#   period of a Timoshenko beam.
#
# All errors are relative to the same exact answers. A time is that of the solver alone: the model is built before, and the
# kernels are compiled before. The packages alternate, run by run, so other work on the machine disturbs all of them alike.

# %% tags=["remove-cell"]
import csv

from cosserat.thesis.book import page

with (page.results() / "peers.csv").open(newline="", encoding="utf-8") as stream:
    lines = list(csv.DictReader(stream))
assert lines, "results/peers.csv is empty"
used = {line["package"]: line["versions"] for line in lines}
runs, dates, processors = (
    " and ".join(sorted({line[key] for line in lines})) for key in ("runs", "date", "processor")
)
load = max(float(line["load"]) for line in lines)
seconds = {(line["problem"], line["package"]): float(line["seconds"]) for line in lines}


def span(seconds):
    """A time as one reads it."""
    value = float(seconds)
    return f"{value:.2f} s" if value >= 1 else f"{1e3 * value:.3g} ms"


# %% tags=["remove-input"]
page.figure(
    "fig_peers",
    "Relative error over the time of the solver; left and low is good. The numbers at the points are those of the elements, and "
    "the pale bars reach from the fastest to the slowest run. Look at one height, one error, in (b) and compare the times.",
)

# %% tags=["remove-input"]
page.text(
    f"Measured on {dates} on one machine ({processors}), medians of {runs} runs, at a system load of up to {load:.1f} "
    "processes. "
    + ("The machine was **busy**: compare ranges, not medians. " if load > 2 else "")
    + "Versions: "
    + "; ".join(f"{package} ({versions})" for package, versions in used.items())
    + "."
)

# %% tags=["remove-input"]
page.folded(
    f"{len(lines)} measurements: medians, ranges and errors",
    page.table(
        [
            (
                line["problem"],
                line["package"],
                span(line["seconds"]),
                f"{span(line['least'])} to {span(line['most'])}",
                span(line["whole"]),
                f"{float(line['error']):.1e}",
            )
            for line in lines
        ],
        ("problem", "package", "median", "range", "whole", "relative error"),
    ),
)

# %% [markdown]
# The column "whole" is the time from the parameters to the answer. For the consistent rod at rest it contains the making of the
# Dataset, which takes longer than the solution.
#
# ## What one sees
#
# **At rest** the consistent rod and Exudyn have the same error on the same mesh, because both are geometrically exact beams with
# linear elements. Their times differ, because the consistent rod does all Newton iterations in one compiled loop. In (b) it
# raises the load in a few increments and predicts each from the path before it, so its answer is the one to which a growing
# load leads. Exudyn has five load steps in (b), which suit it best, and one in (a). PyElastica has no solver for rest. It lets
# the rod move with critical damping until it hardly moves any more, which takes many small steps.
#
# **In motion** the consistent rod and Exudyn make the same 800 implicit steps, and their errors are nearly the same. Exudyn uses the
# trapezoidal rule with a modified Newton method. PyElastica takes explicit steps, nine tenths as long as the longest stable
# one; the finer the mesh, the shorter they are. That is why its time grows faster with the number of elements.

# %% tags=["remove-input"]
per_step = {
    package: 1e9 * seconds["(c) vibration, 2000 elements", package] / (800 * 2000)
    for package in ("cosserat", "Exudyn")
}
page.text(
    f"On the finest mesh of (c) the consistent rod takes {per_step['cosserat']:.0f} nanoseconds a step and an element, and "
    f"Exudyn {per_step['Exudyn']:.0f}. In this time the consistent rod evaluates its gradient in five or six iterations, multiplies "
    "by the mass, and substitutes into a banded factor. There is little left to gain on one core, because in a substitution "
    "each number waits for the one before it."
)

# %% [markdown]
# ## What one does not see
#
# Each package can do what the others cannot, and the three problems show none of it. Exudyn has joints, contact and rigid
# bodies. PyElastica has rods in space with contact and friction. The consistent rod has sections that stretch. The settings of the
# other packages are ours; somebody who knows them better may find faster ones.
#
# ## Measure it yourself
#
# `snakemake peers` makes an environment with both packages, for which it needs a network, measures everything in one run, and
# writes `results/peers.csv`. The next `make` draws the picture and this page from it.
