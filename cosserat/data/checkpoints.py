"""Parts of a long run on disk: each a whole netCDF file, so an interrupted run can resume."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from cosserat.data.netcdf import load, save, stored_digest
from cosserat.errors import InputError

_MUST_AGREE = ("parameters", "source", "environment")
_AFTER = "continues"
"""Attribute of a part: the digest of the part before it, empty in the first."""


@dataclass(frozen=True)
class Parts:
    """The folder `<result>.parts` beside a result that is being computed."""

    result: Path

    @property
    def folder(self) -> Path:
        """The folder of the parts."""
        return self.result.with_name(f"{self.result.name}.parts")

    def check(self) -> None:
        """Raise InputError if something else has the name of the folder, before anything is computed."""
        if self.folder.exists() and not self.folder.is_dir():
            raise InputError(
                f"{self.folder} is a file, where the parts of the run go; move it away or choose another file with "
                "--output"
            )

    def load(self, number: int) -> xr.Dataset | None:
        """A stored part, or None if it has not been computed yet.

        Raises
        ------
        InputError : it is damaged, changed, or does not continue the part before it.
        """
        path = self._path(number)
        if not path.exists():
            return None
        remedy = f"remove {path} and run the same command again; the run goes on from the part before it"
        try:
            part = load(path, own=True)
        except InputError as error:
            raise InputError(f"{str(error).split(';')[0]}; {remedy}") from None
        if part.attrs.get(_AFTER) != self._before(number):
            raise InputError(f"{path} does not continue the part before it; {remedy}")
        return part

    def save(self, number: int, part: xr.Dataset, *, whole: bool = True) -> None:
        """Store a part; an unfinished one goes to `stopped.nc`, and no run resumes from it."""
        with contextlib.suppress(OSError):  # `save` says what is wrong with a folder that cannot be made
            self.folder.mkdir(exist_ok=True)
        path = self._path(number) if whole else self.folder / "stopped.nc"
        save(part.assign_attrs({_AFTER: self._before(number)}), path)

    def remove(self) -> None:
        """Delete the parts after the result is saved, and the folder if it is empty."""
        for ours in ("[0-9]*.nc", "stopped.nc", ".*.nc.*.part"):
            for part in self.folder.glob(ours):
                part.unlink(missing_ok=True)
        with contextlib.suppress(OSError):
            self.folder.rmdir()

    def check_same_run(self, part: xr.Dataset, fresh: xr.Dataset) -> None:
        """Raise InputError if a stored part is of another case, code or environment than the resuming run."""
        for key in _MUST_AGREE:
            if part.attrs.get(key) != fresh.attrs.get(key):
                raise InputError(
                    f"{self.folder} holds parts of a run with other {key}; continuing would mix the two: "
                    f"remove that folder to start again, or restore the earlier {key}"
                )

    def _before(self, number: int) -> str:
        """The digest of the part before one."""
        return str(stored_digest(self._path(number - 1))) if number else ""

    def _path(self, number: int) -> Path:
        return self.folder / f"{number:05d}.nc"
