"""Whether equilibria keep their bits from processor to processor: `python -m tests.processors`.

Each process solves the same members with other kernels of OpenBLAS, or with code that Numba compiles for another
processor, and prints a digest of the answers.  Fails if one differs.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import tempfile

CORES = ("Prescott", "Nehalem", "Sandybridge", "Haswell", "Zen", "SkylakeX")
TARGETS = ("generic", "haswell", "host")


def digest() -> str:
    """A digest of the answers of members of four families, with those of their single runs."""
    import numpy as np

    import cosserat
    from cosserat.problems.many import solve_many

    found = hashlib.sha256()
    spread = np.linspace(0.5, 1.0, 200)
    for case, columns in (
        ("elastica", {"forces.0.force": 4.6 * spread}),
        ("elastica", {"rod.section.height": 0.012 * spread, "rod.material.poisson": 0.4 * spread}),
        ("clamped_free_consistent", {"gravity.g": 9.8 * spread}),
        ("clamped_free", {"gravity.g": 9.8 * spread}),
    ):
        many = solve_many(cosserat.case(case).problem, columns)
        assert many is not None
        assert many.solved.all()
        for name in sorted(many.fields):
            found.update(np.ascontiguousarray(many.fields[name][1]).tobytes())
        found.update(np.ascontiguousarray(cosserat.case(case).problem.solve("one")["x"]).tobytes())
    return found.hexdigest()


def main() -> None:
    """Print the digest of every setting; fail if they differ."""
    if sys.argv[1:] == ["one"]:
        print(digest())
        return
    settings = [("OPENBLAS_CORETYPE", core) for core in CORES] + [
        ("NUMBA_CPU_NAME", cpu) for cpu in TARGETS
    ]
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for key, value in settings:
            own = {key: value, "OMP_NUM_THREADS": "1"}
            if key == "NUMBA_CPU_NAME":
                own["NUMBA_CACHE_DIR"] = f"{folder}/{value}"
                if value == "generic":
                    own["NUMBA_CPU_FEATURES"] = ""
                if value == "host":
                    del own[key]
            command = [sys.executable, "-m", "tests.processors", "one"]
            done = subprocess.run(
                command, env=os.environ | own, capture_output=True, text=True, check=True
            )
            found[key, value] = done.stdout.strip()
            print(f"{key}={value}: {found[key, value][:16]}", flush=True)
    if len(set(found.values())) > 1:
        raise SystemExit("the bits differ")


if __name__ == "__main__":
    main()
