"""Imperfect columns against Perry and Robertson's amplification, with shear and shortening."""

import itertools
from typing import get_args

import numpy as np
import pytest

import cosserat
from cosserat.errors import InputError
from cosserat.rods.imperfections import LoadKey
from cosserat.rods.problem import CONSTRAINTS, LOADS
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


def amplified(load, euler=EULER):
    """Largest ordinate over that of the bow.  derived: with b = 1 - P/EA + P/GA, y' = b a for the angle a of a section,
    EI (a'' - a0'') = -P b a: a = a0 / (1 - P b / P_E)."""
    b = 1 - load / EA + load / GA
    return b / (1 - load * b / euler)


BUCKLING = {"kind": "buckling mode", "amplitude": 1e-5}


@pytest.mark.parametrize("imperfection", [BOW, {"kind": "mode", "amplitude": 1e-5}, BUCKLING])
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


CLAMP = {"at": "first", "fixed": "clamped"}
CLAMPS = [CLAMP, {"at": "last", "fixed": "clamped"}]


@pytest.mark.parametrize("share", [0.3, 0.8])
def test_the_tip_of_a_cantilever_with_its_buckling_mode_is_amplified(share):
    """The shape is 1 - cos(pi s / 2), and the critical load a quarter of Euler's; a load of another size has it too."""
    load, errors = share * EULER / 4, []
    for n in (11, 21, 41):
        data = cosserat.run(column(n, BUCKLING, load, supports=[CLAMP]))
        errors.append(float(data.x[-1, 1]) / 1e-5 / amplified(load, EULER / 4) - 1)
        shape = 1e-5 * (1 - np.cos(np.pi / 2 * data.xi))
        np.testing.assert_allclose(data.x_ref[:, 1], shape, atol=3e-7 * (10 / (n - 1)) ** 2)
    orders = [np.log2(a / b) for a, b in itertools.pairwise(errors)]
    assert orders == pytest.approx([2, 2], abs=0.1)
    assert abs(errors[-1]) < 1.5e-3


@pytest.mark.parametrize(
    "changes",
    [
        {"forces": [{"at": "last", "along": "-E3", "force": 1.0}], "supports": HINGES},
        {"forces": [{"at": "last", "along": "-E3", "force": 1.0}], "mode": 2, "supports": HINGES},
        {
            "prescribed_displacements": [{"at": "last", "dof": "x3", "by": -1e-3}],
            "supports": [HINGES[0], {"at": "last", "fixed": "pinned"}],
        },
        {"temperatures": [{"change": 1.0, "expansion": 1e-5}], "supports": CLAMPS},
        {"temperatures": [{"change": 1.0, "expansion": 1e-5}], "supports": CLAMPS, "pulled": 1.0},
    ],
)
def test_the_shape_is_that_in_which_the_loads_make_the_rod_buckle(changes):
    """Half a wave or a whole one between hinges, a cosine between clamps; a load that is not named does not count."""
    number, pulled = changes.get("mode", 1), changes.get("pulled")
    given = {"forces": []} | {
        key: value for key, value in changes.items() if key not in ("mode", "pulled")
    }
    chosen = BUCKLING | {"mode": number, "amplitude": 1e-3}
    if pulled:
        given["forces"] = [{"at": "50 %", "along": "E3", "force": 1e3}]
        chosen["loads"] = ["temperatures"]
    found = column(41, chosen, **given).problem.geometry.X
    s = np.linspace(0, 1, 41)
    cosine = (1 - np.cos(2 * np.pi * s)) / 2
    right = cosine if "temperatures" in given else np.sin(number * np.pi * s)
    np.testing.assert_allclose(found[:, 1], 1e-3 * right, atol=1e-5)
    if pulled:
        every = column(41, chosen | {"loads": []}, **given).problem.geometry.X
        assert np.abs(every - found).max() > 1e-5


