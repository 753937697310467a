"""Tables of a case that may be given by one of their values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, GetCoreSchemaHandler
from pydantic_core import core_schema

from cosserat.parameters import Quantity


@dataclass(frozen=True)
class ShortForm:
    """Annotation of a table that may be given by one of its values alone, such as `damping = 0.02`.

    about : of this value.  key : its key.  others : what else is in the table.
    """

    about: Quantity
    key: str
    others: tuple[tuple[str, str], ...] = ()

    def widened(self, value: object) -> object:
        """The table that a short form means; a table as it is."""
        if value is None or isinstance(value, Mapping | BaseModel):
            return value
        return {**dict(self.others), self.key: value}

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        return core_schema.no_info_before_validator_function(self.widened, handler(source))
