"""Numbers with units in many spellings: each has its meaning, or is refused with the reason."""

import contextlib
import math
from decimal import Decimal

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from pydantic_core import PydanticCustomError

from cosserat.units import to_si

# Conversions are typed from their definitions: 1 in = 0.0254 m, 1 lb = 0.45359237 kg, 1 g_0 = 9.80665 m/s^2.
LBF = 0.45359237 * 9.80665
READ = {
    "N*m": {
        "0.2 Nm": 0.2, "5 kNm": 5e3, "5 Nmm": 5e-3, "5 Ncm": 5e-2, "3 mNm": 3e-3, "4 MNm": 4e6, "2 µNm": 2e-6,
        "2 N.m": 2, "2 N-m": 2, "2 N·m": 2, "2 N⋅mm": 2e-3, "2 N×m": 2, "1 N m": 1, "40 MN*m": 4e7, "2 J": 2,
        "2 kg m2 s-2": 2, "2 kg·m²/s²": 2, "1 kgf.m": 9.80665, "1 ft*lbf": 0.3048 * LBF, "1 N*mm": 1e-3,
    },
    "Pa": {
        "1 N/mm²": 1e6, "1 N/mm2": 1e6, "1 N/mm^2": 1e6, "1 N/mm**2": 1e6, "2 N mm-2": 2e6, "2 N.mm-2": 2e6,
        "2 N·mm⁻²": 2e6, "1 kN/cm²": 1e7, "1 MPa": 1e6, "1MPa": 1e6, "1_000 MPa": 1e9, "10^9 Pa": 1e9, "10**9 Pa": 1e9,
        "10⁹ Pa": 1e9, "1.0×10^9 Pa": 1e9, "1.0 x 10^9 Pa": 1e9, "1.5*10^9 Pa": 1.5e9, "1.5·10⁻³ Pa": 1.5e-3,
        "1e9 Pa": 1e9, "1E9Pa": 1e9, "2 × 10^3 kPa": 2e6, "1 psi": LBF / 0.0254**2, "1 bar": 1e5, "0.24 kPa": 240,
        "1 J/m³": 1, "1\u00a0GPa": 1e9, "1\u202fGPa": 1e9, "-10^3 Pa": -1e3, "\u22122 kPa": -2e3, "\u20132 kPa": -2e3,
    },
    "m/s^2": {
        "9.81 m/s²": 9.81, "9.81 m/s2": 9.81, "9.81 m/s^2": 9.81, "9.81 m s-2": 9.81, "9.81 m·s⁻²": 9.81,
        "9.81 m.s-2": 9.81, "9.81 m/s/s": 9.81, "9.81 m/(s^2)": 9.81, "9.81 N/kg": 9.81, "1 g_0": 9.80665,
        "1 g_n": 9.80665, "1 g0": 9.80665, "2 standard_gravity": 2 * 9.80665,
    },
    "N": {
        "5 kg·m/s²": 5, "5 kg m s-2": 5, "5 kg*m/s^2": 5, "5 kN": 5e3, "5 mN": 5e-3, "1 kgf": 9.80665, "1 lbf": LBF,
        "26.16 mN": 26.16e-3,
    },
    "m": {
        "5 μm": 5e-6, "5 µm": 5e-6, "5 um": 5e-6, "5 mm": 5e-3, "5 nm": 5e-9, "1 in": 0.0254, "1/2 in": 0.0127,
        "2 ft": 0.6096, "1e-3m": 1e-3, " 5  m ": 5, ".5 m": 0.5, "5. m": 5, "+5 m": 5,
    },
    "m^-1": {
        "1/m": 1, "1 1/m": 1, "2 /m": 2, "0.001/mm": 1, "1 1/mm": 1e3, "2/3 1/m": 2 / 3, "1 m^-1": 1, "1 m-1": 1,
        "1 m⁻¹": 1, "1 m^(-1)": 1, "5 rad/m": 5, "90 deg/m": math.pi / 2,
    },
    "rad": {
        "30º": math.pi / 6, "30°": math.pi / 6, "30 deg": math.pi / 6, "200 deg": math.pi / 0.9,
        "pi/6 rad": math.pi / 6,
        "π/6 rad": math.pi / 6, "pi rad": math.pi, "2 pi rad": 2 * math.pi, "2*pi/3 rad": 2 * math.pi / 3,
        "-pi/2 rad": -math.pi / 2, "0.5 turn": math.pi, "30 mrad": 0.03,
    },
    "rad/s": {
        "20 rad/s": 20, "20 rad s-1": 20, "90 deg/s": math.pi / 2, "90°/s": math.pi / 2, "60 rpm": 2 * math.pi,
    },
    "Hz": {"20 Hz": 20, "20 1/s": 20, "20/s": 20, "20 s-1": 20, "2 kHz": 2e3},
    "1": {"0.3": 0.3, "5/6": 5 / 6, "4%": 0.04, "4 %": 0.04, "10^-3": 1e-3, "1_000": 1e3, "1 mm/m": 1e-3},
    "kg/m": {"10 kg/m": 10, "10 kg m-1": 10, "10 g/cm": 1, "1 lb/ft": 0.45359237 / 0.3048},
    "N/m": {"10 N/m": 10, "10 N m-1": 10, "10 kN/m": 1e4, "10 N/mm": 1e4, "1 lbf/ft": LBF / 0.3048},
    "kg/m^3": {"1 g/cm³": 1e3, "1 g/cm^3": 1e3, "7850 kg/m³": 7850, "7850 kg/m3": 7850, "7850 kg m-3": 7850},
    "s": {"1 ms": 1e-3, "2 min": 120, "1 sec": 1},
    "kg": {"10 g": 0.01, "1 lb": 0.45359237, "1 t": 1e3},
}  # fmt: skip

