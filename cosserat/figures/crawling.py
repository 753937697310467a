"""Crawls as stages of the player: the body on the ground, its stretches, and the paths of its ends."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from cosserat.figures.animated import FRAMES
from cosserat.figures.crawlers import resting_radius
from cosserat.figures.stage import Line, Mark, Panel, Slider, Stage, chosen

Array = NDArray[np.float64]

_SECTIONS = 101  # of a drawn body
_PLACES = 76  # of the stretches along it
_LONGEST = 20.0  # a crawl plays in real time, and faster if that takes longer [s]
_STRETCHES = {
    "mu_1": ("computed", "stretch of the radius \N{GREEK SMALL LETTER MU}\N{SUBSCRIPT ONE}", "")
}
_STRETCHES["mu_3"] = (
    "variant",
    "stretch of the length \N{GREEK SMALL LETTER MU}\N{SUBSCRIPT THREE}",
    "6 3",
)
_ALT = (
    "A body from the side on the ground. Where the advancing load acts it is thin and long, elsewhere short and thick; "
    "these parts travel from the front to the rear. Below: the stretches along the body, and the places of its ends "
    "and of its anchor in time."
)


def animate(
    data: xr.Dataset,
    frames: int = FRAMES,
    *,
    tall: float = 1.0,
    mark: float | None = None,
    alt: str = _ALT,
) -> Stage:
    """A crawl in time; lengths are true to scale, in cm.

    frames : most instants shown, at equal distances.  tall : magnification of heights in the drawing.
    mark : fraction of the length at which a section is marked in black.
    """
    shown = chosen(data.sizes["time"], frames)
    state, time = data.isel(time=shown), data.time.to_numpy()[shown]
    panels = (
        _side(state, tall, mark),
        stretches_panel(state, state.xi_section.to_numpy()),
        _paths(state, time),
    )
    seconds = min(float(time[-1] - time[0]), _LONGEST)
    return Stage(
        str(data.attrs.get("title", "")),
        alt,
        panels,
        Slider("time", time, "s"),
        seconds,
        poster=(int(np.argmax(state.advancing.to_numpy().sum(axis=1))),),
    )


def _side(state: xr.Dataset, tall: float, mark: float | None) -> Panel:
    """The body on the ground at each instant of a crawl."""
    sections = chosen(state.sizes["section"], _SECTIONS)
    radius = np.broadcast_to(resting_radius(state), state.sizes["section"])[sections]
    along = 1e2 * state.along.to_numpy()[:, sections]
    top = 2e2 * radius * state.mu_1.to_numpy()[:, sections]
    more: list[Line | Mark] = []
    if mark is not None:
        k = round(mark * (sections.size - 1))
        near = slice(k, k + 2)
        more = [Line(along[:, near], top[:, near], "ink", "ink", 0.0, width=0.9, label="marked segment")]
    foot = Mark(
        1e2 * state.anchor_along.to_numpy(), np.zeros(along.shape[0]), "triangle", "anchor", "anchor"
    )
    return side_panel(
        along, top, state.advancing.to_numpy()[:, sections] > 0.5, (*more, foot), tall=tall
    )


def side_panel(
    along: Array,
    top: Array,
    thin: NDArray[np.bool_],
    more: tuple[Line | Mark, ...] = (),
    *,
    tall: float = 1.0,
) -> Panel:
    """A body on the ground from the side.

    along, top : of its sections in each state [cm], shape (states, n).  thin : whether the advancing load acts there.
    """
    parts = (
        Line(np.array([along.min(), along.max()]), np.zeros(2), look="ink", width=1.0),
        Line(along, top, look="ink", fill="body", base=0.0, width=0.9, label="anchoring load"),
        Line(
            along,
            np.where(_extended(thin), top, np.nan),
            "ink",
            "thinned",
            0.0,
            width=0.9,
            label="advancing load",
        ),
        *more,
    )
    height = "height [cm]" if tall == 1 else f"height, drawn \N{MULTIPLICATION SIGN} {tall:g} [cm]"
    return Panel(parts, "along the ground [cm]", height, true=True, tall=tall, wide=True)


def _extended(flags: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Flags (states, sections), each run extended by one section so that neighbours meet."""
    more: NDArray[np.bool_] = flags.copy()
    more[:, 1:] |= flags[:, :-1]
    return more


def stretches_panel(state: xr.Dataset, arc_length: Array) -> Panel:
    """The stretches along the body in each state; arc_length : of its resting sections [m], shape (n,)."""
    places = chosen(state.sizes["section"], _PLACES)
    at = 1e2 * arc_length[places]
    parts = tuple(
        Line(at, state[name].to_numpy()[..., places], look, dash=dash, label=label)
        for name, (look, label, dash) in _STRETCHES.items()
    )
    return Panel(parts, "arc length \N{GREEK SMALL LETTER XI} of the resting body [cm]", "stretch [1]")


def _paths(state: xr.Dataset, time: Array) -> Panel:
    """Where the ends are in time, with dots at the state that is shown."""
    parts: list[Line | Mark] = []
    for section, look, label in ((0, "exact", "rear end"), (-1, "ink", "front end")):
        along = 1e2 * state.along.to_numpy()[:, section]
        parts += [Line(time, along, look, label=label), Mark(time, along, "dot", look)]
    return Panel(tuple(parts), "time [s]", "along the ground [cm]")
