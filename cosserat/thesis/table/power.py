"""The power of the results table: change inputs and physics one at a time, and name the rows that notice.

A row notices a change if its claim no longer holds.  Either some row of the affected cases notices a change, or the
change gives a reason why no number can; both together are an error.  Rows of the thesis use cases of the thesis, rows
of our own rod use its own cases, so neither can replace the other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from typing import Any

import xarray as xr

from cosserat.cases.catalogue import Case, find
from cosserat.errors import CosseratError, InputError, OutOfToleranceError
from cosserat.problem import silent
from cosserat.runner import run
from cosserat.studies.answer import check_solved
from cosserat.studies.door import find_study, published_studies, solved
from cosserat.thesis.table.measure import judge
from cosserat.thesis.table.tolerances import Judged, Row

Physics = Callable[[], AbstractContextManager[object]]
Edit = Callable[[Any], Any]
_MAX_SHOWN_ROWS = 3  # rows that a line names


@dataclass(frozen=True)
class Change:
    """One change of some cases.

    what : a short description.  cases : the cases and studies whose rows are judged.
    places, edit : the changed inputs of the cases, such as "rod.material.young", and the change.
    first : how many values of each factor of a study are tried, by default all.
    physics : a context with different mechanics.
    unseen : the reason why no printed number depends on the change.
    """

    what: str
    cases: tuple[str, ...]
    places: tuple[str, ...] = ()
    edit: Edit | None = None
    first: int | None = None
    physics: Physics = nullcontext
    unseen: str = ""


@dataclass(frozen=True)
class Noticed:
    """A change and the rows that notice it."""

    change: Change
    rows: tuple[str, ...]

    def __str__(self) -> str:
        if not self.rows:
            return f"{self.change.what:<52} none: {self.change.unseen or 'NO REASON GIVEN'}"
        rest = len(self.rows) - _MAX_SHOWN_ROWS
        more = f" and {rest} more" if rest > 0 else ""
        return f"{self.change.what:<52} {', '.join(self.rows[:_MAX_SHOWN_ROWS])}{more}"

    @property
    def sound(self) -> bool:
        """Whether either a row notices or the change has a reason why no row can."""
        return bool(self.rows) != bool(self.change.unseen)


def changes() -> tuple[Change, ...]:
    """All changes, in the order of the thesis."""
    from cosserat.thesis.table import power_crawlers, power_rods

    return power_crawlers.CHANGES + power_rods.CHANGES


def edited(case: Case, change: Change) -> Case:
    """The case with its inputs changed, under its own name."""
    table = case.problem.model_dump()
    for place in change.places:
        *path, last = place.split(".")
        inner: Any = table
        for key in path:
            inner = inner[int(key)] if isinstance(inner, list | tuple) else inner[key]
        assert change.edit is not None
        inner[last] = change.edit(inner[last])
    problem = type(case.problem).read(table, f"case '{case.name}'", units_required=False)
    return case.model_copy(update={"problem": problem})


def notices(change: Change, rows: Sequence[Row]) -> Noticed:
    """The rows that notice: all rows of a case that no longer has an answer.

    Raises
    ------
    InputError : the changed case is invalid, so nothing was tried.
    """
    found: list[str] = []
    with change.physics():
        for name in change.cases:
            rows_of_case = [row for row in rows if row.case == name]
            try:
                data = {name: result(name, change)}
            except InputError:
                raise
            except CosseratError as error:
                found += [f"{row.id} (no answer: {type(error).__name__})" for row in rows_of_case]
                continue
            found += [_named(item) for row in rows_of_case if not (item := judge(row, data)).holds]
    return Noticed(change, tuple(found))


def result(name: str, change: Change) -> xr.Dataset:
    """The result of a changed case, or the answer of a study of it.

    Raises
    ------
    CosseratError : the case, or a member of the study, has none.
    """
    if name not in published_studies():
        return run(edited(find(name), change))
    found = find_study(name)
    factors = (
        replace(factor, values=tuple(own[: change.first] for own in factor.values))
        for factor in found.factors
    )
    answer = solved(
        replace(found, base=edited(found.base, change), factors=tuple(factors)), progress=silent
    )
    check_solved(answer, "the answer")
    return answer


def _named(item: Judged) -> str:
    """The id of a row, and its error over its tolerance."""
    if item.row.claim == "within":
        return f"{item.row.id} ({item.error_over_tolerance:.2g})"
    assert item.measured is not None
    assert item.row.found is not None
    assert item.row.found_tolerance is not None
    return f"{item.row.id} ({abs(item.measured - item.row.found) / item.row.found_tolerance:.2g})"


def table(rows: Sequence[Row], words: Sequence[str] = ()) -> Iterator[Noticed]:
    """Each change whose description has one of the words, and the rows that notice it.

    Raises
    ------
    OutOfToleranceError : after the last change, if one has neither a row that notices nor a reason, or both.
    """
    wrong = []
    for change in changes():
        if words and not any(word in change.what for word in words):
            continue
        noticed = notices(change, rows)
        if not noticed.sound:
            wrong.append(change.what)
        yield noticed
    if wrong:
        raise OutOfToleranceError(
            "changes that no row notices and that have no reason, or that a row notices although they have one: "
            + "; ".join(wrong)
        )
