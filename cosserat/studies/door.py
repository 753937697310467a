"""Studies from a case file or from Python: `cosserat.study`."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cosserat.arguments import FUNCTION, taking
from cosserat.cases.catalogue import Case, case_given, find_base, parse, study_tables
from cosserat.errors import InputError, path_of
from cosserat.parameters import nearest
from cosserat.problem import Progress
from cosserat.progress import bar
from cosserat.studies.answer import answer
from cosserat.studies.family import Family, family
from cosserat.studies.solving import solve_members
from cosserat.studies.study import MOST_MEMBERS, Study
from cosserat.text import shortened, shown

Vary = Mapping[str, Any] | Sequence[Mapping[str, Any]]
_DEEPEST = 20
"""Most lists and tables inside each other."""


def find_study(name: str, file: str | Path | None = None) -> Family:
    """The study of that name: from `file` if one is given, else from the published ones.

    Raises
    ------
    InputError : there is no such study, or it is not valid.
    """
    tables = study_tables(file)
    if name not in tables:
        place = "" if file is None else f" in {file}"
        raise InputError(f"there is no study '{shortened(name)}'{place}{nearest(name, list(tables))}")
    read = Study.read(tables[name], f"study '{shortened(name)}'")
    folder = Path() if file is None else path_of(file).parent
    return family(name, read, find_base(read.of, file), folder, unit_required=True)


def study_of(answer: xr.Dataset) -> tuple[Case, Study]:
    """The case that a study varies and the study itself, from its answer.

    Raises
    ------
    InputError : the Dataset is no answer of a study.
    """
    try:
        told = json.loads(str(answer.attrs["study"]))
        case, asked = json.dumps(told["case"]), told["study"]
    except (KeyError, ValueError, TypeError):
        raise InputError("the Dataset is no answer of a study; use one that cosserat wrote") from None
    return parse(case), Study.read(asked, "the study", units_required=False)


def case_of_study(answer: xr.Dataset) -> Case:
    """The case that a study varies, from its answer.

    Raises
    ------
    InputError : the Dataset is no answer of a study.
    """
    return study_of(answer)[0]


def published_studies() -> list[str]:
    """The names of the published studies."""
    return list(study_tables())


@taking(progress=FUNCTION)
def study(
    case: Case | str,
    vary: Vary,
    keep: Mapping[str, str] | None = None,
    *,
    keep_whole: Sequence[str] = (),
    sensitivities: bool = False,
    name: str = "",
    progress: Progress | None = None,
) -> xr.Dataset:
    """Solve a case for many values of some of its keys; the answer is one Dataset.

    vary : dotted keys with lists of values, each a dimension; or a list of factors as in a case file, such as
        [{"rod.length": [1, 2]}, {"sobol": 64, "forces.0.force": {"uniform": [0, 1]}}].  Numbers are in SI units, and
        texts may have others.  Arrays of NumPy and xarray are lists.
    keep : read-outs by name, such as {"tip": "u.E2 at last"}.  keep_whole : names of variables that are kept whole.
    sensitivities : whether the exact derivative of each read-out by each varied quantity is stored, "tip_by_young", as
        by `cosserat.sensitivity`; where one does not exist, "reason" says why.
    name : of the study.  progress : as of `cosserat.run`.

    Raises
    ------
    InputError : a key, a value or a read-out is not valid.  A member without an answer is no error; the answer's
        variable "status" says so.
    """
    base = case_given(case, "study")
    found = family_of(
        base,
        vary,
        {} if keep is None else keep,
        keep_whole=keep_whole,
        name=name,
        sensitivities=sensitivities,
    )
    return solved(found, progress)


def solved(found: Family, progress: Progress | None = None) -> xr.Dataset:
    """The answer of a study, solved here and now."""
    if progress is not None:
        return answer(found, solve_members(found.task(), progress, os.cpu_count() or 1))
    with bar(found.name) as report:
        return answer(found, solve_members(found.task(), report, os.cpu_count() or 1))


def family_of(
    base: Case,
    vary: Vary,
    keep: Mapping[str, str],
    *,
    keep_whole: Sequence[str] = (),
    name: str = "",
    sensitivities: bool = False,
) -> Family:
    """The study that `study` solves.

    Raises
    ------
    InputError : a key, a value or a read-out is not valid.
    """
    name = _text(name, "name", '"reach"') or f"{base.name}_study"
    called = f"study '{shortened(name)}'"
    if isinstance(vary, str):
        raise InputError(
            f"{called}: 'vary' is {shown(vary)}; give the values too, such as {{'rod.length': ['1 m', '2 m']}}"
        )
    if not isinstance(vary, Mapping | list | tuple):
        raise InputError(
            f"{called}: 'vary' is {shown(vary)}; give a table of keys with their values, or a list of such tables"
        )
    if not isinstance(keep, Mapping):
        raise InputError(
            f"{called}: 'keep' is {shown(keep)}; give each read-out a name, such as {{'tip': 'u.E2 at last'}}"
        )
    if isinstance(keep_whole, str) or not isinstance(keep_whole, Sequence | np.ndarray):
        raise InputError(f"{called}: 'keep_whole' is {shown(keep_whole)}; give a list, such as ['x']")
    factors = [{key: values} for key, values in vary.items()] if isinstance(vary, Mapping) else vary
    table = {
        "of": base.name,
        "vary": plain(factors, f"{called}: 'vary'"),
        "keep": dict(keep),
        "keep_whole": list(keep_whole),
        "sensitivities": sensitivities,
    }
    read = Study.read(table, called, units_required=False)
    return family(name, read, base, Path(), unit_required=False)


def _text(value: object, what: str, such: str) -> str:
    if value is not None and not isinstance(value, str):
        raise InputError(f"'{what}' of a study is {shown(value)}; give a text, such as {such}")
    return value or ""


def plain(value: object, where: str, depth: int = 0) -> object:
    """A value as a case file may have it: tables, lists, texts, numbers and truth values of Python alone.

    Arrays of NumPy, xarray and pandas become lists, and their items plain numbers; where : it stands, in errors.

    Raises
    ------
    InputError : it is something else, or too long or deep.
    """
    if isinstance(value, xr.DataArray | xr.Variable | pd.Series | pd.Index):
        value = value.to_numpy()
    if isinstance(value, np.generic | np.ndarray):
        if value.size > MOST_MEMBERS:
            raise InputError(f"{where} has {value.size} values; it may have up to {MOST_MEMBERS}")
        value = value.tolist()
    if isinstance(value, np.floating):  # longer than Python's own
        value = float(value)
    if depth > _DEEPEST:
        raise InputError(f"{where} has more than {_DEEPEST} lists inside each other; give fewer")
    if isinstance(value, Mapping):
        return {
            str(key): None
            if item is None
            else plain(item, f"{where}, '{shortened(str(key))}'", depth + 1)
            for key, item in value.items()
        }
    if isinstance(value, Sequence) and not isinstance(value, str | bytes | bytearray | memoryview):
        if len(value) > MOST_MEMBERS:
            raise InputError(f"{where} has {len(value)} values; it may have up to {MOST_MEMBERS}")
        return [plain(item, f"{where}, item {number}", depth + 1) for number, item in enumerate(value)]
    if isinstance(value, str | bool | int | float):
        return value
    raise InputError(
        f"{where} is {shown(value)}; give numbers, texts, truth values, or lists or arrays of them"
    )
