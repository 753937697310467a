"""What a player shows: panels with lines and marks that have one shape for each state, and a slider over the states.

A stage is data alone.  `cosserat.figures.player` writes it as a figure of a page, `cosserat.figures.films` as a film.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cosserat.figures.style import BODY, COMPUTED, CONSISTENT, EXACT, INK, PAPER, VARIANT

Array = NDArray[np.float64]

LOOKS = {
    "ink": (INK, "#dddddd"),
    "paper": (PAPER, "#1d1f23"),
    "body": (BODY, "#2f4a63"),
    "computed": (COMPUTED, "#6cb0ee"),
    "variant": (VARIANT, "#f08a5d"),
    "consistent": (CONSISTENT, "#dddddd"),
    "exact": (EXACT, "#a0a0a0"),
    "thinned": ("#f3d3a8", "#8a6428"),
    "anchor": ("#c1121f", "#ff7b72"),
}
"""Colours by name: on white paper, and on a dark page."""

SIGNS = ("dot", "ring", "triangle", "diamond")
"""Signs of marks."""


@dataclass(frozen=True)
class Line:
    """A line of a panel, or the outline of a body.

    x, y : coordinates in the units of the panel, shape (k,) of a line that stays, (states, k) of one that moves; a NaN
        lifts the pen.
    look : its colour, a name of `LOOKS`; empty without an outline.  fill : the colour of its inside, or empty.
    base : a height down to which it is closed.  closed : whether its end is joined with its beginning.
    width : of the line in pixels.  dash : pixels drawn and left out, such as "5 3".  label : in the legend.
    """

    x: Array
    y: Array
    look: str = "computed"
    fill: str = ""
    base: float | None = None
    closed: bool = False
    width: float = 1.4
    dash: str = ""
    label: str = ""

    @property
    def moves(self) -> bool:
        """Whether it differs from state to state."""
        return self.x.ndim == 2 or self.y.ndim == 2


@dataclass(frozen=True)
class Mark:
    """A sign at one point: x, y of shape () if it stays, (states,) if it moves, where a NaN hides it."""

    x: Array
    y: Array
    sign: str = "dot"
    look: str = "computed"
    label: str = ""

    @property
    def moves(self) -> bool:
        """Whether it differs from state to state."""
        return self.x.ndim == 1 or self.y.ndim == 1


@dataclass(frozen=True)
class Panel:
    """Axes with what is drawn on them, later parts above earlier ones; what moves is above what stays.

    xlabel, ylabel : what is measured, each with its unit in brackets.
    true : whether one unit is as long up as along; `tall` is the magnification of heights then.
    wide : whether it takes a row of its own.  xlim, ylim : ends of the axes; from the parts if they are left out.
    bare : whether it is a small drawing without axes, of which four stand in a row; both labels are then captions.
    """

    parts: tuple[Line | Mark, ...]
    xlabel: str
    ylabel: str
    true: bool = False
    tall: float = 1.0
    wide: bool = False
    title: str = ""
    xlim: tuple[float, float] | None = None
    ylim: tuple[float, float] | None = None
    bare: bool = False

    def __post_init__(self) -> None:
        """Refuse an axis without a unit."""
        for label in (self.xlabel, self.ylabel):
            if not label.endswith("]") and not self.bare:
                raise ValueError(f"the axis '{label}' of a panel names no unit; end it as in 'time [s]'")


@dataclass(frozen=True)
class Slider:
    """What the slider measures: a name, the values (states,) that rise, and their unit.

    said : words on each state after its value; none if it is empty.  digits : decimals of the value that is shown.
    """

    label: str
    values: Array
    unit: str
    digits: int = 2
    said: tuple[str, ...] = ()

    def spoken(self, state: int) -> str:
        """The value with its unit, and the words on that state."""
        unit = (
            "" if self.unit == "1" else self.unit if self.unit == "\N{DEGREE SIGN}" else f" {self.unit}"
        )
        value = f"{self.values[state]:.{self.digits}f}".replace("-", "\N{MINUS SIGN}")
        return f"{self.label} {value}{unit}" + (f", {self.said[state]}" if self.said else "")


@dataclass(frozen=True)
class Stage:
    """All that a player needs.

    slider : over the states.  second : another one if there are two; the states are then all pairs of their values, and
        those of the second slider follow each other.

    title : in a few words.  alt : what is seen, for those who do not see it.
    seconds : how long it plays, at a pace that follows the values of the slider.  loop : whether it begins again.
    poster : states that are drawn where nothing plays, such as on paper.
    """

    title: str
    alt: str
    panels: tuple[Panel, ...]
    slider: Slider
    seconds: float = 5.0
    loop: bool = False
    poster: tuple[int, ...] = (-1,)
    second: Slider | None = None

    def __post_init__(self) -> None:
        """Refuse parts whose number of states is not that of the slider."""
        for panel in self.panels:
            for part in panel.parts:
                depth = 2 if isinstance(part, Line) else 1
                for values in (part.x, part.y):
                    if values.ndim == depth and values.shape[0] != self.states:
                        raise ValueError(
                            f"a part of the panel '{panel.ylabel}' has {values.shape[0]} states and the slider "
                            f"{self.states}; give as many"
                        )

    def _repr_html_(self) -> str:
        """The player that a notebook shows."""
        from cosserat.figures.player import notebook

        return notebook(self)

    @property
    def states(self) -> int:
        """Number of states."""
        return self.slider.values.size * (self.second.values.size if self.second else 1)

    @property
    def sliders(self) -> tuple[Slider, ...]:
        """One slider, or two."""
        return (self.slider, self.second) if self.second else (self.slider,)

    def places(self, state: int) -> tuple[int, ...]:
        """Where the sliders stand in a state."""
        return divmod(state, self.second.values.size) if self.second else (state,)

    def spoken(self, state: int) -> str:
        """The values of the sliders in a state."""
        stands = zip(self.sliders, self.places(state), strict=True)
        return ", ".join(slider.spoken(place) for slider, place in stands)

    @property
    def drawn(self) -> tuple[int, ...]:
        """Indices of the states of the poster, counted from the first."""
        return tuple(dict.fromkeys(state % self.states for state in self.poster))

    @property
    def labels(self) -> list[Line | Mark]:
        """The first part of each label, for the legend."""
        parts = [part for panel in self.panels for part in panel.parts if part.label]
        return list({part.label: part for part in reversed(parts)}.values())[::-1]


def at(values: Array, state: int, depth: int) -> Array:
    """The values of one state, of an array that moves if it has so many dimensions."""
    return np.asarray(values[state] if values.ndim == depth else values)


def chosen(count: int, most: int) -> NDArray[np.int64]:
    """Indices of at most so many states at equal distances, the first and the last among them."""
    found: NDArray[np.int64] = np.unique(
        np.linspace(0, count - 1, min(count, most)).round().astype(np.int64)
    )
    return found
