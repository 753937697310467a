"""Files of a study in its folder: what is planned, and batches of members before and after they are solved.

    NAME.study/plan.json            the study, and the names of its batches
    NAME.study/members.npz          the values of the keys of its factors
    NAME.study/batches/DIGEST.npz   members to solve; the name says which, with the case and the code
    NAME.study/batches/DIGEST.nc    their answers

Nothing in the files of a batch depends on its place in the study, so a study that is extended or changed back finds
them again.  A plan has a digest of its parts, and the name of a batch is the digest of its members: what does not agree
is not believed.
"""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from cosserat.cases.catalogue import parse
from cosserat.data.content import stamped
from cosserat.data.files import whole_or_absent
from cosserat.data.netcdf import load, save
from cosserat.data.provenance import source
from cosserat.errors import InputError
from cosserat.studies.factors import Columns, Values
from cosserat.studies.family import Family, Task, parameters_of
from cosserat.studies.keys import varied_key
from cosserat.studies.readouts import read_out
from cosserat.studies.solving import Solved
from cosserat.studies.study import Study

Digests = NDArray[np.bytes_]
PLAN, MEMBERS, BATCHES = "plan.json", "members.npz", "batches"
ASIDE = ".aside"
"""Ending of a file that stood in the place of a batch's answer and is none."""
_FORMAT = 2
_AGAIN = "give the command of the study again"
_TEXT = "json:"  # prefix of the name of an array of JSON texts


@dataclass(frozen=True)
class Plan:
    """The batches of a study.

    study : digest of what is asked.  batches : names, old ones first.  seconds : estimate for one member.
    """

    study: str
    batches: tuple[str, ...]
    seconds: float
    format: int = _FORMAT
    about: Mapping[str, Any] = field(default_factory=dict)


def batch_name(digests: Digests, about: str) -> str:
    """The name of a batch: a digest of its members, by their digests (M,), and of what they have in common."""
    return hashlib.blake2b(digests.tobytes() + about.encode(), digest_size=12).hexdigest()


def write_arrays(path: Path, arrays: Mapping[str, Values]) -> bytes:
    """Write arrays, whole or not at all; returns the bytes.  Columns of other things than numbers become JSON texts."""
    plain = {}
    for name, values in arrays.items():
        if values.dtype.kind == "O":
            plain[_TEXT + name] = np.array([json.dumps(item, sort_keys=True) for item in values])
        else:
            plain[name] = values
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **plain)
    _check_link(path)
    with whole_or_absent(path, buffer.tell()) as temporary:
        temporary.write_bytes(buffer.getvalue())
    return buffer.getvalue()


def _check_link(path: Path) -> None:
    """Raise InputError for a link in the place of a file that leads nowhere, perhaps to itself."""
    if path.is_symlink() and not path.exists():
        raise InputError(f"{path} is a link that leads to no file; delete it and {_AGAIN}")


def read_arrays(path: Path) -> dict[str, Values]:
    """What `write_arrays` wrote.

    Raises
    ------
    InputError : the file is missing or damaged.
    """
    try:
        with np.load(path, allow_pickle=False) as stored:
            found = {name: stored[name] for name in stored.files}
        return {name.removeprefix(_TEXT): _unpacked(name, values) for name, values in found.items()}
    except FileNotFoundError:
        raise InputError(f"{path} is missing; {_AGAIN}") from None
    except Exception as error:  # NumPy may say anything about a damaged file
        raise InputError(f"cannot read {path} ({error}); delete it and {_AGAIN}") from None


def _unpacked(name: str, values: Values) -> Values:
    if not name.startswith(_TEXT):
        return values
    column = np.empty(len(values), dtype=object)
    column[:] = [json.loads(str(item)) for item in values]
    return column


def told_of(found: Family) -> dict[str, Any]:
    """What a plan says of its study, as JSON takes it; the values of its keys are beside it."""
    return {
        "about": parameters_of(found),
        "shape": found.shape,
        "factors": [
            {"dim": f.dim, "keys": [key.path for key in f.keys], "names": f.names, "design": f.design}
            for f in found.factors
        ],
    }


