"""The module of WebAssembly that finds the equilibria of a rod as it is pulled, and a process that makes it.

`python -m cosserat.export.webassembly.build FILE` is that process.  Numba must not optimise there: see
`cosserat.export.webassembly.compiled`.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from cosserat.errors import CosseratError
from cosserat.export.webassembly.linked import module

NAMES = {"pull", "evaluate", "reserve", "sin", "cos", "tan", "atan2"}
"""The functions of the module.

pull (room, size, vertices, by_3, by_2) and evaluate (room, size, vertices, task) : those of
`cosserat.export.webassembly.pulled`; room is the address of the array, size the number of its floats.
reserve (bytes) : an address with so much room.
"""


def pulled_rod() -> bytes:
    """The module; the same sources and versions of LLVM and Numba give the same bytes.  It takes 20 s.

    Raises
    ------
    CosseratError : the compiler failed; its last words are in the message.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "object"
        # all that the names of symbols, and so their order, could depend on is fixed
        settings = {"NUMBA_OPT": "0", "NUMBA_CACHE_DIR": folder, "PYTHONHASHSEED": "0"}
        done = subprocess.run(
            [sys.executable, "-m", __name__, str(path)],
            env={**os.environ, **settings},
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode or not path.is_file():
            raise CosseratError(
                f"the rod could not be compiled for WebAssembly; the compiler says: {done.stderr[-2000:].strip()}"
            )
        return module(path.read_bytes(), NAMES)


def _write_object(path: Path) -> None:
    """Compile the functions in this process, which must be without optimisation."""
    from cosserat.solvers.kernels import cache_nothing

    cache_nothing()
    from cosserat.export.webassembly.compiled import Export, compile_less, object_code, types
    from cosserat.export.webassembly.pulled import evaluate_rod, pull_rod

    compile_less()
    whole, real = types.int64, types.float64
    path.write_bytes(
        object_code(
            [
                Export("pull", pull_rod, (whole, real, real), whole),
                Export("evaluate", evaluate_rod, (whole, whole), real),
            ]
        )
    )


if __name__ == "__main__":
    _write_object(Path(sys.argv[1]))
