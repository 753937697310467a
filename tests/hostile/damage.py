"""Results with damage by chance: bits, bytes, blocks, lengths, and what another program changed in them.

A damaged file is refused in one sentence, or read to the same content, or read with a word about it.
"""

from __future__ import annotations

import contextlib
import functools
import io
import json
import random
import warnings
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import xarray as xr

import cosserat
from cosserat.cli import main
from cosserat.data.digest import seal
from cosserat.errors import InputError

from .judge import Input, Outcome, faults
from .schema import BASE, CASE, FAMILIES, MEASURED, bases, file_of
from .values import CONTROL
from .worker import Worker, run_here, where

COMMANDS = (
    ("show", "x.nc"),
    ("plot", "x.nc"),
    ("export", "x.nc", "--to", "csv"),
    ("export", "x.nc", "--to", "vtk"),
)
WITHIN = ("bits", "bytes", "bits of the head", "block", "blocks")
"""Damage that leaves the length of the file."""
DIGESTS = ("kept", "kept", "kept", "cut", "cut", "cut", "forged")
_MARK = b"\ncosserat sha256:"


def results(folder: Path, chosen: Iterable[str] = ()) -> list[Path]:
    """A small result of each kind, a study's and a fit's answer, or some of them, in a folder."""
    return [_result(folder, kind) for kind in chosen or (*bases(), *FAMILIES)]


def _result(folder: Path, kind: str) -> Path:
    """The result of a kind."""
    path, file = folder / f"{kind}.nc", folder / "c.toml"
    file.write_bytes(file_of(kind, {}))
    if kind not in FAMILIES:
        cosserat.save(cosserat.run(cosserat.case(BASE, file)), path)
        return path
    for name, content in MEASURED.items():
        (folder / name).write_bytes(content)
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        assert main([kind, CASE, "--file", str(file), "-o", str(path)]) == 0
    return path


@dataclass(frozen=True)
class Damaged:
    """A file by its original, the kind of damage and the seed.

    digest : whether it stays at the end of the file; else it is "cut" off before, or "forged" afterwards.
    """

    original: Path
    damage: str
    seed: int
    digest: str = "kept"

    def content(self, scratch: Path) -> bytes:
        """The damaged bytes; `scratch` : a file to work on."""
        chance = random.Random(self.seed)
        whole = self.original.read_bytes()
        if self.digest != "kept":
            whole = whole[: whole.rfind(_MARK)]
        if self.damage in _ON_BYTES:
            scratch.write_bytes(_ON_BYTES[self.damage](whole, chance))
        else:
            scratch.write_bytes(whole)
            with netCDF4.Dataset(scratch, "a") as data:
                _ON_DATA[self.damage](data, chance)
        if self.digest == "forged":
            seal(scratch)
        return scratch.read_bytes()

    @property
    def kind(self) -> str:
        """The kind of the result."""
        return self.original.stem


def example(
    originals: list[Path],
    seed: int,
    number: int,
    digests: Iterable[str] = DIGESTS,
    damages: Iterable[str] = (),
) -> Damaged:
    """The damaged file of this number."""
    chance = random.Random(f"{seed} {number}")
    digest = chance.choice(list(digests))
    known = [*_ON_BYTES, *(_ON_DATA if digest != "kept" else ())]
    damage = chance.choice(list(damages) or known)
    return Damaged(chance.choice(originals), damage, chance.getrandbits(32), digest)


def tried(
    worker: Worker, given: Damaged, scratch: Path, commands: int
) -> Iterator[tuple[str, Outcome, list[str]]]:
    """How it is loaded, and how so many commands end with it: the command, how it ended, and its faults."""
    try:
        content = given.content(scratch)
    except (RuntimeError, OSError, ValueError):
        return  # the library of the format refuses this change
    scratch.write_bytes(content)
    ended = worker.call(load_here, scratch, given.original, given.digest == "forged")
    yield "load", ended, [*faults(Input(""), ended)]
    for words in COMMANDS[:commands]:
        ended = worker.call(run_here, Input("", words, {"x.nc": content}))
        wrong = faults(Input(""), ended)
        if given.digest == "forged":  # such a file counts as computed by the package
            wrong = [fault for fault in wrong if not fault.startswith("own fault")]
        yield words[0], ended, wrong


def load_here(path: Path, original: Path, forged: bool) -> Outcome:
    """Load a damaged file and compare it with its original; with a forged digest it may be anything."""
    import traceback

    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            read = cosserat.load(path)
        except InputError as error:
            return Outcome(2, "", f"cosserat: {str(error).replace(str(path), 'x.nc')}\n")
        except BaseException as error:
            return Outcome(raised=traceback.format_exc(limit=-30), where=where(error))
    wrong = (
        ()
        if said or forged or _same(read, _loaded(original))
        else ("silent: read as other content without a word",)
    )
    return Outcome(0, wrong=wrong)


@functools.cache
def _loaded(original: Path) -> xr.Dataset:
    return cosserat.load(original)


def _same(one: xr.Dataset, other: xr.Dataset) -> bool:
    try:
        return bool(one.identical(other))
    except Exception:
        return False