def write_plan(folder: Path, plan: Plan, found: Family) -> None:
    """Store a plan with its study and a digest of both."""
    arrays = {
        f"value {i} {k}": one for i, f in enumerate(found.factors) for k, one in enumerate(f.values)
    }
    arrays |= {
        f"about {i} {name}": one for i, f in enumerate(found.factors) for name, one in f.about.items()
    }
    members = write_arrays(folder / MEMBERS, arrays)
    told = {
        "format": plan.format,
        "study": plan.study,
        "batches": plan.batches,
        "seconds": plan.seconds,
        **told_of(found),
    }
    told["digest"] = _digest(told, members)
    _check_link(folder / PLAN)
    with whole_or_absent(folder / PLAN) as temporary:
        temporary.write_text(json.dumps(told, sort_keys=True), encoding="utf-8")


def _digest(told: Mapping[str, Any], members: bytes) -> str:
    text = json.dumps(told, sort_keys=True).encode()
    return hashlib.blake2b(text + members, digest_size=16).hexdigest()


def read_plan(folder: Path) -> Plan | None:
    """The plan in a folder; None if there is none of this version, or if it is not as it was written."""
    try:
        told = json.loads((folder / PLAN).read_text(encoding="utf-8"))
        members = (folder / MEMBERS).read_bytes()
    except (OSError, ValueError, RecursionError):
        return None
    if not isinstance(told, dict) or told.get("format") != _FORMAT:
        return None
    if told.pop("digest", None) != _digest(told, members):
        return None
    return Plan(told["study"], tuple(told["batches"]), told["seconds"], _FORMAT, told)


def read_family(folder: Path) -> tuple[Plan, Family]:
    """The plan in a folder and its study.

    Raises
    ------
    InputError : there is no plan, or it is damaged.
    """
    plan = read_plan(folder)
    if plan is None:
        raise InputError(f"{folder} holds no plan of a study, or a damaged one; {_AGAIN}")
    about, arrays = plan.about["about"], read_arrays(folder / MEMBERS)
    base = parse(json.dumps(about["case"]))
    called = f"study '{about['name']}'"
    factors = []
    for number, told in enumerate(plan.about["factors"]):
        keys = tuple(varied_key(base.problem, path, called) for path in told["keys"])
        values = tuple(arrays[f"value {number} {k}"] for k in range(len(keys)))
        begins = f"about {number} "
        own = {name.removeprefix(begins): one for name, one in arrays.items() if name.startswith(begins)}
        factors.append(Columns(told["dim"], keys, values, tuple(told["names"]), own, told["design"]))
    read = Study.read(about["study"], called, units_required=False)
    keep = tuple(read_out(name, text, called) for name, text in read.keep.items())
    return plan, Family(about["name"], read, base, tuple(factors), keep)


def write_task(path: Path, task: Task, digests: Digests) -> None:
    """Store the members of a batch."""
    columns = {f"value {k}": column for k, column in enumerate(task.columns)}
    write_arrays(path, columns | {"digests": digests, "about": np.array(task.about)})


def planned_members(path: Path) -> Digests:
    """The digests of the members of a batch to solve, (M,), as `read_task` checks them.

    Raises
    ------
    InputError : as `read_task`.
    """
    return _read_task(path)[1]


def read_task(path: Path) -> Task:
    """The members of a batch, if they are those that the file is named after.

    Raises
    ------
    InputError : the file is missing or damaged, holds another batch, or was planned by another version of the code.
    """
    return _read_task(path)[0]


def members_named(path: Path) -> Digests:
    """The digests that the file of a batch to solve states, (M,), without a look at the values of its members.

    Raises
    ------
    InputError : the file is missing or damaged, or holds another batch.
    """
    return _named(path)[0]


