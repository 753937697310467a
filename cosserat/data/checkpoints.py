"""Parts of a long run on disk: each a whole netCDF file, so an interrupted run can resume."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from cosserat.data.dataset import load, save
from cosserat.errors import InputError

_MUST_AGREE = ("parameters", "source", "environment")


@dataclass(frozen=True)
class Parts:
    """The folder `<result>.parts` beside a result that is being computed."""

    result: Path

    @property
    def folder(self) -> Path:
        """The folder of the parts."""
        return self.result.with_name(f"{self.result.name}.parts")

    def load(self, number: int) -> xr.Dataset | None:
        """A stored part, or None if it has not been computed yet."""
        path = self._path(number)
        return load(path) if path.is_file() else None

    def save(self, number: int, part: xr.Dataset, *, whole: bool = True) -> None:
        """Store a part; an unfinished one goes to `stopped.nc`, and no run resumes from it."""
        self.folder.mkdir(exist_ok=True)
        save(part, self._path(number) if whole else self.folder / "stopped.nc")

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

    def _path(self, number: int) -> Path:
        return self.folder / f"{number:05d}.nc"
