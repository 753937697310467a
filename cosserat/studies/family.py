"""The members of a study: ordinary cases, each with a number, the values of its keys, and a digest."""

from __future__ import annotations

import hashlib
import json
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cosserat.cases.catalogue import Case
from cosserat.data.provenance import source
from cosserat.data.variables import COORDINATES, LABELS, VARIABLES
from cosserat.errors import InputError
from cosserat.problem import Progress, silent
from cosserat.studies.factors import Columns, Values, columns
from cosserat.studies.keys import VariedKey, case_with, table_of
from cosserat.studies.readouts import ReadOut, meant_variable, read_out
from cosserat.studies.study import MOST_MEMBERS, Study
from cosserat.text import LONGEST_NAME, shown

OWN = ("status", "reason", "iterations")
"""Variables of every answer."""
_DIGEST = 12  # bytes of the digest of a member
_OFTEN = 1 << 15  # members between two reports of a plan


@dataclass(frozen=True)
class Task:
    """Members to solve: a case, the keys that differ, and their values.

    columns : values of each key, each (M,), in SI units.  keep, keep_whole : what is kept of each.
    by : those of the keys by which derivatives of the read-outs are kept.
    """

    base: Case
    keys: tuple[str, ...]
    columns: tuple[Values, ...]
    keep: tuple[ReadOut, ...]
    keep_whole: tuple[str, ...]
    by: tuple[str, ...] = ()

    @property
    def size(self) -> int:
        """The number of members."""
        return len(self.columns[0])

    def values(self, number: int) -> dict[str, object]:
        """The values of the keys of one member."""
        return {key: _plain(column[number]) for key, column in zip(self.keys, self.columns, strict=True)}

    @cached_property
    def about(self) -> str:
        """What all members have in common, with the code that computes them, as JSON."""
        return json.dumps(
            {
                "base": self.base.model_dump(mode="json"),
                "keys": self.keys,
                "keep": {one.name: one.text for one in self.keep},
                "keep_whole": self.keep_whole,
                "by": self.by,
                "source": source(),
            },
            sort_keys=True,
        )

    def digests(self, progress: Progress = silent) -> NDArray[np.bytes_]:
        """A digest of each member, (M,): of the whole case, what is kept and the code, and not of its place."""
        common = hashlib.blake2b(self.about.encode(), digest_size=32).digest()
        found = np.empty(self.size, dtype=f"S{2 * _DIGEST}")
        if all(column.dtype.kind in "fi" for column in self.columns):
            rows = np.ascontiguousarray(
                np.column_stack([column.astype(np.float64) for column in self.columns])
            )
            keys: Sequence[bytes] = [row.tobytes() for row in rows]
        else:
            keys = [json.dumps(self.values(k), sort_keys=True).encode() for k in range(self.size)]
        for number, own in enumerate(keys):
            if number % _OFTEN == 0:
                progress(0.0, f"{number} of {self.size} members planned")
            found[number] = hashlib.blake2b(common + own, digest_size=_DIGEST).hexdigest()
        return found

    def part(self, members: NDArray[np.int64] | slice) -> Task:
        """Some of the members."""
        return replace(self, columns=tuple(column[members] for column in self.columns))

    @property
    def names(self) -> list[str]:
        """The names of the values that are kept of each member."""
        return [one.name for one in self.keep] + [
            derivative_name(one.name, path) for one in self.keep for path in self.by
        ]


def derivative_name(read_out: str, path: str) -> str:
    """What a derivative by a key is called where whole paths name keys."""
    return f"{read_out}_by_{path.replace('.', '_')}"


def _plain(value: object) -> object:
    return value.item() if isinstance(value, np.generic) else value


