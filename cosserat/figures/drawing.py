"""Panels of a stage as SVG: axes with units, what stays, and some states of what moves.

Coordinates are pixels of a drawing 720 wide, or 350 for a panel that shares its row; on a page it scales.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from html import escape

import numpy as np
from numpy.typing import NDArray

from cosserat.figures.stage import Line, Mark, Panel, Stage, at
from cosserat.text import brief

Array = NDArray[np.float64]

WIDE, NARROW, BARE = 720, 350, 172
_ROOM = (
    62,
    14,
    34,
    52,
)  # left, right, top and bottom of the axes, also for the large labels of a phone [px]
_LEFT, _RIGHT, _TOP, _BOTTOM = _ROOM
_BARE_ROOM = (3, 3, 40, 6)  # of a bare panel [px]
_HEIGHT = 150  # of the axes of a graph [px]
_LOWEST, _HIGHEST = 46, 330  # height of the axes of a panel that is true to scale [px]
_FADED = 0.4  # opacity of the first state of a poster
_SIGN_PATHS = {
    "dot": "M-4.5 0A4.5 4.5 0 1 0 4.5 0A4.5 4.5 0 1 0 -4.5 0Z",
    "ring": "M-4.5 0A4.5 4.5 0 1 0 4.5 0A4.5 4.5 0 1 0 -4.5 0Z",
    "triangle": "M0 0L-6 11L6 11Z",
    "diamond": "M0 -6L5 0L0 6L-5 0Z",
}


@dataclass(frozen=True)
class Frame:
    """Where a panel lies in its drawing: pixel = origin + scale * value, upwards with a negative scale."""

    panel: Panel
    width: int
    height: int
    xlim: tuple[float, float]
    ylim: tuple[float, float]

    @classmethod
    def of(cls, panel: Panel) -> Frame:
        """The frame of a panel, whose axes hold all of its parts."""
        width = WIDE if panel.wide else BARE if panel.bare else NARROW
        left, right, top, bottom = _BARE_ROOM if panel.bare else _ROOM
        inner = width - left - right
        margin = 0.06 if panel.true else 0.05
        x = panel.xlim or _limits([part.x for part in panel.parts], 0.03)
        y = panel.ylim or _limits([*(part.y for part in panel.parts), _bases(panel)], margin)
        if not panel.true:
            return cls(panel, width, top + _HEIGHT + bottom, x, y)
        tall = inner * panel.tall * (y[1] - y[0]) / (x[1] - x[0])
        height = min(max(tall, _LOWEST), _HIGHEST)
        if tall > height:
            x = _stretched(x, tall / height)
        else:
            y = (
                (y[0], y[0] + (y[1] - y[0]) * height / tall)
                if _bases(panel).size
                else _stretched(y, height / tall)
            )
        return cls(panel, width, round(top + height + bottom), x, y)

    @property
    def map(self) -> tuple[float, float, float, float]:
        """Origin and scale along, origin and scale up."""
        left, right, top, bottom = _BARE_ROOM if self.panel.bare else _ROOM
        along = (self.width - left - right) / (self.xlim[1] - self.xlim[0])
        up = -(self.height - top - bottom) / (self.ylim[1] - self.ylim[0])
        return left - along * self.xlim[0], along, self.height - bottom - up * self.ylim[0], up

    def pixels(self, x: Array, y: Array) -> tuple[Array, Array]:
        """Pixels of points."""
        x0, along, y0, up = self.map
        return x0 + along * x, y0 + up * y


def _bases(panel: Panel) -> Array:
    return np.array(
        [part.base for part in panel.parts if isinstance(part, Line) and part.base is not None]
    )


def _limits(values: list[Array], margin: float) -> tuple[float, float]:
    """Ends of an axis that holds all values, and some more."""
    every = np.concatenate([np.ravel(value) for value in values])
    every = every[np.isfinite(every)]
    low, high = (float(every.min()), float(every.max())) if every.size else (0.0, 1.0)
    more = margin * (high - low) or 0.5 * abs(high) or 0.5
    return low - more, high + more


def _stretched(ends: tuple[float, float], factor: float) -> tuple[float, float]:
    middle, half = (ends[0] + ends[1]) / 2, factor * (ends[1] - ends[0]) / 2
    return middle - half, middle + half


def ticks(low: float, high: float, most: float) -> list[tuple[float, str]]:
    """Round numbers between two ends with their texts, about so many."""
    raw = (high - low) / max(most, 1.0)
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= raw * (1 - 1e-9))
    digits = max(0, -math.floor(math.log10(step) + 1e-9))
    numbers = range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)
    plain = 1e-4 < step < 1e5

    def text(number: int) -> str:
        value = number * step
        return (f"{value:.{digits}f}" if plain else brief(value)).replace("-", "\N{MINUS SIGN}")

    return [(number * step, text(number)) for number in numbers]


def axes(frame: Frame) -> str:
    """Both axes with numbers and units, and the title of the panel; of a bare panel both captions alone."""
    if frame.panel.bare:
        words = (frame.panel.title, frame.panel.ylabel)
        return "".join(
            f'<text x="3" y="{14 + 16 * k}">{escape(text)}</text>' for k, text in enumerate(words)
        )
    x0, along, y0, up = frame.map
    right, bottom = frame.width - _RIGHT, frame.height - _BOTTOM
    parts = [f'<path class="grid" d="M{_LEFT} {_TOP}V{bottom}H{right}"/>']
    for value, text in ticks(*frame.xlim, (right - _LEFT) / 55):
        place = x0 + along * value
        parts.append(f'<path class="grid" d="M{place:.1f} {bottom}v5"/>')
        parts.append(f'<text x="{place:.1f}" y="{bottom + 22}" text-anchor="middle">{text}</text>')
    for value, text in ticks(*frame.ylim, (bottom - _TOP) / 28):
        place = y0 + up * value
        parts.append(f'<path class="grid" d="M{_LEFT} {place:.1f}h-5"/>')
        parts.append(f'<text x="{_LEFT - 8}" y="{place + 4.5:.1f}" text-anchor="end">{text}</text>')
    parts.append(
        f'<text x="{right}" y="{bottom + 44}" text-anchor="end">{escape(frame.panel.xlabel)}</text>'
    )
    title = f"{frame.panel.title}: " if frame.panel.title else ""
    parts.append(f'<text x="6" y="18">{escape(title + frame.panel.ylabel)}</text>')
    return "".join(parts)


def attributes(part: Line | Mark) -> str:
    """Class and style of a part."""
    if isinstance(part, Mark):
        return f'class="{"s" if part.sign == "ring" else "f"}-{part.look}" stroke-width="1.6"'
    names = [f"s-{part.look}"] if part.look else []
    names += [f"f-{part.fill}"] if part.fill else []
    dash = f' stroke-dasharray="{part.dash}"' if part.dash else ""
    return f'class="{" ".join(names)}" stroke-width="{part.width:g}"{dash}'


def shape(part: Line | Mark, frame: Frame, state: int) -> str:
    """One state of a part, as an element of SVG; empty if there is nothing to draw."""
    if isinstance(part, Mark):
        x, y = frame.pixels(at(part.x, state, 1), at(part.y, state, 1))
        if not (np.isfinite(x) and np.isfinite(y)):
            return ""
        return f'<path {attributes(part)} d="{sign_path(part)}" transform="translate({x:.1f} {y:.1f})"/>'
    drawn = outline(part, frame, state)
    return f'<path {attributes(part)} d="{drawn}"/>' if drawn else ""


def sign_path(part: Mark) -> str:
    """The outline of a sign about its point."""
    return _SIGN_PATHS[part.sign]


def outline(part: Line, frame: Frame, state: int) -> str:
    """The path of a line in one state."""
    x, y = np.broadcast_arrays(*frame.pixels(at(part.x, state, 2), at(part.y, state, 2)))
    base = None if part.base is None else f"{frame.pixels(np.zeros(1), np.array([part.base]))[1][0]:.1f}"
    known = np.isfinite(x) & np.isfinite(y)
    edges = np.flatnonzero(np.diff(np.r_[False, known, False].astype(int)))
    pieces = []
    for begin, end in zip(edges[::2], edges[1::2], strict=True):
        points = "L".join(f"{a:.1f} {b:.1f}" for a, b in zip(x[begin:end], y[begin:end], strict=True))
        down = "" if base is None else f"L{x[end - 1]:.1f} {base}L{x[begin]:.1f} {base}Z"
        pieces.append(f"M{points}{down or ('Z' if part.closed else '')}")
    return "".join(pieces)


def poster(stage: Stage, frame: Frame) -> str:
    """What moves in a panel, in the states of the poster; the later, the stronger."""
    moving = [part for part in frame.panel.parts if part.moves]
    groups = []
    for number, state in enumerate(stage.drawn, start=1):
        count = len(stage.drawn)
        strength = 1 if count == 1 else _FADED + (1 - _FADED) * (number - 1) / (count - 1)
        shapes = "".join(shape(part, frame, state) for part in moving)
        groups.append(f'<g opacity="{strength:.2g}">{shapes}</g>')
    return "".join(groups)
