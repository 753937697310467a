"""A player of stored states: a figure of a page with a slider, which needs no network and computes nothing.

How another module makes one:

    from cosserat.figures.player import figure
    from cosserat.figures.stage import Line, Mark, Panel, Slider, Stage

    body = Line(x, y, look="computed", fill="body", closed=True)  # x, y: (states, points), in the units of the panel
    side = Panel((body,), "along E3 [m]", "along E2 [m]", true=True, wide=True)
    curve, dot = Line(time, energy), Mark(time, energy)  # (states,): the curve stays, the dot runs on it
    graph = Panel((curve, dot), "time [s]", "energy [J]")
    stage = Stage("A beam", "The beam swings ...", (side, graph), Slider("time", time, "s"), seconds=4.0)
    html = figure(stage, "fig_beam", "A caption.")

A line of shape (k,) stays, one of shape (states, k) moves.  Without scripts and on paper the states of its poster
are drawn.  States travel in the page as whole numbers of 16 bits: value = offset + step * number.  A step is an eighth
of a pixel of the drawing, so what is shown is within a sixteenth of a pixel of what is stored; -32768 is a gap.
"""

from __future__ import annotations

import base64
import html
import json
from importlib import resources
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cosserat.figures import drawing
from cosserat.figures.drawing import Frame
from cosserat.figures.stage import LOOKS, Line, Mark, Slider, Stage
from cosserat.text import printable

Array = NDArray[np.float64]

