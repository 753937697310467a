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
# # Where each equation is
#
# Each numbered equation of the thesis leads here if no page shows it. The table lists the functions of the library that
# use it, the tests that check it, its misprints and the rows of the results table about it. Equations that nothing uses
# are on the page [What is left out](left_out.ipynb).

# %% tags=["remove-input"]
from cosserat.thesis.book import page

found = page.counts()
page.text(
    f"Of {sum(found.values())} equations, {found['shown']} are shown in this book, {found['library']} others are used in "
    f"the library, {found['tests']} are checked by tests alone, {found['elsewhere']} are the subject of misprints and rows "
    f"alone, and {found['left out']} are left out."
)

# %% tags=["remove-input"]
page.equations()
