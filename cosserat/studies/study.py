"""A study: a case of which some keys are varied, and what is kept of every member."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import ConfigDict, Strict, model_validator
from pydantic_core import PydanticCustomError

from cosserat.parameters import Count, Items, Parameters
from cosserat.studies.designs import DESIGNS
from cosserat.text import Title, shown

MOST_MEMBERS = 10_000_000
"""Most members of a study."""

MOST_KEPT = 500
"""Most read-outs of a study."""


class Factor(Parameters):
    """One factor of a study: the dotted keys of the case that it varies, with their values.

    Keys with lists of one length are varied together.  With a design, each key has a distribution.
    """

    model_config = ConfigDict(frozen=True, extra="allow")

    name: Title = ""
    """Name of its dimension in the answer; by default that of its only key, or "member" for points."""
    names: Annotated[tuple[Title, ...], Items(1, 10_000)] | None = None
    """Names of the values along the dimension, such as those of materials."""
    sobol: Annotated[int, Count(at_least=1, at_most=MOST_MEMBERS)] | None = None
    """Number of Sobol points, a power of two; more points keep the first ones."""
    latin_hypercube: Annotated[int, Count(at_least=1, at_most=MOST_MEMBERS)] | None = None
    """Number of points of a Latin hypercube; another number has other points."""
    saltelli: Annotated[int, Count(at_least=1, at_most=MOST_MEMBERS)] | None = None
    """Number of base points of a design for Sobol's indices, a power of two; k keys give k + 2 members for each."""
    morris: Annotated[int, Count(at_least=1, at_most=MOST_MEMBERS)] | None = None
    """Number of trajectories of a design for Morris's effects; k keys give k + 1 members for each."""
    seed: Annotated[int, Count(at_most=2**32 - 1)] = 0
    """Seed of random points."""
    table: str = ""
    """Name of a CSV file with a column for each varied key, its unit in brackets: rod.length [mm]."""
    covariance: Annotated[tuple[tuple[float, ...], ...], Items(1, 1000)] | None = None
    """Covariances of normal keys in products of their SI units; these then state their mean alone."""

    @model_validator(mode="after")
    def _has_one_source(self) -> Self:
        given = [name for name in (*DESIGNS, "table") if getattr(self, name)]
        if len(given) > 1:
            raise PydanticCustomError("factor", f"has both '{given[0]}' and '{given[1]}'; give one")
        if not self.varied and not self.table:
            raise PydanticCustomError(
                "factor", "varies no key; name one with its values, such as rod.length = [...]"
            )
        if self.varied and self.table:
            raise PydanticCustomError(
                "factor",
                "has a 'table' and other keys; put their values into the table, or into a factor of their own",
            )
        if self.covariance is not None and not self.design:
            raise PydanticCustomError(
                "factor", "has a 'covariance' without random points; add 'sobol = 1024' or the like"
            )
        return self

    @property
    def design(self) -> str:
        """The word of its design; "" for lists and tables."""
        return next((name for name in DESIGNS if getattr(self, name)), "")

    @property
    def varied(self) -> dict[str, Any]:
        """The varied keys, dotted, with what stands behind them."""
        return dict(flattened(self.model_extra or {}))


def flattened(table: Mapping[str, Any], before: tuple[str, ...] = ()) -> list[tuple[str, Any]]:
    """Nested tables as dotted keys; a table with the name of a law, or one that is empty, is a value."""
    from cosserat.studies.distributions import LAWS

    found: list[tuple[str, Any]] = []
    for key, value in table.items():
        path = (*before, str(key))
        if isinstance(value, Mapping) and value and not set(value) & set(LAWS):
            found += flattened(value, path)
        else:
            found.append((".".join(path), value))
    return found


class Study(Parameters):
    """A family of cases: one case with some keys varied, solved for every member, as one Dataset."""

    kind: Literal["study"] = "study"
    title: Title = ""
    """Description in a few words; the name by default."""
    source: Title = ""
    """Its place in a publication, or its origin."""
    of: str
    """Name of the case that is varied."""
    vary: Annotated[tuple[Factor, ...], Items(1, 20)]
    """The factors; their members multiply, and the first is the slowest."""
    keep: dict[str, str] = {}  # noqa: RUF012 - pydantic copies it
    """Read-outs by name: a variable of the result, as 'cosserat show' lists them, such as "u.E2 at last" or
    "max |kappa|".  Before it may stand max, min, mean, norm, range, final or change, behind it a place or an instant
    with 'at', such as 1.2 m, 50 % or 0.5 s; "load_factor where |u.E2| at last reaches 5 cm" is the value at an
    instant."""
    keep_whole: Annotated[tuple[str, ...], Items(0, 50)] = ()
    """Variables of the result that are kept whole; where sizes differ between members, ends are filled with NaN."""
    sensitivities: Annotated[bool, Strict()] = False
    """Whether the exact derivative of each read-out by each varied quantity is stored with it."""

    @model_validator(mode="after")
    def _keeps_something(self) -> Self:
        if not self.keep and not self.keep_whole:
            raise PydanticCustomError(
                "keep",
                "keeps nothing; name a read-out, such as keep.tip = \"u.E2 at last\", or 'keep_whole'",
            )
        if len(self.keep) > MOST_KEPT:
            raise PydanticCustomError(
                "keep",
                f"keeps {len(self.keep)} read-outs; keep up to {MOST_KEPT}, or variables by 'keep_whole'",
            )
        for name in self.keep:
            if not name.isidentifier() or not name.isascii():
                raise PydanticCustomError(
                    "name",
                    f"keeps {shown(name)}, which cannot name a variable; use letters, digits and '_'",
                )
        return self
