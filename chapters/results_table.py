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
# # The results table
#
# The table has one row for each number or curve that the thesis publishes, and some others. A row claims that the number
# *measured* in our stored results lies within its tolerance of the *expected* one. If the thesis is wrong, or has a reading
# that does not agree, the row claims that the number lies outside, at the value that the row gives. The book is not built
# while a claim fails. *Error / tolerance* is below 1 within the tolerance; *loose* marks a tolerance that is over a thousand
# times as wide as the error.
#
# *Printed text* is that of the thesis, never corrected. If the thesis claims that two curves agree at some coefficients, it is
# those coefficients. The kind of a row is the source of *expected*:
#
# * *printed*: the printed number, in SI units;
# * *analytic*: a closed form, that of the thesis if it claims agreement with it, another exact one for our own rows, which
#   begin with C;
# * *in words*: a statement of the thesis;
# * *literature*: a measurement in a source of the thesis that the thesis does not print;
# * *arithmetic*: a number that follows from other numbers of the thesis. Nothing is solved for it, and its standing is only
#   *recomputed*.
#
# Closed forms use the inputs as the thesis prints them, not those of the solved case. The reason for each tolerance unfolds
# in its row. Rows of one number in several readings name the first of them there. A word in the field shows only the rows
# that have it, and a heading sorts them.

# %% tags=["remove-input"]
from cosserat.thesis.book import page

page.text("\n\n".join(page.overview()))

# %% tags=["remove-input"]
page.results_table()

# %% [markdown]
# ## The sensitivity of the claims
#
# `cosserat power` changes inputs and physics one at a time and names the rows whose claims then fail: a modulus, a
# length, a load, a coefficient, a mass, a characteristic of the energy. Each change makes a row of the changed cases fail,
# except for the following, which change no number of the table:

# %% tags=["remove-input"]
page.table(
    page.unseen_changes(),
    ("change", "why no row notices"),
)

# %% [markdown]
# ## Not attempted yet

# %% tags=["remove-input"]
later = [row for row in page.report() if row["standing"] == "not attempted"]
shown = page.text("Nothing: every row is attempted.")
if later:
    shown = page.table(
        [[row[name] for name in ("id", "where", "quantity", "published", "why")] for row in later],
        ("row", "where", "quantity", "published", "why not"),
    )
shown

# %% tags=["remove-cell"]
assert not [row["id"] for row in page.report() if row["verdict"] == "FAILS"]
