"""Command lines by chance: the words of each command from its parser, dropped, doubled, mixed and misspelt."""

from __future__ import annotations

import argparse
import random
from collections.abc import Iterator

from .commands import SLOW, commands
from .judge import Input
from .schema import CASE, bases, file_of
from .values import CONTROL

_PLAIN = """\
- -- c c.toml c.nc x.nc d none/x x.svg x.csv x.pvd x.gif csv vtk vertex 0 -1 7 1e9 é * $(x) /dev/null . .. /
rod.length fig_3_10 elastica.nc --help -o --file %s"""
_VALUES = [*_PLAIN.split(), "", "\n", "rod statics", "9" * 400, "a" * 5000, CONTROL, "a\x00b", "a\udc80"]


def example(seed: int, number: int, result: bytes) -> Input:
    """The command line of this number; `result` : a file that it may find as c.nc."""
    chance = random.Random(f"{seed} {number}")
    known = {name: parser for name, parser in commands().items() if name not in SLOW}
    name = chance.choice(list(known))
    words = [name, *_right(known[name], chance)]
    for _ in range(chance.choice([0, 1, 1, 2, 3])):
        words = _changed(words, chance)
    kind = chance.choice(list(bases()))
    files = {"c.toml": file_of(kind, {}), "d/keep": b"", "c.nc": result, "text": b"a text\n"}
    words = [word for word in words if "/dev/zero" not in word]
    return Input(f"{name}: {' '.join(words)[:70]!r}", tuple(words), files)


def _right(parser: argparse.ArgumentParser, chance: random.Random) -> Iterator[str]:
    """Words that the command may take."""
    for action in parser._actions:
        value = str(chance.choice(list(action.choices))) if action.choices else chance.choice(_VALUES)
        if action.dest in ("file", "case"):
            value = {"file": "c.toml" if action.option_strings else "c.nc", "case": CASE}[action.dest]
        if not action.option_strings:
            yield value
        elif action.dest != "help" and (action.required or chance.random() < 0.4):
            yield chance.choice(action.option_strings)
            if action.nargs != 0:
                yield value


def _changed(words: list[str], chance: random.Random) -> list[str]:
    at = chance.randrange(len(words)) if words else 0
    word = words[at] if words else ""
    new = chance.choice(
        [
            chance.choice(_VALUES),
            word[:-1],
            word + word,
            word.upper(),
            f"--{word}",
            f"{word}=",
            word[::-1],
        ]
    )
    return chance.choice(
        [
            words[:at] + words[at + 1 :],
            [*words[:at], new, *words[at + 1 :]],
            [*words[:at], new, *words[at:]],
            [*words[:at], word, *words[at:]],
            chance.sample(words, len(words)),
        ]
    )
