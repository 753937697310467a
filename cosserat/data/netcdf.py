"""Datasets in netCDF files that are whole or absent, with a digest of their bytes."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import xarray as xr

from cosserat.data.content import is_as_computed
from cosserat.data.dataset import FORMAT, INTACT, version_of
from cosserat.data.digest import DamagedError, digest_of, is_marked, seal
from cosserat.data.files import check_destination, netcdf_path, whole_or_absent
from cosserat.data.readable import check_readable
from cosserat.data.writable import check_writable
from cosserat.errors import ChangedResultWarning, InputError, path_of
from cosserat.signals import uninterrupted
from cosserat.text import printable, shown
from cosserat.threads import FILES

_FRAME = "frame"
"""Dimension of instants in a file, with `time` along it.  Tools of CF take a dimension named `time` for dates; here
times are plain seconds from the start."""
_UNKNOWN = "the netCDF library failed, perhaps for want of memory"
_TRIALS = 5  # to read a file that somebody replaces meanwhile
_SHORT = 150  # characters of an error of the library in a sentence


def save(dataset: xr.Dataset, path: str | Path) -> None:
    """Write a netCDF file under a temporary name and rename it, so that no half-written file is ever seen.

    The same Dataset gives the same bytes.  A Dataset that is as it was computed gets the digest of these bytes at the
    end; a changed one has none, and says so when it is read.  Instants are along the dimension `frame` of
    the file, with `time` as their coordinate in plain seconds.

    How a file that was read stored its values (`encoding`) is left out, since it need not fit to others.

    Raises
    ------
    InputError : the destination cannot be written, or the Dataset holds what no netCDF file can: an attribute or values
        that are neither texts nor numbers, or a name that is no text.
    """
    path = path_of(path)
    check_destination(path, ".nc")
    if not isinstance(dataset, xr.Dataset):
        raise InputError(f"save takes a Dataset, not {shown(dataset)}; give a result of cosserat")
    check_writable(dataset)
    written = dataset.drop_encoding()
    if "time" in dataset.dims:
        written = written.rename_dims(time=_FRAME)
    encoding = {
        str(name): {"_FillValue": None}
        for name, variable in dataset.variables.items()
        if variable.dtype.kind == "f"
    }
    with whole_or_absent(path, dataset.nbytes) as temporary:
        try:
            with FILES, uninterrupted():
                written.to_netcdf(
                    netcdf_path(temporary), engine="netcdf4", format="NETCDF4", encoding=encoding
                )
        except RuntimeError:  # of HDF5, which does not say why
            raise OSError(_UNKNOWN) from None
        except (TypeError, ValueError, AttributeError, KeyError) as error:
            raise InputError(
                f"{path} cannot be written: the netCDF library refuses what the Dataset holds "
                f"({printable(error)[:_SHORT]}); take out what was added to it"
            ) from error
        if is_as_computed(dataset):
            seal(temporary)


def load(path: str | Path, *, own: bool = False) -> xr.Dataset:
    """Read a result whole into memory, after its bytes were compared with the digest at their end.

    It is first read in a process that can be stopped, since a damaged file can keep HDF5 for ever and anybody can make
    a digest.  A result that another program wrote or changed has no digest and comes with a `ChangedResultWarning`.

    own : refuse such a result.

    Raises
    ------
    InputError : the file is missing, damaged, or no result of this version of cosserat.
    """
    path = existing(path)
    for _ in range(_TRIALS):
        before = _state(path)
        intact = stored_digest(path) is not None
        if not intact and own:
            raise InputError(
                f"{path} has no digest, so cosserat did not write it or it was changed; run its case again"
            )
        with FILES:
            check_readable(path)
            read = _read(path)
        if _state(path) == before:
            break
    else:
        raise InputError(
            f"{path} is replaced again and again while it is read; wait until its run has ended"
        )
    _check_format(read, path)
    if not intact:
        warnings.warn(
            f"{path} was written by another program or changed: nothing says that a solver computed its values",
            ChangedResultWarning,
            stacklevel=2,
        )
    read = _along_time(read)
    read.encoding |= {"source": str(path), INTACT: intact}
    return read


def _read(path: Path) -> xr.Dataset:
    """What is in a file.

    Raises
    ------
    InputError : xarray or HDF5 cannot read it.
    """
    try:
        with uninterrupted(), xr.open_dataset(netcdf_path(path), engine="netcdf4") as dataset:
            return dataset.load()
    except Exception as error:  # they may say anything about what is in it
        raise InputError(
            f"cannot read {path} as a result ({printable(error)}); run its case again"
        ) from None


def _state(path: Path) -> tuple[int, ...]:
    """What changes when a file is replaced or written to.

    Raises
    ------
    InputError : it is gone.
    """
    try:
        now = path.stat()
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}; run its case again") from None
    return now.st_dev, now.st_ino, now.st_size, now.st_mtime_ns


def _along_time(dataset: xr.Dataset) -> xr.Dataset:
    """A result with its instants along time, as in memory."""
    instants = _FRAME in dataset.dims and "time" in dataset
    return dataset.swap_dims({_FRAME: "time"}) if instants else dataset


def check_replaceable(path: Path) -> None:
    """Raise InputError if a run would replace a file that cosserat did not write as it is."""
    try:
        foreign = path.exists() and not is_marked(path)
    except OSError:
        return  # whoever writes the file says what is wrong with it
    if foreign:
        raise InputError(
            f"{path} was written by another program or changed, and the run would replace it; move it away or choose "
            "another with --output"
        )


def existing(path: str | Path) -> Path:
    """The path of a file that is there.

    Raises
    ------
    InputError : it is not, or it is a folder.
    """
    path = path_of(path)
    if path.is_dir():
        raise InputError(f"{path} is a folder; give the name of a netCDF file")
    if not path.is_file():
        raise InputError(
            f"there is no file {path}; run the case first ('cosserat run CASE --output {path}')"
        )
    netcdf_path(path)
    return path


def load_case(folder: Path, case: str) -> xr.Dataset:
    """The result of a case in a folder of results, as cosserat wrote it.

    Raises
    ------
    InputError : as `load`, or it is the result of another case.
    """
    path = folder / f"{case}.nc"
    dataset = load(path, own=True)
    if dataset.attrs.get("case") != case:
        raise InputError(
            f"{path} holds the case {printable(dataset.attrs.get('case'))!r}; run '{case}' again"
        )
    return dataset


def stored_digest(path: Path) -> str | None:
    """The digest of a file, which its bytes have; None if another program wrote it, or wrote a changed Dataset.

    Raises
    ------
    InputError : the file cannot be read, or is damaged.
    """
    try:
        return digest_of(path)
    except OSError as error:
        raise InputError(
            f"cannot read {path}: {error.strerror or error}; check its permissions and its disk"
        ) from None
    except DamagedError:
        raise InputError(
            f"{path} is damaged: its bytes are not those that cosserat wrote; delete it and run its case again"
        ) from None


def _check_format(dataset: xr.Dataset, path: Path) -> None:
    """Raise InputError for what is no result, or a result of a later format."""
    if not {"parameters", "study", "analysis"} & set(dataset.attrs):
        raise InputError(
            f"{path} is no result of cosserat: it has no attribute 'parameters'; use one that cosserat wrote"
        )
    found = re.search(r"cosserat-(\d{1,9})\b", str(dataset.attrs.get("Conventions", "")))
    if found and int(found[1]) > FORMAT:
        raise InputError(
            f"{path} has format {found[1]}, written by {version_of(dataset)}, but this version reads formats up to "
            f"{FORMAT}; install a newer cosserat"
        )


def opened(result: xr.Dataset | str | Path) -> xr.Dataset:
    """A result, given by itself or by the name of its file; also one that xarray opened.

    Raises
    ------
    InputError : the file is missing or cannot be read as netCDF.
    """
    return _along_time(result) if isinstance(result, xr.Dataset) else load(result)
