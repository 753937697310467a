"""What the answer of a study holds, in lines for people."""

from __future__ import annotations

import json
from collections import Counter

import numpy as np
import xarray as xr

from cosserat.studies.analysis.answered import answer_of, dims_of, keys_along, read_outs, solved, unit_of
from cosserat.studies.answer import counts
from cosserat.studies.solving import STATUS

_MOST_REASONS = 8


def contents(given: xr.Dataset) -> list[str]:
    """The study, its factors, how many members have which status, and the ranges of the read-outs.

    Raises
    ------
    InputError : it is no answer of a study.
    """
    data = answer_of(given)
    about = json.loads(data.attrs["study"])
    name, of = about.get("name", "study"), about.get("study", {}).get("of", "?")
    kind = about.get("case", {}).get("problem", {}).get("kind", "?")
    lines = [f"{name}: {data.attrs.get('title', '')}", str(data.attrs.get("source", ""))]
    lines += [f"a study of '{of}', {kind}: {counts(data)}", "", "factors: least, largest, unit"]
    for dim in dims_of(data):
        lines.append(f"  {dim} ({data.sizes[dim]})")
        lines += [
            f"    {_row(data[key], key)} {data[key].attrs['key']}" for key in keys_along(data, dim)
        ]
    lines += ["", "read-outs of solved members: least, largest, unit"]
    for one in read_outs(data):
        said = data[one].attrs.get("read_out", data[one].attrs.get("long_name", ""))
        lines.append(f"  {_row(data[one].where(solved(data)), one)} {said}")
    whole = [str(n) for n, v in data.data_vars.items() if set(v.dims) > set(dims_of(data))]
    if whole:
        lines += [
            "",
            "whole variables",
            *(f"  {n} ({', '.join(map(str, data[n].dims))})" for n in whole),
        ]
    return lines + _reasons(data)


def _row(values: xr.DataArray, name: str) -> str:
    """A name, the least and the largest value, and the unit; texts as they are."""
    if values.dtype.kind not in "iuf":
        return f"{name:<14} {', '.join(map(str, dict.fromkeys(values.to_numpy().ravel())))[:60]}"
    numbers = values.to_numpy()[np.isfinite(values.to_numpy())]
    if not numbers.size:
        return f"{name:<14} {'':>29} {unit_of(values):<6}"
    return f"{name:<14} {numbers.min():>14.7g} {numbers.max():>14.7g} {unit_of(values):<6}"


def _reasons(data: xr.Dataset) -> list[str]:
    """Why members have no answer, or a warning, the most frequent first."""
    status, reason = data["status"].to_numpy().ravel(), data["reason"].to_numpy().ravel()
    found = Counter(
        (STATUS[number].replace("_", " "), str(text))
        for number, text in zip(status, reason, strict=True)
        if text
    )
    if not found:
        return []
    lines = [f"  {times} {word}: {text}" for (word, text), times in found.most_common(_MOST_REASONS)]
    more = len(found) - len(lines)
    return ["", "reasons", *lines, *([f"  and {more} others"] if more else [])]
