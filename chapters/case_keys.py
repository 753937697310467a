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
# # Keys of a case
#
# A case is a table of a TOML file. Its `kind` determines its keys; this page lists them from the classes that read
# them. `cosserat describe` prints the same list, and `cosserat schema` gives it to editors. A quantity is a text with its
# unit, such as `"2.5 mm"`; any unit of the same dimension is read. Ratios and whole numbers are written without quotation
# marks. `forces[].at` is the key `at` of each table in the list `forces`. Letters of the thesis, such as $\ell_0$,
# are given with their equation or section.

# %% tags=["remove-cell"]
from cosserat.thesis.book import page

# %% [markdown]
# ## every case

# %% tags=["remove-input"]
page.common_keys()

# %% [markdown]
# ## rod statics

# %% tags=["remove-input"]
page.keys("rod statics")

# %% [markdown]
# ## rod motion

# %% tags=["remove-input"]
page.keys("rod motion")

# %% [markdown]
# ## rod path

# %% tags=["remove-input"]
page.keys("rod path")

# %% [markdown]
# ## modes

# %% tags=["remove-input"]
page.keys("modes")

# %% [markdown]
# ## critical loads

# %% tags=["remove-input"]
page.keys("critical loads")

# %% [markdown]
# ## calibration

# %% tags=["remove-input"]
page.keys("calibration")

# %% [markdown]
# ## discretization errors

# %% tags=["remove-input"]
page.keys("discretization errors")

# %% [markdown]
# ## posture

# %% tags=["remove-input"]
page.keys("posture")

# %% [markdown]
# ## crawl

# %% tags=["remove-input"]
page.keys("crawl")

# %% [markdown]
# ## body mass

# %% tags=["remove-input"]
page.keys("body mass")

# %% [markdown]
# ## worm calibration

# %% tags=["remove-input"]
page.keys("worm calibration")
