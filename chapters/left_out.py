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
# Each numbered equation, figure and table of the thesis is either used, in this book, in the package or in its tests, or it
# stands here with the reason. A test compares this list with all citations: nothing is missing, nothing is in both.

# %% tags=["remove-input"]
from cosserat.thesis.book import page

listed = page.left_out()
(equations, of_equations), (figures, of_figures), (tables, of_tables) = map(
    listed.kept, ("equations", "figures", "tables")
)
page.text(
    f"Used are {equations} of {of_equations} equations and {tables} of {of_tables} tables; drawn are {figures} of "
    f"{of_figures} figures."
)

# %% tags=["remove-input"]
page.table(
    [(item.what, item.where, item.why) for item in listed.left_out], ("what", "in the thesis", "why")
)
