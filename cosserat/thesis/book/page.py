"""The doors of a chapter: stored data, drawn figures, rows of the report, and lines of the library.

A chapter computes no published case again and types no result; it reads results of the workflow and asserts its rows.
"""

from __future__ import annotations

import base64
from html import escape

from IPython.display import HTML, Markdown

from cosserat.thesis.book.command_line import commands
from cosserat.thesis.book.equation_list import counts, equations, left_out, left_out_table
from cosserat.thesis.book.judgements import errata_list, results_table, total_of
from cosserat.thesis.book.key_lists import anchor, common_keys, keys
from cosserat.thesis.book.listings import excerpt, source, written
from cosserat.thesis.book.notation import notation, other_symbols, several_meanings
from cosserat.thesis.book.players import explore, player
from cosserat.thesis.book.pulling import pull
from cosserat.thesis.book.references import how_to_cite, references
from cosserat.thesis.book.stored_variables import variables
from cosserat.thesis.book.tables import folded, mathematics, table, tens
from cosserat.thesis.book.tutorial import Folder
from cosserat.thesis.book.verdicts import (
    amount,
    errata,
    misprint,
    overview,
    report,
    row,
    rows,
    today,
    unseen_changes,
)
from cosserat.thesis.book.workflow import data, results, study
from cosserat.thesis.figures.catalogue import entry

__all__ = [
    "Folder",
    "amount",
    "anchor",
    "commands",
    "common_keys",
    "counts",
    "data",
    "equations",
    "errata",
    "errata_list",
    "excerpt",
    "explore",
    "figure",
    "folded",
    "how_to_cite",
    "keys",
    "left_out",
    "left_out_table",
    "misprint",
    "notation",
    "other_symbols",
    "overview",
    "player",
    "pull",
    "references",
    "report",
    "results",
    "results_table",
    "row",
    "rows",
    "several_meanings",
    "source",
    "study",
    "table",
    "tens",
    "text",
    "today",
    "total_of",
    "unseen_changes",
    "variables",
    "written",
]


def figure(name: str, caption: str) -> HTML:
    """A drawn figure with its number and a caption."""
    picture = base64.b64encode((results() / "figures" / f"{name}.svg").read_bytes()).decode()
    found = entry(name)
    text = f"<b>{escape(found.title)}.</b> {mathematics(caption)}"
    image = f'<img alt="{escape(found.alt)}" src="data:image/svg+xml;base64,{picture}">'
    return HTML(f'<figure class="plot" id="{name}">{image}<figcaption>{text}</figcaption></figure>')


def text(sentence: str) -> Markdown:
    """A sentence with measured numbers in it."""
    return Markdown(sentence)
