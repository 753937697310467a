"""`python -m cosserat`, and the command `cosserat`: signals are minded before anything else is imported."""

import sys

from cosserat.memory import limit_of_memory, watched
from cosserat.signals import Stopped, end_by_signals, ignore_signals, received, uninterrupted
from cosserat.surroundings import has_current_folder, open_streams, show_no_windows


def main() -> int:
    """Run the command of the command line; returns its exit status."""
    open_streams()
    show_no_windows()
    if not has_current_folder():
        print("cosserat: the current folder is gone; change to one that exists", file=sys.stderr)
        return 2
    if (limit := limit_of_memory()) is not None and (status := watched(limit)) is not None:
        return status
    return _main()


def _main() -> int:
    try:
        end_by_signals()
        with uninterrupted():  # an exception amid the import of a compiled library is a panic
            from cosserat import cli

        return cli.main()
    except BaseException:  # a library may turn the exception of a signal into another one
        if not received:
            raise
        stopped = Stopped(received[0])
        print(f"cosserat: {stopped}", file=sys.stderr)
        return stopped.status
    finally:
        ignore_signals()


if __name__ == "__main__":
    sys.exit(main())
