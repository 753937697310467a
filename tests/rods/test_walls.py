"""Walls that taper by themselves: tips and frequencies by quadrature and by Ritz's method, and bad input."""

import numpy as np
import pytest
from numpy.polynomial import legendre
from outside import closed
from scipy.linalg import eigh

import cosserat
from cosserat.errors import InputError

E, NU, RHO, LENGTH = 210e9, 0.3, 7850.0, 2.0
CLAMP = [{"at": "first", "fixed": "clamped"}]
SECTIONS = {
    "tube": {"diameter": 0.3, "wall": 0.02, "shear_factor": "cowper"},
    "hollow rectangle": {"height": 0.3, "width": 0.2, "wall": 0.02, "shear_factor": 0.4},
    "I": {"height": 0.3, "width": 0.2, "flange": 0.03, "web": 0.01, "shear_factor": 0.35},
}
ROUND = [
    {"at": 0.0, "height": 0.9, "width": 0.9},
    {"at": 1.13, "height": 0.8, "width": 0.8, "wall": 0.9},
    {"at": 1.13, "height": 0.8, "width": 0.8, "wall": 0.6},
    {"at": 2.0, "height": 0.4, "width": 0.4, "wall": 0.5},
]
TALL = [{"at": 0.3, "wall": 1.5}, {"at": 2.0, "height": 0.6, "width": 0.9, "wall": 0.5}]


def beam(shape, stations, **changes):
    rod = {
        "length": LENGTH,
        "section": {"shape": shape, **SECTIONS[shape]},
        "material": {"young": E, "poisson": NU, "density": RHO, "line_density": None},
        "stations": stations,
        **changes,
    }
    return cosserat.case("elastica").vary("beam", rod=rod, forces=[], supports=CLAMP)


def factor(stations, name, s):
    """Linear between stations, after a step at it; `wall` is that of the height where none is given."""
    at = np.array([station["at"] for station in stations]) + 1e-12 * np.arange(len(stations))
    values = [
        station.get(name, station.get("height", 1.0) if name == "wall" else 1.0) for station in stations
    ]
    return np.interp(s + 1e-11, at, values)


def local(shape, stations, s):
    """A, I and the shear factor, of an outline less its hollow."""
    given = SECTIONS[shape]
    h, w, t = (factor(stations, name, s) for name in ("height", "width", "wall"))
    if shape == "tube":
        D, d = 0.3 * h, 0.3 * h - 2 * 0.02 * t
        m = d / D
        top = 6 * (1 + NU) * (1 + m**2) ** 2
        k = top / ((7 + 6 * NU) * (1 + m**2) ** 2 + (20 + 12 * NU) * m**2)
        return np.pi / 4 * (D**2 - d**2), np.pi / 64 * (D**4 - d**4), k
    H, W = 0.3 * h, 0.2 * w
    beside = W - 2 * 0.02 * t if shape == "hollow rectangle" else W - 0.01 * t
    inside = H - 2 * t * given.get("wall", given.get("flange"))
    return W * H - beside * inside, (W * H**3 - beside * inside**3) / 12, given["shear_factor"]


def orders(errors):
    return np.log2(np.abs(np.array(errors[:-1]) / errors[1:])) / 2


@pytest.mark.parametrize(
    ("shape", "stations"), [("tube", ROUND), ("hollow rectangle", TALL), ("I", TALL)]
)
def test_tips_of_tapered_walls_are_of_second_order(shape, stations):
    """A step of the wall inside an edge, at the same share of an edge of all meshes."""
    G = E / (2 * (1 + NU))
    right = closed.cantilever_tip(
        1.0,
        LENGTH,
        lambda s: E * local(shape, stations, s)[1],
        lambda s: G * local(shape, stations, s)[2] * local(shape, stations, s)[0],
        [station["at"] for station in stations],
    )
    push = [{"at": "last", "along": "E2", "force": 1.0}]
    found = [
        cosserat.run(beam(shape, stations, vertices=n).vary("p", forces=push)) for n in (11, 41, 161)
    ]
    errors = [float(data.u.sel(axis="E2")[-1]) / right - 1 for data in found]
    assert orders(errors)[-1] == pytest.approx(2, abs=0.15), errors
    assert abs(errors[-1]) < 1e-4


def ritz(shape, stations, count, terms=14):
    """Frequencies of a Timoshenko cantilever [Hz]: deflection and rotation are polynomials times the distance s."""
    nodes, weights = legendre.leggauss(40)
    s, weights = LENGTH * (nodes + 1) / 2, weights * LENGTH / 2
    area, second, k = local(shape, stations, s)
    P = legendre.legvander(nodes, terms - 1).T
    slope = (
        np.array([legendre.legval(nodes, legendre.legder(row)) for row in np.eye(terms)]) * 2 / LENGTH
    )
    value, rate, zero = s * P, P + s * slope, np.zeros_like(P)
    turned, sheared = np.vstack([zero, rate]), np.vstack([rate, -value])
    up, round_ = np.vstack([value, zero]), np.vstack([zero, value])

    def form(rows, factor):
        return (rows * factor * weights) @ rows.T

    K = form(turned, E * second) + form(sheared, k * E / (2 * (1 + NU)) * area)
    M = form(up, RHO * area) + form(round_, RHO * second)
    return np.sqrt(eigh(K, M, eigvals_only=True)[:count]) / (2 * np.pi)


