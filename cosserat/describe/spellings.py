"""Patterns of quantities with units, for editors, which cannot call the reader.

A unit of one word must be listed here and must have the right dimension.  Of compound units, such as "N/mm^2", a
pattern rejects those that it knows to be of another dimension.  All others pass, and the reader checks them.
"""

from __future__ import annotations

import functools
import re

from cosserat.units import is_read_as

_PREFIXED = [
    prefix + unit for unit in ("m", "g", "s", "N", "Pa", "Hz", "J", "rad") for prefix in "kMGdcmµμun"
]
_WORDS = (
    "m in inch ft foot yd mi meter metre g t lb oz s sec second min minute h hr hour day N lbf kgf dyn Pa bar mbar psi "
    "ksi atm Hz J Nm kNm MNm mNm µNm Nmm Ncm rad deg degree ° º turn rpm % percent ppm g_0 g_n g0 standard_gravity "
    "K kelvin mK delta_degC delta_degF"
)
WORDS = (*_WORDS.split(), *_PREFIXED)
"""Units of one word in the patterns."""
COMPOUNDS = (
    *("m^2", "m^3", "m^4", "m^-1", "s^-1", "kg/m", "kg/m^2", "kg/m^3", "kg*m"),
    *("m/s", "m/s^2", "N/m", "N/m^2", "N/m^3", "N*m", "N*m^2", "rad/m", "rad/s", "K/m", "K^-1"),
)
"""Compound units; the patterns have each of their spellings with these words."""

_SIGN = "[-+−‐‑–]"
_TIMES = r"\s*[*x×·⋅∙•]\s*"
_TEN = rf"10(?:(?:\^|\*\*){_SIGN}?\d{{1,3}}|[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)"
_DIGITS = rf"(?:\d+(?:_\d+)*(?:\.\d*)?|\.\d+)(?:[eE]{_SIGN}?\d+)?"
_TIMES_PI = rf"(?:(?:{_TIMES}|\s*)(?:pi|π))?"
_NUMBER = rf"\s*{_SIGN}?(?:{_TEN}|{_DIGITS}(?:{_TIMES}{_TEN})?{_TIMES_PI}|pi|π)(?:\s*/\s*\d{{1,9}})?\s*"
_WORD = "[A-Za-zµμ°º%][A-Za-zµμ_]*"
_POWER = rf"(?:\s*(?:\^|\*\*)\s*\(?{_SIGN}?\d{{1,2}}\)?|{_SIGN}?[1-9]|[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+)"
_SEPARATOR = r"(?:\s*[*/·⋅∙•×.-]\s*|\s+)"
_FACTOR = rf"\(?{_WORD}{_POWER}?\)?"
_PUT_TOGETHER = rf"(?:(?:1\s*)?/\s*{_FACTOR}|{_WORD}{_POWER}|{_FACTOR}{_SEPARATOR}{_FACTOR})(?:{_SEPARATOR}{_FACTOR})*"
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@functools.cache
def accepted(unit: str) -> str:
    """The pattern of a text in a unit: a number, then a word of its dimension, or a compound unit."""
    words = "|".join(map(re.escape, _words(unit)))
    nothing = "|" if unit == "1" else ""
    return rf"^{_NUMBER}(?:{words}|{_PUT_TOGETHER}{nothing})\s*$"


@functools.cache
def refused(unit: str) -> str:
    """The pattern of texts in known compound units of another dimension."""
    others = [compound for compound in COMPOUNDS if not is_read_as(compound, unit)]
    return rf"^{_NUMBER}(?:{'|'.join(map(_spelled, others))})\s*$"


@functools.cache
def _words(unit: str) -> list[str]:
    """The known words of a dimension, the longest first."""
    return sorted((word for word in WORDS if is_read_as(word, unit)), key=len, reverse=True)


def _spelled(compound: str) -> str:
    """The pattern of every spelling of a compound unit: "kg/m^3" is also "g/cm³" and "kg m-3"."""
    pattern = ""
    for sign, word, power in re.findall(r"([*/]?)(\w+)(?:\^(-?\d))?", compound):
        alike = f"(?:{'|'.join(map(re.escape, _words(word)))})"
        exponent = int(power or 1)
        divided = rf"\s*/\s*{alike}{_raised(abs(exponent))}"
        times = _SEPARATOR.replace("/", "") + "?" if sign else ""
        multiplied = f"{times}{alike}{_raised(-exponent if sign == '/' else exponent)}"
        if sign == "/" or exponent < 0:
            one = "" if sign else r"(?:1\s*)?"
            pattern += f"(?:{one}{divided}|{multiplied})"
        else:
            pattern += multiplied
    return pattern


def _raised(exponent: int) -> str:
    if exponent == 1:
        return ""
    plain = str(exponent).replace("-", "[-−]")
    return rf"(?:\s*(?:\^|\*\*)?\s*\(?{plain}\)?|{str(exponent).translate(_SUPERSCRIPTS)})"
