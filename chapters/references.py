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
# # References, and how to cite
#
# The names of authors in the text lead to this page. A DOI stands where it was confirmed.

# %% tags=["remove-input"]
from cosserat.thesis.book import page

page.references()

# %% [markdown]
# ## How to cite
#
# If you use the package or this book, cite both works:

# %% tags=["remove-input"]
page.how_to_cite()

# %% [markdown]
# The package and the text of this book have the licence of MIT; the thesis has that of its author. Each page tells at its
# foot the version and the commit from which it was made.
# `make pdf` prints the whole book as one PDF, `results/cosserat.pdf`.
