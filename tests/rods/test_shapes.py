"""Shapes of a rod at rest: their geometry against closed forms, and curved rods under weight against a BVP."""

import itertools
from functools import cache

import numpy as np
import pytest
from conftest import assembled
from outside import reissner
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, fresnel

import cosserat
from cosserat.errors import InputError
from cosserat.rods.shapes import CurvatureTable, Points

RATE = 9.0
"""Curvature per length of a clothoid, of 1 m [1/m^2]."""
CLOTHOID = {"kind": "curvature", "curvature": [[0, 0], [1, RATE]]}
A, B = 0.35, 0.2
"""Half axes of an ellipse [m]."""
SLENDER = {
    "length": "none",
    "section": {"height": 5e-3, "width": 5e-3},
    "material": {"young": 1e9, "poisson": 0.0, "line_density": 0.04195},
}
"""A rod of its own length, that of newton-physics/newton #3896."""


COEFFICIENTS = [f"c{k}" for k in range(1, 8)]


def orders(errors):
    return [np.log2(coarse / fine) for coarse, fine in itertools.pairwise(errors)]


def clothoid(s):
    """Where a clothoid is (n, 2): its angle is RATE s^2 / 2."""
    scale = np.sqrt(np.pi / RATE)
    S, C = fresnel(s / scale)
    return scale * np.column_stack([C, S])


def half_ellipse(count):
    """Points of the upper half from (A, 0) to (-A, 0), which begins along E2."""
    t = np.linspace(0, np.pi, count)
    return [[A * np.cos(u), B * np.sin(u)] for u in t]


HALF = B * 2 * ellipe(1 - A**2 / B**2)
"""Length of half the ellipse [m]."""


@cache
def parameter(s):
    """The angle t of (A cos t, B sin t) at an arc length from t = 0."""
    return brentq(lambda t: B * ellipeinc(t, 1 - A**2 / B**2) - s, -0.1, np.pi + 0.1, xtol=1e-15)


def bend(s):
    """Curvature of the ellipse at an arc length [1/m]."""
    t = np.array([parameter(u) for u in np.ravel(s)]).reshape(np.shape(s))
    return A * B / (A**2 * np.sin(t) ** 2 + B**2 * np.cos(t) ** 2) ** 1.5


def shaped(rest, vertices, energy="elastica", **more):
    rod = {**SLENDER, "vertices": vertices, "rest": rest, **more}
    if rest["kind"] != "points":
        rod["length"] = 1.0
    if energy != "elastica":
        rod |= {"energy": "published", "calibration": dict.fromkeys(COEFFICIENTS, 1.0)}
    return cosserat.case("elastica").vary("shaped", forces=[], rod=rod)


def test_vertices_follow_a_clothoid_with_second_order():
    errors = []
    for n in (21, 41, 81):
        geometry = shaped(CLOTHOID, n).problem.geometry
        errors.append(np.abs(geometry.X - clothoid(geometry.arc_length)).max())
        assert geometry.arc_length[-1] == pytest.approx(1.0, rel=1e-14)
    assert orders(errors) == pytest.approx([2, 2], abs=0.05)
    assert errors[-1] < 2e-4


def test_vertices_follow_points_on_an_ellipse_with_second_order():
    errors = []
    for n in (21, 41, 81):
        problem = shaped({"kind": "points", "points": half_ellipse(81)}, n).problem
        assert problem.rod.length == pytest.approx(HALF, rel=1e-7)
        t = np.array([parameter(s) for s in problem.geometry.arc_length])
        errors.append(np.abs(problem.geometry.X - [[A * np.cos(u), B * np.sin(u)] for u in t]).max())
    assert orders(errors) == pytest.approx([2, 2], abs=0.05)
    np.testing.assert_allclose(problem.geometry.X[0], [A, 0], atol=1e-15)
    np.testing.assert_allclose(problem.geometry.D[0] / 2.5e-3, [-1, 0], atol=0.05)


def test_a_given_first_tangent_makes_the_end_of_the_spline_better():
    """Of few points, the angle at the first vertex is that given, and the length is nearer."""
    free = Points(points=half_ellipse(7))
    held = Points(points=half_ellipse(7), tangent="E2")
    assert held.angles(np.zeros(1))[0] == pytest.approx(np.pi / 2, abs=1e-14)
    assert abs(held.length - HALF) < abs(free.length - HALF) < 2e-3 * HALF
    errors = [abs(Points(points=half_ellipse(n), tangent="E2").length - HALF) for n in (21, 41, 81)]
    assert min(orders(errors)) > 3.5


