"""Cross-sections of a rod, by the value of `shape` in the table `rod.section` of a case."""

from __future__ import annotations

from typing import Annotated, get_args

from pydantic import Field

from cosserat.rods.sections.composite import Layers, Stiffnesses
from cosserat.rods.sections.hollow import HollowRectangle, ISection, Tube
from cosserat.rods.sections.plain import Circle, Ellipse, Given, Rectangle, Square

AnySection = Annotated[
    Rectangle
    | Square
    | HollowRectangle
    | Circle
    | Tube
    | Ellipse
    | ISection
    | Given
    | Layers
    | Stiffnesses,
    Field(discriminator="shape"),
]
"""A section of any shape."""

SHAPES = {str(shape.model_fields["shape"].default): shape for shape in get_args(get_args(AnySection)[0])}
"""Classes of sections by their `shape`."""
