"""Words that people use for keys and kinds of cases, so that an error can name the one that is meant."""

from __future__ import annotations

from collections.abc import Collection

SYNONYMS = {
    "bearings": "supports",
    "boundary_conditions": "supports",
    "buckling": "critical loads",
    "constraints": "supports",
    "direction": "along",
    "distributed_loads": "line_loads",
    "dynamics": "rod motion",
    "e": "young",
    "eigenfrequencies": "modes",
    "eigenmodes": "modes",
    "elastic_foundation": "foundations",
    "elements": "vertices",
    "frequencies": "modes",
    "from": "start",
    "g": "shear_modulus",
    "gait": "crawl",
    "ground": "foundations",
    "hold": "fixed",
    "intensity": "density",
    "loads": "forces",
    "modal": "modes",
    "moments": "couples",
    "nodes": "vertices",
    "nu": "poisson",
    "outer_diameter": "diameter",
    "point_masses": "masses",
    "points": "probes",
    "prestress": "prestrains",
    "q": "density",
    "radius": "diameter",
    "rho": "density",
    "sensors": "probes",
    "thickness": "wall",
    "to": "end",
    "torques": "couples",
    "weight": "gravity",
    "winkler": "foundations",
    "worm": "crawl",
    "youngs_modulus": "young",
}
"""For each word, in lower case, what it is called in a case."""


def meant(word: str, known: Collection[str]) -> str | None:
    """The known name that a word stands for: by `SYNONYMS`, or as one of its words ("statics" in "rod statics")."""
    other = SYNONYMS.get(word.lower())
    if other in known:
        return other
    within = [name for name in known if word.lower() in name.lower().split()]
    return within[0] if len(within) == 1 else None