def test_whole_turns_of_a_spiral_count():
    """r = a t: two turns of Archimedes' spiral, whose tangent is at t + atan(t)."""
    t = np.linspace(0.5, 4 * np.pi + 0.5, 200)
    spiral = Points(points=np.column_stack([t * np.cos(t), t * np.sin(t)]))
    ends = spiral.angles(np.array([0.0, spiral.length]))
    right = (t[-1] + np.arctan(t[-1])) - (t[0] + np.arctan(t[0]))
    assert np.diff(ends)[0] == pytest.approx(right, rel=1e-4)


def test_a_curvature_between_its_rows_is_linear_or_a_spline():
    at = np.linspace(0, 1, 9)
    rows = np.column_stack([at, np.sin(3 * at)])
    spline = CurvatureTable(curvature=rows, between="spline").angles(np.array([0.0, 0.55]))
    assert spline[1] == pytest.approx((1 - np.cos(3 * 0.55)) / 3, rel=1e-4)
    linear = CurvatureTable(curvature=rows).angles(np.array([0.0, 0.55]))
    assert linear[1] == pytest.approx(quad(lambda s: np.interp(s, *rows.T), 0, 0.55)[0], rel=1e-5)


@pytest.mark.parametrize("energy", ["elastica", "published"])
@pytest.mark.parametrize("rest", [CLOTHOID, {"kind": "points", "points": half_ellipse(41)}])
def test_a_rod_is_at_rest_in_its_shape(energy, rest):
    problem = shaped(rest, 21, energy).problem
    geometry = problem.geometry
    body = problem.rod.strain_energy.potential(problem.rod, geometry)
    energy, gradient, hessian = assembled(body, geometry.q)
    assert abs(energy) < 1e-20 * np.abs(hessian).max()
    assert np.abs(gradient).max() < 1e-14 * np.abs(hessian).max()


@pytest.mark.parametrize("energy", ["elastica", "published"])
def test_a_constant_table_is_an_arc(energy):
    load = {"gravity": {"g": 1.0, "along": "-E2"}}
    rests = ({"kind": "arc", "curvature": 2.0}, {"kind": "curvature", "curvature": [[0, 2], [1, 2]]})
    tips = [cosserat.run(shaped(rest, 11, energy).vary("x", **load)).x[-1].to_numpy() for rest in rests]
    np.testing.assert_allclose(*tips, rtol=1e-9)


@pytest.mark.parametrize("energy", ["elastica", "published"])
@pytest.mark.parametrize("rest", [{"kind": "straight"}, {"kind": "arc", "curvature": 2.0}, CLOTHOID])
def test_a_rod_along_another_direction_is_the_same_rod_turned(energy, rest):
    angle, tips = 0.7, []
    for first, pull in ((0.0, -0.4), (angle, angle - 0.4)):
        case = shaped(rest | {"along": first}, 11, energy).vary("x", gravity={"g": 1.0, "along": pull})
        tips.append(complex(*cosserat.run(case).x[-1].to_numpy()))
    assert abs(tips[0] - shaped(rest, 11).problem.geometry.X[-1] @ [1, 1j]) > 1e-3
    assert tips[1] == pytest.approx(tips[0] * np.exp(1j * angle), abs=1e-9)


@pytest.mark.parametrize("centreline", [0.2, 0.5])
def test_the_line_of_the_area_centres_is_as_long_as_that_of_parallel_curves(centreline):
    """A curve at the distance e inside one that turns by t is shorter by e t, whatever its curvature."""
    rod = shaped(
        CLOTHOID, 21, centreline=centreline, section={"height": 0.02, "width": 5e-3}
    ).problem.rod
    edges = rod.strain_energy.potential(rod, rod.geometry()).constants["edge"][:-1]
    e = (0.5 - centreline) * 0.02
    assert edges.sum() == pytest.approx(1 - e * RATE / 2, rel=1e-12)
    shortened = np.diff(edges) / np.diff(np.linspace(0, 1, 21))[0] ** 2
    np.testing.assert_allclose(shortened, -e * RATE, rtol=1e-9, atol=1e-9)
    bending = rod.strain_energy.potential(rod, rod.geometry()).constants["k_bending"][:-1]
    np.testing.assert_allclose(bending, 1e9 * 5e-3 * 0.02**3 / 12, rtol=1e-12)