@dataclass(frozen=True)
class Family:
    """A study with everything read: its case, its factors, and what is kept.

    study : as it was read, for the answer.
    """

    name: str
    study: Study
    base: Case
    factors: tuple[Columns, ...]
    keep: tuple[ReadOut, ...]

    @property
    def title(self) -> str:
        """Title of the study, its name by default."""
        return self.study.title or self.name

    @property
    def asked(self) -> str:
        """The case and the study as JSON."""
        return json.dumps(parameters_of(self), sort_keys=True)

    @property
    def shape(self) -> tuple[int, ...]:
        """The numbers of members of the factors."""
        return tuple(factor.size for factor in self.factors)

    @property
    def size(self) -> int:
        """The number of members."""
        return math.prod(self.shape)

    @property
    def keys(self) -> tuple[VariedKey, ...]:
        """The varied keys of all factors."""
        return tuple(key for factor in self.factors for key in factor.keys)

    @cached_property
    def names(self) -> dict[str, str]:
        """The names of the keys in the answer, by path: the last word, or the whole path where that is not unique."""
        counted = Counter(key.last for key in self.keys)
        dims = Counter(
            factor.dim
            for factor in self.factors
            if factor.dim != factor.keys[0].last or len(factor.keys) > 1
        )
        taken = {
            *OWN,
            *dims,
            *(one.name for one in self.keep),
            *self.study.keep_whole,
            *_beside(self.study.keep_whole),
        }
        return {
            key.path: key.last
            if counted[key.last] == 1 and key.last not in taken and key.last.isidentifier()
            else key.path.replace(".", "_")
            for key in self.keys
        }

    def dims(self) -> tuple[str, ...]:
        """The names of the dimensions of the factors."""
        return tuple(
            self.names[factor.keys[0].path]
            if len(factor.keys) == 1 and not factor.design and factor.dim == factor.keys[0].last
            else factor.dim
            for factor in self.factors
        )

    def task(self, members: NDArray[np.int64] | None = None) -> Task:
        """The members of these numbers, or all."""
        numbers = np.arange(self.size) if members is None else members
        picked = np.unravel_index(numbers, self.shape)
        found = tuple(
            column[index]
            for factor, index in zip(self.factors, picked, strict=True)
            for column in factor.values
        )
        return Task(
            self.base,
            tuple(key.path for key in self.keys),
            found,
            self.keep,
            self.study.keep_whole,
            tuple(key.path for key in self.by),
        )

    @property
    def by(self) -> tuple[VariedKey, ...]:
        """The varied quantities by which derivatives are kept; none unless they are asked for."""
        if not self.study.sensitivities:
            return ()
        return tuple(
            key
            for factor in self.factors
            for key, values in zip(factor.keys, factor.values, strict=True)
            if key.quantity is not None and values.dtype.kind in "fi"
        )

    def case(self, number: int) -> Case:
        """One member, an ordinary case.

        Raises
        ------
        InputError : there is no such member, or its values are not valid.
        """
        if not 0 <= number < self.size:
            raise InputError(
                f"study '{self.name}' has no member {number}; they are numbered from 0 to {self.size - 1}"
            )
        values = self.task(np.array([number])).values(0)
        return case_with(self.base, table_of(self.base.problem), values, member_name(self.name, number))


def member_name(study: str, number: int) -> str:
    """The name of a member as a case."""
    ending = f"_{number}"
    return study[: LONGEST_NAME - len(ending)] + ending


def _beside(whole: Sequence[str]) -> set[str]:
    """Coordinates and dimensions that whole variables bring along."""
    dims = {dim for name in whole if name in VARIABLES for dim in VARIABLES[name].dims}
    placed = {name for name in COORDINATES if name in VARIABLES and set(VARIABLES[name].dims) <= dims}
    return dims | placed


def family(name: str, study: Study, base: Case, folder: Path, *, unit_required: bool) -> Family:
    """A study with its values read.

    folder : where the tables that it names are.

    Raises
    ------
    InputError : a key, a value, a read-out or a name is not valid, or there are too many members.
    """
    called = f"study '{name}'"
    factors = tuple(
        columns(one, base.problem, called, folder, unit_required=unit_required) for one in study.vary
    )
    paths = [key.path for factor in factors for key in factor.keys]
    for path, times in Counter(paths).items():
        if times > 1:
            raise InputError(f"{called} varies '{path}' {times} times; put its values into one factor")
        inside = [other for other in paths if other.startswith(f"{path}.")]
        if inside:
            raise InputError(f"{called} varies '{path}' and '{inside[0]}' inside it; vary one of them")
    size = math.prod(factor.size for factor in factors)
    if size > MOST_MEMBERS:
        raise InputError(f"{called} has {size} members; a study may have up to {MOST_MEMBERS}")
    for whole in study.keep_whole:
        if whole not in VARIABLES:
            raise InputError(
                f"{called} keeps {shown(whole)}, which no result has{meant_variable(whole)}"
            )
    keep = tuple(read_out(key, text, called) for key, text in study.keep.items())
    found = Family(name, study, base, factors, keep)
    _check_names(found, called)
    return found


def _check_names(found: Family, called: str) -> None:
    dims = found.dims()
    named = [
        *dims,
        *(name for name in found.names.values() if name not in dims),
        *(one.name for one in found.keep),
        *(f"{one.name}_by_{found.names[key.path]}" for one in found.keep for key in found.by),
        *found.study.keep_whole,
        *_beside(found.study.keep_whole),
        *OWN,
        *(about for factor in found.factors for about in factor.about),
    ]
    for name, times in Counter(named).items():
        if times > 1:
            raise InputError(
                f"{called} has {times} things of the name {shown(name)}; give dimensions a 'name' and read-outs names "
                "of their own"
            )
    for factor, dim in zip(found.factors, dims, strict=True):
        if dim in LABELS or not dim:
            raise InputError(
                f"{called}: {shown(dim)} is the name of a dimension of results; give the factor another 'name'"
            )
        if factor.names and len(set(factor.names)) < len(factor.names):
            raise InputError(f"{called}: 'names' of '{dim}' has a name twice; give each value its own")


def parameters_of(found: Family) -> Mapping[str, Any]:
    """The study as plain tables: its case in SI units, and its factors as they were given."""
    return {
        "name": found.name,
        "study": found.study.model_dump(mode="json"),
        "case": found.base.model_dump(mode="json"),
    }
