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
# # Errata, assumptions and questions
#
# An *erratum* is a printed form that fails a check which the corrected form passes; a test shows both. An *assumption* is our
# choice where the page is silent or ambiguous, and the alternatives are measured. A *question* is a suspicion without a
# proof. A *refuted* entry looked wrong and is right.

# %% tags=["remove-cell"]
from cosserat.thesis.book import page


def entries(standing):
    found = page.errata(standing)
    assert found
    return page.text(
        "\n\n".join(
            f"**{name}**, {entry.where}\n\n"
            f"- printed: {entry.printed}\n"
            f"- used instead: {entry.corrected}\n"
            f"- why: {entry.why}\n"
            f"- evidence: `{entry.evidence}`"
            for name, entry in found.items()
        )
    )


# %% [markdown]
# ## Errata

# %% tags=["remove-input"]
entries("erratum")

# %% [markdown]
# ## Assumptions

# %% tags=["remove-input"]
entries("assumption")

# %% [markdown]
# ## Questions

# %% tags=["remove-input"]
entries("question")

# %% [markdown]
# ## Refuted

# %% tags=["remove-input"]
entries("refuted")
