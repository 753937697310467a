"""Animations as files: a GIF, or a page of HTML with a player that needs no network.

The function that a kind names in `cosserat.kinds` makes the stage of both.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from cosserat.data.files import whole_or_absent
from cosserat.progress import bar

if TYPE_CHECKING:
    from cosserat.figures.stage import Stage

ENDINGS = (".gif", ".html")
FRAMES = 100
"""Most frames of an animation, by default."""
MOST_FRAMES = 1000
"""Most frames that can be asked for: a page of so many holds some 2 MB."""

_DPI = 100


def write_animation(stage: Stage, path: Path) -> None:
    """Write a stage as GIF or HTML, by the ending of its name, whole or not at all, without other programs.

    The same stage gives the same bytes.

    Raises
    ------
    InputError : the destination cannot be written.
    """
    with whole_or_absent(path) as temporary:
        if path.suffix == ".gif":
            temporary.write_bytes(_gif(stage, path.name))
        else:
            from cosserat.figures.player import page

            temporary.write_text(page(stage, path.stem), encoding="utf-8")


def _gif(stage: Stage, name: str) -> bytes:
    """The film of a stage; `name` : of its file, for the progress report."""
    from matplotlib.animation import PillowWriter

    from cosserat.figures.films import film

    animation = film(stage)
    figure = animation._fig  # type: ignore[attr-defined]
    animation._init_draw()  # type: ignore[attr-defined]
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # the axes stay where they are in the first frame
    with tempfile.TemporaryDirectory() as folder, bar(name) as progress:
        drawn = Path(folder) / "drawn.gif"
        animation.save(
            drawn,
            writer=PillowWriter(fps=1000 / animation._interval),  # type: ignore[attr-defined]
            dpi=_DPI,
            progress_callback=lambda done, all_: progress((done + 1) / all_, f"frame {done + 1}"),
        )
        return drawn.read_bytes()
