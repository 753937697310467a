"""Symbols in the mathematics of the chapters: what a formula uses, and where in reading order."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

_GREEK = (
    "alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta kappa lambda mu nu xi pi rho sigma tau phi "
    "varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega ell"
).replace(" ", "|")
_STYLE = "mathbf|boldsymbol|mathcal|bar|tilde|hat|dot|ddot|widehat|overline"
_ARGUMENT = rf"\{{(?:\\(?:{_GREEK})|[A-Za-z]|\\(?:{_STYLE})\{{?\\?\w+\}}?)\}}|\s*\\(?:{_GREEK})(?![A-Za-z])|\s+[A-Za-z]"
_ATOM = re.compile(
    rf"(?P<before>\{{\}}[_^](?:\{{[^{{}}]*\}}|\w)\s*)?"
    rf"(?P<base>\\(?:{_STYLE})(?:{_ARGUMENT})|\\(?:{_GREEK})(?![A-Za-z])|(?<![\\A-Za-z])[A-Za-z](?![A-Za-z]))"
    r"(?P<marks>(?:'|\^\*|\^\{\*\})*)"
    r"(?P<index>_(?:\{[^{}]*\}|\\?[A-Za-z0-9]+))?"
)
_WORDS = re.compile(
    r"\\(?:text|mathrm|operatorname|tag|label|ref|begin|end)\*?\{[^{}]*\}|\\[,;!: ]|\\(?:left|right|quad|qquad)\b"
)

_FORMULA = re.compile(
    r"\$\$(.*?)\$\$|\\begin\{equation\*\}(.*?)\\end\{equation\*\}|\$([^$]+)\$", re.DOTALL
)


@dataclass(frozen=True)
class Atom:
    r"""One letter of a formula with its accents, without exponents.

    part : it belongs to one part of the discrete rod, as in {}_K A.  base : such as \mathbf{d}.
    index : its lower index, empty if there is none.
    """

    part: bool
    base: str
    index: str

    def names(self, symbol: Atom) -> bool:
        """Whether this symbol of the notation means that atom of a formula; a letter as index stands for any."""
        if (self.part, self.base) != (symbol.part, symbol.base):
            return False
        return bool(symbol.index) if self.index in _GENERAL else self.index == symbol.index


_GENERAL = frozenset(("i", "j", "K", r"\alpha", r"\beta", r"\alpha i", "ij"))


def atoms(formula: str) -> Iterator[Atom]:
    """The symbols of a formula in their order."""
    for match in _ATOM.finditer(_WORDS.sub(" ", formula)):
        styled = re.fullmatch(rf"\\({_STYLE})\s*\{{?\s*(.+?)\s*\}}?", match["base"])
        base = f"\\{styled[1]}{{{styled[2]}}}" if styled else match["base"]
        index = (match["index"] or "").lstrip("_").strip("{}").strip()
        yield Atom(match["before"] is not None, base, index)


def atom(symbol: str) -> Atom:
    """The one atom of a symbol of the notation."""
    return next(atoms(symbol))


def paragraphs(chapter: str) -> list[str]:
    """The paragraphs of the text cells of a chapter, and its code cells with captions, in their order."""
    found: list[str] = []
    for cell in re.split(r"^# %%", chapter, flags=re.MULTILINE)[1:]:
        head, _, body = cell.partition("\n")
        if "[markdown]" in head:
            text = re.sub(r"^# ?", "", body, flags=re.MULTILINE)
            text = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
            found += [part for part in re.split(r"\n\s*\n", text) if part.strip()]
        elif "$" in body:
            found.append(body.replace("\\\\", "\\"))
    return found


def formulas(text: str) -> Iterator[str]:
    """The formulas in a text, in their order."""
    for match in _FORMULA.finditer(text):
        yield match[1] or match[2] or match[3]
