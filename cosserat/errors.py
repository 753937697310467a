"""Errors that a user can act on: each names the thing, the value and the remedy in one sentence."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cosserat.text import printable, shown

if TYPE_CHECKING:
    import xarray as xr

    from cosserat.solution import Solution


class CosseratError(Exception):
    """Base of every error the package raises on purpose; the command line prints it without a traceback."""

    def __reduce__(self) -> tuple[object, ...]:
        """For other processes, without what belongs to the solver of this one."""
        known = {
            name: value for name, value in self.__dict__.items() if name not in ("state", "reached")
        }
        return type(self), self.args, known


class InputError(CosseratError):
    """A case, a file or an argument is invalid."""

    def __init__(self, message: str) -> None:
        super().__init__(printable(message))  # it quotes what was given


def path_of(given: object) -> Path:
    """A path, given as a path or as a text.

    Raises
    ------
    InputError : it is neither.
    """
    if not isinstance(given, str | os.PathLike):
        raise InputError(f"{shown(given)} names no file; give a path as a text or a pathlib.Path")
    try:
        path = Path(given)
    except TypeError:
        raise InputError(
            f"{shown(given)} names no file; give a path as a text or a pathlib.Path"
        ) from None
    try:
        if not path.is_absolute():
            os.getcwd()
    except FileNotFoundError:
        raise InputError("the current folder is gone; change to one that exists") from None
    try:
        os.fsencode(path).decode()
        path.stat()
    except (FileNotFoundError, NotADirectoryError, PermissionError):
        pass  # whoever reads or writes it says so
    except (
        OSError,
        ValueError,
    ) as error:  # too long, a link to itself, with a null character, or not in UTF-8
        why = getattr(error, "strerror", None) or error
        raise InputError(f"{shown(str(path))} cannot name a file ({why}); give another path") from None
    return path


NO_MEMORY = "there is not enough memory; use fewer vertices, sections, elements or frames"


class OverLimitError(InputError):
    """A run would take more time or space than allowed; the sentence names the limit and how to raise it."""


class CosseratWarning(UserWarning):
    """Something that a user should know about a file or a folder; warnings about numbers are in the Dataset."""


class ChangedResultWarning(CosseratWarning):
    """A result was written by another program or changed: nothing says that a solver computed its values."""


class UnsupportedRodError(InputError):
    """The supports leave the rod free to move without deforming."""


class NotConvergedError(CosseratError):
    """A solver could not meet its tolerance; nothing is returned in its place.

    Attributes
    ----------
    iterations : iterations done before giving up.
    residual, tolerance : the largest unbalanced force and the largest one allowed [N].
    state : the last `Equilibrium` found, or None; its `factor` is the fraction of the load there.
    reached : the last equilibrium or the points of the path up to there, as a `Solution`, or None.
    dataset : the same as a Dataset, for a case run by `cosserat.run`.
    """

    state: Any = None
    reached: Solution | None = None
    dataset: xr.Dataset | None = None

    def __init__(
        self,
        message: str,
        *,
        iterations: int = 0,
        residual: float = math.nan,
        tolerance: float = math.nan,
    ) -> None:
        super().__init__(message)
        self.iterations = iterations
        self.residual = residual
        self.tolerance = tolerance


class OutOfReachError(CosseratError):
    """A state exists but the theory cannot place it in space."""


class CrossingError(CosseratError):
    """Neighbouring sections of a rod cross: its material would pass through itself.

    reached, dataset : the part reached before, or None, as in NotConvergedError.
    """

    reached: Solution | None = None
    dataset: xr.Dataset | None = None


class UnstableError(CosseratError):
    """Small motions about a configuration grow, so it has no vibrations."""


class DivergedError(CosseratError):
    """A motion grew without bound; the part before is kept."""


class OutOfToleranceError(CosseratError):
    """A claim of the results table, or a comparison with a stored result, does not hold."""


class FailedMembersError(CosseratError):
    """The answer of a study is whole, but some of its members have none."""
