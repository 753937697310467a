"""Sine, cosine, tangent and arctangent from additions, products and quotients alone, with the same bits everywhere.

Libraries of mathematics differ in the last bit, from one version or processor to the next.  These functions compute in
pairs of floats, sums that are not rounded, and round once at the end.  So what they return is the float nearest to the
exact number, unless that is half-way between two floats to some 30 digits.  They are for code that runs without a
library, see `cosserat.export.webassembly.compiled`; nothing else of the package calls them.

derived: let s, c be the sine and the cosine of any z near the angle of (x, y).  That angle is z + atan(t), where
t = (y c - x s) / (x c + y s) is so small that two terms of the series are enough.
"""

from __future__ import annotations

from fractions import Fraction
from math import factorial

import numpy as np
from numba import njit

Pair = tuple[float, float]

_SPLITTER = 2.0**27 + 1
_QUARTERS_PER_RADIAN = 2 / np.pi
_HALF_PI = tuple(
    float.fromhex(part)
    for part in ("0x1.921fb54p+0", "0x1.10b46118p-30", "0x1.313198a2e037p-61", "0x1.cd129024e088ap-115")
)
"""pi / 2 in parts: products of the first two with a whole number below 2^20 are exact."""
_ARCTANGENT = (0.999866, -0.3302995, 0.180141, -0.085133, 0.0208351)
"""A polynomial for atan on [0, 1] in odd powers; the last step removes its error of 1e-5."""
_MOST = 30  # highest power in the series of sine and cosine, up to pi / 4
_PLAIN = 14  # power from which on terms are so small that one float each is enough


def _pair(exact: Fraction) -> Pair:
    """The nearest float and the nearest one to what is left."""
    high = float(exact)
    return high, float(exact - Fraction(high))


_COEFFICIENTS = tuple(_pair(Fraction((-1) ** (n // 2), factorial(n))) for n in range(_MOST + 1))
"""Of x^n in the series of the cosine where n is even, of the sine where it is odd."""


@njit(error_model="numpy")
def _sum(a: float, b: float) -> Pair:
    """A sum and its rounding error."""
    s = a + b
    part = s - a
    return s, (a - (s - part)) + (b - part)


@njit(error_model="numpy")
def _product(a: float, b: float) -> Pair:
    """A product and its rounding error."""
    p = a * b
    wide = _SPLITTER * a
    high = wide - (wide - a)
    low = a - high
    wide = _SPLITTER * b
    top = wide - (wide - b)
    rest = b - top
    return p, ((high * top - p) + high * rest + low * top) + low * rest


@njit(error_model="numpy")
def _added(a: Pair, b: Pair) -> Pair:
    """The sum of two pairs."""
    s, e = _sum(a[0], b[0])
    t, f = _sum(a[1], b[1])
    s, e = _sum(s, e + t)
    return _sum(s, e + f)


@njit(error_model="numpy")
def _times(a: Pair, b: Pair) -> Pair:
    """The product of two pairs."""
    p, e = _product(a[0], b[0])
    return _sum(p, e + (a[0] * b[1] + a[1] * b[0]))


@njit(error_model="numpy")
def _ratio(a: Pair, b: Pair) -> Pair:
    """The quotient of two pairs."""
    ratio = a[0] / b[0]
    product, error = _product(ratio, b[0])
    return ratio, ((a[0] - product) - error + a[1] - ratio * b[1]) / b[0]


@njit(error_model="numpy")
def _series(square: Pair, first: int) -> Pair:
    """The sum of the terms n = first, first + 2, ... of the series, over x^first."""
    tail = _COEFFICIENTS[_MOST + first % 2 - 2 * (first % 2)][0]
    for n in range(_MOST + first % 2 - 2 * (first % 2) - 2, _PLAIN + first % 2 - 2, -2):
        tail = tail * square[0] + _COEFFICIENTS[n][0]
    total = tail, 0.0
    for n in range(_PLAIN + first % 2 - 2, first - 2, -2):
        total = _added(_times(total, square), _COEFFICIENTS[n])
    return total


@njit(error_model="numpy")
def _sine_and_cosine(x: float) -> tuple[Pair, Pair]:
    """Both as pairs; |x| is below a million."""
    quarters = np.floor(x * _QUARTERS_PER_RADIAN + 0.5)
    p0, p1, p2, p3 = _HALF_PI
    near = _added(_sum(x - quarters * p0, -quarters * p1), _product(-quarters, p2))
    near = _added(near, (-quarters * p3, 0.0))
    square = _times(near, near)
    sine, cosine = _times(near, _series(square, 1)), _series(square, 0)
    turn = quarters - 4 * np.floor(quarters / 4)
    if turn % 2 == 1.0:
        sine, cosine = cosine, (-sine[0], -sine[1])
    if turn >= 2.0:
        sine, cosine = (-sine[0], -sine[1]), (-cosine[0], -cosine[1])
    return sine, cosine


@njit(error_model="numpy")
def sin(x: float) -> float:
    """The sine; |x| is below a million."""
    if abs(x) < 1e-8:  # of numbers so small that the next digits of the series vanish
        return x - x * x * x / 6
    return _sine_and_cosine(x)[0][0]


@njit(error_model="numpy")
def cos(x: float) -> float:
    """The cosine; |x| is below a million."""
    return _sine_and_cosine(x)[1][0]


@njit(error_model="numpy")
def tan(x: float) -> float:
    """The tangent; |x| is below a million."""
    if abs(x) < 1e-8:
        return x + x * x * x / 3
    ratio, rest = _ratio(*_sine_and_cosine(x))
    return ratio + rest


@njit(error_model="numpy")
def atan2(y: float, x: float) -> float:
    """The angle of (x, y) in [-pi, pi]; each is zero or between 1e-140 and 1e140 in size."""
    wide, high = abs(x), abs(y)
    if high < 1e-20 * wide and x > 0:
        return y / x
    most, least = max(wide, high), min(wide, high)
    ratio = least / most if most > 0.0 else 0.0
    square, z = ratio * ratio, 0.0
    for n in range(len(_ARCTANGENT) - 1, -1, -1):
        z = z * square + _ARCTANGENT[n]
    z *= ratio
    if high > wide:
        z = np.pi / 2 - z
    if x < 0:
        z = np.pi - z
    z = np.copysign(z, y)
    sine, cosine = _sine_and_cosine(z)
    across = _added(_times((y, 0.0), cosine), _times((-x, 0.0), sine))
    along = _added(_times((x, 0.0), cosine), _times((y, 0.0), sine))
    t, rest = _ratio(across, along) if along[0] > 0.0 else (0.0, 0.0)
    angle, error = _sum(z, t)
    return angle + (error + rest - t * t * t / 3 + t * t * t * t * t / 5)
