"""Texts of people cannot change the terminal on which they are shown."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cosserat.text import printable


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("A rod of 5 µm, 30°, naïve; 漢字", "A rod of 5 µm, 30°, naïve; 漢字"),
        ("\x1b[31mred\x07", r"\x1b[31mred\x07"),
        ("a\nb\tc\x00", r"a\nb\tc\x00"),
        ("\u202egnp.exe\u2066", r"\u202egnp.exe\u2066"),
        ("\x9b2J\x7f\u2028\ufeff", r"\x9b2J\x7f\u2028\ufeff"),
        ("\udc80", r"\udc80"),
        (7, "7"),
    ],
)
def test_what_would_steer_a_terminal_is_shown_as_an_escape(text, shown):
    assert printable(text) == shown


@given(st.text(st.characters()))
def test_any_text_is_one_line_that_can_be_written(text):
    shown = printable(text)
    shown.encode("utf-8")
    assert len(shown.splitlines()) <= 1
    assert not any(unicodedata.category(letter) == "Cc" for letter in shown)
