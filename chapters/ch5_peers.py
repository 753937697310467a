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
# `snakemake peers` makes an environment of its own with Exudyn and PyElastica, which needs a network, and solves the same
# problems with them and with the consistent rod, in one go on one machine: (a) the clamped-free beam of section 3.5 under
# its weight; (b) a slender clamped rod under a dead force of ten $EI/L^2$ across its tip, from the straight rod; (c) a
# fifth of a second of the vibrating beam in 800 implicit steps. Times are those of the solver alone, with the model built and
# the kernels compiled; the packages take turns, run by run. Errors are taken against the same exact answers for everyone.
#
# Exudyn's beam is the geometrically exact one with linear elements, its statics has five load steps in (b), which suit it
# best, and one in (a),
# its motion the trapezoidal rule with a modified Newton method. PyElastica has no static solver: it relaxes, critically damped,
# to where it hardly moves; its motion is explicit, at nine tenths of the stable step.

# %% tags=["remove-cell"]
import csv

from cosserat.thesis.book import page

with (page.results() / "peers.csv").open(newline="") as stream:
    lines = list(csv.DictReader(stream))
used = {line["package"]: line["versions"] for line in lines}
runs, dates, processors = (
    " and ".join(sorted({line[key] for line in lines})) for key in ("runs", "date", "processor")
)
load = max(float(line["load"]) for line in lines)


def span(seconds):
    """A time as one reads it."""
    value = float(seconds)
    return f"{value:.2f} s" if value >= 1 else f"{1e3 * value:.3g} ms"


# %% tags=["remove-input"]
page.table(
    [
        (
            line["problem"],
            line["package"],
            span(line["seconds"]),
            f"{span(line['least'])} to {span(line['most'])}",
            f"{float(line['error']):.1e}",
        )
        for line in lines
    ],
    ("problem", "package", "median", "range", "relative error"),
)

# %% tags=["remove-input"]
page.text(
    f"Measured last on {dates}, processor {processors}; medians of {runs} runs, while up to {load:.1f} processes wanted "
    "the machine. "
    + ("That is a **busy machine**: compare ranges, not medians. " if load > 2 else "")
    + "Versions: "
    + "; ".join(f"{package} ({versions})" for package, versions in used.items())
    + "."
)

# %% [markdown]
# What bounds the consistent rod: in (a) and (b) the Newton iterations, some 35 microseconds each at 20 vertices, of which the
# compiled kernel takes 4 and LAPACK's banded Cholesky 3; the rest is NumPy and Python around them, which finer meshes
# outgrow. In (b) the load grows in some ten increments that the path before them predicts, forty iterations in all, so the
# answer is the one that the growing load leads to; a single increment took eight, and could end on the wrong side.
#
# In (c) everything is compiled, and the arithmetic accounts for all of the time. A step takes five or six iterations of the
# modified Newton method; each evaluates the gradient at the middle and the energy at the end of the step in one pass (some
# 70 nanoseconds a vertex), multiplies by the mass (20) and substitutes into a factor (60) that is computed again in one step
# of ten or twenty. That adds up to the measured time. A gradient is some two hundred additions and multiplications, two roots,
# nine divisions and an arctangent, so it runs near what one core does in scalar arithmetic; the substitution is a chain in
# which every number waits for the one before, which no wider unit shortens.
