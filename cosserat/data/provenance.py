"""Origin of a result: the version and the code that computed it, without a date."""

from __future__ import annotations

import functools
import hashlib
import importlib.metadata
import platform
from pathlib import Path

_PACKAGE = Path(__file__).parents[1]
_COMPUTING = (
    "arguments.py",
    "errors.py",
    "limits.py",
    "signals.py",
    "memory.py",
    "reading.py",
    "explain.py",
    "quantities.py",
    "solution.py",
    "text.py",
    "threads.py",
    "units.py",
    "parameters.py",
    "synonyms.py",
    "tables.py",
    "problem.py",
    "kinds.py",
    "publications.py",
    "progress.py",
    "runner.py",
    "exact",
    "solvers",
    "rods",
    "problems",
    "peristalsis",
    *(
        f"studies/{name}.py"
        for name in (
            "keys",
            "between",
            "readouts",
            "distributions",
            "designs",
            "study",
            "factors",
            "family",
            "solving",
            "derivatives",
            "reduced",
        )
    ),
    "cases",
    "describe/keys.py",
    "describe/__init__.py",
    "data",
    "thesis/__init__.py",
    "thesis/earthworm.py",
    "thesis/variables.py",
    "thesis/worm_calibration.py",
)


def computing_sources() -> list[Path]:
    """The modules that can change a computed result, sorted: a change of one makes simulations run again.

    Case files are not among them: each case is an input by itself.
    """
    return sorted(
        file
        for name in _COMPUTING
        for file in ([_PACKAGE / name] if name.endswith(".py") else (_PACKAGE / name).rglob("*.py"))
    )


@functools.cache
def source() -> str:
    """Package version and a digest of the computing code."""
    digest = hashlib.sha256()
    for file in computing_sources():
        digest.update(file.relative_to(_PACKAGE).as_posix().encode())
        digest.update(file.read_bytes())
    return f"cosserat {importlib.metadata.version('cosserat')}, code sha256:{digest.hexdigest()[:16]}"


def environment() -> dict[str, str]:
    """Versions that may change the last digits of a result."""
    return dict(_versions())


@functools.cache
def _versions() -> tuple[tuple[str, str], ...]:
    """The versions of this process; to look them up takes milliseconds."""
    names = ("numpy", "scipy", "numba")
    found = [(name, importlib.metadata.version(name)) for name in names]
    return ("python", platform.python_version()), *found
