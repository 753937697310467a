"""Loads that follow the rod: follower forces, pressure, distributed couples, against exact answers."""

import numpy as np
import pytest
from conftest import jacobian
from scipy.integrate import quad, solve_bvp, solve_ivp
from scipy.optimize import brentq

import cosserat
from cosserat.errors import InputError
from cosserat.problems.critical import RodCriticalLoads
from cosserat.problems.modes import RodModes
from cosserat.problems.static import RodStatics
from cosserat.rods.loads.load import LoadedRod
from cosserat.rods.loads.pressure import Pressure

CLAMP = ["x3", "x2", "d3", "d2"]
BASE = cosserat.case("elastica")
THIN = 2e-3
"""Height of a section over the length: extension and shear are of the order of its square."""


def slender(vertices, *, curvature=0.0, supports=({"at": "first", "fixed": CLAMP},), **loads):
    """A slender rod of unit length and unit bending stiffness under some loads only."""
    given = BASE.problem
    section = {**given.rod.section.model_dump(), "height": THIN, "width": 0.01}
    table = given.model_dump() | dict.fromkeys(("forces", "couples", "line_loads"), ())
    table["rod"] |= {"vertices": vertices, "length": 1.0, "section": section}
    table["rod"]["rest"] = {"kind": "arc", "curvature": curvature}
    table["rod"]["material"] |= {"young": 12 / (0.01 * THIN**3), "poisson": 0.0}
    table["supports"] = list(supports)
    return RodStatics.read(table | loads, "slender", units_required=False)


def solve_order(problems, exact, found):
    """Errors of a sequence of meshes, and their order."""
    errors = [np.abs(found(problem.solve("it")) - exact).max() for problem in problems]
    finer = (problems[-1].rod.vertices - 1) / (problems[0].rod.vertices - 1)
    return errors, np.log(errors[0] / errors[-1]) / np.log(finer)


def tip_angle(solution):
    d = solution["d"][-1]
    return np.arctan2(-d[0], d[1]) % (2 * np.pi)


@pytest.mark.parametrize("load", [2.0, 15.0])
def test_a_follower_force_across_the_tip_meets_the_elastica(load):
    """Seen from the tip the force keeps its direction: theta'' = -load cos theta, an initial value problem."""
    done = solve_ivp(lambda s, y: [y[1], load * np.cos(y[0])], (0, 1), [0, 0], rtol=1e-11, atol=1e-12)
    problems = [
        slender(n, follower_forces=[{"at": "last", "along": "E2", "force": load}]) for n in (41, 81, 161)
    ]
    errors, order = solve_order(problems, abs(done.y[0, -1]) % (2 * np.pi), tip_angle)
    assert errors[-1] < 2e-3
    assert order == pytest.approx(2, abs=0.2)


def follower_cantilever(q, offset):
    """Tip of an inextensible cantilever under a force q per length across it, which turns with it: own BVP.

    offset : distance of the loaded surface below the centreline, which is longer by the factor 1 + offset a'.
    """

    def rates(s, y):
        _, _, a, N3, N2, M = y
        n = q * (1 + offset * M)
        return np.array(
            [np.cos(a), np.sin(a), M, n * np.sin(a), -n * np.cos(a), N3 * np.sin(a) - N2 * np.cos(a)]
        )

    def ends(first, last):
        return np.array([*first[:3], *last[3:]])

    s, y = np.linspace(0, 1, 41), np.zeros((6, 41))
    y[0] = s
    for share in np.linspace(0.1, 1, 10):
        full, q = q, share * q
        done = solve_bvp(rates, ends, s, y, tol=1e-9, max_nodes=20_000)
        assert done.success
        s, y, q = done.x, done.y, full
    return y[:2, -1]


@pytest.mark.parametrize(
    ("loads", "offset"),
    [
        ({"follower_line_loads": [{"along": "E2", "density": 6.0}]}, 0),
        ({"pressures": [{"side": "lower", "pressure": 600.0}]}, THIN / 2),
        ({"pressures": [{"side": "upper", "pressure": -600.0}]}, -THIN / 2),
    ],
)
def test_a_load_across_a_cantilever_meets_a_boundary_value_problem(loads, offset):
    problems = [slender(n, **loads) for n in (21, 41, 81)]
    exact = follower_cantilever(6.0, offset)
    assert exact[0] < 0.75
    errors, order = solve_order(problems, exact, lambda solution: solution["x"][-1])
    assert errors[-1] < 4e-4
    assert order == pytest.approx(2, abs=0.2)


