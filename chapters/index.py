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
# of planar motion. This book computes what the thesis publishes, beside the equations, and judges every number.
#
# Each page was executed when the book was built. Equations carry the numbers of the thesis; code shown beside them is
# the library's own, not a copy. A figure is followed by the rows of the results table that judge it, and the book cannot
# be built while one of those claims fails.
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
# ch5_peers
# results_table
# errata
# left_out
# case_keys
# python_api
# ```

# %% tags=["remove-input"]
from cosserat.thesis.book import page
from cosserat.thesis.table.measure import check
from cosserat.thesis.table.tolerances import read_report

page.figure(
    "fig_opening",
    "Above, four times of a stride; lines across the worm are equally far from each other at rest. Below, states of a "
    "column and an arch as their loads grow, and of a free rod in flight. The last state is dark.",
)

# %% tags=["remove-input"]
page.text(f"**The results table today:** {check(read_report(page.results() / 'report.csv'))}.")

# %% [markdown]
# ## Put in your own rod
#
# A case is a few lines of TOML that may start from a published one. Numbers carry their units; misspelt, missing
# and out-of-range values are errors with a sentence.
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
