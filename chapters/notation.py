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
# # Notation
#
# The symbols of the chapters in the order in which they are defined, with their units, the first equation of the thesis that
# has them, and their names in results and in case files. A letter as index stands for any index; a lower index in front,
# as in ${}_K A$, marks a part of the discrete rod, and an upper one an edge. The names and units of the code come from its
# declarations.

# %% tags=["remove-input"]
from cosserat.thesis.book import page

page.notation()

# %% [markdown]
# ## Letters with several meanings
#
# Each chapter says which one it means.

# %% tags=["remove-input"]
page.several_meanings()

# %% [markdown]
# ## Other symbols of case files and results

# %% tags=["remove-input"]
page.other_symbols()
