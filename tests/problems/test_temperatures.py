"""Heated and pre-strained rods against closed forms, and against a BVP where they hang from a clamp."""

import itertools
from functools import cache

import numpy as np
import pytest
from conftest import assembled, jacobian, random_state
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import cosserat
from cosserat.errors import InputError
from cosserat.rods.energies.reissner import stressed

LENGTH, HEIGHT, WIDTH, YOUNG, NU, ALPHA = 1.0, 0.02, 0.03, 1e8, 0.3, 1e-5
EA, EI = YOUNG * HEIGHT * WIDTH, YOUNG * WIDTH * HEIGHT**3 / 12
GA = 5 / 6 * YOUNG / (2 * (1 + NU)) * HEIGHT * WIDTH
CLAMP = ["x3", "x2", "d3", "d2"]
HINGED = [{"at": "first", "fixed": ["x3", "x2"]}, {"at": "last", "fixed": ["x2"]}]
WALLS = [{"at": "first", "fixed": ["x3", "x2"]}, {"at": "last", "fixed": ["x3", "x2"]}]


def rod(vertices=21, like="elastica", supports=None, **changes):
    given = {
        "section": {"height": HEIGHT, "width": WIDTH},
        "material": {"young": YOUNG, "poisson": NU},
        "vertices": vertices,
    }
    own = {"supports": supports} if supports else {}
    own["rod"] = given | changes.pop("rod", {})
    return cosserat.case(like).vary("heated", **{"forces": []} | own | changes)


def heated(change=0.0, gradient=0.0, **more):
    return [{"change": change, "gradient": gradient, "expansion": ALPHA, **more}]


def orders(errors):
    return [np.log2(coarse / fine) for coarse, fine in itertools.pairwise(errors)]


def test_a_heated_bar_that_is_free_gets_longer_and_thicker_without_stress():
    data = cosserat.run(rod(supports=HINGED, temperatures=heated(change=500)))
    assert float(data.u[-1, 0]) == pytest.approx(ALPHA * 500 * LENGTH, rel=1e-10)
    np.testing.assert_allclose(data.lam, 1 + ALPHA * 500, rtol=1e-11)
    assert np.abs(data.support_force).max() < 1e-9 * EA * ALPHA * 500


@pytest.mark.parametrize(
    ("constraint", "factor", "within"),
    [("free", 1, 1e-9), ("plane strain", 1 / (1 - NU), 1e-9), ("incompressible", 2, 2e-3)],
)
def test_a_heated_bar_between_walls_pushes(constraint, factor, within):
    """N = -E A alpha T, and 1 / (1 - nu) times as much where the sections keep their width."""
    poisson = 0.4999 if constraint == "incompressible" else NU
    case = rod(
        supports=WALLS,
        temperatures=heated(change=20),
        rod={"lateral_constraint": constraint, "material": {"young": YOUNG, "poisson": poisson}},
    )
    data = cosserat.run(case)
    right = factor * EA * ALPHA * 20
    assert float(data.support_force[-1, 0]) == pytest.approx(-right, rel=within)
    np.testing.assert_allclose(data.normal_force, -right, rtol=within)
    assert np.abs(data.u).max() < 1e-9


def test_half_a_bar_heated_pushes_half_as_much():
    """The end of the heated half lies within an edge."""
    data = cosserat.run(rod(supports=WALLS, temperatures=heated(change=20, end=0.537)))
    assert float(data.support_force[-1, 0]) == pytest.approx(-0.537 * EA * ALPHA * 20, rel=1e-2)


@pytest.mark.parametrize("constraint", ["free", "plane strain"])
def test_a_gradient_bends_a_cantilever_into_an_arc_with_the_hot_side_outside(constraint):
    """Curvature -alpha T', here a quarter of a circle, without stress; second order."""
    bend = (1 + NU if constraint == "plane strain" else 1) * ALPHA * 1e5
    errors = []
    for n in (11, 21, 41):
        case = rod(n, temperatures=heated(gradient=1e5), rod={"lateral_constraint": constraint})
        data = cosserat.run(case)
        right = np.array([np.sin(bend), -(1 - np.cos(bend))]) / bend
        errors.append(np.linalg.norm(data.x[-1].to_numpy() - right))
        assert np.abs(data.support_force).max() < 1e-8 * EI * bend
    assert orders(errors) == pytest.approx([2, 2], abs=0.05)