def _bits(whole: bytes, chance: random.Random) -> bytes:
    changed = bytearray(whole)
    for _ in range(chance.randint(1, 3)):
        changed[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def _bytes(whole: bytes, chance: random.Random) -> bytes:
    changed = bytearray(whole)
    for _ in range(chance.randint(1, 3)):
        changed[chance.randrange(len(whole))] = chance.randrange(256)
    return bytes(changed)


def _head(whole: bytes, chance: random.Random) -> bytes:
    return _bits(whole[:2048], chance) + whole[2048:]


def _block(whole: bytes, chance: random.Random, size: int = 512) -> bytes:
    at = chance.randrange(max(1, len(whole) - size))
    new = chance.choice([bytes(size), b"\xff" * size, chance.randbytes(size), whole[:size]])
    return whole[:at] + new + whole[at + size :]


def _blocks(whole: bytes, chance: random.Random) -> bytes:
    for _ in range(chance.randint(1, 3)):
        whole = _block(whole, chance, chance.choice([16, 64, 4096]))
    return whole


def _shorter(whole: bytes, chance: random.Random) -> bytes:
    return whole[
        : chance.choice([0, 1, 8, 512, len(whole) // 2, len(whole) - 1, chance.randrange(len(whole))])
    ]


def _longer(whole: bytes, chance: random.Random) -> bytes:
    at = chance.choice([0, len(whole), chance.randrange(len(whole))])
    return whole[:at] + chance.randbytes(chance.randint(1, 600)) + whole[at:]


_ON_BYTES: dict[str, Callable[[bytes, random.Random], bytes]] = {
    "bits": _bits,
    "bytes": _bytes,
    "bits of the head": _head,
    "block": _block,
    "blocks": _blocks,
    "shorter": _shorter,
    "longer": _longer,
}


def _variable(data: Any, chance: random.Random, kinds: str = "fiuSUO") -> Any:
    names = [
        name
        for name, v in data.variables.items()
        if (v.dtype is str and "U" in kinds) or getattr(v.dtype, "kind", "") in kinds
    ]
    return data.variables[chance.choice(names)]


def _owner(data: Any, chance: random.Random) -> Any:
    return data if chance.random() < 0.6 else _variable(data, chance)


def _rename_variable(data: Any, chance: random.Random) -> None:
    data.renameVariable(_variable(data, chance).name, chance.choice(["other", "x", "time", "a b", "é"]))


def _rename_dimension(data: Any, chance: random.Random) -> None:
    if data.dimensions:  # of single numbers there are none
        data.renameDimension(
            chance.choice(list(data.dimensions)), chance.choice(["other", "time", "frame", "axis"])
        )


def _drop_attribute(data: Any, chance: random.Random) -> None:
    owner = _owner(data, chance)
    if owner.ncattrs():
        owner.delncattr(chance.choice(owner.ncattrs()))


def _attribute(data: Any, chance: random.Random) -> None:
    owner = _owner(data, chance)
    known = [name for name in owner.ncattrs() if not name.startswith("_")]
    value = chance.choice(
        [
            "",
            "nonsense",
            CONTROL.strip("\x00"),
            "[]",
            "null",
            "5",
            7,
            2.5,
            np.arange(3.0),
            "9" * 5000,
            "{}",
        ]
    )
    owner.setncattr(chance.choice(known or ["units"]), value)


def _parameters(data: Any, chance: random.Random) -> None:
    """Change something in the case, study or fit that the file says it is of."""
    name = next(known for known in ("parameters", *FAMILIES) if known in data.ncattrs())
    case = json.loads(data.getncattr(name))
    inside = chance.choice([case, *(part for part in case.values() if isinstance(part, dict) and part)])
    key = chance.choice(list(inside))
    inside[key] = chance.choice([None, 5, "nonsense", [], {}, CONTROL, "../../x", 1e308])
    data.setncattr(name, json.dumps(case))


def _statistics(data: Any, chance: random.Random) -> None:
    """Change something in what the solver says, where one says something."""
    solver = json.loads(data.solver) if "solver" in data.ncattrs() else {}
    if solver:
        solver[chance.choice(list(solver))] = chance.choice(
            [None, "nonsense", [], {}, -1, float("nan"), 10**400]
        )
    data.solver = chance.choice([json.dumps(solver), "{}", "[1]", '{"a": 1}'])


def _values(data: Any, chance: random.Random) -> None:
    """Change a number."""
    variable = _variable(data, chance, "f")
    values = np.array(variable[...], dtype=float).ravel()
    if values.size:
        at = chance.randrange(values.size)
        values[at] = chance.choice([np.nan, np.inf, -np.inf, values[at] + 1, 1e308, -values[at], 0.0])
    variable[...] = values.reshape(variable.shape)


def _label(data: Any, chance: random.Random) -> None:
    """Change a name of a component."""
    names = [name for name, v in data.variables.items() if v.dtype is str and v.size]
    if names:
        data.variables[chance.choice(names)][0] = chance.choice(
            ["", "nonsense", CONTROL.strip("\x00"), "E2", "a" * 5000]
        )


def _added(data: Any, chance: random.Random) -> None:
    """Add variables that the package does not write."""
    dims = tuple(chance.sample(list(data.dimensions), min(len(data.dimensions), chance.randint(0, 2))))
    kind = chance.choice([str, "f8", "i4", "u1", "S1"])
    if chance.random() < 0.3:
        dims = (data.createDimension("none", 0).name,)
    data.createVariable(chance.choice(["added", "along", "mu_1", "time2"]), kind, dims)


def _group(data: Any, chance: random.Random) -> None:
    data.createGroup("more").createVariable("x", "f8", ())


_ON_DATA: dict[str, Callable[[Any, random.Random], None]] = {
    "variable renamed": _rename_variable,
    "dimension renamed": _rename_dimension,
    "attribute removed": _drop_attribute,
    "attribute": _attribute,
    "parameters": _parameters,
    "statistics": _statistics,
    "value": _values,
    "label": _label,
    "variable added": _added,
    "group added": _group,
}
