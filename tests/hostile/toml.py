"""TOML of any value, right or wrong, for files that nobody would write."""

from __future__ import annotations

import datetime
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Raw:
    """A text that stands in the file as it is."""

    text: str


def dumped(value: Any) -> str:
    """A value as TOML, in one line."""
    if isinstance(value, Raw):
        return value.text
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, Mapping):
        inside = ", ".join(f"{_key(key)} = {dumped(item)}" for key, item in value.items())
        return f"{{ {inside} }}" if inside else "{}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(dumped, value))}]"
    if isinstance(value, datetime.date):
        return value.isoformat()
    return str(value)


_MARKS = {n: f"\\u{n:04x}" for n in (*range(32), 127)} | {ord('"'): '\\"', ord("\\"): "\\\\"}


def quoted(text: str) -> str:
    """A text between quotation marks."""
    return f'"{text.translate(_MARKS)}"'


def _key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else quoted(key)


def table(name: str, content: Any) -> str:
    """A table of a file, with its keys below it; something else as a key with its value."""
    if not isinstance(content, Mapping):
        return f"{_key(name)} = {dumped(content)}\n"
    return "\n".join(
        [f"[{_key(name)}]", *(f"{_key(key)} = {dumped(value)}" for key, value in content.items()), ""]
    )
