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
# The table has one row for each number or curve that the thesis publishes, and some others. *Printed text* is that of the
# page, never corrected; if the page claims that two curves agree at some coefficients, it is those coefficients.
# The kind of a row is the source of *expected*. For *printed*, it is that number in SI units. For *analytic*, it is a closed
# form: that of the page if it claims agreement with it, another exact one for our own rows (they begin with C). For *in
# words*, it is the statement. For *literature*, it is a measurement in a source of the page that the page does not print. An
# *arithmetic* number follows from other numbers of the page: nothing is solved for it, and its standing is only
# *recomputed*. Closed forms use the inputs as the page prints them, not those of the solved case.
#
# *Measured* comes from the stored datasets. A row claims that the measured number lies within its tolerance. If the page is
# wrong or has a reading that does not agree, the row claims that the number lies outside, at the value that the row gives.
# Rows of one number in several readings name the first of them.

# %% tags=["remove-input"]
from cosserat.thesis.book import page
from cosserat.thesis.table.measure import summary
from cosserat.thesis.table.power import changes
from cosserat.thesis.table.tolerances import read_report

report = read_report(page.results() / "report.csv")
attempted = [row for row in report if row["standing"] != "not attempted"]
page.text("\n\n".join(summary(report).splitlines()))

# %% tags=["remove-input"]
lines = [
    [
        row["id"],
        f"{row['quantity']} ({row['where']})",
        row["published"],
        page.amount(row["expected"], row["units"]),
        page.amount(row["measured"], row["units"]),
        row["verdict"],
        " ".join((f"{row['kind']}:", row["standing"], row["erratum"])),
    ]
    for row in attempted
]
page.table(
    lines, ("row", "quantity", "printed text", "expected", "measured", "verdict", "kind: standing")
)

# %% [markdown]
# ## The reasons for the tolerances

# %% tags=["remove-input"]
page.table(
    [
        [
            row["id"],
            f"{row['tolerance']} {row['tolerance_kind']}",
            f"{row['found']} ± {row['found_tolerance']}" if row["found"] else "",
            row["reading_of"],
            row["error_over_tolerance"],
            row["why"],
        ]
        for row in attempted
    ],
    ("row", "tolerance", "found outside at", "reading of", "error / tolerance", "why"),
)

# %% [markdown]
# ## The sensitivity of the claims
#
# `cosserat power` changes inputs and physics one at a time and names the rows whose claims then fail: a modulus, a
# length, a load, a coefficient, a mass, a characteristic of the energy. Each change makes a row of the changed cases fail,
# except for the following, which change no number of the table:

# %% tags=["remove-input"]
page.table(
    [[change.what, change.unseen] for change in changes() if change.unseen],
    ("change", "why no row notices"),
)

# %% tags=["remove-cell"]
assert sum(not change.unseen for change in changes()) > 50

# %% [markdown]
# ## Not attempted yet

# %% tags=["remove-input"]
later = [row for row in report if row["standing"] == "not attempted"]
shown = page.text("Nothing: every row is attempted.")
if later:
    shown = page.table(
        [[row[name] for name in ("id", "where", "quantity", "published", "why")] for row in later],
        ("row", "where", "quantity", "published", "why not"),
    )
shown

# %% tags=["remove-cell"]
assert not [row["id"] for row in report if row["verdict"] == "FAILS"]
