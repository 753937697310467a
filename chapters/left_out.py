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
# # What is left out
#
# Each numbered equation, figure and table of the thesis is either used in this book, in the package or in its tests, or it is
# listed here with the reason. A test compares this list with all citations: nothing is missing, and nothing is in both.

# %% tags=["remove-input"]
from cosserat.thesis.book import page

listed = page.left_out()
(equations, of_equations), (figures, of_figures), (tables, of_tables) = map(
    listed.kept, ("equations", "figures", "tables")
)
page.text(
    f"The book and the package use {equations} of {of_equations} equations and {tables} of {of_tables} tables, and draw "
    f"{figures} of {of_figures} figures."
)

# %% tags=["remove-input"]
page.left_out_table()
