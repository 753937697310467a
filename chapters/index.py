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
# # Cosserat curves, reproduced
#
# A directed (Cosserat) rod is a curve whose points carry directors: vectors that say how the cross-section stretches,
# shears and rotates. Evan Hemingway's thesis *Cosserat Curves: Descriptions of Peristalsis and a Discrete Model*
# (University of California, Berkeley, 2020) uses such rods twice: for crawling by peristalsis, and for a discrete model
# of planar motion. This book computes the published results beside the equations, and checks every number.
#
# Each page was executed when the book was built. Equations have the numbers of the thesis. The code beside them is that of
# the library, not a copy. The rows of the results table that check a figure follow it. The book cannot be built while one of
# these claims fails.
#
# ```{toctree}
# :maxdepth: 2
#
# ch1_directed_rod
# ch2_peristalsis
# ch2_crawlers
# ch3_statics
# ch3_motion
# ch3_calibration
# ch3_rods
# ch4_consistent
# studies
# ch5_peers
# reliability
# results_table
# errata
# equations
# left_out
# conventions
# case_keys
# command_line
# python_api
# references
# ```

# %% tags=["remove-input"]
from cosserat.thesis.book import page
from cosserat.thesis.table.measure import check
from cosserat.thesis.table.tolerances import read_report

page.figure(
    "fig_opening",
    "Above: four times of a stride; the lines across the worm have equal distances at rest. Below: states of a "
    "column and an arch as their loads grow, and of a free rod in flight. The last state is dark.",
)

# %% tags=["remove-input"]
page.text(f"**The results table today:** {check(read_report(page.results() / 'report.csv'))}.")

# %% [markdown]
# ## Your own rod
#
# A case is a few lines of TOML that may start from a published one. Numbers have units. A misspelt, missing or out-of-range
# value is an error with a sentence that explains it.
#
# ```toml
# [long_beam]
# like = "clamped_free"
# rod.length = "10 m"
# rod.vertices = 41
# ```
#
# `cosserat run long_beam --file my.toml` writes `long_beam.nc`. The same in Python:

# %%
import cosserat

mine = cosserat.case("clamped_free").vary("long_beam", rod={"length": "10 m", "vertices": 41})
beam = cosserat.run(mine)
print(f"Its tip sinks by {-beam.u.sel(axis='E2')[-1].item():.3f} m.")
