"""Tables of numbers in a case, rows or a CSV file whose header has the units; tables that one value may stand for."""

from __future__ import annotations

import csv
import errno
import functools
import math
import os
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, GetCoreSchemaHandler
from pydantic_core import PydanticCustomError, core_schema

from cosserat.parameters import Items, Quantity, Reader, from_file, is_list, nearest
from cosserat.reading import read_text
from cosserat.text import shortened, shown
from cosserat.units import to_si

Rows = tuple[tuple[float, ...], ...]
"""The rows of a table, in SI units."""
MOST_ROWS = 100_000
"""Most rows of a table."""
_MOST_BYTES = 20_000_000
_MOST_COLUMNS = 1000
_LONGEST_TITLE = 100
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
        cells: Any = tuple(Annotated[float, quantity] for _, quantity in self._quantities)
        rows: Any = Annotated[tuple[tuple[cells], ...], Items(self.least_rows, MOST_ROWS)]
        return rows | str

    @functools.cached_property
    def _quantities(self) -> tuple[tuple[str, Quantity], ...]:
        return tuple((name, Quantity(unit)) for name, unit in self.columns)

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
        elif is_list(value):
            self._check_count(len(value))
            rows = [self._row(number, row, info) for number, row in enumerate(value)]
        else:
            raise PydanticCustomError("type", f"is {shown(value)}; it must be {self.said}")
        return self._checked(rows)

    def _row(self, number: int, row: Any, info: core_schema.ValidationInfo) -> tuple[float, ...]:
        cells = list(row) if is_list(row) else [row]
        if len(cells) != len(self.columns):
            raise PydanticCustomError(
                "row",
                f"has the row {shown(row)} at {number}; each row must be "
                f"[{', '.join(name for name, _ in self.columns)}]",
            )
        return tuple(
            self._cell(cell, quantity, f"row {number}, {name},", required=from_file(info))
            for cell, (name, quantity) in zip(cells, self._quantities, strict=True)
        )

    @staticmethod
    def _cell(cell: object, quantity: Quantity, place: str, *, required: bool) -> float:
        try:
            return quantity.read(cell, unit_required=required)
        except PydanticCustomError as error:
            raise PydanticCustomError("cell", f"has a fault: {place} {error.message()}") from None

    def _check_count(self, rows: int) -> None:
        if rows < self.least_rows:
            raise PydanticCustomError(
                "rows", f"has {rows} row{'s' * (rows != 1)}; it needs {self.least_rows} or more"
            )
        if rows > MOST_ROWS:
            raise PydanticCustomError("rows", f"has {rows} rows; it may have up to {MOST_ROWS}")

    def _checked(self, rows: list[tuple[float, ...]]) -> Rows:
        name = self.columns[0][0]
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
            return PydanticCustomError("csv", f"is the file '{shortened(given)}', {why}")

        try:
            text = read_text(file, _MOST_BYTES) if file.is_file() else _absent(file)
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
        if lines[0].count(separator) >= _MOST_COLUMNS:
            raise refused(f"whose header has more than {_MOST_COLUMNS} columns; leave some out")
        try:
            header, *rows = csv.reader(lines, delimiter=separator)
        except csv.Error as error:
            raise refused(f"which is no table ({error}); give it a header and rows") from None
        places = [self._column(name, unit, header, refused) for name, unit in self.columns]
        self._check_count(len(rows))
        return [
            self._numbers(number, row, header, places, refused)
            for number, row in enumerate(rows, start=1)
        ]

    def _numbers(
        self,
        number: int,
        row: list[str],
        header: list[str],
        places: list[tuple[int, float]],
        refused: Callable[[str], PydanticCustomError],
    ) -> tuple[float, ...]:
        """The numbers of one row of a file."""
        if len(row) != len(header):
            raise refused(
                f"whose row {number} has {len(row)} cells, but the header has {len(header)}; "
                "give every row as many cells"
            )
        found = []
        for (column, factor), (name, quantity) in zip(places, self._quantities, strict=True):
            try:
                cell = float(row[column]) * factor
            except ValueError:
                raise refused(
                    f"whose row {number} is {shown(','.join(row))}, with a cell that is no number; "
                    "write plain numbers with decimal points"
                ) from None
            if not math.isfinite(cell):
                raise refused(f"with a cell that is not finite in row {number}; leave such rows out")
            try:
                found.append(quantity.checked(cell))
            except PydanticCustomError as error:
                raise refused(f"whose row {number} has a fault: {name} {error.message()}") from None
        return tuple(found)

    def _column(
        self, name: str, unit: str, header: list[str], refused: Callable[[str], PydanticCustomError]
    ) -> tuple[int, float]:
        """Index of a column, and the factor to its SI unit."""
        titles = [_TITLE.fullmatch(title[:_LONGEST_TITLE]) for title in header]
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


def _absent(file: Path) -> str:
    """Raise OSError for what is no regular file: a folder, a device, nothing."""
    reason = errno.EISDIR if file.is_dir() else errno.ENODEV if file.exists() else errno.ENOENT
    raise OSError(reason, os.strerror(reason))


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
