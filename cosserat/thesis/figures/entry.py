"""What the list of figures says of each."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Entry:
    """One figure.

    title : its name, with its number in the thesis.
    alt : one sentence that tells what is seen, for a reader who cannot see it; neither title nor caption.
    module : the module of `cosserat.thesis.figures` that draws it.
    cases : the cases that it needs.
    rows : rows of the results table whose published numbers it shows beside the cases.
    studies : published studies that it needs.
    tables : tracked tables beside the results table, such as "peers.csv", whose rows it shows.
    round_off : whether it draws round-off, which is another one on each kind of processor.
    """

    title: str
    alt: str
    module: str
    cases: tuple[str, ...] = ()
    rows: tuple[str, ...] = ()
    round_off: bool = False
    studies: tuple[str, ...] = ()
    tables: tuple[str, ...] = ()
