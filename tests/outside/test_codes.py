"""The reference codes compared with textbooks.  Nothing here imports the package."""

import ast
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh

from . import closed, reissner, sides, timoshenko
from .reissner import CLAMP, FREE, Load, Rod
from .timoshenko import Piece

STIFF = Rod(1.0, 1.0, 1e9, 1e9)
CODES = ("closed", "published_energy", "reissner", "sides", "timoshenko")


@pytest.mark.parametrize("name", CODES)
def test_reference_codes_do_not_import_the_package(name):
    tree = ast.parse(Path(__file__).with_name(f"{name}.py").read_text())
    names = {a.name for n in ast.walk(tree) if isinstance(n, ast.Import) for a in n.names}
    names |= {n.module for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)}
    assert {n.split(".")[0] for n in names} <= {
        "collections",
        "dataclasses",
        "itertools",
        "numpy",
        "scipy",
        *CODES,
    }


@pytest.mark.parametrize(
    ("force", "sideways", "shortening"),
    [(1, 0.30172, 0.05643), (5, 0.71379, 0.38763), (10, 0.81061, 0.55500)],
)
def test_the_cantilever_agrees_with_published_tables(force, sideways, shortening):
    """Mattiasson (1981), five digits."""
    x, y = reissner.tip(STIFF, Load(CLAMP, FREE | {"Ny": force}), steps=5)
    assert (y, 1 - x) == pytest.approx((sideways, shortening), abs=6e-6)
    assert (x, y) == pytest.approx(reissner.elastica_tip(force), abs=1e-8)


def test_a_buckled_column_agrees_with_timoshenko_and_gere():
    """Theory of elastic stability, table of the elastica: at 60 degrees P/P_cr = 1.152, at 120 1.884."""
    for degrees, ratio, along, across in ((60, 1.152, 0.741, 0.593), (120, 1.884, 0.123, 0.803)):
        load = reissner.column_load(np.radians(degrees))
        assert load / (np.pi**2 / 4) == pytest.approx(ratio, abs=1e-3)
        state = reissner.column_beyond(STIFF, load, 1e-6)
        assert np.degrees(state[2, -1]) == pytest.approx(degrees, abs=1e-3)
        assert state[:2, -1] == pytest.approx([along, across], abs=1e-3)


def test_an_inextensible_chain_is_a_catenary_and_a_taut_one_a_parabola():
    H, first, last, shape = reissner.catenary(2 * np.sinh(1.0), 1.0, 1e9, 2.0, 0.0)
    assert (H, first, last) == pytest.approx((1.0, np.cosh(1.0), np.cosh(1.0)), rel=1e-8)
    assert shape(np.sinh(1.0))[1] == pytest.approx(1 - np.cosh(1.0), rel=1e-8)


def test_buckling_loads_are_eulers_and_greenhills():
    slender = Rod(1.0, 1.0, 1e12, 1e12)
    for ends, fraction in (("hinged-hinged", 1), ("clamped-free", 0.25), ("clamped-clamped", 4)):
        assert reissner.buckling_load(slender, ends) == pytest.approx(fraction * np.pi**2, rel=1e-10)
    assert reissner.buckling_load(slender, "clamped-hinged") / np.pi**2 == pytest.approx(
        2.0457, abs=5e-5
    )
    assert reissner.greenhill(slender) == pytest.approx(7.8373, abs=5e-5)


def test_the_buckling_load_with_shear_and_shortening_is_the_branching_load():
    """The boundary value problem by itself: its tip stays below the critical load and leaves above."""
    soft = Rod(1.0, 1.0, 200.0, 100.0)
    critical = reissner.buckling_load(soft, "clamped-free")
    for fraction, leaves in ((0.995, False), (1.01, True)):
        load = Load(CLAMP, FREE | {"Nx": -fraction * critical, "Ny": 1e-6})
        started = reissner.column_beyond(soft, fraction * critical, 1e-6) if leaves else None
        state = reissner.equilibrium(soft, load, steps=40) if started is None else started
        assert (state[1, -1] > 0.05) == leaves


def test_a_weightless_curved_strip_is_an_arc():
    x, y = reissner.tip(Rod(1.0, 1.0, 1e9, 1e9, np.pi), Load(CLAMP, FREE, py=-1e-9), steps=1)
    assert (x, y) == pytest.approx((0.0, 2 / np.pi), abs=1e-8)


def test_frequencies_agree_with_published_tables():
    """1.8751, 4.6941, 7.8548 squared; with a mass as heavy as the beam at its end 1.2479; stepwise the same."""
    beam = Piece(1.0, 1.0, 1e9, 1.0, 0.0)
    wave = np.sqrt(2 * np.pi * timoshenko.frequencies([beam], 3, start=0.5))
    assert wave == pytest.approx([1.875104, 4.694091, 7.854757], abs=1e-6)
    heavy = timoshenko.frequencies([beam], 1, tip_mass=1.0, start=0.3)
    assert np.sqrt(2 * np.pi * heavy) == pytest.approx([1.24792], abs=1e-5)
    cut = timoshenko.frequencies([beam.part(0.3), beam.part(0.7)], 3, start=0.5)
    assert np.sqrt(2 * np.pi * cut) == pytest.approx(wave, rel=1e-9)


