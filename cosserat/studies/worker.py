"""One process of a study: `python -m cosserat.studies.worker batch TASK ANSWER`, or `gather FOLDER ANSWER`."""

from __future__ import annotations

import sys
from pathlib import Path

from cosserat.errors import CosseratError, InputError
from cosserat.signals import Stopped, end_by_signals


def batch(task: Path, file: Path) -> None:
    """Solve the members of a batch and write their answers.

    Raises
    ------
    InputError : the task cannot be read, or the answers cannot be written.
    """
    from cosserat.studies.solving import solve_members
    from cosserat.studies.stored import read_task, write_solved

    given = read_task(task)
    write_solved(file, given, solve_members(given))


def gather(folder: Path, file: Path) -> None:
    """Write the answer of a study whose batches are solved.

    Raises
    ------
    InputError : a batch is missing, or the answer cannot be written.
    """
    from cosserat.data.netcdf import save
    from cosserat.studies.answer import answer
    from cosserat.studies.plan import gathered

    save(answer(*gathered(folder)), file)


def main(arguments: list[str]) -> int:
    """Run one step; returns its exit status."""
    steps = {"batch": batch, "gather": gather}
    try:
        end_by_signals()
        if len(arguments) != 3 or arguments[0] not in steps:
            raise InputError(f"a step of a study is {' or '.join(steps)} with two files")
        steps[arguments[0]](Path(arguments[1]), Path(arguments[2]))
    except CosseratError as error:
        print(f"cosserat: {error}", file=sys.stderr)
        return 2 if isinstance(error, InputError) else 1
    except Stopped as stopped:
        return stopped.status  # the run that started it says so
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
