"""`python -m tests.hostile.faults`: try every fault; exit 1 if one does not end as promised.

`results/faults.csv` keeps for the book what came of each fault when it was tried last as often as the table says.
"""

from __future__ import annotations

import argparse
import signal
import sys

from . import catalogue  # noqa: F401  (its modules enter their faults)
from .processes import ROOT
from .table import FAULTS, Tally, store, tried


def main() -> int:
    """Try the faults that the options name, print the table and store it."""
    options = _read()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # small disks are taken away
    chosen = [one for one in FAULTS.values() if options.only in f"{one.kind}: {one.name}"]
    if not chosen:
        print(
            f"no fault has '{options.only}' in its name; known are: {', '.join(FAULTS)}", file=sys.stderr
        )
        return 2
    tallies: list[Tally] = []
    print(f"{'fault':<58}{'tried':>6}{'as promised':>13}{'not':>5}")
    for one in chosen:
        count = one.count if options.count is None else min(one.count, options.count)
        tally = tried(one, count=count, seed=options.seed, first=options.first)
        tallies.append(tally)
        kept, failed = tally.kept, len(tally.failures)
        print(
            f"{one.kind + ': ' + one.name:<58}{kept + failed:>6}{kept:>13}{failed:>5}  {tally.lacking}",
            flush=True,
        )
        for command, found in tally.failures:
            print(f"    {found}\n      {command}", flush=True)
        if options.write or (options.count is None and options.first == 0):
            store([tally], ROOT / "results" / "faults.csv")
    failed = sum(len(tally.failures) for tally in tallies)
    print(f"{failed} not as promised" if failed else "everything as promised")
    return min(failed, 1)


def _read() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.hostile.faults", description=__doc__)
    parser.add_argument("--only", default="", metavar="WORD", help="faults with this in their name")
    parser.add_argument(
        "--count", type=int, help="attempts at each fault, if that is less (default: the table's)"
    )
    parser.add_argument(
        "--seed", type=int, default=0, help="of all random choices (default: %(default)s)"
    )
    parser.add_argument("--from", type=int, default=0, dest="first", help="number of the first attempt")
    parser.add_argument(
        "--write", action="store_true", help="write the table also with --count or --from"
    )
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
