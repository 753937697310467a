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
# # The command line
#
# Every command of `cosserat`, from the parser that reads them. `cosserat COMMAND --help` prints the same. Lengths, times
# and other quantities stand in case files, with their units; the options here take names, paths and plain numbers. Times
# in options are in hours, sizes in gigabytes.
#
# A command ends with one of these exit codes:
#
# * 0: it has done what was asked;
# * 1: a solve or a claim failed, or some members of a study have no answer;
# * 2: the input is bad, or the disk is full;
# * 130: it was interrupted by Ctrl-C, 143 by SIGTERM, 129 by SIGHUP.
#
# What goes wrong is one sentence on the standard error, with the name, the value and a remedy.

# %% tags=["remove-input"]
from cosserat.thesis.book import page

page.commands()
