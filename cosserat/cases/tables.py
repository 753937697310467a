"""Tables of case files: what a case inherits by `like`, merged key by key."""

from __future__ import annotations

import functools
from collections import UserDict
from collections.abc import Mapping
from typing import Any

from cosserat.errors import InputError
from cosserat.parameters import Dropped, nearest, tables_with_a_choice
from cosserat.publications import kinds
from cosserat.text import shortened, shown

_MOST_STEPS = 50  # of cases that are each like the next one
_MOST_BASES = 50  # of one case
_MOST_KEYS = 10_000  # of a case with everything inherited


class Tables(UserDict[str, Any]):
    """The tables of case files by name; each is merged once."""

    def __init__(self, tables: Mapping[str, Any]) -> None:
        super().__init__(tables)
        self._done: dict[str, dict[str, Any]] = {}

    def inherited(self, name: str) -> dict[str, Any]:
        """The table of a case with everything inherited by `like`.

        Raises
        ------
        InputError : a `like` names no case, refers back to itself, or unfolds into too much.
        """
        return dict(self._inherit(name, ()))

    def _inherit(self, name: str, seen: tuple[str, ...]) -> dict[str, Any]:
        self._check(name, seen)
        if name not in self._done:
            try:
                self._done[name] = self._unfolded(name, (*seen, name))
            except RecursionError:
                raise InputError(
                    f"case '{shortened(name)}': its tables are inside each other, too deep to read; no case needs it"
                ) from None
        return self._done[name]

    def _check(self, name: str, seen: tuple[str, ...]) -> None:
        if name in seen:
            round_ = shortened(" -> ".join((*seen, name)), 200)
            raise InputError(
                f"case '{shortened(name)}': its 'like' refers back to itself ({round_}); remove the cycle"
            )
        if name not in self:
            raise InputError(
                f"case '{shortened(seen[-1])}': 'like' names no case: {shown(name)}{nearest(name, list(self))}"
            )
        if len(seen) > _MOST_STEPS:
            raise InputError(
                f"case '{shortened(seen[0])}': its 'like' leads through more than {_MOST_STEPS} cases; let it name "
                "one nearer to the end"
            )

    def _unfolded(self, name: str, seen: tuple[str, ...]) -> dict[str, Any]:
        table: dict[str, Any] = {}
        own = {key: value for key, value in self[name].items() if key not in ("title", "source")}
        for base in _bases(name, own.pop("like", [])):
            table = merged(table, self._inherit(base, seen))
        for key, value in own.items():
            if isinstance(value, dict) and "like" in value:  # a whole case as a part of this one
                part = {inner: given for inner, given in value.items() if inner != "like"}
                for base in _bases(name, value["like"]):
                    own[key] = merged(self._inherit(base, seen), part)
        table = merged(table, own)
        if _size(table) > _MOST_KEYS:
            raise InputError(
                f"case '{shortened(name)}': with all that it inherits it has more than {_MOST_KEYS} keys; no case "
                "needs so many"
            )
        return table


def _bases(name: str, like: object) -> list[str]:
    """The names that a `like` gives."""
    given = like if isinstance(like, list) else [like]
    bases = [base for base in given if isinstance(base, str)]
    if len(given) > _MOST_BASES or len(bases) < len(given):
        raise InputError(
            f"case '{shortened(name)}': 'like' is {shown(like)}; it must be the name of a case, or a list of up to "
            f"{_MOST_BASES}"
        )
    return bases


def _size(table: Mapping[str, Any]) -> int:
    """The number of keys of a table and of those inside it."""
    return len(table) + sum(_size(value) for value in table.values() if isinstance(value, dict))


def merged(
    base: Mapping[str, Any], own: Mapping[str, Any], path: tuple[str, ...] = ()
) -> dict[str, Any]:
    """Both tables, key by key; a table of another shape or kind replaces the one of the base as a whole.

    The word "none" marks a key of the base as dropped.
    """
    table = dict(base)
    for key, value in own.items():
        old, inner = table.get(key), (*path, key)
        if isinstance(value, dict) and isinstance(old, dict):
            kept = dict.fromkeys(old, Dropped()) if _is_another(old, value, inner) else old
            table[key] = merged(kept, value, inner)
        elif isinstance(value, str) and value == "none" and key in table:
            table[key] = Dropped(value)
        else:
            table[key] = value
    return table


def _is_another(base: Mapping[str, Any], own: Mapping[str, Any], path: tuple[str, ...]) -> bool:
    """Whether a table makes another choice than the one of the base, where there is a choice of classes."""
    differing = [
        key for key, value in own.items() if isinstance(value, str) and base.get(key, value) != value
    ]
    return bool(differing) and _choosers().get(path) in differing


@functools.cache
def _choosers() -> Mapping[tuple[str, ...], str]:
    """Key that chooses the class of a table, by the path of the table in problems of any kind."""
    return {
        path: key
        for kind in kinds().values()
        for path, key in tables_with_a_choice(kind.problem_class())
    }
