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
# A long run may be killed. Its disk may be full, its files may be damaged, and somebody may start it twice. The package makes
# five promises for such days:
#
# * **A file is whole or absent.** What has the name of a result was written to its end.
# * **Nothing is lost.** A run stores its parts. The same command goes on from them, and ends with the same bytes as without
#   the disturbance.
# * **Nothing is silent.** A result or a part that somebody has changed, damaged or replaced is refused, with the name of the
#   file; or it is read and has the same content.
# * **Nothing hangs.** Ctrl-C, the signal of a batch system and a closed terminal each end a run within seconds.
# * **An answer is one sentence.** It names the file and says what to do. The exit code tells a program the same: 2 is a
#   fault that the user can mend; 130, 143 and 129 are the three signals.
#
# Three limits of these promises:
#
# * **A digest is no signature.** There is no secret, so whoever changes a file can compute its digests anew, and the file
#   alone does not show it. Outputs of a release have a second witness: the manifest, which is tracked with the code.
#   `cosserat verify` compares all of them with it; `measure`, `figure` and `check` say which of those that they read is not
#   as released. A result of one's own has no such witness.
# * **Libraries do not bear a lack of memory.** LLVM ends the process, and OpenBLAS asks for its work space for ever, deaf to
#   Ctrl-C. So under a limit of memory a second process watches, says what happened, and passes signals on. Where the system
#   itself runs out of memory it kills without a word; what is known to need more than is free is refused before.
# * **Locks are those of the file system.** NFS and Lustre pass them on between machines unless they are mounted otherwise. Such
#   a mount, or a shared file system that never does, is named by a warning when a result is written there.
#
# A promise is worth as much as the attempts to break it. So each fault of the table below was brought about in real
# processes, many times and at random moments, by `python -m tests.hostile.faults`. Each attempt was judged by its exit code, its
# words, its bytes and the files that were left. All random choices follow from a seed, so an attempt can be repeated.

# %% tags=["remove-cell"]
import csv

from cosserat.thesis.book import page


def rows_of(name):
    """The rows of a tracked table of the folder results."""
    with (page.results() / name).open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


faults = rows_of("faults.csv")
kinds = list(dict.fromkeys(line["kind"] for line in faults))


def counts(lines):
    """How many attempts there were, and how many ended as promised."""
    return tuple(sum(int(line[key]) for line in lines) for key in ("tried", "as promised"))


# %% tags=["remove-input"]
page.text(
    "**When it was tried last:** {1} of {0} attempts ended as promised, ".format(*counts(faults))
    + f"at {len(faults)} faults of {len(kinds)} kinds."
)

# %% tags=["remove-input"]
page.table(
    [
        (kind, str(len(own)), *map(str, counts(own)))
        for kind in kinds
        for own in [[line for line in faults if line["kind"] == kind]]
    ],
    ("kind of fault", "faults", "attempts", "as promised"),
)

# %% tags=["remove-input"]
page.folded(
    f"All {len(faults)} faults, with what is promised for each",
    page.table(
        [
            (line["kind"], line["fault"], line["promise"], line["tried"], line["as promised"])
            for line in faults
        ],
        ("kind", "fault", "promise", "attempts", "as promised"),
    ),
)

# %% [markdown]
# ## Bad input
#
# Most faults are typing errors. The commands `python -m tests.hostile inputs`, `fuzz`, `damage` and `lines` try what people
# type and what they never would: inputs that follow from the lists of keys, and inputs by chance. Each must end in an
# answer or in one sentence with the exit code 1 or 2. It must not end in a traceback, in a warning of another package or with
# a file left behind. It must end within ten seconds, or show its progress. `make test` runs a part of them.

# %% tags=["remove-input"]
page.table(
    [tuple(line.values()) for line in rows_of("inputs.csv")],
    ("what", "seed", "attempts", "as promised"),
)

# %% [markdown]
# ## What was found

# %% tags=["remove-input"]
failures = [(line["fault"], line["first failure"]) for line in faults if line["first failure"]]
found = page.text("No attempt ended otherwise.")
if failures:
    found = page.table(failures, ("fault", "what was found first, or why it was not tried"))
found
