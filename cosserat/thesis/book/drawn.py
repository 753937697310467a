"""Drawn figures of the workflow, and sentences with measured numbers."""

from __future__ import annotations

import base64
from html import escape

from IPython.display import HTML, Markdown

from cosserat.thesis.book.tables import mathematics
from cosserat.thesis.book.workflow import results
from cosserat.thesis.figures.catalogue import entry


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
