"""Arguments of public functions, checked in one place: one of another kind is a sentence with its name and a remedy."""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ParamSpec, TypeVar

import numpy as np

from cosserat.errors import InputError
from cosserat.text import shown

P = ParamSpec("P")
R = TypeVar("R")


@dataclass(frozen=True)
class Kind:
    """A kind of argument.

    read : gives the argument as the function takes it, or raises TypeError or ValueError.  remedy : what to give.
    """

    read: Callable[[object], object]
    remedy: str


def taking(**kinds: Kind) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """A function whose arguments of these names are of these kinds; its own defaults are taken as they are.

    Raises
    ------
    InputError : from the function, where an argument is of another kind.
    """

    def wrapped(function: Callable[P, R]) -> Callable[P, R]:
        signature = inspect.signature(function)

        @functools.wraps(function)
        def checked(*args: P.args, **kwargs: P.kwargs) -> R:
            bound = signature.bind(*args, **kwargs)
            for name, kind in kinds.items():
                if name in bound.arguments:
                    default = signature.parameters[name].default
                    bound.arguments[name] = _read(
                        function.__name__, name, bound.arguments[name], kind, default
                    )
            return function(*bound.args, **bound.kwargs)

        return checked

    return wrapped


def _read(function: str, name: str, given: object, kind: Kind, default: object) -> object:
    if given is None and default is None:
        return None
    try:
        return kind.read(given)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{function} has {name} = {shown(given)}; give {kind.remedy}") from None


def _text(given: object) -> str:
    if not isinstance(given, str):
        raise TypeError
    return str(given)


def _number(given: object) -> float:
    item = given.item() if isinstance(given, np.generic) else given
    if isinstance(item, bool) or not isinstance(item, int | float) or not math.isfinite(item):
        raise TypeError
    return float(item)


def _whole(given: object) -> int:
    item = given.item() if isinstance(given, np.generic) else given
    if isinstance(item, bool) or not isinstance(item, int) or item < 0:
        raise TypeError
    return item


def _items(given: object) -> list[object]:
    if isinstance(given, np.ndarray) and given.ndim == 1:
        return list(given.tolist())
    if not isinstance(given, list | tuple | type({}.keys())):
        raise TypeError
    return list(given)


def _numbers(given: object) -> list[float]:
    single = isinstance(given, int | float | np.number)
    return [_number(item) for item in ([given] if single else _items(given))]


def _texts(given: object) -> list[str]:
    return [given] if isinstance(given, str) else [_text(item) for item in _items(given)]


def _table(given: object) -> dict[str, object]:
    """A table whose arrays are lists."""
    if not isinstance(given, Mapping):
        raise TypeError
    return {
        _text(name): value.tolist() if isinstance(value, np.ndarray) else value
        for name, value in given.items()
    }


def _keys(given: object) -> object:
    return _table(given) if isinstance(given, Mapping) else _texts(given)


def _columns(given: object) -> object:
    """A file by its name as it is, or columns by name, each as long as it is."""
    if isinstance(given, Mapping):
        for column in given.values():
            if isinstance(column, str) or not hasattr(column, "__len__"):
                raise TypeError
            len(column)  # an array without dimensions has none
    return given


def of_class(kind: type, remedy: str) -> Kind:
    """What is of a class, as it is."""

    def read(given: object) -> object:
        if not isinstance(given, kind):
            raise TypeError
        return given

    return Kind(read, remedy)


def _function(given: object) -> object:
    if not callable(given):
        raise TypeError
    return given


TEXT = Kind(_text, "a text")
NUMBER = Kind(_number, "a number")
WHOLE = Kind(_whole, "a whole number, 0 or above")
TEXTS = Kind(_texts, "a text, or a list of texts")
NUMBERS = Kind(_numbers, "a number, or a list of numbers")
TABLE = Kind(_table, "a table with a value for each name")
KEYS = Kind(
    _keys, "the keys with their ranges, such as {'rod.length': ('1 m', '2 m')}, or a list of keys"
)
COLUMNS = Kind(_columns, "the name of a CSV file, or columns by name, each a list")
FUNCTION = Kind(_function, "a function")
