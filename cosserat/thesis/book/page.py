"""The doors of a chapter: stored data, drawn figures, rows of the report, and lines of the library.

A chapter computes no published case again and types no result; it reads results of the workflow and asserts its rows.
"""

from __future__ import annotations

import base64
from html import escape

from IPython.display import HTML, Markdown

from cosserat.thesis.book.key_lists import anchor, common_keys, keys
from cosserat.thesis.book.listings import excerpt, source, written
from cosserat.thesis.book.players import player
from cosserat.thesis.book.tables import folded, mathematics, table
from cosserat.thesis.book.tutorial import Folder
from cosserat.thesis.book.verdicts import amount, errata, misprint, row, rows
from cosserat.thesis.book.workflow import data, results, study
from cosserat.thesis.figures.catalogue import entry
from cosserat.thesis.table.left_out import LeftOutList, read_left_out

__all__ = [
    "Folder",
    "amount",
    "anchor",
    "common_keys",
    "data",
    "errata",
    "excerpt",
    "figure",
    "folded",
    "keys",
    "left_out",
    "misprint",
    "player",
    "results",
    "row",
    "rows",
    "source",
    "study",
    "table",
    "text",
    "written",
]


def figure(name: str, caption: str) -> HTML:
    """A drawn figure with its number and a caption."""
    picture = base64.b64encode((results() / "figures" / f"{name}.svg").read_bytes()).decode()
    found = entry(name)
    text = f"<b>{escape(found.title)}.</b> {mathematics(caption)}"
    image = f'<img alt="{escape(found.alt)}" src="data:image/svg+xml;base64,{picture}">'
    return HTML(f'<figure class="plot" id="{name}">{image}<figcaption>{text}</figcaption></figure>')


def left_out() -> LeftOutList:
    """Parts of the thesis that are left out, with the reasons."""
    return read_left_out(results() / "left_out.toml")


def text(sentence: str) -> Markdown:
    """A sentence with measured numbers in it."""
    return Markdown(sentence)
