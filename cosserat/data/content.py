"""The digest of what a Dataset says, by which `save` knows whether it is still as it was computed."""

from __future__ import annotations

import hashlib

import numpy as np
import xarray as xr

_STAMP = "content"
"""Attribute with the digest."""
_BESIDE = (_STAMP, "history", "continues")
"""Attributes that a Dataset gets later."""


def digest_of_values(data: xr.Dataset) -> str:
    """SHA-256 of names, dimensions, units and values of a Dataset."""
    found = hashlib.sha256()
    for name in sorted(map(str, data.variables)):
        variable = data.variables[name]
        about = (name, variable.dims, variable.shape, variable.attrs.get("units", ""))
        found.update(repr(about).encode())
        if variable.dtype.kind == "f":
            found.update(np.ascontiguousarray(variable.values, dtype="<f8").data)
        else:
            found.update("\n".join(map(str, variable.values.ravel())).encode())
    return found.hexdigest()


def _digest(data: xr.Dataset) -> str:
    """SHA-256 of the values and of the attributes of a Dataset."""
    about = sorted((str(key), str(value)) for key, value in data.attrs.items() if key not in _BESIDE)
    return hashlib.sha256(f"{digest_of_values(data)}{about!r}".encode()).hexdigest()


def stamped(data: xr.Dataset) -> xr.Dataset:
    """A Dataset with its digest: what the package computed, or a part of it that the package took."""
    return stamp(data.assign_attrs())


def stamp(data: xr.Dataset) -> xr.Dataset:
    """A Dataset that has just been made, which gets its digest itself: a copy would take longer."""
    data.attrs[_STAMP] = _digest(data)
    return data


def is_as_computed(data: xr.Dataset) -> bool:
    """Whether a Dataset has its values and attributes of the time when it was stamped."""
    return str(data.attrs.get(_STAMP)) == _digest(data)
