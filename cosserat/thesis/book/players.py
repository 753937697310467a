"""Players of a page: stored states with a slider, drawn by `cosserat.figures.player`."""

from __future__ import annotations

from dataclasses import replace
from html import escape

from IPython.display import HTML

from cosserat.errors import InputError
from cosserat.figures.player import figure
from cosserat.figures.stage import Stage
from cosserat.text import shortened
from cosserat.thesis.book.tables import mathematics
from cosserat.thesis.book.workflow import data
from cosserat.thesis.figures.played import PLAYED


def player(what: str | Stage, caption: str, *, name: str = "", alt: str = "") -> HTML:
    """A player with its title and a caption.

    what : a name of `PLAYED`, or the stage of a result that the chapter has solved, from `cosserat.animate`.
    name : the id of the figure, needed for a stage.  alt : what is seen; that of the stage if it is left out.

    Raises
    ------
    InputError : no player of that name, or a stage without an id.
    """
    if isinstance(what, str):
        if what not in PLAYED:
            raise InputError(
                f"there is no player {shortened(what)}; the players are {', '.join(PLAYED)}"
            )
        played = PLAYED[what]
        stage, name = played.stage({case: data(case) for case in played.cases}), name or what
    elif not name:
        raise InputError("a player of a stage has no id; give it one with name=...")
    else:
        stage = what
    if alt:
        stage = replace(stage, alt=alt)
    return HTML(figure(stage, name, f"<b>{escape(stage.title)}.</b> {mathematics(caption)}"))
