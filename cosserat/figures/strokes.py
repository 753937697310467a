"""Signs of supports, loads and masses as lines of a stage: a pen that keeps what other functions draw on axes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from cosserat.figures.stage import LOOKS, Line
from cosserat.figures.style import INK

Array = NDArray[np.float64]

_NAMES = {pair[0]: name for name, pair in reversed(LOOKS.items())}  # the first of a colour
_HEAD = np.array([[-1.0, 0.34], [0.0, 0.0], [-1.0, -0.34]])  # of an arrow, in lengths of the head
_HEAD_SHARE = 0.4  # of the length of an arrow


@dataclass
class Pen:
    """Takes the calls that signs make of the axes of Matplotlib, and keeps their lines; texts are left out."""

    kept: list[tuple[Array, Array, str, str, float]] = field(default_factory=list)

    def plot(self, x: Any, y: Any, **look: Any) -> None:
        """Keep a line."""
        colour = _NAMES.get(look.get("color", INK), "ink")
        self._keep(x, y, colour, "", look.get("linewidth", 1.4))

    def fill(self, x: Any, y: Any, **look: Any) -> None:
        """Keep a closed outline with its inside."""
        edge, inside = (look.get(name, "none") for name in ("edgecolor", "facecolor"))
        self._keep(x, y, _NAMES.get(edge, ""), _NAMES.get(inside, ""), look.get("linewidth", 1.0))

    def annotate(self, text: str, xy: Any, xytext: Any = None, **look: Any) -> None:
        """Keep an arrow."""
        if "arrowprops" not in look:
            return
        tip, foot = np.asarray(xy, dtype=float), np.asarray(xytext, dtype=float)
        arrow = tip - foot
        along = _HEAD_SHARE * arrow
        across = np.array([-along[1], along[0]])
        head = tip + _HEAD @ np.stack([along, across])
        x, y = np.vstack([foot, tip, head]).T
        self._keep(x, y, "variant", "", 1.6)

    def update_datalim(self, points: Any) -> None:
        """A stage finds its limits by itself."""

    def autoscale_view(self) -> None:
        """A stage finds its limits by itself."""

    def _keep(self, x: Any, y: Any, look: str, fill: str, width: float) -> None:
        self.kept.append(
            (np.asarray(x, dtype=float), np.asarray(y, dtype=float), look, fill, float(width))
        )


def strokes(draw: Callable[[Axes, int], None], states: int) -> list[Line]:
    """What a function draws in each state, as lines that move.

    A line that a state lacks is hidden there; lines of one number belong together if they look alike.
    """
    found: list[list[tuple[Array, Array, str, str, float]]] = []
    for state in range(states):
        pen = Pen()
        draw(cast("Axes", pen), state)
        found.append(pen.kept)
    return [
        _joined([kept[k] if k < len(kept) else None for kept in found])
        for k in range(max(map(len, found)))
    ]


def _joined(kept: Sequence[tuple[Array, Array, str, str, float] | None]) -> Line:
    """One line of the pens of all states."""
    some = [one for one in kept if one is not None]
    count = max(one[0].size for one in some)
    points = np.full((2, len(kept), count), np.nan)
    for state, one in enumerate(kept):
        if one is not None:
            points[:, state, : one[0].size] = one[0], one[1]
    stays = np.array_equal(points, np.broadcast_to(points[:, :1], points.shape))
    x, y = points[:, 0] if stays else points
    return Line(x, y, some[0][2], some[0][3], closed=bool(some[0][3]), width=some[0][4])