GAP = -32768
"""The whole number that stands for no value."""
_PER_PIXEL = 8  # steps of a stored number
_PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{title}</title>
<style>body {{ margin: 1rem auto; max-width: 56rem; padding: 0 0.5rem; background: var(--player-paper); }}
{style}</style></head>
<body>
{figure}
<script>{script}</script>
</body>
</html>
"""


class _Fields:
    """The arrays of a stage as whole numbers, each once."""

    def __init__(self) -> None:
        self.stored: list[dict[str, Any]] = []
        self._known: dict[tuple[bytes, tuple[int, ...], float, float], int] = {}

    def add(self, values: Array, offset: float, pixel: float) -> int:
        """The number of an array; one pixel is so much of its unit."""
        step = float(f"{pixel / _PER_PIXEL:.6g}")
        offset = float(f"{offset:.6g}")
        key = (np.ascontiguousarray(values).tobytes(), values.shape, offset, step)
        if key not in self._known:
            self._known[key] = len(self.stored)
            self.stored.append({"offset": offset, "step": step, "data": _packed(values, offset, step)})
        return self._known[key]


def _packed(values: Array, offset: float, step: float) -> str:
    known = np.isfinite(values)
    numbers = np.clip(np.rint((np.where(known, values, offset) - offset) / step), GAP + 1, -GAP - 1)
    return base64.b64encode(np.where(known, numbers, GAP).astype("<i2").tobytes()).decode()


def unpacked(field: dict[str, Any]) -> Array:
    """The values of a stored field, as the script reads them, in one row."""
    numbers = np.frombuffer(base64.b64decode(field["data"]), "<i2").astype(float)
    return np.where(numbers == GAP, np.nan, field["offset"] + field["step"] * numbers)


def states(stage: Stage) -> dict[str, Any]:
    """All states of a stage, as they travel in a page."""
    fields, parts = _Fields(), []
    for panel in stage.panels:
        frame = Frame.of(panel)
        _, along, _, up = frame.map
        for part in panel.parts:
            if part.moves:
                numbers = (
                    fields.add(part.x, frame.xlim[0], 1 / along),
                    fields.add(part.y, frame.ylim[0], -1 / up),
                )
                parts.append(_part(part, numbers, frame))
    values = stage.slider.values
    pace = (values - values[0]) / ((values[-1] - values[0]) or 1.0)
    return {
        "seconds": stage.seconds,
        "loop": stage.loop,
        "pace": [float(f"{share:.4f}") for share in pace],
        "clock": [
            [printable(slider.spoken(place)) for place in range(slider.values.size)]
            for slider in stage.sliders
        ],
        "fields": fields.stored,
        "parts": parts,
    }


def _part(part: Line | Mark, numbers: tuple[int, int], frame: Frame) -> dict[str, Any]:
    said: dict[str, Any] = {
        "x": numbers[0],
        "y": numbers[1],
        "map": [float(f"{number:.7g}") for number in frame.map],
    }
    if isinstance(part, Mark):
        return said | {"mark": True}
    count = part.x.shape[-1] if part.x.ndim == 2 else part.y.shape[-1]
    said |= {"count": count, "still": [part.x.ndim == 1, part.y.ndim == 1], "closed": part.closed}
    if part.base is not None:
        said["base"] = part.base
    return said


def figure(stage: Stage, name: str, caption: str = "") -> str:
    """A stage as an element <figure>; the script and the style of this module make it play.

    name : its id, unique in the page.  caption : HTML.
    """
    panels = "".join(_panel(stage, number) for number in range(len(stage.panels)))
    legend = "".join(f"<li>{_swatch(part)}{html.escape(part.label)}</li>" for part in stage.labels)
    drawn = "; ".join(printable(stage.spoken(state)) for state in stage.drawn)
    sliders = zip(stage.sliders, stage.places(stage.drawn[-1]), strict=True)
    inputs = "".join(_input(slider, place) for slider, place in sliders)
    packed = json.dumps(states(stage), separators=(",", ":"), ensure_ascii=False).replace("<", r"\u003c")
    return (
        f'<figure class="player" id="{html.escape(name)}" data-player>'
        f'<div class="panels">{panels}</div>'
        + (f'<ul class="legend">{legend}</ul>' if legend else "")
        + f'<p class="drawn">Drawn: {html.escape(drawn)}.</p>'
        f'<div class="controls" hidden><button type="button">Play</button>{inputs}</div>'
        f'<script type="application/json">{packed}</script>'
        f"<figcaption>{caption}</figcaption></figure>"
    )


def _input(slider: Slider, place: int) -> str:
    """A slider with its value beside it."""
    return (
        f'<span><input type="range" min="0" max="{slider.values.size - 1}" step="1" value="{place}" '
        f'aria-label="{html.escape(slider.label)}"><output></output></span>'
    )


def _panel(stage: Stage, number: int) -> str:
    """The drawing of one panel; the script fills what is alive."""
    frame = Frame.of(stage.panels[number])
    still = "".join(drawing.shape(part, frame, 0) for part in frame.panel.parts if not part.moves)
    alive = "".join(_empty(part) for part in frame.panel.parts if part.moves)
    kind = "wide" if frame.panel.wide else "bare" if frame.panel.bare else "half"
    spoken = (
        f'role="img" aria-label="{html.escape(printable(stage.alt))}"'
        if number == 0
        else 'aria-hidden="true"'
    )
    return (
        f'<svg class="{kind}" {spoken} viewBox="0 0 {frame.width} {frame.height}" xmlns="http://www.w3.org/2000/svg">'
        f"{drawing.axes(frame)}<g>{still}</g>"
        f'<g class="poster">{drawing.poster(stage, frame)}</g><g class="alive">{alive}</g></svg>'
    )


def _empty(part: Line | Mark) -> str:
    drawn = f' d="{drawing.sign_path(part)}"' if isinstance(part, Mark) else ""
    return f"<path {drawing.attributes(part)}{drawn} data-part/>"


def _swatch(part: Line | Mark) -> str:
    """A small picture of a line or a mark."""
    if isinstance(part, Mark):
        place = "translate(11 3)" if part.sign == "triangle" else "translate(11 8)"
        inside = f'<path {drawing.attributes(part)} d="{drawing.sign_path(part)}" transform="{place}"/>'
    elif part.fill:
        inside = f'<path {drawing.attributes(part)} d="M2 3H20V13H2Z"/>'
    else:
        inside = f'<path {drawing.attributes(part)} d="M1 8H21"/>'
    return f'<svg class="swatch" viewBox="0 0 22 16" aria-hidden="true">{inside}</svg>'


def script() -> str:
    """The script that plays every player of a page."""
    return (resources.files("cosserat.figures") / "player.js").read_text(encoding="utf-8")


def style() -> str:
    """The style of players, with the colours of `LOOKS` on a light and on a dark page."""
    light = "".join(f"--player-{name}:{pair[0]};" for name, pair in LOOKS.items())
    dark = "".join(f"--player-{name}:{pair[1]};" for name, pair in LOOKS.items())
    looks = "".join(
        f".player .s-{name}{{stroke:var(--player-{name})}}.player .f-{name}{{fill:var(--player-{name})}}"
        for name in LOOKS
    )
    rest = (resources.files("cosserat.figures") / "player.css").read_text(encoding="utf-8")
    return (
        f":root{{{light}}}\n"
        f"@media screen and (prefers-color-scheme:dark){{:root:not([data-theme]){{{dark}}}}}\n"
        f'@media screen{{:root[data-theme="dark"]{{{dark}}}}}\n{looks}\n{rest}'
    )


def notebook(stage: Stage) -> str:
    """A player with all that it needs, for the output of a notebook."""
    caption = html.escape(printable(stage.title))
    return f"<style>{style()}</style>{figure(stage, 'player', caption)}<script>{script()}</script>"


def page(stage: Stage, title: str) -> str:
    """A page of its own with one player."""
    title = html.escape(printable(title))
    caption = html.escape(printable(stage.title))
    return _PAGE.format(
        title=title, style=style(), figure=figure(stage, "player", caption), script=script()
    )
