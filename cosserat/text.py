"""Texts and values of people: how a terminal and an error sentence show them."""

from __future__ import annotations

import re
import reprlib
import unicodedata
from typing import Annotated

from pydantic import AfterValidator
from pydantic_core import PydanticCustomError

_STEERING = ("Cc", "Cf", "Cs", "Zl", "Zp")
"""Categories of Unicode that can change a terminal or a line: controls, formats (such as an override of the direction
of writing), halves of characters, breaks."""
_JOINERS = "\u200c\u200d"  # formats that words of some scripts and emoji need


def steering(text: str) -> str:
    """The characters of a text that can change how a terminal shows what follows, or that no page may hold."""
    return "".join(letter for letter in text if _steers(letter))


def _steers(letter: str) -> bool:
    code = ord(letter)
    no_character = code & 0xFFFE == 0xFFFE or 0xFDD0 <= code <= 0xFDEF
    return no_character or (unicodedata.category(letter) in _STEERING and letter not in _JOINERS)


def printable(text: object) -> str:
    r"""A text from a file for a terminal, on one line: characters that steer are shown as escapes, such as \x1b."""
    shown = str(text)
    return shown.translate(
        {ord(letter): letter.encode("unicode_escape").decode() for letter in set(steering(shown))}
    )


def brief(number: float) -> str:
    """A number with up to six digits, and an exponent without zeros before it: 1e9."""
    return re.sub(r"e([+-])0*", lambda m: "e-" if m[1] == "-" else "e", f"{number:g}")


def shortened(text: str, most: int = 60) -> str:
    """The beginning of a text, for a sentence."""
    return printable(text if len(text) <= most else f"{text[: most - 3]}...")


def shown(value: object) -> str:
    """Any value for a sentence, as Python writes it but never long."""
    return shortened(_BRIEF.repr(value), 120)


class _Brief(reprlib.Repr):
    """As `repr`, with a few items of a list and a few characters of a text."""

    def repr_int(self, x: int, level: int) -> str:
        """A whole number; Python refuses to write very long ones."""
        if x.bit_length() > _LONGEST_INT:
            return f"a whole number of {x.bit_length()} bits"
        return super().repr_int(x, level)


_LONGEST_INT = 10_000  # bits; Python's own limit is 4300 digits
_BRIEF = _Brief()
_BRIEF.maxlevel, _BRIEF.maxstring, _BRIEF.maxother, _BRIEF.maxdict = 3, 60, 60, 4


LONGEST_TITLE = 200
"""Most characters of a title."""
LONGEST_NAME = 100
"""Most characters of a name."""


def _check_title(text: str) -> str:
    if len(text) > LONGEST_TITLE:
        raise PydanticCustomError(
            "title", f"is {shown(text)}, of {len(text)} characters; take up to {LONGEST_TITLE}"
        )
    if steering(text):
        raise PydanticCustomError(
            "title",
            f"has {shown(steering(text))}, which breaks the line or changes how a terminal shows it; leave it out",
        )
    return text


Title = Annotated[str, AfterValidator(_check_title)]
"""A text for people, on one line."""


def checked_name(name: str, pattern: str, remedy: str) -> str:
    """A name, if it is like the pattern and not too long.

    Raises
    ------
    PydanticCustomError : it is not.
    """
    if len(name) > LONGEST_NAME:
        raise PydanticCustomError(
            "name", f"is {shown(name)}, of {len(name)} characters; take up to {LONGEST_NAME}"
        )
    if not re.fullmatch(pattern, name):
        raise PydanticCustomError("name", f"is {shown(name)}{remedy}")
    return name