def test_a_load_over_a_stretch_that_ends_inside_edges_is_of_second_order():
    """Small deflections of a cantilever under a load from 0.35 to 0.65, middles of edges: closed form."""
    small, part = 1e-2, {"start": 0.35, "end": 0.65}
    exact = quad(lambda s: small * s**2 * (3 - s) / 6, 0.35, 0.65)[0]
    line = [{"along": "E2", "density": small, **part}]
    problems = [slender(n, follower_line_loads=line) for n in (11, 31, 91)]
    errors, order = solve_order(problems, exact, lambda solution: solution["u"][-1, 1])
    assert errors[-1] < 1e-4 * exact
    assert order == pytest.approx(2, abs=0.1)
    pressed = slender(11, pressures=[{"side": "lower", "pressure": 100 * small, **part}])
    assert pressed.solve("it")["u"][-1, 1] == pytest.approx(exact, rel=1e-5)  # exact to its centroid


def test_distributed_couples_bend_a_cantilever_by_a_quadratic():
    """The moment m (L - s) makes the angle m (L s - s^2 / 2): the tip by quadrature."""
    m = 4.0
    exact = [
        quad(lambda s: np.cos(m * (s - s**2 / 2)), 0, 1)[0],
        quad(lambda s: np.sin(m * (s - s**2 / 2)), 0, 1)[0],
    ]
    problems = [slender(n, line_couples=[{"density": m}]) for n in (21, 41, 81)]
    errors, order = solve_order(problems, np.array(exact), lambda solution: solution["x"][-1])
    assert errors[-1] < 1e-3
    assert order == pytest.approx(2, abs=0.2)


# ---------------------------------------------------------------- buckling under pressure


def critical(problem):
    """The load factor of the first singular equilibrium."""
    return RodCriticalLoads.of(problem, 1).solve("it")["special_load_factor"][0]


ROLLERS = ({"at": "first", "fixed": ["x3", "x2", "d3"]}, {"at": "last", "fixed": ["x3", "d3"]})


def half_ring(vertices, **loads):
    """Half a ring whose ends are guided; its polygon turns by half a turn exactly.  And its radius."""
    curvature = 2 * (vertices - 1) * np.sin(np.pi / 2 / (vertices - 1))
    return slender(vertices, curvature=curvature, supports=ROLLERS, **loads), 1 / curvature


def test_half_a_ring_between_guides_buckles_at_three_EI_over_R_cubed():
    """(n^2 - 1) EI / R^3 with n = 2, Levy (1884), for a pressure that stays across the ring."""
    found = []
    for vertices in (41, 81):
        problem, R = half_ring(vertices, pressures=[{"side": "lower", "pressure": 300}])
        assert problem.system(problem.geometry).symmetric
        found.append(critical(problem) * R**3)
    assert found[1] == pytest.approx(1, abs=2e-3)
    assert found[1] + (found[1] - found[0]) / 3 == pytest.approx(1, abs=2e-4)


def test_a_dead_load_buckles_half_a_ring_elsewhere():
    """A load that keeps its direction needs n^2 EI / R^3 = 4 (Boresi 1955): a pressure that did not turn shows here."""
    problem, R = half_ring(81, pressures=[{"side": "lower", "pressure": 100}])
    system = problem.system(problem.geometry)
    gradient = np.zeros(system.constrained.size)
    (pressure,) = [load for load in system.external if load.terms == ("pressure",)]
    pressure.add_gradient(system.space.reference, pressure.history, gradient)
    forces = -problem.rod.kinematics.split(gradient)[:, 0]
    dead = [
        {"at": k, "along": tuple(force), "force": float(np.linalg.norm(force))}
        for k, force in enumerate(forces)
    ]
    fixed = problem.replace(pressures=(), forces=dead)
    assert critical(fixed) * R**3 == pytest.approx(4, rel=1e-2)


@pytest.mark.parametrize(
    ("fixed", "k"),
    [
        (["x3", "x2"], 3.0),
        (CLAMP, brentq(lambda k: k * np.tan(np.pi / 3) / np.tan(k * np.pi / 3) - 1, 4.2, 4.45)),
    ],
)
def test_an_arch_buckles_to_one_side_under_pressure(fixed, k):
    """(k^2 - 1) EI / R^3 for an arch of 120 degrees, hinged or clamped: Timoshenko & Gere (1961), section 7.6."""
    R = 3 / (2 * np.pi)
    supports = [{"at": end, "fixed": fixed} for end in ("first", "last")]
    found = [
        critical(
            slender(
                vertices,
                curvature=1 / R,
                supports=supports,
                pressures=[{"side": "lower", "pressure": 100 * (k**2 - 1) / R**3}],
            )
        )
        for vertices in (41, 81)
    ]
    extrapolated = found[1] + (found[1] - found[0]) / 3
    assert extrapolated == pytest.approx(1, abs=5e-3)