def test_frequencies_of_a_tapered_tube_are_of_second_order():
    """Mass and rotary inertia follow the wall; the wall gets thicker while the tube gets thinner."""
    taper = [{"at": 0.0}, {"at": 2.0, "height": 0.5, "width": 0.5, "wall": 1.6}]
    right = ritz("tube", taper, 3)
    np.testing.assert_allclose(ritz("tube", taper, 3, terms=11), right, rtol=1e-7)
    bends = []
    for n in (11, 41):
        data = cosserat.modes(beam("tube", taper, vertices=n), 7)
        along, across = np.abs(data.mode_u).max("vertex").sel(axis=["E3", "E2"]).to_numpy().T
        bends.append(data.natural_frequency.to_numpy()[across > along][:3])
    errors = np.array(bends) / right - 1
    assert np.log2(np.abs(errors[0] / errors[1])) / 2 == pytest.approx(2, abs=0.15), errors
    assert np.abs(errors[1]).max() < 3e-3


def test_walls_that_keep_their_share_are_those_of_the_outline():
    """The same factor for outline and wall is the taper without a wall of its own: energy, mass and stresses."""
    ends = {"at": 2.0, "height": 0.8, "width": 0.8}
    for shape in SECTIONS:
        one, two = (
            beam(shape, [{"at": 0.0}, last], vertices=5, centreline=0.4).problem.rod
            for last in (ends, ends | {"wall": 0.8})
        )
        geometry = one.geometry()
        np.testing.assert_allclose(two.mass(geometry), one.mass(geometry), rtol=1e-12, atol=1e-14)
        mine, other = (r.strain_energy.potential(r, geometry).constants for r in (two, one))
        for name in mine.dtype.names:
            np.testing.assert_allclose(mine[name], other[name], rtol=1e-12, err_msg=name)


def test_stresses_see_the_wall():
    """N / A and M y / I in a tube whose wall alone tapers, by a force along and a couple; Q / A by a force across."""
    taper = [{"at": 0.0}, {"at": 2.0, "wall": 0.5}]
    loads = {
        "forces": [{"at": "last", "along": "E3", "force": 1e3}],
        "couples": [{"at": "last", "moment": 1e3}],
    }
    data = cosserat.run(beam("tube", taper, vertices=11).vary("both", **loads))
    middle = (data.xi.to_numpy()[1:] + data.xi.to_numpy()[:-1]) / 2
    area, second, _ = local("tube", taper, middle)
    for side, y in (("upper", 0.15), ("lower", -0.15)):
        found = data.fibre_stress.sel(surface=side)
        np.testing.assert_allclose(found, 1e3 / area - 1e3 * y / second, rtol=1e-3)
    push = [{"at": "last", "along": "E2", "force": 1e3}]
    data = cosserat.run(beam("tube", taper, vertices=11).vary("across", forces=push))
    np.testing.assert_allclose(np.abs(data.shear_stress), 1e3 / area, rtol=1e-3)


@pytest.mark.parametrize(
    ("shape", "stations", "sentence"),
    [
        (
            "tube",
            [{"at": 1.0, "wall": 8}],
            "'stations' makes 'wall' 0.16 m at 1 m; it must be below half the diam",
        ),
        (
            "tube",
            [{"at": 1.0, "height": 0.1, "width": 0.1, "wall": 1}],
            "below half the diameter, 0.015 m there",
        ),
        (
            "I",
            [{"at": 1.0, "width": 0.1, "wall": 3}],
            "'stations' makes 'web' 0.03 m at 1 m; it must be at most",
        ),
        (
            "hollow rectangle",
            [{"at": 0.0, "width": 2.0}, {"at": 1.0, "wall": 1}],
            "without 'wall', which others",
        ),
        ("tube", [{"at": 1.0, "width": 2.0, "wall": 1}], "but a tube keeps its proportions"),
        ("tube", [{"at": 1.0, "wall": 0}], "'rod.stations.0.wall' is 0; it must be above 0"),
    ],
)
def test_impossible_walls_are_answered_in_one_sentence(shape, stations, sentence):
    with pytest.raises(InputError, match=sentence) as caught:
        beam(shape, stations)
    assert "\n" not in str(caught.value)


def test_who_has_no_wall_says_so():
    square = {"shape": "square", "side": 0.1, "shear_factor": "5/6"}
    with pytest.raises(
        InputError, match="wall = 0.5 at 1 m, but a section with shape = 'square' has no wall"
    ):
        beam("tube", [{"at": 1.0, "wall": 0.5}], section=square)
    published = {
        "energy": "published",
        "calibration": cosserat.case("clamped_free").problem.rod.calibration,
    }
    with pytest.raises(InputError, match="which energy = 'published' does not take"):
        beam("tube", [{"at": 1.0, "wall": 0.5}], **published)