def test_both_codes_give_timoshenkos_frequency_of_a_thick_hinged_beam():
    """Of sin(pi x): (m J / GA) w^4 - (m + (J + m EI / GA) pi^2) w^2 + EI pi^4 = 0; elements agree with the matrices."""
    beam = Piece(1.0, 1.0, 50.0, 1.0, 0.02)
    a, b, c = beam.m * beam.J / beam.GA, -(beam.m + (beam.J + beam.m / beam.GA) * np.pi**2), np.pi**4
    square = (-b - np.sqrt(b * b - 4 * a * c)) / (2 * a)
    K, M = timoshenko.elements(beam, 60)
    free = np.delete(np.arange(122), [0, 120])
    found = eigh(K[np.ix_(free, free)], M[np.ix_(free, free)], eigvals_only=True)[0]
    assert found == pytest.approx(square, rel=1e-4)
    exact = 2 * np.pi * timoshenko.frequencies([beam], 2, start=0.5)
    found = np.sqrt(eigh(K[2:, 2:], M[2:, 2:], eigvals_only=True)[:2])
    assert found == pytest.approx(exact, rel=1e-4)


def test_a_strip_that_is_shaken_slowly_follows_and_at_its_frequency_lags_a_quarter():
    beam = Piece(1.0, 1.0, 1e6, 1.0, 0.0)
    lowest = timoshenko.frequencies([beam], 1, start=0.5)[0]
    tip, force = timoshenko.shaken(beam, 1e-3 * lowest, 0.02)
    assert tip == pytest.approx(1.0, abs=1e-3)
    omega = 2e-3 * np.pi * lowest  # the mass is 1, of which the clamped end has no drag
    assert force.real == pytest.approx(-(omega**2), rel=0.05)
    assert force.imag == pytest.approx(0.04 * omega * 1e3 * omega, rel=0.05)
    # 1.5660 is the share of the first mode in a translation, at the tip of a cantilever
    assert abs(timoshenko.shaken(beam, lowest, 0.005)[0]) == pytest.approx(1.566 / 0.01, rel=1e-2)


def test_closed_forms_have_the_right_limits():
    assert closed.overhanging_tip(1.0, 1.0 - 1e-12, 1.0, 1.0, 1e9)[0] == pytest.approx(0, abs=1e-9)
    sag, left, right = closed.overhanging_tip(2.0, 1.0, 1.0, 1.0, np.inf)
    assert (left, right) == (0.0, 2.0)
    assert sag == pytest.approx(
        1 / 8 + 1 / 6 - 1 / 24
    )  # the part beyond as a cantilever; its hinge turns
    assert closed.toggle(1.0, 0.1, 1e-9, 1.0) == pytest.approx(1e-9 * np.sin(0.1) ** 2, rel=1e-6)
    peak = max(closed.toggle(1.0, 0.1, v, 1.0) for v in np.linspace(0, 0.1, 2001))
    assert closed.toggle_limit(1.0, 0.1, 1.0) == pytest.approx(peak, rel=1e-6)
    assert closed.toggle(1.0, 0.1, np.sin(0.1), 1.0) == pytest.approx(0, abs=1e-15)
    assert closed.struck_bar(1.0, 1.0, 1.0, 1.0, np.array([0, 1, 2, 3, 4, 6])) == pytest.approx(
        [0, 1, 2, 1, 0, 2]
    )
    assert closed.cantilever_tip(3.0, 1.0, lambda s: 1.0) == pytest.approx(1.0, rel=1e-12)
    # a wedge of height 1 - s / 2: integral of (1 - s)^2 / (1 - s/2)^3
    wedge = closed.cantilever_tip(1.0, 1.0, lambda s: (1 - s / 2) ** 3)
    assert wedge == pytest.approx(8 * (np.log(2) - 5 / 8), rel=1e-12)


def test_a_long_beam_on_a_foundation_is_hetenyis_and_balances_its_force():
    sag, moment = closed.rail(2.0, 4.0, 1.0, 1e12)  # b = 1
    assert sag == pytest.approx(2.0 / (2 * 4.0), rel=1e-9)
    assert moment(0.0) == pytest.approx(2.0 / 4, rel=1e-9)
    assert moment(np.pi / 4) == pytest.approx(0.0, abs=1e-9)
    soft, moment = closed.rail(
        2.0, 4.0, 1.0, 3.0
    )  # shear makes it softer; M' = -Q, half of the force on either side
    assert soft > sag
    assert (moment(1e-6) - moment(0.0)) / 1e-6 == pytest.approx(-1.0, rel=1e-5)


def test_a_simple_beam_under_a_force_and_a_line_load_balances():
    s = np.array([1e-12, 0.3, 0.7, 1.2, 2.0 - 1e-12])
    N, Q, M = closed.inner_forces(2.0, s, (0.5, -np.pi / 2, 4.0), (1.0, 2.0, 3.0))
    np.testing.assert_allclose(N, 0.0, atol=1e-12)
    np.testing.assert_allclose(
        Q, [-3.75, -3.75, 0.25, 0.85, 3.25], rtol=1e-9
    )  # reactions by moments about the ends
    assert M[[0, -1]] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert M[1] == pytest.approx(3.75 * 0.3)  # it sags


def test_a_shock_that_passes_once_is_the_impulse():
    """Before the wall answers u = c I / EA; long after, nothing is lost: the wall has given twice the impulse."""
    t = np.linspace(0, 3, 3001)
    tip, wall = closed.shocked_bar(1.0, 1.0, 2.0, 3.0, 0.5, t)
    whole = 3.0 * 2 / np.pi * 0.5
    assert tip[1500] == pytest.approx(whole / 2)
    assert np.trapezoid(wall[:1800], t[:1800]) == pytest.approx(2 * whole, rel=1e-5)


def test_a_table_of_sides_is_found_again():
    assert sides.column_beyond(sides.SLENDER, 1.5 * sides.EULER, 0.01)[:2, -1] == pytest.approx(
        sides.MULTIPLES[1.5], abs=2e-6
    )
    assert sides.ribbon(1e9, 0.1)[1, 200] == pytest.approx(sides.RIBBONS[1e9, 0.1], abs=2e-6)
