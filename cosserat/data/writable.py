"""What a netCDF file can hold of a Dataset, checked before it is written: a user may have put anything into one."""

from __future__ import annotations

from collections.abc import Hashable, Mapping

import numpy as np
import xarray as xr

from cosserat.errors import InputError
from cosserat.text import shown

_WRITTEN = "it cannot be written"
_DECODING = {
    "scale_factor",
    "add_offset",
    "_FillValue",
    "missing_value",
    "_Unsigned",
    "_Encoding",
    "dtype",
}
"""Attributes of a variable by which whoever reads the file changes its values."""


def check_writable(dataset: xr.Dataset) -> None:
    """Raise InputError for a name, an attribute or a variable that a netCDF file cannot hold; the sentence names it."""
    for name in (*dataset.variables, *dataset.dims):
        _check_name(
            name,
            "a variable or dimension of the Dataset",
            "rename it, such as dataset.rename({...: 'name'})",
        )
    _check_attributes(dataset.attrs, "the Dataset")
    for name, variable in dataset.variables.items():
        _check_attributes(variable.attrs, f"'{name}'")
        if decoding := sorted(_DECODING & set(variable.attrs)):
            raise InputError(
                f"the attribute '{decoding[0]}' of '{name}' would change its values when they are read; delete it"
            )
        _check_values(str(name), variable)


def _check_name(name: Hashable, what: str, remedy: str) -> None:
    if (
        not isinstance(name, str)
        or name != name.rstrip()
        or not name
        or "/" in name
        or not _encodes(name)
    ):
        raise InputError(
            f"{what} is called {shown(name)}, so {_WRITTEN}: a name is a text without '/' and without a "
            f"space at its end; {remedy}"
        )


def _check_attributes(attributes: Mapping[Hashable, object], of: str) -> None:
    for name, value in attributes.items():
        _check_name(name, f"an attribute of {of}", "give it another name, or delete it")
        if not _is_attribute(value):
            raise InputError(
                f"the attribute '{name}' of {of} is {shown(value)}, so {_WRITTEN}; make it a text, a number or a "
                "list of such, or delete it"
            )


def _is_attribute(value: object) -> bool:
    """Whether a value is a text in Unicode, a number or a row of them."""
    if isinstance(value, str):
        return _encodes(value)
    if isinstance(value, list | tuple):
        texts = all(isinstance(item, str) and _encodes(item) for item in value)
        numbers = all(isinstance(item, int | float | np.number) and _fits(item) for item in value)
        return texts or numbers
    if isinstance(value, np.ndarray):
        return value.ndim <= 1 and (
            value.dtype.kind in "iuf" or (value.dtype.kind == "U" and all(map(_encodes, value.flat)))
        )
    return isinstance(value, int | float | np.integer | np.floating) and _fits(value)


def _fits(number: object) -> bool:
    """Whether a number has at most 64 bits; truth values are no numbers of netCDF."""
    if isinstance(number, bool | complex | np.complexfloating):
        return False
    return not isinstance(number, int) or -(2**63) <= number < 2**63


def _check_values(name: str, variable: xr.Variable) -> None:
    """Raise InputError for values that are neither numbers nor texts."""
    if variable.dtype.kind == "f" and variable.dtype.itemsize not in (4, 8):
        raise InputError(
            f"'{name}' has values of type {variable.dtype}, so {_WRITTEN}; make them numbers of 64 bits by "
            ".astype(float)"
        )
    if variable.dtype.kind in "iufbSmM":
        return
    if variable.dtype.kind in "OTU":
        given = [one for one in variable.to_numpy().ravel() if one is not None and one == one]  # noqa: PLR0124 - no nan
        numbers = all(isinstance(one, int | float | np.number) and _fits(one) for one in given)
        if numbers or all(isinstance(one, str) and _encodes(one) for one in given):
            return
        odd = next(one for one in given if not (isinstance(one, str) and _encodes(one)))
        raise InputError(
            f"'{name}' holds {shown(odd)}, so {_WRITTEN}; make its values numbers or texts, or drop the variable"
        )
    raise InputError(
        f"'{name}' has values of type {variable.dtype}, so {_WRITTEN}; make them numbers or texts, for complex ones by "
        ".real and .imag, or drop the variable"
    )


def _encodes(text: str) -> bool:
    """Whether a text can be written in UTF-8 and in a file of C, without null characters."""
    try:
        return b"\0" not in text.encode()
    except UnicodeEncodeError:
        return False
