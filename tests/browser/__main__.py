"""`python -m tests.browser results/book` looks at a built book and prints what it saw.

The exit code is 1 if something is wrong, 2 if there is no browser.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import defaultdict
from pathlib import Path

from cosserat.errors import CosseratError

from .audit import CHECKS, PAPER, THEMES, WIDTHS, Audit, Fault, audit

LARGEST = 16e6  # bytes of a book


def size(book: Path) -> list[Fault]:
    total = sum(file.stat().st_size for file in book.rglob("*") if file.is_file())
    print(f"{'size':12} {total / 1e6:10.1f} MB of {LARGEST / 1e6:.0f} MB")
    return [Fault("size", "all", "all", "book", f"{total / 1e6:.1f} MB")] if total > LARGEST else []


def tell(found: Audit, seconds: float) -> None:
    print(
        f"{found.pages} pages at {', '.join(map(str, WIDTHS))} px and on paper of {PAPER} px, "
        f"{' and '.join(THEMES)}: {found.views} views in {seconds:.0f} s"
    )
    for check in CHECKS[:-1]:
        wrong = sum(fault.check == check for fault in found.faults)
        print(f"{check:12} {found.counts[check]:10} looked at {wrong:6} faults")


def list_faults(faults: list[Fault], shown: int) -> None:
    """One line for each sort of fault of a page, with its first elements and its views."""
    sorts = defaultdict(lambda: defaultdict(list))
    for one in faults:
        sorts[one.page, one.check, one.text][one.element].append(one.view)
    for (page, check, text), elements in sorted(sorts.items()):
        views = dict.fromkeys(view for some in elements.values() for view in some)
        print(f"{page}: {check}: {text} ({'; '.join(views)})")
        for element in list(elements)[:shown]:
            print(f"    {element}")
        if len(elements) > shown:
            print(f"    and {len(elements) - shown} more")


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.browser", description=__doc__.split("\n")[0])
    parser.add_argument("book", type=Path, help="folder of the book")
    parser.add_argument("pages", nargs="*", help="pages, such as index.html; all if none is named")
    parser.add_argument(
        "--show", type=int, default=4, help="elements to list of each sort (%(default)s)"
    )
    parser.add_argument("--processes", type=int, help="browsers (one for each processor)")
    options = parser.parse_args()
    if not (options.book / "index.html").is_file():
        parser.error(f"{options.book} holds no book; build one with 'make'")
    start = time.monotonic()
    try:
        found = audit(options.book, options.pages, options.processes)
    except CosseratError as error:
        print(f"python -m tests.browser: {error}", file=sys.stderr)
        return 2
    tell(found, time.monotonic() - start)
    faults = found.faults + size(options.book)
    list_faults(faults, options.show)
    print("no fault" if not faults else f"{len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
