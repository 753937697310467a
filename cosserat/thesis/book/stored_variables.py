"""The stored variables of a result, as a table."""

from __future__ import annotations

from IPython.display import HTML

from cosserat.data.variables import VARIABLES
from cosserat.errors import InputError
from cosserat.thesis.book.tables import table


def variables(*names: str) -> HTML:
    """Variables of a result by their names: along which dimensions each is stored, its unit and its meaning.

    Raises
    ------
    InputError : no result has such a variable.
    """
    missing = [name for name in names if name not in VARIABLES]
    if missing:
        raise InputError(
            f"no result has a variable {', '.join(missing)}; see cosserat/data/variables.py"
        )
    found = [(name, VARIABLES[name]) for name in names]
    lines = [(name, ", ".join(one.dims), one.units, one.long_name) for name, one in found]
    return table(lines, ("variable", "along", "unit", "meaning"))
