"""Supports: degrees of freedom (DOFs) by name, or a word for what is held of the place, angle and stretch of a section.

derived: a director keeps its angle where its component across the reference director is zero.  Its length then is the
component along it.  So each of angle and stretch is one component, wherever the reference director points.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError, core_schema

from cosserat.parameters import Reader
from cosserat.rods.constraints import Constraint
from cosserat.rods.naming import Direction, DofName, Name, unit_vector
from cosserat.text import shown

Array = NDArray[np.float64]
_FREE = "clamped, free to stretch"


@dataclass(frozen=True)
class Held:
    """What a word holds of a section.

    across_only : of the position only the component across a direction.  along : that direction by default.
    """

    angle: bool = False
    stretch: bool = False
    across_only: bool = False
    along: str = "E3"


SUPPORTS: dict[str, Held] = {
    "clamped": Held(angle=True, stretch=True),
    _FREE: Held(angle=True),
    "pinned": Held(),
    "roller": Held(across_only=True),
    "guided": Held(across_only=True, angle=True, along="E2"),
}
"""What each word holds."""
_DOFS: tuple[DofName, ...] = get_args(DofName)


class FixedName(Reader):
    """Annotation: a word for a support, or names of degrees of freedom."""

    @property
    def alternatives(self) -> Any:
        """A word, or a list of names."""
        return (
            Literal["clamped", "clamped, free to stretch", "pinned", "roller", "guided"]
            | tuple[DofName, ...]
        )

    @property
    def said(self) -> str:
        """In words."""
        words, names = (", ".join(f'"{name}"' for name in known) for known in (SUPPORTS, _DOFS))
        return f"{words}, or a list of degrees of freedom from {names}"

    def check(self, value: object, info: core_schema.ValidationInfo) -> str | tuple[str, ...]:
        """Read one word or a list."""
        if isinstance(value, str) and value in SUPPORTS:
            return value
        if not isinstance(value, list | tuple) or len(value) > len(_DOFS):
            raise PydanticCustomError("type", f"is {shown(value)}; it must be {self.said}")
        for name in value:
            if name not in _DOFS:
                raise PydanticCustomError("type", f"has {shown(name)}; it must be {self.said}")
        return tuple(value)


def _shown(fixed: str | tuple[DofName, ...]) -> str:
    return repr(fixed if isinstance(fixed, str) else list(fixed))


class Support(Constraint):
    """A support at one place, with a vertex there."""

    fixed: Annotated[str | tuple[DofName, ...], FixedName()]
    """What it holds at its reference value, by a word or by names of components of the position (x) and director (d).

    "clamped": place, angle and stretch of the section, as if it were bonded.  "clamped, free to stretch": place and
    angle; the section slides on the clamp.  "pinned": place.  "roller": place across `along`.  "guided": place across
    `along`, and angle.
    """
    along: Direction | None = None
    """Direction in which a roller rolls ("E3" by default) or a guided section moves ("E2" by default)."""
    name: Name | None = None
    """Name of the support in the result; its place by default."""

    @property
    def label(self) -> str:
        """Its name, or else its place."""
        return self.name or super().label

    @model_validator(mode="after")
    def _has_a_direction(self) -> Self:
        if self.along is not None and not self._word.across_only:
            raise PydanticCustomError(
                "along",
                f"has 'along', but fixed = {_shown(self.fixed)} has no direction in which it moves; leave it out, or "
                "take 'roller' or 'guided'",
            )
        return self

    @property
    def _word(self) -> Held:
        return SUPPORTS[self.fixed] if isinstance(self.fixed, str) else Held()

    @property
    def free_along(self) -> Array | None:
        """The direction in which the place is free, (2,); None if there is none by a word."""
        if not self._word.across_only:
            return None
        return unit_vector(self._word.along if self.along is None else self.along)

    @property
    def fixes(self) -> tuple[DofName, ...]:
        """The fixed DOFs that are given by name."""
        return () if isinstance(self.fixed, str) else self.fixed

    def holds(self, D: Array) -> list[tuple[str, Array]]:
        """The components that it holds."""
        if not isinstance(self.fixed, str):
            return super().holds(D)
        free, unit = self.free_along, D / np.hypot(*D)
        held = [("x", axis) for axis in np.eye(2)]
        if free is not None:
            held = [("x", np.array([-free[1], free[0]]))]
        if self._word.angle:
            held.append(("d", np.array([unit[1], -unit[0]])))
        if self._word.stretch:
            held.append(("d", unit))
        return held

    def part(self, rod: object, geometry: object) -> None:
        """No motion."""
