"""The cache folder of compiled kernels, chosen before Numba is imported."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from cosserat.errors import InputError

_PACKAGE = Path(__file__).parents[1]
FOLDERS = ("solvers", "rods", "rods/energies", "rods/loads", "rods/attachments", "peristalsis")
"""Folders of the package that hold compiled kernels."""


def choose_cache() -> None:
    """Let Numba keep kernels beside their sources, else in the user's cache, else in a private temporary folder.

    If none is writable, every process compiles the kernels. A choice other than the first is reported once on stderr:
    when the folder is made, or by each process that keeps nothing. If NUMBA_CACHE_DIR is set, it is left as it is.

    Raises
    ------
    InputError : Numba is told not to compile.
    """
    if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"):
        raise InputError("NUMBA_DISABLE_JIT is set, and no solver runs uncompiled; unset it")
    beside = [_PACKAGE / folder / "__pycache__" for folder in FOLDERS]
    if os.environ.get("NUMBA_CACHE_DIR") or all(map(_is_writable, beside)):
        return
    for folder in _candidates():
        known = folder.is_dir()
        if _is_writable(folder, 0o700) and _is_private(folder):
            os.environ["NUMBA_CACHE_DIR"] = str(folder)
            if "numba" in sys.modules:  # which reads the environment when it is imported
                sys.modules["numba"].config.CACHE_DIR = str(folder)
            if not known:
                _print_note(f"compiled kernels are kept in {folder}")
            return
    cache_nothing()
    _print_note(
        "compiled kernels are not cached, which costs seconds a run; set NUMBA_CACHE_DIR to a folder to keep them"
    )


def _candidates() -> Iterator[Path]:
    home = Path(os.path.expanduser("~"))
    caches = Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")
    if caches.is_absolute() and (home not in caches.parents or home.is_dir()):  # a missing home stays so
        yield caches / "cosserat"
    try:
        yield Path(tempfile.gettempdir()) / f"cosserat-{os.getuid()}"
    except OSError:
        return


def _is_writable(folder: Path, mode: int = 0o777) -> bool:
    """Whether a file can be written; permissions do not show read-only file systems, nor bind the superuser."""
    try:
        folder.mkdir(mode=mode, parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


def _is_private(folder: Path) -> bool:
    """Whether nobody else can write there: code in a cache is run."""
    about = folder.lstat()
    return about.st_uid == os.getuid() and not about.st_mode & 0o022 and not folder.is_symlink()


def cache_nothing() -> None:
    """Let functions that are decorated from now on keep no compiled code."""
    from numba.core.ccallback import CFunc
    from numba.core.dispatcher import Dispatcher

    for compiled in (CFunc, Dispatcher):
        setattr(compiled, "enable_caching", lambda _: None)  # noqa: B010 - a method, which mypy lets nobody assign


def _print_note(words: str) -> None:
    print(f"cosserat: {_PACKAGE} cannot be written to; {words}", file=sys.stderr)