@cache
def hung(kind):
    """The last point of a rod that hangs from its clamped first end."""
    length, K, first = (1.0, lambda s: RATE * s, 0.0) if kind == "clothoid" else (HALF, bend, np.pi / 2)
    rod = reissner.Rod.rectangle(length, 5e-3, 5e-3, 1e9, curvature=K)
    rod = reissner.replace(rod, first=first)
    load = reissner.Load(reissner.CLAMP | {"a": first}, reissner.FREE, py=-0.04195 * 9.81)
    return reissner.tip(rod, load, steps=6)


@pytest.mark.parametrize("kind", ["clothoid", "ellipse"])
def test_a_curved_rod_hangs_as_a_boundary_value_problem_says(kind):
    rest = CLOTHOID if kind == "clothoid" else {"kind": "points", "points": half_ellipse(81)}
    gravity = {"g": 9.81, "along": "-E2"}
    right = hung(kind) + (np.zeros(2) if kind == "clothoid" else [A, 0])
    found = [
        cosserat.run(shaped(rest, n).vary("hung", gravity=gravity)).x[-1].to_numpy()
        for n in (21, 41, 81)
    ]
    errors = [np.linalg.norm(tip - right) for tip in found]
    assert orders(errors) == pytest.approx([2, 2], abs=0.15)
    assert errors[-1] < 1e-3


@pytest.mark.parametrize(
    ("rest", "sentence"),
    [
        (
            {"kind": "points", "points": [[0, 0], [2, 0]]},
            "has points along 2 m, but 'length' is 1 m; leave",
        ),
        (
            {"kind": "points", "points": [[0, 0], [0, 0], [1, 0]]},
            r"with \(0 m, 0 m\) in rows 0 and 1; leave",
        ),
        ({"kind": "points", "points": [[0, 0]]}, "has 1 row; it needs 2"),
        ({"kind": "points", "points": "none.csv"}, "is the file 'none.csv', which cannot be read"),
        ({"kind": "points", "points": [[0, 0], [1, 0]], "tangent": "up"}, "'rod.rest.tangent' is 'up'"),
        (
            {"kind": "curvature", "curvature": [[0, 1], [0.5, 2]]},
            "from 0 m to 0.5 m, but the rod goes from 0",
        ),
        (
            {"kind": "curvature", "curvature": [[0, 1], [1, 99]]},
            "'rest' rotates an edge by more than a radian",
        ),
        (
            {"kind": "curvature", "curvature": [["0 m", "1 m"], [1, 0]]},
            'row 0, curvature, is "1 m", in m',
        ),
        ({"kind": "arc"}, "'rod.rest.curvature' is missing"),
        ({"kind": "straight", "along": "up"}, "'rod.rest.along' is 'up'; it must be"),
        ({"kind": "bow"}, "'arc'"),
    ],
)
def test_a_shape_that_fits_no_rod_is_refused_in_one_sentence(rest, sentence):
    with pytest.raises(InputError, match=sentence):
        cosserat.case("elastica").vary("x", rod={"rest": rest, "vertices": 41})


def test_points_come_from_a_file_beside_the_case_and_give_the_length(tmp_path):
    rows = "\n".join(f"{1e3 * x},{1e3 * y}" for x, y in half_ellipse(41))
    (tmp_path / "shape.csv").write_text(f"E3 [mm],E2 [mm]\n{rows}\n")
    text = '[x]\nlike = "elastica"\nrod.length = "none"\nrod.rest = { kind = "points", points = "shape.csv" }\n'
    (tmp_path / "x.toml").write_text(text)
    problem = cosserat.case("x", file=tmp_path / "x.toml").problem
    assert problem.rod.length == pytest.approx(HALF, rel=1e-5)
    text = text.replace(', points = "shape.csv"', "")
    (tmp_path / "x.toml").write_text(text)
    with pytest.raises(InputError, match=r"'rod.rest.points' is missing"):
        cosserat.case("x", file=tmp_path / "x.toml")


def test_a_motion_from_a_beam_mode_needs_a_straight_rod():
    with pytest.raises(
        InputError, match=r"'rod.rest' is not straight along E3; begin from the 'reference'"
    ):
        cosserat.case("vibration_consistent").vary("x", rod={"rest": {"kind": "arc", "curvature": 0.1}})
    with pytest.raises(InputError, match=r"'rod.rest' is not straight along E3"):
        cosserat.case("vibration_consistent").vary("x", rod={"rest": {"along": "30 deg"}})
