"""Cross-sections of a rod, by the value of `shape` in the table `rod.section` of a case."""

from __future__ import annotations

from typing import Annotated, get_args

from pydantic import Field

from cosserat.rods.sections.plain import Rectangle, Square

AnySection = Annotated[Rectangle | Square, Field(discriminator="shape")]
"""A section of any shape."""

SHAPES = {str(shape.model_fields["shape"].default): shape for shape in get_args(get_args(AnySection)[0])}
"""Classes of sections by their `shape`."""
