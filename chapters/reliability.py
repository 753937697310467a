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
# # When things go wrong
#
# A long run may be killed, its disk may be full, its files may be damaged, and somebody may start it twice. Five promises
# hold then:
#
# * A file is whole or absent. Whatever is stored under its name was written to its end.
# * Nothing is lost. The same command goes on from the parts that a run has stored, to the same bytes as without the
#   disturbance.
# * Nothing is silent. A result or a part that was damaged, edited, swapped or replaced is refused by name, or read with the
#   same content.
# * Nothing hangs. Ctrl-C, a batch system's signal and a closed terminal end a run within seconds.
# * An answer is one sentence that names the file and what to do, and an exit code: 2 for what the user can mend, 130, 143 and
#   129 for the three signals.
#
# Each row below is a fault that `python -m tests.hostile.faults` brings about in real processes, many times and at random
# moments. Each attempt is judged by its exit code, its words, its bytes and the files that are left. All random choices follow
# from a seed, so an attempt can be repeated.

# %% tags=["remove-cell"]
import csv

from cosserat.thesis.book import page

with (page.results() / "faults.csv").open(newline="", encoding="utf-8") as stream:
    lines = list(csv.DictReader(stream))
tried, kept = (sum(int(line[key]) for line in lines) for key in ("tried", "as promised"))

# %% tags=["remove-input"]
page.text(
    f"**When it was tried last:** {kept} of {tried} attempts at {len(lines)} faults ended as promised."
)

# %% tags=["remove-input"]
page.table(
    [
        (line["kind"], line["fault"], line["promise"], line["tried"], line["as promised"])
        for line in lines
    ],
    ("kind", "fault", "promise", "tried", "as promised"),
)

# %% [markdown]
# ## Bad input
#
# The commands `python -m tests.hostile inputs`, `fuzz`, `damage` and `lines` try inputs that follow from the classes of
# parameters, and inputs by chance. Each must end in an answer or in one sentence with the exit code 1 or 2, without a
# traceback, a warning of another package or a file left behind, in ten seconds or with a line of progress. A part of
# them is run by `make test`.

# %% tags=["remove-input"]
with (page.results() / "inputs.csv").open(newline="", encoding="utf-8") as stream:
    counts = [tuple(line.values()) for line in csv.DictReader(stream)]
page.table(counts, ("what", "seed", "tried", "as promised"))

# %% [markdown]
# ## What was found

# %% tags=["remove-input"]
failures = [(line["fault"], line["first failure"]) for line in lines if line["first failure"]]
shown = (
    page.table(failures, ("fault", "what was found first, or why it was not tried"))
    if failures
    else None
)
shown or page.text("No attempt ended otherwise.")
