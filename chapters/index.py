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
# # Cosserat curves
#
# A directed rod is a curve whose points carry arrows, its *directors*, which say how each cross-section stretches, shears
# and turns. This book teaches such rods, solves them, and checks every number of the doctoral thesis that it follows.

# %% tags=["remove-input"]
from cosserat.thesis.book import page

page.figure(
    "fig_opening",
    "Above: four times of a stride of a worm; the lines across it have equal distances at rest. Below: a column and an arch "
    "as their loads grow, and a free rod in flight. The last state is dark.",
)

# %% [markdown]
# ## Three ways in
#
# **You know beams, and directed rods are new to you.** Read [From beams to directed rods](beams_to_rods.ipynb). Then take
# the short way through the chapters: the hanging bar, the cantilever and the necking bar of
# [Chapter 3](ch3_statics.ipynb), where sections stretch and turn for the first time, and then the worm of
# [Chapter 2](ch2_peristalsis.ipynb), which is the same rod with muscles. Chapters begin with what you can do after
# them, and end with three exercises, whose solutions unfold.
#
# **You have a rod, a robot or a worm of your own.** [Your own rod](own_rod.ipynb) goes from an empty file to a picture and a
# study; [Your own worm](own_worm.ipynb) does the same for a body that crawls. [Keys of a case](case_keys.ipynb) and
# [The library from Python](python_api.ipynb) are the reference.
#
# **You want to know whether the thesis is right, and whether to believe this book.** Each published number is a row of
# the [results table](results_table.ipynb) with its tolerance and its verdict. Each misprint is in the
# [errata](errata.ipynb), with a test in which the printed form fails. What is not treated is in
# [Left out](left_out.ipynb).

# %% tags=["remove-input"]
verdict = page.today()
page.text(f"**The verdict.** {verdict[0]} The results table has {verdict[-1]}.")

# %% [markdown]
# ## How this book is made
#
# The thesis is Evan Hemingway's *Cosserat Curves: Descriptions of Peristalsis and a Discrete Model* (University of
# California, Berkeley, 2020). Equations and figures have its numbers. Each page was executed when the book was built. The code
# beside an equation is that of the library, not a copy, and the book cannot be built while one of its claims fails.
#
# ```{toctree}
# :caption: Start
# :maxdepth: 1
#
# beams_to_rods
# ```
#
# ```{toctree}
# :caption: Theory
# :maxdepth: 1
#
# ch1_directed_rod
# ```
#
# ```{toctree}
# :caption: Worms and robots
# :maxdepth: 1
#
# ch2_peristalsis
# ch2_crawlers
# ```
#
# ```{toctree}
# :caption: The discrete rod
# :maxdepth: 1
#
# ch3_statics
# ch3_motion
# ch3_calibration
# ch3_rods
# ch4_consistent
# pull
# ```
#
# ```{toctree}
# :caption: Your own
# :maxdepth: 1
#
# studies
# own_rod
# own_worm
# ```
#
# ```{toctree}
# :caption: Reference
# :maxdepth: 1
#
# notation
# conventions
# case_keys
# command_line
# python_api
# results_table
# errata
# equations
# left_out
# reliability
# ch5_peers
# references
# ```