REFUSED = [
    ("Pa", "1,0 GPa", "with a decimal comma; write a decimal point"),
    ("Pa", "1,000 Pa", "with a decimal comma"),
    ("1", "0,3", "with a decimal comma"),
    ("Pa", "1 000 MPa", "with a blank inside the number; write 1000 or 1_000"),
    ("m", "1 1/2 in", "with a blank inside the number"),
    ("m", "2 10^3 m", "with a blank inside the number"),
    ("Pa", "1 Gpa", "whose unit is not known; did you mean 'GPa'?"),
    ("Pa", "1 mpa", "whose unit is not known; did you mean 'MPa' or 'mPa'?"),
    ("Pa", "5 pa", "in pa, a time and not a pressure; did you mean 'Pa'?"),
    ("N", "5 KN", "whose unit is not known; did you mean 'kN'?"),
    ("N", "5 kn", "in kn, a speed and not a force; did you mean 'kN'?"),
    ("N", "5 lb", "in lb, a mass and not a force; write it with its unit, such as \"2.5 N\""),
    ("N", "5 g", "in g, a mass and not a force"),
    ("N", "5 kg", "in kg, a mass and not a force"),
    ("N", "5 Nm", "in Nm, a moment and not a force"),
    ("N*m", "3 mN", "in mN, a force and not a moment"),
    ("N*m", "5 nm", "in nm, a length and not a moment"),
    ("N*m", "1 lb ft", "in lb ft; write it with its unit, such as \"2.5 N*m\""),
    ("m/s^2", "1 g", "in g, a mass and not an acceleration"),
    ("N/m", "10 lb/ft", "in lb/ft, a mass per length and not a force per length"),
    ("N/m", "10 Nm", "in Nm, a moment and not a force per length"),
    ("kg/m", "10 kg/m^3", "in kg/m^3, a density and not a mass per length"),
    ("m", "5 Nm", "in Nm, a moment and not a length; write it"),
    ("m", "5 M", "in M; did you mean 'm'?"),
    ("m", "5 m m", "in m m, an area and not a length"),
    ("m", "5", "in no unit at all; write it with its unit"),
    ("rad", "5", "in no unit at all"),
    ("rad", "pi/6", "in no unit at all"),
    ("rad", "5 %", "in %, a ratio and not an angle"),
    ("1", "0.3 rad", "in rad, an angle and not a ratio"),
    ("1", "5 dB", "in dB, whose zero is not zero"),
    ("1", "0 Np", "in Np, whose zero is not zero"),
    ("Hz", "20 rad/s", "in rad/s, an angular speed and not a frequency"),
    ("Hz", "60 rpm", "in rpm, an angular speed and not a frequency"),
    ("rad/s", "20 Hz", "in Hz, a frequency and not an angular speed"),
    ("rad/s", "20 s-1", "in s-1, a frequency and not an angular speed"),
    ("m", '0.34"', "whose unit is not known"),
    ("m", "5 m*1000", "whose unit is not known"),
    ("m", "5 m 3", "whose unit is not known"),
    ("m", "1 m^(9^9^9^9)", "whose unit is not known"),
    ("m", "1 m^9^9^9^9", "whose unit is not known"),
    ("m", "9**9**9**9 m", "which is not a number with a unit"),
    ("m", "5\u20136 mm", "which is not a number with a unit"),
    ("m", "m", "which is not a number with a unit"),
    ("m", "", "which is not a number with a unit"),
    ("m", "1/0 m", "which is not a number with a unit"),
    ("m", "1/" + "9" * 5000 + " m", "..."),
    ("m", "x" * 5000, 'xxx...", a text of 5000 characters'),
    ("m", "9" * 5000 + " m", "a text of 5002 characters"),
    ("m", "1e400 m", "it must be a finite number"),
]  # fmt: skip


