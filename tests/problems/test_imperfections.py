"""Imperfect columns against Perry and Robertson's amplification, with shear and shortening."""

import itertools

import numpy as np
import pytest

import cosserat
from cosserat.errors import InputError
from cosserat.rods.reference import normals

HINGES = [{"at": "first", "fixed": ["x3", "x2"]}, {"at": "last", "fixed": ["x2"]}]
LENGTH, SIDE, YOUNG = 1.0, 0.05, 1e7
EA, EI, GA = YOUNG * SIDE**2, YOUNG * SIDE**4 / 12, 5 / 6 * YOUNG / 2 * SIDE**2
EULER = np.pi**2 * EI / LENGTH**2
BOW = {"kind": "bow", "amplitude": 1e-5}


def column(vertices, imperfection, load=0.6 * EULER, **changes):
    rod = {
        "vertices": vertices,
        "section": {"height": SIDE, "width": SIDE},
        "material": {"young": YOUNG, "poisson": 0.0},
    }
    forces = [{"at": "last", "along": "-E3", "force": load}]
    return cosserat.case("elastica").vary(
        "column",
        **{"supports": HINGES, "forces": forces, "imperfection": imperfection, "rod": rod} | changes,
    )


def amplified(load):
    """Largest ordinate over that of the bow.  derived: with b = 1 - P/EA + P/GA, y' = b a for the angle a of a section,
    EI (a'' - a0'') = -P b a: a = a0 / (1 - P b / P_E)."""
    b = 1 - load / EA + load / GA
    return b / (1 - load * b / EULER)


@pytest.mark.parametrize("imperfection", [BOW, {"kind": "mode", "amplitude": 1e-5}])
@pytest.mark.parametrize("side", [1, -1])
def test_a_bowed_column_bends_as_perry_and_robertson_say(imperfection, side):
    """At 0.6 of Euler's load the bow is 2.5 times as large, and 0.4 % more for the shear."""
    assert 1e-3 < amplified(0.6 * EULER) / 2.5 - 1 < 1e-2
    errors = []
    for n in (11, 21, 41):
        given = imperfection | {"amplitude": 1e-5 * side}
        found = float(cosserat.run(column(n, given)).x.sel(axis="E2")[n // 2])
        errors.append(found / (1e-5 * side) - amplified(0.6 * EULER))
    orders = [np.log2(a / b) for a, b in itertools.pairwise(errors)]
    assert orders == pytest.approx([2, 2], abs=0.1)
    assert abs(errors[-1]) < 0.02


@pytest.mark.parametrize("energy", ["consistent", "published"])
def test_an_imperfect_rod_without_loads_is_at_rest(energy):
    bow = {"kind": "bow", "bow": "quarter cosine", "amplitude": 0.05}
    case = cosserat.case("clamped_free" if energy == "published" else "elastica")
    data = cosserat.run(case.vary("rest", gravity=None, forces=[], imperfection=bow))
    assert np.abs(data.u).max() < 1e-9
    assert float(data.x_ref[-1, 1]) == pytest.approx(0.05, rel=0.01)


@pytest.mark.parametrize(
    ("bow", "supports", "ends"),
    [
        ("full cosine", "clamps", (0, 0)),
        ("quarter cosine", "clamp", (0, 1)),
        ("half sine", "hinges", (1, 1)),
    ],
)
def test_bows_are_flat_at_clamps_and_of_their_amplitude(bow, supports, ends):
    problem = column(81, {"kind": "bow", "bow": bow, "amplitude": 0.01}).problem
    geometry = problem.geometry
    assert np.abs(geometry.X[:, 1]).max() == pytest.approx(0.01, rel=1e-3)
    np.testing.assert_allclose(geometry.edge_length, LENGTH / 80, rtol=1e-12)
    slopes = np.diff(geometry.X[:, 1])[[0, -1]] / geometry.edge_length[[0, -1]]
    assert (np.abs(slopes) > 0.01).tolist() == [bool(end) for end in ends]


def test_a_bow_of_half_a_ring_is_along_its_normal_and_keeps_its_length():
    """To first order in the amplitude, and to second order in the length of the edges."""
    arc = {"rest": {"kind": "arc", "curvature": np.pi}}
    case = column(81, {"kind": "bow", "amplitude": 1e-4}).vary("bent", rod=arc)
    perfect = case.problem.rod.geometry()
    moved = case.problem.geometry.X - perfect.X
    shape = 1e-4 * np.sin(np.pi * np.linspace(0, 1, 81))
    np.testing.assert_allclose((moved * normals(perfect.X)).sum(axis=1), shape, atol=1e-6)


def test_a_mode_of_a_curved_or_free_rod_keeps_its_ends_and_has_its_amplitude():
    """Between hinges the second mode has a node in the middle; along a normal that turns with the rod."""
    arc = {"rest": {"kind": "arc", "curvature": 0.5}, "vertices": 41}
    case = column(41, {"kind": "mode", "mode": 2, "amplitude": 1e-3})
    added = (case.problem.geometry.X - case.problem.rod.geometry().X)[:, 1]
    np.testing.assert_allclose(
        np.abs(added), 1e-3 * np.abs(np.sin(2 * np.pi * np.linspace(0, 1, 41))), atol=1e-5
    )
    bent = case.vary("bent", rod=arc).problem
    moved = bent.geometry.X - bent.rod.geometry().X
    assert np.abs((moved * normals(bent.rod.geometry().X)).sum(axis=1)).max() == pytest.approx(
        1e-3, rel=0.02
    )
    loose = cosserat.case("vibration_consistent").vary(
        "loose", supports=[], imperfection={"kind": "mode", "amplitude": 1e-3}
    )
    shape = loose.problem.geometry.X[:, 1]
    assert np.abs(shape).max() == pytest.approx(1e-3, rel=1e-3)
    assert (np.diff(np.sign(shape)) != 0).sum() == 2  # the two nodes of a free bar


@pytest.mark.parametrize(
    ("imperfection", "sentence"),
    [
        ({"kind": "bow", "amplitude": 1.0}, "'amplitude' = 1 m, with which it is steeper than"),
        ({"kind": "bow"}, "'imperfection.amplitude' is missing"),
        (
            {"kind": "bow", "bow": "sine", "amplitude": 1.0},
            "'imperfection.bow' is 'sine'; it must be 'half sine'",
        ),
        (
            {"kind": "mode", "mode": 0, "amplitude": 1.0},
            "'imperfection.mode' is 0; it must be at least 1",
        ),
        ({"kind": "mode", "mode": 500, "amplitude": 1.0}, "'mode' = 500, but the rod has fewer"),
        ({"kind": "mode", "mode": 4, "amplitude": 1e-3}, "does not move the rod along its normal"),
        ({"amplitude": "1 kg"}, "'imperfection.kind' is missing: write 'bow' or 'mode'"),
    ],
)
def test_an_imperfection_that_fits_no_rod_is_refused_in_one_sentence(imperfection, sentence):
    with pytest.raises(InputError, match=sentence):
        cosserat.run(column(11, imperfection))
