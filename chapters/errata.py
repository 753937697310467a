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
# choice where the thesis is silent or ambiguous, and the alternatives are measured. A *question* is a suspicion without a
# proof. A *refuted* entry looked wrong and is right. The code of each test unfolds below its entry.

# %% tags=["remove-cell"]
from cosserat.thesis.book import page

# %% [markdown]
# ## Errata

# %% tags=["remove-input"]
page.errata_list("erratum")

# %% [markdown]
# ## Assumptions

# %% tags=["remove-input"]
page.errata_list("assumption")

# %% [markdown]
# ## Questions

# %% tags=["remove-input"]
page.errata_list("question")

# %% [markdown]
# ## Refuted

# %% tags=["remove-input"]
page.errata_list("refuted")
