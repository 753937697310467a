"""Counts of what was tried and how it ended, and the reproduction of each failure."""

from __future__ import annotations

import csv
import re
import sys
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")
STORED = Path(__file__).parents[2] / "results" / "inputs.csv"
_COLUMNS = ("what", "seed", "tried", "as promised")
_SHOWN = 3
_CONTROL = re.compile("[^\n\x20-\x7e\xa1-\u1fff\u2030-\u205f\u2070-\ud7ff]")


@dataclass
class Tally:
    """Counts by class, and the first failures of each kind."""

    tried: Counter[str] = field(default_factory=Counter)
    failed: Counter[str] = field(default_factory=Counter)
    faults: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    ends: Counter[str] = field(default_factory=Counter)

    def add(self, name: str, end: str, wrong: Iterable[str], reproduction: str) -> None:
        """One input: its name, how it ended in a word, its faults, and how to do it again."""
        group = name.partition(":")[0]
        group = re.sub(r"(?: inside)+$", " inside", group)
        self.tried[group] += 1
        self.ends[end] += 1
        wrong = list(wrong)
        self.failed[group] += bool(wrong)
        for fault in wrong:
            if fault not in self.faults:
                print(f"found: {_plain(fault)} ({_plain(name)})", file=sys.stderr, flush=True)
            self.faults.setdefault(fault, []).append((name, reproduction))

    @property
    def bad(self) -> int:
        """Inputs that did not end as promised."""
        return sum(self.failed.values())

    def text(self) -> str:
        """The table, then each fault with its smallest reproductions."""
        lines = [f"{'class':<24}{'tried':>8}{'as promised':>13}{'not':>7}"]
        for group, count in sorted(self.tried.items()):
            lines.append(f"{group:<24}{count:>8}{count - self.failed[group]:>13}{self.failed[group]:>7}")
        total = sum(self.tried.values())
        lines += [f"{'all':<24}{total:>8}{total - self.bad:>13}{self.bad:>7}", ""]
        lines += ["ends: " + ", ".join(f"{end} {count}" for end, count in self.ends.most_common()), ""]
        for fault, found in sorted(self.faults.items(), key=lambda item: (-len(item[1]), item[0])):
            lines.append(f"## {fault}  ({len(found)})")
            for name, reproduction in sorted(found, key=lambda one: len(one[1]))[:_SHOWN]:
                lines += [f"- {name}", *(f"    {line}" for line in reproduction.splitlines())]
            lines.append("")
        return _plain("\n".join(lines))


def store(tally: Tally, what: str, seed: int | str) -> None:
    """Put the counts into `results/inputs.csv`, in the place of those of the same inputs and seed."""
    rows = {}
    if STORED.exists():
        with STORED.open(newline="", encoding="utf-8") as file:
            rows = {(row["what"], row["seed"]): row for row in csv.DictReader(file)}
    tried = sum(tally.tried.values())
    values = (what, str(seed), tried, tried - tally.bad)
    rows[what, str(seed)] = dict(zip(_COLUMNS, values, strict=True))
    with STORED.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, _COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows[key] for key in sorted(rows))


def _plain(text: str) -> str:
    return _CONTROL.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


def followed(given: Iterable[T], total: int, words: str) -> Iterator[T]:
    """The same, with progress on standard error."""
    start = last = time.monotonic()
    for number, one in enumerate(given):
        yield one
        if time.monotonic() - last > 5:
            last = time.monotonic()
            print(f"{words}: {number + 1} of {total}, {last - start:.0f} s", file=sys.stderr, flush=True)
