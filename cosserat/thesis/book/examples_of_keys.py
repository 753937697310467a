"""The published cases that write a key, and the value that the first of them gives it."""

from __future__ import annotations

import functools
import json
import tomllib
from collections.abc import Iterator, Mapping
from importlib import resources
from typing import Any

from cosserat.cases.catalogue import find_base, published, study_tables

_FILES = ("chapter2.toml", "chapter3.toml")


@functools.cache
def examples() -> Mapping[tuple[str, str], list[tuple[str, str]]]:
    """Cases with the value as their file has it, by kind and path of a key, such as "forces[].at".

    Among them are the cases that studies vary.
    """
    found: dict[tuple[str, str], list[tuple[str, str]]] = {}
    kinds = {name: case.problem.kind for name, case in published().items()}
    kinds |= {table["of"]: find_base(table["of"]).problem.kind for table in study_tables().values()}
    for file in _FILES:
        text = (resources.files("cosserat.thesis.cases") / file).read_text(encoding="utf-8")
        for name, table in tomllib.loads(text).items():
            for path, value in _flat(table):
                if name in kinds:
                    cases = found.setdefault((kinds[name], path), [])
                    if name not in (case for case, _ in cases):
                        cases.append((name, value))
    return found


def _flat(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, str]]:
    """Path and written value of every key of a table whose value is short."""
    for key, value in table.items():
        path = f"{before}{key}"
        if isinstance(value, Mapping):
            yield from _flat(value, f"{path}.")
        elif isinstance(value, list) and value and isinstance(value[0], Mapping):
            for item in value:
                yield from _flat(item, f"{path}[].")
        else:
            written = json.dumps(value, ensure_ascii=False)
            if len(written) < 60:
                yield path, written
