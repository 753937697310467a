"""Numbers with units as people write them, read by pint: "2.5 mm", "1_000 MPa", "10^9 N/mm²", "5 Nm", "9.81 m s-2"."""

from __future__ import annotations

import decimal
import functools
import math
import numbers
import re
from typing import TYPE_CHECKING, Any

from pydantic_core import PydanticCustomError

from cosserat.text import shortened, shown
from cosserat.threads import UNITS

if TYPE_CHECKING:
    import pint

_KINDS = {
    "1": ("a ratio", 1e-12, 1e12),
    "%": ("a percentage", 1e-12, 1e12),
    "m": ("a length", 1e-12, 1e9),
    "m^2": ("an area", 1e-24, 1e18),
    "m^3": ("a volume", 1e-36, 1e27),
    "m^4": ("a second moment of area", 1e-48, 1e36),
    "m^-1": ("a curvature", 1e-12, 1e12),
    "kg": ("a mass", 1e-30, 1e24),
    "kg*m^2": ("a moment of inertia", 1e-48, 1e36),
    "kg/m": ("a mass per length", 1e-24, 1e18),
    "kg/m^3": ("a density", 1e-9, 1e12),
    "s": ("a time", 1e-15, 1e12),
    "Hz": ("a frequency", 1e-12, 1e15),
    "1/s": ("a rate", 1e-12, 1e15),
    "m/s": ("a speed", 1e-12, 1e9),
    "m/s^2": ("an acceleration", 1e-12, 1e12),
    "N": ("a force", 1e-24, 1e24),
    "N/m": ("a force per length", 1e-24, 1e24),
    "N*m": ("a moment", 1e-24, 1e24),
    "N*m^2": ("a bending stiffness", 1e-36, 1e36),
    "N*m/rad": ("a rotational stiffness", 1e-24, 1e24),
    "N*m/rad/m": ("a rotational stiffness per length", 1e-24, 1e24),
    "Pa": ("a pressure", 1e-6, 1e15),
    "K": ("a temperature difference", 1e-12, 1e6),
    "K/m": ("a temperature gradient", 1e-12, 1e12),
    "K^-1": ("a thermal expansion", 1e-12, 1e3),
    "rad": ("an angle", 1e-12, 1e6),
    "rad/s": ("an angular speed", 1e-12, 1e12),
}
"""The quantity of a unit in words, and the least size above zero and the largest size that make sense.

The sizes are wide, from atoms to planets, but such that products and ratios of them are far from overflow and
underflow.  Units not listed are named by themselves.
"""
_ANY = ("a quantity", 1e-24, 1e24)
NOTHING = 1e-40
"""Numbers nearer to zero than this are refused where zero is meant: their powers would underflow."""


def what_is_in(unit: str) -> str:
    """The quantity of a unit in words, such as "a length"; "a quantity" for units not listed."""
    return _KINDS.get(unit, _ANY)[0]


def sizes_in(unit: str) -> tuple[float, float]:
    """The least size above zero and the largest size of a quantity that make sense in this unit."""
    return _KINDS.get(unit, _ANY)[1:]


_ALIKE = {"m^-1": "rad/m", "N*m/rad": "N*m", "N*m/rad/m": "N"}
"""Units accepted for another unit.  Elsewhere an angle is no number, although pint counts it as one."""

