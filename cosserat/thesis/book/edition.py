"""Which book this is: the version of the package, and the commit that it is made from."""

from __future__ import annotations

import functools
import importlib.metadata
import subprocess
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Edition:
    """A state of the repository."""

    version: str
    """Version of the package."""
    commit: str
    """First ten digits of the commit, with "-dirty" if files differ from it; empty outside a repository."""
    date: str
    """Day of the commit, as "2026-11-30"; empty outside a repository."""

    @property
    def text(self) -> str:
        """Version, commit and day in one line."""
        made = f", commit {self.commit} of {self.date}" if self.commit else ""
        return f"version {self.version}{made}"


@functools.cache
def edition() -> Edition:
    """The edition of the book that this package makes; it has the day of a commit, never that of the clock."""
    version = importlib.metadata.version("cosserat")
    root = Path(__file__).parents[3]
    if not (
        root / ".git"
    ).exists():  # an archive, or an installed package inside someone's own repository
        return Edition(version, "", "")
    commit = _git(root, "describe", "--always", "--dirty", "--abbrev=10", "--exclude=*")
    date = _git(root, "log", "-1", "--format=%cs")
    return Edition(version, commit, date) if commit and date else Edition(version, "", "")


def _git(root: Path, *arguments: str) -> str:
    """What git says; empty if there is none, or no commit."""
    try:
        done = subprocess.run(
            ["git", "-C", str(root), *arguments], capture_output=True, text=True, check=False
        )
    except OSError:
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""
