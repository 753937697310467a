"""Pictures and animations of any result, by its kind: `cosserat.plot`, `cosserat.animate`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

from cosserat.arguments import WHOLE, taking
from cosserat.data.dataset import case_of, content_of, holding_what_is_needed, name_of, warnings_of
from cosserat.data.files import check_destination
from cosserat.data.netcdf import opened
from cosserat.errors import InputError, path_of
from cosserat.figures.animated import ENDINGS, FRAMES, MOST_FRAMES, write_animation
from cosserat.figures.stage import Stage
from cosserat.figures.style import PICTURES, note, settings, write
from cosserat.publications import kinds
from cosserat.text import shown


def plot(result: xr.Dataset | str | Path, path: str | Path | None = None) -> Figure:
    """The picture of a result, as a matplotlib figure: its body, and curves of what its kind is about.

    Of the answer of a study, the read-outs over what is varied: lines for one number, maps for two on a grid, and for
    points each read-out over each key, with means in intervals of the key; members without an answer are marked.
    Of `cosserat.bands`, the bands with the median.  Of a fit, measured over fitted values, and the residuals.

    result : a Dataset, or the name of its file.
    path : also write the picture there, as SVG, PDF or PNG, by the ending of its name.

    Raises
    ------
    InputError : results of this kind have no picture, or a file cannot be read or written.
    """
    if path is not None:
        check_destination(path_of(path), *PICTURES, inputs=_files(result))
    data = opened(result)
    draw = _drawn_by(data)
    with settings(), holding_what_is_needed(data, "its picture"):
        figure = draw(data)
        note(figure, warnings_of(data))
    if path is not None:
        write(figure, path_of(path))
    return figure


def _drawn_by(data: xr.Dataset) -> Callable[[xr.Dataset], Figure]:
    """The function that draws a result, or the answer of a study.

    Raises
    ------
    InputError : results of its kind have no picture.
    """
    if "bands" in data.attrs:
        from cosserat.figures.bands import picture as of_bands

        return of_bands
    if "fit" in data.attrs:
        from cosserat.figures.fits import picture as of_fit

        return of_fit
    if "study" in data.attrs:
        from cosserat.figures.answers import picture as of_answer

        return of_answer
    _refuse_others(data, "a picture")
    kind = case_of(data).problem.kind
    if not kinds()[kind].picture:
        raise InputError(
            f"{name_of(data)} is of kind '{kind}', which has no picture; see it with 'cosserat show'"
        )
    return kinds()[kind].picture_function()


def _refuse_others(data: xr.Dataset, what: str) -> None:
    """Raise InputError for what is not the result of one case, which has no such thing."""
    if content := content_of(data):
        raise InputError(
            f"{name_of(data)} holds {content}, without {what}; see it with 'cosserat show', or take one case: "
            "'cosserat run CASE', of a study 'cosserat run STUDY --member NUMBER'"
        )


@taking(frames=WHOLE)
def animate(
    result: xr.Dataset | str | Path, path: str | Path | None = None, frames: int = FRAMES
) -> Stage:
    """The animation of a result: its body and curves in each state, with a slider.

    A notebook shows it as a player.  What an animation consists of: `cosserat.figures.stage.Stage`.

    result : a Dataset, or the name of its file.
    path : also write the animation there: a GIF, or HTML with a player.
    frames : most instants that are shown, at equal distances, from 2 to 1000.

    Raises
    ------
    InputError : results of this kind do not move, or a file cannot be read or written.
    """
    if path is not None:
        check_destination(path_of(path), *ENDINGS, inputs=_files(result))
    if not 2 <= frames <= MOST_FRAMES:
        raise InputError(
            f"an animation of {shown(frames)} frames cannot be drawn; take 2 to {MOST_FRAMES}"
        )
    data = opened(result)
    _refuse_others(data, "a motion")
    kind = case_of(data).problem.kind
    if not kinds()[kind].animate:
        moving = ", ".join(f"'{name}'" for name, entry in kinds().items() if entry.animate)
        raise InputError(
            f"{name_of(data)} is of kind '{kind}', which has no animation; kinds with one are {moving}"
        )
    with settings(), holding_what_is_needed(data, "its animation"):
        stage: Stage = kinds()[kind].animation_function()(data, frames)
        if path is not None:
            write_animation(stage, path_of(path))
    return stage


def _files(result: xr.Dataset | str | Path) -> list[Path]:
    """The file that a result is read from, if any."""
    return [] if isinstance(result, xr.Dataset) else [path_of(result)]