_PREFIXES = ("", "k", "M", "G", "m", "c", "µ", "n")
_CHARACTERS = str.maketrans(
    {**dict.fromkeys("·⋅∙•×", "*"), **dict.fromkeys("−‐‑–", "-"), "μ": "µ", "º": "°", "π": "pi"}
    | dict.fromkeys("\u00a0\u2007\u2009\u202f", " ")
)
_SUPERSCRIPTS = str.maketrans("⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "+-0123456789")
_NUMBER = re.compile(
    r"\s*(?P<number>[+-]?(?:\d+(?:_\d+)*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?:nan|inf)\b|[+-]?(?=pi\b))"
    r"(?:\s*\*?\s*(?P<pi>pi)\b)?(?:\s*/\s*(?P<divisor>\d{1,9}))?"
)
_BEGINS_A_UNIT = re.compile(r"[^\W\d]|[%°(/\"']|1\s*/|$")
LONGEST_TEXT = 100
"""Most characters of a number with its unit."""
_EXACT = decimal.Context(LONGEST_TEXT, Emin=decimal.MIN_EMIN, Emax=decimal.MAX_EMAX, traps=[])
_ROUNDING = 1e-14  # of a factor that a library computes
_UNIT = re.compile(r"(?:1 */)?(?:[^\W\d]\w*|[%°()*/ ]|\^ *\(?[+-]?\d{1,2}\)?(?! *\^))*")


@functools.cache
def _units() -> pint.UnitRegistry[float]:
    import pint  # takes 0.4 s: only to read a text with a unit

    return pint.UnitRegistry()


def to_si(value: object, unit: str, *, unit_required: bool) -> float:
    """Read one value as a number in the SI unit `unit`: a number, or a text such as "2.5 mm", "1e3 kg/m" or "5/6".

    An array without dimensions is its number, in the unit that it carries, as results of xarray do.
    `cosserat.quantities.Quantity` also checks its range.

    Raises
    ------
    PydanticCustomError : not a number, not finite, or of another dimension than `unit`.
    """
    if getattr(value, "ndim", None) == 0:
        value = _out_of_array(value)
    if isinstance(value, str):
        number = _read_text(value, unit)
    elif isinstance(value, bool) or not isinstance(value, numbers.Real | decimal.Decimal):
        raise PydanticCustomError("type", f"is {shown(value)}, not a number; {how_to_write(unit)}")
    elif unit_required and unit != "1":
        raise PydanticCustomError("unit", f"is {shown(value)}, without a unit; {how_to_write(unit)}")
    else:
        number = _as_float(value)
    if not math.isfinite(number):
        raise PydanticCustomError("finite", f"is {shown(value)}; it must be a finite number")
    return number


def _out_of_array(value: Any) -> object:
    """The number of an array without dimensions; a text if it carries a unit."""
    number, unit = value.item(), getattr(value, "attrs", {}).get("units", "1")
    return number if unit == "1" else f"{number!r} {unit}"


def _as_float(number: numbers.Real | decimal.Decimal) -> float:
    """A number as a float; infinite if it is larger than any."""
    try:
        return float(number)
    except OverflowError:
        return math.inf
    except ValueError:  # a Decimal that signals that it is no number
        return math.nan


def how_to_write(unit: str) -> str:
    """The remedy for a value that cannot be read."""
    if unit == "1":
        return "write a number, such as 0.3"
    return f'write it with its unit, such as "2.5 {unit}"'


def _read_text(text: str, unit: str) -> float:
    def refused(kind: str, why: str, remedy: str = "") -> PydanticCustomError:
        return PydanticCustomError(
            kind, f'is "{shortened(text)}", {why}; {remedy or how_to_write(unit)}'
        )

    if len(text) > LONGEST_TEXT:
        raise refused("type", f"a text of {len(text)} characters")
    if "," in text:
        raise refused(
            "type", "with a decimal comma", "write a decimal point, and between thousands nothing"
        )
    plain = _in_plain_characters(text)
    found = _NUMBER.match(plain)
    rest = plain[found.end() :].strip() if found else ""
    if found and re.match(r"\d(?!\s*/\s*\D)", rest):
        raise refused("type", "with a blank inside the number", "write 1000 or 1_000")
    if found is None or not _BEGINS_A_UNIT.match(rest) or not int(found["divisor"] or 1):
        raise refused("type", "which is not a number with a unit")
    sign_or_number = found["number"] if found["number"].strip("+-") else f"{found['number']}1"
    root = _written_root(rest)
    if root is None:
        raise refused("type", "whose unit is not known", _meant(rest, unit))
    said = f"in {shortened(rest, 40)}"
    if not _alike(root, unit):
        why = f"{said}{_instead(root, unit)}" if rest else "in no unit at all"
        raise refused("unit", why, _meant(_as_pint_writes(rest), unit))
    zero, factor = _zero_and_one(rest, unit)
    if zero:
        raise refused("unit", f"{said}, whose zero is not zero {unit}")
    if found["pi"] or found["divisor"]:
        number = float(sign_or_number) * (math.pi if found["pi"] else 1) / int(found["divisor"] or 1)
        return number * factor
    return _times(sign_or_number, factor)


def _times(number: str, factor: float) -> float:
    """A written number times a factor; if that is a power of ten, the float nearest to it, so that 9 mm are 0.009 m."""
    power = round(math.log10(factor))
    moved = _EXACT.scaleb(_EXACT.create_decimal(number), power)
    if abs(factor / 10.0**power - 1) < _ROUNDING and moved.is_finite():
        return float(moved)
    return float(number) * factor


@functools.lru_cache(1000)
def _zero_and_one(written: str, unit: str) -> tuple[float, float]:
    """What 0 and 1 of a unit as written are in another unit."""
    given, wanted = _as_pint_writes(written), "" if unit == "1" else unit
    with UNITS:
        made = _units().Quantity
        zero, one = (float(made(value, given).to(wanted).magnitude) for value in (0.0, 1.0))
    return zero, one


def is_read_as(written: str, unit: str) -> bool:
    """Whether a number in a unit as written is accepted for a key in `unit`."""
    root = _written_root(written)
    return root is not None and _alike(root, unit)


@functools.lru_cache(1000)
def _written_root(written: str) -> object:
    """The root units of a unit as written; None if it is not known."""
    try:
        return _root(_as_pint_writes(_in_plain_characters(written)))
    except Exception:  # the unit parser raises errors of many kinds on text that is no unit
        return None


def _alike(root: object, unit: str) -> bool:
    """Whether a unit with root units `root` is accepted for `unit`."""
    return root in (
        _root("" if unit == "1" else unit),
        _root(_ALIKE.get(unit, "" if unit == "1" else unit)),
    )


def _in_plain_characters(text: str) -> str:
    """The text with '*', '^', '-', blanks and powers of ten as a program writes them."""
    text = re.sub(r"[⁺⁻]?[⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda m: "^" + m[0].translate(_SUPERSCRIPTS), text)
    text = text.translate(_CHARACTERS).replace("**", "^")
    ten = r"(?:(?<=[\d.])(\s*[*x]\s*)|(?<![\w.^]))10\^([+-]?\d{1,3})(?!\d)"
    return re.sub(ten, lambda m: ("e" if m[1] else "1e") + m[2], text)


def _as_pint_writes(unit: str) -> str:
    """'Nm', 'N.m' and 'N-m' as N*m, 'm s-2' and 'm/s2' with '^', '/m' as 1/m.

    Raises
    ------
    ValueError : it holds a number that is no exponent, which no unit does, or powers of powers.
    """
    unit = re.sub(r"\b([a-zA-Zµ]?N)(mm|cm|m)\b", r"\1*\2", unit)  # pint's Nm numbers yarn
    unit = re.sub(r"(?<=[\w)])\.(?=[^\W\d])|(?<=[^\W\d])-(?=[^\W\d])", "*", unit)
    unit = re.sub(r"(?<=[^\W\d_])([+-]?[1-9])(?!\w)", r"^\1", unit)
    unit = f"1{unit}" if unit.startswith("/") else unit
    if not _UNIT.fullmatch(unit):
        raise ValueError(unit)
    return unit


@functools.cache
def _root(unit: Any) -> object:
    """A unit in pint's root units; the radian is one of them."""
    with UNITS:
        return _units().Quantity(1.0, unit).to_root_units().units


def _instead(root: object, unit: str) -> str:
    """The given and the wanted quantity, if both have words."""
    given = [what_is_in(known) for known in _KINDS if _root("" if known == "1" else known) == root]
    return f", {given[0]} and not {what_is_in(unit)}" if given and unit in _KINDS else ""


def _meant(written: str, unit: str) -> str:
    """A question for a spelling that is wrong only in its capitals."""
    likely = [prefix + unit for prefix in _PREFIXES if (prefix + unit).casefold() == written.casefold()]
    return f"did you mean {' or '.join(map(repr, likely))}?" if likely else ""
