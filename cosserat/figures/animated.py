"""Animations as files: a GIF, or a page of HTML with buttons that needs no network.

The function that a kind names in `cosserat.kinds` makes the animation.
"""

from __future__ import annotations

import html
import re
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from cosserat.data.files import whole_or_absent
from cosserat.progress import bar
from cosserat.text import printable

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation

ENDINGS = (".gif", ".html")
FRAMES = 100
"""Most frames of an animation, by default."""
MOST_FRAMES = 1000
"""Most frames that can be asked for: a page of so many holds some 20 MB."""

_DPI = 100
_BUTTONS = {
    "minus": "\u2212",
    "fast-backward": "\u00ab",
    "step-backward": "\u2039",
    "play fa-flip-horizontal": "\u25c0",
    "pause": "\u2016",
    "play": "\u25b6",
    "step-forward": "\u203a",
    "fast-forward": "\u00bb",
    "plus": "+",
}
_PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><title>{title}</title></head>
<body>
{body}
</body>
</html>
"""


def write_animation(animation: FuncAnimation, path: Path) -> None:
    """Write an animation as GIF or HTML, by the ending of its name, whole or not at all, without other programs.

    The same animation gives the same bytes.

    Raises
    ------
    InputError : the destination cannot be written.
    """
    from matplotlib.animation import HTMLWriter, PillowWriter

    with whole_or_absent(path) as temporary, tempfile.TemporaryDirectory() as folder:
        drawn = Path(folder) / f"drawn{path.suffix}"
        pace = 1000 / animation._interval  # type: ignore[attr-defined]
        writer = (
            PillowWriter(fps=pace)
            if path.suffix == ".gif"
            else HTMLWriter(fps=pace, embed_frames=True, default_mode="loop", embed_limit=1000)
        )
        figure = animation._fig  # type: ignore[attr-defined]
        animation._init_draw()  # type: ignore[attr-defined]
        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # the axes stay where they are in the first frame
        with bar(path.name) as progress:
            animation.save(
                drawn,
                writer=writer,
                dpi=_DPI,
                progress_callback=lambda done, all_: progress((done + 1) / all_, f"frame {done + 1}"),
            )
        if path.suffix == ".gif":
            temporary.write_bytes(drawn.read_bytes())
        else:
            temporary.write_text(_page(drawn.read_text("utf-8"), path.stem), encoding="utf-8")


def _page(drawn: str, title: str) -> str:
    """The page of matplotlib with buttons that need no font of another host, and without its random name."""
    text = re.sub(r'<link rel="stylesheet"\s+href="[^"]*font-awesome[^"]*">', "", drawn)
    for name, sign in _BUTTONS.items():
        text = text.replace(f'<i class="fa fa-{name}"></i>', sign)
    random = re.search(r'id="_anim_img([0-9a-f]+)"', text)
    return _PAGE.format(
        title=html.escape(printable(title)), body=text.replace(random[1], "") if random else text
    )
