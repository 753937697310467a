"""`python -m tests.studies.fit [COUNT]`: how often intervals of fits hold the true values, of 100 fits by default.

The data are the exact elastica's tip, from elliptic integrals, with normal noise of a fixed seed.  Exit 1 if the
intervals of a key, of 95 %, hold its true value less than 89 of 100 times, which has a chance below 1 %.
"""

from __future__ import annotations

import sys

import numpy as np

import cosserat
from cosserat.exact.elastica import transverse_tip

TRUE = {"rod.material.young": 1e9, "rod.length": 1.0}
START = {"material": {"young": 0.8e9}, "length": 1.05}
OF = {"across": "u.E2 at last", "along": "u.E3 at last"}
NOISE = {"across": 3e-3, "along": 2e-3}  # m
FORCES = np.linspace(0.5, 4.5, 7)  # N


def exact():
    """The tip of the true rod under each force, (forces,) by read-out."""
    stiffness = TRUE["rod.material.young"] * cosserat.case("elastica").problem.rod.second_moment
    tips = np.array([transverse_tip(force / stiffness) for force in FORCES])
    return {"across": tips[:, 0], "along": -tips[:, 1]}


def fitted(seed):
    """A fit to noisy data."""
    random = np.random.default_rng(seed)
    data = {
        word: values + random.normal(0, NOISE[word], FORCES.size) for word, values in exact().items()
    }
    case = cosserat.case("elastica").vary("measured", rod=START)
    return cosserat.fit(case, {"forces.0.force": FORCES, **data}, list(TRUE), OF, deviations=NOISE)


def holds(found):
    """Whether each interval holds the true value."""
    words = {path: path.rpartition(".")[2] for path in TRUE}
    return {
        path: found[f"{word}_low"].item() <= TRUE[path] <= found[f"{word}_high"].item()
        for path, word in words.items()
    }


def main(count):
    kept, variances = dict.fromkeys(TRUE, 0), []
    for seed in range(count):
        found = fitted(seed)
        variances.append(found.attrs["reduced_chi_square"])
        for path, inside in holds(found).items():
            kept[path] += inside
    for path, number in kept.items():
        print(f"{path}: {number} of {count} intervals hold the true value")
    print(f"mean of the reduced chi square {np.mean(variances):.3f}, 1 for noise of the stated size")
    return int(min(kept.values()) < 0.89 * count)


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 100))
