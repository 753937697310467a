"""The entries of all figures: what each is called, what is seen in it, and what it is drawn from."""

from __future__ import annotations

from cosserat.thesis.figures.body_entries import BODIES
from cosserat.thesis.figures.entry import Entry
from cosserat.thesis.figures.rod_entries import RODS

FIGURES: dict[str, Entry] = BODIES | RODS
"""Figures by the name of the function that draws them."""
