"""Texts of people: how a terminal and an error sentence show them."""

from __future__ import annotations

import unicodedata

_STEERING = ("Cc", "Cf", "Cs", "Zl", "Zp")
"""Categories of Unicode that can change a terminal or a line: controls, formats (such as an override of the direction
of writing), halves of characters, breaks."""


def steering(text: str) -> str:
    """The characters of a text that can change how a terminal shows what follows, or that break the line."""
    return "".join(letter for letter in text if unicodedata.category(letter) in _STEERING)


def printable(text: object) -> str:
    r"""A text from a file for a terminal, on one line: characters that steer are shown as escapes, such as \x1b."""
    shown = str(text)
    return shown.translate(
        {ord(letter): letter.encode("unicode_escape").decode() for letter in set(steering(shown))}
    )
