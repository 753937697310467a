"""The notation: every symbol with its meaning, unit, first equation, names in the code and the page that defines it."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from importlib import resources

from IPython.display import HTML

from cosserat.data.variables import VARIABLES
from cosserat.describe import keys as listing
from cosserat.explain import cited
from cosserat.parameters import Count, Quantity
from cosserat.publications import kinds
from cosserat.thesis.book.symbols import Atom, atom, atoms, formulas
from cosserat.thesis.book.tables import framed, mathematics, prose, row, unit

_COLUMNS = ("symbol", "meaning", "unit", "first equation", "in the code", "defined on")
_MOST = 8  # names of the code that a line shows


@dataclass(frozen=True)
class Symbol:
    """One meaning of one symbol.

    symbol : in LaTeX.  unit : SI, "1" without one.  equation : of the thesis, or a section; empty if it is ours.
    page : name of the chapter that defines it; empty for those of keys and stored variables alone.
    """

    symbol: str
    meaning: str
    unit: str
    equation: str
    page: str

    @property
    def atom(self) -> Atom:
        """Its letter, accents and index."""
        return atom(self.symbol)


@dataclass(frozen=True)
class Declared:
    """A symbol as a key of a case or a stored variable declares it."""

    name: str
    symbol: str
    meaning: str
    unit: str
    equation: str


def symbols() -> list[Symbol]:
    """The symbols of the chapters by the pages that define them, in reading order."""
    text = (resources.files("cosserat.thesis.book") / "symbols.toml").read_text(encoding="utf-8")
    pages = tomllib.loads(text)["page"]
    return [
        Symbol(letter, meaning, unit, equation, page["name"])
        for page in pages
        for letter, meaning, unit, equation in page["symbols"]
    ]


def declared() -> list[Declared]:
    """The symbols of keys and of stored variables, each name once."""
    found: dict[str, Declared] = {}
    for kind in kinds():
        for key in listing.keys(kind):
            about = key.value.innermost.about
            if isinstance(about, Quantity | Count) and about.symbol:
                unit = getattr(about, "unit", "1")
                said = re.split(r"[.:;](?:\s|$)", key.meaning.strip())[0]
                found.setdefault(key.path, Declared(key.path, about.symbol, said, unit, about.source))
    for name, variable in VARIABLES.items():
        if variable.symbol:
            found.setdefault(
                name,
                Declared(name, variable.symbol, variable.long_name, variable.units, variable.equation),
            )
    return list(found.values())


def meant(symbol: Symbol, of_code: Declared) -> bool:
    """Whether a name of the code has this symbol and unit, in the chapter of the symbol's equation."""
    same = re.fullmatch(r"\d.*", symbol.equation) and re.fullmatch(r"\d.*", of_code.equation)
    chapters = {symbol.equation[:1], of_code.equation[:1]} if same else {""}
    return (
        len(chapters) == 1
        and _plain(symbol.unit) == _plain(of_code.unit)
        and _is_one_letter(of_code.symbol)
        and symbol.atom.names(atom(of_code.symbol))
    )


def _plain(unit: str) -> str:
    """A unit without blanks and with powers as in stored data, such as "m-1"."""
    return re.sub(r"[ *^]", "", unit).replace("1/m", "m-1").replace("1/s", "s-1").replace("m/s2", "ms-2")


def _is_one_letter(text: str) -> bool:
    """Whether a declared symbol is a letter with accents and indices, not a formula."""
    return not re.search(r"[/()+, ]|\\mp|[A-Z]{2}|^-|kGA", text)


def notation() -> HTML:
    """The symbols of the chapters, then those of keys and stored variables that no chapter explains."""
    of_code = declared()
    lines = [_line(symbol, [d for d in of_code if meant(symbol, d)]) for symbol in symbols()]
    return _table(lines)


def other_symbols() -> HTML:
    """Symbols of keys and stored variables that the chapters do not have, by symbol and meaning."""
    shown = symbols()
    others: dict[tuple[str, str, str, str], list[Declared]] = {}
    for item in declared():
        if not any(meant(symbol, item) for symbol in shown):
            others.setdefault((item.symbol, item.meaning, item.unit, item.equation), []).append(item)
    return _table([_line(Symbol(*about, ""), names) for about, names in others.items()])


def several_meanings() -> HTML:
    """The letters that mean different things, with each meaning and its page."""
    letters: dict[str, list[Symbol]] = {}
    for symbol in symbols():
        letters.setdefault(_letter(symbol), []).append(symbol)
    lines = [
        (
            mathematics(f"${letter}$"),
            "; ".join(f"{_typeset(s)} {prose(s.meaning)} ({_link(s.page)})" for s in found),
        )
        for letter, found in sorted(letters.items(), key=lambda item: item[0].lower().lstrip("\\"))
        if len(found) > 1
    ]
    return _table(lines, ("letter", "meanings"))


def _letter(symbol: Symbol) -> str:
    """The letter of a symbol without accents."""
    inside = re.search(r"\{(\\?\w+)\}$", symbol.atom.base)
    return inside[1] if inside else symbol.atom.base


def _line(symbol: Symbol, names: list[Declared]) -> tuple[str, ...]:
    code = [f"<code>{escape(item.name)}</code>" for item in names[:_MOST]]
    more = [f"and {len(names) - _MOST} more"] if len(names) > _MOST else []
    return (
        _typeset(symbol),
        prose(symbol.meaning),
        unit(symbol.unit),
        escape(cited(symbol.equation)).removeprefix("eq. "),
        ", ".join([*code, *more]),
        _link(symbol.page),
    )


def _typeset(symbol: Symbol) -> str:
    return mathematics(f"${escape(symbol.symbol, quote=False)}$")


def _link(page: str) -> str:
    return f'<a href="{page}.html">{_TITLES.get(page, page)}</a>' if page else ""


_TITLES = {
    "beams_to_rods": "From beams to rods",
    "ch1_directed_rod": "Chapter 1",
    "ch2_peristalsis": "Chapter 2, muscles",
    "ch2_crawlers": "Chapter 2, crawlers",
    "ch3_statics": "Chapter 3, at rest",
    "ch3_motion": "Chapter 3, in motion",
    "ch4_consistent": "Chapter 4",
}
"""Short titles of the pages that define symbols."""


def _table(lines: Sequence[tuple[str, ...]], columns: tuple[str, ...] = _COLUMNS) -> HTML:
    return framed([row(line) for line in lines], columns, what="symbols")


def first_uses(pages: Iterable[tuple[str, list[str]]]) -> dict[str, tuple[str, int]]:
    """The page and the paragraph where each symbol of the notation is used first, by the symbol.

    pages : names and paragraphs of the chapters in reading order.
    """
    wanted = {symbol.symbol: symbol.atom for symbol in symbols()}
    found: dict[str, tuple[str, int]] = {}
    for name, paragraphs in pages:
        for place, paragraph in enumerate(paragraphs):
            for used in (letter for formula in formulas(paragraph) for letter in atoms(formula)):
                for symbol, own in wanted.items():
                    if symbol not in found and own.names(used):
                        found[symbol] = (name, place)
    return found