def test_a_gradient_bows_a_simple_beam_and_bends_a_clamped_one_by_a_moment_alone():
    """alpha T' L^2 / 8 in the middle, the hot upper side outside; or the moment EI alpha T' at both clamps."""
    gradient = 100.0
    bow = ALPHA * gradient * LENGTH**2 / 8
    errors = [
        float(cosserat.run(rod(n, supports=HINGED, temperatures=heated(gradient=gradient))).x[n // 2, 1])
        / bow
        - 1
        for n in (11, 21, 41)
    ]
    assert np.abs(errors).max() < 0.01  # to round-off second order: a parabola is exact
    clamps = [{"at": "first", "fixed": CLAMP}, {"at": "last", "fixed": CLAMP}]
    data = cosserat.run(rod(supports=clamps, temperatures=heated(gradient=gradient)))
    assert np.abs(data.x[:, 1]).max() < 1e-12
    moment = EI * ALPHA * gradient
    assert float(data.reaction_moment[-1]) == pytest.approx(moment, rel=1e-9)
    np.testing.assert_allclose(data.bending_moment, moment, rtol=1e-9)


def test_a_bar_between_walls_buckles_where_its_push_is_eulers():
    """P (1 + P/GA) = pi^2 EI / L^2, P = EA alpha T: the square of the frequency falls to zero there."""
    euler = np.pi**2 * EI / LENGTH**2
    push = GA / 2 * (np.sqrt(1 + 4 * euler / GA) - 1)
    errors = []
    for n in (11, 21):
        loads = np.array([0.9, 0.94, 0.98])
        squares = [
            rod(n, supports=WALLS, temperatures=heated(change=k * push / (EA * ALPHA)))
            .problem.modes(1)
            .angular_frequency[0]
            ** 2
            for k in loads
        ]
        errors.append(np.polyval(np.polyfit(squares, loads, 2), 0.0) - 1)
    assert orders(np.abs(errors)) == pytest.approx([2], abs=0.1)
    assert abs(errors[-1]) < 5e-3


def test_a_prescribed_curvature_closes_a_ring_without_stress():
    """Equal edges that turn by the same angle close exactly."""
    data = cosserat.run(rod(41, prestrains=[{"curvature": 2 * np.pi / LENGTH}]))
    np.testing.assert_allclose(data.x[-1], 0, atol=1e-9)
    assert np.abs(data.support_force).max() < 1e-8 * EI


@cache
def hung():
    """Tip of a rod whose second half is as if it were bent by -2 / m, under a load across: shooting for the moment.

    Unknowns x, y, a, M as in `tests.outside.reissner`; the force is the load beyond, along y.
    """
    load = 4 * EI / LENGTH**3

    def rates(s, state, K):
        c, sn, across = np.cos(state[2]), np.sin(state[2]), load * (LENGTH - s)
        along, slide = 1 + across * sn / EA, across * c / GA
        dx = along * c - slide * sn
        return dx, along * sn + slide * c, K + state[3] / EI, -dx * across

    def end(moment):
        state = [0.0, 0.0, 0.0, moment]
        for a, b, K in ((0, LENGTH / 2, 0.0), (LENGTH / 2, LENGTH, -2.0)):
            state = solve_ivp(
                rates, (a, b), state, args=(K,), method="DOP853", rtol=1e-12, atol=1e-13
            ).y[:, -1]
        return state

    return end(brentq(lambda moment: end(moment)[3], 0, 4 * EI / LENGTH, xtol=1e-12))[:2]


@pytest.mark.parametrize("key", ["temperatures", "prestrains"])
def test_a_rod_bent_by_strains_and_weight_is_as_a_boundary_value_problem_says(key):
    strains = {
        "temperatures": heated(gradient=2 / ALPHA, start=LENGTH / 2),
        "prestrains": [{"curvature": -2.0, "start": LENGTH / 2}],
    }[key]
    weight = [{"along": "E2", "density": 4 * EI / LENGTH**3}]
    tips = [cosserat.run(rod(n, line_loads=weight, **{key: strains})).x[-1] for n in (21, 41, 81)]
    errors = [np.linalg.norm(tip.to_numpy() - hung()) for tip in tips]
    assert orders(errors) == pytest.approx([2, 2], abs=0.15)
    assert errors[-1] < 5e-4


@pytest.mark.parametrize("constraint", ["free", "incompressible"])
@pytest.mark.parametrize("centreline", [0.5, 0.3])
def test_the_load_shifts_the_strains_of_the_energy(constraint, centreline):
    """W(e - e0) - W(e) by the energy itself with another reference; gradient and Hessian by differences."""
    changes = {
        "lateral_constraint": constraint,
        "material": {"young": YOUNG, "poisson": 0.4999},
        "section": {"height": 0.2, "width": WIDTH},
        "centreline": centreline,
    }
    thick = rod(6, rod=changes).problem.rod
    energy = thick.strain_energy.potential(thick, thick.geometry())
    extension, curvature = np.linspace(0.01, 0.05, 5), np.linspace(-0.3, 0.2, 5)
    load = stressed(energy, extension, curvature, np.linspace(0.02, -0.03, 6), 0.01)
    q, other = random_state(thick, 1, 0.1, 0.4), random_state(thick, 2, 0.1, 0.3)
    _, gradient, hessian = assembled(load, q)
    by_energy = jacobian(load.energy, q, 1e-6)
    by_gradient = jacobian(lambda p: assembled(load, p)[1], q, 1e-6)
    np.testing.assert_allclose(gradient, by_energy, atol=1e-6 * np.abs(gradient).max())
    np.testing.assert_allclose(hessian, by_gradient, atol=1e-6 * np.abs(hessian).max())
    if constraint == "free":
        load = stressed(energy, extension, curvature, np.zeros(6), 0.01)
        moved = energy.constants.copy()
        moved["axial"][:-1] += moved["edge"][:-1] * extension
        moved["slide"][:-1] += moved["edge"][:-1] * 0.01
        moved["turn"][:-1] += moved["edge"][:-1] * curvature
        shifted = cosserat.solvers.potential.Potential(energy.evaluate, moved, energy.terms, 7)
        work = [shifted.energy(x) - energy.energy(x) - load.energy(x) for x in (q, other)]
        assert work[0] == pytest.approx(work[1], rel=1e-10)


def test_a_bar_heated_at_once_swings_about_its_length_at_rest():
    """One end clamped: a triangle between 0 and 2 alpha T L of period 4 L / c; energy and loads are balanced."""
    speed = np.sqrt(EA / 0.04)
    period = 4 * LENGTH / speed
    case = rod(
        41,
        "vibration_consistent",
        temperatures=heated(change=100),
        rod={
            "length": LENGTH,
            "material": {"young": YOUNG, "poisson": 0.0, "line_density": 0.04},
        },
        start={"shape": "reference", "amplitude": 0.0},
        duration=period,
        every=period / 40,
        damping=0.0,
        integrator={"step": period / 400},
    )
    data = cosserat.run(case)
    tip = (data.x - data.x_ref)[:, -1, 0].to_numpy() / (ALPHA * 100 * LENGTH)
    triangle = 2 * (1 - np.abs(1 - 2 * np.linspace(0, 1, 41)))
    np.testing.assert_allclose(tip, triangle, atol=0.08)
    clamp = data.normal_force[:, 0].to_numpy() / (
        EA * ALPHA * 100
    )  # its wave of compression comes from the free end
    np.testing.assert_allclose(clamp[:8], -1, atol=0.05)
    ramp = [
        load | {"time_function": {"kind": "ramp", "duration": period}} for load in heated(change=100)
    ]
    slow = cosserat.run(case.vary("slow", temperatures=ramp))
    level = np.linspace(0, 1, 41)
    np.testing.assert_allclose(slow.normal_force[:8, 0] / (EA * ALPHA * 100), -level[:8], atol=0.01)
    assert not [text for text in np.atleast_1d(data.attrs.get("warnings", "")) if "balance" in text]


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        (
            {"temperatures": [{"change": 40}]},
            r"'temperatures' has one without 'expansion', and 'rod.material' has none either",
        ),
        ({"temperatures": [{"change": "40 degC", "expansion": 1e-5}]}, "whose zero is not zero K"),
        (
            {"temperatures": [{"change": "40 m", "expansion": 1e-5}]},
            "a length and not a temperature difference",
        ),
        ({"prestrains": [{"extension": -1.0}]}, "'prestrains.0.extension' is -1; it must be above -1"),
        ({"prestrains": [{"curvature": "1 m"}]}, "'prestrains.0.curvature' is \"1 m\""),
        ({"prestrains": [{"curvature": 1, "start": 0.5, "end": 0.2}]}, "has one from 0.5 m to 0.2 m"),
        (
            {"prestrains": [{"curvature": 1, "end": 1.2}]},
            "has one from 0 m to 1.2 m, but the rod goes from 0 to 1 m",
        ),
        (
            {"prestrains": [{}]},
            "'prestrains.0' has no strain; give 'extension' or 'curvature' or 'section'",
        ),
        (
            {"temperatures": [{"expansion": 1e-5}]},
            "'temperatures.0' has no strain; give 'change' or 'gr",
        ),
        (
            {"prestrains": [{"curvature": 1}], "rod": {"barrier": True}},
            "'prestrains' needs rod.energy = 'consistent' without 'rod.barrier'",
        ),
    ],
)
def test_strains_that_fit_no_rod_are_refused_in_one_sentence(changes, sentence):
    with pytest.raises(InputError, match=sentence):
        rod(**changes)


def test_the_published_energy_takes_no_strains():
    with pytest.raises(InputError, match="needs rod.energy = 'consistent'"):
        cosserat.case("clamped_free").vary("x", prestrains=[{"curvature": 1.0}])


def test_differences_of_temperature_are_read_in_kelvin_and_degrees(tmp_path):
    file = tmp_path / "x.toml"
    told = 'change = "36 delta_degF", gradient = "2 K/mm", expansion = "12e-6 1/K"'
    file.write_text(f'[x]\nlike = "elastica"\ntemperatures = [{{ {told} }}]\n')
    load = cosserat.case("x", file=file).problem.temperatures[0]
    assert (load.change, load.gradient, load.expansion) == pytest.approx((20, 2000, 12e-6))