@pytest.mark.parametrize("unit", READ)
def test_each_spelling_of_a_unit_has_its_meaning(unit):
    for text, value in READ[unit].items():
        assert to_si(text, unit, unit_required=True) == pytest.approx(value, rel=1e-14), text


@pytest.mark.parametrize("unit", READ)
def test_a_quantity_of_another_dimension_is_refused(unit):
    for other, texts in READ.items():
        for text in texts:
            if other != unit:
                with pytest.raises(PydanticCustomError):
                    to_si(text, unit, unit_required=True)


@pytest.mark.parametrize(("unit", "text", "why"), REFUSED, ids=[text[:20] for _, text, _ in REFUSED])
def test_bad_quantities_are_refused_with_the_reason(unit, text, why):
    with pytest.raises(PydanticCustomError) as caught:
        to_si(text, unit, unit_required=True)
    sentence = str(caught.value)
    assert why in sentence or (why == "..." and len(sentence) < 200)
    assert len(sentence) < 250
    assert "\n" not in sentence


@given(st.text("0123456789.,_eE+-*/^x ()kMmNPapsigrdµμ²⁻·×°º%", max_size=14))
def test_any_text_gives_a_number_or_an_error_sentence(text):
    for unit in ("Pa", "m^-1", "1"):
        with contextlib.suppress(PydanticCustomError):  # no error of another kind
            assert math.isfinite(to_si(text, unit, unit_required=True))


@pytest.mark.parametrize(
    ("written", "unit", "power"),
    [
        ("mm", "m", -3),
        ("cm", "m", -2),
        ("µm", "m", -6),
        ("km", "m", 3),
        ("MPa", "Pa", 6),
        ("GPa", "Pa", 9),
        ("N/mm^2", "Pa", 6),
        ("mN", "N", -3),
        ("N*mm", "N*m", -3),
        ("g", "kg", -3),
        ("%", "1", -2),
        ("ms", "s", -3),
        ("mm^2", "m^2", -6),
    ],
)
def test_a_decimal_number_in_a_decimal_unit_is_the_nearest_float(written, unit, power):
    """The right one is Python's own reading of the number with the power of ten behind it."""
    for number in (*range(1, 300), 0.1, 0.7, 2.4, 7.3, 1.27, 12.345678901234567, 1e-5, 8.1e7):
        found = to_si(f"{number} {written}", unit, unit_required=True)
        assert found == float(f"{Decimal(repr(number)):f}e{power}"), number


def test_an_array_without_dimensions_is_its_number_in_the_unit_that_it_carries():
    """As a value that somebody takes from a result."""
    length = xr.DataArray(np.array([0.4, 0.5]), dims="vertex", attrs={"units": "m"})
    for value, read in (
        (length[1], 0.5),
        (length[1].assign_attrs(units="mm"), 0.5e-3),
        (length[1].assign_attrs(units="1"), 0.5),
        (length[1].drop_attrs(), 0.5),
        (np.array(0.5), 0.5),
        (np.array("5 mm"), 5e-3),
        (np.float32(0.5), 0.5),
    ):
        assert to_si(value, "m", unit_required=False) == read
    refused = ((length[1].assign_attrs(units="kg"), "a mass and not a length"), (length, "not a number"),
               (np.array(True), "is True, not a number"), (np.array(None), "not a number"))  # fmt: skip
    for value, said in refused:
        with pytest.raises(PydanticCustomError, match=said):
            to_si(value, "m", unit_required=False)