def _named(path: Path) -> tuple[Digests, dict[str, Any], tuple[NDArray[Any], ...]]:
    """Digests, task and columns of a batch, if the file is named after these digests.

    Raises
    ------
    InputError : the file is missing or damaged, or holds another batch.
    """
    arrays = read_arrays(path)
    try:
        digests, about = arrays["digests"], json.loads(str(arrays["about"]))
        named = batch_name(digests, str(arrays["about"]))
        columns = tuple(arrays[f"value {k}"] for k in range(len(about["keys"])))
        planned = isinstance(about["source"], str)
    except (KeyError, ValueError, TypeError):
        planned = False
    if not planned:
        raise InputError(f"{path} holds no members of a batch; delete it and {_AGAIN}")
    if path.stem != named or any(column.shape != digests.shape for column in columns):
        raise InputError(_others(path))
    return digests, about, columns


def _others(path: Path) -> str:
    return f"{path} holds other members than those it is named after; delete it and {_AGAIN}"


def _read_task(path: Path) -> tuple[Task, Digests]:
    """The task of a batch and the digests of its members."""
    digests, about, columns = _named(path)
    planner = about["source"]
    if planner != source():
        raise InputError(f"{path} was planned by {planner}, and this is {source()}; {_AGAIN}")
    keep = tuple(read_out(name, text, "the batch") for name, text in about["keep"].items())
    task = Task(
        parse(json.dumps(about["base"])),
        tuple(about["keys"]),
        columns,
        keep,
        tuple(about["keep_whole"]),
        tuple(about["by"]),
    )
    if not np.array_equal(task.digests(), digests):
        raise InputError(_others(path))
    return task, digests


def write_solved(path: Path, task: Task, solved: Solved) -> None:
    """Store the answers of a batch with the digests of its members, whole or not at all."""
    variables: dict[str, Any] = {
        "digest": (("member",), task.digests()),
        "status": (("member",), solved.status),
        "reason": (("member",), solved.reason),
        "iterations": (("member",), solved.iterations),
    }
    variables |= {f"value_{name}": (("member",), values) for name, values in solved.values.items()}
    variables |= {f"whole_{name}": field for name, field in solved.whole.items()}
    variables |= {f"beside_{name}": field for name, field in solved.beside.items()}
    variables |= {f"labels_{dim}": ((dim,), list(words)) for dim, words in solved.labels.items()}
    dataset = xr.Dataset(variables, attrs={"study": task.about, "source": source()})
    save(stamped(dataset), path)


def read_solved(path: Path) -> tuple[Digests, Solved]:
    """The answers of a batch, and the digests of its members, (M,).

    Raises
    ------
    InputError : the file is missing, damaged or changed, or is not the answer of the batch that it is named after.
    """
    again = f"'cosserat study' moves it to {path.name}{ASIDE} and solves its members again"
    try:
        stored = load(path, own=True)
    except InputError:
        raise InputError(f"{path} is damaged, or cosserat did not write it; {again}") from None
    if "digest" not in stored or "study" not in stored.attrs:
        raise InputError(f"{path} does not say which batch it answers; {again}")
    digests = stored["digest"].to_numpy()
    if path.stem != batch_name(digests, str(stored.attrs["study"])):
        raise InputError(f"{path} holds the answers of another batch; {again}")
    parts: dict[str, dict[str, Any]] = {"value": {}, "whole": {}, "beside": {}, "labels": {}}
    for key, variable in stored.variables.items():
        kind, _, name = str(key).partition("_")
        if kind in parts:
            parts[kind][name] = (tuple(map(str, variable.dims)), variable.to_numpy())
    return digests, Solved(
        {name: values for name, (_, values) in parts["value"].items()},
        parts["whole"],
        parts["beside"],
        {dim: tuple(map(str, words)) for dim, (_, words) in parts["labels"].items()},
        stored["status"].to_numpy(),
        stored["reason"].to_numpy().astype(object),
        stored["iterations"].to_numpy(),
    )