def test_an_arch_under_its_weight_has_the_shape_of_its_sway():
    """The lowest buckling mode of an arch between hinges is antisymmetric; along its normal it has its amplitude."""
    hinged = [{"at": at, "fixed": "pinned"} for at in ("first", "last")]
    arc = {"rest": {"kind": "arc", "curvature": 2.0}, "vertices": 41, "section": {"height": 0.01}}
    arch = column(41, None, forces=[], supports=hinged).vary("arch", rod=arc)
    perfect = arch.problem.geometry
    inward = {"g": 1.0, "along": normals(perfect.X)[20].tolist()}
    case = arch.vary("swaying", gravity=inward, imperfection=BUCKLING).problem
    shape = (case.imperfection.shape(case, perfect) * normals(perfect.X)).sum(axis=1)
    assert shape[:20].max() == pytest.approx(1)  # of two equal waves the first is positive
    np.testing.assert_allclose(shape, -shape[::-1], atol=1e-9)
    along = ((case.geometry.X - perfect.X) * normals(perfect.X)).sum(axis=1)
    np.testing.assert_allclose(along, 1e-5 * shape, atol=2e-7)  # its edges keep their lengths


def test_a_path_begins_in_a_static_answer_with_the_buckling_mode_of_its_own_loads():
    """Also where those of the static answer make another one, which is that of its own case."""
    from cosserat.problems.path import RodPath

    held = [{"at": "first", "moment": -1e-6}, {"at": "last", "moment": 1e-6}]
    start = column(21, BUCKLING, forces=[], couples=held).problem.model_dump()
    push = [{"at": "last", "along": "-E3", "force": 0.6 * EULER}]
    table = start | {"kind": "rod path", "start_from": start, "couples": [], "forces": push}
    path = RodPath.read(table, "x", units_required=False).solve("the path")
    np.testing.assert_allclose(path["x_ref"], column(21, BUCKLING).problem.geometry.X, atol=1e-15)
    both = column(21, BUCKLING, forces=push, couples=held)
    named = both.vary("named", imperfection={"loads": ["forces"]})
    np.testing.assert_allclose(path["x"][-1], cosserat.run(named).x, atol=1e-10)


def test_the_keys_of_the_loads_are_those_of_a_case():
    assert {*get_args(LoadKey)} == {
        *(set(LOADS) - {"base_motion"}),
        *(key for key in CONSTRAINTS if key != "supports"),
    }


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
        (
            {"amplitude": "1 kg"},
            "'imperfection.kind' is missing: write 'bow' or 'mode' or 'buckling mode'",
        ),
        (BUCKLING | {"mode": 0}, "'imperfection.mode' is 0; it must be at least 1"),
        (
            BUCKLING | {"mode": 99},
            "'mode' = 99, but under 'forces' the rod has [0-9]+ buckling modes; take",
        ),
        (BUCKLING | {"loads": ["couples"]}, "the case has none of the loads that should make it buckle"),
        (
            BUCKLING | {"loads": ["force"]},
            "'imperfection.loads.0' is 'force'; it must be 'gravity', 'line_l",
        ),
    ],
)
def test_an_imperfection_that_fits_no_rod_is_refused_in_one_sentence(imperfection, sentence):
    with pytest.raises(InputError, match=sentence):
        cosserat.run(column(11, imperfection))


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"load": -1.0, "factor": 1e8},
            "under 'forces' the rod has no buckling modes; take a lower one, or other loads",
        ),
        (
            {"supports": []},
            "is a buckling mode, but the supports leave the rod free to move; add one, or",
        ),
        ({"pose": {"kind": "straight"}}, "has a 'pose' and an 'imperfection' of kind 'buckling mode'"),
    ],
)
def test_a_buckling_mode_that_there_is_not_is_refused_in_one_sentence(changes, sentence):
    """By the linear criterion a pull of GA would shear the rod into waves, so GA is out of reach here."""
    given = {key: value for key, value in changes.items() if key != "factor"}
    rod = {"section": {"shear_factor": changes.get("factor", 5 / 6)}}
    with pytest.raises(InputError, match=sentence):
        cosserat.run(column(11, BUCKLING, **given).vary("x", rod=rod))
