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
# # Comparison with other packages
#
# `snakemake peers` makes an environment with Exudyn and PyElastica, for which it needs a network. It solves the same problems
# with them and with the consistent rod, in one run on one machine: (a) the clamped-free beam of section 3.5 under its weight;
# (b) a slender clamped rod under a lateral dead force of ten $EI/L^2$ at its tip, from the straight rod; (c) a fifth of a
# second of the vibrating beam in 800 implicit steps. Times are those of the solver alone, after the model is built and the
# kernels are compiled. The packages alternate, run by run. All errors are relative to the same exact answers.
#
# Exudyn's beam is the geometrically exact one with linear elements. Its statics has five load steps in (b), which suit it best,
# and one in (a). Its motion uses the trapezoidal rule with a modified Newton method. PyElastica has no static solver: it
# relaxes with critical damping until it hardly moves. Its motion is explicit, at nine tenths of the stable step.

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
            span(line["whole"]),
            f"{float(line['error']):.1e}",
        )
        for line in lines
    ],
    ("problem", "package", "median", "range", "whole", "relative error"),
)

# %% tags=["remove-input"]
page.text(
    f"Measured last on {dates}, processor {processors}; medians of {runs} runs, at a system load of up to {load:.1f} "
    "processes. "
    + ("The machine was **busy**: compare ranges, not medians. " if load > 2 else "")
    + "Versions: "
    + "; ".join(f"{package} ({versions})" for package, versions in used.items())
    + "."
)

# %% [markdown]
# The time of the consistent rod in (a) and (b) is that of the Newton iterations, in one compiled loop. Each takes some ten
# microseconds at 20 vertices: the kernel takes four, the banded Cholesky factorisation two, and its substitution one. In (b)
# the load grows in five or six increments, which the path before them predicts. They take nine iterations in all, and the
# answer is the one that the growing load leads to. The column "whole" is the time from the parameters to the answer. For the
# consistent rod at rest that is from the case to the Dataset, and most of it is the making of the Dataset.
#
# In (c) everything is compiled, and the arithmetic accounts for all of the time. A step takes five or six iterations of the
# modified Newton method. Each evaluates the gradient at the middle and the energy at the end of the step in one pass (some
# 70 nanoseconds a vertex), multiplies by the mass (20) and substitutes into a factor (60) that is computed again in one step
# of ten or twenty. The sum is the measured time. A gradient has some two hundred additions and multiplications, two roots,
# nine divisions and an arctangent, so it is near the limit of scalar arithmetic on one core. In the substitution each number
# depends on the one before, so vector units do not make it faster.