@pytest.mark.parametrize(
    "supports", [ROLLERS, [{"at": end, "fixed": CLAMP} for end in ("first", "last")]]
)
def test_a_pressure_between_held_ends_has_a_potential(supports):
    """Its force is minus the gradient of its energy on every free number."""
    problem = slender(
        9, curvature=np.pi, supports=supports, pressures=[{"side": "lower", "pressure": 50}]
    )
    free = ~problem.constrained()
    geometry = problem.geometry
    body = LoadedRod(problem.rod, geometry, None, ~free)
    potential = Pressure.potential(problem.pressures, body)
    assert potential.symmetric
    assert potential.energy(geometry.q) == pytest.approx(0, abs=1e-15)
    q = geometry.q + np.where(free, 0.02 * np.random.default_rng(1).uniform(-1, 1, geometry.q.size), 0)
    gradient = np.zeros(q.size)
    potential.add_gradient(q, potential.history, gradient)
    slope = jacobian(potential.energy, q, 1e-6)
    np.testing.assert_allclose(gradient[free], slope[free], atol=1e-8 * np.abs(gradient).max())


@pytest.mark.parametrize(
    "changes",
    [
        {"supports": [{"at": "first", "fixed": CLAMP}]},
        {"supports": [{"at": end, "fixed": ["x3", "x2"]} for end in ("first", "last")]},
        {"pressures": [{"side": "lower", "pressure": 50, "end": 0.33}]},
    ],
)
def test_other_pressures_have_none(changes):
    given = {"supports": [{"at": end, "fixed": CLAMP} for end in ("first", "last")]}
    given |= {"pressures": [{"side": "lower", "pressure": 50}]} | changes
    problem = slender(9, **given)
    assert not problem.system(problem.geometry).symmetric


def flutter_load(vertices):
    """The follower load along a cantilever [EI / L^2] above which a mode grows, by bisection."""
    low, high = 18.0, 22.0
    while high - low > 1e-3:
        load = (low + high) / 2
        pushed = slender(vertices, follower_forces=[{"at": "last", "along": "-E3", "force": load}])
        growing = RodModes.of(pushed, 3).solve("it").statistics["growing_modes"]
        low, high = (low, load) if growing else (load, high)
    return low


def test_becks_column_flutters_where_it_should():
    """20.0509 EI / L^2, Beck (1952); it never has another equilibrium than the straight one."""
    found = [flutter_load(vertices) for vertices in (21, 41)]
    assert found[1] == pytest.approx(20.0509, rel=3e-3)
    assert found[1] + (found[1] - found[0]) / 3 == pytest.approx(20.0509, rel=1e-4)


# ---------------------------------------------------------------- in motion


def test_the_work_of_loads_that_follow_closes_the_balance():
    case = cosserat.case("vibration_consistent").vary(
        "it",
        start={"shape": "reference", "amplitude": 0.0},
        follower_forces=[{"at": "last", "along": "E2", "force": 2e3}],
        pressures=[
            {"side": "upper", "pressure": 1e4, "time_function": {"kind": "ramp", "duration": 0.05}}
        ],
        duration=0.1,
        every=0.01,
        integrator={"step": 5e-4},
    )
    run = cosserat.run(case)
    energy = run.kinetic_energy + run.strain_energy
    given = run.load_work - run.load_potential
    assert float(run.load_work[-1]) > 0
    assert np.abs(energy - given - (energy - given)[0]).max() < 1e-9 * float(np.abs(energy).max())
    assert "energy balance" not in run.attrs.get("warnings", "")


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"pressures": [{"side": "left", "pressure": 1.0}]}, "'left'; it must be 'upper' or 'lower'"),
        (
            {"pressures": [{"side": "upper", "pressure": 1.0, "start": 0.7, "end": 0.2}]},
            "'pressures' has one from 0.7 m to 0.2 m",
        ),
        (
            {"follower_forces": [{"at": "2 m", "along": "E2", "force": 1.0}]},
            "'at' is 2.0 m, but the rod is 1 m long",
        ),
        (
            {"follower_line_loads": [{"along": "E2", "density": 1.0, "end": 3.0}]},
            "'follower_line_loads' has one from 0 m to 3 m",
        ),
        ({"line_couples": [{"density": "1 N/m"}]}, "in N/m, a force per length and not a force"),
    ],
)
def test_a_fault_is_one_sentence(changes, sentence):
    with pytest.raises(InputError) as caught:
        slender(9, **changes)
    assert sentence in str(caught.value)
