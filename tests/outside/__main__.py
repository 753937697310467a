"""`python -m tests.outside [NAME ...]`: every case, or those named, as a table; exit 1 if one does not hold.

`python -m tests.outside --lines`: the lines that each of them needs, before and now.
"""

import sys

from . import cases, lines, motions, wishes  # noqa: F401  (they enter their checks)
from .checks import CHECKS


def main(names):
    if names == ["--lines"]:
        return show_lines()
    names = names or list(CHECKS)
    unknown = [name for name in names if name not in CHECKS]
    if unknown:
        print(f"there is no case '{unknown[0]}'; known are: {', '.join(CHECKS)}", file=sys.stderr)
        return 2
    failed = 0
    print(f"{'case':<17}{'what':<47}{'right':>14}{'found':>14}{'error':>11}{'allowed':>10}  by")
    for name in names:
        for row in CHECKS[name]():
            failed += not row.holds
            print(
                f"{name:<17}{row.what:<47}{row.right:>14.7g}{row.found:>14.7g}{row.error:>11.2e}"
                f"{row.tolerance:>10.1e}  {row.source}{'' if row.holds else '  DOES NOT HOLD'}",
                flush=True,
            )
    print(f"{failed} rows do not hold" if failed else "every row holds")
    return min(failed, 1)


def show_lines():
    try:
        print(lines.text())
    except lines.NoHistoryError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
