"""Players of a page: stored states with a slider over time or over a parameter."""

from __future__ import annotations

from dataclasses import replace
from html import escape

from IPython.display import HTML

from cosserat.errors import InputError
from cosserat.figures.player import figure
from cosserat.figures.stage import Stage
from cosserat.text import shortened
from cosserat.thesis.book.tables import mathematics
from cosserat.thesis.book.workflow import data, study
from cosserat.thesis.figures.explored import EXPLORED
from cosserat.thesis.figures.played import PLAYED


def player(what: str | Stage, caption: str, *, name: str = "", title: str = "", alt: str = "") -> HTML:
    """A player with its title and a caption.

    what : a name of `PLAYED`, or the stage of a result that the chapter has solved, from `cosserat.animate`.
    name : the id of the figure, needed for a stage.  title, alt : what it is and what is seen, by default as the stage
        says.

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
    stage = replace(stage, title=title or stage.title, alt=alt or stage.alt)
    return _shown(stage, name, caption)


def explore(name: str, caption: str) -> HTML:
    """A figure of `EXPLORED`, whose slider is a parameter of a study, with its title and a caption.

    Raises
    ------
    InputError : there is no such figure.
    """
    if name not in EXPLORED:
        raise InputError(
            f"there is no figure {shortened(name)} to explore; they are {', '.join(EXPLORED)}"
        )
    explored = EXPLORED[name]
    return _shown(explored.stage({one: study(one) for one in explored.studies}), name, caption)


def _shown(stage: Stage, name: str, caption: str) -> HTML:
    end = "" if stage.title.endswith("?") else "."
    return HTML(figure(stage, name, f"<b>{escape(stage.title)}{end}</b> {mathematics(caption)}"))
