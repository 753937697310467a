"""Tables of numbers in a case, rows or a CSV file whose header has the units; tables that one value may stand for."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, GetCoreSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

from cosserat.parameters import Quantity, Reader, from_file, nearest
from cosserat.units import to_si

Rows = tuple[tuple[float, ...], ...]
"""The rows of a table, in SI units."""
_TITLE = re.compile(r"\s*(?P<name>[^\[(]*?)\s*(?:[\[(]\s*(?P<unit>[^\])]*?)\s*[\])])?\s*")


@dataclass(frozen=True)
class Columns(Reader):
    """Annotation of a table: `record: Annotated[Rows, Columns((("time", "s"), ("force", "N")))]`.

    In a case it is a list of rows, or the name of a CSV file.  The header of the file names each column, with its unit
    in brackets: `time [ms], force [kN]`.  Other columns are ignored.  A name is relative to the folder of the case
    file.  The numbers of a file become part of the case.

    columns : names and SI units of the columns.
    increasing : whether the first column must increase.
    least_rows : number of rows that it needs.
    """

    columns: tuple[tuple[str, str], ...]
    increasing: bool = True
    least_rows: int = 2

    @property
    def alternatives(self) -> Any:
        """Rows, or the name of a file."""
        cells: Any = tuple(Annotated[float, Quantity(unit)] for _, unit in self.columns)
        rows: Any = tuple[tuple[cells], ...]
        return rows | str

    @property
    def said(self) -> str:
        """The type in words."""
        row = ", ".join(f"{name} in {unit}" if unit != "1" else name for name, unit in self.columns)
        return f"a list of rows [{row}], or the name of a CSV file with these columns"

    def check(self, value: object, info: core_schema.ValidationInfo) -> Rows:
        """Read the rows of a table."""
        if isinstance(value, str):
            folder = (info.context or {}).get("folder") or Path()
            rows = self._read_file(Path(folder) / value, value)
        elif isinstance(value, list | tuple) or hasattr(value, "__array__"):
            every: Any = value
            rows = [self._row(number, row, info) for number, row in enumerate(every)]
        else:
            raise PydanticCustomError("type", f"is {value!r}; it must be {self.said}")
        return self._checked(rows)

    def _row(self, number: int, row: Any, info: core_schema.ValidationInfo) -> tuple[float, ...]:
        cells = list(row) if isinstance(row, list | tuple) or hasattr(row, "__array__") else [row]
        if len(cells) != len(self.columns):
            raise PydanticCustomError(
                "row",
                f"has the row {row!r} at {number}; each row must be [{', '.join(name for name, _ in self.columns)}]",
            )
        return tuple(
            self._cell(cell, unit, f"row {number}, {name},", required=from_file(info))
            for cell, (name, unit) in zip(cells, self.columns, strict=True)
        )

    @staticmethod
    def _cell(cell: object, unit: str, place: str, *, required: bool) -> float:
        try:
            return to_si(cell, unit, unit_required=required)
        except PydanticCustomError as error:
            raise PydanticCustomError("cell", f"has a fault: {place} {error.message()}") from None

    def _checked(self, rows: list[tuple[float, ...]]) -> Rows:
        name = self.columns[0][0]
        if len(rows) < self.least_rows:
            raise PydanticCustomError(
                "rows",
                f"has {len(rows)} row{'s' * (len(rows) != 1)}; it needs {self.least_rows} or more",
            )
        late = np.flatnonzero(np.diff([row[0] for row in rows]) <= 0) if self.increasing else np.empty(0)
        if late.size:
            number = int(late[0])
            raise PydanticCustomError(
                "order",
                f"has {name} {rows[number][0]:g} before {rows[number + 1][0]:g}; sort the rows by {name}, "
                "each only once",
            )
        return tuple(rows)

    def _read_file(self, file: Path, given: str) -> list[tuple[float, ...]]:
        def refused(why: str) -> PydanticCustomError:
            return PydanticCustomError("csv", f"is the file '{given}', {why}")

        try:
            text = file.read_text(encoding="utf-8-sig")
        except OSError as error:
            raise refused(
                f"which cannot be read ({error.strerror}); give the name of a CSV file relative to the "
                "case file, or the rows themselves"
            ) from None
        except UnicodeDecodeError:
            raise refused("which is not in UTF-8; save it as UTF-8") from None
        lines = [
            line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")
        ]
        if not lines:
            raise refused("which is empty; give it a header and rows")
        separator = max(",;\t", key=lines[0].count)
        header, *rows = csv.reader(lines, delimiter=separator)
        places = [self._column(name, unit, header, refused) for name, unit in self.columns]
        found = []
        for number, row in enumerate(rows, start=1):
            if len(row) != len(header):
                raise refused(
                    f"whose row {number} has {len(row)} cells, but the header has {len(header)}; "
                    "give every row as many cells"
                )
            try:
                found.append(tuple(float(row[column]) * factor for column, factor in places))
            except ValueError:
                raise refused(
                    f"whose row {number} is {separator.join(row)!r}, with a cell that is no number; "
                    "write plain numbers with decimal points"
                ) from None
        if not np.isfinite(found).all():
            raise refused("with a cell that is not finite; leave such rows out")
        return found

    def _column(self, name: str, unit: str, header: list[str], refused: Any) -> tuple[int, float]:
        """Index of a column, and the factor to its SI unit."""
        titles = [_TITLE.fullmatch(title) for title in header]
        names = [found["name"].casefold() if found else "" for found in titles]
        if name.casefold() not in names:
            wanted = ", ".join(f"{own} [{unit}]" for own, unit in self.columns)
            raise refused(
                f"whose header has no column '{name}'{nearest(name, [n for n in names if n])}; "
                f"begin it with a header such as '{wanted}'"
            )
        index = names.index(name.casefold())
        title = titles[index]
        written = title["unit"] if title is not None else None
        if unit == "1" and not written:
            return index, 1.0
        if not written:
            raise refused(f"whose column '{name}' has no unit; write '{name} [{unit}]' in its header")
        try:
            return index, to_si(f"1 {written}", unit, unit_required=True)
        except PydanticCustomError as error:
            raise refused(f"whose column '{name}' {error.message()}") from None


@dataclass(frozen=True)
class ShortForm:
    """Annotation of a table that may be given by one of its values alone, such as `damping = 0.02`.

    about : of this value.  key : its key.  others : what else is in the table.
    """

    about: Quantity
    key: str
    others: tuple[tuple[str, str], ...] = ()

    def widened(self, value: object) -> object:
        """The table that a short form means, none for the number zero; a table as it is."""
        if value is None or isinstance(value, Mapping | BaseModel):
            return value
        if isinstance(value, int | float) and value == 0:
            return None
        return {**dict(self.others), self.key: value}

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_before_validator_function(self.widened, handler(source))
